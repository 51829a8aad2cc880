//! Developer commands: `cargo xtask test` is the whole test run.

mod archive;
mod bare;
mod c;
mod counts;
mod dist;
mod firmware;
mod fuzz;
mod header;
mod studies;
mod test;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

commands:
  test       everything: format, lints, builds without std and without heap, tests, documentation, scenes
  firmware [--counts]
             docs/embedded.csv: size and speed on emulated microcontrollers (--counts: prints instructions of an evaluation
             and per multiply-add of the LU)
  prelink    target/freestanding/libnekton.a: one object, only nekton's symbols
  bench-counts
             docs/bench/instructions.csv: counted instructions, which the test run holds
  fuzz --minutes N
             bytes as scenes and call sequences through the C interface; what it finds goes to fuzz/findings
  symbols    include/nekton.symbols from ffi/src
  c          what users of C and C++ meet: examples, wrapper, installed package
  dist --prefix P
             headers, libraries, pkg-config file and CMake package into folder P
  header     include/nekton.h, include/nekton32.h and ffi/src/api32.rs from ffi/src, docs/errors.md from core/src/status.rs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => test::run(),
        ["bench-counts"] => counts::write(),
        ["firmware"] => firmware::run(),
        ["firmware", "--counts"] => firmware::print_counts(),
        ["fuzz", "--minutes", minutes] => fuzz::run(minutes),
        ["prelink"] => archive::write_prelinked(),
        ["symbols"] => archive::write_symbols(),
        ["c"] => c::run(),
        ["dist", "--prefix", prefix] => dist::run(prefix),
        ["header"] => header::run(),
        ["bench" | "bench-guard" | "extremes" | "trade", ..] => studies::run(&words),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}{}", studies::USAGE);
            ExitCode::SUCCESS
        }
        _ => {
            eprint!("{USAGE}{}", studies::USAGE);
            ExitCode::from(2)
        }
    }
}
