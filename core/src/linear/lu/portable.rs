//! The factorization for any machine: one register tile in plain Rust, which compilers turn into vectors where there are some,
//! and which stays small on a microcontroller.
//!
//! Tested by the test at its end, `linear/lu/tests.rs`.

use super::kernel::Kernel;
use super::rows::{Rows, exchange};
use crate::base::index::Index;
use crate::base::machine::Portable;
use crate::base::memory::{at, inner, part, part_mut, put};
use crate::base::scalar::Real;

/// Columns that are eliminated without recursion.
const SMALL: usize = 64;

/// Rows of a tile.
const ROWS: usize = 4;

impl<R: Real> Kernel<R> for Portable {
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
        by_strips(left, ld, rows, Kind::Product, right);
    }

    fn eliminate_block(
        self,
        block: &mut [R],
        ld: usize,
        n: usize,
        k: usize,
        pivots: &mut [R::Index],
    ) -> Option<(R, R)> {
        let (mut smallest, mut largest) = (R::MAX, R::zero());
        for (c, pivot) in pivots.iter_mut().enumerate() {
            let (done, rest) = block.split_at_mut_checked(c * ld)?;
            let first = c - c % ROWS;
            if c == first {
                // The columns done before act upon a whole strip at once, those of the strip itself one by one.
                let strip = part_mut(rest, 0, (ROWS * ld).min(rest.len()));
                self.solve_lower(done, ld, k, strip);
                self.subtract(done, ld, Rows { to: k + c, count: n - k - c, from: k }, strip);
            }
            let below = part_mut(rest, 0, n);
            for (p, left) in done.chunks_exact(ld.max(1)).enumerate().skip(first) {
                let x = at(below, k + p);
                subtract_column(part_mut(below, k + p + 1, n - k - p - 1), x, part(left, k + p + 1, n - k - p - 1));
            }
            let below = part(below, k + c, n - k - c);
            let size = largest_of(below);
            let row = k + c + below.iter().position(|x| x.abs() == size).unwrap_or(0);
            if size == R::zero() || !size.is_finite() {
                return None;
            }
            (smallest, largest) = (smallest.min(size), largest.max(size));
            *pivot = R::Index::of(row);
            if row != k + c {
                for column in block.chunks_exact_mut(ld.max(1)) {
                    exchange(column, k + c, row);
                }
            }
            let column = part_mut(block, c * ld, n);
            let inverse = R::one() / at(column, k + c);
            scale_column(part_mut(column, k + c + 1, n - k - c - 1), inverse);
        }
        Some((smallest, largest))
    }

    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        by_strips(left, ld, triangle(left, ld, k), Kind::Lower, right);
    }

    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        by_strips(left, ld, triangle(left, ld, k), Kind::Upper, right);
    }

    fn block(self) -> usize {
        SMALL
    }

    fn solve_transposed(self, lu: &[R], ld: usize, n: usize, b: &mut [R]) {
        for c in 0..n {
            let u = part(lu, c * ld, n);
            let value = (at(b, c) - inner(part(u, 0, c), part(b, 0, c))) / at(u, c);
            put(b, c, value);
        }
        for c in (0..n).rev() {
            let (l, below) = (part(lu, c * ld, n), n - c - 1);
            let value = at(b, c) - inner(part(l, c + 1, below), part(b, c + 1, below));
            put(b, c, value);
        }
    }
}

/// What happens to rows of columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// C ← C − A B.
    Product,
    /// Solution with a unit lower triangle: the product with what is above, then the triangle of a tile's own rows.
    Lower,
    /// The same with an upper triangle and what is below.
    Upper,
}

/// The rows of a triangle that begins in row `k`.
fn triangle<R>(left: &[R], ld: usize, k: usize) -> Rows {
    Rows { to: k, count: left.len().checked_div(ld).unwrap_or(0), from: k }
}

/// Columns of a tile: what the registers of a microcontroller hold, or those of larger machines.
const fn columns<R>() -> usize {
    if cfg!(target_arch = "arm") && size_of::<R>() == 8 { 2 } else { 4 }
}

fn by_strips<R: Real>(left: &[R], ld: usize, rows: Rows, kind: Kind, right: &mut [R]) {
    let (width, mut rest) = (columns::<R>() * ld, right);
    while rest.len() >= width.max(1) {
        let (strip, others) = rest.split_at_mut_checked(width).unwrap_or((&mut [], &mut []));
        if columns::<R>() == 2 {
            one_strip::<R, 2>(left, ld, rows, kind, strip);
        } else {
            one_strip::<R, 4>(left, ld, rows, kind, strip);
        }
        rest = others;
    }
    for column in rest.chunks_mut(ld.max(1)) {
        one_strip::<R, 1>(left, ld, rows, kind, column);
    }
}

/// `N` columns, tile by tile, in an order in which each finds what it needs; rows that make no tile one by one.
fn one_strip<R: Real, const N: usize>(left: &[R], ld: usize, rows: Rows, kind: Kind, strip: &mut [R]) {
    let width = left.len().checked_div(ld).unwrap_or(0);
    let mut done = 0;
    while done < rows.count {
        let rest = rows.count - done;
        let whole = rest >= ROWS && (kind != Kind::Upper || rest.is_multiple_of(ROWS));
        let count = if whole { ROWS } else { 1 };
        let (left, row, from, depth) = match kind {
            Kind::Product => (left, done, rows.from, width),
            Kind::Lower => (left, done, rows.from, done),
            Kind::Upper => (left.get((rest - count) * ld..).unwrap_or(&[]), rest - count, rows.from + rest, done),
        };
        if !whole {
            single_row(left, ld, rows.to + row, from, depth, kind, strip);
        } else if tile::<R, N>(left, ld, rows.to + row, from, depth, kind, strip).is_none() {
            put(strip, rows.to + row, R::NAN);
        }
        done += count;
    }
}

/// The row `to` minus the product of `depth` columns of A and the rows `from ..`. On the left of those columns is the triangle if it
/// is an upper one, on their right if it is a lower one.
#[inline(never)]
fn single_row<R: Real>(left: &[R], ld: usize, to: usize, from: usize, depth: usize, kind: Kind, strip: &mut [R]) {
    let own = if kind == Kind::Upper { ld } else { 0 };
    for column in strip.chunks_mut(ld.max(1)) {
        let mut sum = at(column, to);
        for (a, b) in left.get(own..).unwrap_or(&[]).chunks(ld.max(1)).zip(part(column, from, depth)) {
            sum -= at(a, to) * *b;
        }
        put(column, to, if kind == Kind::Upper { sum / at(left, to) } else { sum });
    }
}

/// The same for four rows, held in registers: what is in an array that a loop runs over would not stay there. `None` when
/// something is not there.
#[inline(always)]
fn tile<R: Real, const N: usize>(
    left: &[R],
    ld: usize,
    to: usize,
    from: usize,
    depth: usize,
    kind: Kind,
    strip: &mut [R],
) -> Option<()> {
    let column = |j: usize| Some((load(strip, j * ld + to)?, part(strip, j * ld + from, depth)));
    let (mut s0, b0) = column(0)?;
    let (mut s1, b1) = if N > 1 { column(1)? } else { (s0, b0) };
    let ((mut s2, b2), (mut s3, b3)) = if N > 2 { (column(2)?, column(3)?) } else { ((s0, b0), (s0, b0)) };
    let mut rest = left.get(if kind == Kind::Upper { ROWS * ld } else { 0 }..)?;
    for (((x0, x1), x2), x3) in b0.iter().zip(b1).zip(b2).zip(b3) {
        let (a, others) = rest.split_at_checked(ld)?;
        let a = load(a, to)?;
        rest = others;
        s0 = minus_product(s0, a, *x0);
        if N > 1 {
            s1 = minus_product(s1, a, *x1);
        }
        if N > 2 {
            s2 = minus_product(s2, a, *x2);
            s3 = minus_product(s3, a, *x3);
        }
    }
    if kind == Kind::Lower {
        let t = (load(rest, to)?, load(rest, ld + to)?, load(rest, 2 * ld + to)?);
        s0 = lower(t, s0);
        if N > 1 {
            s1 = lower(t, s1);
        }
        if N > 2 {
            (s2, s3) = (lower(t, s2), lower(t, s3));
        }
    }
    if kind == Kind::Upper {
        let t = (load(left, ld + to)?, load(left, 2 * ld + to)?, load(left, 3 * ld + to)?);
        let (one, (u, v, w)) = (R::one(), t);
        let scale = [one / *left.get(to)?, one / u[1], one / v[2], one / w[3]];
        s0 = upper(t, scale, s0);
        if N > 1 {
            s1 = upper(t, scale, s1);
        }
        if N > 2 {
            (s2, s3) = (upper(t, scale, s2), upper(t, scale, s3));
        }
    }
    store(s0, strip, to);
    if N > 1 {
        store(s1, strip, ld + to);
    }
    if N > 2 {
        store(s2, strip, 2 * ld + to);
        store(s3, strip, 3 * ld + to);
    }
    Some(())
}

/// Four rows of a column.
type Four<R> = [R; ROWS];

#[inline(always)]
fn load<R: Real>(from: &[R], row: usize) -> Option<Four<R>> {
    from.get(row..)?.first_chunk().copied()
}

#[inline(always)]
fn store<R: Real>(s: Four<R>, to: &mut [R], row: usize) {
    if let Some(to) = to.get_mut(row..).and_then(|to| to.first_chunk_mut()) {
        *to = s;
    }
}

#[inline(always)]
fn minus_product<R: Real>([s0, s1, s2, s3]: Four<R>, [a0, a1, a2, a3]: Four<R>, x: R) -> Four<R> {
    [s0 - a0 * x, s1 - a1 * x, s2 - a2 * x, s3 - a3 * x]
}

/// Solves with a unit lower triangle, of which the first three columns are given.
#[inline(always)]
fn lower<R: Real>((l, m, o): (Four<R>, Four<R>, Four<R>), [s0, s1, s2, s3]: Four<R>) -> Four<R> {
    let s1 = s1 - l[1] * s0;
    let s2 = s2 - l[2] * s0 - m[2] * s1;
    [s0, s1, s2, s3 - l[3] * s0 - m[3] * s1 - o[3] * s2]
}

/// Solves with an upper triangle, of which the last three columns and the inverse diagonal are given.
#[inline(always)]
fn upper<R: Real>((u, v, w): (Four<R>, Four<R>, Four<R>), d: Four<R>, [s0, s1, s2, s3]: Four<R>) -> Four<R> {
    let s3 = s3 * d[3];
    let s2 = (s2 - w[2] * s3) * d[2];
    let s1 = (s1 - w[1] * s3 - v[1] * s2) * d[1];
    [(s0 - w[0] * s3 - v[0] * s2 - u[0] * s1) * d[0], s1, s2, s3]
}

/// `y −= x l`.
fn subtract_column<R: Real>(y: &mut [R], x: R, l: &[R]) {
    let ((y4, y), (l4, l)) = (y.as_chunks_mut::<ROWS>(), l.as_chunks::<ROWS>());
    for (y, l) in y4.iter_mut().zip(l4) {
        *y = minus_product(*y, *l, x);
    }
    for (y, l) in y.iter_mut().zip(l) {
        *y -= x * *l;
    }
}

/// `y *= x`.
fn scale_column<R: Real>(y: &mut [R], x: R) {
    let (y4, y) = y.as_chunks_mut::<ROWS>();
    for y in y4 {
        let [y0, y1, y2, y3] = *y;
        *y = [y0 * x, y1 * x, y2 * x, y3 * x];
    }
    for y in y {
        *y *= x;
    }
}

/// The largest magnitude; 0 if there is none but NaN.
fn largest_of<R: Real>(y: &[R]) -> R {
    let larger = |m: R, y: R| if y.abs() > m { y.abs() } else { m };
    let (y4, y) = y.as_chunks::<ROWS>();
    let zero = R::zero();
    let (mut m0, mut m1, mut m2, mut m3) = (zero, zero, zero, zero);
    for [y0, y1, y2, y3] in y4 {
        (m0, m1, m2, m3) = (larger(m0, *y0), larger(m1, *y1), larger(m2, *y2), larger(m3, *y3));
    }
    y.iter().fold(larger(larger(m0, m1), larger(m2, m3)), |m, y| larger(m, *y))
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    /// Whether the product and both solutions are right in strips of `N` columns, from row 2 on: exact in small integers.
    fn right<const N: usize>(width: usize, below: usize) -> bool {
        let n = 2 + width + below;
        let ld = n + 1;
        let entry = |i: usize, j: usize| ((7 * i + 5 * j + i * j) % 5) as f64 - 2.0;
        // Pivots that differ, and are divided by exactly.
        let pivot = |k: usize| [2.0, 0.5, 4.0, 1.0, 8.0][k % 5];
        let left: Vec<f64> =
            (0..width * ld).map(|e| if e % ld == 2 + e / ld { pivot(e / ld) } else { entry(e % ld, e / ld) }).collect();
        let x: Vec<f64> = (0..N * ld).map(|e| entry(e % ld, 3 + e / ld)).collect();
        let product = |row: usize, j: usize, columns: std::ops::Range<usize>| -> f64 {
            columns.map(|p| left[p * ld + row] * x[j * ld + 2 + p]).sum()
        };
        [Kind::Product, Kind::Lower, Kind::Upper].into_iter().all(|kind| {
            // What comes out is known: x, and what is put in is made from it.
            let rows = if kind == Kind::Product { 2 + width..n } else { 2..2 + width };
            let mut strip = x.clone();
            for j in 0..N {
                for row in rows.clone() {
                    strip[j * ld + row] += match kind {
                        Kind::Product => product(row, j, 0..width),
                        Kind::Lower => product(row, j, 0..row - 2),
                        Kind::Upper => product(row, j, row - 2..width) - x[j * ld + row],
                    };
                }
            }
            one_strip::<f64, N>(&left, ld, Rows { to: rows.start, count: rows.len(), from: 2 }, kind, &mut strip);
            strip == x
        })
    }

    #[test]
    fn strips_of_every_width_give_what_the_product_was_made_from() {
        for width in [1, 2, 3, 4, 5, 8, 11, 16] {
            for below in [0, 1, 4, 7, 12] {
                let all = [right::<1>(width, below), right::<2>(width, below), right::<4>(width, below)];
                assert_eq!(all, [true; 3], "{width} columns, {below} rows below");
            }
        }
    }
}
