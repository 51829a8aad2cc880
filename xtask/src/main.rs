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
mod layers;
mod speed;
mod steps;
mod test;
mod trade;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

commands:
  test [--no-skips] [--list] [WORD...]
             everything: format, lints, builds without std and without heap, tests, documentation, scenes; or the steps
             with one of the words in their names (--list: only the names; --no-skips: a skipped step counts as failed)
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
  layers [--picture] [FOLDER]
             checks the imports of core against the order of its layers, and that no crate has circles of files; --picture:
             writes docs/layers.svg (FOLDER: in another checkout)
  header     include/nekton.h and ffi/src/api32.rs from ffi/src, docs/errors.md from core/src/status.rs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test", words @ ..] => match steps::Wish::of(words) {
            Some(wish) => test::run(wish),
            None => usage(),
        },
        ["bench"] => bench::run(),
        ["bench", "--tables"] => bench::tables(),
        ["bench-guard"] => bench::guard(),
        ["bench-counts"] => counts::write(),
        ["firmware"] => firmware::run(),
        ["fuzz", "--minutes", minutes] => fuzz::run(minutes),
        ["prelink"] => archive::write_prelinked(),
        ["symbols"] => archive::write_symbols(),
        ["c"] => c::run(),
        ["dist", "--prefix", prefix] => dist::run(prefix),
        ["trade"] => trade::run(false),
        ["trade", "--resume"] => trade::run(true),
        ["trade", "--tables"] => steps::Steps::only("tables", trade::collected),
        ["trade", "--quick"] => steps::Steps::only("trade", trade::quick),
        ["trade", scene] if !scene.starts_with('-') => trade::one(scene),
        ["layers"] => layers::run(None),
        ["layers", "--picture"] => layers::write_picture(None),
        ["layers", "--picture", folder] => layers::write_picture(Some(folder)),
        ["layers", folder] if !folder.starts_with('-') => layers::run(Some(folder)),
        ["header"] => header::run(),
        ["extremes", "--tables"] => extremes::pages(),
        ["extremes", runs @ ..] if runs.iter().all(|word| !word.starts_with('-')) => extremes::run(runs),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => usage(),
    }
}

fn usage() -> ExitCode {
    eprint!("{USAGE}");
    ExitCode::from(2)
}
