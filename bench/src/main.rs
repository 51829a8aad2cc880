//! `cargo xtask bench`: the ratios that nekton is held to.

use nekton_bench::counted::{COUNTED, PORTABLE};
use nekton_bench::lapack::Lapack;
use nekton_bench::passing::{Point, Scheme, points};
use nekton_bench::rows::{Held, Row, rows};
use std::process::ExitCode;

const USAGE: &str = "usage: nekton-bench table | rows PART | faer | guard | counted | repeat NAME CALLS";

/// A value may leave what it must be by this much before the guard complains, and only if it does so each time.
const SLACK: f64 = 1.15;
const REPEATS: usize = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["table"] => with_lapack(table),
        // The rows whose names have this part.
        ["rows", part] => {
            let lapack = match Lapack::load() {
                Ok(lapack) => lapack,
                Err(why) => {
                    eprintln!("{why}");
                    return ExitCode::FAILURE;
                }
            };
            let chosen: Vec<Row> = rows().into_iter().filter(|row| row.name.contains(part)).collect();
            lines(&lapack, &chosen);
            ExitCode::SUCCESS
        }
        // Lines of the table alone; of a program built with the feature `faer`.
        ["faer"] => with_lapack(|lapack| {
            println!("# {}", lapack.name);
            lines(lapack, &nekton_bench::faer::rows());
            ExitCode::SUCCESS
        }),
        ["guard"] => with_lapack(guard),
        // What can be repeated, and how often that pays.
        ["counted"] => {
            let own = |name: &str| !cfg!(nekton_portable) || name == PORTABLE;
            COUNTED.iter().filter(|(name, ..)| own(name)).for_each(|(name, calls, _)| println!("{name},{calls}"));
            ExitCode::SUCCESS
        }
        // For profilers and counters of instructions: nothing but evaluations.
        ["repeat", name, calls] => {
            let (Some((_, _, make)), Ok(calls)) = (COUNTED.iter().find(|c| c.0 == *name), calls.parse::<usize>())
            else {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            };
            let mut call = make();
            (0..calls).for_each(|_| call());
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

/// Every row, as CSV; then, behind an empty line, the runs of the paper's example. Progress goes to the other stream.
fn table(lapack: &Lapack) -> ExitCode {
    println!("# {}", lapack.name);
    println!("{}", Row::HEAD);
    lines(lapack, &rows());
    if cfg!(nekton_portable) {
        return ExitCode::SUCCESS;
    }
    println!("\n{}", Point::HEAD);
    for scheme in [Scheme::Nekton, Scheme::Plain, Scheme::Octave] {
        points(scheme).iter().flatten().for_each(|point| println!("{}", point.line()));
    }
    ExitCode::SUCCESS
}

fn lines(lapack: &Lapack, rows: &[Row]) {
    for (k, row) in rows.iter().enumerate() {
        eprintln!("{} of {}: {} ({})", k + 1, rows.len(), row.name, row.size);
        let measured = row.measure(lapack);
        match &measured {
            Ok(m) => eprintln!("  {:.3e}, must be {}", m.ratio, row.must),
            Err(why) => eprintln!("  NOT MEASURED: {why}"),
        }
        println!("{}", row.line(&measured));
    }
}

/// Fails when a value is too large in every repeat.
fn guard(lapack: &Lapack) -> ExitCode {
    let mut failed = false;
    for row in rows().iter().filter(|row| row.held == Held::Yes) {
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
