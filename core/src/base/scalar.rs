//! The scalar types of the library, `f32` and `f64`, sealed.
//!
//! Every transcendental function goes through `libm`, with and without `std`, so that each gives the
//! same bits whichever features it was built with.

use crate::base::bits::Bits;
pub use crate::base::index::Index;
use crate::base::machine::Vectors;
use core::fmt::{Debug, Display};
use core::ops::Neg;
use num_traits::NumAssign;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A family of types, one for each scalar.
#[doc(hidden)]
pub trait Of {
    type With<R: Real>;
}

/// A member of a family, its scalar known.
#[doc(hidden)]
pub enum Which<T: Of> {
    Double(T::With<f64>),
    Single(T::With<f32>),
}

/// Scalar type of a model: `f32` or `f64`. Sealed.
pub trait Real:
    sealed::Sealed
    + Vectors
    + Bits
    + bytemuck::Pod
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
    /// Whole numbers of the same size.
    type Index: Index;
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

    /// Tells which scalar this is.
    #[doc(hidden)]
    fn which<T: Of>(x: T::With<Self>) -> Which<T>;

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
    ($t:ident, $index:ident, $which:ident, $sqrt:ident, $sincos:ident, $exp:ident, $expm1:ident, $ln:ident, $ln1p:ident, $atan2:ident, $pow:ident,
     $hypot:ident, $floor:ident) => {
        impl Real for $t {
            type Index = $index;
            #[inline(always)]
            fn which<T: Of>(x: T::With<Self>) -> Which<T> {
                Which::$which(x)
            }
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
real!(f64, u64, Double, sqrt, sincos, exp, expm1, log, log1p, atan2, pow, hypot, floor);
real!(f32, u32, Single, sqrtf, sincosf, expf, expm1f, logf, log1pf, atan2f, powf, hypotf, floorf);
