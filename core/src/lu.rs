//! LU factorization with partial pivoting over the caller's memory, and the solves that follow.
//!
//! Column-major storage with leading dimension `ld`. Right-hand sides appended behind the matrix ride along with the
//! elimination. Cost: 2n³/3 for [`factor`], 2n² for each solve. With the feature `faer` large matrices are factorized
//! by faer.

use crate::scalar::Real;
use crate::status::{Result, Status};
use crate::workspace::{at, inner, part, part_mut, put};

/// Columns eliminated together; the update of one column by a panel is one fused loop.
const PANEL: usize = 8;

/// A factorized matrix: unit lower and upper triangle in place, and the row exchanged at each step.
pub struct Factors<'a, R> {
    /// The triangles, column-major.
    pub lu: &'a [R],
    /// Leading dimension.
    pub ld: usize,
    /// Pivot row of each column (row numbers kept as reals).
    pub pivots: &'a [R],
}

/// Factorizes the first `n` columns of `a` in place and carries the further columns (right-hand sides) along:
/// they come out as L⁻¹P b, ready for [`Factors::back_substitute`].
///
/// Returns the smallest pivot relative to the largest entry met in a pivot column.
///
/// # Errors
/// `Singular` when a pivot column vanishes to rounding or holds a value that is not finite.
pub fn factor<R: Real>(a: &mut [R], ld: usize, n: usize, pivots: &mut [R]) -> Result<R> {
    if let Some(ratio) = R::factor_large(a, ld, n, pivots) {
        return ratio;
    }
    let mut smallest = R::MAX;
    let mut largest = R::zero();
    let mut k = 0;
    while k < n {
        let width = PANEL.min(n - k);
        let Some((head, tail)) = a.split_at_mut_checked((k + width) * ld) else {
            return Err(Status::Internal.into());
        };
        let (left, panel) = head.split_at_mut_checked(k * ld).ok_or(Status::Internal)?;
        let (low, high) = factor_panel(panel, ld, n, k, width, pivots)?;
        for column in left.chunks_exact_mut(ld.max(1)) {
            exchange_all(column, k, part(pivots, k, width));
        }
        smallest = smallest.min(low);
        largest = largest.max(high);
        let panel = &*panel;
        let swaps = part(pivots, k, width);
        let mut pairs = tail.chunks_exact_mut(ld.saturating_mul(2).max(1));
        for pair in pairs.by_ref() {
            let (first, second) = pair.split_at_mut_checked(ld).unwrap_or((&mut [], &mut []));
            let x = eliminate_panel(panel, ld, k, width, swaps, first);
            let y = eliminate_panel(panel, ld, k, width, swaps, second);
            update_two(panel, ld, n, k + width, width, &x, &y, first, second);
        }
        for column in pairs.into_remainder().chunks_exact_mut(ld.max(1)) {
            let x = eliminate_panel(panel, ld, k, width, swaps, column);
            subtract_columns(panel, ld, k + width, n, width, &x, column);
        }
        k += width;
    }
    check_pivots(n, smallest, largest)
}

/// Ratio of the extreme pivots; refuses a matrix that is singular to rounding.
pub(crate) fn check_pivots<R: Real>(n: usize, smallest: R, largest: R) -> Result<R> {
    let ratio = smallest / largest;
    if n > 0 && (ratio <= R::EPSILON * R::HALF || !ratio.is_finite()) {
        return Err(Status::Singular.into());
    }
    Ok(ratio)
}

/// Left-looking elimination of `width` columns from row `k` on. Returns smallest and largest pivot size.
fn factor_panel<R: Real>(
    panel: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    width: usize,
    pivots: &mut [R],
) -> Result<(R, R)> {
    let (mut smallest, mut largest) = (R::MAX, R::zero());
    for c in 0..width {
        let Some((done, rest)) = panel.split_at_mut_checked(c * ld) else {
            return Err(Status::Internal.into());
        };
        let column = part_mut(rest, 0, ld);
        for (p, left) in done.chunks_exact(ld.max(1)).enumerate() {
            let x = at(column, k + p);
            let below = part(left, k + p + 1, n - k - p - 1);
            for (y, l) in part_mut(column, k + p + 1, n - k - p - 1).iter_mut().zip(below) {
                *y -= x * *l;
            }
        }
        let (mut row, mut size) = (k + c, R::zero());
        for (i, x) in part(column, k + c, n - k - c).iter().enumerate() {
            let m = x.abs();
            if m > size {
                (row, size) = (k + c + i, m);
            }
        }
        if size == R::zero() || !size.is_finite() {
            return Err(Status::Singular.into());
        }
        (smallest, largest) = (smallest.min(size), largest.max(size));
        put(pivots, k + c, R::count(row));
        for column in panel.chunks_exact_mut(ld.max(1)) {
            exchange(column, k + c, row);
        }
        let column = part_mut(panel, c * ld, ld);
        let inverse = R::one() / at(column, k + c);
        for x in part_mut(column, k + c + 1, n - k - c - 1) {
            *x *= inverse;
        }
    }
    Ok((smallest, largest))
}

#[inline]
fn exchange<R: Real>(column: &mut [R], i: usize, j: usize) {
    if i != j {
        let (x, y) = (at(column, i), at(column, j));
        put(column, i, y);
        put(column, j, x);
    }
}

/// Applies the exchanges of steps `k`, `k + 1`, … in order.
#[inline]
fn exchange_all<R: Real>(column: &mut [R], k: usize, swaps: &[R]) {
    for (p, row) in swaps.iter().enumerate() {
        exchange(column, k + p, row_of(*row));
    }
}

#[inline]
fn row_of<R: Real>(pivot: R) -> usize {
    pivot.to_f64() as usize
}

/// Applies a panel's exchanges to one column and solves with the panel's unit triangle; returns the multipliers.
#[inline]
fn eliminate_panel<R: Real>(
    panel: &[R],
    ld: usize,
    k: usize,
    width: usize,
    swaps: &[R],
    column: &mut [R],
) -> [R; PANEL] {
    exchange_all(column, k, swaps);
    let mut x = [R::zero(); PANEL];
    for (p, (xp, l)) in x.iter_mut().zip(panel.chunks_exact(ld.max(1))).enumerate().take(width) {
        *xp = at(column, k + p);
        let n = width - p - 1;
        for (y, l) in part_mut(column, k + p + 1, n).iter_mut().zip(part(l, k + p + 1, n)) {
            *y -= *xp * *l;
        }
    }
    x
}

/// The eight columns of a panel, rows `from .. to`; missing ones are empty.
#[inline]
fn eight<R>(panel: &[R], ld: usize, from: usize, to: usize) -> [&[R]; PANEL] {
    let mut columns: [&[R]; PANEL] = [&[]; PANEL];
    for (c, l) in columns.iter_mut().zip(panel.chunks_exact(ld.max(1))) {
        *c = part(l, from, to - from);
    }
    columns
}

/// `column[from..to] -= panel[from..to] x`.
#[inline]
fn subtract_columns<R: Real>(
    panel: &[R],
    ld: usize,
    from: usize,
    to: usize,
    width: usize,
    x: &[R; PANEL],
    column: &mut [R],
) {
    let target = part_mut(column, from, to - from);
    let l = eight(panel, ld, from, to);
    if width < PANEL {
        for (l, x) in l.iter().zip(x).take(width) {
            for (y, l) in target.iter_mut().zip(*l) {
                *y -= *x * *l;
            }
        }
        return;
    }
    let pairs = target.iter_mut().zip(l[0]).zip(l[1]).zip(l[2]).zip(l[3]).zip(l[4]).zip(l[5]).zip(l[6]).zip(l[7]);
    for ((((((((y, a), b), c), d), e), f), g), h) in pairs {
        *y -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]) + ((*e * x[4] + *f * x[5]) + (*g * x[6] + *h * x[7]));
    }
}

/// The same for two columns at once: each entry of the panel is read once.
#[inline]
fn update_two<R: Real>(
    panel: &[R],
    ld: usize,
    n: usize,
    from: usize,
    width: usize,
    x: &[R; PANEL],
    y: &[R; PANEL],
    first: &mut [R],
    second: &mut [R],
) {
    if width < PANEL {
        subtract_columns(panel, ld, from, n, width, x, first);
        subtract_columns(panel, ld, from, n, width, y, second);
        return;
    }
    let l = eight(panel, ld, from, n);
    let targets = part_mut(first, from, n - from).iter_mut().zip(part_mut(second, from, n - from));
    let rows = targets.zip(l[0]).zip(l[1]).zip(l[2]).zip(l[3]).zip(l[4]).zip(l[5]).zip(l[6]).zip(l[7]);
    for (((((((((u, v), a), b), c), d), e), f), g), h) in rows {
        *u -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]) + ((*e * x[4] + *f * x[5]) + (*g * x[6] + *h * x[7]));
        *v -= (*a * y[0] + *b * y[1]) + (*c * y[2] + *d * y[3]) + ((*e * y[4] + *f * y[5]) + (*g * y[6] + *h * y[7]));
    }
}

impl<R: Real> Factors<'_, R> {
    fn order(&self) -> usize {
        self.pivots.len()
    }
    fn panel(&self, k: usize, width: usize) -> &[R] {
        part(self.lu, k * self.ld, width * self.ld)
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [R]) {
        self.forward(b);
        self.back_substitute(b);
    }

    /// b ← L⁻¹ P b: what happens to right-hand sides that ride along.
    pub(crate) fn forward(&self, b: &mut [R]) {
        let n = self.order();
        exchange_all(b, 0, self.pivots);
        let mut k = 0;
        while k < n {
            let width = PANEL.min(n - k);
            let panel = self.panel(k, width);
            let x = eliminate_panel(panel, self.ld, k, width, &[], b);
            subtract_columns(panel, self.ld, k + width, n, width, &x, b);
            k += width;
        }
    }

    /// Solves U x = b in place.
    pub fn back_substitute(&self, b: &mut [R]) {
        let n = self.order();
        let mut k = n.div_ceil(PANEL) * PANEL;
        while k > 0 {
            k -= PANEL;
            let width = PANEL.min(n - k);
            let panel = self.panel(k, width);
            let mut x = [R::zero(); PANEL];
            for p in (0..width).rev() {
                let u = part(panel, p * self.ld, self.ld);
                let value = at(b, k + p) / at(u, k + p);
                put(b, k + p, value);
                if let Some(x) = x.get_mut(p) {
                    *x = value;
                }
                for (y, u) in part_mut(b, k, p).iter_mut().zip(part(u, k, p)) {
                    *y -= value * *u;
                }
            }
            subtract_columns(panel, self.ld, 0, k, width, &x, b);
        }
    }

    /// Solves Aᵀ x = b in place.
    pub fn solve_transposed(&self, b: &mut [R]) {
        let n = self.order();
        for (c, u) in self.lu.chunks_exact(self.ld.max(1)).enumerate().take(n) {
            let value = (at(b, c) - inner(part(u, 0, c), part(b, 0, c))) / at(u, c);
            put(b, c, value);
        }
        for c in (0..n).rev() {
            let (l, below) = (part(self.lu, c * self.ld, n), n - c - 1);
            let value = at(b, c) - inner(part(l, c + 1, below), part(b, c + 1, below));
            put(b, c, value);
        }
        for (c, row) in self.pivots.iter().enumerate().rev() {
            exchange(b, c, row_of(*row));
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    fn random(n: usize, seed: u64) -> Vec<f64> {
        let mut s = seed;
        (0..n)
            .map(|_| {
                s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (s >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            })
            .collect()
    }

    fn largest_residual<R: Real>(n: usize, tolerance: f64) {
        let ld = n + 3;
        let entries = random(n * ld, 7 + n as u64);
        let a: Vec<R> = entries.iter().map(|x| R::lit(*x)).collect();
        let x: Vec<R> = random(n, 3).iter().map(|x| R::lit(*x)).collect();
        let times = |transposed: bool| -> Vec<R> {
            (0..n)
                .map(|i| {
                    (0..n).fold(R::zero(), |s, j| {
                        let entry = if transposed { a[i * ld + j] } else { a[j * ld + i] };
                        s + entry * x[j]
                    })
                })
                .collect()
        };
        let (b, bt) = (times(false), times(true));
        let mut lu = a.clone();
        lu.extend(&b);
        lu.extend([R::zero(); 3]);
        let mut pivots = std::vec![R::zero(); n];
        factor(&mut lu, ld, n, &mut pivots).unwrap();
        let (matrix, carried) = lu.split_at(n * ld);
        let factors = Factors { lu: matrix, ld, pivots: &pivots };
        let mut solutions = [carried[..n].to_vec(), b, bt];
        factors.back_substitute(&mut solutions[0]);
        factors.solve(&mut solutions[1]);
        factors.solve_transposed(&mut solutions[2]);
        for s in solutions {
            for (s, x) in s.iter().zip(&x) {
                assert!((*s - *x).to_f64().abs() < tolerance, "n = {n}: {s} against {x}");
            }
        }
    }

    #[test]
    fn every_solve_gives_the_solution_back() {
        for n in [0, 1, 2, 7, 8, 9, 16, 17, 33, 100] {
            largest_residual::<f64>(n, 1e-10);
        }
        largest_residual::<f32>(33, 2e-3);
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut a = [1.0, 2.0, 2.0, 4.0];
        assert_eq!(factor(&mut a, 2, 2, &mut [0.0; 2]).unwrap_err().status, Status::Singular);
        let mut a = [1.0, f64::NAN, 2.0, 4.0];
        assert!(factor(&mut a, 2, 2, &mut [0.0; 2]).is_err());
    }
}
