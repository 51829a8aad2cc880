//! Derivatives of the state's rates by state and parameters: those of the links' forces, carried through the tree of links.
//!
//! Along any direction (δs, δṡ, δs̈) of the coordinates the generalized residual Nᵀ r, r = M q̈ + F, changes by
//! δ = Nᵀ (H δq + C δq̇ + M δq̈) + δNᵀ r, and the free accelerations by −(N_pᵀ M N_p)⁻¹ (δ − δτ)_p. A lone swimmer's rates follow from
//! its impulse, of which only first derivatives of M are needed.
//!
//! Tested by `tests/derivatives`.

use crate::base::memory::{add, at, axpy, buffers, copy, part_mut, put};
use crate::base::scalar::Real;
use crate::dynamics::articulation::{project, velocities};
use crate::dynamics::derivatives::tree::{Along, Direction, Tree};
use crate::dynamics::derivatives::{Derivatives, frames};
use crate::dynamics::evaluation::Evaluation;
use crate::dynamics::forces::{buoyancy, repulsion};
use crate::fluid::tangent_pass::TangentScratch;
use crate::geometry::pose::{Poses, twist_of};
use crate::linear::ldl;
use crate::model::{Control, Formulation, Model};
use crate::scene::Repulsion;

/// What the motion may be differentiated by.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Parameter {
    /// Density of the fluid, kg/m²; masses of bodies stay as they are.
    FluidDensity,
    /// Gravity, m/s².
    Gravity,
    /// Mass of a link, kg/m.
    Mass(usize),
    /// Moment of inertia of a link about its centre of mass, kg·m.
    Inertia(usize),
    /// Force along x (0), along y (1), N/m, or torque about the centre of mass (2), N, on a link from outside, world.
    Wrench(usize, usize),
    /// Torque (hinge, N) or force (slider, N/m) added to a torque-driven joint's.
    Torque(usize),
    /// Spring constant of a torque-driven joint.
    Stiffness(usize),
    /// Damping constant of a torque-driven joint.
    Damping(usize),
    /// Unloaded value of the spring of a torque-driven joint.
    Rest(usize),
    /// Value u of a prescribed joint; its rate and acceleration stay.
    Position(usize),
    /// Its rate u̇.
    Rate(usize),
    /// Its acceleration ü.
    Acceleration(usize),
}

impl Parameter {
    /// Whether a model has it; what it is called otherwise.
    pub(crate) fn checked<R: Real>(self, model: &Model<'_, R>) -> Result<(), &'static str> {
        let joint = |j: usize, prescribed: bool| {
            model.joints().nth(j).is_some_and(|c| (c.control == Control::Prescribed) == prescribed)
        };
        // The impulse of a lone swimmer is no part of its state.
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let (sound, name) = match self {
            Parameter::FluidDensity => (model.head.plan.fluid, "fluid density"),
            Parameter::Gravity => (!locked, "gravity"),
            Parameter::Mass(i) => (i < model.links.len(), "mass"),
            Parameter::Inertia(i) => (i < model.links.len(), "inertia"),
            Parameter::Wrench(i, k) => (!locked && i < model.links.len() && k < 3, "wrench"),
            Parameter::Torque(j) => (joint(j, false), "torque"),
            Parameter::Stiffness(j) => (joint(j, false), "stiffness"),
            Parameter::Damping(j) => (joint(j, false), "damping"),
            Parameter::Rest(j) => (joint(j, false), "rest"),
            Parameter::Position(j) => (joint(j, true), "position"),
            Parameter::Rate(j) => (joint(j, true), "rate"),
            Parameter::Acceleration(j) => (joint(j, true), "acceleration"),
        };
        if sound { Ok(()) } else { Err(name) }
    }
}

/// Numbers that the arrays' lengths follow from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionDims {
    pub rows: usize,
    pub coordinates: usize,
}

buffers! {
    /// Vectors of one direction: c reals for coordinates, 3n for links.
    pub(crate) struct MotionScratch(d: MotionDims) {
        /// The direction: δs, δṡ, δs̈.
        s: R = d.coordinates,
        ds: R = d.coordinates,
        dds: R = d.coordinates,
        /// What follows of it for the links.
        q: R = d.rows,
        qd: R = d.rows,
        qdd: R = d.rows,
        /// r, and M q̇, of bodies and fluid.
        residual: R = d.rows,
        momentum: R = d.rows,
        /// A force on the links, and scratch of its projection.
        force: R = d.rows,
        carried: R = d.rows,
        moments: R = d.rows,
        /// Generalized forces: of r; of the direction.
        borne: R = d.coordinates,
        generalized: R = d.coordinates,
        /// Changes of the free rates or accelerations.
        solution: R = d.coordinates,
    }
}

/// One evaluation with what is needed to differentiate it.
pub(crate) struct Linearizer<'s, 'a, 'b, R: Real> {
    pub evaluation: &'s mut Evaluation<'a, R>,
    pub model: Model<'a, R>,
    /// Of a lone swimmer.
    pub impulse: [R; 3],
    pub d: Derivatives<'b, R>,
    pub m: MotionScratch<'b, R>,
}

impl<R: Real> Linearizer<'_, '_, '_, R> {
    /// Fills A = ∂ẏ/∂y and B = ∂ẏ/∂θ, column-major, for the state evaluated last.
    pub(crate) fn fill(
        &mut self,
        s: &mut TangentScratch<'_, R>,
        parameters: impl Iterator<Item = Parameter>,
        a: &mut [R],
        b: &mut [R],
    ) {
        let model = self.model;
        self.prepare(s);
        let rows = model.head.plan.state_len.max(1);
        let n = model.head.plan.free_coordinates;
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        a.fill(R::zero());
        b.fill(R::zero());
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            for rate in [false, true].into_iter().take(if locked { 1 } else { 2 }) {
                self.clear();
                put(if rate { &mut *self.m.ds } else { &mut *self.m.s }, i, R::one());
                self.direction(None);
                let column = c.free + if rate { n } else { 0 };
                self.write(None, part_mut(a, column * rows, rows));
            }
        }
        for (parameter, column) in parameters.zip(b.chunks_exact_mut(rows)) {
            self.clear();
            let coordinate = |j: usize| {
                model.coordinates.iter().enumerate().filter(|(_, c)| c.component == 3).nth(j).map_or(0, |(i, _)| i)
            };
            match parameter {
                Parameter::Position(j) => put(self.m.s, coordinate(j), R::one()),
                Parameter::Rate(j) => put(self.m.ds, coordinate(j), R::one()),
                Parameter::Acceleration(j) => put(self.m.dds, coordinate(j), R::one()),
                _ => {}
            }
            self.direction(Some(parameter));
            self.write(Some(parameter), column);
        }
    }

    /// H, C, M of bodies and fluid, the residual and its generalized forces.
    fn prepare(&mut self, s: &mut TangentScratch<'_, R>) {
        let (model, evaluation) = (&self.model, &mut *self.evaluation);
        let (d, m) = (&mut self.d, &mut self.m);
        copy(m.qdd, evaluation.forces.qdd);
        evaluation.force_derivatives(model, m.qdd, d, s);
        copy(m.momentum, evaluation.velocity.momentum);
        if model.head.plan.formulation == Formulation::LockedMomentum {
            // Q has served.
            frames::momentum_slopes(evaluation.velocity.qd, d.mass, d.slope, m.momentum, d.mixed);
        }
        for (i, l) in model.links.iter().enumerate() {
            for (k, mass) in [l.mass, l.mass, l.inertia].into_iter().enumerate() {
                add(m.momentum, 3 * i + k, mass * at(evaluation.velocity.qd, 3 * i + k));
            }
        }
        Evaluation::add_bodies(model, d.mass);
        // Of the accelerations it would tell another error than steps do.
        let indicators = evaluation.kept.indicators;
        evaluation.link_forces(model);
        evaluation.kept.indicators = indicators;
        copy(m.residual, evaluation.forces.force);
        copy(m.carried, m.residual);
        project(model, evaluation.coordinates.s, evaluation.placement.poses, m.carried, m.borne);
    }

    fn clear(&mut self) {
        for x in [&mut *self.m.s, &mut *self.m.ds, &mut *self.m.dds, &mut *self.m.solution] {
            x.fill(R::zero());
        }
    }

    /// What follows of the direction: changes of the rates of a lone swimmer, and of the free accelerations (in `solution`, by
    /// free coordinate).
    fn direction(&mut self, parameter: Option<Parameter>) {
        let model = self.model;
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        if locked {
            self.locked_rates(parameter);
            if !model.head.tracks_work {
                return;
            }
        }
        let (e, d, m) = (&*self.evaluation, &self.d, &mut self.m);
        along(&model, e, m);
        m.force.fill(R::zero());
        for (matrix, x) in [(&*d.position, &*m.q), (&*d.velocity, &*m.qd), (&*d.mass, &*m.qdd)] {
            add_product(matrix, x, m.force);
        }
        if let Some(parameter) = parameter {
            add_link_term(&model, e, m.residual, parameter, m.force);
        }
        copy(m.carried, m.residual);
        generalize(&model, e, m);
        for (i, c) in model.coordinates.iter().enumerate() {
            let term = self.joint_term(i, parameter);
            add(self.m.generalized, i, -term);
            if c.control != Control::Prescribed {
                put(self.m.solution, c.free, -at(self.m.generalized, i));
            }
        }
        self.solve();
    }

    /// Rates of a lone swimmer: N_pᵀ M q̇ is its impulse about its root.
    fn locked_rates(&mut self, parameter: Option<Parameter>) {
        let model = self.model;
        let (e, d, m) = (&*self.evaluation, &self.d, &mut self.m);
        along(&model, e, m);
        m.force.fill(R::zero());
        // Q holds ∂(M q̇)/∂q of the fluid.
        for (matrix, x) in [(&*d.mixed, &*m.q), (&*d.mass, &*m.qd)] {
            add_product(matrix, x, m.force);
        }
        match parameter {
            Some(Parameter::FluidDensity) => axpy(m.force, R::one() / model.head.fluid_density, e.velocity.momentum),
            Some(Parameter::Mass(i)) => {
                (3 * i..3 * i + 2).for_each(|k| add(m.force, k, at(e.velocity.qd, k)));
            }
            Some(Parameter::Inertia(i)) => add(m.force, 3 * i + 2, at(e.velocity.qd, 3 * i + 2)),
            _ => {}
        }
        copy(m.carried, m.momentum);
        generalize(&model, e, m);
        let [px, py, _] = self.impulse;
        let moved = at(m.s, 0) * py - at(m.s, 1) * px;
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            let turned = if c.component == 2 { moved } else { R::zero() };
            put(m.solution, c.free, -turned - at(m.generalized, i));
        }
        self.solve();
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            put(self.m.ds, i, at(self.m.solution, c.free));
        }
    }

    /// Solves with the reduced mass matrix, in place.
    fn solve(&mut self) {
        let (n, reduced) = (self.model.head.plan.free_coordinates, &self.evaluation.reduced);
        ldl::solve(reduced.mass, n, reduced.inverse_pivots, part_mut(self.m.solution, 0, n));
    }

    /// How the torque of a torque-driven joint changes; 0 for other coordinates.
    fn joint_term(&self, i: usize, parameter: Option<Parameter>) -> R {
        let Some(c) = self.model.coordinates.get(i).filter(|c| c.control == Control::Torque) else { return R::zero() };
        let (coordinates, m) = (&self.evaluation.coordinates, &self.m);
        let own = |j: usize| self.model.joints().nth(j).is_some_and(|other| other.link == c.link);
        let explicit = match parameter {
            Some(Parameter::Torque(j)) if own(j) => R::one(),
            Some(Parameter::Stiffness(j)) if own(j) => c.rest - at(coordinates.s, i),
            Some(Parameter::Damping(j)) if own(j) => -at(coordinates.ds, i),
            Some(Parameter::Rest(j)) if own(j) => c.stiffness,
            _ => R::zero(),
        };
        explicit - c.stiffness * at(m.s, i) - c.damping * at(m.ds, i)
    }

    /// Writes the changes of the state's rates.
    fn write(&mut self, parameter: Option<Parameter>, column: &mut [R]) {
        let model = self.model;
        let n = model.head.plan.free_coordinates;
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            put(column, c.free, at(self.m.ds, i));
            if !locked {
                put(column, n + c.free, at(self.m.solution, c.free));
            }
        }
        if model.head.tracks_work {
            let power = self.power(parameter);
            if let Some(last) = column.last_mut() {
                *last = power;
            }
        }
    }

    /// Change of the power of all drives, Σ ν ṡ.
    fn power(&mut self, parameter: Option<Parameter>) -> R {
        let model = self.model;
        let mut power = R::zero();
        for i in 0..model.coordinates.len() {
            power += self.joint_term(i, parameter) * at(self.evaluation.coordinates.ds, i);
        }
        let (e, d, m) = (&*self.evaluation, &self.d, &mut self.m);
        // What the changed accelerations of the free coordinates ask of the prescribed ones.
        m.dds.fill(R::zero());
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            put(m.dds, i, at(m.solution, c.free));
        }
        velocities(&model, e.coordinates.s, m.dds, e.placement.poses, m.qdd);
        m.force.fill(R::zero());
        add_product(d.mass, m.qdd, m.force);
        project(&model, e.coordinates.s, e.placement.poses, m.force, m.dds);
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Free) {
            let rate = at(e.coordinates.ds, i);
            if c.control == Control::Prescribed {
                power += (at(m.generalized, i) + at(m.dds, i)) * rate;
            }
            power += at(m.borne, i) * at(m.ds, i);
        }
        power
    }
}

/// The links' part of the direction.
fn along<R: Real>(model: &Model<'_, R>, e: &Evaluation<'_, R>, m: &mut MotionScratch<'_, R>) {
    let direction = Direction { s: m.s, ds: m.ds, dds: m.dds };
    tree(e).along(model, direction, &mut Along { q: m.q, qd: m.qd, qdd: m.qdd });
}

fn tree<'s, R: Real>(e: &'s Evaluation<'_, R>) -> Tree<'s, R> {
    Tree {
        s: e.coordinates.s,
        ds: e.coordinates.ds,
        dds: e.coordinates.dds,
        poses: Poses(e.placement.poses),
        qd: e.velocity.qd,
        qdd: e.forces.qdd,
    }
}

/// `generalized = Nᵀ force + δNᵀ carried`; both are overwritten.
fn generalize<R: Real>(model: &Model<'_, R>, e: &Evaluation<'_, R>, m: &mut MotionScratch<'_, R>) {
    project(model, e.coordinates.s, e.placement.poses, m.force, m.generalized);
    tree(e).add_projection(model, m.s, m.q, m.carried, m.moments, m.generalized);
}

/// `out += A x`, column by column.
fn add_product<R: Real>(matrix: &[R], x: &[R], out: &mut [R]) {
    for (column, x) in matrix.chunks_exact(out.len().max(1)).zip(x).filter(|(_, x)| **x != R::zero()) {
        axpy(out, *x, column);
    }
}

/// Adds how the residual of the links depends on a parameter of theirs.
fn add_link_term<R: Real>(
    model: &Model<'_, R>,
    e: &Evaluation<'_, R>,
    residual: &[R],
    parameter: Parameter,
    out: &mut [R],
) {
    let (density, gravity) = (model.head.fluid_density, model.head.gravity);
    match parameter {
        Parameter::FluidDensity => {
            for (i, link) in model.links.iter().enumerate() {
                for (k, mass) in [link.mass, link.mass, link.inertia].into_iter().enumerate() {
                    let at = |x: &[R]| at(x, 3 * i + k);
                    add(out, 3 * i + k, (at(residual) - at(e.forces.outer) - mass * at(e.forces.qdd)) / density);
                }
            }
            let poses = Poses(e.placement.poses);
            buoyancy::add_slope(model, poses, gravity, [R::zero(), R::one()], out);
            if model.head.plan.circulation {
                // What is left of the other forces without weight, buoyancy and repulsion.
                let inverse = R::one() / density;
                axpy(out, inverse, e.forces.outer);
                buoyancy::add_slope(model, poses, -gravity * inverse, [R::one(), density], out);
                if let Some(law) = model.head.repulsion {
                    let law = Repulsion { epsilon: -law.epsilon * inverse, ..law };
                    repulsion::add_gradient(&e.placement.configuration(model), law, out);
                }
            }
        }
        Parameter::Gravity => buoyancy::add_slope(model, Poses(e.placement.poses), R::one(), [R::one(), density], out),
        Parameter::Mass(i) => {
            let a = twist_of(e.forces.qdd, i).linear;
            add(out, 3 * i, a.re);
            add(out, 3 * i + 1, a.im + gravity);
        }
        Parameter::Inertia(i) => add(out, 3 * i + 2, at(e.forces.qdd, 3 * i + 2)),
        Parameter::Wrench(i, k) => add(out, 3 * i + k, -R::one()),
        _ => {}
    }
}
