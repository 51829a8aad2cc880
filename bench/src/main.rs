//! `cargo xtask bench`: the ratios that nekton is held to.

use nekton::scene::Quadrature;
use nekton_bench::lapack::Lapack;
use nekton_bench::rows::{Row, ellipses, rows};
use std::process::ExitCode;

const USAGE: &str = "usage: nekton-bench table | guard | repeat NODES COLUMNS CALLS";

/// A value may leave what it must be by this much before the guard complains, and only if it does so each time.
const SLACK: f64 = 1.15;
const REPEATS: usize = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["table"] => with_lapack(table),
        ["guard"] => with_lapack(guard),
        // For profilers and counters of instructions: nothing but evaluations.
        ["repeat", nodes, columns, calls] => {
            let number = |word: &str| word.parse::<usize>().unwrap_or(1);
            let mut evaluation = ellipses(number(columns), 2, 1.0, number(nodes), Quadrature::Plain);
            for _ in 0..number(calls) {
                evaluation.run();
            }
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

fn with_lapack(run: fn(&Lapack) -> ExitCode) -> ExitCode {
    match Lapack::load() {
        Ok(lapack) => run(&lapack),
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Every row, as CSV.
fn table(lapack: &Lapack) -> ExitCode {
    println!("# {}", lapack.name);
    println!("{}", Row::HEAD);
    for row in rows() {
        println!("{}", row.line(&row.measure(lapack)));
    }
    ExitCode::SUCCESS
}

/// Fails when a value is too large in every repeat.
fn guard(lapack: &Lapack) -> ExitCode {
    let mut failed = false;
    for row in rows().iter().filter(|row| row.guarded) {
        let mut best = f64::INFINITY;
        for _ in 0..REPEATS {
            match row.measure(lapack) {
                Ok(measured) => best = best.min(measured.ratio),
                Err(why) => println!("{}: {why}", row.name),
            }
            if best <= row.must * SLACK {
                break;
            }
        }
        let passed = best <= row.must * SLACK;
        println!(
            "{} {} ({}): {best:.3}, must be {}",
            if passed { "ok" } else { "FAILED" },
            row.name,
            row.size,
            row.must
        );
        failed |= !passed;
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
