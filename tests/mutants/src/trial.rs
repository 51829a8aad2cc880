//! Test programs: what each test takes and passes, and how the changes fare.

use crate::Folders;
use crate::build::cargo;
use crate::find::Mutant;
use crate::sample::{Order, read};
use crate::table::{Outcome, Results, fields, line};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant, SystemTime};

/// Changes tried at the same time.
const WORKERS: usize = 2;
/// Tests that take longer are studies, and left out.
const LONGEST: Duration = Duration::from_secs(60);
/// What a run may take of memory, KiB: a change must not fill the machine.
const MEMORY: &str = "4000000";

/// How a process ends that has used its time.
const SIGXCPU: i32 = 24;
const SIGKILL: i32 = 9;

/// A test of a test program.
#[derive(Clone)]
pub struct Test {
    program: PathBuf,
    /// Of the program, without its hash.
    binary: String,
    name: String,
    /// When it was built, s since 1970.
    built: u64,
    /// Of the processor.
    seconds: f64,
    passes: BTreeSet<usize>,
}

impl Test {
    pub fn name(&self) -> String {
        format!("{}: {}", self.binary, self.name)
    }
}

/// All tests that are used.
pub struct Tests {
    pub all: Vec<Test>,
}

/// Seconds since 1970.
fn seconds(time: SystemTime) -> u64 {
    time.duration_since(SystemTime::UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// How a test ended.
#[derive(PartialEq)]
enum Ended {
    Passed,
    Failed,
    TooLong,
}

/// One test with a change switched on, or with its switches counted. The limit is of the processor's time, since other
/// programs may be busy as well; one that sleeps is ended as well, long after.
fn run_test(test: &Test, mutant: &str, cover: Option<&Path>, limit: Duration) -> Result<Ended, String> {
    let mut command = Command::new("nice");
    let bounded = format!("ulimit -v {MEMORY}; ulimit -t {}; exec \"$0\" \"$@\"", limit.as_secs() + 1);
    command.args(["sh", "-c", &bounded]).arg(&test.program);
    command.args(["--exact", &test.name, "--test-threads", "1", "--quiet"]);
    command.env("NEKTON_MUTANT", mutant).env("RUST_BACKTRACE", "0");
    if let Some(cover) = cover {
        command.env("NEKTON_COVER", cover);
    }
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let (start, mut child) = (Instant::now(), command.spawn().map_err(|error| format!("{}: {error}", test.name()))?);
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            let out_of_time = matches!(status.signal(), Some(SIGXCPU | SIGKILL));
            return Ok(match (status.success(), out_of_time) {
                (true, _) => Ended::Passed,
                (false, true) => Ended::TooLong,
                (false, false) => Ended::Failed,
            });
        }
        if start.elapsed() > 20 * limit {
            let _ = child.kill();
            let _ = child.wait();
            return Ok(Ended::TooLong);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

/// Builds the test programs of the copy, and runs every test once without any change.
pub fn tests(folders: &Folders) -> Result<Tests, String> {
    println!("building the tests");
    let start = Instant::now();
    let output =
        cargo(folders, &["test", "--no-run", "--package", "nekton", "--package", "nekton-tests", "--lib", "--tests"])
            .output()
            .map_err(|error| format!("cargo: {error}"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(text.into_owned());
    }
    println!("built in {:.0} s", start.elapsed().as_secs_f64());
    let programs = text.lines().filter_map(|line| {
        let path = PathBuf::from(line.trim().strip_prefix("Executable")?.rsplit_once('(')?.1.strip_suffix(')')?);
        Some(if path.is_absolute() { path } else { folders.copy().join(path) })
    });
    let mut all = Vec::new();
    for program in programs {
        let stem = program.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let binary = stem.rsplit_once('-').map_or(stem.clone(), |(name, _)| name.into());
        let built = std::fs::metadata(&program).and_then(|data| data.modified()).map_or(u64::MAX, seconds);
        let listed = Command::new(&program)
            .args(["--list", "--format", "terse"])
            .output()
            .map_err(|error| format!("{}: {error}", program.display()))?;
        for line in String::from_utf8_lossy(&listed.stdout).lines() {
            if let Some(name) = line.strip_suffix(": test") {
                let (program, binary) = (program.clone(), binary.clone());
                let name = name.into();
                all.push(Test { program, binary, name, built, seconds: f64::NAN, passes: BTreeSet::new() });
            }
        }
    }
    // What is known of the same program.
    let memory = folders.work.join("tests.csv");
    let known = read(&memory).unwrap_or_default();
    let known: BTreeMap<(String, u64), (f64, BTreeSet<usize>)> = known
        .lines()
        .filter_map(|row| match fields(row).as_slice() {
            [name, built, seconds, passes] => {
                let passes = passes.split_whitespace().filter_map(|word| word.parse().ok()).collect();
                Some(((name.clone(), built.parse().ok()?), (seconds.parse().ok()?, passes)))
            }
            _ => None,
        })
        .collect();
    let queue: Mutex<VecDeque<usize>> = Mutex::new((0..all.len()).collect());
    let (slots, failures): (Vec<Mutex<Test>>, _) = (all.into_iter().map(Mutex::new).collect(), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for worker in 0..WORKERS {
            let (queue, slots, failures, known) = (&queue, &slots, &failures, &known);
            scope.spawn(move || {
                while let Some(k) = queue.lock().ok().and_then(|mut queue| queue.pop_front()) {
                    let Ok(mut test) = slots[k].lock() else { continue };
                    if let Some((seconds, passes)) = known.get(&(test.name(), test.built)) {
                        (test.seconds, test.passes) = (*seconds, passes.clone());
                        continue;
                    }
                    let cover = folders.work.join(format!("cover-{worker}.txt"));
                    let _ = std::fs::remove_file(&cover);
                    let start = Instant::now();
                    let ended = run_test(&test, "cover", Some(&cover), LONGEST);
                    let told = std::fs::read_to_string(&cover).unwrap_or_default();
                    let (spent, passed) = told.split_once('\n').unwrap_or_default();
                    test.seconds = spent.parse().map_or(start.elapsed().as_secs_f64(), |spent: f64| spent / 100.0);
                    test.passes = passed.split_whitespace().filter_map(|word| word.parse().ok()).collect();
                    if ended == Ok(Ended::TooLong) {
                        println!("left out, since it takes longer than {} s: {}", LONGEST.as_secs(), test.name());
                        test.passes.clear();
                    } else if ended != Ok(Ended::Passed)
                        && let Ok(mut failures) = failures.lock()
                    {
                        failures.push(test.name());
                    }
                }
            });
        }
    });
    let failures = failures.into_inner().unwrap_or_default();
    if !failures.is_empty() {
        return Err(format!("these fail without any change: {}", failures.join(", ")));
    }
    let all: Vec<Test> = slots.into_iter().filter_map(|slot| slot.into_inner().ok()).collect();
    let rows = all.iter().map(|test| {
        let passes: Vec<String> = test.passes.iter().map(usize::to_string).collect();
        line(&[&test.name(), &test.built.to_string(), &format!("{:.4}", test.seconds), &passes.join(" ")])
    });
    std::fs::write(&memory, rows.collect::<String>()).map_err(|error| format!("{}: {error}", memory.display()))?;
    println!("{} tests take {:.0} s", all.len(), all.iter().map(|test| test.seconds).sum::<f64>());
    Ok(Tests { all })
}

/// How often tests noticed anything, in all and in one file: what to try first.
#[derive(Default)]
struct Luck {
    all: BTreeMap<String, usize>,
    file: BTreeMap<(String, String), usize>,
}

impl Luck {
    fn note(&mut self, test: &str, file: &str) {
        *self.all.entry(test.into()).or_default() += 1;
        *self.file.entry((test.into(), file.into())).or_default() += 1;
    }

    /// Seconds for a hope.
    fn cost(&self, test: &Test, file: &str) -> f64 {
        let name = test.name();
        let all = self.all.get(&name).copied().unwrap_or(0) as f64;
        let here = self.file.get(&(name, file.into())).copied().unwrap_or(0) as f64;
        (test.seconds + 0.01) / (1.0 + all + 10.0 * here)
    }
}

/// Tries one change by the tests that were built since the time `tried`.
fn one(
    id: usize,
    mutant: &Mutant,
    (tests, hint): (&Tests, Option<&String>),
    tried: u64,
    luck: &Mutex<Luck>,
) -> Result<Outcome, String> {
    let begun = seconds(SystemTime::now());
    let passing = || tests.all.iter().filter(|test| test.passes.contains(&id));
    let mut order: Vec<&Test> = passing().filter(|test| test.built >= tried).collect();
    if let Ok(luck) = luck.lock() {
        order.sort_by(|a, b| luck.cost(a, &mutant.file).total_cmp(&luck.cost(b, &mutant.file)));
    }
    order.sort_by_key(|test| hint.is_none_or(|hint| test.name() != *hint));
    for test in &order {
        let limit = Duration::from_secs_f64(5.0 + 10.0 * test.seconds);
        let ended = run_test(test, &id.to_string(), None, limit)?;
        if ended == Ended::Passed {
            continue;
        }
        let name = test.name();
        if let Ok(mut luck) = luck.lock() {
            luck.note(&name, &mutant.file);
        }
        return Ok(if ended == Ended::Failed { Outcome::Killed(name) } else { Outcome::Stuck(name) });
    }
    Ok(Outcome::Survived(passing().count(), begun))
}

/// Tries every change that is not known, until `end`.
pub fn run(
    order: &Order,
    chosen: &[usize],
    tests: &Tests,
    results: &mut Results,
    (equivalent, hints): (&BTreeSet<usize>, &BTreeMap<usize, String>),
    end: Option<Instant>,
) -> Result<(), String> {
    // Of what survived, those that a test passes which was built since, but for those that are known to change nothing.
    let due = |id: &usize| match results.known.get(id) {
        None => true,
        Some(Outcome::Survived(..)) if equivalent.contains(id) => false,
        Some(Outcome::Survived(_, tried)) => tests.all.iter().any(|t| t.built >= *tried && t.passes.contains(id)),
        Some(_) => false,
    };
    let left: VecDeque<usize> = chosen.iter().copied().filter(due).collect();
    let (start, count) = (Instant::now(), left.len());
    println!("{} of {} are known, {count} are tried", chosen.len() - count, chosen.len());
    let mut luck = Luck::default();
    for (&id, outcome) in &results.known {
        if let Outcome::Killed(test) = outcome {
            luck.note(test, &order.mutants[id].file);
        }
    }
    let (queue, luck, results, failure) = (Mutex::new(left), Mutex::new(luck), Mutex::new(results), Mutex::new(None));
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            let (queue, luck, results, failure) = (&queue, &luck, &results, &failure);
            scope.spawn(move || {
                while end.is_none_or(|end| Instant::now() < end) {
                    let Some(id) = queue.lock().ok().and_then(|mut queue| queue.pop_front()) else { break };
                    let mutant = &order.mutants[id];
                    let begin = Instant::now();
                    let tried = match results.lock().ok().and_then(|results| results.known.get(&id).cloned()) {
                        Some(Outcome::Survived(_, tried)) => tried,
                        _ => 0,
                    };
                    let told = one(id, mutant, (tests, hints.get(&id)), tried, luck).and_then(|outcome| {
                        let word = match &outcome {
                            Outcome::Killed(test) => format!("killed by {test}"),
                            Outcome::Stuck(test) => format!("killed by the time of {test}"),
                            Outcome::Survived(count, _) => format!("SURVIVED {count} tests"),
                        };
                        println!(
                            "{:5.0} s {:5.1} s  {}:{}:{} {}: {word}",
                            start.elapsed().as_secs_f64(),
                            begin.elapsed().as_secs_f64(),
                            mutant.file,
                            mutant.line,
                            mutant.column,
                            mutant.change(),
                        );
                        results.lock().map_err(|error| error.to_string())?.add(id, outcome)
                    });
                    if let Err(why) = told {
                        if let Ok(mut failure) = failure.lock() {
                            *failure = Some(why);
                        }
                        break;
                    }
                }
            });
        }
    });
    let seconds = start.elapsed().as_secs_f64();
    let tried = count - queue.into_inner().unwrap_or_default().len();
    println!("{tried} tried in {seconds:.0} s");
    failure.into_inner().unwrap_or_default().map_or(Ok(()), Err)
}
