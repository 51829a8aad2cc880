//! `cargo xtask fuzz`: bytes as scenes and calls, for minutes.

use nekton_steps::{Outcome, cargo, execute, output, root};
use std::process::{Command, ExitCode};

/// What libFuzzer needs to see where a run goes, and the sanitizer that sees every access outside of an object.
const INSTRUMENTED: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table --cfg fuzzing -Zsanitizer=address";

/// Guided by coverage where a nightly compiler is installed, else random.
pub fn run(minutes: &str) -> ExitCode {
    let Ok(minutes) = minutes.parse::<u64>() else {
        eprintln!("--minutes takes a whole number, not {minutes}");
        return ExitCode::from(2);
    };
    let nightly = output("rustup", &["toolchain", "list"]).is_some_and(|list| list.contains("nightly"));
    let outcome = if nightly { guided(60 * minutes) } else { random(60 * minutes) };
    match outcome {
        Outcome::Passed => ExitCode::SUCCESS,
        Outcome::Failed(why) | Outcome::Skipped(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn random(seconds: u64) -> Outcome {
    println!("no nightly compiler: random scripts without guidance");
    execute(cargo(&["run", "--quiet", "--package", "nekton-fuzz", "--bin", "random", "--"]).arg(seconds.to_string()))
}

fn guided(seconds: u64) -> Outcome {
    let host = output("rustc", &["-vV"]).unwrap_or_default();
    let host = host.lines().find_map(|line| line.strip_prefix("host: ")).unwrap_or("x86_64-unknown-linux-gnu");
    let target = root().join("target/fuzz");
    let (corpus, findings) = (target.join("corpus"), root().join("fuzz/findings"));
    for folder in [&corpus, &findings] {
        if let Err(error) = std::fs::create_dir_all(folder) {
            return Outcome::Failed(error.to_string());
        }
    }
    let mut build = Command::new("cargo");
    build.args(["+nightly", "build", "--package", "nekton-fuzz", "--features", "libfuzzer", "--bin", "guided"]);
    build.args(["--release", "--target", host, "--target-dir"]).arg(&target).current_dir(root());
    build.env("RUSTFLAGS", INSTRUMENTED);
    build.env("CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS", "true").env("CARGO_PROFILE_RELEASE_LTO", "off");
    // Set by the cargo that runs this command; the nightly one must choose its own.
    build.env_remove("CARGO").env_remove("RUSTC").env_remove("RUSTUP_TOOLCHAIN");
    match execute(&mut build) {
        Outcome::Passed => {}
        outcome => return outcome,
    }
    let mut run = Command::new(target.join(host).join("release/guided"));
    run.arg(&corpus).arg(&findings).args(["-max_len=1500", "-timeout=60"]);
    run.arg(format!("-max_total_time={seconds}")).arg(format!("-artifact_prefix={}/", findings.display()));
    execute(&mut run)
}
