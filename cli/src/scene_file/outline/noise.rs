//! How far points scatter across the outline on which they are meant to lie.
//!
//! A divided difference of order m, by the length along the line, falls on a smooth curve as the m-th power of the spacing; of points
//! that scatter independently it does not. With weights whose squares sum to 1 its part across the curve has the points' own standard
//! deviation. Low orders fit straight sides between corners, high ones few points on a round outline; those that agree are believed.

use super::line::extent;

/// Orders of differences.
const ORDERS: [usize; 7] = [2, 3, 4, 6, 8, 10, 12];
/// Fewer points, or differences of one order, tell no scatter from a shape.
const LEAST: usize = 20;
/// Orders agree if they differ by this factor at most: twice the spread of one order at 60 points.
const AGREE: f64 = 1.6;
/// Of the differences, the smaller two thirds count: a corner, or a tip between few points, is in the others.
const KEPT: (usize, usize) = (2, 3);
/// The root of the mean square of the smaller two thirds of the values of a normal distribution of deviation 1.
const TRIMMED: f64 = 0.5243;
/// Lengths between points are those of the curve while the line turns by at most this angle at most of them.
const CLEAR: f64 = 0.5;
/// Differences of one order that are looked at, about: enough to know the scatter to 2 %.
const ENOUGH: usize = 4096;
/// Fewer points bend too much from one to the next to tell bends from scatter.
const MANY: usize = 48;
/// Part of the added mass from which on scatter matters: below, it is no error that any bound shows.
const MATTERS: f64 = 1e-5;

/// The scatter of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// The standard deviation across the outline, in the unit of the points. Of a smooth outline through few points it is what
    /// differences leave of its bends.
    pub sigma: f64,
    /// It cannot be bends, and changes the added mass.
    pub matters: bool,
}

impl Noise {
    /// A distance within which a smooth curve fits `n` points: the largest of so many, on average.
    pub fn distance(&self, n: usize) -> f64 {
        self.sigma * (2.0 * (n as f64).ln()).sqrt()
    }
}

/// Estimates the scatter; nothing where the points are too few. O(points).
pub fn noise(points: &[[f64; 2]], corners: &[usize]) -> Option<Noise> {
    let n = points.len();
    // Corners before a point, to see at once whether one is within a stencil.
    let mut before = vec![0; n + 1];
    corners.iter().filter(|k| **k < n).for_each(|k| before[k + 1] = 1);
    (0..n).for_each(|k| before[k + 1] += before[k]);
    let size = extent(points).into_iter().fold(0.0, f64::max);
    let mut found = None;
    let mut stride = 1;
    while n / stride >= LEAST {
        let lengths: Vec<f64> = (0..n).map(|i| gap(points[i], points[(i + stride) % n])).collect();
        let turn = |i: usize| {
            let [a, b, c] = [0, 1, 2].map(|j| points[(i + j * stride) % n]);
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            (u[0] * v[1] - u[1] * v[0]).abs().atan2(u[0] * v[0] + u[1] * v[1])
        };
        let over = |order: &usize| across(points, &lengths, &before, stride, *order);
        let all: Vec<f64> = ORDERS.iter().map_while(over).collect();
        let Some(least) = all.iter().copied().reduce(f64::min) else { break };
        // The lowest of those that agree: its values depend least on one another.
        let order = all.iter().position(|s| *s <= AGREE * least)?;
        let sigma = all[order];
        // Scatter adds to the fluid's inertia, by mode k of n/2 that it excites alike, k σ²: n σ²/2 on a circle of radius 1.
        let part = 3.0 * sigma * sigma / (middle(lengths) / stride as f64 * size);
        // Where second or third differences agree with higher ones, they are not the curve's own bends.
        let seen = found.is_some_and(|before: Noise| before.matters);
        let matters = seen || (n / stride >= MANY && order < 2 && part > MATTERS);
        found = Some(Noise { sigma, matters });
        if middle((0..n).map(turn).collect()) <= CLEAR {
            break;
        }
        // Points so dense that they scatter along the line too: look at every second, third, … of them.
        stride += 1 + stride / 2;
    }
    found.filter(|noise| noise.sigma.is_finite())
}

fn gap(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The median of some values.
fn middle(mut of: Vec<f64>) -> f64 {
    let half = of.len() / 2;
    *of.select_nth_unstable_by(half, f64::total_cmp).1
}

/// The scatter by differences of one order of every `stride`-th point.
fn across(points: &[[f64; 2]], lengths: &[f64], before: &[usize], stride: usize, order: usize) -> Option<f64> {
    let n = points.len();
    let span = order * stride;
    if 2 * span >= n {
        return None;
    }
    // Corners up to a point, which may be past the end.
    let upto = |k: usize| before[k % n] + if k >= n { before[n] } else { 0 };
    let (mut at, mut weights) = (vec![0.0; order + 1], vec![0.0; order + 1]);
    let mut all = Vec::with_capacity(n);
    for i in (0..n).step_by(n.div_ceil(ENOUGH)).filter(|i| upto(i + span) == upto(i + 1)) {
        let point = |j: usize| points[(i + j * stride) % n];
        for j in 0..order {
            at[j + 1] = at[j] + lengths[(i + j * stride) % n];
        }
        // In parts of the mean length, so that no product overflows.
        let unit = at[order] / order as f64;
        for j in 0..=order {
            let others = (0..=order).filter(|k| *k != j);
            weights[j] = others.map(|k| (at[j] - at[k]) / unit).product::<f64>().recip();
        }
        let size = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let (a, b) = (point((order - 1) / 2), point(order / 2 + 1));
        let along = gap(a, b);
        let normal = [(a[1] - b[1]) / along, (b[0] - a[0]) / along];
        let [x, y] = point(0);
        let part = |j: usize| (point(j)[0] - x) * normal[0] + (point(j)[1] - y) * normal[1];
        let difference = (0..=order).map(|j| weights[j] / size * part(j)).sum::<f64>().abs();
        // Repeated points have no difference.
        all.extend(Some(difference).filter(|d| d.is_finite()));
    }
    if all.len() < LEAST {
        return None;
    }
    let kept = all.len() * KEPT.0 / KEPT.1;
    all.select_nth_unstable_by(kept, f64::total_cmp);
    let square = all[..kept].iter().map(|d| d * d).sum::<f64>() / kept as f64;
    Some(square.sqrt() / TRIMMED)
}
