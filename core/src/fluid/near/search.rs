//! Preimages on a curve without closed form: Newton's method, and a choice among its roots by a sum that is known.
//!
//! Tested by `tests/near_contact` (rectangles).
#![allow(clippy::indexing_slicing)] // Indices run over arrays of the same constant length.

use crate::base::complex::{Complex, cabs, complex, csin_cos, dot};
use crate::base::machine::{Machine, Task};
use crate::base::memory::at;
use crate::base::scalar::Real;
use crate::fluid::near::buffers::Preimage;
use crate::fluid::near::pole::{self, LANES, load};
use crate::fluid::near::preimage::{Roots, Source, Targets, wrapped};
use crate::geometry::grading::Offset;

/// Up to two preimages.
type Found<R> = [Option<Preimage<R>>; 2];

/// Searches for the preimages of all targets.
struct Search<'a, 'b, R, F> {
    source: &'b Source<'a, R>,
    targets: &'b Targets<'b, R>,
    visit: F,
}

impl<R: Real, F: FnMut(usize, Preimage<R>)> Task for Search<'_, '_, R, F> {
    type Output = ();
    #[inline(always)]
    fn run(mut self) {
        let targets = self.targets;
        for (k, x) in targets.nodes.points().enumerate() {
            let z = if targets.own { x } else { targets.shift + targets.turn * x };
            for p in self.source.by_search(z, targets.own.then_some(k)).into_iter().flatten() {
                (self.visit)(k, p);
            }
        }
    }
}

impl<R: Real> Source<'_, R> {
    /// Calls `visit` with (row, preimage), in the order of the rows.
    pub(super) fn search(&self, targets: &Targets<'_, R>, visit: impl FnMut(usize, Preimage<R>)) {
        Machine::here().run(Search { source: self, targets, visit });
    }

    /// Newton's method from the nodes that are close relative to their spacing, and the choice among the roots found by the
    /// known sum of the weights.
    #[inline(always)]
    fn by_search(&self, z: Complex<R>, own: Option<usize>) -> Found<R> {
        let n = self.nodes.t.len();
        let h = self.nodes.step;
        if self.farther_than_seven_spacings(z) {
            return [None; 2];
        }
        // Squared distance in units of the spacing, and its two lowest local minima.
        let distance = |k: usize| {
            let (d, dg) = self.arm(k, z);
            dot(d, d) / (h * h * dot(dg, dg))
        };
        let mut starts = [(R::lit(49.0), usize::MAX); 2];
        let (mut before, mut here) = (distance(n.saturating_sub(1)), distance(0));
        for k in 0..n {
            let next = distance(if k + 1 == n { 0 } else { k + 1 });
            if here <= next && here < before && own != Some(k) {
                let [first, second] = starts;
                if here < first.0 {
                    starts = [(here, k), first];
                } else if here < second.0 {
                    starts = [first, (here, k)];
                }
            }
            (before, here) = (here, next);
        }
        let mut found: Found<R> = [None; 2];
        let mut roots = [Complex::default(); 2];
        let mut count = 0;
        for (_, j) in starts.into_iter().filter(|(_, j)| *j < n) {
            let t_j = at(self.nodes.t, j);
            let Some(u) = self.newton(j, z) else { continue };
            let t = u + t_j;
            let known = |other: Complex<R>| {
                let d = complex(wrapped(t.re - other.re), t.im - other.im);
                cabs(d) <= R::EPSILON.sqrt() * R::lit(1e-2) * (R::one() + cabs(u)) || cabs(d) < R::lit(1e-6) * cabs(u)
            };
            if roots.iter().take(count).any(|r| known(*r))
                || own.is_some_and(|k| known(complex(at(self.nodes.t, k), R::zero())))
            {
                continue;
            }
            if let (Some(p), Some(slot), Some(root)) = (self.preimage(j, u), found.get_mut(count), roots.get_mut(count))
            {
                (*slot, *root) = (Some(p), t);
                count += 1;
            }
        }
        if count > 0 { self.best_subset(z, own, found) } else { found }
    }

    /// Whether no node is closer to z than seven times its distance from the next.
    #[inline(always)]
    fn farther_than_seven_spacings(&self, z: Complex<R>) -> bool {
        let limit = R::lit(49.0) * self.nodes.step * self.nodes.step;
        let mut near = false;
        for first in (0..self.nodes.x.len()).step_by(LANES) {
            let [x, y, dx, dy] = self.columns(first);
            let mut most = -R::MAX;
            for i in 0..LANES {
                let (x, y) = (x[i] - z.re, y[i] - z.im);
                let inside = limit * (dx[i] * dx[i] + dy[i] * dy[i]) - (x * x + y * y);
                most = if inside > most { inside } else { most };
            }
            near |= most > R::zero();
        }
        !near
    }

    /// Σ_k h Γ'_k/(Γ_k − z) over the nodes other than z.
    #[inline(always)]
    fn plain_sum(&self, z: Complex<R>) -> Complex<R> {
        let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
        for first in (0..self.nodes.x.len()).step_by(LANES) {
            let [x, y, dx, dy] = self.columns(first);
            for i in 0..LANES {
                let (x, y) = (x[i] - z.re, y[i] - z.im);
                let square = x * x + y * y;
                let inverse = if square > R::zero() { R::one() / square } else { R::zero() };
                re[i] += (dx[i] * x + dy[i] * y) * inverse;
                im[i] += (dy[i] * x - dx[i] * y) * inverse;
            }
        }
        let sum = |x: [R; LANES]| x.into_iter().fold(R::zero(), |sum, x| sum + x);
        complex(sum(re), sum(im)) * self.nodes.step
    }

    /// x, y, x', y' of the nodes from `first` on; where there are no more, derivatives are 0 and nothing counts.
    #[inline(always)]
    fn columns(&self, first: usize) -> [[R; LANES]; 4] {
        let n = &self.nodes;
        [
            load(n.x, first, R::MAX.sqrt() * R::lit(1e-3)),
            load(n.y, first, R::zero()),
            load(n.dx, first, R::zero()),
            load(n.dy, first, R::zero()),
        ]
    }

    /// Γ_k − z and Γ'_k.
    #[inline]
    pub(super) fn arm(&self, k: usize, z: Complex<R>) -> (Complex<R>, Complex<R>) {
        let g = complex(at(self.nodes.x, k), at(self.nodes.y, k));
        (g - z, complex(at(self.nodes.dx, k), at(self.nodes.dy, k)))
    }

    pub(super) fn newton(&self, j: usize, z: Complex<R>) -> Option<Complex<R>> {
        let t_j = at(self.nodes.t, j);
        let (away, tangent) = self.arm(j, z);
        let aim = -away;
        let curve = &self.view.curve;
        // A step of at most four spacings of the parameter.
        let mut slope = curve.jet_real(t_j)[1];
        let limit = R::lit(4.0) * self.nodes.step * cabs(tangent) / cabs(slope);
        let (mut u, mut change) = (Complex::<R>::default(), Complex::<R>::default());
        for _ in 0..24 {
            let mut step = (aim - change) / slope;
            let size = cabs(step);
            if !size.is_finite() {
                return None;
            }
            if size > limit {
                step *= limit / size;
            }
            u += step;
            if size <= R::lit(4.0) * R::EPSILON * cabs(u) {
                return Some(u);
            }
            [change, slope] = curve.change(t_j, u);
            if size <= R::EPSILON.sqrt() * R::lit(0.01) * cabs(u) {
                // One more step reaches rounding.
                let last = (aim - change) / slope;
                return cabs(last).is_finite().then_some(u + last);
            }
        }
        None
    }

    /// Keeps those candidates with which Σ_k W_ik comes closest to its exact value: 0 outside a solid, iπ on the boundary
    /// itself, 2πi inside a tank.
    #[inline(always)]
    fn best_subset(&self, z: Complex<R>, own: Option<usize>, found: Found<R>) -> Found<R> {
        let n = self.nodes.t.len();
        let exact = match own {
            Some(_) => R::PI,
            None if self.record.sign > R::zero() => R::TAU,
            None => R::zero(),
        };
        let mut residual = self.plain_sum(z) - complex(R::zero(), exact);
        if let Some(k) = own {
            let (d, dd) = (self.arm(k, z).1, complex(at(self.nodes.ddx, k), at(self.nodes.ddy, k)));
            residual += dd / d * (self.nodes.step * R::HALF);
        }
        let sums = found.map(|f| f.map_or(Complex::default(), |p| pole::sum_of_weights(&p, self.table, n)));
        let [a, b] = sums;
        let [first, second] = found;
        let rounding = R::EPSILON * R::lit(500.0);
        // All first, so that ties keep all.
        let mut best = (cabs(residual + a + b) - rounding, found);
        for (sum, subset) in [(a, [first, None]), (b, [second, None]), (Complex::default(), [None, None])] {
            let size = cabs(residual + sum);
            if size < best.0 {
                best = (size, subset);
            }
        }
        best.1
    }

    /// The preimage of a root t_j + u.
    fn preimage(&self, node: usize, u: Complex<R>) -> Option<Preimage<R>> {
        let (sin, cos) = csin_cos(u * R::HALF);
        let t = at(self.nodes.t, node);
        let tangent = self.view.curve.jet(u + t)[1];
        let lanes = |z: Complex<R>| [[z.re], [z.im]];
        let offset = Offset { t: [t], u: lanes(u), sin: lanes(sin), cos: lanes(cos) };
        self.complete(&Roots { node: [node], offset, tangent: lanes(tangent) }).get(0, self.nodes.t.len())
    }
}
