//! A compiler for targets without an operating system.

use nekton_steps::{output, root};
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

/// A compiler for a target: the usual one, or else a private one in `target/`, made by `bare-toolchain.sh` where Debian's
/// packages can be had. The error says what is missing and what would help.
pub fn compiler(target: &str) -> Result<Compiler, String> {
    if installed(target) {
        return Ok(Compiler::usual());
    }
    let folder = root().join("target/bare-toolchain");
    let made = Command::new("sh")
        .arg(root().join("xtask/bare-toolchain.sh"))
        .arg(&folder)
        .arg(target)
        .stdout(Stdio::inherit())
        .stderr(Stdio::piped())
        .output();
    let why = match made {
        Ok(made) if made.status.success() => return Ok(Compiler { rustc: Some(folder.join("bin/rustc")) }),
        Ok(made) => {
            let text = String::from_utf8_lossy(&made.stderr).into_owned();
            eprint!("{text}");
            text.lines().last().unwrap_or("no reason given").to_string()
        }
        Err(error) => error.to_string(),
    };
    Err(format!(
        "no compiler for {target}; try: rustup target add {target} (making one from Debian's packages failed: {why})"
    ))
}
