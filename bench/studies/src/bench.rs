//! `cargo xtask bench`: the comparison with LAPACK and with the paper's algorithm, and the guard of speed.

use crate::page::Csv;
use crate::speed::{self, TABLE};
use nekton_steps::bench::{build, programs};
use nekton_steps::{Outcome, cargo, execute, output, read, require, root};
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};

/// Error against time of the paper's example.
const PASSING: &str = "docs/bench/passing.csv";

fn finish(done: Result<(), String>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Measures everything, and writes tables and plots.
pub fn run() -> ExitCode {
    finish(measure().and_then(|()| speed::write()))
}

/// Tables and plots of what is measured already.
pub fn tables() -> ExitCode {
    finish(speed::write())
}

/// What a command prints, its progress shown.
fn listen(command: &mut Command) -> Result<String, String> {
    let done = command.stderr(Stdio::inherit()).output().map_err(|error| format!("{command:?}: {error}"))?;
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    if done.status.success() { Ok(text) } else { Err(format!("{command:?}: {}", done.status)) }
}

fn measure() -> Result<(), String> {
    if let Err(why) = require(&[("octave-cli", "octave")]) {
        eprintln!("SKIPPED: the comparison with Octave: {why}");
    }
    eprintln!("building");
    build()?;
    let [usual, portable] = programs();
    let printed = listen(Command::new(usual).arg("table"))?;
    let (ratios, passing) = printed.split_once("\n\n").ok_or("the table is cut off")?;
    let without = listen(Command::new(portable).arg("table"))?;
    eprintln!("microcontrollers");
    let embedded = on_microcontrollers();
    embedded.lines().for_each(|line| eprintln!("  {line}"));
    let portable_rows: String = without.lines().skip(2).map(|line| format!("{line}\n")).collect();
    let how = how();
    put(TABLE, &format!("{how}{ratios}\n{portable_rows}{embedded}"))?;
    put(PASSING, &format!("{how}{passing}"))
}

fn put(file: &str, text: &str) -> Result<(), String> {
    std::fs::write(root().join(file), text).map_err(|error| format!("{file}: {error}"))
}

/// Date, commit, machine, compiler.
fn how() -> String {
    let date = output("date", &["-u", "+%Y-%m-%d"]).unwrap_or_default();
    let commit = output("git", &["describe", "--always", "--dirty"]).unwrap_or_default();
    let machine = read("/proc/cpuinfo".as_ref()).unwrap_or_default();
    let machine = machine
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .unwrap_or("")
        .trim_start_matches(['\t', ' ', ':']);
    let compiler = output("rustc", &["--version"]).unwrap_or_default();
    let compiler = compiler.split(" (").next().unwrap_or("");
    format!("# {date}, commit {commit}, {machine}, {compiler}\n")
}

/// Rows of the table, of counts instead of times.
fn on_microcontrollers() -> String {
    let rows = counts().and_then(|counts| {
        let mut text = String::new();
        for row in 0..counts.rows.len() {
            let value = counts.number(row, "evaluation")? / 1e6;
            let name = format!("{}: 10⁶ instructions of an evaluation", processor(&counts, row)?);
            text += &format!("{name},48,{value:.3e},,,,,swimmer of 3 links of 16 nodes; QEMU\n");
        }
        for row in 0..counts.rows.len() {
            let value = counts.number(row, "per_multiply_add")?;
            let name = format!("{}: instructions per multiply-add of the LU", processor(&counts, row)?);
            text += &format!("{name},48,{value:.3e},5,3.5,,,QEMU\n");
        }
        Ok(text)
    });
    rows.unwrap_or_else(|why| {
        eprintln!("SKIPPED: counts on microcontrollers: {why}");
        String::new()
    })
}

/// Processor and precision.
fn processor(counts: &Csv, row: usize) -> Result<String, String> {
    Ok(format!("{} {}", counts.cell(row, "processor")?, counts.cell(row, "precision")?))
}

/// What the firmware's builder counts; what it prints of its progress comes before.
fn counts() -> Result<Csv, String> {
    let printed = listen(&mut cargo(&["xtask", "firmware", "--counts"]))?;
    let table = printed.find("processor,precision,").and_then(|start| printed.get(start..)).ok_or("no table")?;
    Ok(Csv::parse(table))
}

/// `cargo xtask bench-guard`: ratios that must hold.
pub fn guard() -> ExitCode {
    let passed = |program: &PathBuf| matches!(execute(Command::new(program).arg("guard")), Outcome::Passed);
    match build() {
        Ok(()) if programs().iter().filter(|program| !passed(program)).count() == 0 => ExitCode::SUCCESS,
        Ok(()) => ExitCode::FAILURE,
        Err(why) => finish(Err(why)),
    }
}
