//! `cargo xtask extremes`: runs at the edges of what a scene may say, and the page that tells of them: its figures are those of
//! the tables in docs/accuracy, its words stand in docs/accuracy/extremes.md.

use crate::page::{Csv, between};
use nekton_steps::{cargo, read, root};
use std::process::ExitCode;

type Result<T> = std::result::Result<T, String>;

/// Tables of errors, and the range that each covers.
const TABLES: [(&str, &str); 10] = [
    ("density", "bodies 1e-6 … 1e6 times as dense as the fluid, and a fluid of density 0"),
    ("length_same_durations", "sizes of 1e-6 … 1e6 m"),
    ("length_same_speeds", "the same; as fast, for as much shorter or longer"),
    ("bodies", "1 … 50 bodies, 16 nodes each"),
    ("tank", "disc in a disc tank, gap 3 … 1e-4 radii, 64 nodes"),
    ("gap", "flanks 1e-1 … 1e-7 sizes apart, 96 nodes"),
    ("aspect", "ellipses 1:1 … 1:1000 side by side, 96 nodes"),
    ("circulation", "γ = 1e-2 … 1e6 speed × size"),
    ("spin", "10 … 1e6 × translation"),
    ("repulsion", "exponents 1 … 12, a bounce"),
];

/// Measures one table or all of them (of `long_run` the runs that are named), and writes the page.
pub fn run(words: &[&str]) -> ExitCode {
    let folder = root().join("docs/accuracy");
    let mut command =
        cargo(&["run", "--release", "--quiet", "--package", "nekton-tests", "--example", "extremes", "--"]);
    if command.arg(folder).args(words).status().is_ok_and(|status| status.success()) {
        pages()
    } else {
        ExitCode::FAILURE
    }
}

/// Writes the figures of the tables into docs/accuracy/extremes.md, and that page into docs/accuracy.md.
pub fn pages() -> ExitCode {
    let written = written().and_then(|pages| {
        for (file, text) in pages {
            std::fs::write(root().join(file), text).map_err(|why| format!("{file}: {why}"))?;
        }
        Ok(())
    });
    if let Err(why) = &written {
        eprintln!("{why}");
    }
    if written.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Both pages as they should be.
fn written() -> Result<[(&'static str, String); 2]> {
    let [page, all] = ["docs/accuracy/extremes.md", "docs/accuracy.md"];
    let text = between(&read(&root().join(page))?, "extremes_errors", &errors()?)?;
    let text = between(&text, "extremes_long_run", &long_run()?)?;
    // A fragment's links are relative to its own folder.
    let fragment = text.replace("](extremes", "](accuracy/extremes");
    let whole = between(&read(&root().join(all))?, "extremes", &fragment)?;
    Ok([(page, text), (all, whole)])
}

fn table(name: &str) -> Result<Csv> {
    read(&root().join(format!("docs/accuracy/extremes_{name}.csv"))).map(|text| Csv::parse(&text))
}

/// The largest errors and indicators of each table, and the runs that were refused.
fn errors() -> Result<String> {
    let mut text = String::from(
        "| table | range | largest error `f64` | at | `f32` | at | largest indicator of space `f64` | `f32` | ended otherwise |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (name, range) in TABLES {
        let csv = table(name)?;
        let line = row(&csv).map_err(|why| format!("extremes_{name}.csv: {why}"))?;
        text += &format!("| [{}](extremes_{name}.csv) | {range} |{line}\n", name.replace('_', " "));
    }
    Ok(text)
}

fn row(csv: &Csv) -> Result<String> {
    let indicators = ["mass", "force", "quadrature", "repulsion"].map(|what| format!("indicator_{what}"));
    let (mut errors, mut space, mut refused) = (String::new(), String::new(), Vec::new());
    for precision in ["f64", "f32"] {
        let (mut worst, mut indicated) = ((0.0, String::from("–")), 0.0_f64);
        for k in 0..csv.rows.len() {
            if csv.cell(k, "precision")? != precision {
                continue;
            }
            let (value, status) = (csv.first(k)?, csv.cell(k, "status")?);
            if status != "Ok" {
                refused.push(format!("`{precision}` {value}: `{status}`"));
                continue;
            }
            let error = csv.number(k, "position_error_sizes")?;
            if error.is_nan() || error > worst.0 {
                worst = (error, value.to_owned());
            }
            for name in &indicators {
                indicated = indicated.max(csv.number(k, name)?);
            }
        }
        errors += &format!(" {:.0e} | {} |", worst.0, worst.1);
        space += &format!(" {indicated:.0e} |");
    }
    Ok(format!("{errors}{space} {} |", refused.join(", ")))
}

/// Drifts of the energy after the longest run of each motion and method.
fn long_run() -> Result<String> {
    let csv = table("long_run")?;
    let mut text = String::from("| motion | method | `f64` | `f32` |\n|---|---|---|---|\n");
    let mut runs: Vec<[&str; 2]> = Vec::new();
    for k in 0..csv.rows.len() {
        let run = [csv.cell(k, "motion")?, csv.cell(k, "method")?];
        if !runs.contains(&run) {
            runs.push(run);
        }
    }
    for [motion, method] in runs {
        text += &format!("| {} | `{method}` |", motion.replace('_', " "));
        for precision in ["f64", "f32"] {
            let own = |k: &usize| {
                let of = |name| csv.cell(*k, name).unwrap_or_default();
                [of("motion"), of("method"), of("precision")] == [motion, method, precision]
            };
            let last = (0..csv.rows.len()).rfind(own);
            let Some(k) = last else { return Err(format!("extremes_long_run.csv: no {motion} {method} {precision}")) };
            text += &match (csv.cell(k, "status")?, csv.cell(k, "steps")?, csv.cell(k, "energy_drift_relative")?) {
                ("Ok", "1000000", drift) => format!(" {drift} |"),
                ("Ok", steps, drift) => format!(" {drift} after {steps} |"),
                (status, steps, _) => format!(" `{status}` after {steps} |"),
            };
        }
        text += "\n";
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_the_extremes_has_the_figures_of_its_tables() {
        for (file, text) in written().unwrap() {
            assert!(read(&root().join(file)).unwrap() == text, "{file}: run `cargo xtask extremes --tables`");
        }
    }
}
