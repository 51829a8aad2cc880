//! What the methods of fixed step have in common: how many equal steps they remember, compensated sums, the first checks.
//!
//! Tested by `integrate/tests/accuracy.rs`, `integrate/tests/robustness.rs`.

use crate::base::fields::Fields;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::integrate::system::{Counters, System, all_finite, finite, same_length};

/// The part of a fixed-step method that does not grow with the dimension.
#[derive(Clone, Copy, Debug)]
pub(super) struct FixedStep<R> {
    /// Length of the last step.
    pub(super) step: R,
    /// Has a step been made since the start or [`FixedStep::reset`]?
    continues: bool,
    /// Number of earlier steps of this length whose rates are known.
    known: usize,
    /// Is there an estimate of a step's error?
    pub(super) estimated: bool,
    pub(super) counters: Counters,
}

impl<R: Real> FixedStep<R> {
    pub(super) fn new() -> Self {
        FixedStep { step: R::zero(), continues: false, known: 0, estimated: false, counters: Counters::default() }
    }

    /// Forgets the past rates and the rest of the state.
    pub(super) fn reset(&mut self) {
        (self.known, self.continues, self.estimated) = (0, false, false);
    }

    /// Forgets the past rates.
    pub(super) fn jump(&mut self) {
        (self.known, self.estimated) = (0, false);
    }

    /// Every field, in order; at most `most` earlier steps are remembered.
    pub(super) fn each(&mut self, io: &mut impl Fields<R>, most: usize) {
        let FixedStep { step, continues, known, estimated, counters } = self;
        io.finite("step", step);
        io.flag("continues", continues);
        io.count("known", known, most);
        io.flag("estimated", estimated);
        counters.each(io);
    }

    /// Begins a step: clears `rest`, the part of the state that it cannot hold, after a start; returns how many earlier rates
    /// serve a step of this length.
    pub(super) fn begin(&self, h: R, rest: &mut [R]) -> usize {
        if !self.continues {
            rest.fill(R::zero());
        }
        if h == self.step { self.known } else { 0 }
    }

    /// A step was made: with `known` earlier rates before it, of which at most `most` are remembered.
    pub(super) fn end(&mut self, h: R, known: usize, most: usize, estimated: bool) {
        self.known = if known < most { known + 1 } else { most };
        (self.step, self.continues, self.estimated) = (h, true, estimated);
        self.counters.steps += 1;
    }
}

/// Refuses what no fixed step can be made of: a time, step or state that is not finite, no step at all or, where time
/// counts, one that is lost in its digits, a state of the wrong length.
pub(super) fn check_step<R: Real, S: System<R> + ?Sized>(system: &S, t: R, h: R, y: &[R]) -> Result<()> {
    finite(t, "time")?;
    if !h.is_finite() || h == R::zero() {
        return Err(Error::new(Status::BadStep).of("step", h.to_f64()));
    }
    if system.clocked() && t + h == t {
        return Err(Error::new(Status::StepTooSmall).of("time", t.to_f64()));
    }
    same_length(system.dim(), y.len())?;
    all_finite(y, Status::NonFiniteState, "state")
}

/// `y += increment`, where `rest` keeps what `y` cannot hold. A state that is not finite is refused, and
/// nothing changed.
pub(super) fn add_increment<R: Real>(y: &mut [R], rest: &mut [R], increment: &[R]) -> Result<()> {
    for ((y, rest), d) in y.iter().zip(&*rest).zip(increment) {
        all_finite(&[*y + (*d + *rest)], Status::NonFiniteState, "state")?;
    }
    for ((y, rest), d) in y.iter_mut().zip(rest).zip(increment) {
        let d = *d + *rest;
        let new = *y + d;
        *rest = d - (new - *y);
        *y = new;
    }
    Ok(())
}
