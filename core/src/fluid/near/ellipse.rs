//! Preimages on an ellipse, in closed form: both roots of (a + b) W/2 + (a − b)/(2W) = z, W = e^(it), many at a time.
#![allow(clippy::indexing_slicing)] // Indices run over arrays of the same constant length.

use crate::base::complex::{Complex, complex};
use crate::base::elementary::{atan2, cln_1p, csqrt, product, quotient, sin_cos};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{at, put};
use crate::base::scalar::Real;
use crate::fluid::near::buffers::Preimage;
use crate::fluid::near::preimage::{Roots, Source, Targets, reach};
use crate::geometry::curve::Ellipse;
use crate::geometry::grading::{LANES, Offset};

type Pairs<R> = [[R; LANES]; 2];

impl<R: Real> Source<'_, R> {
    /// Calls `visit` with (row, preimage), in the order of the rows.
    pub(super) fn on_ellipse(&self, e: Ellipse<R>, targets: &Targets<'_, R>, visit: impl FnMut(usize, Preimage<R>)) {
        // |W| beyond which, or below whose inverse, the pole term is lost in rounding.
        let strip = self.view.grading.plain() * R::count(self.nodes.t.len()) * R::HALF;
        let limit = (reach::<R>() / strip).exp();
        let ratio = (e.a - e.b) / (e.a + e.b);
        if targets.own && ratio.abs() * limit < R::one() {
            return;
        }
        let most = reach::<R>() * R::TWO / R::count(self.nodes.t.len());
        Machine::here().run(OnEllipse { source: self, e, ratio, limit, most, targets, visit });
    }
}

struct OnEllipse<'a, 'b, R, F> {
    source: &'b Source<'a, R>,
    e: Ellipse<R>,
    ratio: R,
    limit: R,
    /// |Im s| beyond which it is lost.
    most: R,
    targets: &'b Targets<'b, R>,
    visit: F,
}

/// Roots that are to be completed.
struct Pending<R> {
    count: usize,
    row: [usize; LANES],
    z: Pairs<R>,
    w: Pairs<R>,
}

impl<R: Real, F: FnMut(usize, Preimage<R>)> Task for OnEllipse<'_, '_, R, F> {
    type Output = ();
    #[inline(always)]
    fn run(mut self) {
        let zero = [[R::zero(); LANES]; 2];
        let mut pending = Pending { count: 0, row: [0; LANES], z: zero, w: zero };
        let n = self.targets.nodes.x.len();
        for first in (0..n).step_by(LANES) {
            let z = self.points(first);
            let roots = self.roots(first, &z);
            let heights = [self.heights(&roots[0]), self.heights(&roots[1])];
            for i in 0..LANES {
                if first + i >= n {
                    break;
                }
                for (w, height) in roots.iter().zip(&heights) {
                    if height[i] > self.most {
                        continue;
                    }
                    let w = complex(w[0][i], w[1][i]);
                    pending.push(first + i, complex(z[0][i], z[1][i]), w);
                    if pending.count == LANES {
                        self.complete(&pending);
                        pending.count = 0;
                    }
                }
            }
        }
        if pending.count > 0 {
            self.complete(&pending);
        }
    }
}

impl<R: Real> Pending<R> {
    /// The first one fills all lanes, so that none holds garbage.
    #[inline(always)]
    fn push(&mut self, row: usize, z: Complex<R>, w: Complex<R>) {
        if self.count == 0 {
            (self.z, self.w) = ([[z.re; LANES], [z.im; LANES]], [[w.re; LANES], [w.im; LANES]]);
        }
        if let Some(r) = self.row.get_mut(self.count) {
            *r = row;
        }
        let ([x, y], [u, v]) = (&mut self.z, &mut self.w);
        for (lanes, value) in [(x, z.re), (y, z.im), (u, w.re), (v, w.im)] {
            put(lanes, self.count, value);
        }
        self.count += 1;
    }
}

impl<R: Real, F: FnMut(usize, Preimage<R>)> OnEllipse<'_, '_, R, F> {
    /// The targets from `first` on, in the source's frame; the last one again where there are no more.
    #[inline(always)]
    fn points(&self, first: usize) -> Pairs<R> {
        let t = self.targets;
        let mut z = [[R::zero(); LANES]; 2];
        for i in 0..LANES {
            let k = (first + i).min(t.nodes.x.len().saturating_sub(1));
            let x = complex(at(t.nodes.x, k), at(t.nodes.y, k));
            let x = if t.own { x } else { t.shift + t.turn * x };
            (z[0][i], z[1][i]) = (x.re, x.im);
        }
        z
    }

    /// |Im s| at roots; the largest number where W is out of the strip.
    #[inline(always)]
    fn heights(&self, w: &Pairs<R>) -> [R; LANES] {
        let mut size = [R::zero(); LANES];
        let (least, most) = (R::one() / (self.limit * self.limit), self.limit * self.limit);
        let mut any = false;
        for i in 0..LANES {
            size[i] = w[0][i] * w[0][i] + w[1][i] * w[1][i];
            any |= size[i] > least && size[i] < most;
        }
        let mut heights = [R::MAX; LANES];
        if any {
            heights = self.source.view.grading.heights(w, &size);
            for i in 0..LANES {
                heights[i] = if size[i] > least && size[i] < most { heights[i] } else { R::MAX };
            }
        }
        heights
    }

    /// W of both roots, the one next to the outline first; 0 for those that do not count.
    #[inline(always)]
    fn roots(&self, first: usize, z: &Pairs<R>) -> [Pairs<R>; 2] {
        let mut roots = [[[R::zero(); LANES]; 2]; 2];
        let (sum, ratio, origin) = (self.e.a + self.e.b, self.ratio, self.source.record.origin);
        let t = self.source.nodes.t;
        if self.targets.own {
            let mut own = [R::zero(); LANES];
            own.iter_mut().zip(t.get(first..).unwrap_or(&[])).for_each(|(own, t)| *own = *t);
            for i in 0..LANES {
                // ratio e^(−it)
                let (s, c) = sin_cos(own[i]);
                (roots[1][0][i], roots[1][1][i]) = (ratio * c, -ratio * s);
            }
        } else {
            let foci = sum * (self.e.a - self.e.b);
            for i in 0..LANES {
                // The centre itself would be divided by.
                let z = [z[0][i] + origin.re + sum * R::EPSILON * R::EPSILON, z[1][i] + origin.im];
                // z √(1 − c²/z²): the branch next to z.
                let [x, y] = quotient([foci, R::zero()], product(z, z));
                let root = product(z, csqrt([R::one() - x, -y]));
                let w = [(z[0] + root[0]) / sum, (z[1] + root[1]) / sum];
                let other = quotient([ratio, R::zero()], w);
                (roots[0][0][i], roots[0][1][i]) = (w[0], w[1]);
                (roots[1][0][i], roots[1][1][i]) = (other[0], other[1]);
            }
        }
        roots
    }

    /// The roots W counted from nodes: with W = e^(it_j) (1 + ε), P = (a + b) W_j/2, Q = (a − b)/(2 W_j) and d = z − Γ_j the
    /// equation is ε² + (1 − Q/P − d/P) ε = d/P, solved without cancellation.
    #[inline(always)]
    fn complete(&mut self, pending: &Pending<R>) {
        let (e, ratio, nodes) = (&self.e, self.ratio, &self.source.nodes);
        let zero = [[R::zero(); LANES]; 2];
        let mut d = zero;
        let mut roots = Roots {
            node: nearest(nodes.t, &pending.w),
            offset: Offset { t: [R::zero(); LANES], u: zero, sin: zero, cos: zero },
            tangent: zero,
        };
        for i in 0..LANES {
            let j = roots.node[i];
            roots.offset.t[i] = at(nodes.t, j);
            (d[0][i], d[1][i]) = (pending.z[0][i] - at(nodes.x, j), pending.z[1][i] - at(nodes.y, j));
        }
        let scale = R::TWO / (e.a + e.b);
        for i in 0..LANES {
            let (s, c) = sin_cos(roots.offset.t[i]);
            let d = product([d[0][i] * scale, d[1][i] * scale], [c, -s]);
            // Q/P
            let q = [ratio * (c * c - s * s), -ratio * (c * s + c * s)];
            let half = [(R::one() - q[0] - d[0]) * R::HALF, -(q[1] + d[1]) * R::HALF];
            let square = product(half, half);
            let root = csqrt([square[0] + d[0], square[1] + d[1]]);
            let back = half[0] * root[0] + half[1] * root[1] < R::zero();
            let root = if back { [-root[0], -root[1]] } else { root };
            let large = [-(half[0] + root[0]), -(half[1] + root[1])];
            let small = quotient([-d[0], -d[1]], large);
            // Of both roots the one that is closer to W.
            let aim = product([pending.w[0][i], pending.w[1][i]], [c, -s]);
            let off = |x: [R; 2]| {
                let (x, y) = (x[0] + R::one() - aim[0], x[1] - aim[1]);
                x * x + y * y
            };
            let other = off(large) < off(small);
            let epsilon = [if other { large[0] } else { small[0] }, if other { large[1] } else { small[1] }];
            let log = cln_1p(epsilon);
            (roots.offset.u[0][i], roots.offset.u[1][i]) = (log[1], -log[0]);
            // e^(iu/2), whose inverse and own difference is 2i sin(u/2)
            let power = [R::one() + epsilon[0], epsilon[1]];
            let root = csqrt(power);
            let inverse = quotient([R::HALF, R::zero()], root);
            let sine = product(epsilon, inverse);
            let cosine = product([power[0] + R::one(), power[1]], inverse);
            (roots.offset.sin[0][i], roots.offset.sin[1][i]) = (sine[1], -sine[0]);
            (roots.offset.cos[0][i], roots.offset.cos[1][i]) = (cosine[0], cosine[1]);
            // i (P W/W_j − Q W_j/W), in units of P, then of length.
            let [x, y] = product(inverse, inverse);
            let fall = product(q, [R::lit(4.0) * x, R::lit(4.0) * y]);
            let tangent = product([c / scale, s / scale], [power[0] - fall[0], power[1] - fall[1]]);
            (roots.tangent[0][i], roots.tangent[1][i]) = (-tangent[1], tangent[0]);
        }
        let done = self.source.complete(&roots);
        for (i, row) in pending.row.iter().enumerate().take(pending.count) {
            if let Some(p) = done.get(i, nodes.t.len()) {
                (self.visit)(*row, p);
            }
        }
    }
}

/// The nodes whose parameters are closest to the angles of `w`; parameters increase from 0 to below 2π.
#[inline(always)]
fn nearest<R: Real>(nodes: &[R], w: &Pairs<R>) -> [usize; LANES] {
    let mut t = [R::zero(); LANES];
    for i in 0..LANES {
        let angle = atan2(w[1][i], w[0][i]);
        t[i] = if angle < R::zero() { angle + R::TAU } else { angle };
    }
    let mut after = [R::zero(); LANES];
    for x in nodes {
        for i in 0..LANES {
            after[i] += if *x < t[i] { R::one() } else { R::zero() };
        }
    }
    let (first, last) = (at(nodes, 0), at(nodes, nodes.len().saturating_sub(1)));
    let mut found = [0; LANES];
    for i in 0..LANES {
        let after = after[i].to_f64() as usize;
        let before = nodes.get(after.wrapping_sub(1)).copied().unwrap_or(last - R::TAU);
        let next = nodes.get(after).copied().unwrap_or(first + R::TAU);
        let k = if t[i] - before < next - t[i] { after + nodes.len() - 1 } else { after };
        found[i] = if k >= nodes.len() { k - nodes.len() } else { k };
    }
    found
}
