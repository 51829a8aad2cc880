//! Commands that measure what the documents tell of accuracy and speed, and write it into them. They are called by `cargo xtask`.

mod bench;
mod extremes;
mod page;
mod speed;
mod trade;

use nekton_steps::Steps;
use std::process::ExitCode;

const USAGE: &str = concat!("usage: cargo xtask <command>\n\ncommands:\n", include_str!("usage.txt"));

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["bench"] => bench::run(),
        ["bench", "--tables"] => bench::tables(),
        ["bench-guard"] => bench::guard(),
        ["trade"] => trade::run(false),
        ["trade", "--resume"] => trade::run(true),
        ["trade", "--tables"] => Steps::only("tables", trade::collected),
        ["trade", "--quick"] => Steps::only("trade", trade::quick),
        ["trade", scene] if !scene.starts_with('-') => trade::one(scene),
        ["extremes", "--tables"] => extremes::pages(),
        ["extremes", runs @ ..] if runs.iter().all(|word| !word.starts_with('-')) => extremes::run(runs),
        _ => {
            eprint!("{USAGE}");
            ExitCode::from(2)
        }
    }
}
