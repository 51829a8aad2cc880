//! How well points tell an outline: the curve through every second of them, at those left out.
//!
//! Both halves of the points are tried. What they miss is measured in two ways, as the added mass of a body feels it: a disc's grows by twice a
//! part of its radius, wherever along the outline it is added, a plate's by that of its length. A quarter of the points tells how fast the rest
//! converges: as it did from a quarter to a half, it is taken to do from a half to all. Where a curve turns by far without a corner, the bulge
//! of an arc over the longer side is added: there, one half knows no more than the other.
//!
//! Tested by the tests at its end, `tests/tests/outlines.rs`.

use super::corners::Kinked;
use super::polyline::{after, area};
use super::{Fourier, through_points};
use crate::base::complex::{Complex, cabs, complex, dot};
use crate::base::memory::{filled, part, room};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::scene::{Corners, Shape};
use alloc::vec::Vec;

/// Steps to the foot of a point.
const STEPS: usize = 8;
/// Points left out that are looked at, at most.
const MOST_LOOKED_AT: usize = 1024;
/// From a half of the points to all the error falls at most by this factor, and at least by the other.
const FASTEST: f64 = 64.0;
const SLOWEST: f64 = 2.0;
/// A turn above this one, at a point that is no corner, may be anything.
const UNKNOWN_TURN: f64 = core::f64::consts::PI / 3.0;

/// Points of a curve and the numbers of its corners.
struct Told<R> {
    points: Vec<[R; 2]>,
    corners: Vec<usize>,
    /// Points left out, each with the number of the point before it.
    left: Vec<(usize, [R; 2])>,
}

impl<R: Real> Told<R> {
    fn room(points: usize, corners: usize) -> Result<Self> {
        Ok(Told { points: room(points)?, corners: room(corners)?, left: room(points)? })
    }

    /// The corners and every second point between them, from the first or the second on.
    fn halved(&self, odd: bool) -> Result<Self> {
        let n = self.points.len();
        let start = self.corners.first().copied().unwrap_or(0);
        let mut half = Self::room(n, self.corners.len())?;
        let (mut corners, mut since) = (self.corners.iter().peekable(), 0_usize);
        for (i, p) in self.points.iter().enumerate().skip(start).chain(self.points.iter().enumerate().take(start)) {
            let corner = corners.next_if(|c| **c == i).is_some();
            if corner {
                since = 0;
                half.corners.push(half.points.len());
            }
            if corner || since.is_multiple_of(2) != odd {
                half.points.push(*p);
            } else {
                // Before the first one kept is after the last one.
                half.left.push((half.points.len().wrapping_sub(1), *p));
            }
            since += 1;
        }
        let last = half.points.len().saturating_sub(1);
        half.left.iter_mut().for_each(|(before, _)| *before = (*before).min(last));
        Ok(half)
    }

    /// The largest distance of a point left out from the curve through the others, and the area between.
    fn missed(&self) -> Result<[R; 2]> {
        let kinked = Kinked::new(&self.points, Corners::At(&self.corners));
        let n = kinked.count();
        let (mut rounded, mut first) = (room::<Complex<R>>(n)?, room(self.points.len())?);
        kinked.each(|own, p| {
            if own == first.len() {
                first.push(rounded.len());
            }
            rounded.push(p);
        });
        let p = |k: usize| rounded.get(k).or(rounded.get(k.saturating_sub(n))).copied().unwrap_or_default();
        let mut scratch = filled(through_points::Memory::<R>::len(&n).ok_or(Status::SizeOverflow)?)?;
        let mut store = filled(through_points::coefficients_len(n))?;
        let mut memory = through_points::Memory::take(&n, &mut &mut *scratch)?;
        let modes = through_points::write(p, n, &mut memory, &mut store)?;
        let coefficients = part(&store, 0, 2 * modes.count);
        let curve = Fourier { centre: R::one(), stride: R::one(), down: modes.down, coefficients };
        let knot = |k: usize| match k.checked_sub(n) {
            Some(k) => through_points::knot(memory.knots, k) + R::TAU,
            None => through_points::knot(memory.knots, k),
        };
        // The first point of the rounding of a corner, or the point itself.
        let begins = |own: usize| match own.checked_sub(first.len()) {
            Some(own) => first.get(own).map_or(n, |k| k + n),
            None => first.get(own).copied().unwrap_or(n),
        };
        let every = self.left.len().div_ceil(MOST_LOOKED_AT).max(1);
        let (mut most, mut area) = (R::zero(), R::zero());
        for (before, [x, y]) in self.left.iter().step_by(every) {
            let z = complex(*x, *y);
            let (from, to) = (begins(*before), begins(before + 2).saturating_sub(1));
            let (mut nearest, mut t) = (R::MAX, knot(from));
            for k in from..to {
                let (a, d) = (p(k), p(k + 1) - p(k));
                let part = (dot(z - a, d) / dot(d, d)).max(R::zero()).min(R::one());
                let distance = cabs(a + d * part - z);
                if distance < nearest {
                    (nearest, t) = (distance, knot(k) + (knot(k + 1) - knot(k)) * part);
                }
            }
            let mut least = R::MAX;
            for _ in 0..STEPS {
                let [x, d, _] = curve.jet_real(t);
                least = least.min(cabs(z - x));
                t = (t + dot(z - x, d) / dot(d, d)).max(knot(from)).min(knot(to));
            }
            most = most.max(least);
            area += least * cabs(p(from) - p(to)) * R::HALF * R::count(every);
        }
        Ok([most, area])
    }
}

impl<R: Real> Shape<'_, R> {
    /// How well points tell an outline: an estimate of the relative error of added mass and area that comes from what is between them, and
    /// that no bound of the error in space contains. Of 526 outlines tried (docs/accuracy/outlines.csv) four had errors above 1e-3 that it put
    /// below; those of smooth curves it mostly overrates, by a factor of 10 to 1e5 the better they are told. 0 for a polygon of nothing but
    /// corners; `None` for shapes in closed form. It cannot know what no point shows (five waves through ten points on a circle).
    ///
    /// Cost: a third of compiling the shape; allocates.
    ///
    /// # Errors
    /// Those of points that make no outline; `OutOfMemory`.
    pub fn outline_error(&self) -> Result<Option<R>> {
        let Shape::Curve { points, corners } = *self else { return Ok(None) };
        self.store_len()?;
        let kinked = Kinked::new(points, corners);
        kinked.check()?;
        let n = kinked.len();
        let mut told = Told::room(n, kinked.all().count())?;
        told.points.extend((0..n).map(|i| kinked.point(i)).map(|p| [p.re, p.im]));
        told.corners.extend(kinked.all());
        let p = |k: usize| kinked.point(k);
        let area = area(p, n).abs();
        let reach = (0..n).fold(R::zero(), |l, k| l.max(cabs(p(k) - p(0)))) * R::HALF;
        let relative = |[most, missed]: [R; 2]| (most * R::TWO / reach).max(missed / area);
        let (mut half, mut quarter) = (R::zero(), R::zero());
        for odd in [false, true] {
            let fewer = told.halved(odd)?;
            if fewer.points.len() < 3 {
                return Ok(Some(R::one()));
            }
            half = half.max(relative(fewer.missed()?));
            let fewest = fewer.halved(odd)?;
            if fewest.points.len() >= 3 {
                quarter = quarter.max(relative(fewest.missed()?));
            }
        }
        let falls =
            if half > R::zero() { (quarter / half).max(R::lit(SLOWEST)).min(R::lit(FASTEST)) } else { R::one() };
        let mut corners = told.corners.iter().peekable();
        let bulges = (0..n).filter(|i| corners.next_if(|c| **c == *i).is_none()).map(|i| {
            let (before, here) = (p(if i > 0 { i - 1 } else { n - 1 }), p(i));
            let sides = cabs(here - before).max(cabs(p(after(i, n)) - here));
            let turn = kinked.turn(i).0;
            let (s, c) = (turn / R::lit(4.0)).sin_cos();
            if turn < R::lit(UNKNOWN_TURN) { R::zero() } else { s / c * sides / reach }
        });
        Ok(Some(bulges.fold(half / falls, R::max)))
    }
}
