//! `plots FOLDER`: draws docs/bench/ratio.svg and passing.svg from the tables beside them.

use nekton_cli::plots::colour;
use nekton_cli::plots::log::{Curve, Marks, chart};
use std::error::Error;
use std::fs;
use std::path::Path;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Lines of a table without comments: cells.
fn table(file: &Path) -> Outcome<Vec<Vec<String>>> {
    let text = fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    Ok(lines.map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

fn number(row: &[String], column: usize) -> f64 {
    row.get(column).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN)
}

/// Ratio against unknowns: columns measure, size, value, must.
fn ratio(rows: &[Vec<String>]) -> Outcome<String> {
    let points = |name: &str, column: usize| -> Vec<(f64, f64)> {
        let own = rows.iter().filter(|row| row.first().is_some_and(|first| first.starts_with(name)));
        own.map(|row| (number(row, 1), number(row, column))).collect()
    };
    let curve = |name: &str, points: Vec<(f64, f64)>, k: usize, marks: Marks| Curve {
        name: name.to_owned(),
        points,
        colour: colour(k),
        marks,
    };
    let (portable, whole) = ("build without SIMD dispatch", "evaluation of 4 bodies");
    let curves = [
        curve("evaluation, without SIMD", points(portable, 2), 1, Marks::DottedLine),
        curve("evaluation", points(whole, 2), 0, Marks::DottedLine),
        curve("what it must be", points(whole, 3), 0, Marks::Rings),
        curve("factorization alone", points("factorization alone", 2), 2, Marks::DottedLine),
        curve("LAPACK's factorization", vec![(64.0, 1.0), (1024.0, 1.0)], 6, Marks::Line),
    ];
    let title = "Time of a complete evaluation of 4 bodies, OpenBLAS's factorization = 1";
    chart(title, "unknowns N (nodes of all bodies)", "time / time of dgetrf(N)", &curves)
}

/// Error against time: columns scheme, nodes, tolerance, error, seconds. Runs that no faster one beats.
fn passing(rows: &[Vec<String>]) -> Outcome<String> {
    let front = |scheme: &str| -> Vec<(f64, f64)> {
        let own = rows.iter().filter(|row| row.first().is_some_and(|first| first == scheme));
        let mut all: Vec<(f64, f64)> = own.map(|row| (number(row, 4) * 1e3, number(row, 3))).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = f64::INFINITY;
        all.retain(|point| {
            let better = point.1 < best;
            best = best.min(point.1);
            better
        });
        all
    };
    let schemes =
        [("octave", "the paper's, in Octave", 1), ("plain", "the paper's, in nekton", 2), ("nekton", "nekton", 0)];
    let curves = schemes.map(|(scheme, name, k)| Curve {
        name: name.to_owned(),
        points: front(scheme),
        colour: colour(k),
        marks: Marks::DottedLine,
    });
    let title = "Two ellipses passing (the paper's section 9.2), to t = 10 s";
    chart(title, "processor time (ms)", "largest error of position (m) or angle (rad)", &curves)
}

fn main() -> Outcome<()> {
    let folder = std::env::args().nth(1).ok_or("usage: plots FOLDER")?;
    let folder = Path::new(&folder);
    fs::write(folder.join("ratio.svg"), ratio(&table(&folder.join("ratios.csv"))?)?)?;
    Ok(fs::write(folder.join("passing.svg"), passing(&table(&folder.join("passing.csv"))?)?)?)
}
