//! Factorization of large matrices by faer (feature `faer`), in the layout of [`crate::lu`].
//!
//! Everything lives in the caller's matrix and on the stack; faer itself allocates once per thread, at its first
//! product.

use crate::lu::{Factors, check_pivots};
use crate::scalar::Real;
use crate::status::{Result, Status};
use crate::workspace::{at, part_mut};
use core::mem::MaybeUninit;
use faer::dyn_stack::MemStack;
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::{MatMut, Par};

/// Below this order the library's own elimination is used.
const FROM: usize = 96;
/// Largest order whose permutation is kept on the stack.
const TO: usize = 4096;

/// Factorizes as [`crate::lu::factor`] does; `None` when the order is outside faer's range here.
pub(crate) fn factor<R: Real + faer::traits::ComplexField>(
    a: &mut [R],
    ld: usize,
    n: usize,
    pivots: &mut [R],
) -> Option<Result<R>> {
    if !(FROM..=TO).contains(&n) || ld < n {
        return None;
    }
    let (mut order, mut inverse) = ([0u32; TO], [0u32; TO]);
    let (order, inverse) = (part_mut(&mut order, 0, n), part_mut(&mut inverse, 0, n));
    let mut scratch = [MaybeUninit::<u8>::uninit(); 8 * TO];
    let need = lu_in_place_scratch::<u32, R>(n, n, Par::Seq, Default::default());
    if need.unaligned_bytes_required() > scratch.len() {
        return None;
    }
    let (matrix, columns) = a.split_at_mut_checked(n * ld)?;
    let view = MatMut::from_column_major_slice_with_stride_mut(matrix, n, n, ld);
    lu_in_place(view, order, inverse, Par::Seq, MemStack::new(&mut scratch), Default::default());
    exchanges(order, inverse, pivots);
    let (mut smallest, mut largest) = (R::MAX, <R as num_traits::Zero>::zero());
    for (c, u) in matrix.chunks_exact(ld).enumerate() {
        let size = Real::abs(at(u, c));
        if Real::is_nan(size) {
            return Some(Err(Status::Singular.into()));
        }
        (smallest, largest) = (Real::min(smallest, size), Real::max(largest, size));
    }
    let factors = Factors { lu: matrix, ld, pivots };
    for column in columns.chunks_exact_mut(ld) {
        factors.forward(column);
    }
    Some(check_pivots(n, smallest, largest))
}

/// Turns a permutation (row `order[i]` comes to place i) into the exchanges that make it one after the other.
/// `place` is overwritten with where each row is at present.
fn exchanges<R: Real>(order: &mut [u32], place: &mut [u32], pivots: &mut [R]) {
    let n = order.len();
    // Present row at each place, kept in a second array on the stack.
    let mut row = [0u32; TO];
    let row = part_mut(&mut row, 0, n);
    for (k, (p, r)) in place.iter_mut().zip(row.iter_mut()).enumerate() {
        (*p, *r) = (k as u32, k as u32);
    }
    for (i, pivot) in pivots.iter_mut().enumerate().take(n) {
        let wanted = order.get(i).copied().unwrap_or(0);
        let j = place.get(wanted as usize).copied().unwrap_or(0);
        *pivot = R::count(j as usize);
        let moved = row.get(i).copied().unwrap_or(0);
        if let Some(r) = row.get_mut(j as usize) {
            *r = moved;
        }
        if let Some(p) = place.get_mut(moved as usize) {
            *p = j;
        }
        if let Some(r) = row.get_mut(i) {
            *r = wanted;
        }
        if let Some(p) = place.get_mut(wanted as usize) {
            *p = i as u32;
        }
    }
}
