//! Sums over nodes in eight lanes, which compile to the machine's vectors.

use crate::base::memory::copy_some;
use crate::base::scalar::Real;

/// Lanes of the sums over nodes.
pub(crate) const LANES: usize = 8;

/// Fewest nodes of a boundary.
pub(crate) const LEAST_NODES: usize = 8;
// What fills no vector is done again together with nodes before it.
const _: () = assert!(LANES <= LEAST_NODES);

/// Sum of lanes, by halves.
#[inline(always)]
pub(crate) fn sum_of<R: Real>([a, b, c, d, e, f, g, h]: [R; LANES]) -> R {
    let halves = [a + e, b + f, c + g, d + h];
    let [a, b, c, d] = halves;
    (a + c) + (b + d)
}

/// A vector of lanes; the missing ones are filled.
#[inline(always)]
pub(crate) fn lanes<R: Real>(from: &[R], fill: R) -> [R; LANES] {
    from.first_chunk().copied().unwrap_or_else(|| {
        let mut lanes = [fill; LANES];
        copy_some(&mut lanes, from);
        lanes
    })
}

/// Writes as many lanes as there is room for.
#[inline(always)]
pub(crate) fn put_lanes<R: Real>(lanes: [R; LANES], to: &mut [R]) {
    match to.first_chunk_mut() {
        Some(to) => *to = lanes,
        None => copy_some(to, &lanes),
    }
}
