//! Tests on closed polylines: area, straightness, self-intersection.
//!
//! Tested by `geometry/curve/tests.rs`.

use crate::base::complex::{Complex, cabs, complex, dot, perp};
use crate::base::memory::{at, put};
use crate::base::scalar::Real;

/// Sizes of an outline from which on it is far.
const FAR: f64 = 16.0;
/// Segments that share a bounding box.
const BLOCK: usize = 16;

/// Reals of the bounding boxes for a polyline of `n` points.
pub(super) const fn boxes_len(n: usize) -> usize {
    n.div_ceil(BLOCK).saturating_mul(4)
}

/// Point `i` of coordinates in turn.
pub(super) fn point<R: Real>(points: &[R], i: usize) -> Complex<R> {
    complex(at(points, i.saturating_mul(2)), at(points, i.saturating_mul(2).saturating_add(1)))
}

/// The number after `i` in a cycle of `n`.
pub(super) const fn after(i: usize, n: usize) -> usize {
    if i.saturating_add(1) < n { i + 1 } else { 0 }
}

/// Where the frame of a compiled outline has its origin in the drawing: a far one keeps the first point near it. Differences of points so far
/// from the drawing's origin are exact.
pub(super) fn frame<R: Real>(points: &[[R; 2]]) -> Complex<R> {
    let p = |[x, y]: &[R; 2]| complex(*x, *y);
    let Some(first) = points.first().map(p) else { return Complex::default() };
    let size = points.iter().fold(R::zero(), |l, q| l.max(cabs(p(q) - first)));
    if cabs(first) > size * R::lit(FAR) { first } else { Complex::default() }
}

/// `a × b`.
pub(super) fn cross<R: Real>(a: Complex<R>, b: Complex<R>) -> R {
    dot(perp(a), b)
}

/// Points without what repeats the first or the one before at the end, to a millionth of their mean distance. O(n) if the last does.
pub(crate) fn distinct<R: Real>(points: &[[R; 2]]) -> &[[R; 2]] {
    let mut rest = points;
    while let (&[first, .., before, last], true) = (rest, rest.len() > 3) {
        let distance = |a: [R; 2], b: [R; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        let nearest = distance(last, first).min(distance(last, before));
        let way = || points.iter().zip(points.iter().skip(1)).fold(R::zero(), |s, (a, b)| s + distance(*a, *b));
        if nearest > R::zero()
            && (nearest > R::lit(1e-3) * distance(first, before)
                || nearest > R::lit(1e-6) * way() / R::count(points.len()))
        {
            break;
        }
        rest = rest.get(..rest.len() - 1).unwrap_or(rest);
    }
    rest
}

/// Signed area of the polygon with these corners.
pub(super) fn area<R: Real>(corner: impl Fn(usize) -> Complex<R>, n: usize) -> R {
    let origin = corner(0);
    let twice = (0..n).fold(R::zero(), |sum, i| sum + cross(corner(i) - origin, corner(after(i, n)) - origin));
    twice * R::HALF
}

/// All points lie on one line, to rounding.
pub(super) fn straight<R: Real>(corner: impl Fn(usize) -> Complex<R>, n: usize) -> bool {
    let origin = corner(0);
    let far = (0..n).map(|i| corner(i) - origin).fold(
        Complex::default(),
        |far: Complex<R>, z| {
            if cabs(z) > cabs(far) { z } else { far }
        },
    );
    let length = cabs(far);
    let unit = far / complex(length, R::zero());
    (0..n).all(|i| cross(unit, corner(i) - origin).abs() <= R::EPSILON * R::lit(64.0) * length)
}

fn point_to_segment<R: Real>(p: Complex<R>, a: Complex<R>, b: Complex<R>) -> R {
    let (d, w) = (b - a, p - a);
    let square = dot(d, d);
    let along = if square > R::zero() { (dot(w, d) / square).max(R::zero()).min(R::one()) } else { R::zero() };
    cabs(w - d * along)
}

/// The segments ab and cd cross, or come as close as `near`.
fn meet<R: Real>(a: Complex<R>, b: Complex<R>, c: Complex<R>, d: Complex<R>, near: R) -> bool {
    let (u, v) = (b - a, d - c);
    let across = |p: R, q: R| (p > R::zero() && q < R::zero()) || (p < R::zero() && q > R::zero());
    if across(cross(u, c - a), cross(u, d - a)) && across(cross(v, a - c), cross(v, b - c)) {
        return true;
    }
    let ends = point_to_segment(a, c, d).min(point_to_segment(b, c, d));
    ends.min(point_to_segment(c, a, b)).min(point_to_segment(d, a, b)) <= near
}

/// The first pair of segments of a closed polyline, neighbours apart, that meet: closer than
/// `absolute + relative · (the shorter segment)`. `boxes` has [`boxes_len`] elements.
pub(super) fn crossing<R: Real>(points: &[R], boxes: &mut [R], absolute: R, relative: R) -> Option<(usize, usize)> {
    let n = points.len() / 2;
    let end = |i: usize| point(points, after(i, n));
    let longest = (0..n).fold(R::zero(), |l, i| l.max(cabs(end(i) - point(points, i))));
    let margin = absolute + relative * longest;
    let blocks = n.div_ceil(BLOCK);
    for b in 0..blocks {
        let mut limits = [R::MAX, R::MAX, -R::MAX, -R::MAX];
        for i in b * BLOCK..n.min(b * BLOCK + BLOCK) {
            for z in [point(points, i), end(i)] {
                limits = [limits[0].min(z.re), limits[1].min(z.im), limits[2].max(z.re), limits[3].max(z.im)];
            }
        }
        for (k, x) in limits.into_iter().enumerate() {
            put(boxes, b * 4 + k, x);
        }
    }
    let boxes: &[R] = boxes;
    let limit = |b: usize, k: usize| at(boxes, b * 4 + k);
    for b in 0..blocks {
        for c in b..blocks {
            if (0..2).any(|k| limit(b, k) > limit(c, k + 2) + margin || limit(c, k) > limit(b, k + 2) + margin) {
                continue;
            }
            for i in b * BLOCK..n.min(b * BLOCK + BLOCK) {
                let (p, q) = (point(points, i), end(i));
                for j in (c * BLOCK).max(i + 2)..n.min(c * BLOCK + BLOCK) {
                    let (s, t) = (point(points, j), end(j));
                    let apart = p.re.max(q.re) + margin < s.re.min(t.re)
                        || s.re.max(t.re) + margin < p.re.min(q.re)
                        || p.im.max(q.im) + margin < s.im.min(t.im)
                        || s.im.max(t.im) + margin < p.im.min(q.im);
                    let neighbours = i == 0 && j + 1 == n;
                    let near = || absolute + relative * cabs(q - p).min(cabs(t - s));
                    if !apart && !neighbours && meet(p, q, s, t, near()) {
                        return Some((i, j));
                    }
                }
            }
        }
    }
    None
}
