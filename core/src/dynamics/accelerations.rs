//! The equations of motion: from time, coordinates and rates to accelerations, joint torques and energies.
//!
//! q = F(p, u) with free coordinates p and prescribed ones u; N = ∂F/∂(p, u), q̈ = N (p̈, ü) + a. With f every force except
//! M q̈ the free coordinates obey N_pᵀ M N_p p̈ = τ − N_pᵀ [M (a + N_u ü) + f] (6.3); the prescribed ones then take
//! ν = N_uᵀ [M q̈ + f] (7.2). Torque-driven joints are free coordinates with a torque τ (Theorem 7.1).
//!
//! The fluid's part of M w is formed from both halves of the symmetrized discrete added mass, so the discrete
//! energy balance is exact at any resolution.

use crate::base::memory::{add, at, axpy, copy, inner, part, put};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::dynamics::articulation::{accelerations, project, velocities};
use crate::dynamics::christoffel::{add_frame_terms, boundary_formula, without_turning};
use crate::dynamics::evaluation::{Counters, Work, configuration, flow, lone_momentum, scratch, system};
use crate::dynamics::forces::{buoyancy, circulation, repulsion};
use crate::dynamics::indicators::force_scale;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::PairScratch;
use crate::fluid::near::buffers::Near;
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::{
    add_interior_potential, add_potential_moments, fill_flux, flux_moments, to_link_frames, to_world,
};
use crate::fluid::system::BoundarySystem;
use crate::geometry::pose::Poses;
use crate::geometry::pose::{put_three, twist_of};
use crate::model::{Control, CoordinateRecord, Formulation, Model};
use crate::scene::ForceFormula;

impl<R: Real> Work<'_, R> {
    /// One pass over the pairs: both rates and the gradient of the motion (exact-gradient formula).
    pub(crate) fn pass(&mut self, model: &Model<'_, R>) {
        self.gradient.fill(R::zero());
        if model.head.plan.unknowns > 0 && model.head.force == ForceFormula::ExactGradient {
            let c = &configuration!(self, model);
            let out = PassResult { rate: self.rate, transposed: self.transposed, gradient: self.gradient };
            pair_pass(c, self.qd, self.density, self.adjoint, &mut scratch!(self), out);
            for g in self.gradient.iter_mut() {
                *g *= model.head.fluid_density;
            }
        }
    }

    /// `force = F + M^f w` for accelerations w of the links: the Christoffel force and the fluid's inertia (symmetrized),
    /// in world directions. One ordinary and one transposed solve.
    fn fluid_force(&mut self, model: &Model<'_, R>, w: Inertia) {
        let links = model.links.len();
        let (c, density) = (&configuration!(self, model), model.head.fluid_density);
        self.force.fill(R::zero());
        if !model.head.plan.fluid {
            return;
        }
        let lone = model.head.plan.formulation == Formulation::Kirchhoff;
        let exact = model.head.force == ForceFormula::ExactGradient || lone;
        let base: &[R] = match w {
            Inertia::Drift => self.drift,
            Inertia::Accelerations => self.qdd,
        };
        if exact {
            without_turning(links, base, self.qd, self.inertial);
        } else {
            copy(self.inertial, base);
        }
        if lone {
            lone_momentum(c, self.inertial, self.force);
            add_frame_terms(links, self.qd, self.momentum, self.gradient, self.force);
            return;
        }
        if model.head.plan.unknowns == 0 {
            return;
        }
        to_link_frames(c, self.inertial, self.spare);
        if exact {
            copy(self.solution, self.rate);
        } else {
            // (2.15): the part that multiplies b_a now; Σ ψ_a kernel = Xᵀ (kernel − 2 A⁻ᵀ kernel), of which the second
            // term rides on the solve below as l = 2 kernel.
            copy(self.solution, self.density);
            add_interior_potential(c, self.v, R::one(), self.solution);
            boundary_formula(c, self.solution, self.v, self.transposed, self.hx, self.force);
            add_potential_moments(c, self.transposed, R::one(), self.force);
            for l in self.transposed.iter_mut() {
                *l *= R::TWO;
            }
            self.solution.fill(R::zero());
        }
        let mut system = system!(self);
        // ½ T₂ + ½ M_hᵀ w = Xᵀ [½ B w − A⁻ᵀ (l + B w)]
        fill_flux(c, self.spare, self.second);
        add_potential_moments(c, self.second, R::HALF, self.force);
        axpy(self.second, R::one(), self.transposed);
        if model.head.plan.free_coordinates == 3 * links {
            // The columns are the motions of each link by itself: Xᵀ A⁻ᵀ = −½ uᵀ.
            for (k, f) in self.inertial.iter_mut().enumerate() {
                *f = inner(system.column(k), self.second) * R::HALF;
            }
            for i in 0..links {
                let (f, turned) = (twist_of(self.force, i), twist_of(self.inertial, i));
                let linear = c.pose(model.head.plan.walls + i).unturned(turned.linear);
                put_three(self.force, i, f.linear + linear, f.angular + turned.angular);
            }
        } else {
            system.factors().solve_transposed(self.second);
            add_potential_moments(c, self.second, -R::one(), self.force);
        }
        // ½ T₁ + ½ M_h w = ½ Bᵀ [A⁻¹ (a − 2 X w) + X w]
        add_interior_potential(c, self.spare, -R::TWO, self.solution);
        system.factors().solve(self.solution);
        add_interior_potential(c, self.spare, R::one(), self.solution);
        flux_moments(c, self.solution, self.inertial);
        // Twice the difference of the halves, for the indicator.
        axpy(self.force, -R::HALF, self.inertial);
        let difference = largest_force(model, self.force) * R::TWO * density;
        axpy(self.force, R::one(), self.inertial);
        to_world(c, density, self.force);
        if exact {
            add_frame_terms(links, self.qd, self.momentum, self.gradient, self.force);
            let scale = force_scale(model, self.force, self.momentum, self.qd);
            put(self.indicators, 1, if scale > R::zero() { difference / scale } else { R::zero() });
        }
    }

    /// Every force that comes neither from inertia nor from drives, into `outer`.
    pub(crate) fn outer_forces(&mut self, model: &Model<'_, R>) {
        let c = &configuration!(self, model);
        self.outer.fill(R::zero());
        let head = model.head;
        if head.plan.gravity {
            buoyancy::add_gradient(model, c.poses, self.outer);
        }
        if let Some(law) = head.repulsion {
            put(self.indicators, 2, repulsion::add_gradient(c, law, self.outer));
        }
        self.add_circulation(model);
    }

    /// Adds ∂T_c/∂q − G q̇ to `outer`.
    fn add_circulation(&mut self, model: &Model<'_, R>) {
        let (c, head) = (&configuration!(self, model), model.head);
        if !head.plan.circulation {
            return;
        }
        let density = head.fluid_density;
        if head.plan.formulation == Formulation::Kirchhoff {
            if head.gyroscopic {
                add_lone_circulation(c, self.qd, self.outer);
            }
            return;
        }
        let (system, mut flow, mut scratch) = (system!(self), flow!(self), scratch!(self));
        circulation::solve(c, &system, &mut flow);
        put(self.indicators, 3, circulation::data_error(c, &flow));
        circulation::add_energy_gradient(c, &system, &mut flow, &mut scratch, density, self.outer);
        if head.gyroscopic {
            circulation::add_gyroscopic_force(
                c,
                &system,
                &mut flow,
                &mut scratch,
                self.qd,
                self.v,
                self.adjoint,
                self.spare,
                density,
                self.outer,
            );
        }
    }

    /// Torques of the torque-driven joints, by free coordinate, into the reduced right-hand side.
    fn add_torques(&mut self, model: &Model<'_, R>, t: R) {
        let n = model.head.plan.free_coordinates;
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control == Control::Torque) {
            let torque = joint_torque(model, i, t, self.channels, at(self.s, i), at(self.ds, i));
            add(self.reduced, n * n + c.free, torque);
        }
    }

    /// Accelerations at (t, p, ṗ). Everything that diagnostics need is left in the buffers.
    pub(crate) fn evaluate(
        &mut self,
        model: &Model<'_, R>,
        impulse: &[R; 3],
        t: R,
        p: &[R],
        dp: &[R],
        counters: &mut Counters,
    ) -> Result<()> {
        counters.evaluations += 1;
        self.indicators.fill(R::zero());
        self.place(model, t, p, dp)?;
        self.grade(model)?;
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        self.fill_jacobian(model);
        self.solve_fluid(model, counters)?;
        self.reduce_mass(model)?;
        if locked {
            self.unlock(model, impulse);
        }
        if locked && !model.head.tracks_work {
            return self.check();
        }
        self.accelerate(model, t)
    }

    /// Accelerations, once velocities are known.
    pub(crate) fn accelerate(&mut self, model: &Model<'_, R>, t: R) -> Result<()> {
        let n = model.head.plan.free_coordinates;
        self.solve_motion(model, true);
        self.pass(model);
        // a + N_u ü
        for (dds, _) in self.dds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed) {
            *dds = R::zero();
        }
        accelerations(model, self.s, self.ds, self.dds, self.poses, self.qd, self.drift);
        self.outer_forces(model);
        self.fluid_force(model, Inertia::Drift);
        axpy(self.force, R::one(), self.outer);
        add_body_inertia(model, self.drift, self.force);
        project(model, self.s, self.poses, self.force, self.generalized);
        let rhs_at = n * n;
        for (c, g) in
            model.coordinates.iter().zip(self.generalized.iter()).filter(|(c, _)| c.control != Control::Prescribed)
        {
            put(self.reduced, rhs_at + c.free, -*g);
        }
        self.add_torques(model, t);
        self.solve_reduced(n);
        for (dds, c) in self.dds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed) {
            *dds = at(self.reduced, rhs_at + c.free);
        }
        accelerations(model, self.s, self.ds, self.dds, self.poses, self.qd, self.qdd);
        self.check()
    }

    fn check(&self) -> Result<()> {
        let all = self.qd.iter().chain(self.dds.iter());
        if all.clone().all(|x| x.is_finite()) { Ok(()) } else { Err(Status::NonFiniteState.into()) }
    }

    /// The forces that drive every coordinate, ν = (∂F/∂s)ᵀ [M q̈ + f], into `generalized`. After [`Work::accelerate`].
    pub(crate) fn drive_forces(&mut self, model: &Model<'_, R>) {
        self.fluid_force(model, Inertia::Accelerations);
        axpy(self.force, R::one(), self.outer);
        add_body_inertia(model, self.qdd, self.force);
        project(model, self.s, self.poses, self.force, self.generalized);
    }

    /// Christoffel force of the velocities in `qd` into `force`.
    pub(crate) fn christoffel_force(&mut self, model: &Model<'_, R>) {
        self.qdd.fill(R::zero());
        self.solve_motion(model, false);
        self.pass(model);
        self.fluid_force(model, Inertia::Accelerations);
    }

    /// Power of all drives: Σ ν ṡ over prescribed and torque-driven coordinates.
    pub(crate) fn power(&mut self, model: &Model<'_, R>, t: R) -> R {
        let prescribed = |c: &CoordinateRecord<R>| c.control == Control::Prescribed;
        let mut power = R::zero();
        for (i, (c, ds)) in model.coordinates.iter().zip(self.ds.iter()).enumerate() {
            power += match c.control {
                Control::Free => R::zero(),
                Control::Torque => joint_torque(model, i, t, self.channels, at(self.s, i), *ds) * *ds,
                // What the prescribed coordinates bear where the free ones do not accelerate.
                Control::Prescribed => at(self.generalized, i) * *ds,
            };
        }
        if model.head.prescribed_moves {
            // And what they bear of the free ones' accelerations, by the mass matrix of the columns.
            let (n, rows) = (model.head.plan.free_coordinates, 3 * model.links.len());
            for (c, dds) in model.coordinates.iter().zip(self.dds.iter()).filter(|(c, _)| !prescribed(c)) {
                power += *dds * self.coupling(model, c.free, n, rows);
            }
        }
        power
    }

    /// Entry of the mass matrix of two columns: of the fluid, symmetrized, and of the bodies.
    fn coupling(&self, model: &Model<'_, R>, k: usize, j: usize, rows: usize) -> R {
        let (column, other) = (part(self.jacobian, k * rows, rows), part(self.jacobian, j * rows, rows));
        let momenta = (part(self.momenta, k * rows, rows), part(self.momenta, j * rows, rows));
        let mut sum = (inner(column, momenta.1) + inner(other, momenta.0)) * R::HALF;
        for (i, link) in model.links.iter().enumerate() {
            let (a, b) = (twist_of(column, i), twist_of(other, i));
            sum += link.mass * crate::base::complex::dot(a.linear, b.linear) + link.inertia * a.angular * b.angular;
        }
        sum
    }

    /// Velocities of a lone swimmer's root from its impulse: N_pᵀ M (N_p ṗ + N_u u̇) = Π.
    fn unlock(&mut self, model: &Model<'_, R>, impulse: &[R; 3]) {
        let (n, rows) = (model.head.plan.free_coordinates, 3 * model.links.len());
        let [px, py, l] = *impulse;
        let (x, y) = (at(self.q, 0), at(self.q, 1));
        for (k, value) in [px, py, l - (x * py - y * px)].into_iter().enumerate() {
            let mut sum = value;
            if model.head.prescribed_moves {
                sum -= self.coupling(model, k, n, rows);
            }
            put(self.reduced, n * n + k, sum);
        }
        self.solve_reduced(n);
        for (ds, c) in self.ds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed) {
            *ds = at(self.reduced, n * n + c.free);
        }
        velocities(model, self.s, self.ds, self.poses, self.qd);
    }
}

/// Which accelerations `fluid_force` takes.
#[derive(Clone, Copy)]
enum Inertia {
    Drift,
    Accelerations,
}

/// ν(t) − k (u − rest) − c u̇ of a torque-driven joint.
pub(crate) fn joint_torque<R: Real>(model: &Model<'_, R>, coordinate: usize, t: R, channels: &[R], u: R, du: R) -> R {
    let Some(c) = model.coordinates.get(coordinate) else { return R::NAN };
    let [torque, _, _] = c.signal.evaluate(t, model.store, channels);
    torque - c.stiffness * (u - c.rest) - c.damping * du
}

/// Adds the bodies' own mass times accelerations.
fn add_body_inertia<R: Real>(model: &Model<'_, R>, w: &[R], force: &mut [R]) {
    for (i, l) in model.links.iter().enumerate() {
        let (a, f) = (twist_of(w, i), twist_of(force, i));
        put_three(force, i, f.linear + a.linear * l.mass, f.angular + a.angular * l.inertia);
    }
}

/// The largest of forces and of torques over the reach of their links.
pub(crate) fn largest_force<R: Real>(model: &Model<'_, R>, force: &[R]) -> R {
    let reaches = model.boundaries.iter().filter(|b| b.link.is_some()).map(|b| b.reach);
    force.chunks_exact(3).zip(reaches).fold(R::zero(), |most, (f, reach)| match f {
        &[x, y, torque] => most.max(x.abs()).max(y.abs()).max(torque.abs() / reach),
        _ => most,
    })
}

/// −G q̇ of a lone body: its circulation impulse turns with it.
pub(crate) fn add_lone_circulation<R: Real>(c: &Configuration<'_, R>, qd: &[R], force: &mut [R]) {
    let Some((body, _)) = c.boundary(0) else { return };
    let [px, py, _] = c.model.head.lone_impulse;
    let p = c.pose(0).turned(crate::base::complex::complex(px, py));
    let v = twist_of(qd, 0);
    let linear = crate::base::complex::perp(v.linear) * body.circulation - crate::base::complex::perp(p) * v.angular;
    let angular = v.linear.im * p.re - v.linear.re * p.im;
    let f = twist_of(force, 0);
    let density = c.model.head.fluid_density;
    put_three(force, 0, f.linear - linear * density, f.angular - angular * density);
}
