//! Parts of an evaluation by themselves, for benchmarks (feature `bench`). Each does again what the last evaluation did.

use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::dynamics::evaluation::{configuration, system};
use crate::fluid::assembly::assemble;
use crate::fluid::configuration::Configuration;
use crate::fluid::near::buffers::Near;
use crate::fluid::system::BoundarySystem;
use crate::geometry::pose::Poses;
use crate::simulation::right_hand_side::split_state;
use crate::simulation::sim::Sim;

/// A part.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stage {
    /// Kinematics, and whether anything touches.
    Place,
    /// Ladders, nodes, preimages.
    Grade,
    /// The boundary system's matrix.
    Assemble,
    /// The same with right-hand sides, factorization, solutions and their moments.
    Solve,
    /// All that follows: forces and accelerations.
    Force,
}

impl<R: Real> Sim<'_, R> {
    /// Does a part again, after [`Sim::rhs`] at the present state.
    ///
    /// # Errors
    /// As [`Sim::rhs`].
    pub fn stage(&mut self, stage: Stage) -> Result<()> {
        let (model, work) = (self.model, &mut self.work);
        match stage {
            Stage::Place => {
                let (p, dp) = split_state(&model, self.state.y);
                work.place(&model, self.head.time, p, dp)
            }
            Stage::Grade => work.grade(&model),
            Stage::Assemble => {
                let (model, system) = (&model, system!(work));
                assemble(
                    &configuration!(work, model),
                    false,
                    system.matrix,
                    system.ld,
                    system.regular,
                    work.zx,
                    work.zy,
                );
                Ok(())
            }
            Stage::Solve => work.solve_fluid(&model, &mut crate::Counters::default()),
            Stage::Force => work.accelerate(&model, self.head.time),
        }
    }
}
