//! Instructions of what is called again and again, counted by callgrind: the guard of speed that no other work disturbs.

use nekton_steps::bench::{build, programs};
use nekton_steps::{Outcome, ask, read, require, root};
use std::path::Path;
use std::process::{Command, ExitCode};

const COUNTS: &str = "docs/bench/instructions.csv";
/// Relative change of a count that is let pass.
const SLACK: f64 = 0.1;
const VALGRIND: [(&str, &str); 1] = [("valgrind", "valgrind")];

/// Name and instructions of one call, for each scene that the benchmark program offers and by both its builds. Callgrind
/// shows programs a processor with AVX2 and without AVX-512, whatever the machine has.
fn counts() -> Result<Vec<(String, f64)>, String> {
    require(&VALGRIND)?;
    build()?;
    let folder = root().join("target/callgrind");
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let total = |program: &Path, name: &str, calls: u32| -> Result<f64, String> {
        let file = folder.join("out");
        let mut count = Command::new("valgrind");
        count.args(["--tool=callgrind", "--quiet"]).arg(format!("--callgrind-out-file={}", file.display()));
        ask(count.arg(program).args(["repeat", name, &calls.to_string()]))?;
        let text = read(&file)?;
        let line = text.lines().find_map(|line| line.strip_prefix("totals: ").or(line.strip_prefix("summary: ")));
        line.and_then(|n| n.trim().parse().ok()).ok_or_else(|| "callgrind wrote no total".to_string())
    };
    let mut all = Vec::new();
    for (program, prefix) in programs().iter().zip(["", "portable: "]) {
        for line in ask(Command::new(program).arg("counted"))?.lines() {
            let (name, calls) = line.rsplit_once(',').ok_or("no number of calls")?;
            let calls: u32 = calls.parse().map_err(|_| line.to_string())?;
            let one = (total(program, name, calls)? - total(program, name, 0)?) / f64::from(calls);
            all.push((format!("{prefix}{name}"), one));
        }
    }
    Ok(all)
}

/// `cargo xtask bench-counts`: writes the counts that the test run expects.
pub fn write() -> ExitCode {
    let written = counts().and_then(|counts| {
        let rows: String = counts.iter().map(|(name, count)| format!("{name},{count:.0}\n")).collect();
        print!("{rows}");
        std::fs::write(root().join(COUNTS), format!("what,instructions\n{rows}")).map_err(|error| error.to_string())
    });
    crate::archive::finish(written, COUNTS)
}

/// A step of the whole test run: instructions have not grown, nor fallen unnoticed.
pub fn held() -> Outcome {
    let expected = match read(&root().join(COUNTS)) {
        Ok(text) => text,
        Err(why) => return Outcome::Failed(why),
    };
    if let Err(why) = require(&VALGRIND) {
        return Outcome::Skipped(why);
    }
    let counts = match counts() {
        Ok(counts) => counts,
        Err(why) => return Outcome::Failed(why),
    };
    let mut changed = Vec::new();
    for (name, count) in counts {
        let old = expected.lines().find_map(|line| line.strip_prefix(&format!("{name},"))).unwrap_or("");
        let old: f64 = old.parse().unwrap_or(f64::NAN);
        println!("{name}: {count:.0} instructions, {old:.0} expected");
        // Written so that a missing line fails.
        let close = (count - old).abs() <= SLACK * old;
        if !close {
            changed.push(format!("{name}: {count:.0} instructions instead of {old:.0}"));
        }
    }
    match changed.is_empty() {
        true => Outcome::Passed,
        false => Outcome::Failed(format!("{} (cargo xtask bench-counts)", changed.join("; "))),
    }
}
