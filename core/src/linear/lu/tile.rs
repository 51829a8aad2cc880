//! The one register tile of the factorization, C ← C − A B, for a machine's own vectors.
//!
//! Everything here is safe and inlined into the entry points of [`super::kernel`], which choose the vector type.
//! Matrices are column-major with leading dimension `ld`.

use super::rows::Rows;
use crate::base::machine::Lanes;
use crate::base::memory::{part, part_mut};
use crate::base::scalar::Real;

/// Columns of a tile.
pub(super) const COLUMNS: usize = 4;

/// Depth of a product from which on its tiles are worth fetching ahead.
const FAR: usize = 64;

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
                    V::prefetch(column.get(rows.to + i * V::WIDTH..).unwrap_or(&[]));
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
pub(super) fn halves<R>(columns: &mut [R]) -> (&mut [R], &mut [R]) {
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
pub(super) fn begin<R: Real, V: Lanes<R>, const M: usize>(from: &[R]) -> [V; M] {
    let mut rows = [V::splat(R::zero()); M];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = V::begin(from.get(i * V::WIDTH..).unwrap_or(&[]));
    }
    rows
}

#[inline(always)]
pub(super) fn store<R: Real, V: Lanes<R>, const M: usize>(rows: [V; M], to: &mut [R]) {
    for (i, row) in rows.into_iter().enumerate() {
        row.store(to.get_mut(i * V::WIDTH..).unwrap_or(&mut []));
    }
}
