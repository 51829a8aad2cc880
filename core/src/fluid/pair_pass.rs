//! One pass over all pairs of boundaries: what the density of the motion induces at the other boundaries, and the transpose.
//!
//! Both directions of a pair need 1/(Γ − z)² of the same differences, up to the turn between the two frames: unless there are pole
//! terms, a pair is visited once, with one division per pair of nodes.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::lanes::{LANES, lanes, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{part, part_mut};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::{PairScratch, Relative, add_pole_velocity, add_pose_sums, pose_sums};
use crate::geometry::nodes::Nodes;
use crate::model::boundary::BoundaryRecord;

/// What [`pair_pass`] fills: two vectors of length N and three reals per link.
pub(crate) struct PassResult<'a, R> {
    pub rate: &'a mut [R],
    pub transposed: &'a mut [R],
    pub gradient: &'a mut [R],
}

once! {
    /// The pass over all pairs, per unit density: `rate = Im(ż ∘ D u)`, its transpose `transposed = Im((λ ż)ᵀ D)`, and
    /// `gradient_a = q̇ᵀ (∂M_h/∂q_a) q̇` without the turning of the frames. O(N²), one division per two pairs of nodes.
    pub(crate) fn pair_pass['a, 'b: 'a](
        c: &'a Configuration<'a, R>, qd: &'a [R], density: &'a [R], adjoint: &'a [R], s: &'a mut PairScratch<'b, R>,
        out: PassResult<'a, R>,
    ) {
        out.rate.fill(R::zero());
        out.transposed.fill(R::zero());
        out.gradient.fill(R::zero());
        let machine = Machine::here();
        let count = c.model.boundaries.len();
        for (i, j) in (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))) {
            let (Some((a, a_nodes)), Some((b, b_nodes))) = (c.boundary(i), c.boundary(j)) else { continue };
            if a.link.is_none() && b.link.is_none() {
                continue;
            }
            let (n, m) = (a.nodes, b.nodes);
            let relative = [Relative::of(c, i, j, qd), Relative::of(c, j, i, qd)];
            let [ra, rb] = [&relative[0], &relative[1]].map(|r| r.rate);
            let (first, second) = out.transposed.split_at_mut_checked(b.first).unwrap_or((&mut [], &mut []));
            let columns = [&mut *s.fx, &mut *s.fy, &mut *s.hx, &mut *s.hy];
            let [fx, fy, hx, hy] =
                columns.map(|x| part_mut(x, 0, n + m).split_at_mut_checked(n).unwrap_or((&mut [], &mut [])));
            let mut a =
                Side::of((i, a, a_nodes), ra, [density, adjoint], [fx.0, fy.0, hx.0, hy.0], part_mut(first, a.first, n));
            let mut b = Side::of((j, b, b_nodes), rb, [density, adjoint], [fx.1, fy.1, hx.1, hy.1], part_mut(second, 0, m));
            let mut end = |target: &Side<'_, '_, R>, source: usize| {
                let rates = part_mut(out.rate, target.record.first, target.record.nodes);
                let mut sums = [Complex::default(); 2];
                machine.run(End { side: target, rates, sums: &mut sums });
                add_pose_sums(c, target.index, source, sums, R::one(), out.gradient);
            };
            let [ab, ba] = [&relative[0], &relative[1]].map(|r| r.place);
            let poles = features::NEAR && (has_poles(c, &a, j) || has_poles(c, &b, i));
            let z = [part_mut(s.zx, 0, n), part_mut(s.zy, 0, n)];
            if poles {
                // A pole term cancels against the plain rule: both must be of the same rounded differences.
                machine.run(Pair::<R, false> { a: &mut a, b: &mut b, place: ab, z });
                add_poles(c, &mut a, &mut b);
                end(&a, j);
                let z = [part_mut(s.zx, 0, m), part_mut(s.zy, 0, m)];
                machine.run(Pair::<R, false> { a: &mut b, b: &mut a, place: ba, z });
                add_poles(c, &mut b, &mut a);
            } else {
                machine.run(Pair::<R, true> { a: &mut a, b: &mut b, place: ab, z });
                end(&a, j);
            }
            end(&b, i);
        }
    }
}

/// One boundary of a pair. Rates, weights and velocities are in the other one's frame.
struct Side<'a, 'b, R> {
    index: usize,
    record: &'a BoundaryRecord<R>,
    nodes: Nodes<'a, R>,
    /// A node x moves at v₀ + v₁ x.
    rate: [Complex<R>; 2],
    density: &'b [R],
    /// The adjoint λ.
    weight: &'b [R],
    /// λ times the rate of each node.
    f: [&'b mut [R]; 2],
    /// What the other boundary's density induces here.
    h: [&'b mut [R]; 2],
    /// Im((λ ż)ᵀ D) of the other boundary's nodes as targets.
    out: &'b mut [R],
}

impl<'a, 'b, R: Real> Side<'a, 'b, R> {
    /// `whole`: density and adjoint of all boundaries; `scratch`: f and h.
    fn of(
        (index, record, nodes): (usize, &'a BoundaryRecord<R>, Nodes<'a, R>),
        rate: [Complex<R>; 2],
        whole: [&'b [R]; 2],
        [fx, fy, hx, hy]: [&'b mut [R]; 4],
        out: &'b mut [R],
    ) -> Self {
        let [density, weight] = whole.map(|x| part(x, record.first, record.nodes));
        Side { index, record, nodes, rate, density, weight, f: [fx, fy], h: [hx, hy], out }
    }

    #[inline(always)]
    fn factor(&self) -> R {
        self.nodes.step * self.record.sign / R::PI
    }

    /// Fills the weights and clears the velocities.
    #[inline(always)]
    fn begin(&mut self) {
        let ([v0, v1], [fx, fy]) = (self.rate, &mut self.f);
        let points = self.nodes.x.iter().zip(self.nodes.y);
        for (((fx, fy), (x, y)), w) in fx.iter_mut().zip(fy.iter_mut()).zip(points).zip(self.weight) {
            *fx = (v0.re + (v1.re * *x - v1.im * *y)) * *w;
            *fy = (v0.im + (v1.re * *y + v1.im * *x)) * *w;
        }
        for h in &mut self.h {
            h.fill(R::zero());
        }
    }
}

/// Whether anything that `source` induces at a node of `target` needs a pole term.
fn has_poles<R: Real>(c: &Configuration<'_, R>, target: &Side<'_, '_, R>, source: usize) -> bool {
    let (first, count) = (target.record.first, target.record.nodes);
    (first..first + count).any(|row| c.preimages(source, row).next().is_some())
}

/// Pole terms of what `source` induces at `target`.
fn add_poles<R: Real>(c: &Configuration<'_, R>, target: &mut Side<'_, '_, R>, source: &mut Side<'_, '_, R>) {
    let ([fx, fy], [hx, hy]) = (&target.f, &mut target.h);
    let at = (source.index, source.record);
    add_pole_velocity(c, at, target.record.first, [source.density, &[]], [fx, fy], [hx, hy], source.out);
}

/// The plain rule of what `b` induces at `a`, and if `BOTH` of what `a` induces at `b`, in the frame of `b`, where `a` stands at
/// `place`: nodes z₀ + z₁ x.
struct Pair<'a, 'b, 'c, R, const BOTH: bool> {
    a: &'c mut Side<'a, 'b, R>,
    b: &'c mut Side<'a, 'b, R>,
    place: [Complex<R>; 2],
    z: [&'c mut [R]; 2],
}

impl<R: Real, const BOTH: bool> Task for Pair<'_, '_, '_, R, BOTH> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Pair { a, b, place: [z0, z1], z: [zx, zy] } = self;
        let points = a.nodes.x.iter().zip(a.nodes.y);
        for ((zx, zy), (x, y)) in zx.iter_mut().zip(zy.iter_mut()).zip(points) {
            *zx = z0.re + (z1.re * *x - z1.im * *y);
            *zy = z0.im + (z1.re * *y + z1.im * *x);
        }
        a.begin();
        b.begin();
        let factor = b.factor();
        // In a's frame 1/(Γ − z)² is this times that in b's frame.
        let turned = z1 * z1 * a.factor();
        let ([fx, fy], [hx, hy]) = (&a.f, &mut a.h);
        let (x, y, fx, fy) = (zx.as_chunks(), zy.as_chunks(), fx.as_chunks(), fy.as_chunks());
        let (dx, dy, u) = (a.nodes.dx.as_chunks(), a.nodes.dy.as_chunks(), a.density.as_chunks());
        let whole = x.0.iter().zip(y.0).zip(fx.0.iter().zip(fy.0)).zip(dx.0.iter().zip(dy.0).zip(u.0));
        let (hx, hy, out) = (hx.as_chunks_mut(), hy.as_chunks_mut(), a.out.as_chunks_mut());
        // Nodes that fill no vector, and their sums. What is missing stands where the last one stands, without weight.
        let place = |x: &[R]| lanes(x, x.last().copied().unwrap_or(R::zero()));
        let weight = |x: &[R]| lanes(x, R::zero());
        let rest = [place(x.1), place(y.1), weight(fx.1), weight(fy.1), weight(dx.1), weight(dy.1), weight(u.1)];
        let mut rest_sums = [[R::zero(); LANES]; 3];
        let ([bfx, bfy], [bhx, bhy]) = (&b.f, &mut b.h);
        let weights = bfx.iter().zip(bfy.iter()).zip(b.density);
        let sums = bhx.iter_mut().zip(bhy.iter_mut()).zip(b.out.iter_mut());
        let nodes = b.nodes.points().zip(b.nodes.tangents());
        for (((g, dg), ((bfx, bfy), w)), ((bhx, bhy), sum)) in nodes.zip(weights).zip(sums) {
            let one = One { g, weight: dg * factor, w: *w, f: turned * complex(*bfx, *bfy) };
            let mut total = [[R::zero(); LANES]; 3];
            let changed = hx.0.iter_mut().zip(hy.0.iter_mut()).zip(out.0.iter_mut());
            for (((hx, hy), out), (((x, y), (fx, fy)), ((dx, dy), u))) in changed.zip(whole.clone()) {
                let far = [*x, *y, *fx, *fy, *dx, *dy, *u];
                ([*hx, *hy, *out], total) = lanes_of_pair::<R, BOTH>(one, far, [*hx, *hy, *out], total);
            }
            if !x.1.is_empty() {
                (rest_sums, total) = lanes_of_pair::<R, BOTH>(one, rest, rest_sums, total);
            }
            // Through memory: else the sums are carried lane by lane through the loop above.
            let [own, vx, vy] = core::hint::black_box(total);
            *sum += sum_of(own);
            (*bhx, *bhy) = (sum_of(vx), sum_of(vy));
        }
        for (sums, out) in rest_sums.iter().zip([hx.1, hy.1, out.1]) {
            for (out, sum) in out.iter_mut().zip(sums) {
                *out += *sum;
            }
        }
        if !BOTH {
            return;
        }
        let [bhx, bhy] = &mut b.h;
        for (x, y) in bhx.iter_mut().zip(bhy.iter_mut()) {
            (*x, *y) = (turned.re * *x - turned.im * *y, turned.re * *y + turned.im * *x);
        }
    }
}

/// A node of `b`: where it is, its weight and density as a source, its weight as a target (turned to the frame of `a`).
#[derive(Clone, Copy)]
struct One<R> {
    g: Complex<R>,
    weight: Complex<R>,
    w: R,
    f: Complex<R>,
}

/// Eight nodes of `a` (positions, weights, tangents, density) and a node of `b`: velocities and transposed sums at the
/// eight, and the sums over them. Arrays by value and short loops, each of which vectorizes.
#[inline(always)]
fn lanes_of_pair<R: Real, const BOTH: bool>(
    one: One<R>,
    [x, y, fx, fy, dx, dy, u]: [[R; LANES]; 7],
    [mut hx, mut hy, mut out]: [[R; LANES]; 3],
    [mut own, mut vx, mut vy]: [[R; LANES]; 3],
) -> ([[R; LANES]; 3], [[R; LANES]; 3]) {
    let One { g, weight, w, f } = one;
    let (mut sx, mut sy) = ([R::zero(); LANES], [R::zero(); LANES]);
    for (((sx, sy), x), y) in sx.iter_mut().zip(&mut sy).zip(x).zip(y) {
        let (dx, dy) = (g.re - x, g.im - y);
        let inverse = R::one() / (dx * dx + dy * dy);
        let (ex, ey) = (dx * inverse, -dy * inverse);
        (*sx, *sy) = (ex * ex - ey * ey, (ex + ex) * ey);
    }
    // D of the node of `b` as a source, apart from its density.
    let (mut px, mut py) = (sx, sy);
    for (px, py) in px.iter_mut().zip(&mut py) {
        (*px, *py) = (*px * weight.re - *py * weight.im, *px * weight.im + *py * weight.re);
    }
    for (h, p) in hx.iter_mut().zip(px) {
        *h += p * w;
    }
    for (h, p) in hy.iter_mut().zip(py) {
        *h += p * w;
    }
    for ((own, (px, py)), (fx, fy)) in own.iter_mut().zip(px.iter().zip(&py)).zip(fx.iter().zip(&fy)) {
        *own += *px * *fy + *py * *fx;
    }
    if !BOTH {
        return ([hx, hy, out], [own, vx, vy]);
    }
    // The same of the eight nodes of `a`.
    let (mut qx, mut qy) = (sx, sy);
    for (((qx, qy), dx), dy) in qx.iter_mut().zip(&mut qy).zip(dx).zip(dy) {
        (*qx, *qy) = (*qx * dx - *qy * dy, *qx * dy + *qy * dx);
    }
    for ((v, q), u) in vx.iter_mut().zip(qx).zip(u) {
        *v += q * u;
    }
    for ((v, q), u) in vy.iter_mut().zip(qy).zip(u) {
        *v += q * u;
    }
    for ((out, qx), qy) in out.iter_mut().zip(qx).zip(qy) {
        *out += f.re * qy + f.im * qx;
    }
    ([hx, hy, out], [own, vx, vy])
}

/// Adds Im(ż h) at the nodes of a side to `rates`, and sums what its pose gradient consists of.
struct End<'a, 'b, 'c, R> {
    side: &'c Side<'a, 'b, R>,
    rates: &'c mut [R],
    sums: &'c mut [Complex<R>; 2],
}

impl<R: Real> Task for End<'_, '_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Side { rate: [v0, v1], nodes, weight, h: [hx, hy], .. } = self.side;
        let points = nodes.x.iter().zip(nodes.y);
        for ((rate, (x, y)), (hx, hy)) in self.rates.iter_mut().zip(points).zip(hx.iter().zip(hy.iter())) {
            let (re, im) = (v0.re + (v1.re * *x - v1.im * *y), v0.im + (v1.re * *y + v1.im * *x));
            *rate += re * *hy + im * *hx;
        }
        *self.sums = pose_sums(weight, nodes, [hx, hy]);
    }
}
