//! One configuration of a scene as an evaluation sees it: where every boundary is and which nodes it has.

use crate::base::scalar::Real;
use crate::fluid::near::buffers::{Near, Preimage};
use crate::geometry::curve::OutlineView;
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::{Pose, Poses};
use crate::model::Model;
use crate::model::boundary::BoundaryRecord;

/// Model, placements, and what near contact added to the model's own nodes.
#[derive(Clone, Copy)]
pub(crate) struct Configuration<'a, R: Real> {
    pub model: Model<'a, R>,
    pub poses: Poses<'a, R>,
    pub near: Near<'a, R>,
}

impl<'a, R: Real> Configuration<'a, R> {
    #[inline]
    pub(crate) fn pose(&self, boundary: usize) -> Pose<R> {
        self.poses.get(boundary)
    }

    /// Whether the nodes of a boundary follow this configuration instead of being the model's.
    #[inline]
    pub(crate) fn regraded(&self, boundary: usize) -> bool {
        self.near.rungs(boundary).is_some()
    }

    /// Whether any wall has nodes of this configuration: then the walls' constant block does not hold.
    pub(crate) fn walls_regraded(&self) -> bool {
        (0..self.model.head.plan.walls).any(|i| self.regraded(i))
    }

    #[inline]
    fn nodes_of(&self, i: usize, b: &'a BoundaryRecord<R>) -> Nodes<'a, R> {
        if self.regraded(i) { self.near.nodes(b) } else { b.nodes(self.model.store) }
    }

    pub(crate) fn boundary(&self, i: usize) -> Option<(&'a BoundaryRecord<R>, Nodes<'a, R>)> {
        self.model.boundaries.get(i).map(|b| (b, self.nodes_of(i, b)))
    }

    /// Every boundary with its nodes, in the order of the unknowns.
    pub(crate) fn each_boundary(
        &self,
    ) -> impl Iterator<Item = (usize, &'a BoundaryRecord<R>, Nodes<'a, R>)> + Clone + use<'a, R> {
        let c = *self;
        self.model.boundaries.iter().enumerate().map(move |(i, b)| (i, b, c.nodes_of(i, b)))
    }

    /// Curve of a boundary with the grading that its nodes have here.
    pub(crate) fn outline(&self, i: usize, b: &BoundaryRecord<R>) -> OutlineView<'a, R> {
        let own = b.view(self.model.store);
        self.near.rungs(i).map_or(own, |rungs| OutlineView { grading: self.near.grading(b, rungs), ..own })
    }

    /// Preimages on boundary `source` of the node at unknown `row`, for which the trapezoidal rule needs its pole term.
    #[inline]
    pub(crate) fn preimages(&self, source: usize, row: usize) -> impl Iterator<Item = Preimage<R>> + use<'a, R> {
        self.near.preimages(source, row)
    }
}
