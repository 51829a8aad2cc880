//! The equations of motion: from time, coordinates and rates to accelerations, and the forces of the drives.
//!
//! q = F(p, u) with free coordinates p and prescribed ones u; N = ∂F/∂(p, u), q̈ = N (p̈, ü) + a. With f every force except
//! M q̈ the free coordinates obey N_pᵀ M N_p p̈ = τ − N_pᵀ [M (a + N_u ü) + f] (6.3); the prescribed ones then take
//! ν = N_uᵀ [M q̈ + f] (7.2). Torque-driven joints are free coordinates with a torque τ (Theorem 7.1).
//!
//! Tested by `tests/articulated`, `tests/conservation`, `tests/driving`.

use crate::base::memory::{add, at, axpy, copy, inner, put};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::dynamics::articulation::{accelerations, project, velocities};
use crate::dynamics::christoffel::{add_frame_terms, boundary_formula, without_turning};
use crate::dynamics::evaluation::{Coordinates, Counters, Evaluation, Indicators};
use crate::dynamics::forces::circulation::{Circulation, Moving, data_error, solve};
use crate::dynamics::forces::{buoyancy, repulsion};
use crate::dynamics::kirchhoff::{add_lone_circulation, lone_momentum};
use crate::dynamics::sizes::relative_force;
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::{
    add_interior_potential, add_potential_moments, fill_flux, flux_moments, to_link_frames, to_world,
};
use crate::geometry::pose::{put_three, twist_of};
use crate::model::signal::Moment;
use crate::model::{Control, CoordinateRecord, Formulation, Model};
use crate::scene::ForceFormula;

impl<R: Real> Evaluation<'_, R> {
    /// One pass over the pairs: both rates and the gradient of the motion (exact-gradient formula).
    pub(crate) fn pass(&mut self, model: &Model<'_, R>) {
        let (c, motion) = (&self.placement.configuration(model), &mut self.velocity);
        motion.gradient.fill(R::zero());
        if model.head.plan.unknowns > 0 && model.head.force == ForceFormula::ExactGradient {
            let out = PassResult { rate: motion.rate, transposed: motion.transposed, gradient: motion.gradient };
            pair_pass(c, motion.qd, motion.density, motion.adjoint, &mut self.pairs, out);
            for g in motion.gradient.iter_mut() {
                *g *= model.head.fluid_density;
            }
        }
    }

    /// `force = F + M^f w` for accelerations w of the links: the Christoffel force and the fluid's inertia, in world directions. Both
    /// are formed from both halves of the symmetrized discrete added mass, so the discrete energy balance is exact at any
    /// resolution. One ordinary and one transposed solve.
    fn fluid_force(&mut self, model: &Model<'_, R>, w: Inertia) {
        let links = model.links.len();
        let (c, density) = (&self.placement.configuration(model), model.head.fluid_density);
        let (motion, scratch) = (&mut self.velocity, &mut self.scratch);
        let force = &mut *self.forces.force;
        force.fill(R::zero());
        if !model.head.plan.fluid {
            return;
        }
        let lone = model.head.plan.formulation == Formulation::Kirchhoff;
        let exact = model.head.force == ForceFormula::ExactGradient || lone;
        let base: &[R] = match w {
            Inertia::Drift => self.forces.drift,
            Inertia::Accelerations => self.forces.qdd,
        };
        let inertial = &mut *scratch.three;
        if exact {
            without_turning(links, base, motion.qd, inertial);
        } else {
            copy(inertial, base);
        }
        if lone {
            lone_momentum(c, inertial, force);
            add_frame_terms(links, motion.qd, motion.momentum, motion.gradient, force);
            return;
        }
        if model.head.plan.unknowns == 0 {
            return;
        }
        let (w, solution, transposed) = (&mut *scratch.other, &mut *scratch.solution, &mut *scratch.transposed);
        to_link_frames(c, inertial, w);
        if exact {
            copy(solution, motion.rate);
        } else {
            // (2.15): the part that multiplies b_a now; Σ ψ_a kernel = Xᵀ (kernel − 2 A⁻ᵀ kernel), of which the second
            // term rides on the solve below as l = 2 kernel.
            copy(solution, motion.density);
            add_interior_potential(c, motion.in_links, R::one(), solution);
            boundary_formula(c, solution, motion.in_links, motion.transposed, self.pairs.hx, force);
            add_potential_moments(c, motion.transposed, R::one(), force);
            for l in motion.transposed.iter_mut() {
                *l *= R::TWO;
            }
            solution.fill(R::zero());
        }
        // ½ T₂ + ½ M_hᵀ w = Xᵀ [½ B w − A⁻ᵀ (l + B w)]
        fill_flux(c, w, transposed);
        add_potential_moments(c, transposed, R::HALF, force);
        axpy(transposed, R::one(), motion.transposed);
        // The vector of the links serves for moments now.
        let moments = inertial;
        if model.head.plan.free_coordinates == 3 * links {
            // The columns are the motions of each link by itself: Xᵀ A⁻ᵀ = −½ uᵀ.
            for (k, f) in moments.iter_mut().enumerate() {
                *f = inner(self.system.column(k), transposed) * R::HALF;
            }
            for i in 0..links {
                let (f, turned) = (twist_of(force, i), twist_of(moments, i));
                let linear = c.pose(model.head.plan.walls + i).unturned(turned.linear);
                put_three(force, i, f.linear + linear, f.angular + turned.angular);
            }
        } else {
            self.system.factors().solve_transposed(transposed);
            add_potential_moments(c, transposed, -R::one(), force);
        }
        // ½ T₁ + ½ M_h w = ½ Bᵀ [A⁻¹ (a − 2 X w) + X w]
        add_interior_potential(c, w, -R::TWO, solution);
        self.system.factors().solve(solution);
        add_interior_potential(c, w, R::one(), solution);
        flux_moments(c, solution, moments);
        // Twice the difference of the halves, for the indicator.
        axpy(force, -R::HALF, moments);
        copy(w, force);
        axpy(force, R::one(), moments);
        to_world(c, density, force);
        if exact {
            add_frame_terms(links, motion.qd, motion.momentum, motion.gradient, force);
            let relative = relative_force(model, w, force, motion.momentum, motion.qd);
            self.kept.indicators.force = relative * R::TWO * density;
        }
    }

    /// Every force that comes neither from inertia nor from drives, into `outer`.
    pub(crate) fn outer_forces(&mut self, model: &Model<'_, R>) {
        let (c, head) = (&self.placement.configuration(model), model.head);
        let outer = &mut *self.forces.outer;
        outer.fill(R::zero());
        if head.plan.gravity {
            buoyancy::add_gradient(model, c.poses, outer);
        }
        if let Some(law) = head.repulsion {
            self.kept.indicators.repulsion = repulsion::add_gradient(c, law, outer);
        }
        self.add_circulation(model);
    }

    /// Adds ∂T_c/∂q − G q̇ to `outer`.
    pub(crate) fn add_circulation(&mut self, model: &Model<'_, R>) {
        let (c, head) = (&self.placement.configuration(model), model.head);
        if !head.plan.circulation {
            return;
        }
        let (density, motion, outer) = (head.fluid_density, &mut self.velocity, &mut *self.forces.outer);
        if head.plan.formulation == Formulation::Kirchhoff {
            if head.gyroscopic {
                add_lone_circulation(c, motion.qd, outer);
            }
            return;
        }
        let difference = solve(c, &self.system, &mut self.circulation);
        self.kept.indicators.circulation = data_error(c, &self.circulation, difference);
        let (system, flow, pairs) = (&self.system, &mut self.circulation, &mut self.pairs);
        let mut circulation = Circulation { c, system, flow, pairs };
        circulation.add_energy_gradient(density, outer);
        if head.gyroscopic {
            let motion = Moving { qd: motion.qd, in_links: motion.in_links, adjoint: motion.adjoint };
            circulation.add_gyroscopic_force(motion, self.scratch.other, density, outer);
        }
    }

    /// Torques of the torque-driven joints, by free coordinate, into the reduced right-hand side.
    fn add_torques(&mut self, model: &Model<'_, R>, t: R) {
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control == Control::Torque) {
            let torque = joint_torque(
                model,
                i,
                Moment { t, after: !self.kept.before },
                self.coordinates.channels,
                at(self.coordinates.s, i),
                at(self.coordinates.ds, i),
            );
            add(self.reduced.rhs, c.free, torque);
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
        self.kept.indicators = Indicators::default();
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
        for (dds, _) in
            self.coordinates.dds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed)
        {
            *dds = R::zero();
        }
        self.accelerate_links(model, Inertia::Drift);
        self.outer_forces(model);
        self.generalize_forces(model, Inertia::Drift);
        for (c, g) in model
            .coordinates
            .iter()
            .zip(self.forces.generalized.iter())
            .filter(|(c, _)| c.control != Control::Prescribed)
        {
            put(self.reduced.rhs, c.free, -*g);
        }
        self.add_torques(model, t);
        self.solve_reduced(n);
        for (dds, c) in
            self.coordinates.dds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed)
        {
            *dds = at(self.reduced.rhs, c.free);
        }
        self.accelerate_links(model, Inertia::Accelerations);
        self.check()
    }

    /// Accelerations of the links for the coordinates' accelerations.
    fn accelerate_links(&mut self, model: &Model<'_, R>, w: Inertia) {
        let (Coordinates { s, ds, dds, .. }, forces) = (&self.coordinates, &mut self.forces);
        let out = match w {
            Inertia::Drift => &mut *forces.drift,
            Inertia::Accelerations => &mut *forces.qdd,
        };
        accelerations(model, s, ds, dds, self.placement.poses, self.velocity.qd, out);
    }

    /// M w + f in `force`, and (∂F/∂s)ᵀ of it in `generalized`.
    fn generalize_forces(&mut self, model: &Model<'_, R>, w: Inertia) {
        self.add_forces(model, w);
        let forces = &mut self.forces;
        project(model, self.coordinates.s, self.placement.poses, forces.force, forces.generalized);
    }

    /// M q̈ + f of the links in `force`. After [`Evaluation::accelerate`].
    #[cfg(feature = "derivatives")]
    pub(crate) fn link_forces(&mut self, model: &Model<'_, R>) {
        self.add_forces(model, Inertia::Accelerations);
    }

    /// M w + f in `force`.
    fn add_forces(&mut self, model: &Model<'_, R>, w: Inertia) {
        self.fluid_force(model, w);
        let forces = &mut self.forces;
        axpy(forces.force, R::one(), forces.outer);
        let accelerations = match w {
            Inertia::Drift => &*forces.drift,
            Inertia::Accelerations => &*forces.qdd,
        };
        add_body_inertia(model, accelerations, forces.force);
    }

    fn check(&self) -> Result<()> {
        let all = self.velocity.qd.iter().chain(self.coordinates.dds.iter());
        if all.clone().all(|x| x.is_finite()) { Ok(()) } else { Err(Status::NonFiniteState.into()) }
    }

    /// The forces that drive every coordinate, ν = (∂F/∂s)ᵀ [M q̈ + f], into `generalized`. After [`Evaluation::accelerate`].
    pub(crate) fn drive_forces(&mut self, model: &Model<'_, R>) {
        self.generalize_forces(model, Inertia::Accelerations);
    }

    /// Christoffel force of the velocities in `qd` into `force`.
    pub(crate) fn christoffel_force(&mut self, model: &Model<'_, R>) {
        self.kept.shown = false;
        self.forces.qdd.fill(R::zero());
        self.solve_motion(model, false);
        self.pass(model);
        self.fluid_force(model, Inertia::Accelerations);
    }

    /// −G e_k into `force` for the motion of one coordinate alone, which takes the place of the velocity.
    pub(crate) fn gyroscopic_column(&mut self, model: &Model<'_, R>, k: usize) {
        self.kept.shown = false;
        let (c, motion, force) = (&self.placement.configuration(model), &mut self.velocity, &mut *self.forces.force);
        force.fill(R::zero());
        motion.qd.fill(R::zero());
        put(motion.qd, k, R::one());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            add_lone_circulation(c, motion.qd, force);
            return;
        }
        to_link_frames(c, motion.qd, motion.in_links);
        fill_flux(c, motion.in_links, motion.adjoint);
        self.system.factors().solve_transposed(motion.adjoint);
        let motion = Moving { qd: motion.qd, in_links: motion.in_links, adjoint: motion.adjoint };
        let mut circulation =
            Circulation { c, system: &self.system, flow: &mut self.circulation, pairs: &mut self.pairs };
        circulation.add_gyroscopic_force(motion, self.scratch.other, model.head.fluid_density, force);
    }

    /// Adds ∂T_c/∂q at the position evaluated last to `out`.
    pub(crate) fn add_circulation_gradient(&mut self, model: &Model<'_, R>, out: &mut [R]) {
        let c = &self.placement.configuration(model);
        let mut circulation =
            Circulation { c, system: &self.system, flow: &mut self.circulation, pairs: &mut self.pairs };
        circulation.add_energy_gradient(model.head.fluid_density, out);
    }

    /// Power of all drives: Σ ν ṡ over prescribed and torque-driven coordinates.
    pub(crate) fn power(&mut self, model: &Model<'_, R>, t: R) -> R {
        let prescribed = |c: &CoordinateRecord<R>| c.control == Control::Prescribed;
        let (mut power, at_time) = (R::zero(), Moment { t, after: !self.kept.before });
        for (i, (c, ds)) in model.coordinates.iter().zip(self.coordinates.ds.iter()).enumerate() {
            power += match c.control {
                Control::Free => R::zero(),
                Control::Torque => {
                    joint_torque(model, i, at_time, self.coordinates.channels, at(self.coordinates.s, i), *ds) * *ds
                }
                // What the prescribed coordinates bear where the free ones do not accelerate.
                Control::Prescribed => at(self.forces.generalized, i) * *ds,
            };
        }
        if model.head.prescribed_moves {
            // And what they bear of the free ones' accelerations, by the mass matrix of the columns.
            let n = model.head.plan.free_coordinates;
            for (c, dds) in model.coordinates.iter().zip(self.coordinates.dds.iter()).filter(|(c, _)| !prescribed(c)) {
                power += *dds * self.coupling(model, c.free, n);
            }
        }
        power
    }

    /// Velocities of a lone swimmer's root from its impulse: N_pᵀ M (N_p ṗ + N_u u̇) = Π.
    fn unlock(&mut self, model: &Model<'_, R>, impulse: &[R; 3]) {
        let n = model.head.plan.free_coordinates;
        let [px, py, l] = *impulse;
        let (x, y) = (at(self.placement.q, 0), at(self.placement.q, 1));
        for (k, value) in [px, py, l - (x * py - y * px)].into_iter().enumerate() {
            let mut sum = value;
            if model.head.prescribed_moves {
                sum -= self.coupling(model, k, n);
            }
            put(self.reduced.rhs, k, sum);
        }
        self.solve_reduced(n);
        for (ds, c) in
            self.coordinates.ds.iter_mut().zip(model.coordinates).filter(|(_, c)| c.control != Control::Prescribed)
        {
            *ds = at(self.reduced.rhs, c.free);
        }
        velocities(model, self.coordinates.s, self.coordinates.ds, self.placement.poses, self.velocity.qd);
    }
}

/// Which accelerations `fluid_force` takes.
#[derive(Clone, Copy)]
enum Inertia {
    Drift,
    Accelerations,
}

/// ν(t) − k (u − rest) − c u̇ of a torque-driven joint.
pub(crate) fn joint_torque<R: Real>(
    model: &Model<'_, R>,
    coordinate: usize,
    at: Moment<R>,
    channels: &[R],
    u: R,
    du: R,
) -> R {
    let Some(c) = model.coordinates.get(coordinate) else { return R::NAN };
    let [torque, _, _] = c.signal.evaluate(at, model.store, channels);
    torque - c.stiffness * (u - c.rest) - c.damping * du
}

/// Adds the bodies' own mass times accelerations.
fn add_body_inertia<R: Real>(model: &Model<'_, R>, w: &[R], force: &mut [R]) {
    for (i, l) in model.links.iter().enumerate() {
        let (a, f) = (twist_of(w, i), twist_of(force, i));
        put_three(force, i, f.linear + a.linear * l.mass, f.angular + a.angular * l.inertia);
    }
}
