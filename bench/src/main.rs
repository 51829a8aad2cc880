//! `cargo xtask bench`: the ratios that nekton is held to.

use nekton_bench::lapack::Lapack;
use nekton_bench::rows::{Row, rows};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let lapack = match Lapack::load() {
        Ok(lapack) => lapack,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::FAILURE;
        }
    };
    match words.as_slice() {
        ["table"] => {
            println!("# {}", lapack.name);
            println!("{}", Row::HEAD);
            for row in rows() {
                let measured = row.measure(&lapack);
                println!("{}", row.line(&measured));
            }
            ExitCode::SUCCESS
        }
        ["repeat", nodes, columns, calls] => {
            let number = |word: &str| word.parse::<usize>().unwrap_or(1);
            let mut evaluation =
                nekton_bench::rows::ellipses(number(columns), 2, 1.0, number(nodes), nekton::scene::Quadrature::Plain);
            for _ in 0..number(calls) {
                evaluation.run();
            }
            ExitCode::SUCCESS
        }
        _ => ExitCode::from(2),
    }
}
