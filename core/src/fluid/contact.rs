//! Which boundaries of a scene touch: the smallest gap, overlap, misplacement, and motion that could have jumped across.
//!
//! Tested by `tests/bad_input`, `tests/driving`, `tests/extremes`.

use crate::base::complex::{cabs, complex};
use crate::base::memory::{at, copy};
use crate::base::scalar::Real;
use crate::base::status::Place;
use crate::fluid::clearance::{Motion, between_ellipses, encloses, gap, meet, touching};
use crate::fluid::gap::{Placed, apart, closest_nodes};
use crate::geometry::pose::Poses;
use crate::model::Model;

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
            let distance = gap(&a, &b, model.store);
            if distance < best.distance {
                best = Gap { distance, between: Some((model.place(i), model.place(j))) };
            }
        }
    }
    best
}

/// Whether two outlines clearly come no closer than `limit` on their way: the outlines are nowhere farther from their nodes than half a
/// spacing, and move no farther than `travel`; or two ellipses do not reach each other along the line of their closest nodes.
/// O(N_i N_j).
fn clear<R: Real>(
    a: &Placed<'_, R>,
    b: &Placed<'_, R>,
    motions: [Motion<R>; 2],
    store: &[R],
    [travel, limit]: [R; 2],
) -> bool {
    if apart(a, b) > travel + limit {
        return true;
    }
    let (square, i, k) = closest_nodes(a, b);
    let node = |p: &Placed<'_, R>, k: usize| p.pose.place(complex(at(p.nodes.x, k), at(p.nodes.y, k)));
    square.sqrt() - R::HALF * (a.record.spacing + b.record.spacing) > travel + limit
        || between_ellipses([a, b], motions, store, node(b, k) - node(a, i)) > limit
}

/// The first pair that touches or crosses, if any, and its gap.
pub(crate) fn first_contact<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place, R)> {
    pairs(model, poses).find_map(|(i, j, a, b)| {
        let limit = touching(&a, &b);
        let rest = [Motion::default(); 2];
        if clear(&a, &b, rest, model.store, [R::zero(), limit]) || !meet(&a, &b, None, model.store, limit) {
            None
        } else {
            Some((model.place(i), model.place(j), gap(&a, &b, model.store)))
        }
    })
}

/// The first pair of which one is inside the other where it should not be (or a body outside the tank), if any.
/// Needed once, at the start: later the outlines would have to cross first.
pub(crate) fn first_misplaced<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place)> {
    let all = || model.each_boundary().map(|(i, record, nodes)| (i, Placed { record, nodes, pose: poses.get(i) }));
    for (i, a) in all() {
        // A point of `a` is where `a` is: within its reach.
        for (j, b) in all().filter(|(j, b)| *j != i && apart(&a, b) <= R::zero()) {
            let z = b.pose.unturned(a.point(model.store, R::zero()) - b.pose.origin);
            let inside = cabs(z) <= b.record.reach && encloses(&b, model.store, z);
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
            if gap(&a, &b, model.store) <= R::zero() {
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

/// The pair that met on the way from an anchor to placements and coordinates, each body at constant linear and angular
/// velocity, if any.
pub(crate) fn swept_contact<'a, R: Real>(
    model: &Model<'a, R>,
    anchor: &'a [R],
    to: Poses<'_, R>,
    q: &[R],
) -> Option<(Place, Place)> {
    let headings = 4 * model.boundaries.len();
    let motion = |a: &Placed<'_, R>, i: usize| Motion {
        shift: to.get(i).origin - a.pose.origin,
        turn: a.record.link.map_or(R::zero(), |link| at(q, 3 * link + 2) - at(anchor, headings + link)),
    };
    let met = pairs(model, Poses(anchor)).find(|(i, j, a, b)| {
        let motions = [motion(a, *i), motion(b, *j)];
        let travel = |m: &Motion<R>, reach: R| cabs(m.shift) + m.turn.abs() * reach;
        let [ma, mb] = &motions;
        let length = travel(ma, a.record.reach) + travel(mb, b.record.reach);
        let limit = touching(a, b);
        !clear(a, b, motions, model.store, [length, limit]) && meet(a, b, Some(motions), model.store, limit)
    });
    met.map(|(i, j, _, _)| (model.place(i), model.place(j)))
}
