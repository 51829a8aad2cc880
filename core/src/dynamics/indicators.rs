//! How far the discretization of space can be trusted: differences of quantities that are equal for the exact solution.
//!
//! Asymmetry of the added mass and the difference of the two halves of the force are as large as the error in general, but
//! where a configuration mirrors itself they vanish whatever the error. What symmetry does not hide is how well the
//! boundary system reproduces the one solution that is known exactly, the constant density: A 1 = 2 on bodies and
//! obstacles, 0 inside a tank, and 1 on the tank itself (0, and 1 of the completion). It costs one solve.
//!
//! Tested by `tests/indicators`, `tests/near_contact`.

use crate::base::memory::{axpy, part, part_mut};
use crate::base::scalar::Real;
use crate::dynamics::evaluation::{Evaluation, Indicators};
use crate::dynamics::sizes::{force_scale, largest_force};
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::{add_potential_moments, flux_moments};
use crate::linear::lu::Factors;
use crate::model::Model;

/// Relative error indicators of the space discretization. They do not see an error of the shape itself.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Resolution<R> {
    /// Asymmetry of the discrete mass before it is symmetrized, relative to its diagonal.
    pub mass: R,
    /// Difference of the two halves of the force, relative to the largest force (torques over the reach of their links), or
    /// to the kinetic energy of the fluid over the largest reach if that is more. 0 with the boundary formula.
    pub force: R,
    /// Error of the constant density on the links (by the plain rule also on walls) as a solution of the boundary system; with circulation also the error of the
    /// fluxes of the bodies' isolated flows through every boundary, or the difference of two approximations of these flows, relative to
    /// the circulations, if that is more.
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

impl<R: Real> Evaluation<'_, R> {
    /// Indicators of the last evaluation. One solve.
    pub(crate) fn resolution(&mut self, model: &Model<'_, R>) -> Resolution<R> {
        let quadrature = if model.head.plan.unknowns == 0 {
            model.head.lone_resolution[1]
        } else {
            constant_error(model, &self.system.factors(), self.scratch.solution)
        };
        let Indicators { mass, force, repulsion, circulation } = self.kept.indicators;
        Resolution { mass, force, quadrature: quadrature.max(circulation), repulsion }
    }

    /// Difference of the halves of the Christoffel force, T₁ = Bᵀ A⁻¹ a against T₂ = −2 Xᵀ A⁻ᵀ l, relative to its size. Two passes,
    /// four solves.
    pub(crate) fn force_error(&mut self, model: &Model<'_, R>) -> R {
        self.christoffel_force(model);
        let (c, motion) = (&self.placement.configuration(model), &mut self.velocity);
        let force = &mut *self.forces.force;
        let scale = force_scale(model, force, motion.momentum, motion.qd);
        let out = PassResult { rate: motion.rate, transposed: motion.transposed, gradient: motion.gradient };
        pair_pass(c, motion.qd, motion.density, motion.adjoint, &mut self.pairs, out);
        let factors = self.system.factors();
        factors.solve(motion.rate);
        factors.solve_transposed(motion.transposed);
        flux_moments(c, motion.rate, force);
        add_potential_moments(c, motion.transposed, R::TWO, force);
        let difference = largest_force(model, force) * model.head.fluid_density;
        if scale > R::zero() { difference / scale } else { R::zero() }
    }

    /// M_h against its transpose, column by column, rows and columns of rotations over the reach of their links. 6n solves.
    pub(crate) fn mass_error(&mut self, model: &Model<'_, R>) -> R {
        let (mut asymmetry, mut size) = (R::zero(), R::zero());
        let reaches = model.boundaries.iter().filter(|b| b.link.is_some()).map(|b| b.reach);
        let lengths = reaches.flat_map(|reach| [R::one(), R::one(), reach]);
        // Two vectors that `mass_column` does not use, lent to it and given back.
        let (column, row) = (core::mem::take(&mut self.forces.force), core::mem::take(&mut self.scratch.other));
        for (k, length) in lengths.enumerate() {
            self.mass_column(model, k, false, column);
            self.mass_column(model, k, true, row);
            size = size.max(largest_force(model, column) / length);
            axpy(row, -R::one(), column);
            asymmetry = asymmetry.max(largest_force(model, row) / length);
        }
        (self.forces.force, self.scratch.other) = (column, row);
        if size > R::zero() { asymmetry / size } else { R::zero() }
    }
}
