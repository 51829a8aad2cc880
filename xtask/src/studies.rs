//! Commands of `bench/studies`, which makes documents: called by the names that they have there.

use nekton_steps::cargo;
use std::process::{Command, ExitCode};

/// What `help` says of them.
pub const USAGE: &str = include_str!("../../bench/studies/src/usage.txt");

/// A command of the studies.
pub fn studies(words: &[&str]) -> Command {
    let mut command = cargo(&["run", "--quiet", "--package", "nekton-studies", "--"]);
    command.args(words);
    command
}

/// Runs one, and ends as it ends.
pub fn run(words: &[&str]) -> ExitCode {
    match studies(words).status() {
        Ok(status) => status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from),
        Err(error) => {
            eprintln!("cargo: {error}");
            ExitCode::FAILURE
        }
    }
}
