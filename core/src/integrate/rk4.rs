//! The classical Runge–Kutta method of order 4.
//!
//! Tested by `integrate/tests/accuracy.rs`, `integrate/tests/estimates.rs`, `tests/integrators`.

use super::fixed_step::{FixedStep, add_increment, check_step};
use super::system::{Counters, System, all_finite, evaluate};
use crate::base::fields::Fields;
use crate::base::memory::{axpy, buffers, copy, part};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};

/// The classical Runge–Kutta method: four evaluations a step, local error O(h⁵).
///
/// The error of a step is estimated when the next one begins and the rate at its end is known: by the
/// difference from the Adams–Moulton formula of order 7, through the rates of seven equal steps. It costs no
/// evaluation, and is exact as the step tends to 0. For steps that are not followed by as many equal ones there is
/// [`Rk4::rough_error`].
#[derive(Clone, Copy, Debug)]
pub struct Rk4<R> {
    past: FixedStep<R>,
    /// Has a step been made since the start or a jump?
    made: bool,
}

/// Earlier rates that the error estimate needs.
const PAST: usize = 6;
/// 60480 times the weights of the Adams–Moulton formula of order 7, the newest rate first.
const MOULTON: [f64; PAST + 1] = [19087.0, 65112.0, -46461.0, 37504.0, -20211.0, 6312.0, -863.0];

buffers! {
    struct Buffers(dim: usize) {
        /// Estimated error of the step before the last.
        error: R = *dim,
        /// The part of the state that it cannot hold.
        rest: R = *dim,
        /// Rough error of the last step.
        rough: R = *dim,
        /// What the last step added to the state.
        increment: R = *dim,
        /// Rates at the beginning of the last steps, the newest first.
        past: R = dim.saturating_mul(PAST),
        first: R = *dim, stage: R = *dim, rate: R = *dim, sum: R = *dim,
    }
}

impl<R: Real> Default for Rk4<R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real> Rk4<R> {
    /// A new integrator.
    pub fn new() -> Self {
        Rk4 { past: FixedStep::new(), made: false }
    }

    /// Every field, in order.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>) {
        let Rk4 { past, made } = self;
        io.flag("made", made);
        past.each(io, PAST);
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
        self.made = false;
    }

    /// Forgets the past rates, as [`reset`](Self::reset) does, but keeps the rest of the state: to be called when the right-hand side
    /// jumped and the state did not.
    pub fn jump(&mut self) {
        self.past.jump();
        self.made = false;
    }

    /// Estimated local error of the step before the last, unknown by unknown. `None` until there were six
    /// equal steps before it.
    pub fn error<'m>(&self, dim: usize, memory: &'m [R]) -> Option<&'m [R]> {
        self.past.estimated.then(|| part(memory, 0, dim))
    }

    /// Upper estimate of the last step's error, unknown by unknown: the difference from an embedded formula of order 2, which is O(h³).
    /// `None` before the first step and after a jump.
    pub fn rough_error<'m>(&self, dim: usize, memory: &'m [R]) -> Option<&'m [R]> {
        self.made.then(|| part(memory, dim.saturating_mul(2), dim))
    }

    /// Advances `y` from `t` to `t + h`; `h` may be negative.
    ///
    /// # Errors
    /// Those of the right-hand side; `NonFiniteState`, `NotFinite`, `BadStep`, `StepTooSmall`, `Length`, `MemoryTooSmall`.
    /// `y` is then as it was, bit for bit.
    pub fn step<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &mut [R],
        memory: &mut [R],
    ) -> Result<()> {
        check_step(system, t, h, y)?;
        let dim = y.len();
        let b = Buffers::take(&dim, &mut { memory })?;
        let known = self.past.begin(h, b.rest);
        evaluate(system, &mut self.past.counters, t, y, b.first)?;
        let estimated = known == PAST;
        if estimated {
            b.error.fill(R::zero());
            let rates = core::iter::once(&*b.first).chain(b.past.chunks_exact(dim.max(1)));
            for (weight, rate) in MOULTON.iter().zip(rates) {
                axpy(b.error, R::lit(-weight / 60480.0), rate);
            }
            for (e, d) in b.error.iter_mut().zip(&*b.increment) {
                *e = *d + h * *e;
            }
        }
        copy(b.sum, b.first);
        copy(b.rate, b.first);
        later_stages(system, &mut self.past.counters, t, h, y, b.stage, b.rate, b.sum)?;
        let quarter = h * R::lit(0.25);
        let rough =
            b.first.iter().zip(&*b.rate).zip(&*b.sum).map(|((k1, k4), sum)| quarter * (*k1 + *k4) - R::HALF * *sum);
        add_increment(y, b.rest, b.sum)?;
        for (e, x) in b.rough.iter_mut().zip(rough) {
            *e = x;
        }
        self.made = true;
        copy(b.increment, b.sum);
        // One step on: every rate takes the place of the next older one.
        for block in b.past.chunks_exact_mut(dim.max(1)) {
            for (newer, older) in b.first.iter_mut().zip(block) {
                core::mem::swap(newer, older);
            }
        }
        self.past.end(h, known, PAST, estimated);
        Ok(())
    }
}

/// The last three stages, given the first rate in both `rate` and `sum`; leaves the increment of the state in
/// `sum`.
pub(super) fn later_stages<R: Real, S: System<R> + ?Sized>(
    system: &mut S,
    counters: &mut Counters,
    t: R,
    h: R,
    y: &[R],
    stage: &mut [R],
    rate: &mut [R],
    sum: &mut [R],
) -> Result<()> {
    let half = h * R::HALF;
    for (reach, weight) in [(half, R::TWO), (half, R::TWO), (h, R::one())] {
        copy(stage, y);
        axpy(stage, reach, rate);
        all_finite(stage, Status::NonFiniteState, "state")?;
        evaluate(system, counters, t + reach, stage, rate)?;
        axpy(sum, weight, rate);
    }
    let sixth = h / R::lit(6.0);
    for s in sum.iter_mut() {
        *s *= sixth;
    }
    Ok(())
}
