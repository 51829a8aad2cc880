//! Which boundaries of a scene touch: the smallest gap, overlap, misplacement, and motion that could have jumped across.

use crate::base::complex::{cabs, cis};
use crate::base::memory::{at, copy};
use crate::base::scalar::Real;
use crate::base::status::Place;
use crate::fluid::gap::{Placed, apart, closest_nodes, encloses, signed_gap, size, touching};
use crate::geometry::nodes::targets;
use crate::geometry::pose::{Pose, Poses};
use crate::model::Model;
use crate::model::boundary::BoundaryRecord;

/// The smallest distance between two boundaries of which one moves.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gap<R> {
    /// Distance, m; 0 or negative when they touch or overlap; infinite when there is only one boundary.
    pub distance: R,
    /// The two boundaries.
    pub between: Option<(Place, Place)>,
}

/// Which pairs are looked at: at least one moves.
fn pairs<'a, R: Real>(
    model: &Model<'a, R>,
    poses: Poses<'a, R>,
) -> impl Iterator<Item = (usize, usize, Placed<'a, R>, Placed<'a, R>)> {
    let model = *model;
    model.each_boundary().flat_map(move |(i, a, a_nodes)| {
        model.each_boundary().skip(i + 1).filter(move |(_, b, _)| a.link.is_some() || b.link.is_some()).map(
            move |(j, b, b_nodes)| {
                let a = Placed { record: a, nodes: a_nodes, pose: poses.get(i) };
                let b = Placed { record: b, nodes: b_nodes, pose: poses.get(j) };
                (i, j, a, b)
            },
        )
    })
}

/// The smallest gap of all pairs of which one moves. O(N²) in the nodes of pairs that are not clearly apart.
pub(crate) fn smallest_gap<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Gap<R> {
    let mut best = Gap { distance: R::one() / R::zero(), between: None };
    for (i, j, a, b) in pairs(model, poses) {
        if apart(&a, &b) < best.distance {
            let distance = signed_gap(&a, &b, model.store);
            if distance < best.distance {
                best = Gap { distance, between: Some((model.place(i), model.place(j))) };
            }
        }
    }
    best
}

/// The first pair that touches or overlaps (within 1e-8 of the smaller size), if any.
pub(crate) fn first_contact<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place, R)> {
    pairs(model, poses).find_map(|(i, j, a, b)| {
        let limit = touching::<R>() * size(&a, &b);
        if apart(&a, &b) > limit {
            return None;
        }
        let (square, _, _) = closest_nodes(&a, &b);
        let near = a.record.spacing.max(b.record.spacing);
        // Nodes further apart than their spacing: the outlines cannot meet.
        if square > near * near {
            return None;
        }
        let gap = signed_gap(&a, &b, model.store);
        let clear = gap > limit;
        if clear { None } else { Some((model.place(i), model.place(j), gap)) }
    })
}

/// The first pair of which one is inside the other where it should not be (or a body outside the tank), if any.
/// Needed once, at the start: later the outlines would have to cross first.
pub(crate) fn first_misplaced<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place)> {
    let all = || model.each_boundary().map(|(i, record, nodes)| (i, Placed { record, nodes, pose: poses.get(i) }));
    for (i, a) in all() {
        // A node of `a` is where `a` is: within its reach.
        for (j, b) in all().filter(|(j, b)| *j != i && apart(&a, b) <= R::zero()) {
            let Some(z) = targets(&a.nodes, a.pose, b.pose).next() else { continue };
            let inside = cabs(z) <= b.record.reach && encloses(&b.nodes, z);
            if b.record.sign > R::zero() && !inside {
                return Some((model.place(i), Place::Tank));
            }
            if b.record.sign < R::zero() && a.record.sign < R::zero() && inside {
                return Some((model.place(i), model.place(j)));
            }
        }
    }
    // Walls among themselves never move; they are checked here once.
    for (i, a) in all().filter(|(_, a)| a.record.link.is_none()) {
        for (j, b) in all().filter(|(j, b)| *j > i && b.record.link.is_none()) {
            let inside_first = a.record.sign > R::zero();
            if signed_gap(&a, &b, model.store) <= R::zero() {
                return Some(if inside_first {
                    (model.place(j), model.place(i))
                } else {
                    (model.place(i), model.place(j))
                });
            }
        }
    }
    None
}

/// Remembers an anchor: placements of all boundaries, then headings of all links (a placement knows no full turns), from
/// their coordinates.
pub(crate) fn set_anchor<R: Real>(anchor: &mut [R], poses: &[R], q: &[R]) {
    let (places, headings) = anchor.split_at_mut_checked(poses.len()).unwrap_or((&mut [], &mut []));
    copy(places, poses);
    for (heading, q) in headings.iter_mut().zip(q.chunks_exact(3)) {
        *heading = at(q, 2);
    }
}

/// Whether a pair could have passed through each other on the way from an anchor to placements and coordinates, each body
/// at constant linear and angular velocity: conservative advancement, each advance no longer than the present gap allows.
pub(crate) fn swept_contact<'a, R: Real>(
    model: &Model<'a, R>,
    anchor: &'a [R],
    to: Poses<'_, R>,
    q: &[R],
) -> Option<(Place, Place)> {
    let headings = 4 * model.boundaries.len();
    let turn_of = |record: &BoundaryRecord<R>| {
        record.link.map_or(R::zero(), |link| at(q, 3 * link + 2) - at(anchor, headings + link))
    };
    for (i, j, a, b) in pairs(model, Poses(anchor)) {
        let (a1, b1) = (to.get(i), to.get(j));
        let (turn_a, turn_b) = (turn_of(a.record), turn_of(b.record));
        let travel = |p: Pose<R>, q: Pose<R>, turn: R, reach: R| cabs(q.origin - p.origin) + turn.abs() * reach;
        let length = travel(a.pose, a1, turn_a, a.record.reach) + travel(b.pose, b1, turn_b, b.record.reach);
        if apart(&a, &b) > length {
            continue;
        }
        let between = |p: Pose<R>, q: Pose<R>, turn: R, x: R| Pose {
            origin: p.origin + (q.origin - p.origin) * x,
            turn: p.turn * cis(turn * x),
        };
        let limit = touching::<R>() * size(&a, &b);
        let mut x = R::zero();
        let mut advances = 0;
        while x < R::one() {
            let pa = Placed { pose: between(a.pose, a1, turn_a, x), ..a };
            let pb = Placed { pose: between(b.pose, b1, turn_b, x), ..b };
            // Nodes are enough here: their distance exceeds the gap by less than a spacing.
            let (square, _, _) = closest_nodes(&pa, &pb);
            let coarse = square.sqrt() - R::HALF * (a.record.spacing + b.record.spacing);
            let gap = if coarse > length * (R::one() - x) { coarse } else { signed_gap(&pa, &pb, model.store) };
            advances += 1;
            if gap <= limit || advances > 200 {
                return Some((model.place(i), model.place(j)));
            }
            if length <= gap {
                break;
            }
            x += gap / length;
        }
    }
    None
}
