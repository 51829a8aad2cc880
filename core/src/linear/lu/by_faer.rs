//! The elimination by faer, on several threads (feature `faer`): in place, with the exchanges of rows noted as the own one notes
//! them, so that every solve that follows is the own code.
//!
//! Tested by `linear/lu/tests` against the own elimination, and by `tests/factorization` in whole simulations.

use crate::base::index::Index;
use crate::base::scalar::{Of, Real, Which};
use crate::base::status::{Error, Result, Status};
use alloc::vec::Vec;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::traits::ComplexField;
use faer::{MatMut, Par};

/// Columns from which on faer takes over: fewer are no work for several threads.
pub(super) const SMALLEST: usize = 512;

/// Columns of a matrix.
struct Columns<'a>(core::marker::PhantomData<&'a ()>);
impl<'a> Of for Columns<'a> {
    type With<R: Real> = &'a mut [R];
}

/// Eliminates the columns `block`, which begin at column `k` and end with the matrix, as `eliminate` does. Returns the smallest and
/// the largest pivot, NaN where one is.
///
/// # Errors
/// `OutOfMemory` for the exchanges, 3n whole numbers.
pub(super) fn eliminate<R: Real>(
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
    threads: usize,
) -> Result<(R, R)> {
    if n - k != pivots.len() || block.len() != pivots.len() * ld {
        return Err(Status::Internal.into());
    }
    let corner = block.get_mut(k..).ok_or(Status::Internal)?;
    let order = match R::which::<Columns<'_>>(corner) {
        Which::Double(corner) => decompose(corner, ld, n - k, threads),
        Which::Single(corner) => decompose(corner, ld, n - k, threads),
    }?;
    for (step, row) in order.into_iter().enumerate() {
        let mut row = row;
        // A row that earlier exchanges moved is where the last of them put it.
        while row < step {
            row = pivots.get(row).map_or(usize::MAX, |p| p.get() - k);
        }
        if let Some(pivot) = pivots.get_mut(step) {
            *pivot = R::Index::of(k + row);
        }
    }
    let diagonal = block.iter().skip(k).step_by(ld + 1).map(|pivot| pivot.abs());
    Ok(diagonal.fold((R::MAX, R::zero()), |(least, most), pivot| (least.min(pivot), most.max(pivot))))
}

/// The factors of the m × m matrix `a` in place; for each row of theirs, which row of the matrix it came from.
fn decompose<T: ComplexField>(a: &mut [T], ld: usize, m: usize, threads: usize) -> Result<Vec<usize>> {
    let none = |_| Error::new(Status::OutOfMemory);
    let par = if threads > 1 { Par::rayon(threads) } else { Par::Seq };
    let (mut order, mut inverse) = (Vec::new(), Vec::new());
    for places in [&mut order, &mut inverse] {
        places.try_reserve_exact(m).map_err(none)?;
        places.resize(m, 0usize);
    }
    let need = lu_in_place_scratch::<usize, T>(m, m, par, Default::default());
    let mut memory = MemBuffer::try_new(need).map_err(|_| Error::new(Status::OutOfMemory))?;
    let a = MatMut::from_column_major_slice_with_stride_mut(a, m, m, ld);
    lu_in_place(a, &mut order, &mut inverse, par, MemStack::new(&mut memory), Default::default());
    Ok(order)
}
