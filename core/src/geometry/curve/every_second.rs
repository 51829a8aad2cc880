//! How well points tell an outline: the curve through every second of them, at those left out.
//!
//! Both halves of the points are tried. What they miss is measured in two ways, as the added mass of a body feels it: a disc's grows by twice a
//! part of its radius, wherever along the outline it is added, a plate's by that of its length. A quarter of the points tells how fast the rest
//! converges: as it did from a quarter to a half, it is taken to do from a half to all. Where a curve turns by far without a corner, the bulge
//! of an arc over the longer side counts: there, one half knows no more than the other. So does what the curve leaves the chord by where a side
//! is far longer than those beside it: it may be straight, or an arc whose points were lost. Where it is far shorter, its direction bends the
//! curve beside it, and either half has but one of its ends: the curve through all is compared with them.
//!
//! Tested by the tests at its end, `tests/tests/outlines.rs`.

use super::corners::Kinked;
use super::polyline::{after, area, cross};
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
/// A side so many times longer than those beside it is a gap, looked at in so many places.
const GAP: f64 = 3.0;
const SAMPLES: usize = 16;
/// Places that are looked at on a side beside a pair of close points, by how much more than at the points left out the curve through all
/// leaves that through a half where it is bent by the pair, and how much more than the area between may come of it.
const PLACES: usize = 5;
const BENT: f64 = 2.0;
const MARGIN: f64 = 4.0;
/// A turn above this one, at a point that is no corner, may be anything.
const UNKNOWN_TURN: f64 = core::f64::consts::PI / 3.0;

/// Points of a curve and the numbers of its corners.
struct Told<R> {
    points: Vec<[R; 2]>,
    corners: Vec<usize>,
    /// Points left out, each with the number of the point before it.
    left: Vec<(usize, [R; 2])>,
    /// How many places after the first corner the points of a half stood.
    places: Vec<usize>,
}

impl<R: Real> Told<R> {
    fn room(points: usize, corners: usize) -> Result<Self> {
        Ok(Told { points: room(points)?, corners: room(corners)?, left: room(points)?, places: room(points)? })
    }

    /// The corners and every second point between them, from the first or the second on.
    fn halved(&self, odd: bool) -> Result<Self> {
        let n = self.points.len();
        let start = self.corners.first().copied().unwrap_or(0);
        let mut half = Self::room(n, self.corners.len())?;
        let (mut corners, mut since) = (self.corners.iter().peekable(), 0_usize);
        let turned = self.points.iter().enumerate().skip(start).chain(self.points.iter().enumerate().take(start));
        for (place, (i, p)) in turned.enumerate() {
            let corner = corners.next_if(|c| **c == i).is_some();
            if corner {
                since = 0;
                half.corners.push(half.points.len());
            }
            // Two in a row are never left out.
            let seam = odd && self.corners.is_empty() && n % 2 == 1 && i + 1 == n;
            if corner || seam || since.is_multiple_of(2) != odd {
                half.points.push(*p);
                half.places.push(place);
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
        let through = Through::new(&self.points, &self.corners)?;
        let curve = through.curve();
        let every = self.left.len().div_ceil(MOST_LOOKED_AT).max(1);
        let (mut most, mut area) = (R::zero(), R::zero());
        for (before, [x, y]) in self.left.iter().step_by(every) {
            let z = complex(*x, *y);
            let (from, to) = through.around(*before);
            let (mut nearest, mut t) = (R::MAX, through.knot(from));
            for k in from..to {
                let (a, d) = (through.point(k), through.point(k + 1) - through.point(k));
                let part = (dot(z - a, d) / dot(d, d)).max(R::zero()).min(R::one());
                let distance = cabs(a + d * part - z);
                if distance < nearest {
                    (nearest, t) = (distance, through.knot(k) + (through.knot(k + 1) - through.knot(k)) * part);
                }
            }
            let mut least = R::MAX;
            for _ in 0..STEPS {
                let [x, d, _] = curve.jet_real(t);
                least = least.min(cabs(z - x));
                t = (t + dot(z - x, d) / dot(d, d)).max(through.knot(from)).min(through.knot(to));
            }
            most = most.max(least);
            area += least * cabs(through.point(from) - through.point(to)) * R::HALF * R::count(every);
        }
        Ok([most, area])
    }

    /// Numbers of the points after which a side is far longer than those beside it, corners apart: it may be straight, or its points lost.
    fn gaps(&self) -> impl Iterator<Item = usize> {
        let n = self.points.len();
        let p = move |k: usize| self.points.get(k % n.max(1)).map_or(Complex::default(), |[x, y]| complex(*x, *y));
        let side = move |k: usize| cabs(p(k + 1) - p(k));
        let corner = move |k: usize| self.corners.binary_search(&(k % n.max(1))).is_ok();
        (0..n).filter(move |k| {
            let before = if corner(*k) { R::zero() } else { side(k + n - 1) };
            let after = if corner(k + 1) { R::zero() } else { side(k + 1) };
            // Between two corners sides are straight.
            !(corner(*k) && corner(k + 1)) && before.max(after) * R::lit(GAP) <= side(*k)
        })
    }

    /// Numbers of the points after which a side is far shorter than those beside it, but for what is beyond a corner: small errors of its
    /// ends turn it by far, and the curve with it, while either half has only one of them.
    fn pairs(&self) -> impl Iterator<Item = usize> {
        let n = self.points.len();
        let p = move |k: usize| self.points.get(k % n.max(1)).map_or(Complex::default(), |[x, y]| complex(*x, *y));
        let side = move |k: usize| cabs(p(k + 1) - p(k));
        let corner = move |k: usize| self.corners.binary_search(&(k % n.max(1))).is_ok();
        (0..n).filter(move |k| {
            let beside = |corner: bool, side: R| if corner { R::MAX } else { side };
            let shorter = beside(corner(*k), side(k + n - 1)).min(beside(corner(k + 1), side(k + 1)));
            shorter < R::MAX && side(*k) * R::lit(GAP) <= shorter
        })
    }

    /// Points of the curve on the sides beside pairs, each with the number of the point before it.
    fn beside_pairs(&self) -> Result<Vec<(usize, [R; 2])>> {
        let count = self.pairs().count();
        let mut all = room(count.saturating_mul(2 * PLACES))?;
        if count == 0 {
            return Ok(all);
        }
        let through = Through::new(&self.points, &self.corners)?;
        let (curve, n) = (through.curve(), self.points.len());
        for k in self.pairs().flat_map(|k| [if k > 0 { k - 1 } else { n - 1 }, after(k, n)]) {
            let (from, to) = through.around(k);
            let (start, end) = (through.knot(from), through.knot(to));
            all.extend((1..=PLACES).map(|i| {
                let z = curve.jet_real(start + (end - start) * (R::count(i) / R::count(PLACES + 1)))[0];
                (k, [z.re, z.im])
            }));
        }
        Ok(all)
    }

    /// The same half with other points to look at, of the curve through all of the points of `whole`.
    fn looks_at(&mut self, all: &[(usize, [R; 2])], whole: &Self) {
        let (n, start) = (whole.points.len(), whole.corners.first().copied().unwrap_or(0));
        let last = self.points.len().saturating_sub(1);
        self.left.clear();
        self.left.extend(all.iter().map(|(k, z)| {
            let place = (k + n - start) % n.max(1);
            (self.places.partition_point(|p| *p <= place).wrapping_sub(1).min(last), *z)
        }));
    }

    /// How far the curve leaves the chords of gaps, and the area between.
    fn bulging(&self) -> Result<[R; 2]> {
        let (mut most, mut area) = (R::zero(), R::zero());
        if self.gaps().next().is_none() {
            return Ok([most, area]);
        }
        let through = Through::new(&self.points, &self.corners)?;
        let curve = through.curve();
        let n = self.points.len();
        let p = |k: usize| self.points.get(k % n.max(1)).map_or(Complex::default(), |[x, y]| complex(*x, *y));
        for k in self.gaps() {
            let (from, to) = through.around(k);
            let (start, length) = (through.knot(from), cabs(p(k + 1) - p(k)));
            let unit = (p(k + 1) - p(k)) * (R::one() / length);
            let step = (through.knot(to) - start) / R::count(SAMPLES);
            let off = (1..SAMPLES).map(|i| curve.jet_real(start + step * R::count(i))[0] - p(k)).fold(
                R::zero(),
                |off: R, x| {
                    let along = dot(x, unit);
                    if along > R::zero() && along < length { off.max(cross(unit, x).abs()) } else { off }
                },
            );
            most = most.max(off);
            area += off * length * R::lit(2.0 / 3.0);
        }
        Ok([most, area])
    }
}

/// A curve through points and the roundings of their corners.
struct Through<R> {
    points: Vec<Complex<R>>,
    knots: Vec<R>,
    /// Of every point given, the first of its rounding, or itself.
    first: Vec<usize>,
    coefficients: Vec<R>,
    modes: through_points::Modes,
}

impl<R: Real> Through<R> {
    fn new(given: &[[R; 2]], corners: &[usize]) -> Result<Self> {
        let kinked = Kinked::new(given, Corners::At(corners));
        let n = kinked.count();
        let (mut points, mut first, mut knots) = (room::<Complex<R>>(n)?, room(given.len())?, room(n)?);
        kinked.each(|own, p| {
            if own == first.len() {
                first.push(points.len());
            }
            points.push(p);
        });
        let p = |k: usize| points.get(k).copied().unwrap_or_default();
        let mut scratch = filled(through_points::Memory::<R>::len(&n).ok_or(Status::SizeOverflow)?)?;
        let mut coefficients = filled(through_points::coefficients_len(n))?;
        let mut memory = through_points::Memory::take(&n, &mut &mut *scratch)?;
        let modes = through_points::write(p, n, &mut memory, &mut coefficients)?;
        knots.extend((0..n).map(|k| through_points::knot(memory.knots, k)));
        Ok(Through { points, knots, first, coefficients, modes })
    }

    fn curve(&self) -> Fourier<'_, R> {
        let coefficients = part(&self.coefficients, 0, 2 * self.modes.count);
        Fourier { centre: R::one(), stride: R::one(), down: self.modes.down, coefficients }
    }

    fn point(&self, k: usize) -> Complex<R> {
        let n = self.points.len();
        self.points.get(k).or(self.points.get(k.saturating_sub(n))).copied().unwrap_or_default()
    }

    /// Parameter of a point, in its first turn or the second.
    fn knot(&self, k: usize) -> R {
        let knot = |k: usize| self.knots.get(k).copied().unwrap_or(R::NAN);
        k.checked_sub(self.knots.len()).map_or_else(|| knot(k), |k| knot(k) + R::TAU)
    }

    /// From the rounding of a point given to that of the next one, both included.
    fn around(&self, given: usize) -> (usize, usize) {
        let (n, all) = (self.points.len(), self.first.len());
        let begins = |k: usize| match k.checked_sub(all) {
            Some(k) => self.first.get(k).map_or(n, |k| k + n),
            None => self.first.get(k).copied().unwrap_or(n),
        };
        (begins(given), begins(given + 2).saturating_sub(1))
    }
}

impl<R: Real> Shape<'_, R> {
    /// How well points tell an outline: an estimate of the relative error of added mass and area that comes from what is between them, and
    /// that no bound of the error in space contains. Of 580 outlines tried (docs/accuracy/outlines.csv) three had errors above 1e-3 that it put
    /// below; those of smooth curves it mostly overrates, by a factor of 10 to 1e5 the better they are told. 0 for a polygon of nothing but
    /// corners; `None` for shapes in closed form. It cannot know what no point shows (five waves through ten points on a circle).
    ///
    /// Cost: O(points²) for the curves through halves and quarters of the points, and through all of them where a side is a gap; allocates.
    ///
    /// # Errors
    /// `NotFinite`, `BadShape`, `SelfIntersection`, `OutOfRange` for points that make no outline; `OutOfMemory`.
    pub fn outline_error(&self) -> Result<Option<R>> {
        let Shape::Curve { points, corners } = *self else { return Ok(None) };
        self.validate()?;
        match estimated(&Kinked::new(points, corners)) {
            // Fewer points than an outline takes may be on one line, or twice in one place: they tell nothing.
            Err(e) if e.status != Status::OutOfMemory => Ok(Some(R::one())),
            Ok(e) if e.is_nan() => Ok(Some(R::one())),
            other => other.map(Some),
        }
    }
}

fn estimated<R: Real>(kinked: &Kinked<'_, R>) -> Result<R> {
    let n = kinked.len();
    let mut told = Told::room(n, kinked.all().count())?;
    told.points.extend((0..n).map(|i| kinked.point(i)).map(|p| [p.re, p.im]));
    told.corners.extend(kinked.all());
    let p = |k: usize| kinked.point(k);
    let area = area(p, n).abs();
    let reach = (0..n).fold(R::zero(), |l, k| l.max(cabs(p(k) - p(0)))) * R::HALF;
    let relative = |[most, missed]: [R; 2]| (most * R::TWO / reach).max(missed / area);
    let (mut half, mut quarter, mut apart, mut bent) = (R::zero(), R::zero(), R::zero(), R::zero());
    let beside = told.beside_pairs()?;
    for odd in [false, true] {
        let mut fewer = told.halved(odd)?;
        if fewer.points.len() < 3 {
            return Ok(R::one());
        }
        half = half.max(relative(fewer.missed()?));
        let fewest = fewer.halved(odd)?;
        if fewest.points.len() >= 3 {
            quarter = quarter.max(relative(fewest.missed()?));
        }
        if !beside.is_empty() {
            fewer.looks_at(&beside, &told);
            let [most, missed] = fewer.missed()?;
            apart = apart.max(most * R::TWO / reach);
            bent = bent.max(missed * R::lit(MARGIN / PLACES as f64) / area);
        }
    }
    // On a smooth curve it leaves that through a half no farther than its points do.
    let bent = if apart > half * R::lit(BENT) { bent } else { R::zero() };
    let falls = if half > R::zero() { (quarter / half).max(R::lit(SLOWEST)).min(R::lit(FASTEST)) } else { R::one() };
    let mut corners = told.corners.iter().peekable();
    let bulges = (0..n).filter(|i| corners.next_if(|c| **c == *i).is_none()).map(|i| {
        let (before, here) = (p(if i > 0 { i - 1 } else { n - 1 }), p(i));
        let sides = cabs(here - before).max(cabs(p(after(i, n)) - here));
        let turn = kinked.turn(i).0;
        let (s, c) = (turn / R::lit(4.0)).sin_cos();
        if turn < R::lit(UNKNOWN_TURN) { R::zero() } else { s / c * sides / reach }
    });
    let gaps = relative(told.bulging()?);
    Ok(bulges.fold((half / falls).max(gaps).max(bent), R::max))
}
