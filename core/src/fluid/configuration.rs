//! One configuration of a scene as an evaluation sees it: where every boundary is and which nodes it has.

use crate::base::complex::{Complex, complex};
use crate::base::memory::{copy, part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::near::{Near, Preimage};
use crate::geometry::curve::OutlineView;
use crate::geometry::pose::Pose;
use crate::model::Model;
use crate::model::boundary::{BoundaryRecord, Nodes};

/// Placements of all boundaries, kept as four reals each.
#[derive(Clone, Copy)]
pub(crate) struct Poses<'a, R>(pub &'a [R]);

impl<R: Real> Poses<'_, R> {
    #[inline]
    pub(crate) fn get(&self, boundary: usize) -> Pose<R> {
        match part(self.0, 4 * boundary, 4) {
            &[x, y, c, s] => Pose { origin: complex(x, y), turn: complex(c, s) },
            _ => Pose::default(),
        }
    }
}

/// Writes a placement.
pub(crate) fn put_pose<R: Real>(poses: &mut [R], boundary: usize, pose: &Pose<R>) {
    let values = [pose.origin.re, pose.origin.im, pose.turn.re, pose.turn.im];
    copy(part_mut(poses, 4 * boundary, 4), &values);
}

/// Turn and shift from one boundary's frame to another's.
#[inline]
pub(crate) fn relative<R: Real>(pose: Pose<R>, source: Pose<R>) -> (Complex<R>, Complex<R>) {
    (source.unturned(pose.turn), source.unturned(pose.origin - source.origin))
}

/// Nodes of one boundary in another's frame: z = conj(turn_j)(r_i − r_j + turn_i X). Differences of origins are
/// taken first, so a scene far from the world's origin loses no digits.
#[inline]
pub(crate) fn targets<'a, R: Real>(
    nodes: &'a Nodes<'a, R>,
    pose: Pose<R>,
    source: Pose<R>,
) -> impl Iterator<Item = Complex<R>> + 'a {
    let (turn, shift) = relative(pose, source);
    nodes.points().map(move |x| shift + turn * x)
}

/// Writes the nodes of one boundary in another's frame.
pub(crate) fn fill_targets<R: Real>(nodes: &Nodes<'_, R>, pose: Pose<R>, source: Pose<R>, zx: &mut [R], zy: &mut [R]) {
    for ((x, y), z) in zx.iter_mut().zip(zy).zip(targets(nodes, pose, source)) {
        (*x, *y) = (z.re, z.im);
    }
}

/// Model, placements, and what near contact added to the model's own nodes.
#[derive(Clone, Copy)]
pub(crate) struct Configuration<'a, R> {
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
