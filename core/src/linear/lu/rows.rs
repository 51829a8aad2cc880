//! What the loops of the factorization share: rows of a product, exchanges.

use crate::base::memory::{at, put};
use crate::base::scalar::Real;

/// Side of a triangle that is solved at once in vectors, and columns that are eliminated together there.
pub(super) const BLOCK: usize = 8;

/// Which rows of the right columns a product C ← C − A B reads (B) and which it changes (C); A is what stands left of C.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    /// First row of C.
    pub(super) to: usize,
    /// Rows of C.
    pub(super) count: usize,
    /// First row of B.
    pub(super) from: usize,
}

#[inline]
pub(super) fn exchange<R: Real>(column: &mut [R], i: usize, j: usize) {
    let (x, y) = (at(column, i), at(column, j));
    put(column, i, y);
    put(column, j, x);
}
