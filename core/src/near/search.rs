//! Preimages on a curve without closed form: Newton's method, and a choice among its roots by a sum that is known.

use crate::grading::Offset;
use crate::near::pole;
use crate::near::preimage::{Preimage, Roots, Source, wrapped};
use crate::scalar::{Complex, Real, cabs, complex, csin_cos, dot};
use crate::workspace::at;

/// Up to two preimages.
type Found<R> = [Option<Preimage<R>>; 2];

impl<R: Real> Source<'_, R> {
    /// Newton's method from the nodes that are close relative to their spacing, and the choice among the roots found by the
    /// known sum of the weights.
    pub(super) fn by_search(&self, z: Complex<R>, own: Option<usize>) -> Found<R> {
        let n = self.nodes.t.len();
        let h = self.nodes.step;
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
        let speed = cabs(curve.jet_real(t_j)[1]);
        let limit = R::lit(4.0) * self.nodes.step * cabs(tangent) / speed;
        let mut u = Complex::<R>::default();
        for _ in 0..24 {
            let slope = curve.jet(u + t_j)[1];
            let mut step = (aim - curve.delta(t_j, u)) / slope;
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
            if size <= R::EPSILON.sqrt() * R::lit(0.01) * cabs(u) {
                // One more step reaches rounding.
                let slope = curve.jet(u + t_j)[1];
                let last = (aim - curve.delta(t_j, u)) / slope;
                return cabs(last).is_finite().then_some(u + last);
            }
        }
        None
    }

    /// Keeps those candidates with which Σ_k W_ik comes closest to its exact value: 0 outside a solid, iπ on the boundary
    /// itself, 2πi inside a tank.
    fn best_subset(&self, z: Complex<R>, own: Option<usize>, found: Found<R>) -> Found<R> {
        let n = self.nodes.t.len();
        let exact = match own {
            Some(_) => R::PI,
            None if self.record.sign > R::zero() => R::TAU,
            None => R::zero(),
        };
        let mut residual = complex(R::zero(), -exact);
        for k in 0..n {
            if own == Some(k) {
                let (d, dd) = (self.arm(k, z).1, complex(at(self.nodes.ddx, k), at(self.nodes.ddy, k)));
                residual += dd / d * (self.nodes.step * R::HALF);
                continue;
            }
            let (away, tangent) = self.arm(k, z);
            residual += tangent / away * self.nodes.step;
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
