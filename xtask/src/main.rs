//! Developer commands: `cargo xtask test` is the whole test run.

mod archive;
mod bare;
mod bench;
mod c;
mod counts;
mod dist;
mod expected;
mod extremes;
mod firmware;
mod fuzz;
mod header;
mod speed;
mod steps;
mod test;
mod trade;

use std::process::ExitCode;
use steps::{Outcome, cargo, execute};

const USAGE: &str = "usage: cargo xtask <command>

commands:
  test       everything: format, lints, builds without std and without heap, tests, documentation, scenes
  firmware   docs/embedded.csv: size and speed on emulated microcontrollers
  prelink    target/freestanding/libnekton.a: one object, only nekton's symbols
  bench [--tables]
             docs/bench: speed beside OpenBLAS's factorization and the paper's algorithm, its plots, and the tables in
             README.md and docs/design.md (4 minutes; --tables: only what is measured already)
  bench-guard
             fails when one of those ratios is too large
  bench-counts
             docs/bench/instructions.csv: counted instructions, which the test run holds
  fuzz --minutes N
             bytes as scenes and call sequences through the C interface; what it finds goes to fuzz/findings
  mutants [--first N] [--minutes M] [--again] [--list]
             docs/mutants.csv: 300 small wrong changes of core, one at a time, and which test notices each (three hours;
             goes on where it was cut off)
  symbols    include/nekton.symbols from ffi/src
  c          what users of C and C++ meet: examples, wrapper, installed package
  dist --prefix P
             headers, libraries, pkg-config file and CMake package into folder P
  extremes [--tables | TABLE | long_run MOTION [METHOD [PRECISION]]]
             docs/accuracy/extremes_*.csv and what the pages tell of them: one table or (in two hours) all, or some of the
             long runs (--tables: only what is measured already)
  trade [--quick | --resume | --tables | SCENE]
             docs/accuracy: speed against accuracy of every scene, the paper's figures (25 minutes; --quick: one minute, into
             target/accuracy; --resume: goes on with a run that was cut off; --tables: only what is measured already;
             SCENE: one of scenes/, without repeating what is measured)
  header     include/nekton.h and ffi/src/api32.rs from ffi/src, docs/errors.md from core/src/status.rs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => test::run(),
        ["bench"] => bench::run(),
        ["bench", "--tables"] => bench::tables(),
        ["bench-guard"] => bench::guard(),
        ["bench-counts"] => counts::write(),
        ["firmware"] => firmware::run(),
        ["fuzz", "--minutes", minutes] => fuzz::run(minutes),
        ["mutants", options @ ..] => mutants(options),
        ["prelink"] => archive::write_prelinked(),
        ["symbols"] => archive::write_symbols(),
        ["c"] => c::run(),
        ["dist", "--prefix", prefix] => dist::run(prefix),
        ["trade"] => trade::run(false),
        ["trade", "--resume"] => trade::run(true),
        ["trade", "--tables"] => steps::Steps::only("tables", trade::collected),
        ["trade", "--quick"] => steps::Steps::only("trade", trade::quick),
        ["trade", scene] if !scene.starts_with('-') => trade::one(scene),
        ["header"] => header::run(),
        ["extremes", "--tables"] => extremes::pages(),
        ["extremes", runs @ ..] if runs.iter().all(|word| !word.starts_with('-')) => extremes::run(runs),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprint!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

/// The program of `tests/mutants`, which needs a parser of Rust that nothing else does.
fn mutants(options: &[&str]) -> ExitCode {
    let outcome = execute(cargo(&["run", "--quiet", "--package", "nekton-mutants", "--"]).args(options));
    if matches!(outcome, Outcome::Passed) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
