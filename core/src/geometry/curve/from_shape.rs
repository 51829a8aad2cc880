//! From a shape to its outline: validation, curve, grading.
//!
//! Tested by the tests at its end, `geometry/curve/tests.rs`, `tests/bad_input`.

use super::corners::Kinked;
use super::even::Even;
use super::polygon::{self, CORNER};
use super::polyline::{area, boxes_len, cross, crossing, distinct, frame, point, straight};
use super::{Curve, Ellipse, Kind, Outline, through_points};
use crate::base::complex::{Complex, cabs, dot};
use crate::base::memory::{part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::geometry::grading::{Ladder, TOP, grading_len, write_grading};
use crate::scene::{Corners, Shape};

/// Most lobes of a star.
pub const MAX_LOBES: usize = 1024;
/// Rungs of the ladder at a bend.
const BEND_RUNGS: usize = 8;
/// Most tips of an outline that is not a polygon.
const MOST_TIPS: usize = 32;
/// Samples per corner in the test of a rounded polygon.
const PER_CORNER: usize = 64;
/// Samples closer than this part of their spacing cannot be told from touching.
const TOUCH: f64 = 1e-3;
/// The same between the straight flanks of a polygon, which may be thin.
const FLANKS: f64 = 1e-6;

/// |curvature| and |γ′| where the derivatives are these.
fn bend<R: Real>([_, d, dd]: [Complex<R>; 3]) -> [R; 2] {
    let speed = cabs(d);
    [cross(d, dd).abs() / (speed * speed * speed), speed]
}

/// Parameters of the sharpest bends of a sampled curve, with γ's scale there: local maxima of |curvature| k with
/// k P/2π > 2, ladder scale 1/(k |γ′|). `bend` gives |curvature| and |γ′| at a sample, periodically.
fn bends<'a, R: Real>(
    bend: &'a dyn Fn(usize) -> [R; 2],
    samples: usize,
    perimeter: R,
) -> impl Iterator<Item = Ladder<R>> + 'a {
    let step = R::TAU / R::count(samples);
    let (mut before, mut here) = (bend(samples.saturating_sub(1)), bend(0));
    (0..samples).filter_map(move |i| {
        let ([a, _], [b, speed]) = (before, here);
        let next = bend(i + 1);
        (before, here) = (here, next);
        let [c, _] = next;
        let sharp = b > a && b >= c && b * perimeter > R::TAU * R::TWO;
        // Vertex of the parabola through three values.
        let shift = (a - c) / (a - b - b + c) * R::HALF;
        let floor = R::lit(TOP / 2187.0 * 1.01);
        sharp.then(|| Ladder {
            t: (R::count(i) + shift) * step,
            beta: (R::one() / (b * speed)).max(floor),
            top: R::lit(TOP),
        })
    })
}

/// A length that must be positive and such that its fourth power can be represented.
fn length<R: Real>(what: &'static str, value: R) -> Result<()> {
    let error = |status: Status| Err(Error::new(status).of(what, value.to_f64()));
    let smallest = R::TINY.sqrt().sqrt() * R::lit(16.0);
    match value {
        v if !v.is_finite() => error(Status::NotFinite),
        v if v <= R::zero() => error(Status::BadShape),
        v if v < smallest || v * smallest > R::lit(0.1) => error(Status::OutOfRange),
        _ => Ok(()),
    }
}

/// Sizes of everything a shape needs.
struct Sizes {
    /// Reals of the curve.
    own: usize,
    /// Rungs, at most.
    rungs: usize,
    /// Permanent ladders, at most.
    ladders: usize,
    /// Tips and corners, at most.
    tips: usize,
    scratch: usize,
}

/// Corner `k` of a polygon of `n`, counter-clockwise: a clockwise one is walked backwards from its first corner.
fn turned<R: Real>(points: &[[R; 2]], clockwise: bool) -> impl Fn(usize) -> Complex<R> + '_ {
    let n = points.len();
    move |k| point(points.as_flattened(), if clockwise && k > 0 { n.saturating_sub(k) } else { k })
}

fn rectangle<R: Real>(width: R, height: R) -> [[R; 2]; 4] {
    let (x, y) = (width * R::HALF, height * R::HALF);
    [[-x, -y], [x, -y], [x, y], [-x, y]]
}

impl<R: Real> Outline<R> {
    /// Visits what nodes gather at: permanent ladders, in the order in which the grading was made of them, and parameters of tips (curvature
    /// times perimeter above 4π) and corners.
    pub(crate) fn each_feature(&self, store: &[R], mut visit: impl FnMut(Option<Ladder<R>>, R)) {
        match self.kind.curve(store) {
            Curve::Ellipse(e) => {
                let (long, short) = (e.a.max(e.b), e.a.min(e.b));
                if long / (short * short) * e.properties().perimeter > R::TAU * R::TWO {
                    let first = if e.a > e.b { R::zero() } else { R::PI * R::HALF };
                    visit(None, first);
                    visit(None, first + R::PI);
                }
            }
            Curve::Polygon(polygon) => polygon.ladders().for_each(|l| visit(Some(l), l.t)),
            Curve::Fourier(curve) => {
                let even = Even::new(curve, self.samples);
                let bend = |i: usize| bend(even.jet(i));
                let mut room = self.rungs;
                bends(&bend, self.samples, self.perimeter).for_each(|ladder| {
                    let fits = self.rungs > 0 && ladder.count() <= room;
                    if fits {
                        room -= ladder.count();
                    }
                    visit(fits.then_some(ladder), ladder.t);
                });
            }
        }
    }
}

impl<R: Real> Shape<'_, R> {
    /// The same without a repeated last point.
    fn closed(&self) -> Self {
        match *self {
            Shape::Polygon { vertices, radius } => Shape::Polygon { vertices: distinct(vertices), radius },
            other => other,
        }
    }

    /// A point is repeated at the end.
    fn repeats(&self) -> bool {
        match *self {
            Shape::Polygon { vertices: points, .. } | Shape::Curve { points, .. } => {
                distinct(points).len() < points.len()
            }
            _ => false,
        }
    }

    /// Visits the numbers of the points at which a curve has corners, given or found; nothing for other shapes. O(points), times the number
    /// of corners if they are given and do not increase.
    pub fn each_corner(&self, visit: impl FnMut(usize)) {
        if let Shape::Curve { points, corners } = *self {
            Kinked::new(points, corners).all().for_each(visit);
        }
    }

    fn sizes(&self) -> Result<Sizes> {
        let polygon = |vertices: &[[R; 2]], radius: Option<R>| {
            let n = vertices.len();
            let samples = n.max(4).saturating_mul(PER_CORNER);
            Ok(Sizes {
                own: n.saturating_mul(CORNER),
                rungs: polygon::rungs(turned(vertices, false), n, radius)?,
                ladders: n,
                tips: n,
                scratch: samples.saturating_mul(2).saturating_add(boxes_len(samples)),
            })
        };
        match self.closed() {
            Shape::Ellipse { .. } => Ok(Sizes { own: 0, rungs: 0, ladders: 0, tips: 2, scratch: 0 }),
            Shape::Star { lobes, .. } => {
                Ok(Sizes { own: 6, rungs: 0, ladders: 0, tips: lobes.min(MOST_TIPS), scratch: 0 })
            }
            Shape::Rectangle { width, height, radius } => polygon(&rectangle(width, height), radius),
            Shape::Polygon { vertices, radius } => polygon(vertices, radius),
            Shape::Curve { points, corners } => {
                let n = Kinked::new(points, corners).count();
                let memory = through_points::Memory::<R>::len(&n).ok_or(Status::SizeOverflow)?;
                Ok(Sizes {
                    own: through_points::coefficients_len(n),
                    rungs: n.saturating_mul(BEND_RUNGS),
                    ladders: n,
                    tips: n.min(MOST_TIPS),
                    scratch: memory.saturating_add(n.saturating_mul(2)),
                })
            }
        }
    }

    /// Reals that the compiled outline occupies. Depends on the shape only. Errors: `SizeOverflow`; `OutOfRange`
    /// for a corner radius that is not positive.
    pub(crate) fn store_len(&self) -> Result<usize> {
        let sizes = self.sizes()?;
        let graded = grading_len(sizes.rungs).and_then(|n| n.checked_add(sizes.own));
        graded.filter(|n| *n < usize::MAX / 64).ok_or(Status::SizeOverflow.into())
    }

    /// Reals needed while compiling: about n² + 100 n for a curve through n points, 130 per corner, else none.
    /// Depends on the shape only. Errors as for [`store_len`](Self::store_len).
    pub(crate) fn scratch_len(&self) -> Result<usize> {
        let scratch = self.sizes()?.scratch;
        if scratch < usize::MAX / 64 { Ok(scratch) } else { Err(Status::SizeOverflow.into()) }
    }

    /// Number of permanent ladders and of tips or corners, at most.
    pub(crate) fn ladder_counts(&self) -> Result<(usize, usize)> {
        self.sizes().map(|s| (s.ladders, s.tips))
    }

    /// The origin of the compiled outline's frame in the shape's drawing frame: not its own origin where the outline is far from that.
    pub(crate) fn frame(&self) -> Complex<R> {
        match *self {
            Shape::Polygon { vertices: points, .. } | Shape::Curve { points, .. } => frame(distinct(points)),
            _ => Complex::default(),
        }
    }

    /// Validates the shape and writes its curve and grading into `store`.
    ///
    /// Corner radius: that of an arc of the same effect ([`Polygon`](super::Polygon)); `None` is [`SHARP`](super::SHARP)
    /// of the shortest side; from 32 roundings of the perimeter up to where two arcs no longer fit on a side.
    /// Clockwise corners or points are turned round, with the notice `OutlineReversed` in place of `Ok`; a repeated last point is dropped,
    /// with the notice `PointRepeated`; kinks of a curve's points become corners, with `CornersFound`
    /// before either.
    /// Errors name the measure, corner ("vertex") or point: `NotFinite`, `BadShape`, `OutOfRange`,
    /// `SelfIntersection`; `MemoryTooSmall`.
    ///
    /// Cost: O(1) for ellipses, O(corners² rungs) for polygons, O(points³) for curves.
    pub(crate) fn compile(&self, store: &mut [R], scratch: &mut [R]) -> Result<(Outline<R>, Status)> {
        let closed = self.closed();
        let (outline, status) = closed.compile_closed(store, scratch)?;
        let repeated = self.repeats() && status != Status::CornersFound;
        Ok((outline, if repeated { Status::PointRepeated } else { status }))
    }

    fn compile_closed(&self, store: &mut [R], scratch: &mut [R]) -> Result<(Outline<R>, Status)> {
        self.validate()?;
        let sizes = self.sizes()?;
        if store.len() < self.store_len()? || scratch.len() < self.scratch_len()? {
            return Err(Status::MemoryTooSmall.into());
        }
        match *self {
            Shape::Ellipse { a, b } => {
                Ok((Outline { kind: Kind::Ellipse(Ellipse { a, b }), ..Outline::default() }, Status::Ok))
            }
            Shape::Star { radius, amplitude, lobes } => {
                let half = radius * amplitude * R::HALF;
                for (k, x) in [half, radius, half].into_iter().enumerate() {
                    put(store, 2 * k, x);
                    put(store, 2 * k + 1, R::zero());
                }
                let kind = Kind::Fourier { centre: R::one(), stride: R::count(lobes), down: 1, count: 3 };
                let samples = lobes.saturating_mul(32);
                let (curve, step) = (kind.curve(store), R::TAU / R::count(samples.max(1)));
                let perimeter =
                    (0..samples).fold(R::zero(), |p, i| p + cabs(curve.jet_real(step * R::count(i))[1]) * step);
                Ok((Outline { kind, rungs: 0, samples, perimeter }, Status::Ok))
            }
            Shape::Rectangle { width, height, radius } => {
                let perimeter = polygon::write_rectangle(width, height, radius, store)?;
                Ok((grade_corners(4, perimeter, radius, store, scratch)?, Status::Ok))
            }
            Shape::Polygon { vertices, radius } => {
                let clockwise = polygon::check(vertices, scratch)?;
                let n = vertices.len();
                let (vertex, from) = (turned(vertices, clockwise), frame(vertices));
                let perimeter = polygon::write(|k| vertex(k) - from, n, radius, store)?;
                let outline = grade_corners(n, perimeter, radius, store, scratch)?;
                Ok((outline, if clockwise { Status::OutlineReversed } else { Status::Ok }))
            }
            Shape::Curve { points, corners } => {
                let kinked = Kinked::new(points, corners);
                let n = kinked.count();
                let (rounded, scratch) =
                    scratch.split_at_mut_checked(n.saturating_mul(2)).ok_or(Status::MemoryTooSmall)?;
                let rounded = rounded.as_chunks_mut::<2>().0;
                let mut places = rounded.iter_mut();
                kinked.each(|_, p| {
                    if let Some(place) = places.next() {
                        *place = [p.re, p.im];
                    }
                });
                let clockwise = area(turned(rounded, false), n) < R::zero();
                let p = turned(rounded, clockwise);
                let mut memory = through_points::Memory::take(&n, &mut { scratch })?;
                let modes = through_points::write(&p, n, &mut memory, store)?;
                let kind = Kind::Fourier { centre: R::one(), stride: R::one(), down: modes.down, count: modes.count };
                let samples = through_points::samples(n);
                let outline = grade_bends(kind, n, sizes.rungs, [memory.samples, memory.roots], store)?;
                if let Some((_, j)) = crossing(memory.samples, memory.boxes, R::zero(), R::lit(TOUCH)) {
                    let at = through_points::point_before(memory.knots, n, j);
                    let own = if clockwise && at > 0 { n.saturating_sub(at) } else { at };
                    return Err(Error::new(Status::SelfIntersection).of("point", kinked.origin(own) as f64));
                }
                let enclosed = area(|i| point(memory.samples, i), samples);
                let Curve::Fourier(curve) = kind.curve(store) else {
                    return Err(Status::Internal.into());
                };
                let size = curve.modes().fold(R::zero(), |s, (k, c)| if k == R::zero() { s } else { s + dot(c, c) });
                if enclosed <= size * R::EPSILON * R::lit(64.0) || enclosed.is_nan() {
                    return Err(Error::new(Status::BadShape).of("area", enclosed.to_f64()));
                }
                let found = corners == Corners::Auto && kinked.all().next().is_some();
                let status = match (found, clockwise) {
                    (true, _) => Status::CornersFound,
                    (_, true) => Status::OutlineReversed,
                    _ => Status::Ok,
                };
                Ok((outline, status))
            }
        }
    }

    /// Checks on the numbers alone.
    pub(super) fn validate(&self) -> Result<()> {
        match *self {
            Shape::Ellipse { a, b } => length("a", a).and(length("b", b)),
            Shape::Star { radius, amplitude, lobes } => {
                length("radius", radius)?;
                let error = |status: Status| Err(Error::new(status).of("amplitude", amplitude.to_f64()));
                if !amplitude.is_finite() {
                    error(Status::NotFinite)
                } else if amplitude.abs() >= R::one() {
                    error(Status::OutOfRange)
                } else if lobes > MAX_LOBES {
                    Err(Error::new(Status::OutOfRange).of("lobes", lobes as f64))
                } else {
                    Ok(())
                }
            }
            Shape::Rectangle { width, height, radius } => {
                length("width", width)?;
                length("height", height)?;
                radius_given(radius)
            }
            Shape::Polygon { vertices, radius } => {
                radius_given(radius)?;
                points_given("vertices", "vertex", vertices)
            }
            Shape::Curve { points, corners } => {
                Kinked::new(points, corners).check()?;
                let points = distinct(points);
                points_given("points", "point", points)?;
                let p = turned(points, false);
                let n = points.len();
                let size = (0..n).fold(R::zero(), |l, k| l.max(cabs(p(k) - p(0))));
                for k in 0..n {
                    // Of many points, those of which others repeat an earlier one are left to the test for crossings.
                    let others = if n > 512 { k.saturating_sub(1)..k } else { 0..k };
                    if others.chain(0..k.min(1)).any(|j| cabs(p(k) - p(j)) <= R::EPSILON * R::lit(64.0) * size) {
                        let neighbour = cabs(p(k) - p(k.saturating_sub(1))) <= R::EPSILON * R::lit(64.0) * size;
                        let closing = k + 1 == n && cabs(p(k) - p(0)) <= R::EPSILON * R::lit(64.0) * size;
                        let status = if neighbour || closing { Status::BadShape } else { Status::SelfIntersection };
                        return Err(Error::new(status).of("point", k as f64));
                    }
                }
                if straight(p, n) { Err(Error::new(Status::BadShape).of("area", 0.0)) } else { Ok(()) }
            }
        }
    }
}

fn radius_given<R: Real>(radius: Option<R>) -> Result<()> {
    match radius {
        Some(r) if !r.is_finite() => Err(Error::new(Status::NotFinite).of("radius", r.to_f64())),
        _ => Ok(()),
    }
}

/// At least three finite points, spread over a length in range.
fn points_given<R: Real>(all: &'static str, one: &'static str, points: &[[R; 2]]) -> Result<()> {
    if points.len() < 3 {
        return Err(Error::new(Status::BadShape).of(all, points.len() as f64));
    }
    if let Some(k) = points.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
        return Err(Error::new(Status::NotFinite).of(one, k as f64));
    }
    let p = turned(points, false);
    let (far, size) = (1..points.len()).fold((0, R::zero()), |(far, size), k| {
        let d = cabs(p(k) - p(0)).max(cabs(p(k)));
        if d > size { (k, d) } else { (far, size) }
    });
    length(one, size).map_err(|e| if size > R::zero() { e.of(one, far as f64) } else { e.of(one, 1.0) })
}

/// Grades a curve through points at its bends, convex and concave; leaves its samples in `positions`, their curvatures and speeds in `shape`.
///
/// Stars are not graded: among ten bends or so the ladders compete, and the polar angle already resolves them
/// (0.3, 5 lobes alone, 48 nodes: added mass to 1e-6 as against 1e-3).
fn grade_bends<R: Real>(
    kind: Kind<R>,
    points: usize,
    most: usize,
    [positions, shape]: [&mut [R]; 2],
    store: &mut [R],
) -> Result<Outline<R>> {
    let (own, graded) = store.split_at_mut_checked(kind.len()).ok_or(Status::MemoryTooSmall)?;
    let Curve::Fourier(curve) = kind.curve(own) else { return Err(Status::Internal.into()) };
    let samples = through_points::samples(points);
    let even = Even::new(curve, samples);
    let step = R::TAU / R::count(samples);
    let mut perimeter = R::zero();
    let places = positions.as_chunks_mut::<2>().0.iter_mut().zip(shape.as_chunks_mut::<2>().0);
    for (i, (place, shape)) in places.enumerate() {
        let jet = even.jet(i);
        let [x, d, _] = jet;
        perimeter += cabs(d) * step;
        (*place, *shape) = ([x.re, x.im], bend(jet));
    }
    let shape = shape.as_chunks::<2>().0;
    let bend = |i: usize| shape.get(if i < samples { i } else { i - samples }).copied().unwrap_or([R::NAN; 2]);
    let mut room = most;
    let ladders = bends(&bend, samples, perimeter).take(points).take_while(move |ladder| {
        let fits = ladder.count() <= room;
        room = room.saturating_sub(ladder.count());
        fits
    });
    let rungs = write_grading(ladders, graded)?;
    Ok(Outline { kind, rungs, samples, perimeter })
}

/// Grades a polygon at its corners and makes sure that rounding has not tangled it.
fn grade_corners<R: Real>(
    n: usize,
    perimeter: R,
    radius: Option<R>,
    store: &mut [R],
    scratch: &mut [R],
) -> Result<Outline<R>> {
    let kind = Kind::Polygon { corners: n, perimeter };
    let (own, graded) = store.split_at_mut_checked(kind.len()).ok_or(Status::MemoryTooSmall)?;
    let Curve::Polygon(curve) = kind.curve(own) else {
        return Err(Status::Internal.into());
    };
    let rungs = write_grading(curve.ladders(), graded)?;
    let outline = Outline { kind, rungs, ..Outline::default() };
    let samples = n.max(4) * PER_CORNER;
    let (positions, boxes) = scratch.split_at_mut_checked(2 * samples).ok_or(Status::MemoryTooSmall)?;
    let mut points = positions.as_chunks_mut::<2>().0.iter_mut();
    outline.view(store).walk(samples, |node| {
        if let Some(p) = points.next() {
            *p = [node.x.re, node.x.im];
        }
    })?;
    match crossing(positions, part_mut(boxes, 0, boxes_len(samples)), R::zero(), R::lit(FLANKS)) {
        Some(_) => Err(Error::new(Status::OutOfRange).of("radius", radius.unwrap_or(R::NAN).to_f64())),
        None => Ok(outline),
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;

    #[test]
    fn a_polygon_whose_outline_crosses_itself_is_refused_by_its_samples() {
        // A notch from above that ends inside, or below the lower side.
        for (end, fits) in [(0.4, true), (0.1, true), (-0.3, false), (-0.6, false)] {
            let vertices = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, end], [0.0, 1.0]];
            let radius = Some(0.01);
            let shape = Shape::Polygon { vertices: &vertices, radius };
            let (mut store, mut scratch) =
                (vec![f64::NAN; shape.store_len().unwrap()], vec![f64::NAN; shape.scratch_len().unwrap()]);
            let perimeter = polygon::write(turned(&vertices, false), 5, radius, &mut store).unwrap();
            let told = grade_corners(5, perimeter, radius, &mut store, &mut scratch);
            assert_eq!(
                told.map(|_| ()).map_err(|e| (e.status, e.what)),
                if fits { Ok(()) } else { Err((Status::OutOfRange, "radius")) }
            );
        }
    }
}
