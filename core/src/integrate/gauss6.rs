//! The implicit Runge–Kutta method of Gauss and Legendre with three stages, of order 6.
//!
//! Tested by the tests at its end, `integrate/tests/implicit.rs`, `tests/integrators`.

use super::fixed_step::{FixedStep, add_increment, check_step};
use super::system::{Counters, System, all_finite, evaluate};
use crate::base::fields::Fields;
use crate::base::memory::{buffers, copy};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};

/// Gauss–Legendre Runge–Kutta with three stages (Hairer, Lubich & Wanner 2006, sections II.1.3, VIII.6): order 6,
/// symmetric in time. On motions that can be run backwards its energy error neither grows nor decays.
///
/// The equations of the stages are solved by fixed-point iteration, until rounding stops it; it begins with the
/// polynomial through the five rates known from the last step, and takes three evaluations a sweep. The state is summed with compensation, and the rounded coefficients
/// satisfy the conditions of consistency and symmetry exactly: what is left of the energy's error is the random
/// walk of rounding.
#[derive(Clone, Copy, Debug)]
pub struct Gauss6<R> {
    past: FixedStep<R>,
}

/// Sweeps after which a step is given up.
const MAX_SWEEPS: usize = 50;

/// c₃ − ½ = √15/10.
const REACH: f64 = 0.387_298_334_620_741_7;
/// b₁ = 5/18, a₂₁ = 5/36 + √15/24, a₃₂ = 2/9 + √15/15, a₃₁ = 5/36 + √15/30; the rest follow by symmetry.
const B1: f64 = 5.0 / 18.0;
const A21: f64 = 0.300_263_194_980_864_6;
const A32: f64 = 0.480_421_111_969_383_35;
const A31: f64 = 0.267_988_333_762_469_45;
/// Weights that extrapolate to the three stages from the rates at −1 (beginning of the last step), at its stages,
/// and at 0 (its end): exact for polynomials of degree 4.
const EXTRAPOLATE: [[f64; 5]; 3] = [
    [
        0.311_293_261_238_465_44,
        -0.577_294_217_002_301_7,
        0.753_768_758_431_508_9,
        -2.561_160_986_661_637,
        3.073_393_183_993_964,
    ],
    [8.5, -15.317_541_634_481_458, 17.0, -34.682_458_365_518_54, 25.5],
    [
        43.688_706_738_761_53,
        -77.438_839_013_338_36,
        79.246_231_241_568_5,
        -137.422_705_782_997_7,
        92.926_606_816_006_04,
    ],
];

buffers! {
    struct Buffers(dim: usize) {
        /// The part of the state that it cannot hold.
        rest: R = *dim,
        /// Rate at the beginning of the last step, and at its stages.
        before: R = *dim, past1: R = *dim, past2: R = *dim, past3: R = *dim,
        /// Rate at the present state, and at the stages.
        rate: R = *dim, stage1: R = *dim, stage2: R = *dim, stage3: R = *dim,
        trial: R = *dim, trial_rate: R = *dim,
        /// Largest change of a stage's rate by this sweep, and the least of all sweeps so far.
        change: R = *dim, least: R = *dim,
    }
}

impl<R: Real> Default for Gauss6<R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real> Gauss6<R> {
    /// A new integrator.
    pub fn new() -> Self {
        Gauss6 { past: FixedStep::new() }
    }

    /// Every field, in order.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>) {
        let Gauss6 { past } = self;
        past.each(io, 1);
    }

    /// Numbers of memory for `dim` unknowns; `None` if that cannot be addressed.
    pub fn memory_len(dim: usize) -> Option<usize> {
        Buffers::<R>::len(&dim)
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.past.counters
    }

    /// Forgets the past rates and the rest of the state: to be called when the state was changed from outside
    /// or the right-hand side jumped.
    pub fn reset(&mut self) {
        self.past.reset();
    }

    /// Forgets the past rates, as [`reset`](Self::reset) does, but keeps the rest of the state: to be called when the right-hand side
    /// jumped and the state did not.
    pub fn jump(&mut self) {
        self.past.jump();
    }

    /// Advances `y` from `t` to `t + h`; `h` may be negative.
    ///
    /// # Errors
    /// `NoConvergence` if the stages are not found in 50 sweeps: the step is too long for this method. Those of
    /// the right-hand side; `NonFiniteState`, `NotFinite`, `BadStep`, `StepTooSmall`, `Length`, `MemoryTooSmall`. `y` is then as
    /// it was, bit for bit.
    pub fn step<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &mut [R],
        memory: &mut [R],
    ) -> Result<()> {
        check_step(system, t, h, y)?;
        let mut b = Buffers::take(&y.len(), &mut { memory })?;
        let known = self.past.begin(h, b.rest) > 0;
        evaluate(system, &mut self.past.counters, t, y, b.rate)?;
        let solved = if known {
            b.extrapolate();
            self.solve(system, t, h, y, &mut b)
        } else {
            Err(Status::NoConvergence.into())
        };
        // Extrapolated stages may lie where there is no rate, or too far away.
        if let Err(e) = solved {
            if known && !super::system::recoverable(&e) && e.status != Status::NoConvergence {
                return Err(e);
            }
            for stage in [&mut b.stage1, &mut b.stage2, &mut b.stage3] {
                copy(stage, b.rate);
            }
            self.solve(system, t, h, y, &mut b)?;
        }
        let [b1, b2] = weights::<R>();
        let stages = b.stage1.iter().zip(&*b.stage2).zip(&*b.stage3);
        for (d, ((f1, f2), f3)) in b.trial.iter_mut().zip(stages) {
            *d = h * (b1 * (*f1 + *f3) + b2 * *f2);
        }
        add_increment(y, b.rest, b.trial)?;
        copy(b.before, b.rate);
        copy(b.past1, b.stage1);
        copy(b.past2, b.stage2);
        copy(b.past3, b.stage3);
        self.past.end(h, usize::from(known), 1, false);
        Ok(())
    }

    /// Finds the rates of the stages from a first guess of them.
    fn solve<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &[R],
        b: &mut Buffers<'_, R>,
    ) -> Result<()> {
        let reach = R::lit(REACH);
        let nodes = [R::HALF - reach, R::HALF, R::HALF + reach];
        let rows = rows::<R>();
        b.least.fill(R::MAX);
        for _ in 0..MAX_SWEEPS {
            b.change.fill(R::zero());
            for (stage, (c, [a1, a2, a3])) in nodes.into_iter().zip(rows).enumerate() {
                let known = y.iter().zip(&*b.rest).zip(b.stage1.iter().zip(&*b.stage2).zip(&*b.stage3));
                for (trial, ((y, rest), ((f1, f2), f3))) in b.trial.iter_mut().zip(known) {
                    *trial = *y + (*rest + h * ((a1 * *f1 + a2 * *f2) + a3 * *f3));
                }
                all_finite(b.trial, Status::NonFiniteState, "state")?;
                evaluate(system, &mut self.past.counters, t + c * h, b.trial, b.trial_rate)?;
                let rates = match stage {
                    0 => &mut *b.stage1,
                    1 => &mut *b.stage2,
                    _ => &mut *b.stage3,
                };
                for ((change, old), new) in b.change.iter_mut().zip(rates.iter_mut()).zip(&*b.trial_rate) {
                    *change = change.max((*new - *old).abs());
                    *old = *new;
                }
            }
            // As long as any unknown comes closer, whatever its unit: then rounding is all that is left, or
            // nothing converges.
            let mut closer = false;
            for (least, change) in b.least.iter_mut().zip(&*b.change) {
                closer |= *change < R::lit(0.9) * *least;
                *least = least.min(*change);
            }
            if !closer {
                break;
            }
        }
        b.settled(system, h, y)
    }
}

impl<R: Real> Buffers<'_, R> {
    /// First guess of the stages' rates from those of the last step.
    fn extrapolate(&mut self) {
        let past = self.before.iter().zip(&*self.past1).zip(&*self.past2).zip(&*self.past3).zip(&*self.rate);
        let stages = self.stage1.iter_mut().zip(&mut *self.stage2).zip(&mut *self.stage3);
        for (((s1, s2), s3), ((((f0, f1), f2), f3), f4)) in stages.zip(past) {
            for (stage, [w0, w1, w2, w3, w4]) in [s1, s2, s3].into_iter().zip(EXTRAPOLATE) {
                let old = R::lit(w0) * *f0 + R::lit(w1) * *f1 + R::lit(w2) * *f2;
                *stage = old + (R::lit(w3) * *f3 + R::lit(w4) * *f4);
            }
        }
    }

    /// Refuses stages that still move by more than rounding, which errors of the right-hand side may enlarge. Unknowns are
    /// compared in units of their scales, and 1 is then as large as the largest of them at least.
    fn settled<S: System<R> + ?Sized>(&self, system: &S, h: R, y: &[R]) -> Result<()> {
        let (mut change, mut size) = (R::zero(), R::zero());
        for (i, ((y, f), c)) in y.iter().zip(&*self.rate).zip(&*self.change).enumerate() {
            let (scale, least) = system.scale(i, h).map_or((R::one(), R::zero()), |scale| (scale, R::one()));
            change = change.max((h * *c).abs() / scale);
            size = size.max(y.abs().max((h * *f).abs()) / scale).max(least);
        }
        let allowed = size * R::EPSILON.powf(R::lit(2.0 / 3.0));
        if change <= allowed { Ok(()) } else { Err(Error::new(Status::NoConvergence).of("step", h.to_f64())) }
    }
}

/// b₁ = b₃ and b₂ = 1 − 2 b₁, a difference without rounding.
fn weights<R: Real>() -> [R; 2] {
    let b1 = R::lit(B1);
    [b1, R::one() - R::TWO * b1]
}

/// The matrix of the method. aᵢⱼ + aⱼᵢ of opposite stages is bⱼ exactly, since no difference here is rounded.
fn rows<R: Real>() -> [[R; 3]; 3] {
    let [b1, b2] = weights::<R>();
    let (a21, a32, a31) = (R::lit(A21), R::lit(A32), R::lit(A31));
    let (half1, half2) = (b1 * R::HALF, b2 * R::HALF);
    [[half1, b2 - a32, b1 - a31], [a21, half2, b1 - a21], [a31, a32, half1]]
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    /// y' = −k y.
    struct Decay(f64);

    impl System<f64> for Decay {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _: f64, y: &[f64], dydt: &mut [f64]) -> Result<()> {
            dydt[0] = -self.0 * y[0];
            Ok(())
        }
    }

    #[test]
    fn stages_are_found_or_not_whatever_the_unit_of_the_unknowns() {
        // The sweeps contract by h k or so, whatever the size of y.
        for unit in [1e-200, 1e-30, 1e-9, 1.0, 1e9, 1e200] {
            for (k, settles) in [(1.0, true), (40.0, false)] {
                let (mut y, mut memory) = ([unit], std::vec![0.0; Gauss6::<f64>::memory_len(1).unwrap()]);
                let told = Gauss6::new().step(&mut Decay(k), 0.0, 0.1, &mut y, &mut memory);
                assert_eq!(told.err().map(|e| e.status), (!settles).then_some(Status::NoConvergence), "{unit:e}, {k}");
                let exact = if settles { (-0.1 * k).exp() } else { 1.0 };
                assert!((y[0] / unit - exact).abs() < 1e-12, "{unit:e}: {}", y[0] / unit);
            }
        }
    }

    fn sums_are_exact<R: Real>() {
        let ([b1, b2], a) = (weights::<R>(), rows::<R>());
        assert_eq!(R::TWO * b1 + b2, R::one());
        for i in 0..3 {
            for (j, b) in [b1, b2, b1].into_iter().enumerate() {
                // Both conversions to f64 and, for f32, the sum are exact.
                assert_eq!(a[i][j].to_f64() + a[2 - i][2 - j].to_f64(), b.to_f64());
            }
        }
    }

    #[test]
    fn rounded_coefficients_are_consistent_and_symmetric_exactly() {
        sums_are_exact::<f32>();
        sums_are_exact::<f64>();
    }

    #[test]
    fn coefficients_satisfy_the_order_conditions_of_collocation() {
        let c = [0.5 - REACH, 0.5, 0.5 + REACH];
        let ([b1, b2], a) = (weights::<f64>(), rows::<f64>());
        for k in 1..=6 {
            let sum: f64 = [b1, b2, b1].iter().zip(c).map(|(b, c)| b * c.powi(k - 1)).sum();
            assert!((sum - 1.0 / f64::from(k)).abs() < 2e-16);
        }
        for (a, c_i) in a.iter().zip(c) {
            for k in 1..=3 {
                let sum: f64 = a.iter().zip(c).map(|(a, c)| a * c.powi(k - 1)).sum();
                assert!((sum - c_i.powi(k) / f64::from(k)).abs() < 2e-16);
            }
        }
    }

    #[test]
    fn extrapolation_is_exact_for_degree_4() {
        let c = [0.5 - REACH, 0.5, 0.5 + REACH];
        let nodes = [-1.0, c[0] - 1.0, c[1] - 1.0, c[2] - 1.0, 0.0];
        for (weights, x) in EXTRAPOLATE.iter().zip(c) {
            for k in 0..=4 {
                let sum: f64 = weights.iter().zip(nodes).map(|(w, x)| w * f64::powi(x, k)).sum();
                assert!((sum - x.powi(k)).abs() < 2e-13, "{k} {sum}");
            }
        }
    }
}
