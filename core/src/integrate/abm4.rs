//! Adams–Bashforth–Moulton of order 4 with a fixed step.

use super::rk4::later_stages;
use super::{Counters, System, all_finite, check_step, evaluate};
use crate::scalar::Real;
use crate::status::{Result, Status};
use crate::workspace::{buffers, copy};

/// Predicts by Adams–Bashforth 4, evaluates, corrects by Adams–Moulton 4 and evaluates (PECE): two
/// evaluations a step, local error O(h⁵). The first three steps are Runge–Kutta 4.
#[derive(Clone, Copy, Debug)]
pub struct Abm4<R> {
    step: R,
    /// Number of earlier rates that are known, at most 3.
    known: usize,
    counters: Counters,
}

buffers! {
    struct Buffers(dim: usize) {
        /// Rate at the present state.
        rate: *dim,
        /// Rates one, two and three steps ago.
        past1: *dim, past2: *dim, past3: *dim,
        trial: *dim, trial_rate: *dim, sum: *dim,
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
        Abm4 { step: R::zero(), known: 0, counters: Counters::default() }
    }

    /// Numbers of work memory for `dim` unknowns; `None` if that cannot be addressed.
    pub fn work_len(dim: usize) -> Option<usize> {
        Buffers::<R>::len(&dim)
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Forgets the past rates: to be called when the state was changed from outside or the right-hand
    /// side jumped. The next three steps are Runge–Kutta again.
    pub fn reset(&mut self) {
        self.known = 0;
    }

    /// Advances `y` from `t` to `t + h`; `h` may be negative. A step that differs from the last one
    /// starts anew, as after [`reset`](Self::reset).
    ///
    /// # Errors
    /// Those of the right-hand side; `NonFiniteState`, `NotFinite`, `BadStep`, `Length`, `MemoryTooSmall`.
    /// `y` and the past rates are then as they were, bit for bit.
    pub fn step<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &mut [R],
        work: &mut [R],
    ) -> Result<()> {
        check_step(system, t, h, y)?;
        let b = Buffers::split(&y.len(), work)?;
        let known = if h == self.step { self.known } else { 0 };
        // The second evaluation of PECE, at the corrected state, is made when the next step begins.
        evaluate(system, &mut self.counters, t, y, b.rate)?;
        if known < 3 {
            copy(b.trial_rate, b.rate);
            copy(b.sum, b.rate);
            later_stages(system, &mut self.counters, t, h, y, b.trial, b.trial_rate, b.sum)?;
        } else {
            let h24 = h / R::lit(24.0);
            let past = || b.rate.iter().zip(&*b.past1).zip(&*b.past2).zip(&*b.past3);
            for ((p, y), (((f0, f1), f2), f3)) in b.trial.iter_mut().zip(&*y).zip(past()) {
                let bashforth = (R::lit(55.0) * *f0 - R::lit(59.0) * *f1) + (R::lit(37.0) * *f2 - R::lit(9.0) * *f3);
                *p = *y + h24 * bashforth;
            }
            evaluate(system, &mut self.counters, t + h, b.trial, b.trial_rate)?;
            for (((c, y), f), (((f0, f1), f2), _)) in b.trial.iter_mut().zip(&*y).zip(&*b.trial_rate).zip(past()) {
                let moulton = (R::lit(9.0) * *f + R::lit(19.0) * *f0) + (*f2 - R::lit(5.0) * *f1);
                *c = *y + h24 * moulton;
            }
            all_finite(b.trial, Status::NonFiniteState, "state")?;
        }
        copy(y, b.trial);
        copy(b.past3, b.past2);
        copy(b.past2, b.past1);
        copy(b.past1, b.rate);
        self.known = if known < 3 { known + 1 } else { 3 };
        self.step = h;
        self.counters.steps += 1;
        Ok(())
    }
}
