//! What can be asked of a simulation at the state it shows: energies, impulses, gaps, forces, matrices, error
//! indicators. The first question after a step costs one evaluation; the following ones share it.
//!
//! Tested by `tests/conservation`, `tests/reference_values`, `tests/gradients`, `tests/articulated`.

use crate::base::memory::{at, copy, part, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::accelerations::joint_torque;
use crate::dynamics::evaluation::Evaluation;
use crate::dynamics::forces::{buoyancy, circulation, repulsion};
use crate::fluid::contact::{Gap, smallest_gap};
use crate::geometry::pose::{Poses, put_three, twist_of};
use crate::model::signal::Moment;
use crate::model::{Control, Formulation};
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

/// Balance of energy, J/m.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EnergyDrift<R> {
    /// Total − work, now minus at first.
    pub amount: R,
    /// The largest kinetic energy met when energies were asked for.
    pub kinetic: R,
    /// From where on it is noticed: a thousandth of `kinetic`, with what a hundred times the absolute tolerance of `Adams` makes of it,
    /// or rounding of the energies.
    pub allowed: R,
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
        let poses = &mut *self.evaluation.placement.poses;
        let walls = self.model.head.plan.walls;
        for i in 0..self.model.links.len() {
            if let &[x, y, theta] = part(self.state.positions, 3 * i, 3) {
                crate::geometry::pose::put_pose(poses, walls + i, &crate::geometry::pose::Pose::new(x, y, theta));
            }
        }
        smallest_gap(&self.model, Poses(poses))
    }

    /// Energies at the state shown, J/m: ½ q̇ᵀ M q̇ (2.11) of fluid and bodies, P (2.8), V (5.1), T_c (section 3 of the paper). O(N²)
    /// with repulsion, else O(N); like every question one evaluation more if it is the first one after a step.
    ///
    /// # Errors
    /// As an evaluation: `Contact`, `Singular`, `NonFiniteState`.
    pub fn energy(&mut self) -> Result<Energy<R>> {
        self.evaluated()?;
        let (model, head) = (self.model, self.model.head);
        let c = &self.evaluation.placement.configuration(&model);
        let kinetic_fluid = self
            .evaluation
            .velocity
            .momentum
            .iter()
            .zip(self.evaluation.velocity.qd.iter())
            .fold(R::zero(), |s, (p, v)| s + *p * *v)
            * R::HALF;
        let kinetic_bodies = buoyancy::kinetic_bodies(&model, self.evaluation.velocity.qd);
        let zero = R::zero();
        let weight =
            if head.plan.gravity { buoyancy::energy(&model, c.poses, self.evaluation.placement.q) } else { zero };
        let repulsion = head.repulsion.map_or(zero, |law| repulsion::energy(c, law));
        let circulation = if self.circulates() {
            circulation::energy(&self.evaluation.circulation) * head.fluid_density
        } else {
            zero
        };
        let work = if head.tracks_work { self.state.y.last().copied().unwrap_or(zero) } else { zero };
        let total = kinetic_fluid + kinetic_bodies + weight + repulsion + circulation;
        let sizes = [kinetic_fluid, kinetic_bodies, weight, repulsion, circulation, work];
        self.progress.balance.add(total - work, &sizes, self.state.velocities, self.progress.time);
        Ok(Energy { kinetic_fluid, kinetic_bodies, buoyancy: weight, repulsion, circulation, total, work })
    }

    /// By how much energy − work differs from what it was when an energy was first asked for since [`Sim::set_state`]: the error of the
    /// whole motion, of whatever origin, that no estimate of single steps can miss. Ask at the start, too. One evaluation if nothing was
    /// asked at this state, as [`Sim::energy`].
    ///
    /// # Errors
    /// As [`Sim::energy`].
    pub fn energy_drift(&mut self) -> Result<EnergyDrift<R>> {
        self.energy()?;
        let b = self.progress.balance;
        Ok(EnergyDrift { amount: b.drift, kinetic: b.kinetic, allowed: self.progress.allowed_drift() })
    }

    fn circulates(&self) -> bool {
        self.model.head.plan.circulation && self.model.head.plan.formulation != Formulation::Kirchhoff
    }

    /// Linear impulse (x, y), N·s/m, and angular impulse about the origin, N·s, of bodies, fluid and circulation. O(N). Constant in unbounded
    /// fluid without gravity and obstacles (with circulation: in the full model).
    ///
    /// # Errors
    /// As [`Sim::energy`].
    pub fn impulse(&mut self) -> Result<[R; 3]> {
        self.evaluated()?;
        let mut total = self.evaluation.total_impulse(&self.model);
        if !self.model.head.plan.circulation {
            return Ok(total);
        }
        let (model, density) = (self.model, self.model.head.fluid_density);
        let c = &self.evaluation.placement.configuration(&model);
        if self.circulates() {
            circulation::impulse(c, &self.evaluation.circulation, self.evaluation.scratch.other);
        } else {
            let [x, y, a] = model.head.lone_impulse;
            put_three(self.evaluation.scratch.other, 0, c.pose(0).turned(crate::base::complex::complex(x, y)), a);
        }
        for (_, b, _) in model.each_boundary() {
            let Some(link) = b.link else { continue };
            let p = twist_of(self.evaluation.scratch.other, link);
            let (x, y) = (at(self.evaluation.placement.q, 3 * link), at(self.evaluation.placement.q, 3 * link + 1));
            // The canonical impulse: P − γ J r, with angular part P_θ + r × P − γ |r|²/2.
            let gamma = b.circulation;
            total[0] += density * (p.linear.re + gamma * y);
            total[1] += density * (p.linear.im - gamma * x);
            total[2] += density * (p.angular + x * p.linear.im - y * p.linear.re - gamma * (x * x + y * y) * R::HALF);
        }
        Ok(total)
    }

    /// Torque ν that drives every joint (7.2), N (a force for a slider, N/m), and its power ν u̇, W/m. `joint_count` each. Two solves,
    /// O(N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn joint_torques(&mut self, torque: &mut [R], power: &mut [R]) -> Result<()> {
        self.expect(torque.len(), self.model.joint_count())?;
        self.expect(power.len(), self.model.joint_count())?;
        self.evaluated()?;
        let model = self.model;
        self.evaluation.drive_forces(&model);
        let now = Moment { t: self.progress.time, after: !self.progress.arrived };
        let joints = model.coordinates.iter().enumerate().filter(|(_, c)| c.component == 3);
        for ((torque, power), (k, c)) in torque.iter_mut().zip(power.iter_mut()).zip(joints) {
            let (u, du) = (at(self.evaluation.coordinates.s, k), at(self.evaluation.coordinates.ds, k));
            *torque = match c.control {
                Control::Torque => joint_torque(&model, k, now, self.evaluation.coordinates.channels, u, du),
                _ => at(self.evaluation.forces.generalized, k),
            };
            *power = *torque * du;
        }
        Ok(())
    }

    /// Accelerations q̈ (6.3), m/s² and rad/s² (3 per link).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn accelerations(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.evaluated()?;
        copy(out, self.evaluation.forces.qdd);
        Ok(())
    }

    /// Symmetrized added mass M^f (2.11) (3n × 3n, column-major; kg/m, kg, kg·m). 3n solves, O(n N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn added_mass(&mut self, out: &mut [R]) -> Result<()> {
        let n = self.rows();
        self.expect(out.len(), n * n)?;
        self.evaluated()?;
        self.evaluation.added_mass(&self.model, out);
        Ok(())
    }

    /// Mass matrix M = diag(m, m, I) + M^f (3n × 3n, column-major; kg/m, kg, kg·m). O(n N²).
    ///
    /// # Errors
    /// As [`Sim::added_mass`].
    pub fn mass_matrix(&mut self, out: &mut [R]) -> Result<()> {
        self.added_mass(out)?;
        Evaluation::add_bodies(&self.model, out);
        Ok(())
    }

    /// Christoffel force ⟨Γ, q̇, q̇⟩ (2.15), N/m and N (3 per link), by the scene's formula. At most four solves and a pass over the pairs,
    /// O(N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn christoffel(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.evaluated()?;
        let model = self.model;
        self.evaluation.christoffel_force(&model);
        copy(out, self.evaluation.forces.force);
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
        self.evaluated()?;
        let model = self.model;
        // Γ(e_i, e_i) first, then 2 Γ(e_i, e_j) = Γ(e_i + e_j, e_i + e_j) − Γ(e_i, e_i) − Γ(e_j, e_j).
        for (i, j) in (0..n).map(|i| (i, i)).chain((0..n).flat_map(|j| (0..j).map(move |i| (i, j)))) {
            self.evaluation.velocity.qd.fill(R::zero());
            put(self.evaluation.velocity.qd, i, R::one());
            put(self.evaluation.velocity.qd, j, R::one());
            self.evaluation.christoffel_force(&model);
            for a in 0..n {
                let force = at(self.evaluation.forces.force, a);
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

    /// ∂P/∂q of weight and buoyancy (2.8), (2.16), N/m and N (3 per link). O(n).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn buoyancy(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.evaluated()?;
        out.fill(R::zero());
        buoyancy::add_gradient(&self.model, Poses(self.evaluation.placement.poses), out);
        Ok(())
    }

    /// ∂V/∂q of repulsion (5.1), N/m and N (3 per link); 0 without repulsion. O(N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn repulsion(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.evaluated()?;
        out.fill(R::zero());
        if let Some(law) = self.model.head.repulsion {
            repulsion::add_gradient(&self.evaluation.placement.configuration(&self.model), law, out);
        }
        Ok(())
    }

    /// ∂T_c/∂q of the circulatory flow's energy (3.5), (3.6), N/m and N (3 per link); 0 without circulation. A solve and a pass over
    /// the pairs, O(N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn circulation_gradient(&mut self, out: &mut [R]) -> Result<()> {
        self.expect(out.len(), self.rows())?;
        self.evaluated()?;
        out.fill(R::zero());
        if self.circulates() {
            let model = self.model;
            self.evaluation.add_circulation_gradient(&model, out);
        }
        Ok(())
    }

    /// The antisymmetric matrix G of the force +G q̇ linear in the velocities (3n × 3n, column-major); 0 without circulation
    /// and in the paper's model (3.4). 6n solves, O(n N²).
    ///
    /// # Errors
    /// `Length`, and as [`Sim::energy`].
    pub fn gyroscopic(&mut self, out: &mut [R]) -> Result<()> {
        let n = self.rows();
        self.expect(out.len(), n * n)?;
        self.evaluated()?;
        out.fill(R::zero());
        let model = self.model;
        if !model.head.gyroscopic {
            return Ok(());
        }
        for (k, column) in out.chunks_exact_mut(n.max(1)).enumerate() {
            self.evaluation.gyroscopic_column(&model, k);
            copy(column, self.evaluation.forces.force);
            for x in column {
                *x = -*x;
            }
        }
        Ok(())
    }
}
