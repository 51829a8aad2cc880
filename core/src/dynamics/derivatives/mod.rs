//! Derivatives of the force r = M q̈ + F of bodies and fluid by positions and velocities of the links, at fixed accelerations:
//! H = ∂r/∂q, C = ∂r/∂q̇, and M = ∂r/∂q̈. Of them all derivatives of the motion are made (`tree`, `motion`).
//!
//! They are the derivatives of the discrete force (module `christoffel`), exact at any resolution, with nodes that stay where
//! they are in their outlines. With D and E of `fluid/tangent_pass`, U and λ the density and the adjoint of unit motions and of
//! the motion itself, W = Im dG[q̇], c_b = Im dG[b] u, r_b = Im dG[b]ᵀ λ:
//!
//! S = A⁻¹ c, Z = A⁻¹ W U, T = A⁻¹ (Im d²G[b, q̇] u + Im dG[b] w + W S), and per unit density
//! M_v = sym Bᵀ Z, P = ½ (Bᵀ S + Uᵀ r), Q = ½ (Bᵀ T + Uᵀ r″ + Zᵀ r), Y = λᵀ Im d²G u + rᵀ S + Sᵀ r;
//! `frames` adds the turning of the links. One pass over the pairs, three sets of 3n solves, 6n products with W: the price
//! of two to three more evaluations, however many bodies there are.
//!
//! Tested by `tests/derivatives`.

pub(crate) mod frames;
pub(crate) mod motion;
mod products;
pub(crate) mod tree;

use crate::base::memory::{add, at, axpy, buffers, copy, inner, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::christoffel::without_turning;
use crate::dynamics::evaluation::Evaluation;
use crate::dynamics::forces::{buoyancy, repulsion};
use crate::dynamics::kirchhoff::lone_momentum;
use crate::fluid::configuration::Configuration;
use crate::fluid::potentials::{add_interior_potential, fill_flux, flux_moments, to_link_frames, to_world};
use crate::fluid::tangent_pass::{TangentResult, TangentScratch, TangentSource, tangent_pass};
use crate::model::{Formulation, Model};
use crate::scene::ForceFormula;

/// Numbers that the arrays' lengths follow from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DerivativeDims {
    /// 3n.
    rows: usize,
    unknowns: usize,
    ld: usize,
    /// Most nodes of a boundary; 0 without unknowns.
    pub(crate) longest: usize,
    /// The columns of an evaluation are the unit motions of the links.
    free: bool,
}

impl DerivativeDims {
    pub(crate) fn of<R: Real>(model: &Model<'_, R>) -> Self {
        let (rows, unknowns) = (3 * model.links.len(), model.head.plan.unknowns);
        let longest = model.boundaries.iter().fold(0, |most, b| most.max(b.nodes));
        DerivativeDims {
            rows,
            unknowns,
            ld: crate::dynamics::evaluation::leading(unknowns),
            longest: if unknowns == 0 { 0 } else { longest },
            free: model.head.plan.free_coordinates == rows,
        }
    }

    fn columns(&self) -> usize {
        self.ld * self.rows
    }

    fn square(&self) -> usize {
        self.rows * self.rows
    }
}

buffers! {
    /// What derivatives need beside an evaluation. Columns run over the unit motions of the links, world, 3n; on the unknowns
    /// with the leading dimension of the boundary system.
    pub(crate) struct Derivatives(d: DerivativeDims) {
        /// U, where the evaluation has other columns.
        densities: R = if d.free { 0 } else { d.columns() },
        /// c_b, then S.
        rate: R = d.columns(),
        /// r_b.
        transposed: R = d.columns(),
        /// Im d²G[b, q̇] u + Im dG[b] w + W S, then T.
        second: R = d.columns(),
        /// r″.
        second_transposed: R = d.columns(),
        /// W U, then Z.
        product: R = d.columns(),
        /// Columns of W of one source.
        panel: R = d.ld * d.longest,
        /// w, μ · N.
        second_density: R = d.unknowns,
        second_adjoint: R = d.unknowns,
        /// q̈ without the turning of the frames · 3n.
        base: R = d.rows,
        /// M^f · 3n × 3n, as all that follow, with density.
        mass: R = d.square(),
        /// M_v.
        mass_rate: R = d.square(),
        /// P.
        slope: R = d.square(),
        /// Q.
        mixed: R = d.square(),
        /// Y.
        hessian: R = d.square(),
        /// ∂r/∂q.
        position: R = d.square(),
        /// ∂r/∂q̇.
        velocity: R = d.square(),
    }
}

/// Refuses what has no derivatives yet, by the name of the term.
pub(crate) fn supported<R: Real>(model: &Model<'_, R>) -> Result<()> {
    let no = |term| Err(Error::new(Status::Unsupported).of(term, f64::NAN));
    let lone = model.head.plan.formulation == Formulation::Kirchhoff;
    if model.head.plan.circulation {
        return no("circulation");
    }
    if model.head.force != ForceFormula::ExactGradient && !lone {
        return no("force formula");
    }
    Ok(())
}

impl<R: Real> Evaluation<'_, R> {
    /// H, C and M^f at the state evaluated last, for the accelerations `qdd` of the links (world, 3n).
    pub(crate) fn force_derivatives(
        &mut self,
        model: &Model<'_, R>,
        qdd: &[R],
        d: &mut Derivatives<'_, R>,
        s: &mut TangentScratch<'_, R>,
    ) {
        let dims = DerivativeDims::of(model);
        for square in [&mut *d.mass, &mut *d.mass_rate, &mut *d.slope, &mut *d.mixed, &mut *d.hessian] {
            square.fill(R::zero());
        }
        without_turning(model.links.len(), qdd, self.velocity.qd, d.base);
        if dims.unknowns > 0 {
            self.unit_densities(model, &dims, d);
            self.pair_derivatives(model, &dims, d, s);
        } else if model.head.plan.formulation == Formulation::Kirchhoff {
            let c = &self.placement.configuration(model);
            let unit = &mut *self.scratch.three;
            for (k, column) in d.mass.chunks_exact_mut(dims.rows.max(1)).enumerate() {
                unit.fill(R::zero());
                put(unit, k, R::one());
                lone_momentum(c, unit, column);
            }
        }
        frames::complete(self.velocity.qd, qdd, d);
        let c = &self.placement.configuration(model);
        if model.head.plan.gravity {
            buoyancy::add_hessian(model, c.poses, d.position);
        }
        if let Some(law) = model.head.repulsion {
            repulsion::add_hessian(c, law, d.position);
        }
    }

    /// U, where the columns of the evaluation are others; M^f.
    fn unit_densities(&mut self, model: &Model<'_, R>, dims: &DerivativeDims, d: &mut Derivatives<'_, R>) {
        let (n, rows, density) = (dims.unknowns, dims.rows, model.head.fluid_density);
        if dims.free {
            copy(d.mass, part(self.columns.momenta, 0, rows * rows));
        } else {
            let c = &self.placement.configuration(model);
            let (unit, in_links) = (&mut *self.scratch.three, &mut *self.scratch.other);
            d.densities.fill(R::zero());
            let fill = |unit: &mut [R], in_links: &mut [R], k: usize| {
                unit.fill(R::zero());
                put(unit, k, R::one());
                to_link_frames(c, unit, in_links);
            };
            for (k, column) in d.densities.chunks_exact_mut(dims.ld.max(1)).enumerate() {
                fill(unit, in_links, k);
                add_interior_potential(c, in_links, -R::TWO, part_mut(column, 0, n));
            }
            self.system.factors().solve_columns(d.densities);
            for (k, (column, mass)) in
                d.densities.chunks_exact(dims.ld.max(1)).zip(d.mass.chunks_exact_mut(rows.max(1))).enumerate()
            {
                fill(unit, in_links, k);
                let potential = &mut *self.scratch.solution;
                copy(potential, part(column, 0, n));
                add_interior_potential(c, in_links, R::one(), potential);
                flux_moments(c, potential, mass);
                to_world(c, density, mass);
            }
        }
        symmetrize(d.mass, rows);
    }

    /// What pairs of boundaries contribute: M_v, P, Q, Y.
    fn pair_derivatives(
        &mut self,
        model: &Model<'_, R>,
        dims: &DerivativeDims,
        d: &mut Derivatives<'_, R>,
        s: &mut TangentScratch<'_, R>,
    ) {
        let (n, ld, rows, density) = (dims.unknowns, dims.ld, dims.rows, model.head.fluid_density);
        let c = &self.placement.configuration(model);
        let (velocity, factors) = (&self.velocity, self.system.factors());
        let in_links = &mut *self.scratch.other;
        to_link_frames(c, d.base, in_links);
        copy(d.second_density, velocity.rate);
        add_interior_potential(c, in_links, -R::TWO, d.second_density);
        factors.solve(d.second_density);
        fill_flux(c, in_links, d.second_adjoint);
        axpy(d.second_adjoint, R::one(), velocity.transposed);
        factors.solve_transposed(d.second_adjoint);
        let from = TangentSource {
            qd: velocity.qd,
            density: velocity.density,
            adjoint: velocity.adjoint,
            second_density: d.second_density,
            second_adjoint: d.second_adjoint,
        };
        let out = &mut TangentResult {
            ld,
            rate: d.rate,
            transposed: d.transposed,
            second: d.second,
            second_transposed: d.second_transposed,
            hessian: d.hessian,
        };
        tangent_pass(c, from, s, out);
        factors.solve_columns(d.rate);
        // U lies behind the factors where the columns of the evaluation are the unit motions.
        let unit = if dims.free { part(self.system.matrix, n * ld, rows * ld) } else { &*d.densities };
        d.product.fill(R::zero());
        products::add_products(c, velocity.qd, ld, &mut self.pairs, d.panel, [unit, d.rate], [d.product, d.second]);
        factors.solve_columns(d.product);
        factors.solve_columns(d.second);
        moments(c, dims, density, d.product, d.mass_rate);
        symmetrize(d.mass_rate, rows);
        moments(c, dims, density * R::HALF, d.rate, d.slope);
        moments(c, dims, density * R::HALF, d.second, d.mixed);
        let half = density * R::HALF;
        for b in 0..rows {
            let (r, second, s_b) =
                (part(d.transposed, b * ld, n), part(d.second_transposed, b * ld, n), part(d.rate, b * ld, n));
            for a in 0..rows {
                let (u, z, r_a) = (part(unit, a * ld, n), part(d.product, a * ld, n), part(d.transposed, a * ld, n));
                add(d.slope, b * rows + a, half * inner(u, r));
                add(d.mixed, b * rows + a, half * (inner(u, second) + inner(z, r)));
                let product = inner(r_a, s_b);
                add(d.hessian, b * rows + a, product);
                add(d.hessian, a * rows + b, product);
            }
        }
        for y in d.hessian.iter_mut() {
            *y *= density;
        }
    }
}

/// `out = scale Bᵀ f` of every column of `f`, world · 3n × 3n.
fn moments<R: Real>(c: &Configuration<'_, R>, dims: &DerivativeDims, scale: R, f: &[R], out: &mut [R]) {
    for (f, out) in f.chunks_exact(dims.ld.max(1)).zip(out.chunks_exact_mut(dims.rows.max(1))) {
        flux_moments(c, part(f, 0, dims.unknowns), out);
        to_world(c, scale, out);
    }
}

/// The symmetric half of a square matrix, in place.
fn symmetrize<R: Real>(a: &mut [R], n: usize) {
    for i in 0..n {
        for j in 0..i {
            let mean = (at(a, i * n + j) + at(a, j * n + i)) * R::HALF;
            put(a, i * n + j, mean);
            put(a, j * n + i, mean);
        }
    }
}
