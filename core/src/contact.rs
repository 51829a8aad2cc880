//! Distances between boundaries: the smallest gap, overlap, and motion that could have jumped across.

use crate::boundary::{BoundaryRecord, Nodes};
use crate::model::Model;
use crate::nystrom::{Poses, targets};
use crate::scalar::{Complex, Real, cabs, cis, dot, perp};
use crate::se2::Pose;
use crate::status::Place;
use crate::workspace::{at, copy, part};

/// The smallest distance between two boundaries of which one moves.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gap<R> {
    /// Distance, m; 0 or negative when they touch or overlap; infinite when there is only one boundary.
    pub distance: R,
    /// The two boundaries.
    pub between: Option<(Place, Place)>,
}

/// A gap below this share of the smaller body's size counts as contact.
fn touching<R: Real>() -> R {
    R::lit(1e-6).max(R::lit(64.0) * R::EPSILON)
}

/// Whether the polygon of the nodes encloses `z` (crossing number).
pub(crate) fn encloses<R: Real>(nodes: &Nodes<'_, R>, z: Complex<R>) -> bool {
    let mut inside = false;
    let ends = nodes.points().cycle().skip(1);
    for (a, b) in nodes.points().zip(ends) {
        if (a.im > z.im) != (b.im > z.im) && z.re < a.re + (b.re - a.re) * (z.im - a.im) / (b.im - a.im) {
            inside = !inside;
        }
    }
    inside
}

/// One boundary, placed.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a, R> {
    pub record: &'a BoundaryRecord<R>,
    pub nodes: Nodes<'a, R>,
    pub pose: Pose<R>,
}

impl<R: Real> Placed<'_, R> {
    /// Position, derivatives by t and unit normal into the fluid, in the world's directions about `origin`.
    fn jet(&self, store: &[R], t: R, origin: Complex<R>) -> [Complex<R>; 4] {
        let view = self.record.outline.view(part(store, self.record.store_at, self.record.store_len));
        let [x, d, dd] = view.curve.jet_real(t);
        let x = self.pose.origin - origin + self.pose.turned(x - self.record.origin);
        let (d, dd) = (self.pose.turned(d), self.pose.turned(dd));
        let normal = perp(d) / cabs(d) * self.record.sign;
        [x, d, dd, normal]
    }
}

/// Closest pair of nodes: squared distance and the two nodes. O(N_i N_j).
fn closest_nodes<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> (R, usize, usize) {
    let mut best = (R::MAX, 0, 0);
    for (i, z) in targets(&a.nodes, a.pose, b.pose).enumerate() {
        let distance = |x: &R, y: &R| {
            let (dx, dy) = (*x - z.re, *y - z.im);
            dx * dx + dy * dy
        };
        let row =
            b.nodes.x.iter().zip(b.nodes.y).map(|(x, y)| distance(x, y)).fold(R::MAX, |m, d| if d < m { d } else { m });
        if row < best.0 {
            let k = b.nodes.x.iter().zip(b.nodes.y).position(|(x, y)| distance(x, y) <= row).unwrap_or(0);
            best = (row, i, k);
        }
    }
    best
}

/// Signed gap of two boundaries: negative when the closest points show that they overlap. Closest nodes, then
/// Newton on both outlines.
pub(crate) fn signed_gap<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>, store: &[R]) -> R {
    let (square, i, k) = closest_nodes(a, b);
    let coarse = square.sqrt();
    let origin = a.pose.origin;
    let (mut s, mut t) = (at(a.nodes.t, i), at(b.nodes.t, k));
    let mut best = coarse;
    let mut sign = R::one();
    for _ in 0..12 {
        let ([x, dx, ddx, _], [y, dy, ddy, normal]) = (a.jet(store, s, origin), b.jet(store, t, origin));
        let d = x - y;
        let distance = cabs(d);
        if distance <= best * (R::one() + R::lit(4.0) * R::EPSILON) {
            best = distance;
            sign = if dot(d, normal) < R::zero() { -R::one() } else { R::one() };
        }
        // Gradient and Hessian of |d|²/2; Gauss–Newton where the Hessian is not positive.
        let (gs, gt) = (dot(d, dx), -dot(d, dy));
        let (mut hss, hst, mut htt) = (dot(dx, dx) + dot(d, ddx), -dot(dx, dy), dot(dy, dy) - dot(d, ddy));
        if hss * htt - hst * hst <= R::lit(1e-6) * dot(dx, dx) * dot(dy, dy) || hss <= R::zero() {
            (hss, htt) = (dot(dx, dx) * R::lit(1.01), dot(dy, dy) * R::lit(1.01));
        }
        let det = hss * htt - hst * hst;
        let (mut ds, mut dt) = ((hst * gt - htt * gs) / det, (hst * gs - hss * gt) / det);
        // No further than two nodes at a time.
        let limit = R::TWO * a.nodes.step.max(b.nodes.step);
        let size = ds.abs().max(dt.abs());
        if size > limit {
            (ds, dt) = (ds * limit / size, dt * limit / size);
        }
        if !size.is_finite() || size < R::EPSILON {
            break;
        }
        (s, t) = (s + ds, t + dt);
    }
    best * sign
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

/// A lower bound of the gap from enclosing circles (not for the tank).
fn circles_apart<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> R {
    if a.record.sign > R::zero() || b.record.sign > R::zero() {
        return -R::MAX;
    }
    cabs(a.pose.origin - b.pose.origin) - a.record.reach - b.record.reach
}

fn size<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> R {
    a.record.reach.min(b.record.reach)
}

/// The smallest gap of all pairs of which one moves. O(N²) in the nodes of pairs that are not clearly apart.
pub(crate) fn smallest_gap<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Gap<R> {
    let mut best = Gap { distance: R::one() / R::zero(), between: None };
    for (i, j, a, b) in pairs(model, poses) {
        if circles_apart(&a, &b) < best.distance {
            let distance = signed_gap(&a, &b, model.store);
            if distance < best.distance {
                best = Gap { distance, between: Some((model.place(i), model.place(j))) };
            }
        }
    }
    best
}

/// The first pair that touches or overlaps (within one millionth of the smaller size), if any.
pub(crate) fn first_contact<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place, R)> {
    pairs(model, poses).find_map(|(i, j, a, b)| {
        let limit = touching::<R>() * size(&a, &b);
        if circles_apart(&a, &b) > limit {
            return None;
        }
        let (square, _, _) = closest_nodes(&a, &b);
        let near = a.record.spacing.max(b.record.spacing);
        // Nodes further apart than their spacing: the outlines cannot meet.
        if square > near * near {
            return None;
        }
        let gap = signed_gap(&a, &b, model.store);
        let apart = gap > limit;
        if apart { None } else { Some((model.place(i), model.place(j), gap)) }
    })
}

/// The first pair of which one is inside the other where it should not be (or a body outside the tank), if any.
/// Needed once, at the start: later the outlines would have to cross first.
pub(crate) fn first_misplaced<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>) -> Option<(Place, Place)> {
    let all = || model.each_boundary().map(|(i, record, nodes)| (i, Placed { record, nodes, pose: poses.get(i) }));
    for (i, a) in all() {
        for (j, b) in all().filter(|(j, _)| *j != i) {
            let Some(z) = targets(&a.nodes, a.pose, b.pose).next() else { continue };
            let inside = encloses(&b.nodes, z);
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
    copy(anchor, poses);
    for (heading, q) in anchor.iter_mut().skip(poses.len()).zip(q.chunks_exact(3)) {
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
        if circles_apart(&a, &b) > length {
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
