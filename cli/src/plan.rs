//! `nekton plan`: what will be computed and what it costs.

use std::path::Path;

use crate::ending::{Ending, say};
use crate::scene_file::Problem;
use crate::setup::Setup;

/// Prints the plan.
pub fn plan(path: &Path) -> Result<Ending, Problem> {
    let setup = Setup::open(path)?;
    say(&setup.model.view().plan().to_string());
    say(&format!("nodes                    {}", setup.nodes().join(", ")));
    for (whose, what) in setup.scene.outlines() {
        say(&format!("outline of {whose}: {what}"));
    }
    for notice in setup.notices() {
        say(&format!("notice: {notice}"));
    }
    Ok(Ending::Complete)
}
