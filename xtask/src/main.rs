//! Developer commands: `cargo xtask test` is the whole test run.

mod c;
mod dist;
mod expected;
mod header;
mod steps;
mod test;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

commands:
  test    everything: format, lints, builds without std and without heap, tests, documentation, scenes
  c       what users of C and C++ meet: examples, wrapper, installed package
  dist --prefix P
          headers, libraries, pkg-config file and CMake package into folder P
  header  include/nekton.h and ffi/src/api32.rs from ffi/src, docs/errors.md from core/src/status.rs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => test::run(),
        ["c"] => c::run(),
        ["dist", "--prefix", prefix] => dist::run(prefix),
        ["header"] => header::run(),
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
