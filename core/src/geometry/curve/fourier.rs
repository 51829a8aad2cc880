//! Outline given by a finite Fourier sum: an entire function of the parameter.

use crate::base::complex::{Complex, cexp, cexpm1, cis, complex, perp};
use crate::base::scalar::Real;

/// γ(t) = Σ cⱼ e^(i kⱼ t), modes kⱼ = centre + stride (j − down) for j = 0, 1, ….
#[derive(Clone, Copy, Debug)]
pub struct Fourier<'a, R> {
    pub(super) centre: R,
    pub(super) stride: R,
    /// Number of modes below the centre.
    pub(super) down: usize,
    /// Real and imaginary parts in turn.
    pub(super) coefficients: &'a [R],
}

impl<'a, R: Real> Fourier<'a, R> {
    /// Number of modes.
    pub fn len(&self) -> usize {
        self.coefficients.len() / 2
    }

    /// Has no modes.
    pub fn is_empty(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// Mode numbers and coefficients.
    pub fn modes(&self) -> impl Iterator<Item = (R, Complex<R>)> + 'a {
        let (centre, stride, down) = (self.centre, self.stride, R::count(self.down));
        let pairs = self.coefficients.as_chunks::<2>().0.iter().enumerate();
        pairs.map(move |(j, &[re, im])| (centre + stride * (R::count(j) - down), complex(re, im)))
    }

    /// Coefficients from the centre upwards, and from below the centre downwards. Powers then start at the largest
    /// coefficients and lose accuracy only towards the small ones.
    fn branches(&self) -> [(R, R, impl Iterator<Item = Complex<R>> + 'a); 2] {
        let pairs = self.coefficients.as_chunks::<2>().0;
        let (low, high) = pairs.split_at_checked(self.down).unwrap_or((&[], &[]));
        // One type for both directions: exactly one of the two parts is empty.
        let walk =
            |up: &'a [[R; 2]], down: &'a [[R; 2]]| up.iter().chain(down.iter().rev()).map(|&[re, im]| complex(re, im));
        [(self.centre, self.stride, walk(high, &[])), (self.centre - self.stride, -self.stride, walk(&[], low))]
    }

    /// Sums with the powers of `z(k) = e^(ikt)`.
    fn sum(&self, z: impl Fn(R) -> Complex<R>) -> [Complex<R>; 3] {
        let mut jet = [Complex::default(); 3];
        for (start, stride, coefficients) in self.branches() {
            let (mut k, mut power, ratio) = (start, z(start), z(stride));
            for c in coefficients {
                let term = c * power;
                let first = perp(term * k);
                jet[0] += term;
                jet[1] += first;
                jet[2] += perp(first * k);
                k += stride;
                power *= ratio;
            }
        }
        jet
    }

    pub(super) fn jet(&self, t: Complex<R>) -> [Complex<R>; 3] {
        self.sum(|k| cexp(perp(t * k)))
    }

    pub(super) fn jet_real(&self, t: R) -> [Complex<R>; 3] {
        self.sum(|k| cis(t * k))
    }

    pub(super) fn delta(&self, t: R, u: Complex<R>) -> Complex<R> {
        let mut sum = Complex::default();
        for (start, stride, coefficients) in self.branches() {
            let (mut power, ratio) = (cis(t * start), cis(t * stride));
            // e^(iku) − 1 from mode to mode: relative accuracy in u is kept.
            let (mut change, step) = (cexpm1(perp(u * start)), cexpm1(perp(u * stride)));
            for c in coefficients {
                sum += c * power * change;
                power *= ratio;
                change = change * step + change + step;
            }
        }
        sum
    }
}
