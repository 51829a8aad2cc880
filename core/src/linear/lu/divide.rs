//! Division of a block by the triangle above it, without vectors of a machine's own.

use super::rows::Rows;
use crate::base::memory::{at, part, part_mut};
use crate::base::scalar::Real;

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
