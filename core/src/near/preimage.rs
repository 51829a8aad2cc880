//! Complex parameters at which one boundary, continued, passes through a node of another (or of its opposite flank).
//!
//! x = s* − s_j is found relative to a node: γ(t_j + u) − γ(t_j) = z − Γ_j without cancellation, then
//! x = s(t_j + u) − s(t_j). The rounded Γ_j is the same number as in the kernel's reciprocal.

use crate::boundary::{BoundaryRecord, Nodes};
use crate::configuration::{Configuration, Poses};
use crate::curve::{Curve, Ellipse, OutlineView};
use crate::model::Model;
use crate::near::{NearMut, PREIMAGES, pole};
use crate::scalar::{Complex, Real, cabs, cln, cln_1p, complex, csin_cos, csqrt, dot};
use crate::workspace::{at, copy, part_mut};

/// A preimage near the real axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preimage<R> {
    /// Node from which x is counted.
    pub node: usize,
    /// s* − s_node.
    pub x: Complex<R>,
    /// dx/dz.
    pub rate: Complex<R>,
}

impl<R: Real> Preimage<R> {
    /// Reals that hold one: node + 1 (0: none), x, rate.
    pub(crate) const REALS: usize = 5;

    #[inline]
    pub(crate) fn read(data: &[R]) -> Option<Self> {
        match data {
            &[node, xr, xi, rr, ri] if node > R::zero() => {
                Some(Preimage { node: node.to_f64() as usize - 1, x: complex(xr, xi), rate: complex(rr, ri) })
            }
            _ => None,
        }
    }

    fn reals(&self) -> [R; 5] {
        [R::count(self.node + 1), self.x.re, self.x.im, self.rate.re, self.rate.im]
    }
}

/// The pole term falls like (π/N) e^(−N |Im x|/2): beyond this exponent it is lost in rounding.
pub(crate) fn reach<R: Real>() -> R {
    -R::EPSILON.ln() - R::lit(3.0)
}

/// A boundary as the source of a pole.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a, R> {
    pub record: &'a BoundaryRecord<R>,
    pub nodes: Nodes<'a, R>,
    pub view: OutlineView<'a, R>,
    pub table: &'a [R],
}

/// Up to two preimages.
pub(crate) type Found<R> = [Option<Preimage<R>>; 2];

impl<R: Real> Source<'_, R> {
    /// Preimages of z (in the source's frame). `own`: z is this node of the source, and its own preimage is left out.
    pub(crate) fn preimages(&self, z: Complex<R>, own: Option<usize>) -> Found<R> {
        match &self.view.curve {
            Curve::Ellipse(e) => self.on_ellipse(e, z, own),
            _ => self.by_search(z, own),
        }
    }

    /// Both roots of (a + b) W/2 + (a − b)/(2W) = z, W = e^(it), in closed form.
    fn on_ellipse(&self, ellipse: &Ellipse<R>, z: Complex<R>, own: Option<usize>) -> Found<R> {
        let (sum, difference) = (ellipse.a + ellipse.b, ellipse.a - ellipse.b);
        let first = match own {
            Some(k) => crate::scalar::cis(at(self.nodes.t, k)),
            None => ellipse.preimage(z + self.record.origin),
        };
        let second = complex(difference / sum, R::zero()) / first;
        let mut found = [None; 2];
        let mut slots = found.iter_mut();
        for w in [(own.is_none()).then_some(first), (difference != R::zero()).then_some(second)].into_iter().flatten() {
            let t = cln(w);
            // t* = −i ln W
            let (turn, lift) = (t.im, -t.re);
            let far = self.view.grading.plain() * lift.abs() * R::count(self.nodes.t.len()) * R::HALF > reach();
            if far || lift == R::zero() {
                continue;
            }
            let j = nearest(self.nodes.t, turn);
            if let Some(p) = self.ellipse_preimage(ellipse, j, z, w)
                && let Some(slot) = slots.next()
            {
                *slot = Some(p);
            }
        }
        found
    }

    /// The root w = e^(it*) counted from node j: with W = e^(it_j) (1 + ε), P = (a + b) W_j/2, Q = (a − b)/(2 W_j) and
    /// d = z − Γ_j the equation is P ε² + (P − Q − d) ε = d, solved without cancellation.
    fn ellipse_preimage(&self, e: &Ellipse<R>, j: usize, z: Complex<R>, w: Complex<R>) -> Option<Preimage<R>> {
        let t_j = at(self.nodes.t, j);
        let node = crate::scalar::cis(t_j);
        let (p, q) = (node * ((e.a + e.b) * R::HALF), node.conj() * ((e.a - e.b) * R::HALF));
        let d = z - complex(at(self.nodes.x, j), at(self.nodes.y, j));
        let half = (p - q - d) * R::HALF;
        let root = csqrt(half * half + p * d);
        let root = if dot(half, root) < R::zero() { -root } else { root };
        // Both roots; the one meant is the closer to w.
        let small = d / (half + root);
        let large = -(half + root) / p;
        let aim = w * node.conj() - R::one();
        let epsilon = if cabs(small - aim) <= cabs(large - aim) { small } else { large };
        let turn = cln_1p(epsilon);
        let u = complex(turn.im, -turn.re);
        // e^(iu/2), whose inverse and own difference is 2i sin(u/2)
        let power = epsilon + R::one();
        let half_power = csqrt(power);
        let sine = epsilon / (half_power * R::TWO);
        let halves = [complex(sine.im, -sine.re), (power + R::one()) / (half_power * R::TWO)];
        let tangent = p * power - q / power;
        self.complete(j, u, halves, complex(-tangent.im, tangent.re))
    }

    /// Real part and magnitude of the imaginary part of the preimage of z next to the boundary; `None` where it is too far to
    /// matter for the trapezoidal rule.
    pub(crate) fn footprint(&self, z: Complex<R>) -> Option<(R, R)> {
        let t = match &self.view.curve {
            Curve::Ellipse(e) => {
                let t = cln(e.preimage(z + self.record.origin));
                complex(t.im, t.re.abs())
            }
            _ => {
                let size = |k: usize| {
                    let (d, dg) = self.arm(k, z);
                    dot(d, d) / dot(dg, dg)
                };
                let closest = (0..self.nodes.t.len()).map(|k| (size(k), k));
                let (_, j) = closest.fold((R::MAX, 0), |best, new| if new.0 < best.0 { new } else { best });
                // Where Newton's method does not settle, the distance over the speed is the scale.
                let (t_j, distance) = (at(self.nodes.t, j), cabs(self.arm(j, z).0));
                let apart = complex(R::zero(), distance / cabs(self.view.curve.jet_real(t_j)[1]));
                let u = self.newton(j, z).unwrap_or(apart);
                complex(t_j + u.re, u.im.abs())
            }
        };
        let near = self.view.grading.plain() * t.im * R::count(self.nodes.t.len()) < reach();
        (near && t.im > R::zero()).then_some((t.re, t.im))
    }

    /// Newton's method from the nodes that are close relative to their spacing, and the choice among the roots found by the
    /// known sum of the weights.
    fn by_search(&self, z: Complex<R>, own: Option<usize>) -> Found<R> {
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
    fn arm(&self, k: usize, z: Complex<R>) -> (Complex<R>, Complex<R>) {
        let g = complex(at(self.nodes.x, k), at(self.nodes.y, k));
        (g - z, complex(at(self.nodes.dx, k), at(self.nodes.dy, k)))
    }

    fn newton(&self, j: usize, z: Complex<R>) -> Option<Complex<R>> {
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

    /// Completes a root t_j + u.
    fn preimage(&self, node: usize, u: Complex<R>) -> Option<Preimage<R>> {
        let (sin, cos) = csin_cos(u * R::HALF);
        self.complete(node, u, [sin, cos], self.view.curve.jet(u + at(self.nodes.t, node))[1])
    }

    /// Completes a root t_j + u, given sine and cosine of u/2 and γ' there; `None` where the pole term is lost in rounding.
    fn complete(
        &self,
        node: usize,
        u: Complex<R>,
        halves: [Complex<R>; 2],
        tangent: Complex<R>,
    ) -> Option<Preimage<R>> {
        let [x, slope] = self.view.grading.difference(at(self.nodes.t, node), u, halves);
        let exponent = R::count(self.nodes.t.len()) * x.im.abs() * R::HALF;
        if exponent.is_nan() || exponent >= reach() || x.im == R::zero() {
            return None;
        }
        let rate = slope / tangent;
        (rate.re.is_finite() && rate.im.is_finite()).then_some(Preimage { node, x, rate })
    }
}

/// An angle brought to [−π, π].
pub(crate) fn wrapped<R: Real>(t: R) -> R {
    t - R::TAU * (t / R::TAU).round()
}

/// The node whose parameter is closest to t; parameters increase from 0 to below 2π.
fn nearest<R: Real>(nodes: &[R], t: R) -> usize {
    let t = t - (t / R::TAU).floor() * R::TAU;
    let after = nodes.partition_point(|x| *x < t);
    let before = if after == 0 { nodes.len().saturating_sub(1) } else { after - 1 };
    let after = if after == nodes.len() { 0 } else { after };
    let gap = |k: usize| wrapped(at(nodes, k) - t).abs();
    if gap(before) < gap(after) { before } else { after }
}

/// Finds the preimages of all nodes on all boundaries of which one moves, on walls whose blocks are formed anew, and on the
/// opposite flank of every boundary whose nodes belong to this configuration.
pub(crate) fn find_all<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, near: &mut NearMut<'_, R>) {
    let NearMut { nodes, rungs, ladders, preimages, unknowns } = near;
    if preimages.is_empty() {
        return;
    }
    let view = crate::near::Near { nodes, rungs, ladders, preimages: &[], unknowns: *unknowns };
    let c = Configuration { model: *model, poses, near: view };
    let walls_anew = c.walls_regraded();
    for (j, record, nodes) in c.each_boundary() {
        let source = Source { record, nodes, view: c.outline(j, record), table: record.table(model.store) };
        let strip = source.view.grading.plain() * R::count(record.nodes) * R::HALF;
        // Beyond this multiple of the source's reach every pole term is lost.
        let most = (reach::<R>() / strip).exp();
        for (i, target, points) in c.each_boundary() {
            let rows = part_mut(preimages, (j * *unknowns + target.first) * PREIMAGES, target.nodes * PREIMAGES);
            let both_walls = record.link.is_none() && target.link.is_none();
            let wanted =
                if i == j { c.regraded(i) || (record.link.is_none() && walls_anew) } else { !both_walls || walls_anew };
            let apart = cabs(c.pose(i).origin - c.pose(j).origin) - target.reach;
            let far = i != j && record.sign < R::zero() && target.sign < R::zero() && apart > most * record.reach;
            if !wanted || far {
                rows.fill(R::zero());
                continue;
            }
            let (turn, shift) =
                (c.pose(j).unturned(c.pose(i).turn), c.pose(j).unturned(c.pose(i).origin - c.pose(j).origin));
            for (k, (row, x)) in rows.chunks_exact_mut(PREIMAGES).zip(points.points()).enumerate() {
                let own = (i == j).then_some(k);
                let z = if i == j { x } else { shift + turn * x };
                row.fill(R::zero());
                for (slot, p) in
                    row.chunks_exact_mut(Preimage::<R>::REALS).zip(source.preimages(z, own).iter().flatten())
                {
                    copy(slot, &p.reals());
                }
            }
        }
    }
}
