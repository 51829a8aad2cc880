//! A Fourier sum at even parameters, all at once: by the fast transform where there is one, else one by one.
//!
//! Tested by the test at its end.

use super::Fourier;
use crate::base::complex::Complex;
use crate::base::scalar::Real;

/// A curve at `count` even parameters.
pub(super) struct Even<'a, R> {
    curve: Fourier<'a, R>,
    count: usize,
    #[cfg(feature = "fft")]
    jets: alloc::vec::Vec<[Complex<R>; 3]>,
}

impl<'a, R: Real> Even<'a, R> {
    pub(super) fn new(curve: Fourier<'a, R>, count: usize) -> Self {
        Even {
            curve,
            count,
            #[cfg(feature = "fft")]
            jets: transformed(&curve, count),
        }
    }

    /// γ, γ′, γ″ at 2πi/count.
    pub(super) fn jet(&self, i: usize) -> [Complex<R>; 3] {
        let i = if i < self.count { i } else { i - self.count };
        #[cfg(feature = "fft")]
        if let Some(jet) = self.jets.get(i) {
            return *jet;
        }
        self.curve.jet_real(R::TAU * R::count(i) / R::count(self.count.max(1)))
    }
}

/// Products of modes and places from which on the transform pays.
#[cfg(feature = "fft")]
const MANY: usize = 1 << 20;

/// All of them, or nothing where they are few, or memory is short.
#[cfg(feature = "fft")]
fn transformed<R: Real>(curve: &Fourier<'_, R>, count: usize) -> alloc::vec::Vec<[Complex<R>; 3]> {
    use crate::base::complex::{complex, perp};
    use crate::base::memory::{filled, room};
    use alloc::vec::Vec;
    use rustfft::num_complex::Complex as Pair;
    if curve.modes().count().saturating_mul(count) < MANY {
        return Vec::new();
    }
    let (Ok(mut data), Ok(mut jets)) = (filled::<[Pair<f64>; 3]>(count), room(count)) else { return Vec::new() };
    for (k, c) in curve.modes() {
        let (k, c) = (k.to_f64(), Pair { re: c.re.to_f64(), im: c.im.to_f64() });
        // On the grid a mode is what its number is modulo the count.
        let place = (k as i64).rem_euclid(count as i64) as usize;
        if let Some(slots) = data.get_mut(place) {
            for (slot, factor) in slots.iter_mut().zip([1.0, k, k * k]) {
                *slot += c * factor;
            }
        }
    }
    let plan = rustfft::FftPlanner::new().plan_fft_inverse(count);
    let sums = [0, 1, 2].map(|which| {
        let mut sum: Vec<_> = data.iter().filter_map(|slots| slots.get(which).copied()).collect();
        plan.process(&mut sum);
        sum
    });
    let of = |z: &Pair<f64>| complex(R::lit(z.re), R::lit(z.im));
    let [value, first, second] = &sums;
    jets.extend(value.iter().zip(first).zip(second).map(|((v, d), dd)| [of(v), perp(of(d)), -of(dd)]));
    jets
}

#[cfg(all(test, feature = "fft"))]
mod tests {
    extern crate std;
    use super::*;
    use crate::base::complex::cabs;
    use std::vec::Vec;

    #[test]
    fn the_transform_gives_the_sums() {
        // 801 modes on fewer, and on more places.
        let coefficients: Vec<f64> =
            (0..1602).map(|i| f64::sin((i * i) as f64) / (1.0 + (i as f64 / 2.0 - 400.0).abs())).collect();
        let curve = Fourier { centre: 1.0, stride: 1.0, down: 401, coefficients: &coefficients };
        for count in [1500, 4096] {
            let even = Even::new(curve, count);
            assert_eq!(even.jets.len(), count);
            for i in (0..=count).step_by(97) {
                let exact = curve.jet_real(f64::TAU * i as f64 / count as f64);
                for (k, (a, b)) in even.jet(i).into_iter().zip(exact).enumerate() {
                    assert!(cabs(a - b) < 1e-12 * 400.0_f64.powi(k as i32), "{count} {i} {k}");
                }
            }
        }
    }
}
