//! Mutation test of core: small wrong changes, one at a time, and which test notices each.
//!
//! A copy of core gets every change of a sample at once, each behind a switch (`copy`), and is built once with its tests. Every
//! test then tells which switches it passes, and each change is tried against those tests alone, the quickest first, two
//! changes at a time (`trial`). What was found is kept in `target/mutants` and added to when the command is given again.

mod active;
mod build;
mod copy;
mod find;
mod sample;
mod table;
mod trial;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

const USAGE: &str = "usage: cargo xtask mutants [--first N] [--minutes M] [--again] [--list]

  --first N    only the first N changes of the sample, as a trial; docs/mutants.csv is not written
  --minutes M  begin no change after M minutes; the next call goes on, here or, by docs/mutants.csv, on another machine
  --again      try again what survived, by all tests (else by those that are new, and without what is listed as equivalent)
  --list       print the sample and try nothing
";

/// Size of the sample and seed of its order.
const SAMPLE: usize = 300;
const SEED: u64 = 13;

/// What the command was asked to do.
struct Options {
    first: usize,
    minutes: Option<u64>,
    again: bool,
    list: bool,
}

/// Folders of a run.
pub struct Folders {
    /// The repository.
    pub root: PathBuf,
    /// `target/mutants`.
    pub work: PathBuf,
}

impl Folders {
    /// The changed copy of the workspace.
    pub fn copy(&self) -> PathBuf {
        self.work.join("copy")
    }
}

fn options() -> Option<Options> {
    let mut options = Options { first: SAMPLE, minutes: None, again: false, list: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--first" => options.first = words.next()?.parse().ok()?,
            "--minutes" => options.minutes = Some(words.next()?.parse().ok()?),
            "--again" => options.again = true,
            "--list" => options.list = true,
            _ => return None,
        }
    }
    Some(options)
}

fn main() -> ExitCode {
    let Some(options) = options() else {
        eprint!("{USAGE}");
        return ExitCode::from(2);
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new(".")).to_path_buf();
    let folders = Folders { work: root.join("target/mutants"), root };
    match run(&folders, &options) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Whether everything was tried and enough was noticed.
fn run(folders: &Folders, options: &Options) -> Result<bool, String> {
    let start = Instant::now();
    let end = options.minutes.map(|minutes| start + Duration::from_secs(60 * minutes));
    let order = sample::order(&folders.root, SEED)?;
    println!("{} changes are possible in {} files of core", order.mutants.len(), order.files.len());
    let chosen = build::compiled(folders, &order, options.first)?;
    if options.list {
        for &index in &chosen {
            let m = &order.mutants[index];
            println!("{index}: {} {} line {}, {}: {}", m.file, m.function, m.line, m.kind, m.change());
        }
        return Ok(true);
    }
    let tests = trial::tests(folders)?;
    let mut results = table::Results::read(&folders.work.join("results.csv"), &order, &tests)?;
    if options.again {
        results.forget_survivors();
    }
    let equivalent = table::equivalents(&folders.root.join("tests/mutants/equivalent.csv"))?;
    let path = folders.root.join("docs/mutants.csv");
    let known = (&table::listed(&order, &equivalent), &table::hints(&path, &order));
    trial::run(&order, &chosen, &tests, &mut results, known, end)?;
    let report = table::Report::new(&order, &chosen, &results, &equivalent);
    report.print();
    println!("{:.0} minutes", start.elapsed().as_secs_f64() / 60.0);
    if options.first == SAMPLE {
        std::fs::write(&path, report.csv()).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("written: docs/mutants.csv");
    }
    Ok(report.complete() && report.enough())
}
