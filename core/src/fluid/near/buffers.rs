//! What a configuration adds to the model's own nodes, as it lies in a simulation's memory.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::memory::{at, part};
use crate::base::scalar::Real;
use crate::geometry::grading::Grading;
use crate::geometry::nodes::Nodes;
use crate::model::boundary::BoundaryRecord;

/// Most ladders that a configuration puts on one boundary; the finest are kept.
pub(crate) const MOST_LADDERS: usize = 24;
/// Reals of the ladder list of one boundary: number of ladders, number of rungs (−1: the model's nodes), ladders.
pub(crate) const LADDER_LIST: usize = 2 + 3 * MOST_LADDERS;
/// Reals of the preimages of one node on one boundary.
pub(crate) const PREIMAGES: usize = 2 * Preimage::<f64>::REALS;
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
}

impl<R: Real> Preimage<R> {
    /// Reals that hold one: σ (node + 1) (0: none), tangent, factor, rate.
    pub(crate) const REALS: usize = 7;

    #[inline]
    pub(crate) fn read(data: &[R]) -> Option<Self> {
        match data {
            &[node, tr, ti, fr, fi, rr, ri] if node != R::zero() => Some(Preimage {
                node: node.abs().to_f64() as usize - 1,
                sign: if node < R::zero() { -R::one() } else { R::one() },
                tangent: complex(tr, ti),
                factor: complex(fr, fi),
                rate: complex(rr, ri),
            }),
            _ => None,
        }
    }

    pub(crate) fn reals(&self) -> [R; 7] {
        let (t, f, r) = (self.tangent, self.factor, self.rate);
        [self.sign * R::count(self.node + 1), t.re, t.im, f.re, f.im, r.re, r.im]
    }
}

/// The buffers of the present configuration (all empty: plain).
#[derive(Clone, Copy)]
pub(crate) struct Near<'a, R> {
    pub nodes: &'a [R],
    pub rungs: &'a [R],
    pub ladders: &'a [R],
    pub preimages: &'a [R],
    pub unknowns: usize,
}

/// The same, while they are filled.
pub(crate) struct NearMut<'a, R> {
    pub nodes: &'a mut [R],
    pub rungs: &'a mut [R],
    pub ladders: &'a mut [R],
    pub preimages: &'a mut [R],
    pub unknowns: usize,
}

impl<'a, R: Real> Near<'a, R> {
    /// Number of rungs of a boundary whose nodes belong to this configuration.
    #[inline]
    pub(crate) fn rungs(&self, boundary: usize) -> Option<usize> {
        let count = self.ladders.get(boundary * LADDER_LIST + 1).copied()?;
        (features::NEAR && count >= R::zero()).then(|| count.to_f64() as usize)
    }

    pub(crate) fn nodes(&self, b: &BoundaryRecord<R>) -> Nodes<'a, R> {
        Nodes::read(part(self.nodes, COLUMNS * b.first, COLUMNS * b.nodes), b.nodes)
    }

    pub(crate) fn grading(&self, b: &BoundaryRecord<R>, rungs: usize) -> Grading<'a, R> {
        Grading::read(part(self.rungs, b.slots.rungs_at, b.slots.rungs_len), rungs)
    }

    #[inline]
    pub(crate) fn preimages(&self, source: usize, row: usize) -> impl Iterator<Item = Preimage<R>> + use<'a, R> {
        let all = part(self.preimages, (source * self.unknowns + row) * PREIMAGES, PREIMAGES);
        all.chunks_exact(Preimage::<R>::REALS).map_while(Preimage::read)
    }
}

/// Number of ladders in a list.
pub(crate) fn ladder_count<R: Real>(list: &[R]) -> usize {
    at(list, 0).to_f64() as usize
}
