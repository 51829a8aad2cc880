//! `cargo xtask bench`: the comparison with LAPACK, and the guards of speed.

use crate::steps::{Outcome, ask, cargo, execute, output, read, require, root};
use std::process::{Command, ExitCode};

const TABLE: &str = "docs/bench/ratios.csv";
const COUNTS: &str = "docs/bench/instructions.csv";
/// Nodes per body, columns of bodies (two rows), evaluations of the longer of two runs.
const COUNTED: [(u32, u32, u32); 3] = [(16, 2, 40), (32, 2, 20), (64, 2, 4)];
/// Relative change of a count that is let pass.
const SLACK: f64 = 0.1;

fn bench(word: &str) -> Command {
    cargo(&["run", "--release", "--quiet", "--package", "nekton-bench", "--", word])
}

/// Measures everything and writes the table.
pub fn run() -> ExitCode {
    match ask(&mut bench("table")).and_then(write) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn write(table: String) -> Result<(), String> {
    let date = output("date", &["-u", "+%Y-%m-%d"]).unwrap_or_default();
    let commit = output("git", &["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let machine = read("/proc/cpuinfo".as_ref()).unwrap_or_default();
    let machine = machine
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .unwrap_or("")
        .trim_start_matches(['\t', ' ', ':']);
    let compiler = output("rustc", &["--version"]).unwrap_or_default();
    let compiler = compiler.split(" (").next().unwrap_or("");
    let text = format!("# {date}, commit {commit}, {machine}, {compiler}\n{table}");
    print!("{text}");
    let path = root().join(TABLE);
    std::fs::create_dir_all(path.parent().unwrap_or(&path)).map_err(|error| error.to_string())?;
    std::fs::write(path, text).map_err(|error| format!("{TABLE}: {error}"))
}

/// Instructions of one evaluation, counted by callgrind, for each size. Callgrind shows programs a processor with AVX2 and
/// without AVX-512, whatever the machine has.
fn counts() -> Result<Vec<(String, f64)>, String> {
    require(&[("valgrind", "valgrind")])?;
    ask(&mut cargo(&["build", "--release", "--quiet", "--package", "nekton-bench"]))?;
    let folder = root().join("target/callgrind");
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let total = |nodes: u32, columns: u32, calls: u32| -> Result<f64, String> {
        let file = folder.join("out");
        let mut count = Command::new("valgrind");
        count.args(["--tool=callgrind", "--quiet"]).arg(format!("--callgrind-out-file={}", file.display()));
        count.arg(root().join("target/release/nekton-bench"));
        ask(count.args(["repeat".to_string(), nodes.to_string(), columns.to_string(), calls.to_string()]))?;
        let text = read(&file)?;
        let line = text.lines().find_map(|line| line.strip_prefix("totals: ").or(line.strip_prefix("summary: ")));
        line.and_then(|n| n.trim().parse().ok()).ok_or_else(|| "callgrind wrote no total".to_string())
    };
    let count = |&(nodes, columns, calls): &(u32, u32, u32)| {
        let one = (total(nodes, columns, calls)? - total(nodes, columns, 0)?) / f64::from(calls);
        Ok((format!("{} bodies of {nodes} nodes", 2 * columns), one))
    };
    COUNTED.iter().map(count).collect()
}

/// `cargo xtask bench-counts`: writes the counts that the guard expects.
pub fn write_counts() -> ExitCode {
    let written = counts().and_then(|counts| {
        let rows: String = counts.iter().map(|(name, count)| format!("{name},{count:.0}\n")).collect();
        print!("{rows}");
        let path = root().join(COUNTS);
        std::fs::create_dir_all(path.parent().unwrap_or(&path)).map_err(|error| error.to_string())?;
        std::fs::write(path, format!("scene,instructions_per_evaluation\n{rows}")).map_err(|error| error.to_string())
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// A step of the whole test run: instructions per evaluation have not grown.
pub fn held() -> Outcome {
    let expected = match read(&root().join(COUNTS)) {
        Ok(text) => text,
        Err(why) => return Outcome::Failed(why),
    };
    let counts = match counts() {
        Ok(counts) => counts,
        Err(why) => return Outcome::Skipped(why),
    };
    for (name, count) in counts {
        let old = expected.lines().find_map(|line| line.strip_prefix(&format!("{name},"))).unwrap_or("");
        let old: f64 = old.parse().unwrap_or(f64::NAN);
        println!("{name}: {count:.0} instructions, {old:.0} expected");
        // Written so that a missing line fails.
        let close = (count - old).abs() <= SLACK * old;
        if !close {
            return Outcome::Failed(format!(
                "{name}: {count:.0} instructions instead of {old:.0} (cargo xtask bench-counts)"
            ));
        }
    }
    Outcome::Passed
}

/// `cargo xtask bench-guard`: ratios against LAPACK that must hold.
pub fn guard() -> ExitCode {
    match execute(&mut bench("guard")) {
        Outcome::Passed => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
