//! `nekton plan`: what will be computed and what it costs.

use std::path::Path;

use crate::ending::{Ending, say};
use crate::scene_file::{Integrator, Problem};
use crate::setup::Setup;

/// Nodes up to which the bound of the error at the start is looked at: a fraction of a second.
const MOST: usize = 2048;

/// Prints the plan.
pub fn plan(path: &Path) -> Result<Ending, Problem> {
    let setup = Setup::open(path)?;
    say(&setup.model.view().plan().to_string());
    say(&format!("nodes                    {}", setup.nodes().join(", ")));
    for (whose, what) in setup.outlines() {
        say(&format!("outline of {whose}: {what}"));
    }
    let mut notices = setup.notices();
    // What keeps a simulation from starting is told when one is run.
    if setup.model.view().plan().unknowns <= MOST
        && let Ok(mut sim) = setup.simulate(Integrator::Rk4 { step: 1.0 })
        && let Ok(resolution) = sim.view().resolution()
    {
        notices.extend(setup.unresolved(resolution.bound()));
    }
    for notice in notices {
        say(&format!("notice: {notice}"));
    }
    Ok(Ending::Complete)
}
