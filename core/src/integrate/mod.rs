//! Integrators of ordinary differential equations `y' = f(t, y)` in memory given by the caller.
//!
//! - [`rk4`]: the classical Runge–Kutta step of order 4, fixed step, four evaluations.
//! - [`abm4`]: Adams–Bashforth–Moulton of order 4, fixed step, two evaluations.
//! - [`adams`]: Adams–Bashforth–Moulton of variable step and order 1–12 (the method of Matlab's
//!   `ode113`), with error control and dense output, two evaluations.
//! - [`gauss6`]: the implicit Runge–Kutta method of Gauss and Legendre of order 6, fixed step, symmetric in
//!   time, 20 to 40 evaluations.
//!
//! Every method sums the state with compensation, so that many short steps do not add up their rounding.
//!
//! The integrators are small `Copy` values; everything that grows with the dimension lies in a work slice
//! of `work_len(dim)` numbers, which belongs to one integrator from one call to the next.

use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};

pub mod abm4;
pub mod adams;
mod control;
mod formula;
pub mod gauss6;
pub mod rk4;
#[cfg(test)]
mod tests;

pub use abm4::Abm4;
pub use adams::Adams;
pub use gauss6::Gauss6;
pub use rk4::Rk4;

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

/// Evaluates the right-hand side and refuses rates that are not finite.
fn evaluate<R: Real, S: System<R> + ?Sized>(
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
fn all_finite<R: Real>(values: &[R], status: Status, what: &'static str) -> Result<()> {
    match values.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Error::new(status).of(what, x.to_f64())),
        None => Ok(()),
    }
}

/// Refuses a time or step of the caller that is not finite.
fn finite<R: Real>(x: R, what: &'static str) -> Result<()> {
    all_finite(&[x], Status::NotFinite, what)
}

/// Refuses what no fixed step can be made of: a time, step or state that is not finite, no step at all or, where time
/// counts, one that is lost in its digits, a state of the wrong length.
fn check_step<R: Real, S: System<R> + ?Sized>(system: &S, t: R, h: R, y: &[R]) -> Result<()> {
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

/// Refuses a buffer of the wrong length.
fn same_length(want: usize, got: usize) -> Result<()> {
    if want == got { Ok(()) } else { Err(Error::new(Status::Length).of("length", got as f64)) }
}

/// `y += increment`, where `rest` keeps what `y` cannot hold. A state that is not finite is refused, and
/// nothing changed.
fn add_increment<R: Real>(y: &mut [R], rest: &mut [R], increment: &[R]) -> Result<()> {
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

/// Does the error belong to the trial state, so that another one may succeed?
fn recoverable(error: &Error) -> bool {
    matches!(error.status, Status::Contact | Status::Singular | Status::NonFiniteState)
}
