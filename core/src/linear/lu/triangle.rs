//! Solves with triangles of at most eight rows, and with the transposed factors, for a machine's own vectors.

use super::rows::BLOCK;
use super::tile::{COLUMNS, begin, halves, store};
use crate::base::lanes::{lanes, put_lanes};
use crate::base::machine::Lanes;
use crate::base::memory::{at, part, part_mut, put};
use crate::base::scalar::Real;

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
        // There may be fewer columns than a block has.
        let from = left.get(p * ld + k..p * ld + k + width).unwrap_or(&[]);
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
    let column = |p: usize| lanes(columns.get(p * ld + k..p * ld + k + width).unwrap_or(&[]), R::zero());
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
    let side = |c: usize| columns.get(c * ld + row..c * ld + row + y.len()).unwrap_or(first);
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
