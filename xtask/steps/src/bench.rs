//! The benchmark program, whose times the studies write down and whose instructions the test run counts.

use crate::{ask, cargo, root};
use std::path::PathBuf;

/// The program as usual, and built as for a machine of which nothing is known.
pub fn programs() -> [PathBuf; 2] {
    ["target", "target/portable"].map(|folder| root().join(folder).join("release/nekton-bench"))
}

/// Builds both.
pub fn build() -> Result<(), String> {
    let arguments = ["build", "--release", "--quiet", "--package", "nekton-bench", "--bins"];
    ask(&mut cargo(&arguments))?;
    let mut portable = cargo(&arguments);
    portable.arg("--target-dir").arg(root().join("target/portable"));
    ask(portable.env("RUSTFLAGS", "--cfg nekton_portable")).map(|_| ())
}
