//! What can be asked of a simulation at the state it shows: energies, impulses, gaps, forces, matrices, error
//! indicators. The first question after a step costs one evaluation; the following ones share it.

use crate::base::memory::{at, copy, part, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::accelerations::joint_torque;
use crate::dynamics::evaluation::Counters;
use crate::dynamics::evaluation::{Work, configuration, flow, scratch, system};
use crate::dynamics::forces::{buoyancy, circulation, repulsion};
use crate::fluid::configuration::Configuration;
use crate::fluid::contact::Gap;
use crate::fluid::contact::smallest_gap;
use crate::fluid::induced::PairScratch;
use crate::fluid::near::buffers::Near;
use crate::fluid::potentials::{
    add_interior_potential, add_potential_moments, fill_flux, flux_moments, to_link_frames, to_world,
};
use crate::fluid::system::BoundarySystem;
use crate::geometry::pose::Poses;
use crate::geometry::pose::{put_three, twist_of};
use crate::model::{Control, Formulation, Model};
use crate::simulation::sim::Sim;

/// Energies, J/m.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Energy<R> {
    /// Kinetic energy of the fluid moved by the bodies, ½ q̇ᵀ M^f q̇.
    pub kinetic_fluid: R,
    /// Kinetic energy of the bodies.
    pub kinetic_bodies: R,
    /// Potential energy of weight and buoyancy.
    pub buoyancy: R,
    /// Potential energy of repulsion.
    pub repulsion: R,
    /// Kinetic energy of the circulatory flow (up to a constant; 0 for a lone body in unbounded fluid).
    pub circulation: R,
    /// Sum of the five.
    pub total: R,
    /// Work done by the drives since the start; total − work is constant.
    pub work: R,
}

impl<R: Real> Work<'_, R> {
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
            let (p, v) = (twist_of(self.momentum, i), twist_of(self.qd, i));
            let linear = p.linear + v.linear * l.mass;
            let (x, y) = (at(self.q, 3 * i), at(self.q, 3 * i + 1));
            total[0] += linear.re;
            total[1] += linear.im;
            total[2] += p.angular + v.angular * l.inertia + x * linear.im - y * linear.re;
        }
        total
    }

    /// `out = M^f e` per unit density for a world direction `e` of one coordinate; `transposed`: the other half.
    pub(crate) fn mass_column(&mut self, model: &Model<'_, R>, direction: usize, transposed: bool, out: &mut [R]) {
        let c = &configuration!(self, model);
        out.fill(R::zero());
        put(out, direction, R::one());
        to_link_frames(c, out, self.v);
        let system = system!(self);
        if transposed {
            fill_flux(c, self.v, self.solution);
            out.fill(R::zero());
            add_potential_moments(c, self.solution, R::one(), out);
            system.factors().solve_transposed(self.solution);
            add_potential_moments(c, self.solution, -R::TWO, out);
        } else {
            self.solution.fill(R::zero());
            add_interior_potential(c, self.v, -R::TWO, self.solution);
            system.factors().solve(self.solution);
            add_interior_potential(c, self.v, R::one(), self.solution);
            flux_moments(c, self.solution, out);
        }
        to_world(c, R::one(), out);
    }
}

impl<R: Real> Sim<'_, R> {
    pub(crate) fn rows(&self) -> usize {
        3 * self.model.links.len()
    }

    fn expect(&self, given: usize, needed: usize) -> Result<()> {
        if given == needed { Ok(()) } else { Err(Error::new(Status::Length).of("length", given as f64)) }
    }

    /// The smallest gap between boundaries of which one moves. O(N²) for pairs that are not clearly apart; no evaluation.
    pub fn gap(&mut self) -> Gap<R> {
        let poses = &mut *self.work.poses;
        let walls = self.model.head.plan.walls;
        for i in 0..self.model.links.len() {
            if let &[x, y, theta] = part(self.state.positions, 3 * i, 3) {
                crate::geometry::pose::put_pose(poses, walls + i, &crate::geometry::pose::Pose::new(x, y, theta));
            }
        }
        smallest_gap(&self.model, Poses(poses))
    }

    /// Energies at the state shown.
    ///
    /// # Errors
    /// As an evaluation: `Contact`, `Singular`, `NonFiniteState`.
    pub fn energy(&mut self) -> Result<Energy<R>> {
        self.refresh()?;
        let (model, head) = (self.model, self.model.head);
        let c = &configuration!(self.work, &model);
        let kinetic_fluid =
            self.work.momentum.iter().zip(self.work.qd.iter()).fold(R::zero(), |s, (p, v)| s + *p * *v) * R::HALF;
        let kinetic_bodies = buoyancy::kinetic_bodies(&model, self.work.qd);
        let zero = R::zero();
        let weight = if head.plan.gravity { buoyancy::energy(&model, c.poses, self.work.q) } else { zero };
        let repulsion = head.repulsion.map_or(zero, |law| repulsion::energy(c, law));
        let circulation =
            if self.circulates() { circulation::energy(&flow!(self.work)) * head.fluid_density } else { zero };
        let work = if head.tracks_work { self.state.y.last().copied().unwrap_or(zero) } else { zero };
        let total = kinetic_fluid + kinetic_bodies + weight + repulsion + circulation;
        Ok(Energy { kinetic_fluid, kinetic_bodies, buoyancy: weight, repulsion, circulation, total, work })
    }

    fn circulates(&self) -> bool {
        self.model.head.plan.circulation && self.model.head.plan.formulation != Formulation::Kirchhoff
    }

    /// Linear impulse (x, y) and angular impulse about the origin of bodies, fluid and circulation. Constant in unbounded
    /// fluid without gravity and obstacles (with circulation: in the full model).
    ///
    /// # Errors
    /// As [`Sim::energy`].
    pub fn impulse(&mut self) -> Result<[R; 3]> {
        self.refresh()?;
        let mut total = self.work.total_impulse(&self.model);
        if !self.model.head.plan.circulation {
            return Ok(total);
        }
        let (model, density) = (self.model, self.model.head.fluid_density);
        let c = &configuration!(self.work, &model);
        if self.circulates() {
            circulation::impulse(c, &flow!(self.work), self.work.spare);
        } else {
            let [x, y, a] = model.head.lone_impulse;
            put_three(self.work.spare, 0, c.pose(0).turned(crate::base::complex::complex(x, y)), a);
        }
        for (_, b, _) in model.each_boundary() {
            let Some(link) = b.link else { continue };
            let p = twist_of(self.work.spare, link);
            let (x, y) = (at(self.work.q, 3 * link), at(self.work.q, 3 * link + 1));
            // The canonical impulse: P − γ J r, with angular part P_θ + r × P − γ |r|²/2.
            let gamma = b.circulation;
            total[0] += density * (p.linear.re + gamma * y);
            total[1] += density * (p.linear.im - gamma * x);
            total[2] += density * (p.angular + x * p.linear.im - y * p.linear.re - gamma * (x * x + y * y) * R::HALF);
        }
        Ok(total)
    }

    /// Torque (force for a slider) that drives every joint, and its power ν u̇ (7.2). `joint_count` each.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn joint_torques(&mut self, torque: &mut [R], power: &mut [R]) -> Result<()> {
        self.expect(torque.len(), self.model.joint_count())?;
        self.expect(power.len(), self.model.joint_count())?;
        self.refresh()?;
        let model = self.model;
        self.work.drive_forces(&model);
        let joints = model.coordinates.iter().enumerate().filter(|(_, c)| c.component == 3);
        for ((torque, power), (k, c)) in torque.iter_mut().zip(power.iter_mut()).zip(joints) {
            let (u, du) = (at(self.work.s, k), at(self.work.ds, k));
            *torque = match c.control {
                Control::Torque => joint_torque(&model, k, self.head.time, self.work.channels, u, du),
                _ => at(self.work.generalized, k),
            };
            *power = *torque * du;
        }
        Ok(())
    }

    /// Accelerations q̈ (3 per link).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn accelerations(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.refresh()?;
        copy(out, self.work.qdd);
        Ok(())
    }

    /// Symmetrized added mass M^f (3n × 3n, column-major). 3n solves.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn added_mass(&mut self, out: &mut [R]) -> Result<()> {
        let n = self.rows();
        self.expect(out.len(), n * n)?;
        self.refresh()?;
        let (model, density) = (self.model, self.model.head.fluid_density);
        out.fill(R::zero());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            for (k, column) in self.work.momenta.chunks_exact(n.max(1)).zip(out.chunks_exact_mut(n.max(1))) {
                copy(column, k);
            }
            return Ok(());
        }
        if !model.head.plan.fluid {
            return Ok(());
        }
        for (k, column) in out.chunks_exact_mut(n.max(1)).enumerate() {
            self.work.mass_column(&model, k, false, column);
        }
        self.head.fresh = false;
        for i in 0..n {
            for j in 0..=i {
                let mean = (at(out, i * n + j) + at(out, j * n + i)) * R::HALF * density;
                put(out, i * n + j, mean);
                put(out, j * n + i, mean);
            }
        }
        Ok(())
    }

    /// Mass matrix M = diag(m, m, I) + M^f (3n × 3n, column-major).
    ///
    /// # Errors
    /// As [`Sim::added_mass`].
    pub fn mass_matrix(&mut self, out: &mut [R]) -> Result<()> {
        self.added_mass(out)?;
        let n = self.rows();
        for (i, l) in self.model.links.iter().enumerate() {
            for (k, m) in [l.mass, l.mass, l.inertia].into_iter().enumerate() {
                crate::base::memory::add(out, (3 * i + k) * (n + 1), m);
            }
        }
        Ok(())
    }

    /// Christoffel force ⟨Γ, q̇, q̇⟩ (3 per link), by the scene's formula.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn christoffel(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.refresh()?;
        let model = self.model;
        self.work.christoffel_force(&model);
        copy(out, self.work.force);
        self.head.fresh = false;
        Ok(())
    }

    /// The full tensor Γ of the Christoffel force, ⟨Γ, v, w⟩_a = Σ Γ_aij v_i w_j: n = 3 links, entry (a, i, j) at a + n (i + n j),
    /// symmetric in i and j. By polarization: n (n+1)/2 forces, each O(N²). For inspection, never needed in a step.
    ///
    /// # Errors
    /// `Length` unless n³ long, and as [`Sim::energy`].
    pub fn christoffel_tensor(&mut self, out: &mut [R]) -> Result<()> {
        let n = self.rows();
        self.expect(out.len(), n * n * n)?;
        self.refresh()?;
        let model = self.model;
        self.head.fresh = false;
        // Γ(e_i, e_i) first, then 2 Γ(e_i, e_j) = Γ(e_i + e_j, e_i + e_j) − Γ(e_i, e_i) − Γ(e_j, e_j).
        for (i, j) in (0..n).map(|i| (i, i)).chain((0..n).flat_map(|j| (0..j).map(move |i| (i, j)))) {
            self.work.qd.fill(R::zero());
            put(self.work.qd, i, R::one());
            put(self.work.qd, j, R::one());
            self.work.christoffel_force(&model);
            for a in 0..n {
                let force = at(self.work.force, a);
                let entry = |i: usize, j: usize| a + n * (i + n * j);
                if i == j {
                    put(out, entry(i, i), force);
                } else {
                    let mixed = (force - at(out, entry(i, i)) - at(out, entry(j, j))) * R::HALF;
                    put(out, entry(i, j), mixed);
                    put(out, entry(j, i), mixed);
                }
            }
        }
        Ok(())
    }

    /// ∂P/∂q of weight and buoyancy (3 per link).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn buoyancy(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.refresh()?;
        out.fill(R::zero());
        buoyancy::add_gradient(&self.model, Poses(self.work.poses), out);
        Ok(())
    }

    /// ∂V/∂q of repulsion (3 per link); 0 without repulsion.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn repulsion(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.refresh()?;
        out.fill(R::zero());
        if let Some(law) = self.model.head.repulsion {
            repulsion::add_gradient(&configuration!(self.work, &self.model), law, out);
        }
        Ok(())
    }

    /// ∂T_c/∂q of the circulatory flow's energy (3 per link); 0 without circulation.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn circulation_gradient(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.refresh()?;
        out.fill(R::zero());
        if self.circulates() {
            let (model, w) = (self.model, &mut self.work);
            let (system, mut flow, mut scratch) = (system!(w), flow!(w), scratch!(w));
            let density = model.head.fluid_density;
            circulation::add_energy_gradient(
                &configuration!(w, &model),
                &system,
                &mut flow,
                &mut scratch,
                density,
                out,
            );
        }
        Ok(())
    }

    /// The antisymmetric matrix G of the force +G q̇ linear in the velocities (3n × 3n, column-major); 0 without circulation
    /// and in the paper's model. 6n solves.
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn gyroscopic(&mut self, out: &mut [R]) -> Result<()> {
        let n = self.rows();
        self.expect(out.len(), n * n)?;
        self.refresh()?;
        out.fill(R::zero());
        let model = self.model;
        if !model.head.gyroscopic {
            return Ok(());
        }
        for (k, column) in out.chunks_exact_mut(n.max(1)).enumerate() {
            self.work.gyroscopic_column(&model, k);
            copy(column, self.work.force);
            for x in column {
                *x = -*x;
            }
        }
        self.head.fresh = false;
        Ok(())
    }
}

impl<R: Real> Work<'_, R> {
    /// −G e_k into `force` for the motion of one coordinate alone.
    fn gyroscopic_column(&mut self, model: &Model<'_, R>, k: usize) {
        let c = &configuration!(self, model);
        self.force.fill(R::zero());
        self.qd.fill(R::zero());
        put(self.qd, k, R::one());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            crate::dynamics::accelerations::add_lone_circulation(c, self.qd, self.force);
            return;
        }
        to_link_frames(c, self.qd, self.v);
        fill_flux(c, self.v, self.adjoint);
        let (system, mut flow, mut scratch) = (system!(self), flow!(self), scratch!(self));
        system.factors().solve_transposed(self.adjoint);
        circulation::add_gyroscopic_force(
            c,
            &system,
            &mut flow,
            &mut scratch,
            self.qd,
            self.v,
            self.adjoint,
            self.spare,
            model.head.fluid_density,
            self.force,
        );
    }
}
