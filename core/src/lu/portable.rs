//! The factorization for any machine: one register tile in plain Rust, which compilers turn into vectors where there are some,
//! and which stays small on a microcontroller.

use super::kernel::Kernel;
use super::{Rows, exchange};
use crate::scalar::Real;
use crate::workspace::{at, inner, part, part_mut, put};

/// Columns that are eliminated without recursion.
const SMALL: usize = 64;

/// Rows of a tile.
const ROWS: usize = 4;

/// Any machine.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

impl<R: Real> Kernel<R> for Portable {
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
        by_strips(left, ld, Kind::Product(rows), right);
    }

    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R]) -> Option<(R, R)> {
        let (mut smallest, mut largest) = (R::MAX, R::zero());
        for (c, pivot) in pivots.iter_mut().enumerate() {
            let (done, rest) = block.split_at_mut_checked(c * ld)?;
            let first = c - c % strip::<R>();
            if c == first {
                // The columns done before act upon a whole strip at once, those of the strip itself one by one.
                let strip = part_mut(rest, 0, (strip::<R>() * ld).min(rest.len()));
                self.solve_lower(done, ld, k, strip);
                self.subtract(done, ld, Rows { to: k + c, count: n - k - c, from: k }, strip);
            }
            let column = part_mut(rest, 0, n);
            for (p, left) in done.chunks_exact(ld.max(1)).enumerate().skip(first) {
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
                return None;
            }
            (smallest, largest) = (smallest.min(size), largest.max(size));
            *pivot = R::count(row);
            if row != k + c {
                for column in block.chunks_exact_mut(ld.max(1)) {
                    exchange(column, k + c, row);
                }
            }
            let column = part_mut(block, c * ld, n);
            let inverse = R::one() / at(column, k + c);
            for x in part_mut(column, k + c + 1, n - k - c - 1) {
                *x *= inverse;
            }
        }
        Some((smallest, largest))
    }

    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        by_strips(left, ld, Kind::Lower(k), right);
    }

    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        by_strips(left, ld, Kind::Upper(k), right);
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

/// What happens to a strip of columns.
#[derive(Clone, Copy)]
enum Kind {
    /// C ← C − A B.
    Product(Rows),
    /// Solution with the unit lower triangle in the rows from this one on.
    Lower(usize),
    /// The same with the upper triangle.
    Upper(usize),
}

/// Columns of a strip, and of a tile: what the registers of a microcontroller hold, and those of larger machines.
const fn strip<R>() -> usize {
    if cfg!(target_arch = "arm") && size_of::<R>() == 8 { 2 } else { 4 }
}

fn by_strips<R: Real>(left: &[R], ld: usize, kind: Kind, right: &mut [R]) {
    let (width, mut rest) = (strip::<R>() * ld, right);
    while rest.len() >= width.max(1) {
        let (strip, others) = rest.split_at_mut_checked(width).unwrap_or((&mut [], &mut []));
        if self::strip::<R>() == 2 {
            one_strip::<R, 2>(left, ld, kind, strip);
        } else {
            one_strip::<R, 4>(left, ld, kind, strip);
        }
        rest = others;
    }
    for column in rest.chunks_mut(ld.max(1)) {
        one_strip::<R, 1>(left, ld, kind, column);
    }
}

/// Tile by tile, in an order in which each finds what it needs.
fn one_strip<R: Real, const N: usize>(left: &[R], ld: usize, kind: Kind, strip: &mut [R]) {
    let width = left.len().checked_div(ld).unwrap_or(0);
    let count = if let Kind::Product(rows) = kind { rows.count } else { width };
    let tiles = count.div_ceil(ROWS);
    for i in 0..tiles {
        let row = ROWS * if let Kind::Upper(_) = kind { tiles - 1 - i } else { i };
        let count = (count - row).min(ROWS);
        let (first, depth, to, from) = match kind {
            Kind::Product(rows) => (0, width, rows.to + row, rows.from),
            Kind::Lower(k) => (0, row, k + row, k),
            Kind::Upper(k) => (row + count, width - row - count, k + row, k + row + count),
        };
        if count == ROWS {
            let (a, triangle) = (part(left, first * ld, depth * ld), part(left, row * ld, ROWS * ld));
            let _ = tile::<R, N>(a, ld, Rows { to, count: depth, from }, kind, triangle, strip);
        } else {
            for i in 0..count {
                let (first, depth, to, from) = match kind {
                    Kind::Product(_) => (first, depth, to + i, from),
                    Kind::Lower(_) => (first, depth + i, to + i, from),
                    Kind::Upper(_) => (first - i, depth + i, to + count - 1 - i, from - i),
                };
                for j in 0..N {
                    let (a, b) = (part(left, first * ld, depth * ld), part(strip, j * ld + from, depth));
                    let mut sum = at(strip, j * ld + to);
                    for (a, b) in a.chunks_exact(ld.max(1)).zip(b) {
                        sum -= at(a, to) * *b;
                    }
                    if let Kind::Upper(_) = kind {
                        sum /= at(left, (first - 1) * ld + to);
                    }
                    put(strip, j * ld + to, sum);
                }
            }
        }
    }
}

/// One tile of four rows, held in registers: what is in an array that a loop runs over would not stay there. `None` when a part
/// of it is not there.
#[inline(never)]
fn tile<R: Real, const N: usize>(
    left: &[R],
    ld: usize,
    rows: Rows,
    kind: Kind,
    triangle: &[R],
    strip: &mut [R],
) -> Option<()> {
    let Rows { to, from, count: depth } = rows;
    let column = |j: usize| Some((load(strip, j * ld + to)?, part(strip, j * ld + from, depth)));
    let (mut s0, b0) = column(0)?;
    let (mut s1, b1) = if N > 1 { column(1)? } else { (s0, b0) };
    let ((mut s2, b2), (mut s3, b3)) = if N > 2 { (column(2)?, column(3)?) } else { ((s0, b0), (s0, b0)) };
    let mut rest = left;
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
    match kind {
        Kind::Product(_) => {}
        Kind::Lower(_) => {
            let t = (load(triangle, to)?, load(triangle, ld + to)?, load(triangle, 2 * ld + to)?);
            s0 = lower(t, s0);
            if N > 1 {
                s1 = lower(t, s1);
            }
            if N > 2 {
                (s2, s3) = (lower(t, s2), lower(t, s3));
            }
        }
        Kind::Upper(_) => {
            let t = (load(triangle, ld + to)?, load(triangle, 2 * ld + to)?, load(triangle, 3 * ld + to)?);
            let one = R::one();
            let scale = [one / at(triangle, to), one / t.0[1], one / t.1[2], one / t.2[3]];
            s0 = upper(t, scale, s0);
            if N > 1 {
                s1 = upper(t, scale, s1);
            }
            if N > 2 {
                (s2, s3) = (upper(t, scale, s2), upper(t, scale, s3));
            }
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
    part(from, row, ROWS).first_chunk().copied()
}

#[inline(always)]
fn store<R: Real>(s: Four<R>, to: &mut [R], row: usize) {
    if let Some(to) = part_mut(to, row, ROWS).first_chunk_mut() {
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

/// A ← A U⁻¹ in the rows `to ..` of a block, whose rows `from ..` hold U.
pub(super) fn divide<R: Real>(block: &mut [R], ld: usize, rows: Rows) {
    for c in 0..block.len().checked_div(ld).unwrap_or(0) {
        let Some((done, rest)) = block.split_at_mut_checked(c * ld) else { return };
        let column = part_mut(rest, 0, ld);
        for (p, left) in done.chunks_exact(ld.max(1)).enumerate() {
            let x = at(column, rows.from + p);
            for (y, l) in part_mut(column, rows.to, rows.count).iter_mut().zip(part(left, rows.to, rows.count)) {
                *y -= x * *l;
            }
        }
        let inverse = R::one() / at(column, rows.from + c);
        for y in part_mut(column, rows.to, rows.count) {
            *y *= inverse;
        }
    }
}
