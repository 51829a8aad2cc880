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
//! of `memory_len(dim)` numbers, which belongs to one integrator from one call to the next.

pub(crate) mod abm4;
pub(crate) mod adams;
mod control;
mod fixed_step;
mod formula;
pub(crate) mod gauss6;
pub(crate) mod rk4;
mod system;
#[cfg(test)]
mod tests;

pub use abm4::Abm4;
pub use adams::Adams;
pub use gauss6::Gauss6;
pub use rk4::Rk4;
pub use system::{Counters, System};
