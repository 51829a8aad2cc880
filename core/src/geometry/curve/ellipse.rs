//! Ellipse about the origin, in the eccentric angle.

use crate::base::complex::{Complex, complex, csin_cos, csqrt, perp};
use crate::base::scalar::Real;
use crate::geometry::curve::AreaProperties;

/// γ(t) = a cos t + i b sin t, with a, b > 0 in any order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse<R> {
    /// Semi-axis along x.
    pub a: R,
    /// Semi-axis along y.
    pub b: R,
}

impl<R: Real> Ellipse<R> {
    fn combine(&self, s: Complex<R>, c: Complex<R>) -> [Complex<R>; 3] {
        let x = c * self.a + perp(s * self.b);
        [x, s * -self.a + perp(c * self.b), -x]
    }

    /// W = e^(it) of the preimage t of z: the root of (a + b) W/2 + (a − b)/(2W) = z of larger magnitude, which is the one next
    /// to the outline.
    pub(crate) fn preimage(&self, z: Complex<R>) -> Complex<R> {
        let (sum, difference) = (self.a + self.b, self.a - self.b);
        // √(z² − c²) on the branch next to z.
        let root = z * csqrt(complex(R::one(), R::zero()) - complex(sum * difference, R::zero()) / (z * z));
        let w = (z + root) / sum;
        if w.re.is_finite() && w.im.is_finite() { w } else { csqrt(complex(difference / sum, R::zero())) }
    }

    pub(super) fn jet(&self, t: Complex<R>) -> [Complex<R>; 3] {
        let (s, c) = csin_cos(t);
        self.combine(s, c)
    }

    pub(super) fn jet_real(&self, t: R) -> [Complex<R>; 3] {
        let (s, c) = t.sin_cos();
        let x = complex(self.a * c, self.b * s);
        [x, complex(-self.a * s, self.b * c), -x]
    }

    pub(super) fn delta(&self, t: R, u: Complex<R>) -> Complex<R> {
        let half = u * R::HALF;
        let (s, c) = csin_cos(half + t);
        (s * -self.a + perp(c * self.b)) * csin_cos(half).0 * R::TWO
    }

    /// In closed form; the perimeter by the arithmetic-geometric mean, which no aspect ratio slows down.
    pub(super) fn properties(&self) -> AreaProperties<R> {
        let (a, b) = (self.a.max(self.b), self.a.min(self.b));
        let area = R::PI * a * b;
        // In units of a, so that squares of large or small axes stay in range.
        let (mut m, mut g) = (R::one(), b / a);
        let mut sum = (R::one() - g) * (R::one() + g) * R::HALF;
        let mut power = R::HALF;
        for _ in 0..16 {
            let c = (m - g) * R::HALF;
            power *= R::TWO;
            sum += power * c * c;
            (m, g) = ((m + g) * R::HALF, (m * g).sqrt());
            if c <= R::EPSILON * R::HALF {
                break;
            }
        }
        AreaProperties {
            area,
            centroid: Complex::default(),
            polar_moment: area * (a * a + b * b) / R::lit(4.0),
            perimeter: R::TAU * a * (R::one() - sum) / m,
            reach: a,
        }
    }
}
