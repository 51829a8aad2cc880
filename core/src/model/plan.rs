//! What a model computes and what that costs: explicit, printable, and derived from the scene alone.
//!
//! Tested by `tests/ingredients`.

use core::fmt;

/// How the equations of motion are integrated.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Formulation {
    /// State (p, ṗ): the general case.
    #[default]
    Velocity,
    /// A lone rigid body: constant added mass in its own frame, no boundary system per step.
    Kirchhoff,
    /// A lone body with prescribed joints and no outer force: the impulse is constant, the state is the pose of
    /// its first link, first order in time.
    LockedMomentum,
}

/// The plan of a model. Counts are per evaluation of the accelerations.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[non_exhaustive]
pub struct Plan {
    /// How the equations of motion are integrated.
    pub formulation: Formulation,
    /// Moving links.
    pub links: usize,
    /// Fixed boundaries (tank and obstacles).
    pub walls: usize,
    /// Unknowns of the boundary system; 0 when none is solved while stepping.
    pub unknowns: usize,
    /// Unknowns on moving links.
    pub moving_unknowns: usize,
    /// Right-hand sides solved at most (transposed ones included): products of solved columns take the place of some.
    pub right_hand_sides: usize,
    /// Coordinates that obey the laws of motion.
    pub free_coordinates: usize,
    /// Coordinates that are prescribed functions of time.
    pub prescribed_coordinates: usize,
    /// Length of the integrated state vector.
    pub state_len: usize,
    /// A fluid of positive density.
    pub fluid: bool,
    /// Gravity and buoyancy.
    pub gravity: bool,
    /// Repulsion.
    pub repulsion: bool,
    /// Circulation.
    pub circulation: bool,
    /// Bound of the relative error in space above which there is a notice: the scene's tolerance, or a thousandth.
    pub tolerance: f64,
    /// Bytes of the model's store of reals.
    pub model_bytes: usize,
    /// Bytes of a simulation's reals (evaluation and integrator).
    pub sim_bytes: usize,
    /// Floating-point operations, leading terms.
    pub operations: f64,
}

impl Plan {
    /// Leading-order operation count of one evaluation, `nodes` of all boundaries.
    pub(crate) fn count_operations(&self, nodes: usize) -> f64 {
        let (n, m) = (self.unknowns as f64, self.right_hand_sides as f64);
        let pairs = (self.unknowns * self.unknowns) as f64;
        let assembly = if self.circulation { 14.0 } else { 10.0 };
        // Induced velocity of the force pass: 20 flops per pair, once more for circulation.
        let force = if self.circulation { 44.0 } else { 20.0 };
        // Repulsion: 25 flops, one root and one power per pair, each pair once; it needs no boundary system.
        let repulsion = if self.repulsion { 12.5 * (nodes * nodes) as f64 } else { 0.0 };
        2.0 / 3.0 * n * n * n + 2.0 * n * n * m + (assembly + force) * pairs + repulsion
    }
}

impl fmt::Display for Formulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Formulation::Velocity => "velocities",
            Formulation::Kirchhoff => "lone rigid body (constant added mass)",
            Formulation::LockedMomentum => "lone swimmer (conserved impulse, first order in time)",
        })
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let yes = |b: bool| if b { "yes" } else { "no" };
        writeln!(f, "formulation              {}", self.formulation)?;
        writeln!(f, "links, walls             {}, {}", self.links, self.walls)?;
        writeln!(f, "coordinates free, given  {}, {}", self.free_coordinates, self.prescribed_coordinates)?;
        writeln!(f, "state length             {}", self.state_len)?;
        writeln!(f, "boundary unknowns        {} ({} on links)", self.unknowns, self.moving_unknowns)?;
        writeln!(f, "right-hand sides         {}", self.right_hand_sides)?;
        writeln!(
            f,
            "fluid, gravity           {}, {}\nrepulsion, circulation   {}, {}",
            yes(self.fluid),
            yes(self.gravity),
            yes(self.repulsion),
            yes(self.circulation)
        )?;
        writeln!(f, "noticed error in space   {:e}", self.tolerance)?;
        writeln!(f, "model memory             {} bytes", self.model_bytes)?;
        writeln!(f, "simulation memory        {} bytes", self.sim_bytes)?;
        write!(f, "operations / evaluation  {:.3e}", self.operations)
    }
}
