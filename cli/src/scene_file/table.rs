//! CSV files that a scene refers to: outlines (`x,y`) and motions (`t,u[,du,ddu]`).

use std::path::Path;

use super::reader::{Item, Outcome, Problem, suggest};

/// Columns of a file with a header, all finite; with the line of each row.
struct Columns {
    names: Vec<String>,
    rows: Vec<(usize, Vec<f64>)>,
}

fn read(path: &Path, from: &Item<'_>, allowed: &[&str]) -> Outcome<Columns> {
    let complain = |e: std::io::Error| from.problem(format!("names {}, which cannot be read: {e}", path.display()));
    let bytes = std::fs::read(path).map_err(complain)?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes.as_slice());
    let mut names: Option<Vec<String>> = None;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| {
            let line = e.position().map_or(1, |p| p.line() as usize);
            Problem::line(path, line, "this is not UTF-8 text separated by commas")
        })?;
        let line = record.position().map_or(1, |p| p.line() as usize);
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

/// Points of an outline, columns `x,y`.
pub fn outline(from: &Item<'_>) -> Outcome<Vec<[f64; 2]>> {
    let path = from.source.relative(from.text()?);
    let columns = read(&path, from, &["x", "y"])?;
    let (x, y) = (columns.need(&path, "x")?, columns.need(&path, "y")?);
    Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
}

/// Rows (t, u, u̇, ü). A missing rate is the slope of the cubic spline through the column before
/// (not-a-knot ends), so that u̇ has an error of order 3 and ü of order 2 in the spacing, ends included.
pub fn motion(from: &Item<'_>) -> Outcome<Vec<[f64; 4]>> {
    let path = from.source.relative(from.text()?);
    let columns = read(&path, from, &["t", "u", "du", "ddu"])?;
    let t = columns.need(&path, "t")?;
    let back = t.windows(2).position(|w| matches!(w, [a, b] if a >= b));
    if let Some(k) = back {
        let line = columns.rows.get(k + 1).map_or(1, |r| r.0);
        let (a, b) = (t.get(k).copied().unwrap_or(0.0), t.get(k + 1).copied().unwrap_or(0.0));
        return Err(Problem::line(&path, line, format!("times must increase, but {b} follows {a}")));
    }
    let u = columns.need(&path, "u")?;
    let du = columns.get("du").unwrap_or_else(|| spline_slopes(&t, &u));
    let ddu = columns.get("ddu").unwrap_or_else(|| spline_slopes(&t, &du));
    Ok(t.iter().zip(u).zip(du).zip(ddu).map(|(((t, u), du), ddu)| [*t, u, du, ddu]).collect())
}

/// Slopes at the knots of the not-a-knot cubic spline; of the parabola or line if there are 3 or 2 points.
fn spline_slopes(t: &[f64], u: &[f64]) -> Vec<f64> {
    let n = t.len();
    let h: Vec<f64> = t.windows(2).map(|w| w[1] - w[0]).collect();
    let d: Vec<f64> = u.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    match n {
        0 | 1 => return vec![0.0; n],
        2 => return vec![d[0]; 2],
        3 => {
            let middle = (h[1] * d[0] + h[0] * d[1]) / (h[0] + h[1]);
            return vec![2.0 * d[0] - middle, middle, 2.0 * d[1] - middle];
        }
        _ => {}
    }
    // Tridiagonal: continuity of the second derivative inside, of the third at the second and last but one knots.
    let (mut low, mut diagonal, mut up, mut right) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let (a, b) = (h[0], h[1]);
    diagonal[0] = b;
    up[0] = a + b;
    right[0] = ((a + 2.0 * (a + b)) * b * d[0] + a * a * d[1]) / (a + b);
    let (a, b) = (h[n - 2], h[n - 3]);
    diagonal[n - 1] = b;
    low[n - 1] = a + b;
    right[n - 1] = ((a + 2.0 * (a + b)) * b * d[n - 2] + a * a * d[n - 3]) / (a + b);
    for k in 1..n - 1 {
        low[k] = h[k];
        diagonal[k] = 2.0 * (h[k - 1] + h[k]);
        up[k] = h[k - 1];
        right[k] = 3.0 * (h[k] * d[k - 1] + h[k - 1] * d[k]);
    }
    for k in 1..n {
        let m = low[k] / diagonal[k - 1];
        diagonal[k] -= m * up[k - 1];
        right[k] -= m * right[k - 1];
    }
    right[n - 1] /= diagonal[n - 1];
    for k in (0..n - 1).rev() {
        right[k] = (right[k] - up[k] * right[k + 1]) / diagonal[k];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::spline_slopes;

    #[test]
    fn slopes_are_exact_for_a_cubic_on_uneven_knots() {
        let t = [0.0, 0.3, 1.0, 1.1, 2.0, 3.5];
        let u: Vec<f64> = t.iter().map(|t| 1.0 - 2.0 * t + 0.5 * t * t - 0.25 * t * t * t).collect();
        for (t, s) in t.iter().zip(spline_slopes(&t, &u)) {
            assert!((s - (-2.0 + t - 0.75 * t * t)).abs() < 1e-13);
        }
        let parabola = spline_slopes(&[0.0, 1.0, 3.0], &[0.0, 1.0, 9.0]);
        assert!(parabola.iter().zip([0.0, 2.0, 6.0]).all(|(a, b)| (a - b).abs() < 1e-14));
        assert_eq!(spline_slopes(&[0.0, 2.0], &[1.0, 5.0]), [2.0, 2.0]);
        assert_eq!(spline_slopes(&[1.0], &[5.0]), [0.0]);
    }

    #[test]
    fn slopes_converge_up_to_the_ends() {
        let worst = |n: usize| {
            let t: Vec<f64> = (0..=n).map(|k| 3.0 * k as f64 / n as f64).collect();
            let u: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            t.iter().zip(spline_slopes(&t, &u)).map(|(t, s)| (s - t.cos()).abs()).fold(0.0, f64::max)
        };
        assert!(worst(20) / worst(40) > 7.0);
    }
}
