//! `nekton plan`: what will be computed and what it costs.

use std::path::Path;

use crate::ending::{Ending, say};
use crate::scene_file::Problem;
use crate::setup::Setup;
use crate::waiting::Waiting;

/// Prints the plan.
pub fn plan(path: &Path) -> Result<Ending, Problem> {
    let _told = Waiting::new("reading outlines");
    let (setup, plan) = Setup::sketch(path)?;
    say(&plan.to_string());
    let chosen = setup.scene.chosen_nodes();
    let about = |place| if chosen.contains(&place) { "about " } else { "" };
    say(&format!("nodes                    {}", setup.counts(about).join(", ")));
    if !chosen.is_empty() {
        say(
            "                         about: by the rule; a run looks at its start, and takes up to four times as many where it needs them",
        );
    }
    if plan.fluid || plan.repulsion {
        say("error in space           told by `nekton evaluate`, which makes the matrices");
    }
    for (whose, what) in setup.outlines() {
        say(&format!("outline of {whose}: {what}"));
    }
    for notice in setup.notices() {
        say(&format!("notice: {notice}"));
    }
    Ok(Ending::Complete)
}
