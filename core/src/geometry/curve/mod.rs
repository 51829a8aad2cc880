//! Outlines: validated shapes as analytic closed curves, with the grading of their nodes.
//!
//! Every curve runs counter-clockwise in a 2π-periodic parameter t, is analytic in t, and can be evaluated at complex t.
//! Lengths are those of the shape's own drawing frame.
//!
//! Ellipses, stars and rectangles have exactly the measures given. A side of a polygon, of length L between right angles
//! of corner radius R, lies inside the line through its vertices by 0.76 R ln(1 + e^(−1.31 L/R)) at its middle: 3 % of L
//! at the largest radius L/2, 2·10⁻⁷ L at L/10, nothing to rounding from L/28 on.
//!
//! Tested by `geometry/curve/tests.rs`, `geometry/curve/added_mass_test.rs`.

#[cfg(test)]
mod added_mass_test;
mod corners;
mod ellipse;
mod even;
#[cfg(feature = "alloc")]
mod every_second;
mod fourier;
mod from_shape;
mod polygon;
mod polyline;
#[cfg(test)]
mod tests;
mod through_points;

pub use ellipse::Ellipse;
pub use fourier::Fourier;
pub use polygon::{Polygon, SHARP};
pub(crate) use polyline::distinct;

use crate::base::complex::{Complex, cabs, complex, dot};
use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::geometry::grading::{Grading, Ladder, walk, write_fitting};
use even::Even;
use polygon::CORNER;
use polyline::cross;

/// A closed analytic curve.
#[derive(Clone, Copy, Debug)]
pub enum Curve<'a, R> {
    /// Ellipse.
    Ellipse(Ellipse<R>),
    /// Polygon with rounded corners.
    Polygon(Polygon<'a, R>),
    /// Fourier sum: a star, or a curve through points.
    Fourier(Fourier<'a, R>),
}

impl<R: Real> Curve<'_, R> {
    /// γ, γ′, γ″ at a complex parameter. Polygons: |Im t| P/2π below π r of the nearest corner.
    pub fn jet(&self, t: Complex<R>) -> [Complex<R>; 3] {
        match self {
            Curve::Ellipse(c) => c.jet(t),
            Curve::Polygon(c) => c.jet(t),
            Curve::Fourier(c) => c.jet(t),
        }
    }

    /// γ, γ′, γ″ at a real parameter.
    pub fn jet_real(&self, t: R) -> [Complex<R>; 3] {
        match self {
            Curve::Ellipse(c) => c.jet_real(t),
            Curve::Polygon(c) => c.jet_real(t),
            Curve::Fourier(c) => c.jet_real(t),
        }
    }

    /// γ(t + u) − γ(t), to relative accuracy in u, and γ′(t + u).
    pub fn change(&self, t: R, u: Complex<R>) -> [Complex<R>; 2] {
        match self {
            Curve::Ellipse(c) => [c.delta(t, u), c.jet(u + t)[1]],
            Curve::Polygon(c) => [c.delta(t, u), c.jet(u + t)[1]],
            Curve::Fourier(c) => c.change(t, u),
        }
    }
}

/// Bounds of a curve's derivatives, of all parameters: |γ′|, |γ″|, |γ‴|. Infinite: see [`Curve::bend`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spread<R>(pub [R; 3]);

impl<R: Real> Curve<'_, R> {
    /// The bounds, once for many calls of [`bend`](Self::bend).
    pub(crate) fn spread(&self) -> Spread<R> {
        Spread(match self {
            Curve::Ellipse(c) => [c.a.max(c.b); 3],
            Curve::Polygon(c) => [c.perimeter / R::TAU, R::MAX, R::MAX],
            Curve::Fourier(c) => c.modes().fold([R::zero(); 3], |[first, second, third], (k, c)| {
                let k = k.abs();
                let size = cabs(c) * k;
                [first + size, second + size * k, third + size * k * k]
            }),
        })
    }

    /// A number with which |γ(t + u) − γ(t) − γ′(t) u| ≤ w²/2 times it for all |u| ≤ w, given |γ″(t)|.
    pub(crate) fn bend(&self, spread: &Spread<R>, t: R, w: R, second: R) -> R {
        let Spread([first, most, third]) = *spread;
        match self {
            Curve::Polygon(c) => c.bend(t, w),
            // A chord is no longer than its arc.
            _ => most.min(second + w * third).min(R::lit(4.0) * first / w),
        }
    }

    /// A bound of the lengths of arcs given by their ends.
    pub(crate) fn longest(&self, arcs: impl Iterator<Item = (R, R)>) -> R {
        let spread = self.spread();
        let Spread([first, ..]) = spread;
        arcs.fold(R::zero(), |longest, (from, to)| {
            let turns = if to > from { R::zero() } else { R::TAU };
            let w = (to - from + turns) * R::HALF;
            let [_, d, second] = self.jet_real(from + w);
            let speed = cabs(d) + w * self.bend(&spread, from + w, w, cabs(second));
            longest.max(R::TWO * w * speed.min(first))
        })
    }
}

/// Integrals over the area inside an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaProperties<R> {
    /// Area.
    pub area: R,
    /// Centroid, in the drawing frame.
    pub centroid: Complex<R>,
    /// ∫ |x − centroid|² dA.
    pub polar_moment: R,
    /// Length of the outline.
    pub perimeter: R,
    /// Largest distance of the outline from the centroid.
    pub reach: R,
}

#[derive(Clone, Copy, Debug)]
enum Kind<R> {
    Ellipse(Ellipse<R>),
    Polygon { corners: usize, perimeter: R },
    Fourier { centre: R, stride: R, down: usize, count: usize },
}

impl<R: Real> Kind<R> {
    /// Reals in the store before the grading.
    fn len(&self) -> usize {
        match *self {
            Kind::Ellipse(_) => 0,
            Kind::Polygon { corners, .. } => corners * CORNER,
            Kind::Fourier { count, .. } => count * 2,
        }
    }

    fn curve<'a>(&self, store: &'a [R]) -> Curve<'a, R> {
        let own = part(store, 0, self.len());
        match *self {
            Kind::Ellipse(ellipse) => Curve::Ellipse(ellipse),
            Kind::Polygon { perimeter, .. } => Curve::Polygon(Polygon { perimeter, corners: own }),
            Kind::Fourier { centre, stride, down, .. } => {
                Curve::Fourier(Fourier { centre, stride, down, coefficients: own })
            }
        }
    }
}

/// A compiled shape: what to read where in its store. Holds no references and can be kept beside the store.
#[derive(Clone, Copy, Debug)]
pub struct Outline<R> {
    kind: Kind<R>,
    rungs: usize,
    /// Samples that find the bends of a Fourier sum, and the length of the outline by them.
    samples: usize,
    perimeter: R,
}

impl<R: Real> Default for Outline<R> {
    /// The unit circle.
    fn default() -> Self {
        Outline {
            kind: Kind::Ellipse(Ellipse { a: R::one(), b: R::one() }),
            rungs: 0,
            samples: 0,
            perimeter: R::zero(),
        }
    }
}

impl<R: Real> Outline<R> {
    /// The outline together with the store it was compiled into.
    pub fn view<'a>(&self, store: &'a [R]) -> OutlineView<'a, R> {
        let graded = store.get(self.kind.len()..).unwrap_or(&[]);
        let grading = if self.rungs == 0 { Grading::uniform() } else { Grading::read(graded, self.rungs) };
        OutlineView { curve: self.kind.curve(store), grading }
    }

    /// Replaces the grading by that of these ladders, as far as there is memory for their rungs. Errors: `MemoryTooSmall`
    /// if there is none at all.
    pub(crate) fn regrade(&mut self, ladders: impl Iterator<Item = Ladder<R>>, store: &mut [R]) -> Result<()> {
        let graded = store.get_mut(self.kind.len()..).unwrap_or(&mut []);
        (self.rungs, _) = write_fitting(ladders, graded)?;
        Ok(())
    }
}

/// A node: position and its derivatives with respect to the graded parameter s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<R> {
    /// Parameter of the curve.
    pub t: R,
    /// Position.
    pub x: Complex<R>,
    /// dx/ds.
    pub dx: Complex<R>,
    /// d²x/ds².
    pub ddx: Complex<R>,
}

/// A curve and the grading of its nodes.
#[derive(Clone, Copy, Debug)]
pub struct OutlineView<'a, R> {
    /// The curve.
    pub curve: Curve<'a, R>,
    /// The map from the curve's parameter t to the nodes' parameter s.
    pub grading: Grading<'a, R>,
}

impl<R: Real> OutlineView<'_, R> {
    /// The point at parameter t with its derivatives in s: dx/ds = γ′/s′, d²x/ds² = γ″/s′² − γ′ s″/s′³.
    #[cfg(test)]
    pub fn node_at(&self, t: R) -> Node<R> {
        let [_, slope, bend] = self.grading.jet(t);
        self.node_of([t, slope, bend])
    }

    /// d²s/dz² of the nodes' parameter as a function of the point z = γ(t + u), u complex: (s″ − s′ γ″/γ′)/γ′².
    #[cfg(feature = "derivatives")]
    pub(crate) fn second_rate(&self, t: R, u: Complex<R>) -> Complex<R> {
        let [_, first, second] = self.curve.jet(u + t);
        let [slope, bend] = self.grading.slopes(t, u);
        (bend - slope * second / first) / (first * first)
    }

    /// The same from t, ds/dt and d²s/dt².
    fn node_of(&self, [t, slope, bend]: [R; 3]) -> Node<R> {
        let [x, first, second] = self.curve.jet_real(t);
        let rate = R::one() / slope;
        Node { t, x, dx: first * rate, ddx: (second - first * (bend * rate)) * (rate * rate) }
    }

    /// Node `k` of `n`, at s = 2πk/n. Errors: `OutOfRange` unless k < n, `Internal` when the parameter could not
    /// be found to rounding. Cost: some ten evaluations of the grading, one of the curve.
    #[cfg(test)]
    pub fn node(&self, k: usize, n: usize) -> Result<Node<R>> {
        Ok(self.node_at(self.grading.node(k, n)?))
    }

    /// Calls `visit` with `n` nodes in turn.
    pub(crate) fn walk(&self, n: usize, mut visit: impl FnMut(Node<R>)) -> Result<()> {
        walk(&self.grading, n, &mut |jet| visit(self.node_of(jet)))
    }

    /// Calls `visit` with `n` nodes in turn, even in s, or for Fourier sums in t.
    fn around(&self, n: usize, mut visit: impl FnMut(Node<R>)) -> Result<()> {
        let Curve::Fourier(fourier) = self.curve else { return self.walk(n, visit) };
        let even = Even::new(fourier, n);
        for k in 0..n {
            let [x, dx, ddx] = even.jet(k);
            visit(Node { t: R::TAU * R::count(k) / R::count(n), x, dx, ddx });
        }
        Ok(())
    }

    /// Area, centroid, polar moment, perimeter and reach by boundary integrals: the trapezoid rule, in s for
    /// polygons, exact to rounding; closed form for ellipses. Errors: `Internal` as for the nodes.
    pub fn properties(&self) -> Result<AreaProperties<R>> {
        let n = match &self.curve {
            Curve::Ellipse(ellipse) => return Ok(ellipse.properties()),
            Curve::Polygon(_) => (self.grading.rungs() * 8).max(2048),
            // Of the moments the rule in t leaves nothing from four times the highest mode on; the perimeter is near rounding too.
            Curve::Fourier(fourier) => {
                let modes = fourier.modes().fold(R::zero(), |top, (k, _)| top.max(k.abs())).to_f64() as usize;
                (modes * 6).max(2048)
            }
        };
        let step = R::TAU / R::count(n);
        let origin = (self.curve.jet_real(R::zero())[0] + self.curve.jet_real(R::PI)[0]) * R::HALF;
        let (mut area, mut first, mut polar, mut perimeter) =
            (R::zero(), Complex::<R>::default(), R::zero(), R::zero());
        self.around(n, |node| {
            let z = node.x - origin;
            let flux = cross(z, node.dx);
            area += flux;
            first += z * flux;
            polar += dot(z, z) * flux;
            perimeter += cabs(node.dx);
        })?;
        // ∇·x = 2, ∇·(x₁x) = 3x₁, ∇·(|x|²x) = 4|x|²
        let shift = first / complex(area, R::zero()) * R::lit(2.0 / 3.0);
        let centroid = origin + shift;
        let (area, polar) = (area * step * R::HALF, polar * step / R::lit(4.0));
        let (mut reach, mut farthest) = (R::zero(), R::zero());
        self.around(n / 4, |node| {
            let z = node.x - centroid;
            if cabs(z) > reach {
                (reach, farthest) = (cabs(z), node.t);
            }
        })?;
        for _ in 0..4 {
            let [x, d, dd] = self.curve.jet_real(farthest);
            let z = x - centroid;
            reach = reach.max(cabs(z));
            let curvature = dot(d, d) + dot(z, dd);
            if curvature < R::zero() {
                farthest -= dot(z, d) / curvature;
            }
        }
        Ok(AreaProperties {
            area,
            centroid,
            polar_moment: polar - area * dot(shift, shift),
            perimeter: perimeter * step,
            reach,
        })
    }
}
