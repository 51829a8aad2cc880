//! Closest points of two outlines: closest nodes, then Newton's method on both curves.
//!
//! Tested by `tests/near_contact`, `tests/bad_input`, `tests/walls`.

use crate::base::complex::{Complex, cabs, complex, dot, perp};
use crate::base::lanes::LANES;
use crate::base::machine::{Machine, Task};
use crate::base::memory::at;
use crate::base::scalar::Real;
use crate::geometry::nodes::{Nodes, targets};
use crate::geometry::pose::Pose;
use crate::model::boundary::BoundaryRecord;

/// One boundary, placed.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a, R> {
    pub record: &'a BoundaryRecord<R>,
    pub nodes: Nodes<'a, R>,
    pub pose: Pose<R>,
}

impl<R: Real> Placed<'_, R> {
    /// Position, derivatives by t and unit normal into the fluid, in the world's directions about `origin`.
    pub(crate) fn jet(&self, store: &[R], t: R, origin: Complex<R>) -> [Complex<R>; 4] {
        let [x, d, dd] = self.record.view(store).curve.jet_real(t);
        let x = self.pose.origin - origin + self.pose.turned(x - self.record.origin);
        let (d, dd) = (self.pose.turned(d), self.pose.turned(dd));
        let normal = perp(d) / cabs(d) * self.record.sign;
        [x, d, dd, normal]
    }

    /// A point of the outline, in the world.
    pub(crate) fn point(&self, store: &[R], t: R) -> Complex<R> {
        self.pose.place(self.record.view(store).curve.jet_real(t)[0] - self.record.origin)
    }
}

/// Squared distance of z (in the boundary's frame) to its closest node, in eight lanes so that it vectorizes.
#[inline(always)]
fn square_to<R: Real>(nodes: &Nodes<'_, R>, z: Complex<R>) -> R {
    let nearer = |mut best: [R; LANES], x: [R; LANES], y: [R; LANES]| {
        for ((best, x), y) in best.iter_mut().zip(x).zip(y) {
            let (dx, dy) = (x - z.re, y - z.im);
            let d = dx * dx + dy * dy;
            *best = if d < *best { d } else { *best };
        }
        best
    };
    let (x, y) = (nodes.x.as_chunks().0, nodes.y.as_chunks().0);
    let mut best = x.iter().zip(y).fold([R::MAX; LANES], |best, (x, y)| nearer(best, *x, *y));
    // What is left, together with some that were there already: no boundary has fewer nodes than lanes.
    if !nodes.x.len().is_multiple_of(LANES)
        && let (Some(x), Some(y)) = (nodes.x.last_chunk(), nodes.y.last_chunk())
    {
        best = nearer(best, *x, *y);
    }
    best.iter().fold(R::MAX, |m, d| if *d < m { *d } else { m })
}

/// The node of which that is the distance.
fn node_at<R: Real>(nodes: &Nodes<'_, R>, z: Complex<R>, square: R) -> usize {
    let is = |(x, y): (&R, &R)| {
        let (dx, dy) = (*x - z.re, *y - z.im);
        dx * dx + dy * dy <= square
    };
    nodes.x.iter().zip(nodes.y).position(is).unwrap_or(0)
}

/// Parameters and distance of the closest points of two outlines: up to three local minima, from those of the nodes'
/// distances by Newton's method. O(N_i N_j).
pub(crate) fn closest_points<R: Real>(
    a: &Placed<'_, R>,
    b: &Placed<'_, R>,
    store: &[R],
    mut visit: impl FnMut(R, R, R),
) {
    let mut minima = [(R::MAX, 0, 0); 3];
    let z = |i: usize| {
        let x = complex(at(a.nodes.x, i), at(a.nodes.y, i));
        let (turn, shift) = (b.pose.unturned(a.pose.turn), b.pose.unturned(a.pose.origin - b.pose.origin));
        shift + turn * x
    };
    let n = a.nodes.x.len();
    let (mut before, mut here) = (square_to(&b.nodes, z(n.saturating_sub(1))), square_to(&b.nodes, z(0)));
    for i in 0..n {
        let next = square_to(&b.nodes, z(if i + 1 == n { 0 } else { i + 1 }));
        if here <= next && here < before {
            let mut candidate = (here, i, node_at(&b.nodes, z(i), here));
            for slot in minima.iter_mut() {
                if candidate.0 < slot.0 {
                    core::mem::swap(slot, &mut candidate);
                }
            }
        }
        (before, here) = (here, next);
    }
    for (square, i, k) in minima {
        if square < R::MAX {
            let (s, t, distance, _) = refine(a, b, store, at(a.nodes.t, i), at(b.nodes.t, k), square.sqrt(), false);
            visit(s, t, distance);
        }
    }
}

/// Parameter of the point of an outline closest to x (in the world), and its distance. O(N).
pub(crate) fn foot<R: Real>(b: &Placed<'_, R>, store: &[R], x: Complex<R>) -> (R, R) {
    let z = b.pose.unturned(x - b.pose.origin);
    let square = square_to(&b.nodes, z);
    let start = at(b.nodes.t, node_at(&b.nodes, z, square));
    let (mut best, mut t) = ((square.sqrt(), start), start);
    let curve = b.record.view(store).curve;
    for _ in 0..8 {
        let [y, d, dd] = curve.jet_real(t);
        let away = y - b.record.origin - z;
        let distance = cabs(away);
        if distance <= best.0 {
            best = (distance, t);
        }
        let (slope, square) = (dot(away, d), dot(d, d));
        let bend = (square + dot(away, dd)).max(square * R::lit(0.1));
        let step = -slope / bend;
        if !step.is_finite() || step.abs() < R::EPSILON.sqrt() * R::lit(1e-2) {
            break;
        }
        t += step.max(-b.nodes.step).min(b.nodes.step);
    }
    (best.1, best.0)
}

/// Closest pair of nodes: squared distance and the two nodes. O(N_i N_j).
pub(crate) fn closest_nodes<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> (R, usize, usize) {
    let mut best = (R::MAX, 0);
    Machine::here().run(Closest { a, b, best: &mut best });
    let (square, i) = best;
    let z = targets(&a.nodes, a.pose, b.pose).nth(i).unwrap_or_default();
    (square, i, node_at(&b.nodes, z, square))
}

/// Squared distance of the closest pair of nodes, and the node of `a`.
struct Closest<'a, 'b, R> {
    a: &'b Placed<'a, R>,
    b: &'b Placed<'a, R>,
    best: &'b mut (R, usize),
}

impl<R: Real> Task for Closest<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        for (i, z) in targets(&self.a.nodes, self.a.pose, self.b.pose).enumerate() {
            let row = square_to(&self.b.nodes, z);
            if row < self.best.0 {
                *self.best = (row, i);
            }
        }
    }
}

/// Newton's method on both outlines from the parameters (s, t) at distance `coarse`: parameters, distance, and −1 if the
/// closest points show that the outlines overlap, else 1. No point farther apart than `coarse` is accepted, but for the
/// depth of outlines that are known to cross.
///
/// Solved is x'(s)·n(t) = 0 and (x − y)·y'(t) = 0 with n the normal of the second outline, which does not degenerate as
/// the distance vanishes and continues to the deepest point of a slight overlap.
pub(crate) fn refine<R: Real>(
    a: &Placed<'_, R>,
    b: &Placed<'_, R>,
    store: &[R],
    mut s: R,
    mut t: R,
    coarse: R,
    crossing: bool,
) -> (R, R, R, R) {
    let origin = a.pose.origin;
    let limit = R::TWO * a.nodes.step.max(b.nodes.step);
    // The closest pair seen, in case Newton's method does not settle.
    let mut best = (s, t, coarse, R::one());
    for _ in 0..24 {
        let ([x, dx, ddx, _], [y, dy, ddy, normal]) = (a.jet(store, s, origin), b.jet(store, t, origin));
        let d = x - y;
        let (distance, depth) = (cabs(d), dot(d, normal));
        if distance <= best.2 * (R::one() + R::lit(4.0) * R::EPSILON) {
            best = (s, t, distance, if depth < R::zero() { -R::one() } else { R::one() });
        }
        let (square, own) = (dot(dy, dy), dot(dx, dx));
        // n' = −σκ|y'| τ = (n·y'')/|y'|² · (−y')
        let bend = dot(normal, ddy) / square;
        let (g, h) = (dot(dx, normal), dot(d, dy));
        let (gs, gt) = (dot(ddx, normal), -bend * dot(dx, dy));
        let (hs, ht) = (dot(dx, dy), (dot(d, ddy) - square).min(R::lit(-0.1) * square));
        // The foot on the second outline follows; what remains is one equation for s, whose slope is positive at a minimum.
        let slope = (gs - gt * hs / ht).max(R::lit(1e-6) * own / a.record.reach);
        let (mut ds, mut dt) = (-(g - gt * h / ht) / slope, R::zero());
        dt -= (h + hs * ds) / ht;
        let size = ds.abs().max(dt.abs());
        if !size.is_finite() {
            break;
        }
        if size > limit {
            (ds, dt) = (ds * limit / size, dt * limit / size);
        }
        (s, t) = (s + ds, t + dt);
        if size < R::EPSILON.sqrt() * R::lit(1e-2) {
            // Converged: the normal distance, which a slight overlap makes negative.
            let ([x, ..], [y, _, _, normal]) = (a.jet(store, s, origin), b.jet(store, t, origin));
            let depth = dot(x - y, normal);
            if depth.abs() <= best.2 * (R::one() + R::lit(1e-3)) || (depth < R::zero() && crossing) {
                best = (s, t, depth.abs(), if depth < R::zero() { -R::one() } else { R::one() });
            }
            break;
        }
    }
    best
}

/// A lower bound of the gap from enclosing circles (not for the tank).
pub(crate) fn apart<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> R {
    if a.record.sign > R::zero() || b.record.sign > R::zero() {
        return -R::MAX;
    }
    cabs(a.pose.origin - b.pose.origin) - a.record.reach - b.record.reach
}
