//! The classical Runge–Kutta method of order 4.

use super::{Counters, System, all_finite, check_step, evaluate};
use crate::scalar::Real;
use crate::status::{Result, Status};
use crate::workspace::{axpy, buffers, copy};

/// The classical Runge–Kutta method: four evaluations a step, local error O(h⁵).
#[derive(Clone, Copy, Debug, Default)]
pub struct Rk4 {
    counters: Counters,
}

buffers! {
    struct Buffers(dim: usize) { stage: *dim, rate: *dim, sum: *dim, }
}

impl Rk4 {
    /// A new integrator.
    pub const fn new() -> Self {
        Rk4 { counters: Counters { evaluations: 0, steps: 0, rejected: 0 } }
    }

    /// Numbers of work memory for `dim` unknowns; `None` if that cannot be addressed.
    pub fn work_len(dim: usize) -> Option<usize> {
        Buffers::<f64>::len(&dim)
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Advances `y` from `t` to `t + h`; `h` may be negative.
    ///
    /// # Errors
    /// Those of the right-hand side; `NonFiniteState`, `NotFinite`, `BadStep`, `Length`, `MemoryTooSmall`.
    /// `y` is then as it was, bit for bit.
    pub fn step<R: Real, S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t: R,
        h: R,
        y: &mut [R],
        work: &mut [R],
    ) -> Result<()> {
        check_step(system, t, h, y)?;
        let b = Buffers::split(&y.len(), work)?;
        evaluate(system, &mut self.counters, t, y, b.rate)?;
        copy(b.sum, b.rate);
        later_stages(system, &mut self.counters, t, h, y, b.stage, b.rate, b.sum)?;
        copy(y, b.stage);
        self.counters.steps += 1;
        Ok(())
    }
}

/// The last three stages, given the first rate in both `rate` and `sum`; leaves the new state in `stage`.
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
        evaluate(system, counters, t + reach, stage, rate)?;
        axpy(sum, weight, rate);
    }
    copy(stage, y);
    axpy(stage, h / R::lit(6.0), sum);
    all_finite(stage, Status::NonFiniteState, "state")
}
