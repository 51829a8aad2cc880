//! What the developers' commands share: named, timed steps and the summary at the end; other programs; the repository's folder.

pub mod bench;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// How a step ended.
pub enum Outcome {
    /// As it should.
    Passed,
    /// What failed.
    Failed(String),
    /// Why it could not run, and how to make it run.
    Skipped(String),
}

/// Steps run so far.
#[derive(Default)]
pub struct Steps {
    done: Vec<(String, Duration, Outcome)>,
}

impl Steps {
    /// Runs a step and notes how it ended.
    pub fn run(&mut self, name: &str, action: impl FnOnce() -> Outcome) {
        println!("\n== {name}");
        let start = Instant::now();
        let outcome = action();
        match &outcome {
            Outcome::Passed => {}
            Outcome::Failed(why) => println!("-- {name}: FAILED: {why}"),
            Outcome::Skipped(why) => println!("-- {name}: SKIPPED: {why}"),
        }
        self.done.push((name.into(), start.elapsed(), outcome));
    }

    /// One step alone.
    pub fn only(name: &str, action: impl FnOnce() -> Outcome) -> ExitCode {
        let mut steps = Steps::default();
        steps.run(name, action);
        steps.finish()
    }

    /// Runs a command as a step.
    pub fn command(&mut self, name: &str, command: &mut Command) {
        self.run(name, || execute(command));
    }

    /// Prints the summary; the last line counts what passed, failed and was skipped.
    pub fn finish(self) -> ExitCode {
        let width = self.done.iter().map(|(name, ..)| name.len()).max().unwrap_or(0);
        println!("\n== summary");
        let (mut passed, mut failed, mut skipped) = (0, 0, 0);
        for (name, time, outcome) in &self.done {
            let word = match outcome {
                Outcome::Passed => {
                    passed += 1;
                    "passed"
                }
                Outcome::Failed(_) => {
                    failed += 1;
                    "FAILED"
                }
                Outcome::Skipped(_) => {
                    skipped += 1;
                    "SKIPPED"
                }
            };
            println!("{name:<width$}  {:>7.1} s  {word}", time.as_secs_f64());
        }
        for (name, _, outcome) in &self.done {
            match outcome {
                Outcome::Passed => {}
                Outcome::Failed(why) => println!("FAILED {name}: {why}"),
                Outcome::Skipped(why) => println!("SKIPPED {name}: {why}"),
            }
        }
        println!("{passed} passed, {failed} failed, {skipped} skipped");
        if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

/// The repository's top folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("xtask/steps lies in the workspace").into()
}

/// `cargo` with arguments, in the repository's top folder.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    command.args(arguments).current_dir(root());
    command
}

/// Runs a command, its output shown.
pub fn execute(command: &mut Command) -> Outcome {
    let arguments: Vec<_> = command.get_args().map(|a| a.to_string_lossy()).collect();
    println!("{} {}", command.get_program().to_string_lossy(), arguments.join(" "));
    match command.status() {
        Ok(status) if status.success() => Outcome::Passed,
        Ok(status) => Outcome::Failed(status.to_string()),
        Err(error) => Outcome::Failed(error.to_string()),
    }
}

/// Runs a command and gives what it prints; the error names the command and what it says.
pub fn ask(command: &mut Command) -> Result<String, String> {
    let line = format!("{command:?}");
    let output = command.output().map_err(|error| format!("{line}: {error}"))?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(out.into_owned()) } else { Err(format!("{line}: {}\n{out}{err}", output.status)) }
}

/// A file's text; the error names the file.
pub fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// What a command prints, or `None` when it fails.
pub fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_string())
}

/// Makes sure that each program is there. A missing one is installed with its Debian package where apt may be
/// used (that is, as root); otherwise the packages to install are named.
pub fn require(programs_and_packages: &[(&str, &str)]) -> Result<(), String> {
    let missing = || -> Vec<&str> {
        let absent = |program: &str| output("sh", &["-c", &format!("command -v {program}")]).is_none();
        programs_and_packages.iter().filter(|(program, _)| absent(program)).map(|(_, package)| *package).collect()
    };
    let packages = missing();
    if packages.is_empty() {
        return Ok(());
    }
    if output("id", &["-u"]).as_deref() == Some("0") && output("sh", &["-c", "command -v apt-get"]).is_some() {
        let install =
            || execute(Command::new("apt-get").args(["install", "--yes", "--no-install-recommends"]).args(&packages));
        // On a fresh machine the package lists are missing or stale.
        if !matches!(install(), Outcome::Passed) {
            let _ = execute(Command::new("apt-get").args(["update", "--quiet"]));
            let _ = install();
        }
    }
    match missing() {
        rest if rest.is_empty() => Ok(()),
        rest => Err(format!("please install: {}", rest.join(" "))),
    }
}
