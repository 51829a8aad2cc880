//! Outlines as people have them: aerofoil files of Selig's and Lednicer's kind, CSV of any sort, paths of SVG pictures, and sections
//! by formula.

mod cells;
mod drawing;
#[cfg(test)]
mod drawing_test;
mod line;
pub mod naca;
mod noise;
#[cfg(test)]
mod noise_test;
mod path;
mod points;
pub mod smooth;
#[cfg(test)]
mod smooth_test;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::file;
use super::reader::{Item, Outcome, Problem};
use cells::{Row, Sheet, short};
pub use line::turn;
pub use noise::noise;
use points::MOST;
pub use points::Outline;

/// Both surfaces of a section begin, and end, at most this part of its chord apart.
const OPEN: f64 = 0.1;
/// A nose that both surfaces have is one point if their first points differ by less than this part of the spacing.
const SAME: f64 = 1e-6;

impl Outline {
    /// The file that an item names, and in a picture the path that another one names.
    pub fn open(from: &Item<'_>, id: Option<&Item<'_>>) -> Outcome<Self> {
        let path = from.source.relative(from.text()?);
        let bytes = file::read(&path, file::OUTLINE)
            .map_err(|e| from.problem(format!("names {}, which cannot be read: {e}", path.display())))?;
        let text = cells::text(&path, &bytes)?;
        let (outline, kind) = match id {
            _ if drawing::is_xml(&text) => drawing::read(&path, &text, id.map(Item::text).transpose()?)?,
            Some(id) => return Err(id.problem("is for SVG pictures only")),
            None => read(&path, &text).map(|(points, kind)| (Self::of(points), kind))?,
        };
        // By the name in the scene: where the scene is, is of no importance.
        Ok(outline.described(&format!("{}{kind}", from.text()?)))
    }
}

/// The points of a file, as they stand there, and in brackets what was understood beyond two columns of numbers.
fn read(path: &Path, text: &str) -> Outcome<(Vec<[f64; 2]>, String)> {
    let mut sheet = cells::sheet(path, text)?;
    let mut kind = Vec::new();
    let single = lone_number(path, &mut sheet)?;
    let (columns, header) = columns(path, &mut sheet)?;
    // A name, and a header that does not say x and y.
    let last = sheet.head.len().saturating_sub(1);
    let heads = sheet.head.iter().enumerate().filter(|(k, _)| [0, last].contains(k));
    kind.extend(heads.map(|(_, (text, _))| format!("`{}`", short(text))));
    kind.extend(single);
    kind.extend(header);
    if sheet.decimal_commas {
        kind.push("decimal commas".to_owned());
    }
    let mut rows: Vec<Point> =
        sheet.rows.iter().map(|r| Point { line: r.line, at: columns.map(|c| r.cells[c]), apart: r.apart }).collect();
    several(path, &rows)?;
    let counted = counts(path, &rows)?;
    if counted.is_some() {
        rows.remove(0);
    }
    let parts = counted.or_else(|| blocks(&rows));
    kind.extend(parts.map(|_| "upper and lower surface, joined".to_owned()));
    let points = match parts {
        Some(first) => join(path, &rows, first)?,
        None => rows.iter().map(|p| p.at).collect(),
    };
    if points.len() < 3 {
        return Err(Problem::file(path, format!("has {} points; an outline needs at least 3", points.len())));
    }
    if points.len() > MOST {
        let hint = format!("every {}th of them would do", points.len().div_ceil(MOST));
        return Err(Problem::file(path, format!("has {} points; at most {MOST} are taken", points.len())).hint(hint));
    }
    let kind = if kind.is_empty() { String::new() } else { format!(" ({})", kind.join(", ")) };
    Ok((points, kind))
}

struct Point {
    line: usize,
    at: [f64; 2],
    apart: bool,
}

/// A number alone before the points may be their count.
fn lone_number(path: &Path, sheet: &mut Sheet) -> Outcome<Option<String>> {
    let points = sheet.rows.len() - 1;
    match sheet.rows.first() {
        Some(Row { line, cells, .. }) if cells.len() == 1 => {
            if cells[0] != points as f64 {
                let message = format!("`{}` stands alone and is not the number of the {points} lines below", cells[0]);
                let hint = "if it is a name, write a word before it, such as NACA; if it is nothing, take it out";
                return Err(Problem::line(path, *line, message).hint(hint));
            }
            sheet.rows.remove(0);
            Ok(Some("with their number".to_owned()))
        }
        _ => Ok(None),
    }
}

/// Which columns are x and y, and a word on it where that was not plain.
fn columns(path: &Path, sheet: &mut Sheet) -> Outcome<([usize; 2], Option<String>)> {
    let mut counts = std::collections::BTreeMap::<usize, usize>::new();
    sheet.rows.iter().filter(|r| r.cells.len() > 1).for_each(|r| *counts.entry(r.cells.len()).or_default() += 1);
    let width = counts.iter().max_by_key(|(n, times)| (**times, usize::MAX - **n)).map_or(2, |(n, _)| *n);
    if let Some(row) = sheet.rows.iter().find(|r| r.cells.len() != width) {
        let message = format!("{} numbers where other lines have {width}", row.cells.len());
        let hint = "each line of the points has as many; a line that is none begins with #, or goes";
        return Err(Problem::line(path, row.line, message).hint(hint));
    }
    let key = |name: &String| {
        let word: String = name.chars().take_while(|c| c.is_alphabetic()).collect();
        word.to_lowercase()
    };
    let header = sheet.head.last().map(|(_, cells)| cells.clone()).unwrap_or_default();
    let named: Vec<(usize, String)> =
        header.iter().map(key).enumerate().filter(|(_, k)| k == "x" || k == "y").collect();
    let whole = header.len() == width;
    match named.as_slice() {
        // In a head between blanks, units stand apart.
        [(i, a), (j, b)] if a != b && (whole || width == 2) => {
            let [i, j] = if whole { [*i, *j] } else { [0, 1] };
            let columns = if a == "x" { [i, j] } else { [j, i] };
            sheet.head.pop();
            let text = format!("x and y from columns {} and {}", columns[0] + 1, columns[1] + 1);
            Ok((columns, (columns != [0, 1] || width != 2).then_some(text)))
        }
        [(1, x)] if width == 2 && whole && x == "x" && header[0].chars().count() < 3 => {
            let message = format!("column x stands second in the header, and none is y: {}", header.join(","));
            Err(Problem::file(path, message).hint("name the columns x and y"))
        }
        _ if width == 2 => Ok(([0, 1], None)),
        _ => {
            let line = sheet.rows.first().map_or(1, |r| r.line);
            let hint =
                "keep two columns, or name one x and one y in a header; for two surfaces write one after the other";
            let message = format!("{width} numbers to a line, and no header that tells which are x and y");
            Err(Problem::line(path, line, message).hint(hint))
        }
    }
}

/// Refuses several outlines in one file, as programs for multi-element sections part them.
fn several(path: &Path, rows: &[Point]) -> Outcome<()> {
    let mark = [999.0; 2];
    match rows.iter().find(|p| p.at == mark) {
        Some(p) if rows.iter().all(|q| q.at == mark || size(q) < 100.0) => {
            let message = "999 999 parts two outlines, but a shape has one";
            Err(Problem::line(path, p.line, message).hint("make a file for each"))
        }
        _ => Ok(()),
    }
}

fn size(p: &Point) -> f64 {
    p.at[0].abs().max(p.at[1].abs())
}

/// The number of points of the first surface, if the first line counts those of both.
fn counts(path: &Path, rows: &[Point]) -> Outcome<Option<usize>> {
    let Some((first, points)) = rows.split_first() else { return Ok(None) };
    let [a, b] = first.at;
    if [a, b].iter().any(|n| n.fract() != 0.0 || *n < 2.0) {
        return Ok(None);
    }
    let fits = a + b == points.len() as f64;
    // Where all else is of the size of a chord of 1, it cannot be a point.
    let must = points.iter().all(|p| size(p) < 2.0);
    let surfaces = || surfaces(points, a as usize);
    match (fits, must) {
        (true, _) if surfaces() => Ok(Some(a as usize)),
        (true, true) => {
            let message =
                format!("the line counts {a} and {b} points, but these do not run from the nose to the tail twice");
            let hint = "list both surfaces from the leading edge, or take the line out if the points go round";
            Err(Problem::line(path, first.line, message).hint(hint))
        }
        (false, true) => {
            let message =
                format!("`{a} {b}` is far from all other points, and does not count the {} below", points.len());
            let hint = "a Lednicer file counts the points of the upper and of the lower surface here; mend the line, or take it out";
            Err(Problem::line(path, first.line, message).hint(hint))
        }
        _ => Ok(None),
    }
}

/// Whether points are two surfaces, both from the nose to the tail.
fn surfaces(points: &[Point], first: usize) -> bool {
    let (upper, lower) = points.split_at(first.min(points.len()));
    let ends = |s: &[Point]| Some((s.first()?.at, s.last()?.at));
    let (Some((a, b)), Some((c, d))) = (ends(upper), ends(lower)) else { return false };
    let chord = gap(a, b);
    upper.len() > 1 && lower.len() > 1 && gap(a, c) <= OPEN * chord && gap(b, d) <= OPEN * chord
}

fn gap(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The same without counts: two blocks parted by a line of blanks.
fn blocks(rows: &[Point]) -> Option<usize> {
    let mut marks = rows.iter().enumerate().skip(1).filter(|(_, p)| p.apart).map(|(k, _)| k);
    let first = marks.next().filter(|_| marks.next().is_none())?;
    surfaces(rows, first).then_some(first)
}

/// One line from two surfaces: back along the first, then along the second, with one nose.
fn join(path: &Path, rows: &[Point], first: usize) -> Outcome<Vec<[f64; 2]>> {
    let (upper, lower) = rows.split_at(first.min(rows.len()));
    let (Some(nose), [start, next, ..]) = (upper.first(), lower) else {
        return Err(Problem::file(path, "has a surface without points"));
    };
    let shared = gap(nose.at, start.at) <= SAME * gap(start.at, next.at);
    Ok(upper.iter().rev().chain(lower.iter().skip(usize::from(shared))).map(|p| p.at).collect())
}
