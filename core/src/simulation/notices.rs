//! What a simulation tells of its errors: indicators of its steps and of the state shown, and what is to be noticed.
//!
//! Tested by `tests/indicators`, `tests/extremes`.

use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::indicators::Resolution;
use crate::simulation::sim::Sim;
use crate::simulation::state::{Method, Watch};
use crate::simulation::time_error::{Rough, StepError};

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
    /// nothing. The first of [`Sim::notices`].
    pub fn notice(&mut self) -> Option<(R, Error)> {
        self.notices().into_iter().flatten().next()
    }

    /// All that is to be noticed, each with its time, the gravest first:
    /// * `StepTooLong`: the estimated error of a step was [`STEP_ERROR_LIMIT`](crate::STEP_ERROR_LIMIT) or more reaches of a link, or radians; the motion is no longer
    ///   that of the scene. (`gauss6` has no estimate: its stages are not found then.)
    /// * `DriveUnresolved`: a drive did something within a step that its ends do not tell (a step of `rk4` or `abm4` longer than a quarter
    ///   of a period, an eighth of a window's ramp, or with rows of a table in it that leave the straight line; a jump within a step), or
    ///   a motion jumped in its position or speed. The longest step that would have seen it (0: none) and the joint or body.
    /// * `Unresolved`: the bound of the error in space exceeded the scene's tolerance, or a thousandth if none was asked for (before the
    ///   first step: at the state shown); the bound and the boundaries that are now closest to each other. O(N²) for that gap.
    /// * `EnergyDrift`: as [`Sim::energy_drift`] found it when an energy was asked for last.
    pub fn notices(&mut self) -> [Option<(R, Error)>; 4] {
        let moved = self.progress.watch != Watch::Nothing;
        let coarse = (moved && self.progress.coarsest >= R::lit(STEP_ERROR_LIMIT)).then(|| {
            let notice = Error::new(Status::StepTooLong).of("error", self.progress.coarsest.to_f64());
            (self.progress.coarsest_time, notice)
        });
        let missed = self.progress.missed;
        let unseen = (moved && missed.length < R::MAX).then(|| {
            let notice = Error::new(Status::DriveUnresolved).of("step", missed.length.to_f64());
            (missed.time, notice.at(self.model.place_of(missed.coordinate)))
        });
        let balance = self.progress.balance;
        let drift = (balance.drift.abs() > self.progress.allowed_drift()).then(|| {
            let notice = Error::new(Status::EnergyDrift).of("drift", balance.drift.to_f64());
            (balance.time, notice.beside(balance.kinetic.to_f64()))
        });
        [coarse, unseen, self.unresolved(), drift]
    }

    /// The tolerance in space, if it was not met.
    fn unresolved(&mut self) -> Option<(R, Error)> {
        let asked = self.model.head.tolerance;
        let bound = self.indicators().ok()?.bound();
        if bound <= asked {
            return None;
        }
        let time = if self.progress.watch == Watch::Nothing { self.progress.time } else { self.progress.worst_time };
        let notice = Error::new(Status::Unresolved).of("error", bound.to_f64());
        Some((time, self.gap().between.map_or(notice, |(a, b)| notice.at(a).with(b))))
    }

    /// Indicators of the last evaluation, refused if they say nothing of the result any more. One solve.
    pub(crate) fn bounded(&mut self) -> Result<Resolution<R>> {
        let model = self.model;
        let here = self.evaluation.resolution(&model);
        // NaN is no bound.
        if here.bound() <= R::one() || model.head.allow_unresolved {
            return Ok(here);
        }
        let error = Error::new(Status::BoundExceeded).of("bound", here.bound().to_f64());
        let Some(b) = self.evaluation.least_resolved(&model) else { return Err(error) };
        let error = error.at(b.place).beside(b.nodes as f64);
        // Close by, it is the gap that is not resolved.
        let gap = self.gap();
        match gap.between {
            Some((a, other)) if gap.distance < b.spacing => Err(error.at(a).with(other)),
            _ => Err(error),
        }
    }

    /// An evaluation of the state shown, if it can be trusted at all, and its indicators.
    pub(crate) fn evaluated(&mut self) -> Result<Resolution<R>> {
        self.refresh()?;
        self.bounded()
    }

    /// Error indicators at the state shown, from all of the added mass. 9n + 7 solves for n links, two passes over the pairs.
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

    /// Adds the last step's estimated error to what [`Sim::time_error`] tells.
    pub(crate) fn note_error(&mut self, regular: bool, t: R, h: R) {
        let (n, memory) = (self.state.y.len(), &*self.state.integrator);
        let p = &mut *self.progress;
        // A shortened step is Runge–Kutta, unless it is of `Gauss6`.
        let (good, rough) = match p.method {
            Method::Rk4 { .. } => (p.rk4.error(n, memory), p.rk4.rough_error(n, memory)),
            Method::Abm4 { .. } if regular => (p.abm4.error(n, memory), p.abm4.rough_error(n, memory)),
            Method::Abm4 { .. } => (None, p.rk4.rough_error(n, memory)),
            Method::Adams { .. } => (p.adams.error(memory), None),
            Method::Gauss6 { .. } => (None, None),
        };
        let of = |error| StepError::of(error, h, &self.model);
        let (good, rough) = (good.map(of), rough.map(of));
        match good {
            Some(error) => {
                p.time_error.add(&error);
                p.rough.better = true;
                self.note_step(error.relative, t);
            }
            None => p.time_error.unknown += 1,
        }
        if let Some(error) = rough.filter(|_| !self.progress.rough.better) {
            self.progress.rough.add(error);
        }
    }

    /// The integrator is about to forget the past: steps of which nothing better will be known are told by their upper estimates.
    pub(crate) fn end_stretch(&mut self) {
        let rough = self.progress.rough;
        self.progress.rough = Rough::nothing();
        if rough.better || rough.steps == 0 {
            return;
        }
        self.progress.time_error.add_rough(&rough);
        if self.progress.watch == Watch::Past {
            // Its call is over: the next one tells.
            self.progress.late = self.progress.late.max(rough.sum.relative);
        } else {
            self.note_step(rough.sum.relative, self.progress.time);
        }
    }

    fn note_step(&mut self, relative: R, t: R) {
        if relative > self.progress.coarsest {
            (self.progress.coarsest, self.progress.coarsest_time) = (relative, t);
        }
    }
}
