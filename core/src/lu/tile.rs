//! The one register tile of the factorization, C ← C − A B, and the loops around it, for a machine's own vectors.
//!
//! Everything here is safe and inlined into the entry points of [`super::kernel`], which choose the vector type.
//! Matrices are column-major with leading dimension `ld`.

use super::{BLOCK, Rows, exchange};
use crate::nystrom::{lanes, put_lanes};
use crate::scalar::Real;
use crate::workspace::{at, part, part_mut, put};

/// Columns of a tile.
const COLUMNS: usize = 4;

/// Depth of a product from which on its tiles are worth fetching ahead.
const FAR: usize = 64;

/// A vector of a few rows of one column.
pub trait Lanes<R>: Copy {
    /// Rows.
    const WIDTH: usize;
    /// The same value in every row.
    fn splat(x: R) -> Self;
    /// The first rows of a slice, if it has them all.
    fn load(from: &[R]) -> Option<Self>;
    /// The first rows of a slice; 0 where it ends early.
    fn begin(from: &[R]) -> Self;
    /// Writes as many rows as the slice has.
    fn store(self, to: &mut [R]);
    /// `self − a b`.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Sum of the rows.
    fn sum(self) -> R;
    /// The larger of `self` and |x|, row by row; `self` where x is NaN.
    fn max_abs(self, x: Self) -> Self;
    /// Asks for the memory of a slice's first element ahead of its use.
    fn prefetch(from: &[R]);
    /// Whether no row, all ≥ 0, exceeds 1.
    fn within_one(self) -> bool;
    /// One row.
    fn row(self, i: usize) -> R;
    /// The largest row.
    fn largest(self) -> R;
}

/// C ← C − A B, where B and C are rows of the same columns `right` and do not overlap. `left` holds A's columns.
#[inline(always)]
pub(super) fn subtract<R: Real, V: Lanes<R>, const M: usize>(left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
    let mut done = 0;
    while done < rows.count {
        let rest = rows.count - done;
        let here = Rows { to: rows.to + done, count: rest.min(M * V::WIDTH), ..rows };
        let a = left.get(here.to..).unwrap_or(&[]);
        match rest.div_ceil(V::WIDTH) {
            1 => row_of_tiles::<R, V, 1>(a, ld, here, right),
            2 if M > 2 => row_of_tiles::<R, V, 2>(a, ld, here, right),
            _ => row_of_tiles::<R, V, M>(a, ld, here, right),
        }
        done += here.count;
    }
}

/// The tiles side by side: what they read of A stays in the first cache.
#[inline(always)]
fn row_of_tiles<R: Real, V: Lanes<R>, const M: usize>(a: &[R], ld: usize, rows: Rows, right: &mut [R]) {
    let depth = a.len().div_ceil(ld.max(1));
    if depth == 0 {
        return;
    }
    let mut rest = right;
    while rest.len() >= COLUMNS * ld {
        let (group, others) = rest.split_at_mut_checked(COLUMNS * ld).unwrap_or((&mut [], &mut []));
        if depth >= FAR {
            // What the next tile changes is on its way while this one is computed.
            for column in others.chunks(ld.max(1)).take(COLUMNS) {
                for i in 0..=M {
                    V::prefetch(part(column, rows.to + i * V::WIDTH, 1));
                }
            }
        }
        rest = others;
        let (first, second) = halves(group);
        let ((w, x), (y, z)) = (halves(first), halves(second));
        let ((b0, c0), (b1, c1)) = (rows.of(w, depth), rows.of(x, depth));
        let ((b2, c2), (b3, c3)) = (rows.of(y, depth), rows.of(z, depth));
        tile::<R, V, M>(a, ld, [b0, b1, b2, b3], [c0, c1, c2, c3]);
    }
    for column in rest.chunks_mut(ld.max(1)) {
        let (b, c) = rows.of(column, depth);
        tile_of_one::<R, V, M>(a, ld, b, c);
    }
}

#[inline(always)]
fn halves<R>(columns: &mut [R]) -> (&mut [R], &mut [R]) {
    columns.split_at_mut_checked(columns.len() / 2).unwrap_or((&mut [], &mut []))
}

impl Rows {
    /// B's and C's part of a column.
    #[inline(always)]
    fn of<R>(self, column: &mut [R], depth: usize) -> (&[R], &mut [R]) {
        let Some((upper, lower)) = column.split_at_mut_checked(self.to.max(self.from)) else { return (&[], &mut []) };
        if self.to < self.from {
            (part(lower, 0, depth), part_mut(upper, self.to, self.count))
        } else {
            (part(upper, self.from, depth), part_mut(lower, 0, self.count))
        }
    }
}

/// One tile of `M` vectors of rows by four columns: its columns minus A B. `a` begins at the tile's first row.
#[inline(always)]
fn tile<R: Real, V: Lanes<R>, const M: usize>(a: &[R], ld: usize, b: [&[R]; COLUMNS], c: [&mut [R]; COLUMNS]) {
    let [c0, c1, c2, c3] = c;
    let [b0, b1, b2, b3] = b;
    // Whole vectors in one branch, so that they need not pass through memory.
    let mut sums = match (load(c0), load(c1), load(c2), load(c3)) {
        (Some(s0), Some(s1), Some(s2), Some(s3)) => [s0, s1, s2, s3],
        _ => [begin(c0), begin(c1), begin(c2), begin(c3)],
    };
    let mut rest = a;
    for (((b0, b1), b2), b3) in b0.iter().zip(b1).zip(b2).zip(b3) {
        let Some(rows) = load::<R, V, M>(rest) else { break };
        rest = rest.get(ld..).unwrap_or(&[]);
        rank_one(&mut sums, rows, [*b0, *b1, *b2, *b3]);
    }
    // One by one: what stands in an array that a loop runs over would not stay in registers.
    let [s0, s1, s2, s3] = sums;
    store(s0, c0);
    store(s1, c1);
    store(s2, c2);
    store(s3, c3);
    if !rest.is_empty() {
        last_column(rest, b0, c0);
        last_column(rest, b1, c1);
        last_column(rest, b2, c2);
        last_column(rest, b3, c3);
    }
}

/// The same for one column.
#[inline(always)]
fn tile_of_one<R: Real, V: Lanes<R>, const M: usize>(a: &[R], ld: usize, b: &[R], c: &mut [R]) {
    let mut sums = [begin(c)];
    let mut rest = a;
    for b in b {
        let Some(rows) = load::<R, V, M>(rest) else { break };
        rest = rest.get(ld..).unwrap_or(&[]);
        rank_one(&mut sums, rows, [*b]);
    }
    let [sums] = sums;
    store(sums, c);
    if !rest.is_empty() {
        last_column(rest, b, c);
    }
}

/// The last column of A where memory ends before a whole vector.
#[cold]
#[inline(never)]
fn last_column<R: Real>(a: &[R], b: &[R], c: &mut [R]) {
    for (c, a) in c.iter_mut().zip(a) {
        *c -= *a * b.last().copied().unwrap_or(R::NAN);
    }
}

#[inline(always)]
fn rank_one<R: Real, V: Lanes<R>, const M: usize, const N: usize>(sums: &mut [[V; M]; N], rows: [V; M], b: [R; N]) {
    for (sums, b) in sums.iter_mut().zip(b) {
        let b = V::splat(b);
        for (sum, row) in sums.iter_mut().zip(rows) {
            *sum = sum.minus_product(row, b);
        }
    }
}

#[inline(always)]
fn load<R: Real, V: Lanes<R>, const M: usize>(from: &[R]) -> Option<[V; M]> {
    let mut rows = [V::splat(R::zero()); M];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = V::load(from.get(i * V::WIDTH..)?)?;
    }
    Some(rows)
}

#[inline(always)]
fn begin<R: Real, V: Lanes<R>, const M: usize>(from: &[R]) -> [V; M] {
    let mut rows = [V::splat(R::zero()); M];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = V::begin(from.get(i * V::WIDTH..).unwrap_or(&[]));
    }
    rows
}

#[inline(always)]
fn store<R: Real, V: Lanes<R>, const M: usize>(rows: [V; M], to: &mut [R]) {
    for (i, row) in rows.into_iter().enumerate() {
        row.store(to.get_mut(i * V::WIDTH..).unwrap_or(&mut []));
    }
}

/// Elimination with partial pivoting of at most [`BLOCK`] columns from row `k` on. Returns the smallest and the largest
/// pivot; `None` when there is none.
#[inline(always)]
pub(super) fn eliminate_block<R: Real, V: Lanes<R>>(
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R],
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
    pivots: &mut [R],
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
        *pivot = R::count(k + c);
        crate::workspace::copy(part_mut(block, c * ld + k, BLOCK), top);
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
    let Some(columns) = columns_of(block, ld) else { return super::portable::divide(block, ld, rows) };
    let (mut tops, mut inverses) = ([[R::zero(); BLOCK]; BLOCK], [R::zero(); BLOCK]);
    let mut below: [&mut [R]; BLOCK] = [&mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut [], &mut []];
    let parts = tops.iter_mut().zip(&mut inverses).zip(&mut below).zip(columns);
    for (c, (((top, inverse), below), column)) in parts.enumerate() {
        crate::workspace::copy(top, part(column, rows.from, BLOCK));
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
    pivots: &mut [R],
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
        *pivot = R::count(row);
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

/// Solves with the triangle in rows `k ..` of the columns `left` (at most [`BLOCK`]): the unit lower one, or the upper one.
#[inline(always)]
pub(super) fn solve_triangle<R: Real, V: Lanes<R>, const UPPER: bool>(
    left: &[R],
    ld: usize,
    k: usize,
    right: &mut [R],
) {
    match BLOCK / V::WIDTH {
        1 => triangle::<R, V, 1, UPPER>(left, ld, k, right),
        2 => triangle::<R, V, 2, UPPER>(left, ld, k, right),
        _ => triangle::<R, V, 4, UPPER>(left, ld, k, right),
    }
}

/// The same, where `H` vectors make a block. Rows of the upper triangle are scaled so that it is a unit triangle too.
#[inline(always)]
fn triangle<R: Real, V: Lanes<R>, const H: usize, const UPPER: bool>(left: &[R], ld: usize, k: usize, right: &mut [R]) {
    let width = left.len().div_ceil(ld.max(1));
    let zero = V::splat(R::zero());
    let (mut block, mut scale) = ([[zero; H]; BLOCK], [-R::one(); BLOCK]);
    for (p, (column, scale)) in block.iter_mut().zip(&mut scale).enumerate() {
        let from = part(left.get(p * ld..).unwrap_or(&[]), k, width);
        // What belongs to the other triangle, and is finite, is taken 0 times.
        let mut mask = [R::zero(); BLOCK];
        for (i, mask) in mask.iter_mut().enumerate() {
            let kept = if UPPER { i < p } else { i > p };
            *mask = if kept { -R::one() } else { R::zero() };
        }
        *column = scaled(begin::<R, V, H>(from), begin::<R, V, H>(&mask));
        if UPPER && let Some(pivot) = from.get(p) {
            *scale = *pivot;
        }
    }
    let scale = if UPPER { scale.map(|pivot| -R::one() / pivot) } else { scale };
    let scale = begin::<R, V, H>(&scale);
    if UPPER {
        for column in &mut block {
            *column = scaled(*column, scale);
        }
    }
    let mut groups = right.chunks_exact_mut((COLUMNS * ld).max(1));
    for group in groups.by_ref() {
        let (first, second) = halves(group);
        let ((a, b), (c, d)) = (halves(first), halves(second));
        let columns = [part_mut(a, k, width), part_mut(b, k, width), part_mut(c, k, width), part_mut(d, k, width)];
        substitute::<R, V, H, COLUMNS, UPPER>(&block, scale, columns);
    }
    for column in groups.into_remainder().chunks_mut(ld.max(1)) {
        substitute::<R, V, H, 1, UPPER>(&block, scale, [part_mut(column, k, width)]);
    }
}

/// Row by row, with the columns of a unit triangle.
#[inline(always)]
fn substitute<R: Real, V: Lanes<R>, const H: usize, const N: usize, const UPPER: bool>(
    block: &[[V; H]; BLOCK],
    scale: [V; H],
    columns: [&mut [R]; N],
) {
    let mut y = [[V::splat(R::zero()); H]; N];
    for (y, column) in y.iter_mut().zip(&columns) {
        *y = begin(column);
        if UPPER {
            *y = scaled(*y, scale);
        }
    }
    for i in 0..BLOCK {
        let p = if UPPER { BLOCK - 1 - i } else { i };
        let Some(column) = block.get(p) else { return };
        for y in &mut y {
            let x = y.get(p / V::WIDTH).map_or(R::NAN, |y| y.row(p % V::WIDTH));
            for (y, l) in y.iter_mut().zip(column) {
                *y = y.minus_product(*l, V::splat(x));
            }
        }
    }
    for (y, column) in y.into_iter().zip(columns) {
        store(y, column);
    }
}

/// `−scale · y`.
#[inline(always)]
fn scaled<R: Real, V: Lanes<R>, const H: usize>(y: [V; H], scale: [V; H]) -> [V; H] {
    let mut out = [V::splat(R::zero()); H];
    for ((out, y), scale) in out.iter_mut().zip(y).zip(scale) {
        *out = out.minus_product(y, scale);
    }
    out
}

/// Rows `k ..` of at most [`BLOCK`] columns, `width` of each; 0 where there are fewer.
#[inline(always)]
fn triangle_of<R: Real>(columns: &[R], ld: usize, k: usize, width: usize) -> [[R; BLOCK]; BLOCK] {
    let column = |p: usize| lanes(part(columns.get(p * ld..).unwrap_or(&[]), k, width), R::zero());
    [column(0), column(1), column(2), column(3), column(4), column(5), column(6), column(7)]
}

/// Solves Uᵀ Lᵀ x = b in place with the factors of order `n`: eight scalar products at a time.
#[inline(always)]
pub(super) fn solve_transposed<R: Real, V: Lanes<R>>(lu: &[R], ld: usize, n: usize, b: &mut [R]) {
    for k in (0..n).step_by(BLOCK) {
        let width = (n - k).min(BLOCK);
        let columns = part(lu, k * ld, width * ld);
        let known = products::<R, V>(columns, ld, 0, part(b, 0, k));
        let (u, mut x) = (triangle_of(columns, ld, k, width), lanes(part(b, k, width), R::zero()));
        let mut inverses = [R::one(); BLOCK];
        for (p, (inverse, u)) in inverses.iter_mut().zip(&u).enumerate() {
            *inverse = if p < width { at(u, p) } else { R::one() };
        }
        let inverses = inverses.map(|pivot| R::one() / pivot);
        // Of each sum the product that is known last comes last, so that little waits for it.
        for c in 0..BLOCK {
            let mut sum = at(&x, c) - at(&known, c);
            for p in 0..c {
                sum -= at(&x, p) * u.get(c).map_or(R::NAN, |u| at(u, p));
            }
            put(&mut x, c, sum * at(&inverses, c));
        }
        put_lanes(x, part_mut(b, k, width));
    }
    for k in (0..n).step_by(BLOCK).rev() {
        let width = (n - k).min(BLOCK);
        let columns = part(lu, k * ld, width * ld);
        let known = products::<R, V>(columns, ld, k + width, part(b, k + width, n - k - width));
        let (l, mut x) = (triangle_of(columns, ld, k, width), lanes(part(b, k, width), R::zero()));
        for i in 0..BLOCK {
            let c = BLOCK - 1 - i;
            let mut sum = at(&x, c) - at(&known, c);
            for j in 0..i {
                let p = BLOCK - 1 - j;
                sum -= at(&x, p) * l.get(c).map_or(R::NAN, |l| at(l, p));
            }
            put(&mut x, c, sum);
        }
        put_lanes(x, part_mut(b, k, width));
    }
}

/// Scalar products of `y` with the rows from `row` on of at most [`BLOCK`] columns; anything for missing ones.
#[inline(always)]
fn products<R: Real, V: Lanes<R>>(columns: &[R], ld: usize, row: usize, y: &[R]) -> [R; BLOCK] {
    // The first column takes the place of missing ones.
    let first = part(columns, row, y.len());
    let side = |c: usize| match part(columns, c * ld + row, y.len()) {
        [] => first,
        side => side,
    };
    let [a, b, c, d] = four_products::<R, V>(y, [side(0), side(1), side(2), side(3)]);
    let [e, f, g, h] = four_products::<R, V>(y, [side(4), side(5), side(6), side(7)]);
    [a, b, c, d, e, f, g, h]
}

#[inline(always)]
fn four_products<R: Real, V: Lanes<R>>(y: &[R], [a, b, c, d]: [&[R]; 4]) -> [R; 4] {
    let zero = V::splat(R::zero());
    let (mut p, mut q, mut r, mut s) = (zero, zero, zero, zero);
    let [mut y, mut a, mut b, mut c, mut d] = [y, a, b, c, d].map(|x| x.chunks_exact(V::WIDTH));
    for ((((y, a), b), c), d) in y.by_ref().zip(a.by_ref()).zip(b.by_ref()).zip(c.by_ref()).zip(d.by_ref()) {
        let y = V::begin(y);
        p = p.minus_product(V::begin(a), y);
        q = q.minus_product(V::begin(b), y);
        r = r.minus_product(V::begin(c), y);
        s = s.minus_product(V::begin(d), y);
    }
    if !y.remainder().is_empty() {
        let y = V::begin(y.remainder());
        p = p.minus_product(V::begin(a.remainder()), y);
        q = q.minus_product(V::begin(b.remainder()), y);
        r = r.minus_product(V::begin(c.remainder()), y);
        s = s.minus_product(V::begin(d.remainder()), y);
    }
    [-p.sum(), -q.sum(), -r.sum(), -s.sum()]
}
