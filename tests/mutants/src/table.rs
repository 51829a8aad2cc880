//! Results on disk: what is known of each change, the hand-written list of those that change nothing, and the table.

use crate::find::Mutant;
use crate::sample::{Order, read};
use crate::trial::Tests;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a change fared.
#[derive(Clone, PartialEq, Debug)]
pub enum Outcome {
    /// This test fails.
    Killed(String),
    /// This test does not end in its time.
    Stuck(String),
    /// All tests that pass its switch succeed; how many, and when (s since 1970) the first of them was begun.
    Survived(usize, u64),
}

/// What is known, by number; written down at once.
pub struct Results {
    path: PathBuf,
    /// Of core.
    stamp: String,
    pub known: BTreeMap<usize, Outcome>,
}

impl Results {
    /// What was found in earlier runs of the same core.
    pub fn read(path: &Path, order: &Order, tests: &Tests) -> Result<Self, String> {
        let stamp = format!("{:016x}", order.hash);
        let mut known = BTreeMap::new();
        for row in std::fs::read_to_string(path).unwrap_or_default().lines().map(fields) {
            let [of, id, word, rest, begun] = row.as_slice() else { continue };
            let Ok(id) = id.parse() else { continue };
            if *of != stamp {
                continue;
            }
            let exists = tests.all.iter().any(|test| test.name() == *rest);
            match word.as_str() {
                "killed" if exists => known.insert(id, Outcome::Killed(rest.clone())),
                "stuck" if exists => known.insert(id, Outcome::Stuck(rest.clone())),
                "survived" => {
                    known.insert(id, Outcome::Survived(rest.parse().unwrap_or(0), begun.parse().unwrap_or(0)))
                }
                _ => known.remove(&id),
            };
        }
        Ok(Results { path: path.into(), stamp, known })
    }

    /// They are tried again, by all tests.
    pub fn forget_survivors(&mut self) {
        self.known.retain(|_, outcome| !matches!(outcome, Outcome::Survived(..)));
    }

    /// Adds one, in memory and on disk.
    pub fn add(&mut self, id: usize, outcome: Outcome) -> Result<(), String> {
        let (word, rest, begun) = match &outcome {
            Outcome::Killed(test) => ("killed", test.clone(), String::new()),
            Outcome::Stuck(test) => ("stuck", test.clone(), String::new()),
            Outcome::Survived(count, begun) => ("survived", count.to_string(), begun.to_string()),
        };
        let row = line(&[&self.stamp, &id.to_string(), word, &rest, &begun]);
        let mut file = std::fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .map_err(|error| format!("{}: {error}", self.path.display()))?;
        file.write_all(row.as_bytes()).map_err(|error| format!("{}: {error}", self.path.display()))?;
        self.known.insert(id, outcome);
        Ok(())
    }
}

/// One row of comma-separated values.
pub fn line(fields: &[&str]) -> String {
    let quoted = fields.iter().map(|field| {
        if field.contains([',', '"', '\n']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { (*field).into() }
    });
    quoted.collect::<Vec<String>>().join(",") + "\n"
}

/// The fields of a row.
pub fn fields(row: &str) -> Vec<String> {
    let (mut out, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = row.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                field.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => out.push(std::mem::take(&mut field)),
            _ => field.push(letter),
        }
    }
    out.push(field);
    out
}

/// What a line of the hand-written list is recognized by: file, function, code of the line, column, change.
type Key = [String; 5];

fn key(m: &Mutant) -> Key {
    [m.file.clone(), m.function.clone(), m.code.clone(), m.column.to_string(), m.change()]
}

/// Changes that stand in the hand-written list.
pub fn listed(order: &Order, equivalent: &BTreeMap<Key, String>) -> BTreeSet<usize> {
    (0..order.mutants.len()).filter(|&id| equivalent.contains_key(&key(&order.mutants[id]))).collect()
}

/// The hand-written list of changes that change nothing, with reasons.
pub fn equivalents(path: &Path) -> Result<BTreeMap<Key, String>, String> {
    let text = read(path)?;
    let mut out = BTreeMap::new();
    for (k, row) in text.lines().enumerate().skip(1) {
        let mut fields = fields(row);
        let reason = fields.pop().filter(|reason| !reason.is_empty());
        let (Some(reason), Ok(key)) = (reason, Key::try_from(fields)) else {
            return Err(format!("{}: line {} has not 6 fields, the last a reason", path.display(), k + 1));
        };
        out.insert(key, reason);
    }
    Ok(out)
}

/// By the table of an earlier run, on whatever machine and however core has changed since: which test noticed a change. It is
/// tried first.
pub fn hints(path: &Path, order: &Order) -> BTreeMap<usize, String> {
    let mut killers = BTreeMap::new();
    for row in std::fs::read_to_string(path).unwrap_or_default().lines().map(fields) {
        if let [file, _, column, function, _, code, change, _, by] = row.as_slice() {
            let key: Key = [file, function, code, column, change].map(Clone::clone);
            killers.insert(key, by.clone());
        }
    }
    let all = order.mutants.iter().enumerate();
    all.filter_map(|(id, m)| killers.get(&key(m)).map(|by| (id, by.clone()))).collect()
}

/// The table and its sums.
pub struct Report<'a> {
    rows: Vec<(&'a Mutant, Option<&'a Outcome>, Option<&'a String>)>,
    /// Of the list, what is in no sample.
    unused: Vec<Key>,
}

impl<'a> Report<'a> {
    pub fn new(
        order: &'a Order,
        chosen: &[usize],
        results: &'a Results,
        equivalent: &'a BTreeMap<Key, String>,
    ) -> Self {
        let mut used = BTreeSet::new();
        let mut rows: Vec<_> = chosen
            .iter()
            .map(|&id| {
                let m = &order.mutants[id];
                let reason = equivalent.get(&key(m));
                if reason.is_some() {
                    used.insert(key(m));
                }
                (m, results.known.get(&id), reason)
            })
            .collect();
        rows.sort_by_key(|(m, ..)| (&m.file, m.start, &m.after));
        Report { rows, unused: equivalent.keys().filter(|key| !used.contains(*key)).cloned().collect() }
    }

    /// Everything was tried.
    pub fn complete(&self) -> bool {
        self.rows.iter().all(|(_, outcome, _)| outcome.is_some())
    }

    /// [noticed (of these by standing still), survived, equivalent]
    fn sums(&self) -> [usize; 4] {
        let mut sums = [0; 4];
        for (_, outcome, reason) in &self.rows {
            match outcome {
                Some(Outcome::Killed(_)) => sums[0] += 1,
                Some(Outcome::Stuck(_)) => {
                    sums[0] += 1;
                    sums[1] += 1;
                }
                Some(Outcome::Survived(..)) if reason.is_some() => sums[3] += 1,
                Some(Outcome::Survived(..)) => sums[2] += 1,
                None => {}
            }
        }
        sums
    }

    /// 90 % of what changes anything is noticed, and nothing that is noticed stands in the list.
    pub fn enough(&self) -> bool {
        let [noticed, _, survived, _] = self.sums();
        let wrong = self.rows.iter().any(|(_, outcome, reason)| {
            reason.is_some() && matches!(outcome, Some(Outcome::Killed(_) | Outcome::Stuck(_)))
        });
        !wrong && 10 * noticed >= 9 * (noticed + survived)
    }

    pub fn print(&self) {
        let mut kinds: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
        for (m, outcome, reason) in &self.rows {
            let kind = kinds.entry(m.kind).or_default();
            match (outcome, reason) {
                (Some(Outcome::Survived(tests, _)), None) => {
                    kind[1] += 1;
                    println!(
                        "survived {tests} tests: {}:{}:{} {}: {}",
                        m.file,
                        m.line,
                        m.column,
                        m.function,
                        m.change()
                    );
                    println!("    {}", m.code);
                }
                (Some(Outcome::Killed(test) | Outcome::Stuck(test)), reason) => {
                    kind[0] += 1;
                    if reason.is_some() {
                        println!(
                            "listed as equivalent, but {test} fails: {}:{}:{} {}",
                            m.file,
                            m.line,
                            m.column,
                            m.change()
                        );
                    }
                }
                _ => {}
            }
        }
        for key in &self.unused {
            println!("listed as equivalent, but not in the sample: {}", key.join(", "));
        }
        for (kind, [noticed, survived]) in kinds {
            println!("{kind}: {noticed} of {} noticed", noticed + survived);
        }
        let [noticed, stuck, survived, equivalent] = self.sums();
        let all = noticed + survived;
        println!(
            "{noticed} of {all} changes are noticed ({:.1} %), {stuck} of them by tests that do not end; {equivalent} more change nothing",
            100.0 * noticed as f64 / all.max(1) as f64
        );
    }

    /// docs/mutants.csv.
    pub fn csv(&self) -> String {
        let mut out = line(&["file", "line", "column", "function", "kind", "code", "change", "result", "by"]);
        for (m, outcome, reason) in &self.rows {
            let survived = |tests: &usize| match (reason, tests) {
                (Some(reason), _) => ("equivalent", (*reason).clone()),
                (None, 0) => ("survived", "no test comes there".into()),
                (None, tests) => ("survived", format!("{tests} tests")),
            };
            let (word, by) = match outcome {
                Some(Outcome::Killed(test)) => ("killed", test.clone()),
                Some(Outcome::Stuck(test)) => ("killed by time", test.clone()),
                Some(Outcome::Survived(tests, _)) => survived(tests),
                None => ("not tried", String::new()),
            };
            let [row, column] = [m.line, m.column].map(|n| n.to_string());
            out += &line(&[&m.file, &row, &column, &m.function, m.kind, &m.code, &m.change(), word, &by]);
        }
        out
    }
}

#[cfg(test)]
mod test {
    use super::{fields, line};

    #[test]
    fn rows_come_back_as_they_were_written() {
        let row = ["a", "f(x, y) \"z\"", "", "→"];
        assert_eq!(fields(line(&row).trim_end()), row);
    }
}
