//! Elimination of a block of eight columns, for a machine's own vectors: in one pass over its rows where partial pivoting
//! exchanges nothing, else column by column with exchanges.
//!
//! Tested by `linear/lu/tests.rs`.

use super::rows::{BLOCK, Rows, exchange};
use super::tile::{begin, halves, store};
use crate::base::index::Index;
use crate::base::machine::Lanes;
use crate::base::memory::{at, part, part_mut};
use crate::base::scalar::Real;

/// Elimination with partial pivoting of at most [`BLOCK`] columns from row `k` on. Returns the smallest and the largest
/// pivot; `None` when there is none.
#[inline(always)]
pub(super) fn eliminate_block<R: Real, V: Lanes<R>>(
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
) -> Option<(R, R)> {
    let straight = match BLOCK / V::WIDTH {
        1 => eliminate_straight::<R, V, 1>(block, ld, n, k, pivots),
        2 => eliminate_straight::<R, V, 2>(block, ld, n, k, pivots),
        _ => eliminate_straight::<R, V, 4>(block, ld, n, k, pivots),
    };
    if straight.is_some() { straight } else { eliminate_exchanging::<R, V>(block, ld, n, k, pivots) }
}

/// Elimination of a whole block in one pass over its rows, without a search for pivots, provided that partial pivoting would
/// exchange no rows: that no multiplier exceeds 1. Otherwise `None`, and the block is (to rounding) what it was.
#[inline(always)]
fn eliminate_straight<R: Real, V: Lanes<R>, const H: usize>(
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
) -> Option<(R, R)> {
    if pivots.len() != BLOCK {
        return None;
    }
    let mut tops = [[R::zero(); BLOCK]; BLOCK];
    let mut columns: [&mut [R]; BLOCK] = [&mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut []];
    for ((to, below), column) in tops.iter_mut().zip(&mut columns).zip(columns_of(block, ld)?) {
        let (top, rest) = part_mut(column, k, n - k).split_first_chunk_mut::<BLOCK>()?;
        (*to, *below) = (*top, rest);
    }
    let inverses = triangularize::<R, V, H>(&mut tops)?;
    let (mut smallest, mut largest) = (R::MAX, R::zero());
    for (p, column) in tops.iter().enumerate() {
        let size = at(column, p).abs();
        (smallest, largest) = (smallest.min(size), largest.max(size));
    }
    let rows = n - k - BLOCK;
    let mut done = 0;
    while done < rows {
        let x = divided::<R, V>(rows_of(&columns, done), &tops, &inverses);
        if !x.iter().fold(V::splat(R::zero()), |m, x| m.max_abs(*x)).within_one() {
            for row in (0..done).step_by(V::WIDTH) {
                store_rows(multiplied::<R, V>(rows_of(&columns, row), &tops), &mut columns, row);
            }
            return None;
        }
        store_rows(x, &mut columns, done);
        done += V::WIDTH;
    }
    for (c, (pivot, top)) in pivots.iter_mut().zip(&tops).enumerate() {
        *pivot = R::Index::of(k + c);
        crate::base::memory::copy(part_mut(block, c * ld + k, BLOCK), top);
    }
    Some((smallest, largest))
}

/// The columns of a whole block.
#[inline(always)]
fn columns_of<R>(block: &mut [R], ld: usize) -> Option<[&mut [R]; BLOCK]> {
    let (first, second) = halves(block.get_mut(..BLOCK * ld)?);
    let ((a, b), (c, d)) = (halves(first), halves(second));
    let (((a, b), (c, d)), ((e, f), (g, h))) = ((halves(a), halves(b)), (halves(c), halves(d)));
    Some([a, b, c, d, e, f, g, h])
}

/// A ← A U⁻¹ in the rows `to ..` of a block, whose rows `from ..` hold U.
#[inline(always)]
pub(super) fn divide<R: Real, V: Lanes<R>>(block: &mut [R], ld: usize, rows: Rows) {
    let Some(columns) = columns_of(block, ld) else { return super::divide::divide(block, ld, rows) };
    let (mut tops, mut inverses) = ([[R::zero(); BLOCK]; BLOCK], [R::zero(); BLOCK]);
    let mut below: [&mut [R]; BLOCK] = [&mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut []];
    let parts = tops.iter_mut().zip(&mut inverses).zip(&mut below).zip(columns);
    for (c, (((top, inverse), below), column)) in parts.enumerate() {
        crate::base::memory::copy(top, part(column, rows.from, BLOCK));
        *inverse = R::one() / at(top, c);
        *below = part_mut(column, rows.to, rows.count);
    }
    for row in (0..rows.count).step_by(V::WIDTH) {
        store_rows(divided::<R, V>(rows_of(&below, row), &tops, &inverses), &mut below, row);
    }
}

/// Factors of a block of columns in place, without exchanges; the inverse pivots. `None` if a multiplier exceeds 1 or a
/// pivot is 0 or not finite.
#[inline(always)]
fn triangularize<R: Real, V: Lanes<R>, const H: usize>(columns: &mut [[R; BLOCK]; BLOCK]) -> Option<[R; BLOCK]> {
    let mut u = columns.map(|column| begin::<R, V, H>(&column));
    // Written out: what a loop over columns indexes would not stay in registers.
    let inverses = [
        eliminate_one::<R, V, H, 0>(&mut u)?,
        eliminate_one::<R, V, H, 1>(&mut u)?,
        eliminate_one::<R, V, H, 2>(&mut u)?,
        eliminate_one::<R, V, H, 3>(&mut u)?,
        eliminate_one::<R, V, H, 4>(&mut u)?,
        eliminate_one::<R, V, H, 5>(&mut u)?,
        eliminate_one::<R, V, H, 6>(&mut u)?,
        eliminate_one::<R, V, H, 7>(&mut u)?,
    ];
    for (column, u) in columns.iter_mut().zip(u) {
        store(u, column);
    }
    Some(inverses)
}

/// Eliminates column `P`.
#[inline(always)]
fn eliminate_one<R: Real, V: Lanes<R>, const H: usize, const P: usize>(u: &mut [[V; H]; BLOCK]) -> Option<R> {
    let (zero, row) = (V::splat(R::zero()), |y: &[V; H]| y.get(P / V::WIDTH).map_or(R::NAN, |y| y.row(P % V::WIDTH)));
    let (done, later) = u.split_at_mut_checked(P + 1)?;
    let own = done.last_mut()?;
    let pivot = row(own);
    if pivot == R::zero() || !pivot.is_finite() {
        return None;
    }
    let inverse = R::one() / pivot;
    let mut below = [R::zero(); BLOCK];
    below.iter_mut().skip(P + 1).for_each(|x| *x = R::one());
    let (below, mut l, mut largest) = (begin::<R, V, H>(&below), [zero; H], zero);
    for ((l, x), below) in l.iter_mut().zip(own).zip(below) {
        let part = zero.minus_product(*x, below);
        *l = zero.minus_product(part, V::splat(inverse));
        *x = x.minus_product(*x, below).minus_product(*l, V::splat(-R::one()));
        largest = largest.max_abs(*l);
    }
    for y in later {
        let x = V::splat(row(y));
        for (y, l) in y.iter_mut().zip(l) {
            *y = y.minus_product(l, x);
        }
    }
    largest.within_one().then_some(inverse)
}

/// Rows of A U⁻¹ from rows of A.
#[inline(always)]
fn divided<R: Real, V: Lanes<R>>(mut x: [V; BLOCK], u: &[[R; BLOCK]; BLOCK], inverses: &[R; BLOCK]) -> [V; BLOCK] {
    let zero = V::splat(R::zero());
    for c in 0..BLOCK {
        let (done, rest) = x.split_at_mut_checked(c).unwrap_or((&mut [], &mut []));
        if let ([x, ..], Some(u), Some(inverse)) = (rest, u.get(c), inverses.get(c)) {
            for (l, u) in done.iter().zip(u) {
                *x = x.minus_product(*l, V::splat(*u));
            }
            *x = zero.minus_product(*x, V::splat(-*inverse));
        }
    }
    x
}

/// Rows of L U from rows of L.
#[inline(always)]
fn multiplied<R: Real, V: Lanes<R>>(mut l: [V; BLOCK], u: &[[R; BLOCK]; BLOCK]) -> [V; BLOCK] {
    for c in (0..BLOCK).rev() {
        let (before, rest) = l.split_at_mut_checked(c).unwrap_or((&mut [], &mut []));
        if let ([x, ..], Some(u)) = (rest, u.get(c)) {
            *x = V::splat(R::zero()).minus_product(*x, V::splat(-at(u, c)));
            for (l, u) in before.iter().zip(u) {
                *x = x.minus_product(*l, V::splat(-*u));
            }
        }
    }
    l
}

/// A vector of rows of every column of a block; 0 beyond the last row.
#[inline(always)]
fn rows_of<R: Real, V: Lanes<R>>(columns: &[&mut [R]; BLOCK], row: usize) -> [V; BLOCK] {
    let whole = || {
        let mut x = [V::splat(R::zero()); BLOCK];
        for (x, column) in x.iter_mut().zip(columns) {
            *x = V::load(column.get(row..)?)?;
        }
        Some(x)
    };
    // Whole vectors in one branch, so that they need not pass through memory.
    whole().unwrap_or_else(|| {
        let mut x = [V::splat(R::zero()); BLOCK];
        for (x, column) in x.iter_mut().zip(columns) {
            *x = V::begin(column.get(row..).unwrap_or(&[]));
        }
        x
    })
}

#[inline(always)]
fn store_rows<R: Real, V: Lanes<R>>(x: [V; BLOCK], columns: &mut [&mut [R]; BLOCK], row: usize) {
    for (x, column) in x.into_iter().zip(columns) {
        x.store(column.get_mut(row..).unwrap_or(&mut []));
    }
}

/// The same, left-looking, with exchanges.
#[inline(always)]
fn eliminate_exchanging<R: Real, V: Lanes<R>>(
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
) -> Option<(R, R)> {
    let (mut smallest, mut largest) = (R::MAX, R::zero());
    let width = pivots.len();
    for (c, pivot) in pivots.iter_mut().enumerate() {
        let (done, rest) = block.split_at_mut_checked(c * ld)?;
        let column = part_mut(rest, 0, n);
        let column = part_mut(column, k, n - k);
        let size = match c {
            0 => reduce_column::<R, V, 0>(done, ld, k, column),
            1 => reduce_column::<R, V, 1>(done, ld, k, column),
            2 => reduce_column::<R, V, 2>(done, ld, k, column),
            3 => reduce_column::<R, V, 3>(done, ld, k, column),
            4 => reduce_column::<R, V, 4>(done, ld, k, column),
            5 => reduce_column::<R, V, 5>(done, ld, k, column),
            6 => reduce_column::<R, V, 6>(done, ld, k, column),
            _ => reduce_column::<R, V, 7>(done, ld, k, column),
        };
        if size == R::zero() || !size.is_finite() {
            return None;
        }
        (smallest, largest) = (smallest.min(size), largest.max(size));
        let row = k + c + part(column, c, n - k - c).iter().position(|y| y.abs() == size).unwrap_or(0);
        *pivot = R::Index::of(row);
        if row != k + c {
            for column in block.chunks_exact_mut(ld.max(1)).take(width) {
                exchange(column, k + c, row);
            }
        }
        let column = part_mut(block, c * ld, n);
        let inverse = R::one() / at(column, k + c);
        for y in part_mut(column, k + c + 1, n - k - c - 1) {
            *y *= inverse;
        }
    }
    Some((smallest, largest))
}

/// Solves with the `C` columns done before, rows `k ..`, and reduces the rows below; returns the largest magnitude there.
#[inline(always)]
fn reduce_column<R: Real, V: Lanes<R>, const C: usize>(done: &[R], ld: usize, k: usize, column: &mut [R]) -> R {
    let mut rest = done;
    let mut l: [&[R]; C] = [&[]; C];
    for l in &mut l {
        let (first, others) = rest.split_at_checked(ld).unwrap_or((&[], &[]));
        (*l, rest) = (part(first, k, column.len()), others);
    }
    let Some((top, below)) = column.split_first_chunk_mut::<C>() else { return R::NAN };
    let mut x = *top;
    let mut triangle = [[R::zero(); C]; C];
    for (t, l) in triangle.iter_mut().zip(&mut l) {
        let Some((head, tail)) = l.split_first_chunk::<C>() else { return R::NAN };
        (*t, *l) = (*head, tail);
    }
    for (p, t) in triangle.iter().enumerate() {
        let pivot = at(&x, p);
        for (x, t) in x.iter_mut().zip(t).skip(p + 1) {
            *x -= pivot * *t;
        }
    }
    *top = x;
    let mut largest = V::splat(R::zero());
    let mut done = 0;
    let mut whole = below.chunks_exact_mut(V::WIDTH);
    for y in whole.by_ref() {
        let Some(mut sum) = V::load(y) else { break };
        for (l, x) in l.iter().zip(x) {
            let Some(l) = l.get(done..).and_then(V::load) else { return R::NAN };
            sum = sum.minus_product(l, V::splat(x));
        }
        sum.store(y);
        largest = largest.max_abs(sum);
        done += V::WIDTH;
    }
    let mut size = largest.largest();
    for (i, y) in whole.into_remainder().iter_mut().enumerate() {
        for (l, x) in l.iter().zip(x) {
            *y -= at(l, done + i) * x;
        }
        if y.abs() > size {
            size = y.abs();
        }
    }
    size
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::base::machine::{Machine, Task, Vectors};
    use core::marker::PhantomData;
    use std::vec::Vec;

    struct Straight<'a, V, const H: usize>(&'a mut [f64], &'a mut [u64], PhantomData<V>);

    impl<V: Lanes<f64>, const H: usize> Task for Straight<'_, V, H> {
        type Output = bool;
        #[inline(always)]
        fn run(self) -> bool {
            let n = self.0.len() / BLOCK;
            eliminate_straight::<f64, V, H>(self.0, n, n, 0, self.1).is_some()
        }
    }

    /// Whether the block is eliminated in one pass, by every set of instructions that the machine at hand has.
    fn straight(block: &[f64]) -> Vec<bool> {
        let one = |machine| {
            let (block, pivots) = (&mut block.to_vec()[..], &mut [0; BLOCK][..]);
            match machine {
                Machine::Portable(_) => None,
                Machine::Avx2(m) => Some(m.fused(Straight::<<f64 as Vectors>::Short, 2>(block, pivots, PhantomData))),
                Machine::Avx512(m) => Some(m.fused(Straight::<<f64 as Vectors>::Long, 1>(block, pivots, PhantomData))),
            }
        };
        Machine::all().into_iter().filter_map(one).collect()
    }

    #[test]
    fn a_block_takes_one_pass_if_and_only_if_its_pivots_need_no_exchange() {
        let n = 21;
        let sound =
            |row: usize, column: usize| if row == column { 3.0 } else { ((row + 2 * column) as f64).sin() / 9.0 };
        let with = |at: Option<(usize, usize)>, value: f64| -> Vec<f64> {
            (0..BLOCK * n).map(|e| if at == Some((e % n, e / n)) { value } else { sound(e % n, e / n) }).collect()
        };
        assert!(straight(&with(None, 0.0)).into_iter().all(|one_pass| one_pass));
        for at in [(0, 0), (5, 5), (7, 7), (13, 2)] {
            for value in [f64::NAN, f64::INFINITY, if at.0 == at.1 { 1e-3 } else { 30.0 }] {
                // NaN below comes to a later pivot.
                let any = straight(&with(Some(at), value)).into_iter().any(|one_pass| one_pass);
                assert!(!any || (at.0 != at.1 && value.is_nan()), "{value} at {at:?}");
            }
        }
    }
}
