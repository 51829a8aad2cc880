//! The smoothest outline within a distance of points that scatter.
//!
//! With q the fitted and p the given points, Σ |q − p|² + λ ∫ |q‴ + κ² q′|² ds is least, s being the length along the line; λ is
//! the largest with which no point moves farther than allowed. Without corners κ = 2π / perimeter, so that circles cost nothing and
//! do not shrink. Between corners, which stay where they are, κ is 0, and nothing reaches across them. The integral is a sum over
//! divided differences, the trigonometric ones for κ > 0; least squares by rotations, since normal equations would lose the digits
//! of long waves. O(points).

use super::line::{distinct, extent, turn, twice_area};
use super::noise::{Noise, noise};
use super::points::{Outline, six};

/// Fewer points are a shape, not a fit.
const LEAST: usize = 8;
/// A corner turns by so many standard deviations of what scatter turns.
const STANDS_OUT: f64 = 5.0;
/// Halvings of the logarithm of λ, to 1 % of it.
const HALVINGS: usize = 14;
/// Unlike lengths, relative to their mean, at least: what lies closer is taken apart by so much.
const CLOSEST: f64 = 1e-4;
/// The square root of λ times the largest weight, at most: above, rounding would be what is fitted.
const STIFFEST: f64 = 1e13;

/// Whether a point's turn is more than what points that scatter by `sigma` make of a straight line.
pub fn stands_out(points: &[[f64; 2]], k: usize, sigma: f64) -> bool {
    let n = points.len();
    let [a, b, c] = [k + n - 1, k, k + 1].map(|i| points[i % n]);
    let least = (a[0] - b[0]).hypot(a[1] - b[1]).min((c[0] - b[0]).hypot(c[1] - b[1]));
    turn(points, k).to_radians() * least > STANDS_OUT * 6.0_f64.sqrt() * sigma
}

/// What points that were moved may change the added mass by, over their way (rms) and the outline's narrower extent. Scatter about a smooth
/// outline leaves less, by up to the root of the number of points; points rounded to a grid, and tips that are cut off, leave as much.
const MOVED: f64 = 10.0;

impl Outline {
    /// The same with the points of the smoothest curve within a distance of them; or what is wrong, and what helps. Corners stay.
    pub fn smoothed(self, corners: &[usize], within: f64) -> Result<Self, (String, String)> {
        let given = distinct(&self.points);
        let n = given.len();
        if n < LEAST {
            return Err((format!("needs at least {LEAST} points, but there are {n}"), "leave it out".to_owned()));
        }
        if let Some(k) = (1..n).find(|k| given[*k] == given[*k - 1]) {
            let hint = "leave one of the two out; points count from 0".to_owned();
            return Err((format!("cannot part points that are one: point {k} repeats the one before it"), hint));
        }
        let size = extent(given).into_iter().fold(0.0, f64::max);
        let scattered = self.noise.map(|noise| noise.sigma);
        if !size.is_finite() || within >= size {
            let text = format!("must be less than the outline's size, {} m, but is {within:e}", six(size));
            let fair = self.noise.map_or(1e-3 * size, |noise| noise.distance(n));
            return Err((text, format!("a few times the scatter of its points is enough, such as {fair:.0e}")));
        }
        let [first, last] = [given[0], given[n - 1]];
        // What is repeated at the end stays so, and the core drops it.
        let own = |k: usize| {
            let p = self.points[k];
            let far = |q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
            if k < n {
                k
            } else if far(last) < far(first) {
                n - 1
            } else {
                0
            }
        };
        let pinned: Vec<usize> = corners.iter().map(|k| own(*k)).collect();
        let mut points = smooth(given, &pinned, within);
        let [most, rms] = moved(given, &points);
        let area = six(0.5 * twice_area(&points).abs());
        points.extend((n..self.points.len()).map(|k| points[own(k)]).collect::<Vec<_>>());
        let kept = match corners {
            [] => String::new(),
            [k] => format!(", the corner at point {k} (counted from 0) kept"),
            corners => format!(", {} corners kept", corners.len()),
        };
        let scattered = scattered.map_or_else(String::new, |s| format!(" (they scattered by about {s:.0e} m)"));
        let told = format!(
            "smoothed within {within:e} m: its points were moved by {most:.1e} m at most, {rms:.1e} m rms{scattered}{kept}; the polygon \
             through them has {area} m² then"
        );
        let told = self.told.into_iter().chain([told]).collect::<Vec<_>>().join("; ");
        // What is left tells that the distance was too short; what there was, which one is long enough.
        let left = noise(&points, corners);
        let noise =
            left.map(|left| Noise { sigma: self.noise.map_or(left.sigma, |n| n.sigma.max(left.sigma)), ..left });
        let narrow = extent(given).into_iter().fold(f64::INFINITY, f64::min);
        let smoothing = Some((MOVED * rms / narrow).min(1.0));
        Ok(Outline { noise, points, told: Some(told), corners: self.corners, smoothing })
    }
}

/// The fitted points; the given ones, if none lie within the distance. Points are at least [`LEAST`], corners increase.
pub(super) fn smooth(given: &[[f64; 2]], corners: &[usize], within: f64) -> Vec<[f64; 2]> {
    let size = extent(given).into_iter().fold(0.0, f64::max);
    let from = given.first().copied().unwrap_or_default();
    let points: Vec<[f64; 2]> = given.iter().map(|p| [0, 1].map(|c| (p[c] - from[c]) / size)).collect();
    let n = points.len();
    let mut pinned = vec![false; n];
    corners.iter().filter(|k| **k < n).for_each(|k| pinned[*k] = true);
    let fit = Penalty::along(&points, &pinned).within(&points, &pinned, within / size).unwrap_or(points);
    let back = |(k, q): (usize, &[f64; 2])| if pinned[k] { given[k] } else { [0, 1].map(|c| from[c] + size * q[c]) };
    fit.iter().enumerate().map(back).collect()
}

/// The largest and the root mean square distance between points and those that they became.
pub(super) fn moved(from: &[[f64; 2]], to: &[[f64; 2]]) -> [f64; 2] {
    let distances = from.iter().zip(to).map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]));
    let [most, sum] = distances.fold([0.0, 0.0], |[most, sum], d| [f64::max(most, d), sum + d * d]);
    [most, (sum / from.len() as f64).sqrt()]
}

/// Rows of four weights each, at this point and the three after it; none where a corner is between.
struct Penalty {
    rows: Vec<Option<[f64; 4]>>,
}

impl Penalty {
    fn along(points: &[[f64; 2]], pinned: &[bool]) -> Self {
        let n = points.len();
        let step = |i: usize| {
            let (p, q) = (points[i], points[(i + 1) % n]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let perimeter: f64 = (0..n).map(step).sum();
        let least = CLOSEST * perimeter / n as f64;
        // The perimeter is 2π, so κ is 1.
        let unit = std::f64::consts::TAU / (0..n).map(|i| step(i).max(least)).sum::<f64>();
        let round = !pinned.contains(&true);
        let chord = |d: f64| if round { 2.0 * (0.5 * d).sin() } else { d };
        let row = |i: usize| {
            if pinned[(i + 1) % n] || pinned[(i + 2) % n] {
                return None;
            }
            let mut at = [0.0; 4];
            for j in 0..3 {
                at[j + 1] = at[j] + unit * step((i + j) % n).max(least);
            }
            let root = (at[3] / 3.0).sqrt();
            let weight = |j: usize| {
                let others = (0..4).filter(|k| *k != j).map(|k| chord(at[j] - at[k]));
                root / others.product::<f64>()
            };
            Some([0, 1, 2, 3].map(weight))
        };
        Penalty { rows: (0..n).map(row).collect() }
    }

    /// The fit with the largest λ that moves no point by more than `most`.
    fn within(&self, points: &[[f64; 2]], pinned: &[bool], most: f64) -> Option<Vec<[f64; 2]>> {
        let n = points.len() as f64;
        let fit = |log: f64| {
            let q = self.fit(points, pinned, (0.5 * log).exp());
            let [far, rms] = moved(points, &q);
            (far <= most && rms.is_finite()).then_some(q)
        };
        let weights = self.rows.iter().flatten().flatten();
        let stiff = weights.fold(0.0, |w: f64, x| w.max(x.abs()));
        // From a fit that hardly moves any point to one that follows nothing but ellipses, to 1e-4.
        let mut low = (1e-3 * most).ln() - 2.0 * stiff.ln();
        let mut high = (6e4 * n).ln().min(2.0 * (STIFFEST / stiff).ln());
        if let Some(all) = fit(high) {
            return Some(all);
        }
        let mut best = None;
        for _ in 0..HALVINGS {
            let log = 0.5 * (low + high);
            match fit(log) {
                Some(q) => (best, low) = (Some(q), log),
                None => high = log,
            }
        }
        best
    }

    /// The fit with a given root of λ.
    fn fit(&self, points: &[[f64; 2]], pinned: &[bool], root: f64) -> Vec<[f64; 2]> {
        let n = points.len();
        let mut system = System::new(n);
        let banded = system.banded();
        // A row travels down to the first that is free. Those that reach round the end go first, while all are.
        for i in banded..n {
            self.add(&mut system, i, points, pinned, root);
        }
        for (i, p) in points.iter().enumerate() {
            if i < banded {
                self.add(&mut system, i, points, pinned, root);
            }
            let mut row = Row { right: *p, ..Row::default() };
            match i.checked_sub(banded) {
                Some(border) => row.border[border] = 1.0,
                None => row.band[0] = 1.0,
            }
            system.add(i, row);
        }
        system.solve()
    }

    /// Adds the row of point `i`.
    fn add(&self, system: &mut System, i: usize, points: &[[f64; 2]], pinned: &[bool], root: f64) {
        let (n, banded) = (points.len(), system.banded());
        let Some(weights) = self.rows[i] else { return };
        let mut row = Row::default();
        let start = if i < banded { i } else { 0 };
        for (j, w) in weights.iter().enumerate() {
            let (k, w) = ((i + j) % n, root * w);
            match k.checked_sub(banded) {
                _ if pinned[k] => [0, 1].iter().for_each(|c| row.right[*c] -= w * points[k][*c]),
                Some(border) => row.border[border] += w,
                None => row.band[k - start] += w,
            }
        }
        system.add(start, row);
    }
}

/// One equation: its unknowns from the first one on, the last three of all, the right-hand sides.
#[derive(Clone, Copy, Default)]
struct Row {
    band: [f64; 4],
    border: [f64; 3],
    right: [f64; 2],
}

impl Row {
    /// Turns both so that the other one's entry, `b`, vanishes beside this one's, `a`.
    fn rotate(&mut self, other: &mut Row, a: f64, b: f64) {
        let long = a.hypot(b);
        let (c, s) = (a / long, b / long);
        let turn = |p: &mut f64, q: &mut f64| (*p, *q) = (c * *p + s * *q, c * *q - s * *p);
        self.band.iter_mut().zip(&mut other.band).for_each(|(p, q)| turn(p, q));
        self.border.iter_mut().zip(&mut other.border).for_each(|(p, q)| turn(p, q));
        self.right.iter_mut().zip(&mut other.right).for_each(|(p, q)| turn(p, q));
    }
}

/// A triangular system that equations are added to: a band, whose last three columns reach all the way up.
struct System {
    rows: Vec<Row>,
}

impl System {
    fn new(n: usize) -> Self {
        System { rows: vec![Row::default(); n] }
    }

    fn banded(&self) -> usize {
        self.rows.len() - 3
    }

    fn add(&mut self, mut at: usize, mut row: Row) {
        while at < self.banded() {
            let [first, rest @ ..] = row.band;
            if first != 0.0 {
                let own = &mut self.rows[at];
                if own.band[0] == 0.0 {
                    *own = row;
                    return;
                }
                let a = own.band[0];
                own.rotate(&mut row, a, first);
            } else if rest == [0.0; 3] {
                break;
            }
            let [_, b, c, d] = row.band;
            row.band = [b, c, d, 0.0];
            at += 1;
        }
        let banded = self.banded();
        for (k, own) in self.rows[banded..].iter_mut().enumerate() {
            let [a, b] = [own.border[k], row.border[k]];
            if b != 0.0 {
                if a == 0.0 {
                    *own = row;
                    return;
                }
                own.rotate(&mut row, a, b);
            }
        }
    }

    fn solve(&self) -> Vec<[f64; 2]> {
        let (n, banded) = (self.rows.len(), self.banded());
        let mut q = vec![[0.0; 2]; n];
        for i in (0..n).rev() {
            let row = &self.rows[i];
            let own = i.checked_sub(banded).map_or(row.band[0], |k| row.border[k]);
            q[i] = [0, 1].map(|c| {
                let band = (1..4).filter(|j| i + j < banded).map(|j| row.band[j] * q[i + j][c]).sum::<f64>();
                let border = (0..3).filter(|k| banded + k > i).map(|k| row.border[k] * q[banded + k][c]).sum::<f64>();
                (row.right[c] - band - border) / own
            });
        }
        q
    }
}
