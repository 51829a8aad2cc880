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

impl From<Result<(), String>> for Outcome {
    fn from(result: Result<(), String>) -> Self {
        match result {
            Ok(()) => Outcome::Passed,
            Err(why) => Outcome::Failed(why),
        }
    }
}

impl Outcome {
    /// Why it was not passed.
    pub fn why(self) -> String {
        match self {
            Outcome::Passed => String::new(),
            Outcome::Failed(why) | Outcome::Skipped(why) => why,
        }
    }
}

/// Which steps are run, and what counts as success.
#[derive(Default)]
pub struct Wish {
    /// Parts of names, in small letters; of a step one of them is to be in its name. None: every step.
    pub words: Vec<String>,
    /// Only the names are printed.
    pub list: bool,
    /// A step that is skipped counts as failed.
    pub no_skips: bool,
}

impl Wish {
    /// From the words after `cargo xtask test`; `None`: they mean nothing.
    pub fn of(arguments: &[&str]) -> Option<Wish> {
        let mut wish = Wish::default();
        for argument in arguments {
            match *argument {
                "--list" => wish.list = true,
                "--no-skips" => wish.no_skips = true,
                word if word.starts_with('-') => return None,
                word => wish.words.push(word.to_lowercase()),
            }
        }
        Some(wish)
    }

    fn includes(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        self.words.is_empty() || self.words.iter().any(|word| name.contains(word))
    }
}

/// Steps run so far.
#[derive(Default)]
pub struct Steps {
    wish: Wish,
    done: Vec<(String, Duration, Outcome)>,
}

impl Steps {
    /// A run of what is wished.
    pub fn wished(wish: Wish) -> Self {
        Steps { wish, done: Vec::new() }
    }

    /// Runs a step, if it is wished, and notes how it ended.
    pub fn run(&mut self, name: &str, action: impl FnOnce() -> Outcome) {
        if !self.wish.includes(name) {
            return;
        }
        if self.wish.list {
            println!("{name}");
            return;
        }
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
        if self.wish.list {
            return ExitCode::SUCCESS;
        }
        let width = self.done.iter().map(|(name, ..)| name.len()).max().unwrap_or(0);
        println!("\n== summary");
        for (name, time, outcome) in &self.done {
            let word = match outcome {
                Outcome::Passed => "passed",
                Outcome::Failed(_) => "FAILED",
                Outcome::Skipped(_) => "SKIPPED",
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
        let [passed, failed, skipped] = self.counted();
        println!("{passed} passed, {failed} failed, {skipped} skipped");
        match self.verdict() {
            Ok(()) => ExitCode::SUCCESS,
            Err(why) => {
                println!("{why}");
                ExitCode::FAILURE
            }
        }
    }

    /// How many steps passed, failed and were skipped.
    fn counted(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for (.., outcome) in &self.done {
            let kind = match outcome {
                Outcome::Passed => 0,
                Outcome::Failed(_) => 1,
                Outcome::Skipped(_) => 2,
            };
            counts[kind] += 1;
        }
        counts
    }

    /// Whether the run as a whole passed; the error says why not.
    fn verdict(&self) -> Result<(), String> {
        match self.counted() {
            [0, 0, 0] => Err("no step has such a name (cargo xtask test --list)".into()),
            [_, 0, skipped] if skipped > 0 && self.wish.no_skips => {
                Err("steps that are skipped are not let pass (--no-skips)".into())
            }
            [_, 0, _] => Ok(()),
            _ => Err("steps failed".into()),
        }
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
/// used (that is, as root); otherwise the packages to install are named. What stands for a program may go on with
/// `&&` and a further condition, for what comes in a package of its own and is no program.
pub fn require(programs_and_packages: &[(&str, &str)]) -> Result<(), String> {
    let missing = || -> Vec<&str> {
        let absent = |program: &str| output("sh", &["-c", &format!("command -v {program}")]).is_none();
        programs_and_packages.iter().filter(|(program, _)| absent(program)).map(|(_, package)| *package).collect()
    };
    if !missing().is_empty() && may_install() {
        install(&missing);
    }
    match missing() {
        rest if rest.is_empty() => Ok(()),
        rest => Err(format!("please install: {}", rest.join(" "))),
    }
}

fn may_install() -> bool {
    output("id", &["-u"]).as_deref() == Some("0") && output("sh", &["-c", "command -v apt-get"]).is_some()
}

/// Installs what is missing, as far as it can be had: at first by the package lists as they are, which on a fresh machine
/// are missing or name what the servers no longer have; then by new ones; and then each package alone, since of several
/// none is installed when one cannot be had.
fn install<'p>(missing: &impl Fn() -> Vec<&'p str>) {
    let apt = |arguments: &[&str]| {
        let mut apt = Command::new("apt-get");
        apt.env("DEBIAN_FRONTEND", "noninteractive").args(["-o", "DPkg::Lock::Timeout=300"]).args(arguments);
        matches!(execute(&mut apt), Outcome::Passed)
    };
    let install = |packages: &[&str]| apt(&[&["install", "--yes", "--no-install-recommends"], packages].concat());
    if install(&missing()) {
        return;
    }
    // An installation that was cut off hinders every later one.
    let _ = execute(Command::new("dpkg").args(["--configure", "-a"]).env("DEBIAN_FRONTEND", "noninteractive"));
    apt(&["update", "--quiet"]);
    if !install(&missing()) {
        for package in missing() {
            install(&[package]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(arguments: &[&str]) -> (Vec<String>, bool) {
        let mut steps = Steps::wished(Wish::of(arguments).unwrap());
        steps.run("format", || Outcome::Passed);
        steps.run("firmware Cortex-M7", || Outcome::Skipped("no compiler".into()));
        steps.run("tests", || Outcome::Passed);
        (steps.done.iter().map(|(name, ..)| name.clone()).collect(), steps.verdict().is_ok())
    }

    #[test]
    fn no_skips_fails_on_a_skipped_step_and_nothing_else() {
        assert!(run(&[]).1 && !run(&["--no-skips"]).1 && run(&["--no-skips", "format"]).1);
        let mut steps = Steps::default();
        steps.run("format", || Outcome::Failed("it is ugly".into()));
        assert!(steps.verdict().is_err());
    }

    #[test]
    fn words_choose_steps_and_a_word_that_chooses_none_is_an_error() {
        assert_eq!(run(&["FIRM", "test"]).0, ["firmware Cortex-M7", "tests"]);
        assert_eq!(run(&["frimware"]), (vec![], false));
        assert_eq!(run(&["--list"]).0.len(), 0);
        assert!(Wish::of(&["--no-skip"]).is_none());
    }
}
