//! How two outlines stand to each other, from the curves themselves: whether they come within a distance, at rest or on
//! their way, their gap, and whether one encloses a point. Nodes have no part in it.
//!
//! An arc of half-width w about the parameter m is γ(m) + γ′(m) u, |u| ≤ w, but for w²/2 times the largest |γ″| on it. The
//! difference of two such arcs on their way, over an interval of time, is a point plus three segments plus what
//! the second derivatives leave: its distance from 0 has a lower bound. Where this does not settle it, that part is halved
//! that takes most from the bound. Halves are dyadic, so the way back is kept as one byte a level, and nothing else.
//!
//! Tested by `tests/contact`, `tests/driving`, `tests/bad_input`.

use crate::base::complex::{Complex, cis, dot, perp};
use crate::base::memory::at;
use crate::base::scalar::Real;
use crate::fluid::gap::{Placed, closest_nodes, refine};
use crate::geometry::curve::{Curve, Spread};

/// Most halvings on the way to a box: more than the digits of two parameters and a time allow.
const LEVELS: usize = 160;
/// Most boxes that one search looks at. Only outlines that follow each other closely all the way round need so many.
const BOXES: usize = 100_000;

/// How a boundary moves from its placement, at constant rates, in the unit of time.
#[derive(Clone, Copy, Default)]
pub(crate) struct Motion<R> {
    /// Displacement of its origin.
    pub shift: Complex<R>,
    /// Angle by which it turns.
    pub turn: R,
}

/// A gap that counts as contact: 1e-8 of the smaller body, but no less than the digits of the larger one tell.
pub(crate) fn touching<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>) -> R {
    let (less, more) = (a.record.reach.min(b.record.reach), a.record.reach.max(b.record.reach));
    (R::lit(1e-8) * less).max(R::lit(64.0) * R::EPSILON * more)
}

fn norm<R: Real>(z: Complex<R>) -> R {
    dot(z, z).sqrt()
}

/// A lower bound of the distance from 0 of c plus the segments ±g, each thickened: along c, and across each segment; and what
/// each of them takes from it. Directions along which c itself is not beyond `limit` cannot help and are left out.
fn apart<R: Real, const N: usize>(c: Complex<R>, parts: [(Complex<R>, R); N], limit: R) -> (R, [R; N]) {
    let mut best = (-R::MAX, parts.map(|(g, off)| norm(g) + off));
    for n in core::iter::once(c).chain(parts.into_iter().map(|(g, _)| perp(g))) {
        let size = norm(n);
        let far = dot(c, n).abs() / size;
        if far > limit {
            let taken = parts.map(|(g, off)| dot(g, n).abs() / size + off);
            let left = taken.iter().fold(far, |left, part| left - *part);
            if left > best.0 {
                best = (left, taken);
            }
        }
    }
    best
}

/// An arc: its middle, half its tangent line, and how far it may be off that.
#[derive(Clone, Copy, Default)]
struct Arc<R> {
    middle: Complex<R>,
    along: Complex<R>,
    off: R,
}

/// A curve with the bounds of its derivatives.
struct Arcs<'a, R> {
    curve: Curve<'a, R>,
    spread: Spread<R>,
    origin: Complex<R>,
}

impl<'a, R: Real> Arcs<'a, R> {
    fn of(placed: &Placed<'_, R>, store: &'a [R]) -> Self {
        let curve = placed.record.view(store).curve;
        Arcs { curve, spread: curve.spread(), origin: placed.record.origin }
    }
    /// The arc about `u` of half-width `w`, both in turns of the parameter.
    fn at(&self, u: R, w: R) -> Arc<R> {
        let (t, w) = (u * R::TAU, w * R::TAU);
        let [x, d, second] = self.curve.jet_real(t);
        let bend = self.curve.bend(&self.spread, t, w, norm(second));
        Arc { middle: x - self.origin, along: d * w, off: bend * w * w * R::HALF }
    }
}

/// Whether the outline encloses `z` (in its frame): crossings of a ray, each arc replaced by its chord where no arc of that
/// kind could lie on both sides of z.
pub(crate) fn encloses<R: Real>(placed: &Placed<'_, R>, store: &[R], z: Complex<R>) -> bool {
    let arcs = Arcs::of(placed, store);
    let end = |u: R| arcs.curve.jet_real(u * R::TAU)[0] - arcs.origin - z;
    let (mut inside, mut done, mut w) = (false, R::zero(), R::HALF);
    let (first, mut a) = (end(R::zero()), end(R::zero()));
    while done < R::one() {
        let arc = arcs.at(done + w, w);
        // On the outline itself, to rounding, either answer is right.
        if apart(arc.middle - z, [(arc.along, arc.off)], R::zero()).0 <= R::zero() && w > R::EPSILON {
            w *= R::HALF;
            continue;
        }
        done += R::TWO * w;
        let b = if done < R::one() { end(done) } else { first };
        let crosses = (a.im > R::zero()) != (b.im > R::zero());
        if crosses && (a.re * b.im > b.re * a.im) == (b.im > a.im) {
            inside = !inside;
        }
        a = b;
        // As wide as the next place allows: places are multiples of widths.
        while (done / (w * R::lit(4.0))).floor() * (w * R::lit(4.0)) == done && w < R::HALF {
            w *= R::TWO;
        }
    }
    inside
}

/// The box that a search looks at: middles and half-widths of both parameters, in turns, and of the time.
struct Walk<R> {
    middle: [R; 3],
    half: [R; 3],
    /// What has changed since it was looked at.
    stale: [bool; 3],
    /// The way here: which part was halved, + 4 if its upper half came first, + 8 in the half that came second.
    way: [u8; LEVELS],
    level: usize,
}

impl<R: Real> Walk<R> {
    fn new(moving: bool) -> Self {
        let time = if moving { R::HALF } else { R::zero() };
        let whole = [R::HALF, R::HALF, time];
        Walk { middle: whole, half: whole, stale: [true; 3], way: [0; LEVELS], level: 0 }
    }

    /// Scales a half-width, then moves the middle by so many of it.
    fn change(&mut self, part: usize, scale: R, by: R) {
        if let (Some(middle), Some(half), Some(stale)) =
            (self.middle.get_mut(part), self.half.get_mut(part), self.stale.get_mut(part))
        {
            // Whole numbers of half-widths: exact, forwards and back.
            *half *= scale.min(R::one());
            *middle += by * *half;
            *half *= scale.max(R::one());
            *stale = true;
        }
    }

    /// Goes to the upper or lower half of a part, if the digits allow.
    fn halve(&mut self, part: usize, upper: bool) -> bool {
        let fine = self.half.get(part).is_none_or(|half| *half <= R::TWO * R::EPSILON);
        let Some(step) = self.way.get_mut(self.level).filter(|_| !fine) else { return false };
        *step = part as u8 + if upper { 4 } else { 0 };
        self.level += 1;
        self.change(part, R::HALF, if upper { R::one() } else { -R::one() });
        true
    }

    /// Goes to the next box that is left, if any.
    fn next(&mut self) -> bool {
        while let Some(level) = self.level.checked_sub(1) {
            let Some(step) = self.way.get_mut(level) else { return false };
            let (part, second) = (usize::from(*step & 3), *step & 8 != 0);
            let back = if *step & 4 != 0 { -R::one() } else { R::one() };
            if !second {
                *step |= 8;
                self.change(part, R::one(), R::TWO * back);
                return true;
            }
            self.change(part, R::TWO, -back);
            self.level = level;
        }
        false
    }
}

/// What a search found: parameters and distance of the closest points it looked at, and whether it came to its end.
struct Found<R> {
    s: R,
    t: R,
    distance: R,
    settled: bool,
}

/// Looks at all pairs of points, at all times if they move, until one is closer than `enough`. Left out are boxes farther
/// than the least distance found times `share` less `digits`.
fn search<R: Real>(
    a: &Placed<'_, R>,
    b: &Placed<'_, R>,
    motions: Option<[Motion<R>; 2]>,
    store: &[R],
    mut found: Found<R>,
    [enough, share, digits]: [R; 3],
) -> Found<R> {
    let (first, second) = (Arcs::of(a, store), Arcs::of(b, store));
    let mut walk = Walk::new(motions.is_some());
    let [ma, mb] = motions.unwrap_or_default();
    let (start, drift) = (a.pose.origin - b.pose.origin, ma.shift - mb.shift);
    let (mut p, mut q) = (Arc::default(), Arc::default());
    let (mut turn_a, mut turn_b) = (a.pose.turn, b.pose.turn);
    for _ in 0..BOXES {
        let ([u, v, time], [half_u, half_v, w]) = (walk.middle, walk.half);
        let [stale_u, stale_v, stale_time] = core::mem::take(&mut walk.stale);
        if stale_u {
            p = first.at(u, half_u);
        }
        if stale_v {
            q = second.at(v, half_v);
        }
        if stale_time && motions.is_some() {
            (turn_a, turn_b) = (a.pose.turn * cis(ma.turn * time), b.pose.turn * cis(mb.turn * time));
        }
        let (x, y, dx, dy) = (turn_a * p.middle, turn_b * q.middle, turn_a * p.along, turn_b * q.along);
        let between = start + drift * time + (x - y);
        let distance = norm(between);
        if distance < found.distance {
            // Much closer: another valley, whose bottom Newton's method knows.
            let valley = motions.is_none() && distance < found.distance * R::lit(0.9);
            found = Found { s: u * R::TAU, t: v * R::TAU, distance, settled: true };
            if valley {
                let (s, t, distance, _) = refine(a, b, store, found.s, found.t, distance, false);
                found = Found { s, t, distance, settled: true };
            }
            if found.distance <= enough {
                return found;
            }
        }
        let moved = (drift + perp(x) * ma.turn - perp(y) * mb.turn) * w;
        // What the second derivatives leave: by each parameter, by time, by a parameter and time.
        let (by_a, by_b) = (ma.turn.abs() * w, mb.turn.abs() * w);
        let (length_a, length_b) = (norm(dx), norm(dy));
        let turned = (by_a * by_a * a.record.reach + by_b * by_b * b.record.reach) * R::HALF
            + by_a * (length_a + R::TWO * p.off)
            + by_b * (length_b + R::TWO * q.off);
        let limit = found.distance * share - digits;
        let (least, [ka, kb, kt]) = apart(between, [(dx, p.off), (dy, q.off), (moved, turned)], limit);
        let mut next = false;
        if least <= limit {
            let (part, way) = match kt > ka.max(kb) {
                true => (2, moved),
                false if kb > ka => (1, -dy),
                false => (0, dx),
            };
            // The closer half first.
            next = walk.halve(part, dot(between, way) < R::zero());
            // Too fine to be told from contact.
            if !next && found.distance <= enough {
                found.distance = R::zero();
                return found;
            }
        }
        if !next && !walk.next() {
            return found;
        }
    }
    found.settled = false;
    found
}

/// Radii of two discs: their distances need no search.
fn discs<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>, store: &[R]) -> Option<[R; 2]> {
    let radius = |p: &Placed<'_, R>| match p.record.view(store).curve {
        Curve::Ellipse(e) if e.a == e.b => Some(e.a),
        _ => None,
    };
    radius(a).zip(radius(b)).map(|(a, b)| [a, b])
}

/// A lower bound of the distance of two ellipses outside each other, on their way through a unit of time, from their extents along a
/// direction, which change by no more than a − b for each radian; of anything else −∞.
pub(crate) fn between_ellipses<R: Real>(
    [a, b]: [&Placed<'_, R>; 2],
    motions: [Motion<R>; 2],
    store: &[R],
    way: Complex<R>,
) -> R {
    let way = way / norm(way);
    // Halfway, and by how much it may be less before and after.
    let extent = |p: &Placed<'_, R>, m: &Motion<R>| match p.record.view(store).curve {
        Curve::Ellipse(e) if p.record.sign < R::zero() => {
            let n = p.pose.unturned(way) * cis(-m.turn * R::HALF);
            Some((e.a * n.re).hypot(e.b * n.im) + (e.a - e.b).abs() * m.turn.abs() * R::HALF)
        }
        _ => None,
    };
    let [ma, mb] = &motions;
    match extent(a, ma).zip(extent(b, mb)) {
        Some((a_extent, b_extent)) => {
            let (start, shift) = (dot(b.pose.origin - a.pose.origin, way), dot(mb.shift - ma.shift, way));
            start.min(start + shift) - a_extent - b_extent
        }
        None => -R::MAX,
    }
}

/// Whether two outlines come within `limit` of each other, at rest or on their way through a unit of time.
pub(crate) fn meet<R: Real>(
    a: &Placed<'_, R>,
    b: &Placed<'_, R>,
    motions: Option<[Motion<R>; 2]>,
    store: &[R],
    limit: R,
) -> bool {
    if let Some([ra, rb]) = discs(a, b, store) {
        let (from, [ma, mb]) = (a.pose.origin - b.pose.origin, motions.unwrap_or_default());
        let way = ma.shift - mb.shift;
        // The distance of the centres takes every value between its least and its largest on the way.
        let time = (-dot(from, way) / dot(way, way)).max(R::zero()).min(R::one());
        let (start, end) = (norm(from), norm(from + way));
        let least = if time.is_finite() { norm(from + way * time).min(start).min(end) } else { start };
        return least <= ra + rb + limit && start.max(end) >= (ra - rb).abs() - limit;
    }
    let start = Found { s: R::zero(), t: R::zero(), distance: limit, settled: true };
    let found = search(a, b, motions, store, start, [limit, R::HALF, R::zero()]);
    found.distance < limit || !found.settled
}

/// Signed gap of two outlines: 0 or negative where they touch or cross, and where one body is inside another or outside the
/// tank.
pub(crate) fn gap<R: Real>(a: &Placed<'_, R>, b: &Placed<'_, R>, store: &[R]) -> R {
    if let Some([ra, rb]) = discs(a, b, store) {
        let between = norm(a.pose.origin - b.pose.origin);
        return match (a.record.sign > R::zero(), b.record.sign > R::zero()) {
            (true, _) => ra - rb - between,
            (_, true) => rb - ra - between,
            _ => between - ra - rb,
        };
    }
    let (square, i, k) = closest_nodes(a, b);
    let (s, t) = (at(a.nodes.t, i), at(b.nodes.t, k));
    let (s, t, distance, _) = refine(a, b, store, s, t, square.sqrt(), false);
    // What is not found to meet is farther apart than half of what counts as contact.
    let limit = touching(a, b) * R::lit(0.49);
    let mut found = Found { s, t, distance, settled: true };
    if distance > limit {
        let digits = R::lit(256.0) * R::EPSILON * a.record.reach.max(b.record.reach);
        found = search(a, b, None, store, found, [limit, R::one() - R::lit(1e-9), digits]);
    }
    let crossing = found.distance <= limit;
    let (_, _, distance, sign) = refine(a, b, store, found.s, found.t, found.distance, crossing);
    if crossing { R::zero().min(distance * sign) } else { distance * sign }
}
