//! What a configuration adds to the model's own nodes, as it lies in a simulation's memory.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::index::Index;
use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::geometry::grading::{Grading, Ladder};
use crate::geometry::nodes::Nodes;
use crate::model::boundary::BoundaryRecord;

/// Most ladders that a configuration puts on one boundary; the finest are kept.
pub(crate) const MOST_LADDERS: usize = 24;
/// Reals of the ladders of one boundary.
pub(crate) const LADDERS: usize = 3 * MOST_LADDERS;
/// Whole numbers of one boundary: number of its ladders, and of its rungs plus 1 (0: the model's nodes).
pub(crate) const LISTS: usize = 2;
/// Most preimages of one node on one boundary.
pub(crate) const PREIMAGES: usize = 2;
/// Reals of a preimage: tangent, factor, rate. (The node from which it is counted is a whole number.)
pub(crate) const PREIMAGE_REALS: usize = 6;
/// Columns of a boundary's nodes.
pub(crate) const COLUMNS: usize = 8;

/// Rungs that a boundary of `nodes` nodes can use beyond its permanent ones.
pub(crate) fn rung_allowance(nodes: usize) -> usize {
    nodes.max(24)
}

/// A preimage near the real axis, as the pole term of its row needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preimage<R> {
    /// Node j from which x = s* − s_j is counted.
    pub node: usize,
    /// Sign of Im x.
    pub sign: R,
    /// tan(x/2).
    pub tangent: Complex<R>,
    /// (π/N) (−1)^j e^(iσNx/2).
    pub factor: Complex<R>,
    /// dx/dz.
    pub rate: Complex<R>,
    /// The root of the curve is t_j + u with this u; NaN where it was read from memory, which does not keep it.
    #[cfg_attr(not(feature = "derivatives"), allow(dead_code))]
    pub offset: Complex<R>,
}

impl<R: Real> Preimage<R> {
    /// From the node plus 1 and the reals.
    #[inline]
    fn read((node, reals): (&R::Index, &[R])) -> Option<Self> {
        match (node.get().checked_sub(1), reals) {
            (Some(node), &[tr, ti, fr, fi, rr, ri]) => Some(Preimage {
                node,
                // Im tan(x/2) has the sign of Im x.
                sign: if ti < R::zero() { -R::one() } else { R::one() },
                tangent: complex(tr, ti),
                factor: complex(fr, fi),
                rate: complex(rr, ri),
                offset: complex(R::NAN, R::NAN),
            }),
            _ => None,
        }
    }

    pub(crate) fn reals(&self) -> [R; PREIMAGE_REALS] {
        let (t, f, r) = (self.tangent, self.factor, self.rate);
        [t.re, t.im, f.re, f.im, r.re, r.im]
    }
}

/// The buffers of the present configuration (all empty: plain).
#[derive(Clone, Copy)]
pub(crate) struct Near<'a, R: Real> {
    pub nodes: &'a [R],
    pub rungs: &'a [R],
    pub lists: &'a [R::Index],
    pub preimage_nodes: &'a [R::Index],
    pub preimages: &'a [R],
    pub unknowns: usize,
}

/// The same, while they are filled.
pub(crate) struct NearMut<'a, R: Real> {
    pub nodes: &'a mut [R],
    pub rungs: &'a mut [R],
    pub lists: &'a mut [R::Index],
    pub ladders: &'a mut [R],
    pub preimage_nodes: &'a mut [R::Index],
    pub preimages: &'a mut [R],
    pub unknowns: usize,
}

impl<'a, R: Real> Near<'a, R> {
    /// Number of rungs of a boundary whose nodes belong to this configuration.
    #[inline]
    pub(crate) fn rungs(&self, boundary: usize) -> Option<usize> {
        if !features::NEAR {
            return None;
        }
        self.lists.get(boundary * LISTS + 1)?.get().checked_sub(1)
    }

    pub(crate) fn nodes(&self, b: &BoundaryRecord<R>) -> Nodes<'a, R> {
        Nodes::read(part(self.nodes, COLUMNS * b.first, COLUMNS * b.nodes), b.nodes)
    }

    pub(crate) fn grading(&self, b: &BoundaryRecord<R>, rungs: usize) -> Grading<'a, R> {
        Grading::read(part(self.rungs, b.slots.rungs_at, b.slots.rungs_len), rungs)
    }

    #[inline]
    pub(crate) fn preimages(&self, source: usize, row: usize) -> impl Iterator<Item = Preimage<R>> + use<'a, R> {
        let first = (source * self.unknowns + row) * PREIMAGES;
        let nodes = self.preimage_nodes.get(first..first + PREIMAGES).unwrap_or(&[]);
        let reals = self.preimages.get(first * PREIMAGE_REALS..).unwrap_or(&[]);
        nodes.iter().zip(reals.as_chunks::<PREIMAGE_REALS>().0.iter().map(|x| &x[..])).map_while(Preimage::read)
    }
}

/// Ladders on the boundaries, as many as each may have, and how many they are.
pub(crate) struct LadderLists<'a, R: Real> {
    pub lists: &'a mut [R::Index],
    pub ladders: &'a mut [R],
}

impl<R: Real> LadderLists<'_, R> {
    /// Number of ladders of a boundary, those ladders, and room for all it may have.
    pub(crate) fn of(&mut self, boundary: usize) -> Option<(&mut R::Index, &mut [[R; 3]])> {
        let count = self.lists.get_mut(boundary * LISTS)?;
        let ladders = self.ladders.get_mut(boundary * LADDERS..(boundary + 1) * LADDERS)?;
        Some((count, ladders.as_chunks_mut::<3>().0))
    }

    /// Empties all lists; no boundary has rungs of its own.
    pub(crate) fn clear(&mut self) {
        self.lists.fill(R::Index::of(0));
    }
}

/// Ladders in the list of a boundary.
pub(crate) fn listed<'a, R: Real>(
    lists: &[R::Index],
    ladders: &'a [R],
    boundary: usize,
) -> impl Iterator<Item = Ladder<R>> + use<'a, R> {
    let count = lists.get(boundary * LISTS).map_or(0, |n| n.get());
    let ladders = part(ladders, boundary * LADDERS, 3 * count);
    ladders.as_chunks::<3>().0.iter().map(|&[t, beta, top]| Ladder { t, beta, top })
}
