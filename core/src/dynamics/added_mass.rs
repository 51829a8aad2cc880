//! Added mass: the fluid's momentum for motions of the bodies, M^f_ab = ∫ ψ_a b_b (2.11) with the potentials ψ of the elementary
//! problems (2.6), solved in the direct formulation (8.2): (I − Im G) u = −2 X v, ψ = u + X v.
//!
//! The discrete matrix M_h = Bᵀ ψ is not quite symmetric; its symmetric half is what every force is the exact derivative of.
//! Tested by `tests/reference_values` (closed forms), `tests/near_contact` (image dipoles), `tests/gradients`, `tests/conservation`.

use crate::base::memory::{add, at, axpy, copy, inner, part, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::dynamics::evaluation::{Counters, Evaluation};
use crate::dynamics::kirchhoff::lone_momentum;
use crate::fluid::potentials::{
    add_interior_potential, add_potential_moments, fill_flux, flux_moments, to_link_frames, to_world,
};
use crate::fluid::system::{column_momenta, solve_columns};
use crate::geometry::pose::twist_of;
use crate::linear::ldl;
use crate::model::{Control, CoordinateRecord, Formulation, Model};

impl<R: Real> Evaluation<'_, R> {
    /// Solves the boundary system for the columns of the Jacobian and forms their momenta M^f N, one half of the added mass. O(N³).
    pub(crate) fn solve_fluid(&mut self, model: &Model<'_, R>, counters: &mut Counters) -> Result<()> {
        let rows = (3 * model.links.len()).max(1);
        let (c, columns) = (&self.placement.configuration(model), &mut self.columns);
        columns.momenta.fill(R::zero());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            for (column, momentum) in columns.jacobian.chunks_exact(rows).zip(columns.momenta.chunks_exact_mut(rows)) {
                lone_momentum(c, column, momentum);
            }
            return Ok(());
        }
        if model.head.plan.unknowns == 0 {
            return Ok(());
        }
        for (world, link) in columns.jacobian.chunks_exact(rows).zip(columns.in_links.chunks_exact_mut(rows)) {
            to_link_frames(c, world, link);
        }
        counters.factorizations += 1;
        let (motions, pairs) = (&*columns.in_links, &mut self.pairs);
        let by = self.kept.factorization();
        solve_columns(by, &mut self.system, &mut self.kept.walls_ready, c, motions, pairs.zx, pairs.zy)?;
        column_momenta(&self.system, c, motions, pairs.hx, pairs.hy, pairs.fx, columns.momenta);
        for momentum in columns.momenta.chunks_exact_mut(rows) {
            to_world(c, model.head.fluid_density, momentum);
        }
        Ok(())
    }

    /// Reduced mass matrix N_pᵀ M N_p of bodies and fluid, factorized.
    ///
    /// # Errors
    /// `Singular` if it is not positive definite, with the link that the first coordinate moves for which it is not.
    pub(crate) fn reduce_mass(&mut self, model: &Model<'_, R>) -> Result<()> {
        let (n, rows) = (model.head.plan.free_coordinates, 3 * model.links.len());
        let (columns, reduced) = (&self.columns, &mut self.reduced);
        let weighted = &mut *self.scratch.other;
        let (jacobian, momenta) =
            (|k: usize| part(columns.jacobian, k * rows, rows), |k: usize| part(columns.momenta, k * rows, rows));
        // What does not move adds nothing.
        let product = |column: &[R], c: &CoordinateRecord<R>, momentum: &[R]| {
            let (first, count) = c.moves;
            let pairs = part(column, first, count).iter().zip(part(momentum, first, count));
            pairs.fold(R::zero(), |s, (x, y)| s + *x * *y)
        };
        let free = || model.coordinates.iter().filter(|c| c.control != Control::Prescribed);
        let mut asymmetry = R::zero();
        for (k, own) in free().enumerate() {
            copy(weighted, jacobian(k));
            for (p, l) in weighted.as_chunks_mut::<3>().0.iter_mut().zip(model.links) {
                for (p, m) in p.iter_mut().zip([l.mass, l.mass, l.inertia]) {
                    *p *= m;
                }
            }
            // The diagonal first: the asymmetry of the others is measured by it.
            let entry = |j: usize, other: &CoordinateRecord<R>| {
                let halves = [product(jacobian(j), other, momenta(k)), product(jacobian(k), own, momenta(j))];
                let (a, b) = (own.moves, other.moves);
                let common = a.0 < b.0 + b.1 && b.0 < a.0 + a.1;
                let bodies = if common { product(jacobian(j), other, weighted) } else { R::zero() };
                ((halves[0] + halves[1]) * R::HALF + bodies, (halves[0] - halves[1]).abs())
            };
            let (own_sum, _) = entry(k, own);
            put(reduced.mass, k * n + k, own_sum);
            let own_scale = if own_sum > R::zero() { R::one() / own_sum.sqrt() } else { R::zero() };
            put(reduced.inverse_pivots, k, own_scale);
            for (j, other) in free().enumerate().take(k) {
                let (sum, difference) = entry(j, other);
                put(reduced.mass, k * n + j, sum);
                put(reduced.mass, j * n + k, sum);
                asymmetry = asymmetry.max(difference * (own_scale * at(reduced.inverse_pivots, j)));
            }
        }
        self.kept.indicators.mass = asymmetry.max(model.head.lone_resolution[0]);
        ldl::factor(reduced.mass, n, reduced.inverse_pivots).map_err(|k| {
            let link = free().nth(k).and_then(|c| model.links.get(c.link));
            link.map_or(Status::Singular.into(), |l| Error::new(Status::Singular).at(Place::Link(l.place.0, l.place.1)))
        })
    }

    /// Solves the reduced system in place: `rhs` becomes its solution.
    pub(crate) fn solve_reduced(&mut self, n: usize) {
        ldl::solve(self.reduced.mass, n, self.reduced.inverse_pivots, self.reduced.rhs);
    }

    /// The density of the motion q̇ itself, its adjoint, and its momentum (symmetrized, world directions, with density).
    /// `combined`: q̇ is the motion of the coordinates, whose density is a combination of the solved columns; otherwise
    /// it costs a solve.
    pub(crate) fn solve_motion(&mut self, model: &Model<'_, R>, combined: bool) {
        let rows = 3 * model.links.len();
        let (c, motion) = (&self.placement.configuration(model), &mut self.velocity);
        if model.head.plan.formulation == Formulation::Kirchhoff {
            lone_momentum(c, motion.qd, motion.momentum);
            return;
        }
        if model.head.plan.unknowns == 0 {
            motion.momentum.fill(R::zero());
            return;
        }
        to_link_frames(c, motion.qd, motion.in_links);
        let (system, half) = (&mut self.system, &mut *self.scratch.other);
        if combined {
            let free = model.head.plan.free_coordinates;
            let rates = model
                .coordinates
                .iter()
                .zip(self.coordinates.ds.iter())
                .filter(|(c, _)| c.control != Control::Prescribed);
            let last = core::iter::repeat_n(R::one(), (self.columns.jacobian.len() / rows.max(1)).saturating_sub(free));
            let rates = rates.map(|(_, ds)| *ds).chain(last);
            system.combine(rates.clone(), motion.density);
            half.fill(R::zero());
            for (rate, momentum) in rates.zip(self.columns.momenta.chunks_exact(rows.max(1))) {
                axpy(half, rate, momentum);
            }
        } else {
            motion.density.fill(R::zero());
            add_interior_potential(c, motion.in_links, -R::TWO, motion.density);
            system.factors().solve(motion.density);
            let potential = &mut *self.scratch.solution;
            copy(potential, motion.density);
            add_interior_potential(c, motion.in_links, R::one(), potential);
            flux_moments(c, potential, half);
            to_world(c, model.head.fluid_density, half);
        }
        fill_flux(c, motion.in_links, motion.adjoint);
        // ½ Xᵀ B v now, −Xᵀ λ after the solve: M_hᵀ v = Xᵀ (B v − 2 λ).
        motion.momentum.fill(R::zero());
        add_potential_moments(c, motion.adjoint, R::HALF, motion.momentum);
        system.factors().solve_transposed(motion.adjoint);
        add_potential_moments(c, motion.adjoint, -R::one(), motion.momentum);
        to_world(c, model.head.fluid_density, motion.momentum);
        axpy(motion.momentum, R::HALF, half);
    }

    /// Entry of the mass matrix of two columns: of the fluid, symmetrized, and of the bodies.
    pub(crate) fn coupling(&self, model: &Model<'_, R>, k: usize, j: usize) -> R {
        let rows = 3 * model.links.len();
        let (column, other) =
            (part(self.columns.jacobian, k * rows, rows), part(self.columns.jacobian, j * rows, rows));
        let momenta = (part(self.columns.momenta, k * rows, rows), part(self.columns.momenta, j * rows, rows));
        let mut sum = (inner(column, momenta.1) + inner(other, momenta.0)) * R::HALF;
        for (i, link) in model.links.iter().enumerate() {
            let (a, b) = (twist_of(column, i), twist_of(other, i));
            sum += link.mass * crate::base::complex::dot(a.linear, b.linear) + link.inertia * a.angular * b.angular;
        }
        sum
    }

    /// Densities, adjoint and momentum of the motion placed last.
    pub(crate) fn prepare_motion(&mut self, model: &Model<'_, R>, counters: &mut Counters) -> Result<()> {
        self.grade(model)?;
        self.fill_jacobian(model);
        self.solve_fluid(model, counters)?;
        self.solve_motion(model, true);
        Ok(())
    }

    /// Linear impulse and angular impulse about the origin, bodies and fluid (without circulation).
    pub(crate) fn total_impulse(&self, model: &Model<'_, R>) -> [R; 3] {
        let mut total = [R::zero(); 3];
        for (i, l) in model.links.iter().enumerate() {
            let (p, v) = (twist_of(self.velocity.momentum, i), twist_of(self.velocity.qd, i));
            let linear = p.linear + v.linear * l.mass;
            let (x, y) = (at(self.placement.q, 3 * i), at(self.placement.q, 3 * i + 1));
            total[0] += linear.re;
            total[1] += linear.im;
            total[2] += p.angular + v.angular * l.inertia + x * linear.im - y * linear.re;
        }
        total
    }

    /// The same of the motion (p, ṗ), from scratch.
    pub(crate) fn impulse_of_motion(&mut self, model: &Model<'_, R>, p: &[R], dp: &[R]) -> Result<[R; 3]> {
        let mut counters = Counters::default();
        self.place(model, R::zero(), p, dp)?;
        self.prepare_motion(model, &mut counters)?;
        Ok(self.total_impulse(model))
    }

    /// `out = M_h e` per unit density for a world direction `e` of one coordinate; `transposed`: M_hᵀ e. Writes over the velocity's
    /// directions in links.
    pub(crate) fn mass_column(&mut self, model: &Model<'_, R>, direction: usize, transposed: bool, out: &mut [R]) {
        self.kept.shown = false;
        let c = &self.placement.configuration(model);
        let (v, solution) = (&mut *self.velocity.in_links, &mut *self.scratch.solution);
        out.fill(R::zero());
        put(out, direction, R::one());
        to_link_frames(c, out, v);
        let factors = self.system.factors();
        if transposed {
            fill_flux(c, v, solution);
            out.fill(R::zero());
            add_potential_moments(c, solution, R::one(), out);
            factors.solve_transposed(solution);
            add_potential_moments(c, solution, -R::TWO, out);
        } else {
            solution.fill(R::zero());
            add_interior_potential(c, v, -R::TWO, solution);
            factors.solve(solution);
            add_interior_potential(c, v, R::one(), solution);
            flux_moments(c, solution, out);
        }
        to_world(c, R::one(), out);
    }

    /// M^f, symmetrized, with density: 3n × 3n, column-major. 3n solves.
    pub(crate) fn added_mass(&mut self, model: &Model<'_, R>, out: &mut [R]) {
        let n = 3 * model.links.len();
        out.fill(R::zero());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            // The columns are the body's three directions.
            copy(out, part(self.columns.momenta, 0, n * n));
            return;
        }
        if !model.head.plan.fluid {
            return;
        }
        for (k, column) in out.chunks_exact_mut(n.max(1)).enumerate() {
            self.mass_column(model, k, false, column);
        }
        for i in 0..n {
            for j in 0..=i {
                let mean = (at(out, i * n + j) + at(out, j * n + i)) * R::HALF * model.head.fluid_density;
                put(out, i * n + j, mean);
                put(out, j * n + i, mean);
            }
        }
    }

    /// The bodies' part of the mass matrix, added to it.
    pub(crate) fn add_bodies(model: &Model<'_, R>, out: &mut [R]) {
        let n = 3 * model.links.len();
        for (i, l) in model.links.iter().enumerate() {
            for (k, m) in [l.mass, l.mass, l.inertia].into_iter().enumerate() {
                add(out, (3 * i + k) * (n + 1), m);
            }
        }
    }
}
