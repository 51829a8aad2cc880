//! A compiler for targets without an operating system.

use nekton_steps::{Outcome, output, root};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Cortex-M4F and M7.
pub const CORTEX_M: &str = "thumbv7em-none-eabihf";

/// The compiler to build with.
pub struct Compiler {
    /// `None`: the usual one.
    rustc: Option<PathBuf>,
}

impl Compiler {
    /// The usual compiler.
    pub fn usual() -> Self {
        Compiler { rustc: None }
    }

    /// Name and version.
    pub fn version(&self) -> String {
        let rustc = self.rustc.clone().unwrap_or("rustc".into());
        let line = output(&rustc.to_string_lossy(), &["--version"]).unwrap_or_default();
        line.split(" (").next().unwrap_or("").to_string()
    }

    /// Makes a cargo command use it.
    pub fn used_by<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        if let Some(rustc) = &self.rustc {
            command.env("RUSTC", rustc).env_remove("RUSTUP_TOOLCHAIN");
        }
        command
    }
}

/// Whether the usual compiler can build for a target.
pub fn installed(target: &str) -> bool {
    let folder = output("rustc", &["--print", "target-libdir", "--target", target]);
    folder.is_some_and(|folder| Path::new(&folder).is_dir())
}

/// The least version of the compiler that the workspace can be built with.
const LEAST: &str = env!("CARGO_PKG_RUST_VERSION");
/// What the script ends with where no fit compiler can be had.
const UNFIT: i32 = 3;

/// The script that makes a private compiler in a folder.
fn script(folder: &Path, least: &str, target: &str) -> Command {
    let mut script = Command::new("sh");
    script.arg(root().join("xtask/bare-toolchain.sh")).arg(folder).args([least, target]);
    script
}

/// A compiler for a target: the usual one, or else a private one in `target/`, made by `bare-toolchain.sh` where Debian's
/// packages can be had. Otherwise the step is skipped, and the reason says what would help; it fails where a compiler
/// that is fit could not be made ready.
pub fn compiler(target: &str) -> Result<Compiler, Outcome> {
    if installed(target) {
        return Ok(Compiler::usual());
    }
    let folder = root().join("target/bare-toolchain");
    let mut script = script(&folder, LEAST, target);
    made(script.stdout(Stdio::inherit()), target).map(|()| Compiler { rustc: Some(folder.join("bin/rustc")) })
}

/// Runs the script.
fn made(script: &mut Command, target: &str) -> Result<(), Outcome> {
    let broken = |why: &str| Outcome::Failed(format!("making a compiler for {target} failed: {why}"));
    let made = script.stderr(Stdio::piped()).output().map_err(|error| broken(&error.to_string()))?;
    if made.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&made.stderr);
    eprint!("{text}");
    let why = text.lines().last().unwrap_or("no reason given");
    match made.status.code() {
        Some(UNFIT) => Err(Outcome::Skipped(format!(
            "no compiler for {target}; try: rustup target add {target} (or one from Debian's packages: {why})"
        ))),
        _ => Err(broken(why)),
    }
}

#[cfg(test)]
#[path = "bare_test.rs"]
mod tests;
