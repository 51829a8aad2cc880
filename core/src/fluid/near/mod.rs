//! What boundaries that come close to each other (or to themselves) need beyond fixed nodes and the trapezoidal rule:
//! ladders at closest points and at tips and corners ([`ladders`]) → nodes of this configuration ([`regrade`]) → complex
//! preimages of nodes on the other boundaries ([`preimage`]) → the closed-form pole term of the quadrature ([`pole`]).
//!
//! All of it lives in a simulation's memory, in four buffers; a scene that is plain, or has one boundary, has none.

mod ellipse;
pub(crate) mod ladders;
pub(crate) mod pole;
pub(crate) mod preimage;
pub(crate) mod regrade;
mod search;

use crate::base::features;
use crate::base::memory::{at, part};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::fluid::configuration::Poses;
use crate::geometry::grading::Grading;
use crate::model::Model;
use crate::model::boundary::{BoundaryRecord, Nodes};
pub(crate) use preimage::Preimage;

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
        Grading::read(part(self.rungs, b.rungs_at, b.rungs_len), rungs)
    }

    #[inline]
    pub(crate) fn preimages(&self, source: usize, row: usize) -> impl Iterator<Item = Preimage<R>> + use<'a, R> {
        let all = part(self.preimages, (source * self.unknowns + row) * PREIMAGES, PREIMAGES);
        all.chunks_exact(Preimage::<R>::REALS).map_while(Preimage::read)
    }
}

impl<R: Real> NearMut<'_, R> {
    /// Places ladders and nodes for this configuration and finds every preimage that needs a pole term.
    ///
    /// # Errors
    /// `Internal` if a node could not be placed to rounding.
    pub(crate) fn prepare_here(&mut self, model: &Model<'_, R>, poses: Poses<'_, R>) -> Result<()> {
        if !features::NEAR || self.ladders.is_empty() {
            return Ok(());
        }
        ladders::place(model, poses, self.ladders);
        regrade::regrade(model, self)?;
        preimage::find_all(model, poses, self);
        Ok(())
    }
}

/// Number of ladders in a list.
pub(crate) fn ladder_count<R: Real>(list: &[R]) -> usize {
    at(list, 0).to_f64() as usize
}
