//! The loops of the factorization for any machine: long runs down the columns, which compilers vectorize as far as they may,
//! and which stay small and fast on a microcontroller.

use super::kernel::Kernel;
use super::{BLOCK, Rows, exchange};
use crate::scalar::Real;
use crate::workspace::{at, inner, part, part_mut, put};

/// Any machine.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

impl<R: Real> Kernel<R> for Portable {
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
        let mut pairs = right.chunks_exact_mut(ld.saturating_mul(2).max(1));
        for pair in pairs.by_ref() {
            let (first, second) = pair.split_at_mut_checked(ld).unwrap_or((&mut [], &mut []));
            for (i, left) in left.chunks(ld.saturating_mul(BLOCK).max(1)).enumerate() {
                let rows = Rows { from: rows.from + i * BLOCK, ..rows };
                subtract_from_two(left, ld, rows, first, second);
            }
        }
        for column in pairs.into_remainder().chunks_mut(ld.max(1)) {
            for (i, left) in left.chunks(ld.saturating_mul(BLOCK).max(1)).enumerate() {
                subtract_from_one(left, ld, Rows { from: rows.from + i * BLOCK, ..rows }, column);
            }
        }
    }

    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R]) -> Option<(R, R)> {
        let (mut smallest, mut largest) = (R::MAX, R::zero());
        for (c, pivot) in pivots.iter_mut().enumerate() {
            let (done, rest) = block.split_at_mut_checked(c * ld)?;
            let column = part_mut(rest, 0, n);
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
        let width = left.len().checked_div(ld).unwrap_or(0);
        for column in right.chunks_mut(ld.max(1)) {
            for (p, l) in left.chunks_exact(ld.max(1)).enumerate() {
                let x = at(column, k + p);
                let n = width - p - 1;
                for (y, l) in part_mut(column, k + p + 1, n).iter_mut().zip(part(l, k + p + 1, n)) {
                    *y -= x * *l;
                }
            }
        }
    }

    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        for column in right.chunks_mut(ld.max(1)) {
            for (p, u) in left.chunks_exact(ld.max(1)).enumerate().rev() {
                let x = at(column, k + p) / at(u, k + p);
                put(column, k + p, x);
                for (y, u) in part_mut(column, k, p).iter_mut().zip(part(u, k, p)) {
                    *y -= x * *u;
                }
            }
        }
    }

    fn small(self) -> usize {
        64
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

/// The rows of at most eight columns; missing ones are empty.
#[inline]
fn eight<R>(left: &[R], ld: usize, rows: Rows) -> [&[R]; BLOCK] {
    let mut columns: [&[R]; BLOCK] = [&[]; BLOCK];
    for (c, l) in columns.iter_mut().zip(left.chunks_exact(ld.max(1))) {
        *c = part(l, rows.to, rows.count);
    }
    columns
}

/// The multipliers in a column; 0 beyond the columns on the left.
#[inline]
fn multipliers<R: Real>(left: &[R], ld: usize, rows: Rows, column: &[R]) -> [R; BLOCK] {
    let mut x = [R::zero(); BLOCK];
    let width = left.len().checked_div(ld).unwrap_or(0);
    crate::workspace::copy(&mut x, part(column, rows.from, width));
    x
}

/// `column −= left x` for at most eight columns on the left.
#[inline]
fn subtract_from_one<R: Real>(left: &[R], ld: usize, rows: Rows, column: &mut [R]) {
    let x = multipliers(left, ld, rows, column);
    let target = part_mut(column, rows.to, rows.count);
    let l = eight(left, ld, rows);
    if l[BLOCK - 1].is_empty() {
        for (l, x) in l.iter().zip(x) {
            for (y, l) in target.iter_mut().zip(*l) {
                *y -= x * *l;
            }
        }
        return;
    }
    let rows = target.iter_mut().zip(l[0]).zip(l[1]).zip(l[2]).zip(l[3]).zip(l[4]).zip(l[5]).zip(l[6]).zip(l[7]);
    for ((((((((y, a), b), c), d), e), f), g), h) in rows {
        *y -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]) + ((*e * x[4] + *f * x[5]) + (*g * x[6] + *h * x[7]));
    }
}

/// The same for two columns at once: each entry on the left is read once.
#[inline]
fn subtract_from_two<R: Real>(left: &[R], ld: usize, rows: Rows, first: &mut [R], second: &mut [R]) {
    let l = eight(left, ld, rows);
    if l[BLOCK - 1].is_empty() {
        subtract_from_one(left, ld, rows, first);
        subtract_from_one(left, ld, rows, second);
        return;
    }
    let (x, y) = (multipliers(left, ld, rows, first), multipliers(left, ld, rows, second));
    let targets = part_mut(first, rows.to, rows.count).iter_mut().zip(part_mut(second, rows.to, rows.count));
    let rows = targets.zip(l[0]).zip(l[1]).zip(l[2]).zip(l[3]).zip(l[4]).zip(l[5]).zip(l[6]).zip(l[7]);
    for (((((((((u, v), a), b), c), d), e), f), g), h) in rows {
        *u -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]) + ((*e * x[4] + *f * x[5]) + (*g * x[6] + *h * x[7]));
        *v -= (*a * y[0] + *b * y[1]) + (*c * y[2] + *d * y[3]) + ((*e * y[4] + *f * y[5]) + (*g * y[6] + *h * y[7]));
    }
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
