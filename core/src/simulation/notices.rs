//! What a simulation tells of its errors: indicators of its steps and of the state shown, and what is to be noticed.
//!
//! Tested by `tests/indicators`, `tests/extremes`.

use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::indicators::Resolution;
use crate::simulation::sim::Sim;
use crate::simulation::state::Watch;

/// Estimated error of one step (of positions, and of velocities over another step), in reaches of a link or in radians, from which
/// on steps are too long.
pub const STEP_ERROR_LIMIT: f64 = 0.1;

impl<R: Real> Sim<'_, R> {
    /// Error indicators of the steps: the largest over the last call of [`Sim::step`] or [`Sim::advance`], of the reduced mass
    /// matrix and the force along the motion as they are formed anyway; before the first step those of the state shown.
    /// O(N²) per step, which every step spends.
    ///
    /// # Errors
    /// As [`Sim::energy`], before the first step only.
    pub fn indicators(&mut self) -> Result<Resolution<R>> {
        if self.progress.watch == Watch::Nothing {
            self.refresh()?;
            let model = self.model;
            return Ok(self.evaluation.resolution(&model));
        }
        Ok(self.progress.worst)
    }

    /// What is to be noticed of the last call of [`Sim::step`] or [`Sim::advance`], and when it was worst; `None` if there is
    /// nothing.
    /// * `StepTooLong`: the estimated error of a step was [`STEP_ERROR_LIMIT`] or more reaches of a link, or radians; the motion is no longer
    ///   that of the scene. (`gauss6` has no estimate: its stages are not found then.)
    /// * `Unresolved`: the scene's tolerance in space was not met (before the first step: at the state shown); the bound of the
    ///   error and the boundaries that are now closest to each other. Never if none was asked for. O(N²) for that gap.
    pub fn notice(&mut self) -> Option<(R, Error)> {
        if self.progress.watch != Watch::Nothing && self.progress.coarsest >= R::lit(STEP_ERROR_LIMIT) {
            let notice = Error::new(Status::StepTooLong).of("error", self.progress.coarsest.to_f64());
            return Some((self.progress.coarsest_time, notice));
        }
        let asked = self.model.head.tolerance;
        if asked == R::zero() {
            return None;
        }
        let bound = self.indicators().ok()?.bound();
        if bound <= asked {
            return None;
        }
        let time = if self.progress.watch == Watch::Nothing { self.progress.time } else { self.progress.worst_time };
        let notice = Error::new(Status::Unresolved).of("error", bound.to_f64());
        Some((time, self.gap().between.map_or(notice, |(a, b)| notice.at(a).with(b))))
    }

    /// Error indicators at the state shown, from all of the added mass. 6n + 7 solves for n links, two passes over the pairs.
    ///
    /// # Errors
    /// As [`Sim::energy`].
    pub fn resolution(&mut self) -> Result<Resolution<R>> {
        self.refresh()?;
        let model = self.model;
        if model.head.plan.unknowns == 0 {
            return Ok(self.evaluation.resolution(&model));
        }
        let Resolution { quadrature, repulsion, .. } = self.evaluation.resolution(&model);
        // Force: T₁ = Bᵀ A⁻¹ a against T₂ = −2 Xᵀ A⁻ᵀ l, both from one more pass.
        let force = self.evaluation.force_error(&model);
        let mass = self.evaluation.mass_error(&model);
        Ok(Resolution { mass, force, quadrature, repulsion })
    }
}
