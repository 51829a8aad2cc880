//! How far the discretization of space can be trusted: differences of quantities that are equal for the exact solution.
//!
//! Asymmetry of the added mass and the difference of the two halves of the force are as large as the error in general, but
//! where a configuration mirrors itself they vanish whatever the error. What symmetry does not hide is how well the
//! boundary system reproduces the one solution that is known exactly, the constant density: A 1 = 2 on bodies and
//! obstacles, 0 inside a tank, and 1 on the tank itself (0, and 1 of the completion). It costs one solve. Errors that are all of one mode
//! which the system nearly does not see are told by the highest modes of the densities.
//!
//! Tested by `tests/indicators`, `tests/near_contact`.

use crate::base::complex::{Complex, complex, dot};
use crate::base::memory::{at, axpy, part, part_mut};
use crate::base::scalar::Real;
use crate::dynamics::evaluation::{Evaluation, Indicators};
use crate::dynamics::sizes::relative_force;
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::{add_potential_moments, flux_moments};
use crate::geometry::pose::put_three;
use crate::linear::lu::Factors;
use crate::model::Model;
use crate::model::boundary::BoundaryRecord;

/// Relative error indicators of the space discretization. They do not see an error of the shape itself.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Resolution<R> {
    /// Asymmetry of the discrete mass before it is symmetrized, relative to its diagonal, link by link.
    pub mass: R,
    /// Difference of the two halves of the force on a link, relative to that force (torques over the reach of their links), or where that
    /// is more to the energy of its motion over its reach, or to the largest force on any link, less by as much as the link is smaller
    /// than the largest. 0 with the boundary formula.
    pub force: R,
    /// Error of the constant density on the links (by the plain rule also on walls) as a solution of the boundary system; or three times the
    /// share of a motion's inertia that lies in the highest modes of its densities, if that is more; with circulation also the error of the
    /// fluxes of the bodies' isolated flows through every boundary, or the difference of two approximations of these flows, relative to
    /// the circulation of that boundary, or of all, less by as much as it is smaller than the largest that carries some, if that is more.
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
    links.fold(R::zero(), |m, b| m.max(of_motions(part(density, b.first, b.nodes))))
}

/// Largest error of a constant density on one boundary, or what it says of motions if that is more: of the harmonics of a kernel the one
/// that makes it is the N-th; with those of a motion and of what follows from it lower ones err, in all about as a harmonic N − 2 would,
/// which for few nodes is larger by digits where both are small.
pub(crate) fn of_motions<R: Real>(density: &[R]) -> R {
    let error = density.iter().fold(R::zero(), |m, x| m.max((*x - R::one()).abs()));
    let motions = (error.ln() * (R::one() - R::TWO / R::count(density.len().max(2)))).exp();
    error.max(motions / R::lit(20.0))
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
        let quadrature = quadrature.max(circulation).max(self.untold_inertia(model));
        Resolution { mass, force, quadrature, repulsion }
    }

    /// Three times the largest share of a motion's inertia that lies in the highest modes of its densities: where a mode that hardly moves
    /// the fluid is nearly a solution of the boundary system, all errors are of it, and neither asymmetry nor halves of the force nor the
    /// constant density show them. Three times, since what the nodes do not tell is more than the highest that they do. O(N) per motion.
    fn untold_inertia(&mut self, model: &Model<'_, R>) -> R {
        let columns = self.columns.jacobian.len() / (3 * model.links.len()).max(1);
        let columns = if model.head.plan.unknowns > 0 { columns } else { 0 };
        (0..columns).fold(R::zero(), |worst, k| {
            let (inertia, density) = (self.coupling(model, k, k), &*self.system.column(k));
            let parts = model.boundaries.iter().map(|b| part(density, b.first, b.nodes));
            let energy = parts.fold(R::zero(), |sum, u| sum + highest_modes(u)) * model.head.fluid_density;
            if inertia > R::zero() { worst.max(R::lit(3.0) * energy / inertia) } else { worst }
        })
    }

    /// The boundary on which the constant density of the last [`Evaluation::resolution`] errs most.
    pub(crate) fn least_resolved<'m>(&self, model: &Model<'m, R>) -> Option<&'m BoundaryRecord<R>> {
        let worst = |b: &BoundaryRecord<R>| {
            let values = part(self.scratch.solution, b.first, b.nodes).iter();
            values.fold(R::zero(), |m, x| m.max((*x - R::one()).abs()))
        };
        let all = model.boundaries.iter().filter(|b| b.link.is_some());
        if model.head.plan.unknowns == 0 {
            return all.into_iter().next();
        }
        all.map(|b| (worst(b), b)).reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, b)| b)
    }

    /// Difference of the halves of the Christoffel force, T₁ = Bᵀ A⁻¹ a against T₂ = −2 Xᵀ A⁻ᵀ l, relative to its size. Two passes,
    /// four solves.
    pub(crate) fn force_error(&mut self, model: &Model<'_, R>) -> R {
        self.christoffel_force(model);
        let (c, motion) = (&self.placement.configuration(model), &mut self.velocity);
        let out = PassResult { rate: motion.rate, transposed: motion.transposed, gradient: motion.gradient };
        pair_pass(c, motion.qd, motion.density, motion.adjoint, &mut self.pairs, out);
        let factors = self.system.factors();
        factors.solve(motion.rate);
        factors.solve_transposed(motion.transposed);
        let difference = &mut *self.scratch.three;
        flux_moments(c, motion.rate, difference);
        add_potential_moments(c, motion.transposed, R::TWO, difference);
        relative_force(model, difference, self.forces.force, motion.momentum, motion.qd) * model.head.fluid_density
    }

    /// M_h against its transpose, entry by entry, relative to the roots of the largest added masses of both links (of rotations over the
    /// square of the reach). 9n solves.
    pub(crate) fn mass_error(&mut self, model: &Model<'_, R>) -> R {
        // Vectors that `mass_column` does not use, lent to it and given back.
        let (column, row) = (core::mem::take(&mut self.forces.force), core::mem::take(&mut self.scratch.other));
        let sizes = core::mem::take(&mut self.scratch.three);
        let links = model.boundaries.iter().filter(|b| b.link.is_some());
        // √m of a translation, √m · reach of a rotation.
        for (i, b) in links.enumerate() {
            let mut mass = R::zero();
            for (k, length) in [R::one(), R::one(), b.reach].into_iter().enumerate() {
                self.mass_column(model, 3 * i + k, false, column);
                mass = mass.max(at(column, 3 * i + k).abs() / (length * length));
            }
            let root = mass.sqrt();
            put_three(sizes, i, complex(root, root), root * b.reach);
        }
        let mut asymmetry = R::zero();
        for k in 0..sizes.len() {
            self.mass_column(model, k, false, column);
            self.mass_column(model, k, true, row);
            axpy(row, -R::one(), column);
            let scales = sizes.iter().map(|s| *s * at(sizes, k));
            let relative = row.iter().zip(scales).map(|(x, s)| if s > R::zero() { x.abs() / s } else { R::zero() });
            asymmetry = relative.fold(asymmetry, R::max);
        }
        (self.forces.force, self.scratch.other, self.scratch.three) = (column, row, sizes);
        asymmetry
    }
}

/// Twice the energy, per unit density, of a harmonic flow that has at the boundary the largest of the four highest modes that N nodes can
/// tell: π N/2 a². O(N).
fn highest_modes<R: Real>(density: &[R]) -> R {
    let n = R::count(density.len().max(1));
    let (sin, cos) = (R::TAU / n).sin_cos();
    let (turn, mut at, mut sums) = (complex(cos, sin), complex(R::one(), R::zero()), [Complex::<R>::default(); 4]);
    for pair in density.as_chunks::<2>().0 {
        for (x, sign) in pair.iter().zip([R::one(), -R::one()]) {
            let mut wave = complex(*x * sign, R::zero());
            for sum in &mut sums {
                *sum += wave;
                wave *= at;
            }
            at *= turn;
        }
    }
    // Of the modes N/2 − m there are two, but for m = 0.
    let [half, others @ ..] = sums.map(|x| dot(x, x));
    others.into_iter().fold(half, |most, x| most.max(x * R::lit(4.0))) * R::PI * R::HALF / n
}
