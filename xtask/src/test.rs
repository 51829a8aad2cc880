//! `cargo xtask test`.

use crate::bare::{CORTEX_M, Compiler, compiler, installed};
use crate::c;
use crate::firmware;
use crate::studies::studies;
use nekton_steps::{Outcome, Steps, Wish, cargo, execute, require, root};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

/// Targets without an operating system for which core is built when their `core` library is installed.
const BARE_TARGETS: [&str; 4] =
    [CORTEX_M, "riscv32imafc-unknown-none-elf", "wasm32-unknown-unknown", "x86_64-unknown-none"];

/// Runs everything that the project promises, or what is wished of it.
pub fn run(wish: Wish) -> ExitCode {
    let mut steps = Steps::wished(wish);
    steps.run("compilers", || require(&[("cc", "gcc"), ("c++", "g++")]).into());
    steps.command("format", &mut cargo(&["fmt", "--all", "--check"]));
    steps.command("lints", &mut cargo(&["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"]));
    steps.run("layers of core", crate::layers::step);
    steps.command("core without std and heap", &mut cargo(&["build", "--package", "nekton", "--no-default-features"]));
    steps.command(
        "core without std",
        &mut cargo(&["build", "--package", "nekton", "--no-default-features", "--features", "alloc"]),
    );
    steps.command(
        "core without graded quadrature",
        &mut cargo(&["test", "--package", "nekton", "--no-default-features", "--test", "without_near"]),
    );
    steps.run("core for a bare target", bare);
    steps.run("embedded archive, program without operating system", || firmware::freestanding().into());
    for board in firmware::boards() {
        steps.run(&format!("firmware {board}"), || firmware::step(board));
    }
    steps.command("tests", &mut cargo(&["test", "--workspace", "--no-fail-fast"]));
    steps.command(
        "core tests with fft",
        &mut cargo(&["test", "--package", "nekton", "--features", "fft", "--no-fail-fast"]),
    );
    steps.run("instructions per evaluation", crate::counts::held);
    steps.command(
        "documentation",
        cargo(&["doc", "--workspace", "--lib", "--no-deps"]).env("RUSTDOCFLAGS", "--deny warnings"),
    );
    c::add(&mut steps);
    scenes(&mut steps);
    steps.command("speed against accuracy, quickly", &mut studies(&["trade", "--quick"]));
    steps.run("matlab (in octave)", matlab);
    steps.finish()
}

/// Builds core for every bare target that is installed, and at least for one.
fn bare() -> Outcome {
    let mut targets: Vec<&str> = BARE_TARGETS.into_iter().filter(|target| installed(target)).collect();
    let mut with = Compiler::usual();
    if targets.is_empty() {
        targets.push(CORTEX_M);
        with = match compiler(CORTEX_M) {
            Ok(compiler) => compiler,
            Err(outcome) => return outcome,
        };
    }
    for target in targets {
        let build =
            ["build", "--package", "nekton", "--no-default-features", "--profile", "embedded", "--target", target];
        let outcome = execute(with.used_by(&mut cargo(&build)));
        if !matches!(outcome, Outcome::Passed) {
            return outcome;
        }
    }
    Outcome::Passed
}

/// Builds the gateway of `matlab/` and runs its tests in Octave.
fn matlab() -> Outcome {
    // From gnuplot on for figures; the font is no program.
    let programs = [
        ("octave-cli", "octave"),
        ("mkoctfile", "octave-dev"),
        ("gnuplot", "gnuplot-nox"),
        ("gs", "ghostscript"),
        ("gs && test -n \"$(find /usr/share/fonts -name 'FreeSans.*')\"", "fonts-freefont-otf"),
    ];
    if let Err(why) = require(&programs) {
        return Outcome::Skipped(why);
    }
    let mut octave = Command::new("octave-cli");
    // Without a history Octave does not complain when it exits.
    octave.args(["--norc", "--no-history", "--quiet", "--eval", "build_nekton; run_tests"]);
    execute(octave.current_dir(root().join("matlab")))
}

/// Runs every scene with the command, each as a step.
fn scenes(steps: &mut Steps) {
    let mut files: Vec<PathBuf> = std::fs::read_dir(root().join("scenes"))
        .map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())).collect())
        .unwrap_or_default();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    if files.is_empty() {
        steps.run("scenes", || Outcome::Failed("there is no scenes/*.toml".into()));
    }
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (scene, out) = (format!("scenes/{name}.toml"), format!("target/scenes/{name}"));
        steps.run(&format!("scene {name}"), || {
            // A result of an earlier run must not be taken for this one's.
            let _ = std::fs::remove_dir_all(root().join(&out));
            match execute(&mut cargo(&["run", "--release", "--quiet", "--", "run", &scene, "--out", &out])) {
                Outcome::Passed if !root().join(&out).join("report.html").is_file() => {
                    Outcome::Failed(format!("{out}/report.html was not written"))
                }
                outcome => outcome,
            }
        });
    }
}
