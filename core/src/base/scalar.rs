//! The scalar types of the library, `f32` and `f64`, and the few complex functions the numerics need.
//!
//! Every transcendental function goes through `libm`, with and without `std`, so that each gives the
//! same bits whichever features it was built with.

use core::fmt::{Debug, Display};
use core::ops::Neg;
use num_traits::NumAssign;

/// Complex numbers carry points and vectors of the plane: `x + i y`.
pub type Complex<R> = nalgebra::Complex<R>;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Scalar type of a model: `f32` or `f64`. Sealed.
pub trait Real:
    sealed::Sealed
    + crate::linear::lu::Vectors
    + crate::base::elementary::Bits
    + crate::base::once::Compiled
    + Copy
    + Default
    + PartialOrd
    + Debug
    + Display
    + Send
    + Sync
    + 'static
    + NumAssign
    + Neg<Output = Self>
{
    /// Not a number; the value that an access out of range yields.
    const NAN: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Largest finite number.
    const MAX: Self;
    /// Smallest positive normal number.
    const TINY: Self;
    /// π.
    const PI: Self;
    /// 2π.
    const TAU: Self;
    /// ½.
    const HALF: Self;
    /// 2.
    const TWO: Self;

    /// The nearest number of this type.
    fn lit(x: f64) -> Self;
    /// The nearest number of this type (exact below 2²⁴).
    fn count(n: usize) -> Self;
    /// Exact conversion to `f64`.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Exponential.
    fn exp(self) -> Self;
    /// `exp(x) - 1` without cancellation.
    fn expm1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// `ln(1 + x)` without cancellation.
    fn ln_1p(self) -> Self;
    /// Angle of the point (`x`, `self`).
    fn atan2(self, x: Self) -> Self;
    /// Power.
    fn powf(self, p: Self) -> Self;
    /// Euclidean length of (`self`, `other`) without overflow.
    fn hypot(self, other: Self) -> Self;
    /// Largest integer not above.
    fn floor(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// Sine.
    #[inline]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine.
    #[inline]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Hyperbolic sine.
    #[inline]
    fn sinh(self) -> Self {
        let e = self.expm1();
        (e + e / (e + Self::one())) * Self::HALF
    }
    /// Hyperbolic cosine.
    #[inline]
    fn cosh(self) -> Self {
        (self.exp() + (-self).exp()) * Self::HALF
    }
    /// The larger; NaN when either is NaN, so that a poisoned value is never hidden.
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other || self.is_nan() { self } else { other }
    }
    /// The smaller; NaN when either is NaN.
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other || self.is_nan() { self } else { other }
    }
    /// Is not a number.
    #[inline]
    #[allow(clippy::eq_op)]
    fn is_nan(self) -> bool {
        self != self
    }
    /// Nearest integer.
    #[inline]
    fn round(self) -> Self {
        (self + Self::HALF).floor()
    }
}

macro_rules! real {
    ($t:ident, $sqrt:ident, $sincos:ident, $exp:ident, $expm1:ident, $ln:ident, $ln1p:ident, $atan2:ident, $pow:ident,
     $hypot:ident, $floor:ident) => {
        impl Real for $t {
            const NAN: Self = $t::NAN;
            const EPSILON: Self = $t::EPSILON;
            const MAX: Self = $t::MAX;
            const TINY: Self = $t::MIN_POSITIVE;
            const PI: Self = core::$t::consts::PI;
            const TAU: Self = core::$t::consts::TAU;
            const HALF: Self = 0.5;
            const TWO: Self = 2.0;
            #[inline]
            fn lit(x: f64) -> Self {
                x as $t
            }
            #[inline]
            fn count(n: usize) -> Self {
                n as $t
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                libm::$sincos(self)
            }
            #[inline]
            fn exp(self) -> Self {
                libm::$exp(self)
            }
            #[inline]
            fn expm1(self) -> Self {
                libm::$expm1(self)
            }
            #[inline]
            fn ln(self) -> Self {
                libm::$ln(self)
            }
            #[inline]
            fn ln_1p(self) -> Self {
                libm::$ln1p(self)
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline]
            fn powf(self, p: Self) -> Self {
                libm::$pow(self, p)
            }
            #[inline]
            fn hypot(self, other: Self) -> Self {
                libm::$hypot(self, other)
            }
            #[inline]
            fn floor(self) -> Self {
                libm::$floor(self)
            }
            #[inline]
            fn abs(self) -> Self {
                $t::abs(self)
            }
            #[inline]
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
        }
    };
}
real!(f64, sqrt, sincos, exp, expm1, log, log1p, atan2, pow, hypot, floor);
real!(f32, sqrtf, sincosf, expf, expm1f, logf, log1pf, atan2f, powf, hypotf, floorf);

/// `x + i y`.
#[inline]
pub fn complex<R: Real>(x: R, y: R) -> Complex<R> {
    Complex { re: x, im: y }
}

/// The unit number of angle `theta`: turns a vector of a body's frame into the world's.
#[inline]
pub fn cis<R: Real>(theta: R) -> Complex<R> {
    let (s, c) = theta.sin_cos();
    complex(c, s)
}

/// `i z`: the vector `z` turned by a right angle (the paper's `z^⊥`).
#[inline]
pub fn perp<R: Real>(z: Complex<R>) -> Complex<R> {
    complex(-z.im, z.re)
}

/// Magnitude without overflow.
#[inline]
pub fn cabs<R: Real>(z: Complex<R>) -> R {
    z.re.hypot(z.im)
}

/// Scalar product of two vectors.
#[inline]
pub fn dot<R: Real>(a: Complex<R>, b: Complex<R>) -> R {
    a.re * b.re + a.im * b.im
}

/// Exponential.
pub fn cexp<R: Real>(z: Complex<R>) -> Complex<R> {
    cis(z.im) * z.re.exp()
}

/// `exp(z) - 1` to relative accuracy near 0.
pub fn cexpm1<R: Real>(z: Complex<R>) -> Complex<R> {
    let (s, c) = z.im.sin_cos();
    let half = (z.im * R::HALF).sin();
    // e^x cos y - 1 = (e^x - 1) cos y - 2 sin²(y/2)
    complex(z.re.expm1() * c - R::TWO * half * half, z.re.exp() * s)
}

/// Principal `ln(z)`.
pub fn cln<R: Real>(z: Complex<R>) -> Complex<R> {
    complex(cabs(z).ln(), z.im.atan2(z.re))
}

/// Principal `ln(1 + z)` to relative accuracy near 0.
pub fn cln_1p<R: Real>(z: Complex<R>) -> Complex<R> {
    // |1+z|² - 1 = 2x + x² + y²
    let m = z.re * (R::TWO + z.re) + z.im * z.im;
    complex(m.ln_1p() * R::HALF, z.im.atan2(R::one() + z.re))
}

/// Principal arc tangent, to relative accuracy near 0.
pub fn catan<R: Real>(z: Complex<R>) -> Complex<R> {
    let square = z * z;
    // Below a tenth eight terms of the series reach rounding.
    if square.re * square.re + square.im * square.im < R::lit(1e-4) {
        let mut sum = complex(R::lit(1.0 / 15.0), R::zero());
        for k in [13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
            sum = complex(R::lit(1.0 / k), R::zero()) - sum * square;
        }
        return z * sum;
    }
    let (x, y) = (z.re, z.im);
    let below = R::one() - y;
    let re = (x + x).atan2((R::one() + y) * below - x * x) * R::HALF;
    complex(re, (R::lit(4.0) * y / (x * x + below * below)).ln_1p() / R::lit(4.0))
}

/// Principal square root.
pub fn csqrt<R: Real>(z: Complex<R>) -> Complex<R> {
    let m = cabs(z);
    if m == R::zero() {
        return Complex::default();
    }
    if z.re >= R::zero() {
        let s = ((m + z.re) * R::HALF).sqrt();
        complex(s, z.im / (R::TWO * s))
    } else {
        let s = ((m - z.re) * R::HALF).sqrt();
        let s = if z.im < R::zero() { -s } else { s };
        complex(z.im / (R::TWO * s), s)
    }
}

/// Complex sine and cosine.
pub fn csin_cos<R: Real>(z: Complex<R>) -> (Complex<R>, Complex<R>) {
    let (s, c) = z.re.sin_cos();
    let (sh, ch) = (z.im.sinh(), z.im.cosh());
    (complex(s * ch, c * sh), complex(c * ch, -s * sh))
}
