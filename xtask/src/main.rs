//! Developer commands: `cargo xtask test` is the whole test run.

mod archive;
mod bare;
mod c;
mod counts;
mod dist;
mod firmware;
mod fuzz;
mod header;
mod layers;
mod studies;
mod test;

use nekton_steps::{Outcome, cargo, execute};
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

commands:
  test [--no-skips] [--list] [WORD...]
             everything: format, lints, builds without std and without heap, tests, documentation, scenes; or the steps
             with one of the words in their names (--list: only the names; --no-skips: a skipped step counts as failed)
  firmware [--counts]
             docs/embedded.csv: size and speed on emulated microcontrollers (--counts: prints instructions of an evaluation
             and per multiply-add of the LU)
  prelink    target/freestanding/libnekton.a: one object, only nekton's symbols
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
  layers [--picture] [FOLDER]
             checks the imports of core against the order of its layers, and that no crate has circles of files; --picture:
             writes docs/layers.svg (FOLDER: in another checkout)
  header     include/nekton.h, include/nekton32.h and ffi/src/api32.rs from ffi/src, docs/errors.md from core/src/status.rs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test", words @ ..] => match nekton_steps::Wish::of(words) {
            Some(wish) => test::run(wish),
            None => usage(),
        },
        ["bench-counts"] => counts::write(),
        ["firmware"] => firmware::run(),
        ["firmware", "--counts"] => firmware::print_counts(),
        ["fuzz", "--minutes", minutes] => fuzz::run(minutes),
        ["mutants", options @ ..] => mutants(options),
        ["prelink"] => archive::write_prelinked(),
        ["symbols"] => archive::write_symbols(),
        ["c"] => c::run(),
        ["dist", "--prefix", prefix] => dist::run(prefix),
        ["layers"] => layers::run(None),
        ["layers", "--picture"] => layers::write_picture(None),
        ["layers", "--picture", folder] => layers::write_picture(Some(folder)),
        ["layers", folder] if !folder.starts_with('-') => layers::run(Some(folder)),
        ["header"] => header::run(),
        ["bench" | "bench-guard" | "extremes" | "trade", ..] => studies::run(&words),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}{}", studies::USAGE);
            ExitCode::SUCCESS
        }
        _ => usage(),
    }
}

/// The program of `tests/mutants`, which needs a parser of Rust that nothing else does.
fn mutants(options: &[&str]) -> ExitCode {
    let outcome = execute(cargo(&["run", "--quiet", "--package", "nekton-mutants", "--"]).args(options));
    if matches!(outcome, Outcome::Passed) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn usage() -> ExitCode {
    eprint!("{USAGE}{}", studies::USAGE);
    ExitCode::from(2)
}
