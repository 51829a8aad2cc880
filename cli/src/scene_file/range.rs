//! Where the quintics between a table's rows go: whether they leave what the rows show.

/// An interpolant may leave the range of the two rows beside it by this part of their difference.
const STRAIGHT: f64 = 0.1;
/// Where the rows turn, and at both ends, it may leave it by this part of the range of four rows: a parabola's rows show at
/// least 8 times what it rises above them.
const TURNING: f64 = 0.2;
/// Excursions below this part of the range of all rows are told to nobody.
const NOTHING: f64 = 1e-6;

/// The piece that leaves the range of its rows farthest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excursion {
    /// Index of the row before it.
    pub row: usize,
    /// By how much.
    pub over: f64,
    /// The value that it reaches.
    pub value: f64,
    /// How many pieces leave their rows' range by more than they may.
    pub pieces: usize,
}

/// Looks at every piece of rows (t, u, u̇, ü) whose times increase. O(rows).
pub fn excursion(rows: &[[f64; 4]]) -> Option<Excursion> {
    let u = |k: usize| rows[k][1];
    let all = span(rows.iter().map(|r| r[1]));
    let mut worst: Option<Excursion> = None;
    for k in 0..rows.len().saturating_sub(1) {
        let [low, high] = span([u(k), u(k + 1)]);
        let before = k.checked_sub(1).map(|j| u(k) - u(j));
        let after = (k + 2 < rows.len()).then(|| u(k + 2) - u(k + 1));
        let here = u(k + 1) - u(k);
        let turning = match (before, after) {
            (Some(b), Some(a)) => b * here < 0.0 || a * here < 0.0 || (here == 0.0 && a * b < 0.0),
            _ => true,
        };
        let allowed = if turning {
            let [low, high] = span((k.saturating_sub(1)..rows.len().min(k + 3)).map(u));
            // Two rows alone show no turn.
            (if rows.len() > 2 { TURNING } else { STRAIGHT }) * (high - low)
        } else {
            STRAIGHT * (high - low)
        };
        let allowed = allowed.max(NOTHING * (all[1] - all[0])).max(64.0 * f64::EPSILON * low.abs().max(high.abs()));
        let (least, most) = reach(&rows[k], &rows[k + 1], low - allowed, high + allowed);
        let (over, value) = if most - high > low - least { (most - high, most) } else { (low - least, least) };
        if over > allowed || over.is_nan() {
            let pieces = worst.map_or(1, |w| w.pieces + 1);
            worst = Some(match worst {
                Some(w) if w.over >= over => Excursion { pieces, ..w },
                _ => Excursion { row: k, over, value, pieces },
            });
        }
    }
    worst
}

/// Least and greatest.
fn span(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
}

/// Least and greatest value of the quintic between two rows: exact unless it certainly stays between `low` and `high`; then
/// those of the rows.
fn reach(a: &[f64; 4], b: &[f64; 4], low: f64, high: f64) -> (f64, f64) {
    let h = b[0] - a[0];
    let [[_, u0, v0, a0], [_, u1, v1, a1]] = [a, b].map(|r| [0.0, r[1], r[2] * h, r[3] * h * h]);
    let ends = (u0.min(u1), u0.max(u1));
    // The quintic lies within the hull of its control values.
    let inner = [u0 + v0 / 5.0, u0 + 0.4 * v0 + a0 / 20.0, u1 - 0.4 * v1 + a1 / 20.0, u1 - v1 / 5.0];
    if inner.iter().all(|c| (low..=high).contains(c)) {
        return ends;
    }
    let (d, e, f) = (u1 - u0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0);
    let c = [u0, v0, 0.5 * a0, 10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f];
    let values = roots(&derivative(&c)).into_iter().map(|x| value(&c, x));
    values.fold(ends, |(low, high), x| (low.min(x), high.max(x)))
}

fn value(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| c + x * sum)
}

fn derivative(c: &[f64]) -> Vec<f64> {
    c.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

/// Where a polynomial changes its sign between 0 and 1: between two extremes it does so once.
fn roots(c: &[f64]) -> Vec<f64> {
    if c.len() < 2 {
        return Vec::new();
    }
    let mut marks = vec![0.0];
    marks.extend(roots(&derivative(c)));
    marks.push(1.0);
    let mut found = Vec::new();
    for pair in marks.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        let rising = value(c, high) > 0.0;
        if (value(c, low) > 0.0) == rising {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (value(c, middle) > 0.0) == rising { high = middle } else { low = middle }
        }
        found.push(0.5 * (low + high));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{excursion, reach};

    #[test]
    fn the_reach_of_a_quintic_is_that_of_many_points_on_it() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            20.0 * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        };
        for _ in 0..500 {
            let (a, b) = ([1.0, random(), random(), random()], [2.5, random(), random(), random()]);
            let (low, high) = reach(&a, &b, 0.0, 0.0);
            // By the sum of both rows' Taylor polynomials under smooth weights, which is the same quintic.
            let points = (0..=20_000).map(|k| {
                let (x, h) = (k as f64 / 20_000.0, 1.5);
                let side = |r: &[f64; 4], x: f64, h: f64| {
                    let (p, q, s) = (r[1], r[2] * h, 0.5 * r[3] * h * h);
                    (1.0 - x).powi(3) * (p * (1.0 + 3.0 * x + 6.0 * x * x) + q * x * (1.0 + 3.0 * x) + s * x * x)
                };
                side(&a, x, h) + side(&b, 1.0 - x, -h)
            });
            let (least, most) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), u| (a.min(u), b.max(u)));
            assert!((least - low).abs() < 1e-5 && (most - high).abs() < 1e-5, "{low} {least} {high} {most}");
            assert!(low <= least + 1e-12 && high >= most - 1e-12);
        }
    }

    #[test]
    fn smooth_rows_that_turn_are_no_excursion_and_a_bump_between_equal_rows_is() {
        // However the rows lie beside the extremes.
        for phase in 0..20 {
            for n in [7, 20, 300] {
                let rows: Vec<[f64; 4]> = (0..=n)
                    .map(|k| 7.0 * f64::from(k) / f64::from(n))
                    .map(|t| (t, (t + 0.1 * f64::from(phase)).sin_cos()))
                    .map(|(t, (s, c))| [t, s, c, -s])
                    .collect();
                assert_eq!(excursion(&rows), None, "{n} {phase}");
            }
        }
        let still = |u: f64, v: f64| [u, v, 0.0];
        let rows = |list: &[[f64; 3]]| -> Vec<[f64; 4]> {
            list.iter().enumerate().map(|(k, r)| [k as f64, r[0], r[1], r[2]]).collect()
        };
        let flat = rows(&[still(0.0, 0.0), still(0.0, 0.0), still(0.0, 0.3), still(1.0, 0.0)]);
        let found = excursion(&flat).unwrap();
        assert!(found.row == 1 && found.pieces == 1 && found.value < -0.03, "{found:?}");
        assert_eq!(excursion(&rows(&[still(0.0, 0.0), still(1.0, 0.0)])), None);
        assert!(excursion(&rows(&[still(0.0, -1.0), still(1.0, 0.0)])).is_some());
    }
}
