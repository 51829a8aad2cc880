//! Corners of a curve through points: which points are corners, and the points of their rounding.
//!
//! A corner is taken apart into points of the two flanks, denser towards it by a factor 2 each, and points of the rounding between
//! them, γ(s) = flank(s) + (t₋ + t₊) r ln(1 + e^(−s/r)), as polygons have it: the curve through all of them is as smooth as any other.
//! A flank next to the corner is the parabola through it and the two points that follow.
//!
//! Tested by the tests at its end, `tests/tests/defaults.rs`.

use crate::base::complex::{Complex, cabs, complex, dot};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::geometry::curve::polyline::{cross, distinct, frame};
use crate::scene::Corners;

/// r as a part of the outline's size; at least 512 roundings.
const ROUNDING: f64 = 2e-6;
/// r is at most this part of a segment beside the corner.
const SHORTEST: f64 = 1.0 / 64.0;
/// A turn below this one is never taken for a corner. No regular polygon turns by just this.
const LEAST_TURN: f64 = core::f64::consts::PI * (29.0 / 180.0);
/// Uneven points of a smooth curve do not turn by more than this.
const CLEAR_TURN: f64 = core::f64::consts::PI / 3.0;
/// A turn above this one is a cusp: the smooth curve through its points rounds it better.
const CUSP: f64 = core::f64::consts::PI * (175.0 / 180.0);
/// A corner's turn and curvature are this many times its neighbours'.
const ABOVE: f64 = 4.0;
/// Beside a tip the curvature falls off; beside a corner it does so by no more than this factor from point to point.
const FALL: f64 = 1.5;
/// Turns below this one are those of a straight flank.
const STRAIGHT: f64 = 5e-3;

/// The points of a curve and which of them are corners.
pub(super) struct Kinked<'a, R> {
    points: &'a [[R; 2]],
    corners: Corners<'a>,
    /// The same with repeated ones.
    given: &'a [[R; 2]],
    /// Corners that are given increase: they are found by bisection.
    sorted: bool,
    size: R,
    /// The origin of their frame.
    from: Complex<R>,
}

/// One side of a corner.
#[derive(Clone, Copy)]
struct Flank<R> {
    /// Derivatives by the length s along the flank at the corner: first, half the second.
    slope: Complex<R>,
    bend: Complex<R>,
    /// Length of the segment beside the corner.
    length: R,
    /// How far points are put on it.
    end: R,
}

impl<R: Real> Flank<R> {
    fn straight(self) -> Self {
        let chord = self.slope + self.bend * self.length;
        Flank { slope: chord * (R::one() / cabs(chord)), bend: Complex::default(), ..self }
    }
}

impl<'a, R: Real> Kinked<'a, R> {
    pub(super) fn new(given: &'a [[R; 2]], corners: Corners<'a>) -> Self {
        let points = distinct(given);
        let p = |k: usize| points.get(k).map_or(Complex::default(), |[x, y]| complex(*x, *y));
        let size = (0..points.len()).fold(R::zero(), |l, k| l.max(cabs(p(k) - p(0))));
        let sorted = matches!(corners, Corners::At(list) if list.iter().zip(list.iter().skip(1)).all(|(a, b)| a <= b));
        Kinked { points, corners, given, sorted, size, from: frame(points) }
    }

    /// Corners given are points of the curve, each once. Errors: `OutOfRange`, `BadShape` with the number.
    pub(super) fn check(&self) -> Result<()> {
        let Corners::At(given) = self.corners else { return Ok(()) };
        if let Some(k) = given.iter().find(|k| **k >= self.given.len()) {
            return Err(Error::new(Status::OutOfRange).of("corner", *k as f64));
        }
        let mut others = given.iter();
        while let Some(k) = others.next() {
            // Where they increase the next one tells.
            let repeated = if self.sorted { others.clone().next() == Some(k) } else { others.clone().any(|o| o == k) };
            if repeated {
                return Err(Error::new(Status::BadShape).of("corner", *k as f64));
            }
        }
        Ok(())
    }

    /// Point `k` steps on from point `i`.
    fn along(&self, i: usize, k: isize) -> usize {
        (i as isize).saturating_add(k).checked_rem_euclid(self.points.len() as isize).unwrap_or(0) as usize
    }

    /// Number of points.
    #[cfg(feature = "alloc")]
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    pub(super) fn point(&self, i: usize) -> Complex<R> {
        self.points.get(i).map_or(Complex::default(), |[x, y]| complex(*x, *y) - self.from)
    }

    /// Cosine and sine, times a positive number, of the turn at a point.
    fn turned(&self, i: usize) -> (R, R) {
        let (before, after) =
            (self.point(i) - self.point(self.along(i, -1)), self.point(self.along(i, 1)) - self.point(i));
        (dot(before, after), cross(before, after))
    }

    /// The point that a given one is or, if it was dropped, repeats: the first or the last one.
    fn own(&self, k: usize) -> usize {
        let (first, last) = (0, self.points.len().saturating_sub(1));
        match self.given.get(k) {
            Some([x, y]) if k > last => {
                let far = |i: usize| cabs(complex(*x, *y) - self.from - self.point(i));
                if far(last) < far(first) { last } else { first }
            }
            _ => k,
        }
    }

    /// The amount of the turn at a point, and over the mean of its segments.
    pub(super) fn turn(&self, i: usize) -> (R, R) {
        let (c, s) = self.turned(i);
        let turn = s.abs().atan2(c);
        let (p, from, to) = (self.point(i), self.point(self.along(i, -1)), self.point(self.along(i, 1)));
        (turn, turn * R::TWO / (cabs(p - from) + cabs(to - p)))
    }

    /// The turn stands out on both sides, apart from that of a point next to it which may be the other corner of a blunt end.
    fn stands_out(&self, i: usize) -> bool {
        // Most points turn by less, tan 29° = 0.554: no need for the angle.
        let (c, s) = self.turned(i);
        if s.abs() <= c * R::lit(0.55) {
            return false;
        }
        let (turn, mean) = self.turn(i);
        if turn < R::lit(LEAST_TURN) || turn > R::lit(CUSP) {
            return false;
        }
        // Beside a straight flank without points of its own, one segment is long.
        let segment = |k: isize| cabs(self.point(self.along(i, k)) - self.point(i));
        let curvature = if turn > R::lit(CLEAR_TURN) { turn / segment(-1).min(segment(1)) } else { mean };
        let below = |(t, k): (R, R)| t * R::lit(ABOVE) <= turn && k * R::lit(ABOVE) <= curvature;
        let mut ends = 0;
        for way in [-1, 1] {
            let [next, second] = [1, 2].map(|k| self.turn(self.along(i, way * k)));
            if next.0 > R::lit(LEAST_TURN) && next.0 * R::lit(ABOVE) > turn {
                ends += 1;
                continue;
            }
            let steady = next.0 <= R::lit(STRAIGHT) || next.1 <= second.1 * R::lit(FALL);
            if !below(next) || (second.0 < R::lit(LEAST_TURN) && !below(second)) || !steady {
                return false;
            }
        }
        ends < 2
    }

    /// The point is a corner: given as one, or shown by its neighbours, at least three of them from the next one but for blunt ends.
    pub(super) fn is_corner(&self, i: usize) -> bool {
        match self.corners {
            Corners::None => false,
            Corners::At(list) => {
                let n = self.points.len();
                let listed = if self.sorted {
                    list.get(list.partition_point(|k| *k < i)) == Some(&i)
                } else {
                    list.contains(&i)
                };
                listed || ((i == 0 || i + 1 == n) && list.iter().any(|k| *k >= n && self.own(*k) == i))
            }
            Corners::Auto => {
                let other = |k: isize| self.stands_out(self.along(i, k));
                self.points.len() >= 8
                    && self.stands_out(i)
                    && [-1, 1].into_iter().all(|way| {
                        let (turn, next) = (self.turn(i).0, self.turn(self.along(i, way)).0);
                        let end = next > R::lit(LEAST_TURN) && next * R::lit(ABOVE) > turn;
                        // The other corner of a blunt end is one itself.
                        if end { other(way) && !other(2 * way) } else { !other(2 * way) && !other(3 * way) }
                    })
            }
        }
    }

    /// The flank that leaves corner `i` backwards or forwards.
    fn flank(&self, i: usize, way: isize) -> Flank<R> {
        let (next, second) = (self.along(i, way), self.along(i, 2 * way));
        let (p, q, r) = (self.point(i), self.point(next), self.point(second));
        let length = cabs(q - p);
        let chord = (q - p) * (R::one() / length);
        let straight = Flank { slope: chord, bend: Complex::default(), length, end: length * R::lit(0.7) };
        if self.is_corner(next) {
            return Flank { end: length * R::lit(0.35), ..straight };
        }
        // Newton's form through the three.
        let beyond = cabs(r - q);
        let bend = ((r - q) * (R::one() / beyond) - chord) * (R::one() / (length + beyond));
        Flank { slope: chord - bend * length, bend, ..straight }
    }

    /// Both flanks and r; `None` if the corner is too small to be rounded.
    fn rounding(&self, i: usize) -> Option<([Flank<R>; 2], R)> {
        let mut flanks = [self.flank(i, -1), self.flank(i, 1)];
        let wedge = |[a, b]: [Complex<R>; 2]| cross(a, b).atan2(dot(a, b));
        let chords = wedge(flanks.map(|f| f.straight().slope));
        let tangents = wedge(flanks.map(|f| f.slope));
        // Parabolas that close a wedge, or cross.
        if chords.abs() < R::PI * R::HALF
            && (if chords < R::zero() { -tangents } else { tangents }) < chords.abs() * R::HALF
        {
            flanks = flanks.map(Flank::straight);
        }
        let shortest = flanks.iter().fold(R::MAX, |l, f| l.min(f.length));
        let r = (self.size * R::lit(ROUNDING).max(R::EPSILON * R::lit(512.0))).min(shortest * R::lit(SHORTEST));
        (r > self.size * R::EPSILON * R::lit(8.0)).then_some((flanks, r))
    }

    /// Number of points of the curve, those of the roundings included.
    pub(super) fn count(&self) -> usize {
        (0..self.points.len()).fold(0, |sum: usize, i| {
            let around =
                || self.rounding(i).map_or(0, |(flanks, r)| flanks.iter().map(|f| places(r, f.end).count()).sum());
            sum.saturating_add(1).saturating_add(if self.is_corner(i) { around() } else { 0 })
        })
    }

    /// Numbers of the corners.
    pub(super) fn all(&self) -> impl Iterator<Item = usize> {
        (0..self.points.len()).filter(|i| self.is_corner(*i))
    }

    /// The given point that point `k` of the curve comes from.
    pub(super) fn origin(&self, k: usize) -> usize {
        let (mut at, mut own) = (0, 0);
        self.each(|i, _| {
            if at == k {
                own = i;
            }
            at += 1;
        });
        own
    }

    /// Visits the points of the curve with the numbers of those that they come from.
    pub(super) fn each(&self, mut visit: impl FnMut(usize, Complex<R>)) {
        for i in 0..self.points.len() {
            let p = self.point(i);
            let rounding = if self.is_corner(i) { self.rounding(i) } else { None };
            let Some(([before, after], r)) = rounding else {
                visit(i, p);
                continue;
            };
            let unit = |f: Flank<R>| f.slope * (R::one() / cabs(f.slope));
            let inward = (unit(before) + unit(after)) * r;
            let at = |f: Flank<R>, s: R| p + f.slope * s + f.bend * (s * s) + inward * (-s / r).exp().ln_1p();
            // The places are found from the corner outwards.
            for k in (0..places(r, before.end).count()).rev() {
                if let Some(s) = places(r, before.end).nth(k) {
                    visit(i, at(before, s));
                }
            }
            visit(i, p + inward * R::TWO.ln());
            places(r, after.end).for_each(|s| visit(i, at(after, s)));
        }
    }
}

/// Distances from a corner of its points on one flank.
fn places<R: Real>(r: R, end: R) -> impl Iterator<Item = R> {
    let mut s = r * R::HALF;
    core::iter::from_fn(move || {
        let here = s;
        s += s.max(r * R::lit(0.8));
        (here <= end && here.is_finite()).then_some(here)
    })
}

#[cfg(test)]
#[allow(clippy::indexing_slicing)]
mod tests {
    extern crate std;
    use super::*;
    use std::f64::consts::{PI, TAU};
    use std::vec::Vec;

    type Points = Vec<[f64; 2]>;

    fn found(points: &[[f64; 2]]) -> Vec<usize> {
        Kinked::new(points, Corners::Auto).all().collect()
    }

    /// Section of relative thickness t by x along its upper side, from the tail, which closes with the coefficient 0.1036.
    fn section(t: f64, tail: f64, x: &[f64]) -> Points {
        let y = |x: f64| 5.0 * t * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - tail * x))));
        let above = x.iter().map(|x| [*x, y(*x)]);
        above.chain(x.iter().rev().skip(1).map(|x| [*x, -y(*x)])).collect()
    }

    fn sides(corners: &[[f64; 2]], each: usize) -> Points {
        let n = corners.len();
        let side = |k: usize| (0..each).map(move |i| (k, (k + 1) % n, i as f64 / each as f64));
        let all = (0..n).flat_map(side);
        all.map(|(a, b, t)| [0, 1].map(|c| corners[a][c] * (1.0 - t) + corners[b][c] * t)).collect()
    }

    #[test]
    fn tips_of_smooth_outlines_are_no_corners_however_few_the_points() {
        for b in [1.0, 0.3, 0.1, 0.03, 0.01] {
            for n in [6, 8, 12, 16, 24, 48, 100_usize] {
                for shift in [0.0, 0.25, 0.5] {
                    let t = |k: usize| TAU * (k as f64 + shift) / n as f64;
                    let eccentric: Points = (0..n).map(|k| [t(k).cos(), b * t(k).sin()]).collect();
                    assert_eq!(found(&eccentric), [], "{b} {n} {shift}");
                    // The same by even lengths, with few points at the tips.
                    let fine: Points =
                        (0..=20_000).map(|k| TAU * k as f64 / 2e4).map(|t| [t.cos(), b * t.sin()]).collect();
                    let mut ways = std::vec![0.0];
                    for w in fine.windows(2) {
                        ways.push(ways[ways.len() - 1] + (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]));
                    }
                    let whole = ways[20_000];
                    let at = |k: usize| ways.partition_point(|s| *s < whole * (k as f64 + shift) / n as f64);
                    let even: Points = (0..n).map(|k| fine[at(k)]).collect();
                    assert_eq!(found(&even), [], "{b} {n} {shift} by length");
                }
            }
        }
    }

    #[test]
    fn tails_of_sections_are_corners_and_noses_are_not() {
        let table =
            [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1, 0.075, 0.05, 0.025, 0.0125, 0.0];
        for t in [0.06, 0.12, 0.18, 0.24] {
            let mut spacings = std::vec![table.to_vec()];
            for n in [10, 20, 30, 40, 80, 160] {
                spacings.push((0..=n).map(|k| 0.5 + 0.5 * (PI * f64::from(k) / f64::from(n)).cos()).collect());
                spacings.push((0..=n).map(|k| 1.0 - f64::from(k) / f64::from(n)).collect());
            }
            for x in spacings {
                let sharp = section(t, 0.1036, &x);
                assert_eq!(found(&sharp), [0], "{t} {}", x.len());
                let blunt = section(t, 0.1015, &x);
                assert_eq!(found(&blunt), [0, blunt.len() - 1], "{t} {}", x.len());
            }
        }
    }

    #[test]
    fn corners_between_straight_and_curved_flanks_are_found() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let l_shape = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        for each in [4, 5, 10, 50] {
            assert_eq!(found(&sides(&square, each)), [0, 1, 2, 3].map(|k| k * each));
            assert_eq!(found(&sides(&l_shape, each)), [0, 1, 2, 3, 4, 5].map(|k| k * each));
        }
        // Their corners alone do not tell.
        assert_eq!(found(&square), []);
        // All corners of a regular polygon, or none.
        for n in 3..30_usize {
            let corner = |k: usize| (TAU * k as f64 / n as f64 + 0.1).sin_cos();
            let polygon: Points = (0..n).map(corner).map(|(y, x)| [x, y]).collect();
            for each in [4, 8] {
                let expected: Vec<usize> = if n <= 12 { (0..n).map(|k| k * each).collect() } else { Vec::new() };
                assert_eq!(found(&sides(&polygon, each)), expected, "{n}");
            }
        }
        for n in [8_usize, 20, 40, 100] {
            let arc: Points = (0..=n).map(|k| PI * k as f64 / n as f64).map(|t| [t.cos(), t.sin()]).collect();
            let chord = (1..n).map(|k| [-1.0 + 2.0 * k as f64 / n as f64, 0.0]);
            assert_eq!(found(&arc.iter().copied().chain(chord).collect::<Points>()), [0, n]);
            assert_eq!(found(&arc), [0, n], "without points on the chord");
        }
    }

    #[test]
    fn a_corner_that_is_none_leaves_a_smooth_curve_where_it_was() {
        // A circle, and lobes whose curvature is least at t = π/4, where a chord would be off by 0.02 of the second power of a step and
        // the parabolas' tangents turn by more than half a turn. Parabolas are off by less than the third power.
        for (amplitude, n) in [(0.0, 16_usize), (0.0, 40), (0.05, 96), (0.05, 192)] {
            let (h, radius) = (TAU / n as f64, |t: f64| 1.0 + amplitude * (4.0 * t).cos());
            let line: Points =
                (0..n).map(|k| h * k as f64).map(|t| [radius(t) * t.cos(), radius(t) * t.sin()]).collect();
            for at in [0, 3, n / 8, n - 1] {
                let numbers = [at];
                let mut off = 0.0_f64;
                let kinked = Kinked::new(&line, Corners::At(&numbers));
                kinked.each(|_, p| off = off.max((cabs(p) - radius(p.im.atan2(p.re))).abs()));
                let most = if amplitude > 0.0 && at == n / 8 { 0.1 } else { 0.6 };
                assert!(off < most * h * h * h, "{amplitude} {n} {at}: {:e} times h³", off / (h * h * h));
            }
        }
    }

    #[test]
    fn a_rounded_corner_passes_through_its_neighbours_and_is_cut_by_its_rounding() {
        let points = sides(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 4);
        let kinked = Kinked::new(&points, Corners::At(&[0]));
        let mut all: Vec<(usize, Complex<f64>)> = Vec::new();
        kinked.each(|own, p| all.push((own, p)));
        assert_eq!(all.len(), kinked.count());
        let r = ROUNDING * 2.0_f64.sqrt();
        // t₋ + t₊ = (1, 1), r ln 2 of it.
        let nearest = all.iter().map(|(_, p)| cabs(*p)).fold(1.0, f64::min);
        assert!((nearest - 2.0_f64.sqrt() * r * 2.0_f64.ln()).abs() < 1e-12);
        for (own, p) in &all {
            // The sides: e^(−x/r) + e^(−y/r) = 1.
            let off = (-p.re / r).exp() + (-p.im / r).exp() - 1.0;
            assert!(*own != 0 || off.abs() < 1e-9, "{p:?}");
            assert!(*own == 0 || cabs(*p - complex(points[*own][0], points[*own][1])) == 0.0);
        }
        // Neighbours are at most a little more than twice as far as those before.
        let chord = |k: usize| cabs(all[(k + 1) % all.len()].1 - all[k].1);
        for k in 0..all.len() {
            let ratio = chord((k + 1) % all.len()) / chord(k);
            assert!((0.3..3.4).contains(&ratio), "{k}: {ratio}");
        }
        // A last point that is repeated, whichever it repeats, is the corner that it repeats.
        for (corner, repeated) in [(0, points[0]), (15, points[15])] {
            let longer: Points = points.iter().copied().chain([repeated]).collect();
            let all: Vec<usize> = Kinked::new(&longer, Corners::At(&[16])).all().collect();
            assert_eq!(all, [corner]);
        }
        let wrong = Kinked::new(&points, Corners::At(&[16])).check().unwrap_err();
        assert_eq!((wrong.status, wrong.what, wrong.value), (Status::OutOfRange, "corner", 16.0));
        for twice in [&[0, 3, 3, 8][..], &[8, 3, 0, 3]] {
            let wrong = Kinked::new(&points, Corners::At(twice)).check().unwrap_err();
            assert_eq!((wrong.status, wrong.what, wrong.value), (Status::BadShape, "corner", 3.0));
        }
    }
}
