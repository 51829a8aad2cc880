//! What an integrator is given, and what it refuses.
//!
//! Tested by `integrate/tests/robustness.rs`.

use crate::base::fields::Fields;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};

/// The right-hand side of `y' = f(t, y)`.
pub trait System<R> {
    /// Number of unknowns.
    fn dim(&self) -> usize;

    /// Writes `f(t, y)` to `dydt`; both slices have [`dim`](Self::dim) elements.
    ///
    /// # Errors
    /// `Contact`, `Singular` and `NonFiniteState` say that *this* state has no rate: an integrator that
    /// chooses its steps then tries a shorter one. Any other error ends the step at once.
    fn rhs(&mut self, t: R, y: &[R], dydt: &mut [R]) -> Result<()>;

    /// A change of an unknown within a step `h` that matters, in its own unit: what makes unknowns of different units
    /// comparable. `R::MAX` for one that nothing depends on; `None` if all that is known are the values of the unknowns.
    fn scale(&self, _unknown: usize, _h: R) -> Option<R> {
        None
    }

    /// Whether the rate depends on `t` other than through the state. Then no step may be too short for the digits of `t`.
    fn clocked(&self) -> bool {
        false
    }

    /// The longest step from `t`, at most `h` and of its sign, whose ends and stages tell what the rates do as functions of time:
    /// nothing that begins and ends within it is missed.
    fn seen(&self, _t: R, h: R) -> R {
        h
    }

    /// The first time strictly between `t` and `end` at which the rates jump as functions of time. A step ends there, with the rates
    /// before the jump; the next one begins with those after it.
    fn next_jump(&self, _t: R, _end: R) -> Option<R> {
        None
    }

    /// Whether the derivative of the rates jumps at `t`, by so much that it matters to a step of length `h`.
    fn kinks_at(&self, _t: R, _h: R) -> bool {
        false
    }

    /// Whether the rates jump at `t`.
    fn jumps_at(&self, _t: R) -> bool {
        false
    }
}

/// What an integrator has done since it was made.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counters {
    /// Evaluations of the right-hand side, failed ones included.
    pub evaluations: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Trial steps given up: error too large, or no rate at the trial state.
    pub rejected: u64,
}

impl Counters {
    /// Every field, in order.
    pub(super) fn each<R: Real>(&mut self, io: &mut impl Fields<R>) {
        let Counters { evaluations, steps, rejected } = self;
        io.total("evaluations", evaluations);
        io.total("steps", steps);
        io.total("rejected", rejected);
    }
}

/// Evaluates the right-hand side and refuses rates that are not finite.
pub(super) fn evaluate<R: Real, S: System<R> + ?Sized>(
    system: &mut S,
    counters: &mut Counters,
    t: R,
    y: &[R],
    dydt: &mut [R],
) -> Result<()> {
    counters.evaluations += 1;
    system.rhs(t, y, dydt)?;
    all_finite(dydt, Status::NonFiniteState, "rate")
}

/// Refuses values that are not finite.
pub(super) fn all_finite<R: Real>(values: &[R], status: Status, what: &'static str) -> Result<()> {
    match values.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Error::new(status).of(what, x.to_f64())),
        None => Ok(()),
    }
}

/// Refuses a time or step of the caller that is not finite.
pub(super) fn finite<R: Real>(x: R, what: &'static str) -> Result<()> {
    all_finite(&[x], Status::NotFinite, what)
}

/// Refuses a buffer of the wrong length.
pub(super) fn same_length(want: usize, got: usize) -> Result<()> {
    if want == got { Ok(()) } else { Err(Error::new(Status::Length).of("length", got as f64)) }
}

/// Does the error belong to the trial state, so that another one may succeed?
pub(super) fn recoverable(error: &Error) -> bool {
    matches!(error.status, Status::Contact | Status::Singular | Status::NonFiniteState)
}
