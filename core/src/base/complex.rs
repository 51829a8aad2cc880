//! Points and vectors of the plane as complex numbers, and the few complex functions the numerics need.

use crate::base::scalar::Real;

/// Complex numbers carry points and vectors of the plane: `x + i y`.
pub type Complex<R> = nalgebra::Complex<R>;

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

/// Principal arc tangent, to relative accuracy near 0: what [`crate::base::elementary`]'s is compared with.
#[cfg(test)]
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
