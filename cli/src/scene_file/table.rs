//! CSV files that a scene refers to: functions of time (`t,u[,du,ddu]`).

use std::path::Path;

use super::file;
use super::range::excursion;
use super::reader::{Item, Outcome, Problem, suggest};
use super::slopes::{estimate, monotone, spline};

/// Columns of a file with a header, all finite; with the line of each row.
struct Columns {
    names: Vec<String>,
    rows: Vec<(usize, Vec<f64>)>,
}

fn read(path: &Path, bytes: &[u8], allowed: &[&str]) -> Outcome<Columns> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut names: Option<Vec<String>> = None;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| {
            let line = e.position().map_or(1, |p| p.line() as usize);
            Problem::line(path, line, "this is not UTF-8 text separated by commas")
        })?;
        let line = record.position().map_or(1, |p| line_of(bytes, p));
        let Some(names) = &names else {
            names = Some(header(path, line, &record, allowed)?);
            continue;
        };
        if record.len() != names.len() {
            let message = format!("{} columns instead of {}", record.len(), names.len());
            return Err(Problem::line(path, line, message).hint(format!("the header is {}", names.join(","))));
        }
        let row: Vec<f64> = record
            .iter()
            .zip(names)
            .map(|(cell, name)| match cell.parse::<f64>() {
                Ok(x) if x.is_finite() => Ok(x),
                _ => Err(Problem::line(path, line, format!("`{cell}` in column `{name}` is not a finite number"))),
            })
            .collect::<Outcome<_>>()?;
        rows.push((line, row));
    }
    let names =
        names.ok_or_else(|| Problem::file(path, format!("is empty; expected a header {}", allowed.join(","))))?;
    if rows.is_empty() {
        return Err(Problem::file(path, "has a header but no rows"));
    }
    Ok(Columns { names, rows })
}

/// Line of a record, whose position is that of the comments and empty lines before it.
fn line_of(bytes: &[u8], position: &csv::Position) -> usize {
    let rest = bytes.get(position.byte() as usize..).unwrap_or_default();
    let skipped = rest.split(|b| *b == b'\n').take_while(|l| matches!(l, [] | [b'\r'] | [b'#', ..])).count();
    position.line() as usize + skipped
}

fn header(path: &Path, line: usize, record: &csv::StringRecord, allowed: &[&str]) -> Outcome<Vec<String>> {
    let names: Vec<String> = record.iter().map(str::to_owned).collect();
    for (k, name) in names.iter().enumerate() {
        if !allowed.contains(&name.as_str()) {
            let hint = if name.parse::<f64>().is_ok() {
                Some(format!("the first line must be the header {}", allowed.join(",")))
            } else {
                suggest(name, allowed)
            };
            return Err(Problem::line(path, line, format!("unknown column `{name}`")).maybe_hint(hint));
        }
        if names.iter().take(k).any(|n| n == name) {
            return Err(Problem::line(path, line, format!("column `{name}` appears twice")));
        }
    }
    Ok(names)
}

impl Columns {
    fn index(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }
    fn need(&self, path: &Path, name: &str) -> Outcome<Vec<f64>> {
        self.get(name).ok_or_else(|| Problem::line(path, 1, format!("the header lacks column `{name}`")))
    }
    fn get(&self, name: &str) -> Option<Vec<f64>> {
        let k = self.index(name)?;
        Some(self.rows.iter().filter_map(|(_, r)| r.get(k).copied()).collect())
    }
}

/// How rates are made that a table does not give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slopes {
    /// Between two rows u stays between their values.
    Monotone,
    /// Those of a cubic spline.
    Spline,
}

impl Slopes {
    /// Reads the word.
    pub fn read(item: &Item<'_>) -> Outcome<Self> {
        let word = item.word(&["monotone", "spline"])?;
        Ok(if word == "spline" { Slopes::Spline } else { Slopes::Monotone })
    }
}

/// A function of time as rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Rows (t, u, u̇, ü).
    pub rows: Vec<[f64; 4]>,
    /// What the user should know of them.
    pub notices: Vec<String>,
}

/// What is asked of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// `slopes`, if it is given.
    pub slopes: Option<Slopes>,
    /// Whether the function may jump: a torque may, a motion may not.
    pub jumps: bool,
}

/// The slope at a turn, as part of the largest between two rows, from which on it is a loss to take 0 for it.
const LOSS: f64 = 0.01;

/// The table that an item names.
pub fn motion(from: &Item<'_>, wanted: Wanted, slopes: Option<&Item<'_>>) -> Outcome<Table> {
    let path = from.source.relative(from.text()?);
    let refuse = |message: &str| slopes.map_or_else(|| from.problem(message), |s| s.problem(message));
    let complain = |e| from.problem(format!("names {}, which cannot be read: {e}", path.display()));
    rows(&path, &file::read(&path, file::TABLE).map_err(complain)?, wanted, refuse)
}

/// Rows (t, u, u̇, ü) from the content of a file. Without `du` the rates are those of [`monotone`] or of the cubic spline
/// (not-a-knot ends: u̇ then has an error of order 3, ü of order 2 in the spacing, ends included); a missing `ddu` is the slope
/// of the spline through the rates. Each part between two jumps is taken by itself. O(rows). `refuse` complains about `slopes`.
pub fn rows(path: &Path, bytes: &[u8], wanted: Wanted, refuse: impl FnOnce(&str) -> Problem) -> Outcome<Table> {
    let columns = read(path, bytes, &["t", "u", "du", "ddu"])?;
    let (t, u) = (columns.need(path, "t")?, columns.need(path, "u")?);
    let (du, ddu) = (columns.get("du"), columns.get("ddu"));
    if let (Some(_), Some(_)) = (&du, wanted.slopes) {
        let text = format!("does not go with {}, which gives `du`", path.display());
        return Err(refuse(&text).hint("take out one of the two"));
    }
    let line = |k: usize| columns.rows.get(k).map_or(1, |r| r.0);
    let parts = parts(path, &t, wanted.jumps, line)?;
    let slopes = wanted.slopes.unwrap_or(Slopes::Monotone);
    let mut table = Table { rows: Vec::with_capacity(t.len()), notices: Vec::new() };
    let (mut worst, mut lost) = (None, None);
    for part in parts {
        let first = part.start;
        let (t, u) = (&t[part.clone()], &u[part.clone()]);
        let (du, ddu) = (du.as_ref().map(|x| &x[part.clone()]), ddu.as_ref().map(|x| &x[part.clone()]));
        let rates: Vec<[f64; 2]> = match (du, slopes) {
            (None, Slopes::Monotone) => {
                if wanted.slopes.is_none() {
                    lost = larger(lost, loss(t, u).map(|(k, v, by)| (v.abs(), (first + k, v, by))));
                }
                monotone(t, u)
            }
            (du, _) => {
                let du = du.map_or_else(|| spline(t, u), <[f64]>::to_vec);
                let ddu = ddu.map_or_else(|| spline(t, &du), <[f64]>::to_vec);
                du.into_iter().zip(ddu).map(|(v, a)| [v, a]).collect()
            }
        };
        let given = |k: usize, rate: [f64; 2]| match ddu {
            Some(ddu) => [rate[0], ddu[k]],
            None => rate,
        };
        let rows = rates.iter().enumerate().map(|(k, r)| given(k, *r)).zip(t.iter().zip(u));
        table.rows.extend(rows.map(|([v, a], (t, u))| [*t, *u, v, a]));
        // Monotone pieces cannot leave the range of their rows, unless the file gives ü.
        if du.is_some() || ddu.is_some() || slopes == Slopes::Spline {
            let far = excursion(&table.rows[first..]);
            worst = larger(worst, far.map(|e| (e.over, (first + e.row, e))));
        }
    }
    let at = |k: usize| format!("{}:{}", path.display(), line(k));
    if let Some((_, (k, e))) = worst {
        let (a, b) = (table.rows[k], table.rows[k + 1]);
        let others = if e.pieces > 1 { format!(", the farthest of {}", e.pieces) } else { String::new() };
        table.notices.push(format!(
            "{}: between t = {} and {} the interpolant goes to {:.6e}, far from its rows' {} and {}{others} (give more rows \
             there, look at `du` and `ddu`, or leave rates and `slopes` away)",
            at(k),
            a[0],
            b[0],
            e.value,
            a[1],
            b[1]
        ));
    }
    if let Some((_, (k, v, by))) = lost {
        table.notices.push(format!(
            "{}: the rows turn smoothly about t = {}, where the rate is taken as 0: they suggest {v:.2e}, and the value errs by \
             about {by:.1e} (give `du` or slopes = \"spline\"; slopes = \"monotone\" keeps it so, without this notice)",
            at(k),
            t[k]
        ));
    }
    Ok(table)
}

fn larger<T>(a: Option<(f64, T)>, b: Option<(f64, T)>) -> Option<(f64, T)> {
    match (&a, &b) {
        (Some(x), Some(y)) if x.0 >= y.0 => a,
        (Some(_), None) => a,
        _ => b,
    }
}

/// The parts between jumps: rows of equal times, which only a torque may have.
fn parts(path: &Path, t: &[f64], jumps: bool, line: impl Fn(usize) -> usize) -> Outcome<Vec<std::ops::Range<usize>>> {
    let mut parts = Vec::new();
    let mut first = 0;
    for k in 1..t.len() {
        let (a, b) = (t[k - 1], t[k]);
        if a < b {
            continue;
        }
        if a > b {
            return Err(Problem::line(path, line(k), format!("times must increase, but {b} follows {a}")));
        }
        if !jumps {
            let message =
                format!("t = {b} stands here and on line {}: a jump, which a motion cannot make", line(k - 1));
            let hint = "leave out one of the two rows, or move them apart by the time that the change takes";
            return Err(Problem::line(path, line(k), message).hint(hint));
        }
        if k - first == 1 && first > 0 {
            let message = format!("t = {b} stands in three rows, of which the one between means nothing");
            return Err(Problem::line(path, line(k), message).hint("two rows of one time are a jump: before and after"));
        }
        parts.push(first..k);
        first = k;
    }
    parts.push(first..t.len());
    Ok(parts)
}

/// The turn of smooth rows at which most is lost by a rate of 0: its row, the rate that the rows suggest there, and what it
/// would add to the value. Rows are smooth where three neighbouring second differences have one sign and about one size.
fn loss(t: &[f64], u: &[f64]) -> Option<(usize, f64, f64)> {
    let slope = |k: usize| (u[k + 1] - u[k]) / (t[k + 1] - t[k]);
    let second = |k: usize| 2.0 * (slope(k) - slope(k - 1)) / (t[k + 1] - t[k - 1]);
    let most = (0..t.len().saturating_sub(1)).map(|k| slope(k).abs()).fold(0.0, f64::max);
    let mut worst = None;
    for k in 2..t.len().saturating_sub(2) {
        if slope(k - 1) * slope(k) > 0.0 {
            continue;
        }
        let bends = [second(k - 1), second(k), second(k + 1)];
        let [low, high] =
            bends.iter().fold([f64::INFINITY, 0.0], |[a, b], s| [f64::min(a, s.abs()), f64::max(b, s.abs())]);
        let one_sign = bends.iter().all(|s| s * bends[1] > 0.0);
        if one_sign && high <= 2.0 * low {
            let v = estimate(t, u, k)[0];
            worst = larger(worst, Some((v.abs(), (k, v, 0.5 * v * v / low))));
        }
    }
    worst.filter(|(v, _)| *v > LOSS * most).map(|(_, w)| w)
}
