//! Tables and plots of what `cargo xtask bench` has measured, between the markers of README.md and docs/design.md.

use crate::page::{Csv, between};
use nekton_steps::{Outcome, cargo, execute, read, root};
use std::fs;

/// Measured ratios.
pub const TABLE: &str = "docs/bench/ratios.csv";

type Result<T> = std::result::Result<T, String>;

/// Writes all of it.
pub fn write() -> Result<()> {
    let text = read(&root().join(TABLE))?;
    let (how, table): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with('#'));
    let how: Vec<&str> = how.iter().map(|line| line.trim_start_matches("# ")).collect();
    let table = Csv::parse(&table.join("\n"));
    for (file, marker, text) in [
        ("README.md", "speed", format!("{}\nMeasured {}.\n", whole(&table)?, how.join(", "))),
        ("docs/design.md", "ratios", by_size(&table)?),
    ] {
        let path = root().join(file);
        let page = between(&read(&path)?, marker, &text).map_err(|why| format!("{file}: {why}"))?;
        fs::write(&path, page).map_err(|error| format!("{file}: {error}"))?;
    }
    let mut plots = cargo(&["run", "--release", "--quiet", "--package", "nekton-bench", "--example", "plots", "--"]);
    match execute(plots.arg(root().join("docs/bench"))) {
        Outcome::Passed => Ok(()),
        Outcome::Failed(why) | Outcome::Skipped(why) => Err(why),
    }
}

/// A number with about three digits; a dash for none.
fn digits(x: Option<f64>) -> String {
    let Some(x) = x else { return "–".into() };
    let places = [100.0, 10.0, 0.1, 0.01, 0.001].iter().position(|least| x >= *least).unwrap_or(5);
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A value, or a time with its unit.
fn shown(text: &str, time: bool) -> String {
    let x = text.parse::<f64>().ok();
    match x {
        Some(x) if time && x < 1e-6 => format!("{} ns", digits(Some(1e9 * x))),
        Some(x) if time && x < 1e-3 => format!("{} µs", digits(Some(1e6 * x))),
        Some(x) if time => format!("{} ms", digits(Some(1e3 * x))),
        _ => digits(x),
    }
}

/// Every measure in a row, those of several sizes in one. A value that is larger than it must be is bold.
fn whole(table: &Csv) -> Result<String> {
    let mut text = String::from("| measure | must | aim | measured |\n|---|---|---|---|\n");
    let mut row = 0;
    while row < table.rows.len() {
        let name = table.cell(row, "measure")?;
        let last = (row..table.rows.len()).take_while(|r| table.cell(*r, "measure") == Ok(name)).last().unwrap_or(row);
        let time = name.ends_with("(s)");
        let cells = |column: &str| -> Result<Vec<&str>> { (row..=last).map(|r| table.cell(r, column)).collect() };
        let (values, musts) = (cells("value")?, cells("must")?);
        let number = |text: &str| text.parse::<f64>().ok();
        let told = values.iter().zip(&musts).map(|(value, must)| {
            let missed = number(must).is_some_and(|must| number(value).is_none_or(|value| value > must));
            let value = shown(value, time);
            if missed { format!("**{value}**") } else { value }
        });
        let told = told.collect::<Vec<_>>().join(" / ");
        let joined = |column: &str| -> Result<String> {
            let mut all: Vec<String> = cells(column)?.into_iter().map(|x| shown(x, time)).collect();
            all.dedup();
            Ok(all.join(" / "))
        };
        let sizes = if row < last { format!(", N = {}", cells("size")?.join(" / ")) } else { String::new() };
        let name = name.trim_end_matches(" (s)").replace(" / ", " ÷ ");
        text += &format!("| {name}{sizes} | {} | {} | {told} |\n", joined("must")?, joined("aim")?);
        row = last + 1;
    }
    Ok(text)
}

/// The ratios that grow or fall with the number of unknowns.
fn by_size(table: &Csv) -> Result<String> {
    let mut text = String::from(
        "| N | evaluation ÷ `dgetrf` | factorization ÷ `dgetrf` | its GFlop/s | evaluation without SIMD dispatch ÷ `dgetrf` |\n\
         |---|---|---|---|---|\n",
    );
    let cell = |name: &str, size: &str, column: &str| {
        let row = (0..table.rows.len()).find(|r| {
            table.cell(*r, "size") == Ok(size) && table.cell(*r, "measure").is_ok_and(|m| m.starts_with(name))
        });
        row.map_or(Ok(String::new()), |row| table.cell(row, column).map(str::to_owned))
    };
    for size in ["64", "128", "256", "512", "1024"] {
        text += &format!(
            "| {size} | {} | {} | {} | {} |\n",
            digits(cell("evaluation of 4 bodies", size, "value")?.parse().ok()),
            digits(cell("factorization alone", size, "value")?.parse().ok()),
            cell("factorization alone", size, "note")?.trim_end_matches(" GFlop/s"),
            digits(cell("build without SIMD dispatch", size, "value")?.parse().ok()),
        );
    }
    Ok(text)
}
