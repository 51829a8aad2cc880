//! Parts of an evaluation by themselves, for benchmarks (feature `bench`). Each does again what the last evaluation did.

use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::dynamics::evaluation::{Counters, Evaluation};
use crate::fluid::assembly::assemble;
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
        let (model, evaluation) = (self.model, &mut self.evaluation);
        match stage {
            Stage::Place => {
                let (p, dp) = split_state(&model, self.state.y);
                evaluation.place(&model, self.progress.time, p, dp)
            }
            Stage::Grade => evaluation.grade(&model),
            Stage::Assemble => {
                let Evaluation { placement, system, pairs, .. } = evaluation;
                let c = &placement.configuration(&model);
                assemble(c, false, system.matrix, system.ld, system.regular, pairs.zx, pairs.zy);
                Ok(())
            }
            Stage::Solve => evaluation.solve_fluid(&model, &mut Counters::default()),
            Stage::Force => evaluation.accelerate(&model, self.progress.time),
        }
    }
}
