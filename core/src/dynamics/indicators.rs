//! How far the discretization of space can be trusted: differences of quantities that are equal for the exact solution.
//!
//! Asymmetry of the added mass and the difference of the two halves of the force are as large as the error in general, but
//! where a configuration mirrors itself they vanish whatever the error. What symmetry does not hide is how well the
//! boundary system reproduces the one solution that is known exactly, the constant density: A 1 = 2 on bodies and
//! obstacles, 0 inside a tank, and 1 on the tank itself (0, and 1 of the completion). It costs one solve.

use crate::base::memory::{at, axpy, inner, part, part_mut};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::accelerations::largest_force;
use crate::dynamics::evaluation::{Work, configuration, scratch, system};
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::PairScratch;
use crate::fluid::near::buffers::Near;
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::{add_potential_moments, flux_moments};
use crate::fluid::system::BoundarySystem;
use crate::geometry::pose::Poses;
use crate::linear::lu::Factors;
use crate::model::Model;
use crate::simulation::sim::{Sim, Watch};

/// Estimated error of one step (of positions, and of velocities over another step), in reaches of a link or in radians, from which
/// on steps are too long.
pub const STEP_ERROR_LIMIT: f64 = 0.1;

/// Relative error indicators of the space discretization. They do not see an error of the shape itself.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Resolution<R> {
    /// Asymmetry of the discrete mass before it is symmetrized, relative to its diagonal.
    pub mass: R,
    /// Difference of the two halves of the force, relative to the largest force (torques over the reach of their links), or
    /// to the kinetic energy of the fluid over the largest reach if that is more. 0 with the boundary formula.
    pub force: R,
    /// Error of the constant density on the links (by the plain rule also on walls) as a solution of the boundary system; with circulation also the error of the
    /// fluxes of the bodies' isolated flows through every boundary, relative to the circulations, if that is more.
    pub quadrature: R,
    /// Estimated error of the double integrals of the repulsion, relative to its largest force between two boundaries; 0 without
    /// repulsion.
    pub repulsion: R,
}

impl<R: Real> Resolution<R> {
    /// Bound of the relative error of added mass and force, and of repulsion: 100 times the largest indicator.
    pub fn bound(&self) -> R {
        self.mass.max(self.force).max(self.quadrature).max(self.repulsion) * R::lit(100.0)
    }

    pub(crate) fn max(&self, other: &Self) -> Self {
        Resolution {
            mass: self.mass.max(other.mass),
            force: self.force.max(other.force),
            quadrature: self.quadrature.max(other.quadrature),
            repulsion: self.repulsion.max(other.repulsion),
        }
    }
}

/// Largest error of the constant density on links (by the plain rule also on walls), given the factors of the boundary system. `density` is scratch.
pub(crate) fn constant_error<R: Real>(model: &Model<'_, R>, factors: &Factors<'_, R>, density: &mut [R]) -> R {
    let tank = model.boundaries.iter().any(|b| b.sign > R::zero());
    for b in model.boundaries {
        let sum = if b.sign > R::zero() {
            R::one()
        } else if tank {
            R::zero()
        } else {
            R::TWO
        };
        part_mut(density, b.first, b.nodes).fill(sum);
    }
    factors.solve(density);
    // Between walls an error may be large that no body feels; but by the plain rule a wall may be too thin for its own nodes.
    let links = model.boundaries.iter().filter(|b| b.link.is_some() || b.slots.table_len == 0);
    let values = links.flat_map(|b| part(density, b.first, b.nodes));
    values.fold(R::zero(), |m, x| m.max((*x - R::one()).abs()))
}

/// A force's natural size: the largest one, or what the motion could exert, its energy over a length, where forces cancel.
pub(crate) fn force_scale<R: Real>(model: &Model<'_, R>, force: &[R], momentum: &[R], velocity: &[R]) -> R {
    let size = model.boundaries.iter().filter(|b| b.link.is_some()).fold(R::zero(), |m, b| m.max(b.reach));
    largest_force(model, force).max(inner(momentum, velocity) * R::HALF / size)
}

impl<R: Real> Work<'_, R> {
    /// Indicators of the last evaluation. One solve.
    pub(crate) fn resolution(&mut self, model: &Model<'_, R>) -> Resolution<R> {
        let quadrature = if model.head.plan.unknowns == 0 {
            model.head.lone_resolution[1]
        } else {
            constant_error(model, &system!(self).factors(), self.solution)
        };
        let [mass, force, repulsion, circulation] = [0, 1, 2, 3].map(|k| at(self.indicators, k));
        Resolution { mass, force, quadrature: quadrature.max(circulation), repulsion }
    }
}

impl<R: Real> Sim<'_, R> {
    /// Error indicators of the steps: the largest over the last call of [`Sim::step`] or [`Sim::advance`], of the reduced mass
    /// matrix and the force along the motion as they are formed anyway; before the first step those of the state shown.
    /// O(N²) per step, which every step spends.
    ///
    /// # Errors
    /// As [`Sim::energy`], before the first step only.
    pub fn indicators(&mut self) -> Result<Resolution<R>> {
        if self.head.watch == Watch::Nothing {
            self.refresh()?;
            let model = self.model;
            return Ok(self.work.resolution(&model));
        }
        Ok(self.head.worst)
    }

    /// What is to be noticed of the last call of [`Sim::step`] or [`Sim::advance`], and when it was worst; `None` if there is
    /// nothing.
    /// * `StepTooLong`: the estimated error of a step was [`STEP_ERROR_LIMIT`] or more reaches of a link, or radians; the motion is no longer
    ///   that of the scene. (`gauss6` has no estimate: its stages are not found then.)
    /// * `Unresolved`: the scene's tolerance in space was not met (before the first step: at the state shown); the bound of the
    ///   error and the boundaries that are now closest to each other. Never if none was asked for. O(N²) for that gap.
    pub fn notice(&mut self) -> Option<(R, Error)> {
        if self.head.watch != Watch::Nothing && self.head.coarsest >= R::lit(STEP_ERROR_LIMIT) {
            let notice = Error::new(Status::StepTooLong).of("error", self.head.coarsest.to_f64());
            return Some((self.head.coarsest_time, notice));
        }
        let asked = self.model.head.tolerance;
        if asked == R::zero() {
            return None;
        }
        let bound = self.indicators().ok()?.bound();
        if bound <= asked {
            return None;
        }
        let time = if self.head.watch == Watch::Nothing { self.head.time } else { self.head.worst_time };
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
        let zero = R::zero();
        if model.head.plan.unknowns == 0 {
            return Ok(self.work.resolution(&model));
        }
        let Resolution { quadrature, repulsion, .. } = self.work.resolution(&model);
        // Force: T₁ = Bᵀ A⁻¹ a against T₂ = −2 Xᵀ A⁻ᵀ l, both from one more pass.
        let w = &mut self.work;
        w.christoffel_force(&model);
        let scale = force_scale(&model, w.force, w.momentum, w.qd);
        let out = PassResult { rate: w.rate, transposed: w.transposed, gradient: w.gradient };
        let c = &configuration!(w, &model);
        pair_pass(c, w.qd, w.density, w.adjoint, &mut scratch!(w), out);
        let system = system!(w);
        system.factors().solve(w.rate);
        system.factors().solve_transposed(w.transposed);
        flux_moments(c, w.rate, w.force);
        add_potential_moments(c, w.transposed, R::TWO, w.force);
        let difference = largest_force(&model, w.force) * model.head.fluid_density;
        let force = if scale > zero { difference / scale } else { zero };
        // Mass: M_h against its transpose, column by column, rows and columns of rotations over the reach of their links.
        let (mut asymmetry, mut size) = (zero, zero);
        let reaches = model.boundaries.iter().filter(|b| b.link.is_some()).map(|b| b.reach);
        let lengths = reaches.flat_map(|reach| [R::one(), R::one(), reach]);
        for (k, length) in lengths.enumerate() {
            let w = &mut self.work;
            // Two vectors that `mass_column` does not use, lent to it and given back.
            let (column, row) = (core::mem::take(&mut w.force), core::mem::take(&mut w.spare));
            w.mass_column(&model, k, false, column);
            w.mass_column(&model, k, true, row);
            size = size.max(largest_force(&model, column) / length);
            axpy(row, -R::one(), column);
            asymmetry = asymmetry.max(largest_force(&model, row) / length);
            (w.force, w.spare) = (column, row);
        }
        self.head.fresh = false;
        Ok(Resolution { mass: if size > zero { asymmetry / size } else { zero }, force, quadrature, repulsion })
    }
}
