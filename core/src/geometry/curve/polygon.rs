//! Polygon with rounded corners: the polygon filtered by a logistic kernel, in closed form.
//!
//! With arclength σ = t P/2π, side directions d and Δₘ the jump of d at corner m, the outline is the polygon itself
//! plus Σ Δₘ rₘ ln(1 + e^(−|σ − σₘ|/rₘ)): analytic for |Im σ| < π r, straight to rounding some 36 r away from a
//! corner. A corner radius R (that of an arc) means r = R tan(T/4) / (2 ln 2 · 1.107 cos(T/2)) at the turn T, which
//! adds the same mass as the arc does for T = 90°.
//!
//! Tested by `geometry/curve/tests.rs`, `geometry/curve/added_mass_test.rs`.

use crate::base::complex::{Complex, cabs, cexp, cexpm1, cln_1p, complex, dot};
use crate::base::memory::{part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::geometry::curve::polyline::{after, area, boxes_len, cross, crossing, point, straight};
use crate::geometry::grading::{Ladder, TOP};

/// Reals of a corner: vertex, direction of the side that follows, jump of direction, arclength, r.
pub(super) const CORNER: usize = 8;
/// Sharp corners: radius over the shortest side.
pub const SHARP: f64 = 1e-4;
/// Beyond this many r the filter has died away.
const FAR: f64 = 40.0;

/// Outline of a rounded polygon.
#[derive(Clone, Copy, Debug)]
pub struct Polygon<'a, R> {
    pub(super) perimeter: R,
    pub(super) corners: &'a [R],
}

#[derive(Clone, Copy)]
struct Corner<R> {
    vertex: Complex<R>,
    direction: Complex<R>,
    jump: Complex<R>,
    arclength: R,
    r: R,
}

impl<'a, R: Real> Polygon<'a, R> {
    fn corners(&self) -> impl Iterator<Item = Corner<R>> + 'a {
        self.corners.as_chunks::<CORNER>().0.iter().map(|&[vx, vy, dx, dy, jx, jy, arclength, r]| Corner {
            vertex: complex(vx, vy),
            direction: complex(dx, dy),
            jump: complex(jx, jy),
            arclength,
            r,
        })
    }

    /// Arclength in [0, P), and the corner where its side begins.
    fn locate(&self, t: R) -> (R, Corner<R>) {
        let turns = (t / R::TAU).floor();
        let reduced = (t - turns * R::TAU) * self.perimeter / R::TAU;
        let sigma = if reduced >= R::zero() && reduced < self.perimeter { reduced } else { R::zero() };
        let nowhere = complex(R::NAN, R::NAN);
        let start = Corner { vertex: nowhere, direction: nowhere, jump: nowhere, arclength: R::NAN, r: R::NAN };
        (sigma, self.corners().take_while(|c| c.arclength <= sigma).last().unwrap_or(start))
    }

    /// Distances of σ past a corner and its periodic images, as far as `reach`. The corner's own is y itself, bit for bit: at the
    /// corner its sign must be that by which the side was chosen.
    fn images(&self, y: R, reach: R) -> impl Iterator<Item = R> + 'a {
        let p = self.perimeter;
        let turns = core::iter::successors(Some(((reach + y) / p).floor()), |turns| Some(*turns - R::one()));
        turns.map(move |turns| y - turns * p).take_while(move |y| *y <= reach).take(256)
    }

    pub(super) fn jet(&self, t: Complex<R>) -> [Complex<R>; 3] {
        let (sigma, side) = self.locate(t.re);
        let rate = self.perimeter / R::TAU;
        let lift = t.im * rate;
        let mut x = side.vertex + side.direction * complex(sigma - side.arclength, lift);
        let (mut dx, mut ddx) = (side.direction, Complex::default());
        for corner in self.corners() {
            let r = corner.r;
            for y in self.images(sigma - corner.arclength, R::lit(FAR) * r) {
                let sign = if y < R::zero() { -R::one() } else { R::one() };
                let e = cexp(complex(y, lift) * (-sign / r));
                let a = e / (e + R::one());
                x += corner.jump * cln_1p(e) * r;
                dx -= corner.jump * a * sign;
                ddx += corner.jump * (a / (e + R::one())) / complex(r, R::zero());
            }
        }
        [x, dx * rate, ddx * (rate * rate)]
    }

    pub(super) fn jet_real(&self, t: R) -> [Complex<R>; 3] {
        let (sigma, side) = self.locate(t);
        let rate = self.perimeter / R::TAU;
        let mut x = side.vertex + side.direction * (sigma - side.arclength);
        let (mut dx, mut ddx) = (side.direction, Complex::default());
        for corner in self.corners() {
            let r = corner.r;
            for y in self.images(sigma - corner.arclength, R::lit(FAR) * r) {
                let sign = if y < R::zero() { -R::one() } else { R::one() };
                let e = (-y.abs() / r).exp();
                let a = e / (R::one() + e);
                x += corner.jump * (r * e.ln_1p());
                dx -= corner.jump * (sign * a);
                ddx += corner.jump * (a / (R::one() + e) / r);
            }
        }
        [x, dx * rate, ddx * (rate * rate)]
    }

    /// See [`Curve::bend`](super::Curve::bend): each corner turns the tangent by no more than its jump, at no more than
    /// the rate where the arc is closest to it.
    pub(super) fn bend(&self, t: R, w: R) -> R {
        let (sigma, _) = self.locate(t);
        let rate = self.perimeter / R::TAU;
        self.corners().fold(R::zero(), |sum, corner| {
            let (r, jump) = (corner.r, dot(corner.jump, corner.jump).sqrt() * rate);
            self.images(sigma - corner.arclength, R::lit(FAR) * r + w * rate).fold(sum, |sum, y| {
                let e = (-(y.abs() - w * rate).max(R::zero()) / r).exp();
                let grown = R::one() + e;
                sum + jump * (rate * e / (grown * grown * r)).min(R::TWO / w)
            })
        })
    }

    pub(super) fn delta(&self, t: R, u: Complex<R>) -> Complex<R> {
        let (sigma, side) = self.locate(t);
        let rate = self.perimeter / R::TAU;
        let w = complex(u.re - (u.re / R::TAU).round() * R::TAU, u.im) * rate;
        let mut sum = side.direction * w;
        for corner in self.corners() {
            let r = corner.r;
            for y in self.images(sigma - corner.arclength, R::lit(FAR) * r + w.re.abs()) {
                let sign = if y < R::zero() { -R::one() } else { R::one() };
                let e = (-y.abs() / r).exp();
                let a = e / (R::one() + e);
                let q = w * (-sign / r);
                // ln(1 + a (e^q − 1)): near its start; grown, as z + …, once the corner is passed, which keeps the
                // branch however large Im z is; in between.
                let term = if cabs(q) <= R::one() {
                    cln_1p(cexpm1(q) * a)
                } else {
                    let z = q - (y.abs() / r + e.ln_1p());
                    let grown = || z + cln_1p(cexp(-z) / complex(R::one() + e, R::zero()));
                    if z.re > R::zero() { grown() } else { cln_1p(cexp(z) - a) }
                };
                sum += corner.jump * term * r;
            }
        }
        sum
    }

    /// The permanent ladder of every corner: scale of the zeros of γ′, faded over the longer adjacent side.
    pub(super) fn ladders(&self) -> impl Iterator<Item = Ladder<R>> + 'a {
        let p = self.perimeter;
        let ends = self.corners().map(|c| c.arclength).skip(1).chain(core::iter::once(p));
        let mut before = p - self.corners().last().map_or(R::zero(), |c| c.arclength);
        self.corners().zip(ends).filter_map(move |(c, end)| {
            let (last, side) = (before, end - c.arclength);
            before = side;
            let turn = turn(c.direction - c.jump, c.direction).abs();
            let ladder = Ladder {
                t: c.arclength * R::TAU / p,
                beta: scale(c.r, turn, p),
                top: (side.max(last) * R::TAU / p).min(R::lit(TOP)),
            };
            // A corner that does not turn leaves no trace in the flow.
            (turn * turn > R::EPSILON).then_some(ladder)
        })
    }
}

fn turn<R: Real>(before: Complex<R>, next: Complex<R>) -> R {
    cross(before, next).atan2(dot(before, next))
}

/// Checks the vertices of a polygon. Returns whether they run clockwise.
pub(super) fn check<R: Real>(vertices: &[[R; 2]], scratch: &mut [R]) -> Result<bool> {
    let n = vertices.len();
    let bad = |status: Status, k: usize| Error::new(status).of("vertex", k as f64);
    let flat = vertices.as_flattened();
    if n < 3 {
        return Err(Error::new(Status::BadShape).of("vertices", n as f64));
    }
    if let Some(k) = vertices.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
        return Err(bad(Status::NotFinite, k));
    }
    let corner = |k: usize| point(flat, k);
    let size = (0..n).fold(R::zero(), |l, k| l.max(cabs(corner(k) - corner(0))));
    let rounding = R::EPSILON * R::lit(64.0) * size;
    if let Some(k) = (0..n).find(|&k| cabs(corner(after(k, n)) - corner(k)) <= rounding) {
        return Err(bad(Status::BadShape, after(k, n)));
    }
    if straight(corner, n) {
        return Err(Error::new(Status::BadShape).of("area", 0.0));
    }
    if let Some((_, j)) = crossing(flat, part_mut(scratch, 0, boxes_len(n)), rounding, R::zero()) {
        return Err(bad(Status::SelfIntersection, j));
    }
    // Sides that fold back onto each other.
    let direction = |k: usize| corner(after(k, n)) - corner(k);
    if let Some(k) = (0..n).find(|&k| R::PI - turn(direction(k), direction(after(k, n))).abs() < R::lit(1e-4)) {
        return Err(bad(Status::SelfIntersection, after(k, n)));
    }
    Ok(area(corner, n) < R::zero())
}

/// Perimeter, and the corner radius with its default. Errors: `OutOfRange` when the radius is not positive or too
/// small to be told from a sharp corner in this precision (32 roundings of the perimeter).
fn measure<R: Real>(vertex: impl Fn(usize) -> Complex<R>, n: usize, radius: Option<R>) -> Result<(R, R)> {
    let (mut perimeter, mut shortest) = (R::zero(), R::MAX);
    for k in 0..n {
        let side = cabs(vertex(after(k, n)) - vertex(k));
        perimeter += side;
        shortest = shortest.min(side);
    }
    let resolved = perimeter * R::EPSILON * R::lit(32.0);
    match radius {
        None => Ok((perimeter, (shortest * R::lit(SHARP)).max(resolved))),
        Some(radius) if radius >= resolved => Ok((perimeter, radius)),
        Some(radius) => Err(Error::new(Status::OutOfRange).of("radius", radius.to_f64())),
    }
}

/// Width r of the filter for a corner radius and a turn. A slight turn needs hardly any rounding; a floor on it
/// keeps r away from 0.
fn width<R: Real>(radius: R, turn: R) -> R {
    let (s, c) = (turn.max(R::lit(0.1)) / R::lit(4.0)).sin_cos();
    radius * s / c / ((turn * R::HALF).cos() * R::lit(2.0 * core::f64::consts::LN_2 * 1.107))
}

/// Scale of the permanent ladder of a corner.
fn scale<R: Real>(r: R, turn: R, perimeter: R) -> R {
    R::TWO * r * (R::PI - turn) * R::TAU / perimeter
}

/// Upper bound of the number of rungs of a polygon's ladders, one more per corner than its sides as given need.
pub(super) fn rungs<R: Real>(vertex: impl Fn(usize) -> Complex<R>, n: usize, radius: Option<R>) -> Result<usize> {
    if n == 0 {
        return Ok(0);
    }
    let (perimeter, radius) = measure(&vertex, n, radius)?;
    let mut before = vertex(0) - vertex(n.saturating_sub(1));
    Ok((0..n).fold(0usize, |sum, k| {
        let next = vertex(after(k, n)) - vertex(k);
        let turn = turn(before, next).abs();
        before = next;
        let ladder = Ladder { t: R::zero(), beta: scale(width(radius, turn), turn, perimeter), top: R::lit(TOP) };
        sum.saturating_add(ladder.count()).saturating_add(1)
    }))
}

/// Writes the corners of a checked, counter-clockwise polygon and returns its perimeter.
/// Errors: `OutOfRange` when the radius is not positive or two arcs of it do not fit a side.
pub(super) fn write<R: Real>(
    vertex: impl Fn(usize) -> Complex<R>,
    n: usize,
    radius: Option<R>,
    store: &mut [R],
) -> Result<R> {
    let side = |k: usize| vertex(after(k, n)) - vertex(k);
    let (perimeter, radius) = measure(&vertex, n, radius)?;
    let mut before = side(n.saturating_sub(1));
    let mut arclength = R::zero();
    let mut tangents = [R::zero(); 2];
    let mut first = R::zero();
    for k in 0..n {
        let (at, next) = (vertex(k), side(k));
        let (unit, last) = (next / complex(cabs(next), R::zero()), before / complex(cabs(before), R::zero()));
        let turn = turn(before, next).abs();
        // Length of the side that an arc of this radius takes.
        tangents = [tangents[1], radius * (turn * R::HALF).sin() / (turn * R::HALF).cos()];
        if k == 0 {
            first = tangents[1];
        } else if tangents[0] + tangents[1] > cabs(before) * R::lit(1.0 + 1e-6) {
            return Err(Error::new(Status::OutOfRange).of("radius", radius.to_f64()));
        }
        let r = width(radius, turn);
        let jump = unit - last;
        let record = [at.re, at.im, unit.re, unit.im, jump.re, jump.im, arclength, r];
        for (j, x) in record.into_iter().enumerate() {
            put(store, k * CORNER + j, x);
        }
        arclength += cabs(next);
        before = next;
    }
    if tangents[1] + first > cabs(before) * R::lit(1.0 + 1e-6) {
        return Err(Error::new(Status::OutOfRange).of("radius", radius.to_f64()));
    }
    Ok(perimeter)
}

/// Writes the corners of a rectangle about the origin whose rounded outline measures `width` by `height`.
pub(super) fn write_rectangle<R: Real>(width: R, height: R, radius: Option<R>, store: &mut [R]) -> Result<R> {
    let corner = |x: R, y: R| {
        move |k: usize| match k {
            0 => complex(-x, -y) * R::HALF,
            1 => complex(x, -y) * R::HALF,
            2 => complex(x, y) * R::HALF,
            _ => complex(-x, y) * R::HALF,
        }
    };
    let (mut x, mut y) = (width, height);
    let mut perimeter = write(corner(x, y), 4, radius, store)?;
    // Rounding shrinks short sides; stretch until the middles of the sides are where they belong.
    for _ in 0..60 {
        let outline = Polygon { perimeter, corners: part(store, 0, 4 * CORNER) };
        let middle = |sigma: R| outline.jet_real(sigma * R::TAU / perimeter)[0];
        let right = middle(x + y * R::HALF).re * R::TWO - width;
        let top = middle(x * R::lit(1.5) + y).im * R::TWO - height;
        if right.abs().max(top.abs()) <= R::EPSILON * R::TWO * width.max(height) {
            break;
        }
        (x, y) = (x - right, y - top);
        perimeter = write(corner(x, y), 4, radius, store)?;
    }
    Ok(perimeter)
}
