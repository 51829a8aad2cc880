//! Rates and accelerations at the rows of a table that gives values alone.
//!
//! A piece of the table is the quintic with u, u̇ and ü of both its rows. In Bézier form, on a piece of length h that rises
//! by d h, the rate has the control values v₀, v₀ + a₀h/4, 5d − 2v₀ − a₀h/4 − 2v₁ + a₁h/4, v₁ − a₁h/4, v₁: while none of them
//! is negative it rises. The rows share the middle one, 5d, by what they would like to have; then each is limited by itself.

/// Rows of the polynomial that estimates a row's rate and acceleration.
const STENCIL: usize = 5;

/// (u̇, ü) at every row, such that the quintics between the rows are monotone: u̇ = 0 where the rows turn or stand still.
/// Elsewhere, in smooth rows, that of the polynomial through five rows: errors of order 4 and 3 in the spacing, except next to
/// an extreme of the rows. O(rows).
pub fn monotone(t: &[f64], u: &[f64]) -> Vec<[f64; 2]> {
    let wishes: Vec<Wish> = (0..t.len()).map(|k| wish(t, u, k)).collect();
    let limited = |k: usize| {
        let (own, left, right) = (&wishes[k], left(t, u, k), right(t, u, k));
        if own.turns || t.len() < 2 {
            return [own.v, own.a];
        }
        let (sign, mut v) = (own.sign, own.v);
        // What this row may use of the piece on either side, and with it the bounds of v and of a.
        let l = left.map(|(h, d)| (h, wishes[k - 1].leaves(own, h, d * sign, -1.0)));
        let r = right.map(|(h, d)| (h, wishes[k + 1].leaves(own, h, d * sign, 1.0)));
        for (_, share) in l.iter().chain(&r) {
            v = v.min(*share);
        }
        if let (Some((hl, sl)), Some((hr, sr))) = (l, r) {
            v = v.min(0.5 * (sl * hr + sr * hl) / (hl + hr));
        }
        let low = r.map_or(f64::NEG_INFINITY, |(h, _)| -4.0 * v / h);
        let low = l.map_or(low, |(h, share)| low.max(-4.0 * (share - 2.0 * v) / h));
        let high = l.map_or(f64::INFINITY, |(h, _)| 4.0 * v / h);
        let high = r.map_or(high, |(h, share)| high.min(4.0 * (share - 2.0 * v) / h));
        // `low` can exceed `high` by rounding only.
        [sign * v, sign * own.a.min(high).max(low.min(high))]
    };
    (0..t.len()).map(limited).collect()
}

/// What the rows themselves say of a rate and acceleration, with the sign of the direction in which the rows go.
struct Wish {
    v: f64,
    a: f64,
    sign: f64,
    /// The rows turn here, or stand still before or after: this is final.
    turns: bool,
}

impl Wish {
    /// Part of a piece's 5 d that this row would use; `side` is 1 at the right end of the piece, −1 at the left.
    fn uses(&self, h: f64, side: f64) -> f64 {
        if self.turns { 0.25 * h * self.a.abs() } else { (2.0 * self.v - side * 0.25 * h * self.a).max(0.0) }
    }

    /// What this row leaves to `other`, which lies before it (`side` 1) or after it (−1).
    fn leaves(&self, other: &Wish, h: f64, d: f64, side: f64) -> f64 {
        let (own, others, half) = (self.uses(h, side), other.uses(h, -side), 2.5 * d);
        if self.turns || (own <= half && others > half) {
            5.0 * d - if self.turns { own } else { own.max(5.0 * d - others) }
        } else if own > half && others <= half {
            others.max(5.0 * d - own)
        } else {
            half
        }
    }
}

/// Length and slope of the piece before a row.
fn left(t: &[f64], u: &[f64], k: usize) -> Option<(f64, f64)> {
    k.checked_sub(1).and_then(|k| right(t, u, k))
}

/// Length and slope of the piece after a row.
fn right(t: &[f64], u: &[f64], k: usize) -> Option<(f64, f64)> {
    let h = t.get(k + 1)? - t[k];
    Some((h, (u[k + 1] - u[k]) / h))
}

fn wish(t: &[f64], u: &[f64], k: usize) -> Wish {
    let ([v, a], sides) = (estimate(t, u, k), (left(t, u, k), right(t, u, k)));
    let still = Wish { v: 0.0, a: 0.0, sign: 1.0, turns: true };
    let (hl, dl, hr, dr) = match sides {
        (Some((hl, dl)), Some((hr, dr))) => (hl, dl, hr, dr),
        (Some((_, d)), None) | (None, Some((_, d))) if d != 0.0 => {
            let sign = d.signum();
            return Wish { v: (sign * v).clamp(0.0, 2.5 * d.abs()), a: sign * a, sign, turns: false };
        }
        _ => return still,
    };
    let second = 2.0 * (dr - dl) / (hl + hr);
    if dl * dr > 0.0 {
        let sign = dl.signum();
        if (0.0..=2.5 * dl.abs().min(dr.abs())).contains(&(sign * v)) {
            return Wish { v: sign * v, a: sign * a, sign, turns: false };
        }
        // Too uneven for five rows: the parabola through three.
        return Wish { v: sign * (hr * dl + hl * dr) / (hl + hr), a: sign * second, sign, turns: false };
    }
    if dl == 0.0 || dr == 0.0 {
        return still;
    }
    // More than half of a piece's 5 d is left to the row on its other side.
    let most = (10.0 * dl.abs() / hl).min(10.0 * dr.abs() / hr);
    let a = if a * second > 0.0 { a } else { second };
    Wish { a: a.clamp(-most, most), ..still }
}

/// (u̇, ü) at row `k` of the polynomial through the rows nearest to it, by Newton's divided differences from that row on.
pub fn estimate(t: &[f64], u: &[f64], k: usize) -> [f64; 2] {
    let n = t.len().min(STENCIL);
    let first = k.saturating_sub(STENCIL / 2).min(t.len() - n);
    let mut x = [0.0; STENCIL];
    let mut c = [0.0; STENCIL];
    let others = (first..first + n).filter(|i| *i != k);
    for (slot, i) in std::iter::once(k).chain(others).enumerate() {
        (x[slot], c[slot]) = (t[i] - t[k], u[i] - u[k]);
    }
    for order in 1..n {
        for i in (order..n).rev() {
            c[i] = (c[i] - c[i - 1]) / (x[i] - x[i - order]);
        }
    }
    // Σ c_j Π_{0<i<j} (x − x_i) and its derivative at x = 0, by Horner's scheme.
    let (mut value, mut slope) = (0.0, 0.0);
    for j in (1..n).rev() {
        slope = value - x[j] * slope;
        value = c[j] - x[j] * value;
    }
    [value, 2.0 * slope]
}

/// Slopes at the knots of the not-a-knot cubic spline; of the parabola or line if there are 3 or 2 points.
pub fn spline(t: &[f64], u: &[f64]) -> Vec<f64> {
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
    use super::{monotone, spline};

    /// u and u̇ of the quintic between two rows (t, u, u̇, ü), by its Hermite basis.
    fn quintic(a: &[f64; 4], b: &[f64; 4], t: f64) -> [f64; 2] {
        let h = b[0] - a[0];
        let x = (t - a[0]) / h;
        let (y, w) = (1.0 - x, x * x * (1.0 - x) * (1.0 - x));
        let basis = |x: f64, y: f64| {
            let value =
                [y.powi(3) * (1.0 + 3.0 * x + 6.0 * x * x), x * y.powi(3) * (1.0 + 3.0 * x), 0.5 * x * x * y.powi(3)];
            let slope = [-30.0 * w, y * y * (1.0 + 2.0 * x - 15.0 * x * x), 0.5 * x * y * y * (2.0 - 5.0 * x)];
            (value, slope)
        };
        let ((p, dp), (q, dq)) = (basis(x, y), basis(y, x));
        let (left, right) = ([a[1], a[2] * h, a[3] * h * h], [b[1], -b[2] * h, b[3] * h * h]);
        let sum = |c: [f64; 3], r: [f64; 3]| c[0] * r[0] + c[1] * r[1] + c[2] * r[2];
        [sum(p, left) + sum(q, right), (sum(dp, left) - sum(dq, right)) / h]
    }

    fn table(t: &[f64], u: &[f64], rates: &[[f64; 2]]) -> Vec<[f64; 4]> {
        t.iter().zip(u).zip(rates).map(|((t, u), r)| [*t, *u, r[0], r[1]]).collect()
    }

    /// Uniform in (0, 1).
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[test]
    fn between_two_rows_the_value_goes_one_way_whatever_the_rows() {
        let mut seed = 1;
        for round in 0..2000 {
            let n = 2 + (random(&mut seed) * 12.0) as usize;
            let (mut t, mut u) = (vec![0.0], vec![0.0]);
            for k in 1..n {
                t.push(t[k - 1] + 10_f64.powf(4.0 * random(&mut seed) - 3.0));
                let step = 10_f64.powf(4.0 * random(&mut seed) - 3.0);
                let kind = if round % 3 == 0 { 0.0 } else { random(&mut seed) };
                u.push(
                    u[k - 1]
                        + if kind < 0.6 {
                            step
                        } else if kind < 0.85 {
                            -step
                        } else {
                            0.0
                        },
                );
            }
            let rows = table(&t, &u, &monotone(&t, &u));
            for pair in rows.windows(2) {
                let d = pair[1][1] - pair[0][1];
                let size = d.abs() / (pair[1][0] - pair[0][0]);
                for k in 0..=64 {
                    let at = pair[0][0] + (pair[1][0] - pair[0][0]) * k as f64 / 64.0;
                    let [value, slope] = quintic(&pair[0], &pair[1], at);
                    assert!(slope * d.signum() >= -1e-9 * size, "{rows:?}: {slope} at {at}");
                    let (low, high) = (pair[0][1].min(pair[1][1]), pair[0][1].max(pair[1][1]));
                    let slack = 1e-12 * (low.abs() + high.abs());
                    assert!((low - slack..=high + slack).contains(&value), "{rows:?}: {value} at {at}");
                }
            }
        }
    }

    #[test]
    fn where_rows_turn_or_stand_still_the_rate_is_zero() {
        let (t, u) = ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0, 1.0, 1.0, 4.0, 2.0, 3.0, 9.0]);
        let rates = monotone(&t, &u);
        for k in [1, 2, 3, 4] {
            assert_eq!(rates[k][0], 0.0, "row {k}");
        }
        assert!(rates[3][1] < 0.0 && rates[4][1] > 0.0 && rates[1][1] == 0.0, "{rates:?}");
        assert!(rates[0][0] > 0.0 && rates[5][0] > 0.0 && rates[6][0] > 0.0, "{rates:?}");
    }

    /// Largest errors of u̇ and ü at rows, and of u̇ between them, of a function on uneven rows, where `look` says so.
    fn errors(n: usize, f: impl Fn(f64) -> [f64; 3], look: impl Fn(f64) -> bool) -> [f64; 3] {
        let t: Vec<f64> = (0..=n).map(|k| k as f64 / n as f64).map(|x| 3.0 * (x + 0.05 * (9.0 * x).sin())).collect();
        let u: Vec<f64> = t.iter().map(|t| f(*t)[0]).collect();
        let rows = table(&t, &u, &monotone(&t, &u));
        let mut worst = [0.0_f64; 3];
        for pair in rows.windows(2).filter(|p| look(p[0][0]) && look(p[1][0])) {
            let [_, v, a] = f(pair[0][0]);
            let at = 0.7 * pair[0][0] + 0.3 * pair[1][0];
            let here = [pair[0][2] - v, pair[0][3] - a, quintic(&pair[0], &pair[1], at)[1] - f(at)[1]];
            worst.iter_mut().zip(here).for_each(|(w, e)| *w = w.max(e.abs()));
        }
        worst
    }

    #[test]
    fn rates_of_smooth_rows_have_order_4_and_accelerations_order_3_ends_included() {
        let f = |t: f64| [t.exp() + t, t.exp() + 1.0, t.exp()];
        let (coarse, fine) = (errors(100, f, |_| true), errors(200, f, |_| true));
        let order: Vec<f64> = coarse.iter().zip(fine).map(|(c, f)| (c / f).log2()).collect();
        assert!(order[0] > 3.7 && order[1] > 2.7 && order[2] > 3.7, "{order:?}");
    }

    #[test]
    fn away_from_extremes_the_orders_are_the_same_and_next_to_them_the_rate_has_order_1() {
        // Extremes at 0.375 π and 0.875 π; two rows beside each are spoilt at most.
        let f = |t: f64| [(2.0 * t - 0.8).sin(), 2.0 * (2.0 * t - 0.8).cos(), -4.0 * (2.0 * t - 0.8).sin()];
        let far = |n: usize| move |t: f64| (2.0 * t - 0.8).cos().abs() > 2.0 * 3.0 * 3.0 * 1.5 / n as f64;
        let (coarse, fine) = (errors(200, f, far(200)), errors(400, f, far(400)));
        let order: Vec<f64> = coarse.iter().zip(fine).map(|(c, f)| (c / f).log2()).collect();
        assert!(order[0] > 3.5 && order[1] > 2.5 && order[2] > 3.5, "{order:?}");
        let (coarse, fine) = (errors(200, f, |_| true), errors(400, f, |_| true));
        assert!(coarse[0] < 4.0 * 3.0 * 1.5 / 200.0 && fine[0] < 4.0 * 3.0 * 1.5 / 400.0, "{coarse:?} {fine:?}");
    }

    #[test]
    fn a_parabola_with_its_top_at_a_row_and_a_line_are_met_exactly() {
        let t = [0.0, 0.5, 1.1, 2.0, 2.4, 3.0, 4.0];
        let parabola: Vec<f64> = t.iter().map(|t| 1.0 - (t - 2.0) * (t - 2.0)).collect();
        for (t, [v, a]) in t.iter().zip(monotone(&t, &parabola)) {
            assert!((v + 2.0 * (t - 2.0)).abs() < 1e-12 && (a + 2.0).abs() < 1e-11, "{t}: {v} {a}");
        }
        let line: Vec<f64> = t.iter().map(|t| 3.0 * t - 1.0).collect();
        assert!(monotone(&t, &line).iter().all(|[v, a]| (v - 3.0).abs() < 1e-13 && a.abs() < 1e-11));
        assert_eq!(monotone(&[1.0], &[5.0]), [[0.0, 0.0]]);
        assert_eq!(monotone(&[1.0, 3.0], &[5.0, 1.0]), [[-2.0, 0.0], [-2.0, 0.0]]);
    }

    #[test]
    fn slopes_are_exact_for_a_cubic_on_uneven_knots() {
        let t = [0.0, 0.3, 1.0, 1.1, 2.0, 3.5];
        let u: Vec<f64> = t.iter().map(|t| 1.0 - 2.0 * t + 0.5 * t * t - 0.25 * t * t * t).collect();
        for (t, s) in t.iter().zip(spline(&t, &u)) {
            assert!((s - (-2.0 + t - 0.75 * t * t)).abs() < 1e-13);
        }
        let parabola = spline(&[0.0, 1.0, 3.0], &[0.0, 1.0, 9.0]);
        assert!(parabola.iter().zip([0.0, 2.0, 6.0]).all(|(a, b)| (a - b).abs() < 1e-14));
        assert_eq!(spline(&[0.0, 2.0], &[1.0, 5.0]), [2.0, 2.0]);
        assert_eq!(spline(&[1.0], &[5.0]), [0.0]);
    }

    #[test]
    fn slopes_converge_up_to_the_ends() {
        let worst = |n: usize| {
            let t: Vec<f64> = (0..=n).map(|k| 3.0 * k as f64 / n as f64).collect();
            let u: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            t.iter().zip(spline(&t, &u)).map(|(t, s)| (s - t.cos()).abs()).fold(0.0, f64::max)
        };
        assert!(worst(20) / worst(40) > 7.0);
    }
}
