//! Adams–Bashforth–Moulton of order 4 with a fixed step.
//!
//! Tested by `integrate/tests/accuracy.rs`, `integrate/tests/estimates.rs`, `tests/integrators`.

use super::fixed_step::{FixedStep, add_increment, check_step};
use super::rk4::later_stages;
use super::system::{Counters, System, all_finite, evaluate};
use crate::base::fields::Fields;
use crate::base::memory::{buffers, copy, part};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};

/// Predicts by Adams–Bashforth 4, evaluates, corrects by Adams–Moulton 4 and evaluates (PECE): two
/// evaluations a step, local error O(h⁵). The first three steps are Runge–Kutta 4.
#[derive(Clone, Copy, Debug)]
pub struct Abm4<R> {
    past: FixedStep<R>,
    /// Has a step been made since the start or a jump?
    made: bool,
}

buffers! {
    struct Buffers(dim: usize) {
        /// Estimated error of the last step.
        error: R = *dim,
        /// The part of the state that it cannot hold.
        rest: R = *dim,
        /// Rate at the present state.
        rate: R = *dim,
        /// Rates one, two and three steps ago.
        past1: R = *dim, past2: R = *dim, past3: R = *dim,
        trial: R = *dim, trial_rate: R = *dim, sum: R = *dim,
    }
}

impl<R: Real> Default for Abm4<R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real> Abm4<R> {
    /// A new integrator.
    pub fn new() -> Self {
        Abm4 { past: FixedStep::new(), made: false }
    }

    /// Every field, in order.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>) {
        let Abm4 { past, made } = self;
        io.flag("made", made);
        past.each(io, 3);
    }

    /// Numbers of memory for `dim` unknowns; `None` if that cannot be addressed.
    pub fn memory_len(dim: usize) -> Option<usize> {
        Buffers::<R>::len(&dim)
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.past.counters
    }

    /// Forgets the past rates: to be called when the state was changed from outside or the right-hand
    /// side jumped. The next three steps are Runge–Kutta again.
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

    /// Estimated local error of the last step, unknown by unknown, by Milne's device: 19/270 of the difference
    /// of corrector and predictor. `None` after a Runge–Kutta step.
    pub fn error<'m>(&self, dim: usize, memory: &'m [R]) -> Option<&'m [R]> {
        self.past.estimated.then(|| part(memory, 0, dim))
    }

    /// Upper estimate of the last step's error if it was a Runge–Kutta step, as [`super::Rk4::rough_error`].
    pub fn rough_error<'m>(&self, dim: usize, memory: &'m [R]) -> Option<&'m [R]> {
        (self.made && !self.past.estimated).then(|| part(memory, 0, dim))
    }

    /// Advances `y` from `t` to `t + h`; `h` may be negative. A step that differs from the last one
    /// starts anew, as after [`reset`](Self::reset).
    ///
    /// # Errors
    /// Those of the right-hand side; `NonFiniteState`, `NotFinite`, `BadStep`, `StepTooSmall`, `Length`, `MemoryTooSmall`.
    /// `y` and the past rates are then as they were, bit for bit.
    pub fn step<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &mut [R],
        memory: &mut [R],
    ) -> Result<()> {
        check_step(system, t, h, y)?;
        let b = Buffers::take(&y.len(), &mut { memory })?;
        let known = self.past.begin(h, b.rest);
        // The second evaluation of PECE, at the corrected state, is made when the next step begins.
        evaluate(system, &mut self.past.counters, t, y, b.rate)?;
        if known < 3 {
            copy(b.trial_rate, b.rate);
            copy(b.sum, b.rate);
            later_stages(system, &mut self.past.counters, t, h, y, b.trial, b.trial_rate, b.sum)?;
            let quarter = h * R::lit(0.25);
            for (e, ((k1, k4), sum)) in b.error.iter_mut().zip(b.rate.iter().zip(&*b.trial_rate).zip(&*b.sum)) {
                *e = quarter * (*k1 + *k4) - R::HALF * *sum;
            }
        } else {
            let h24 = h / R::lit(24.0);
            let past = || b.rate.iter().zip(&*b.past1).zip(&*b.past2).zip(&*b.past3);
            for (((p, y), sum), (((f0, f1), f2), f3)) in b.trial.iter_mut().zip(&*y).zip(&mut *b.sum).zip(past()) {
                *sum = h24 * ((R::lit(55.0) * *f0 - R::lit(59.0) * *f1) + (R::lit(37.0) * *f2 - R::lit(9.0) * *f3));
                *p = *y + *sum;
            }
            all_finite(b.trial, Status::NonFiniteState, "state")?;
            evaluate(system, &mut self.past.counters, t + h, b.trial, b.trial_rate)?;
            let milne = R::lit(19.0 / 270.0);
            for (((e, sum), f), (((f0, f1), f2), _)) in
                b.error.iter_mut().zip(&mut *b.sum).zip(&*b.trial_rate).zip(past())
            {
                let moulton = h24 * ((R::lit(9.0) * *f + R::lit(19.0) * *f0) + (*f2 - R::lit(5.0) * *f1));
                *e = milne * (moulton - *sum);
                *sum = moulton;
            }
        }
        add_increment(y, b.rest, b.sum)?;
        copy(b.past3, b.past2);
        copy(b.past2, b.past1);
        copy(b.past1, b.rate);
        self.past.end(h, known, 3, known == 3);
        self.made = true;
        Ok(())
    }
}
