//! One pass over all pairs of boundaries for the derivatives of the force by position and velocity: what given densities induce
//! at boundaries that move, differentiated once (D = dW/dz) and twice (E = dD/dz = 2 (sign/π) h Γ'/(Γ − z)³), and the transposes.
//!
//! With ż = v₀ + v₁ X of a target's nodes X in the source's frame for a motion of the links, Im dG[a] = Im(ż_a ∘ D) and
//! Im d²G[a, b] = Im(ż_a ż_b ∘ E + z̈_ab ∘ D): polynomials in X, so that one pass serves the motions of all links.
//!
//! Tested by `tests/derivatives`.

use crate::base::complex::{Complex, complex, perp};
use crate::base::features;
use crate::base::lanes::{LANES, lanes, put_lanes, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{add, at, buffers, part, part_mut, put};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::{Relative, boundary_twist};
use crate::fluid::near::pole;
use crate::fluid::near::preimage::{Source, Targets, each_preimage};
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::{Pose, Twist, relative};
use crate::model::boundary::BoundaryRecord;

/// Columns of scratch on the target's nodes, and on the source's.
const WEIGHTS: usize = 12;
const VELOCITIES: usize = 6;
const SUMS: usize = 12;

buffers! {
    /// Scratch of the pass, for boundaries of at most so many nodes.
    pub(crate) struct TangentScratch(longest: usize) {
        /// The target's nodes in the source's frame · 2, and 5 complex weights there · whole vectors of lanes.
        targets: R = WEIGHTS * longest.next_multiple_of(LANES),
        /// D u, E u and D w at the target's nodes · 3 complex columns.
        velocities: R = VELOCITIES * longest.next_multiple_of(LANES),
        /// λᵀ D, (λ X)ᵀ D, the same of μ, (λ ż)ᵀ E, (λ ż X)ᵀ E at the source's nodes · 6 complex columns.
        sums: R = SUMS * longest.next_multiple_of(LANES),
    }
}

/// What the pass takes: the motion of the links, world · 3n, and densities of which `density` and `adjoint` are those of that
/// motion · N each.
#[derive(Clone, Copy)]
pub(crate) struct TangentSource<'a, R> {
    pub qd: &'a [R],
    /// u.
    pub density: &'a [R],
    /// λ.
    pub adjoint: &'a [R],
    /// w, of which D alone is asked for.
    pub second_density: &'a [R],
    /// μ, the same transposed.
    pub second_adjoint: &'a [R],
}

/// What it fills, with b running over the 3n unit motions of the links, world: columns with leading dimension `ld`.
pub(crate) struct TangentResult<'a, R> {
    pub ld: usize,
    /// Im dG[b] u.
    pub rate: &'a mut [R],
    /// Im dG[b]ᵀ λ.
    pub transposed: &'a mut [R],
    /// Im d²G[b, q̇] u + Im dG[b] w.
    pub second: &'a mut [R],
    /// Im d²G[b, q̇]ᵀ λ + Im dG[b]ᵀ μ.
    pub second_transposed: &'a mut [R],
    /// λᵀ Im d²G[a, b] u · 3n × 3n.
    pub hessian: &'a mut [R],
}

once! {
    /// The pass, per unit density: about 60 operations and one division per ordered pair of nodes, and as many per node and
    /// link as are in its columns.
    pub(crate) fn tangent_pass['a, 'b: 'a](
        c: &'a Configuration<'a, R>, from: TangentSource<'a, R>, s: &'a mut TangentScratch<'b, R>, out: &'a mut TangentResult<'a, R>,
    ) {
        for part in [&mut *out.rate, &mut *out.transposed, &mut *out.second, &mut *out.second_transposed, &mut *out.hessian] {
            part.fill(R::zero());
        }
        let machine = Machine::here();
        for (j, source, source_nodes) in c.each_boundary() {
            for (i, target, target_nodes) in c.each_boundary() {
                if i == j || (source.link.is_none() && target.link.is_none()) {
                    continue;
                }
                let pair = PairOf { i, j, target, source, target_nodes, source_nodes };
                let motion = Relative::of(c, i, j, from.qd);
                machine.run(Kernel { pair, motion: &motion, from, s });
                if features::NEAR && pair.has_poles(c) {
                    pair.add_poles(c, from, s);
                }
                machine.run(Distribute { c, pair, from, s, out });
            }
        }
    }
}

/// An ordered pair of boundaries.
#[derive(Clone, Copy)]
struct PairOf<'a, R> {
    i: usize,
    j: usize,
    target: &'a BoundaryRecord<R>,
    source: &'a BoundaryRecord<R>,
    target_nodes: Nodes<'a, R>,
    source_nodes: Nodes<'a, R>,
}

/// Reals of a vector of lanes of the target's nodes: positions and weights; velocities.
const TARGET: usize = WEIGHTS * LANES;
const VELOCITY: usize = VELOCITIES * LANES;
const SUM: usize = SUMS * LANES;

impl<R: Real> PairOf<'_, R> {
    /// The target's nodes in vectors of lanes: place in the source's frame, λ, λ X, μ, μ X, λ ż, λ ż X.
    #[inline(always)]
    fn fill_targets(&self, motion: &Relative<R>, from: &TangentSource<'_, R>, out: &mut [R]) {
        let n = self.target.nodes;
        let ([z0, z1], [w0, w1]) = (motion.place, motion.rate);
        let (adjoint, second) =
            (part(from.adjoint, self.target.first, n), part(from.second_adjoint, self.target.first, n));
        for (q, block) in out.as_chunks_mut::<TARGET>().0.iter_mut().enumerate() {
            for lane in 0..LANES {
                // What is missing to a whole vector stands where the last node stands, without weight.
                let (k, weight) = if q * LANES + lane < n { (q * LANES + lane, R::one()) } else { (n - 1, R::zero()) };
                let x = complex(at(self.target_nodes.x, k), at(self.target_nodes.y, k));
                let (l, u, z) = (at(adjoint, k) * weight, at(second, k) * weight, z0 + z1 * x);
                let (lx, ux, rate) = (x * l, x * u, (w0 + w1 * x) * l);
                let far = rate * x;
                let row = [z.re, z.im, l, lx.re, lx.im, u, ux.re, ux.im, rate.re, rate.im, far.re, far.im];
                for (column, value) in block.as_chunks_mut::<LANES>().0.iter_mut().zip(row) {
                    put(column, lane, value);
                }
            }
        }
    }

    /// Whether anything that the source induces at the target needs a pole term.
    fn has_poles(&self, c: &Configuration<'_, R>) -> bool {
        let (first, count) = (self.target.first, self.target.nodes);
        (first..first + count).any(|row| c.preimages(self.j, row).next().is_some())
    }

    /// Scratch of this pair: vectors of lanes of the target, and six complex columns on the source.
    fn scratch<'s>(&self, s: &'s mut TangentScratch<'_, R>) -> [&'s mut [R]; 3] {
        let blocks = self.target.nodes.div_ceil(LANES);
        [
            part_mut(s.targets, 0, blocks * TARGET),
            part_mut(s.velocities, 0, blocks * VELOCITY),
            part_mut(s.sums, 0, self.source.nodes.div_ceil(LANES) * SUM),
        ]
    }
}

/// The plain rule of one ordered pair.
struct Kernel<'a, 'b, 'c, R: Real> {
    pair: PairOf<'a, R>,
    motion: &'c Relative<R>,
    from: TangentSource<'a, R>,
    s: &'c mut TangentScratch<'b, R>,
}

impl<R: Real> Task for Kernel<'_, '_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Kernel { pair, motion, from, s } = self;
        let [targets, velocities, sums] = pair.scratch(s);
        pair.fill_targets(motion, &from, targets);
        velocities.fill(R::zero());
        let (source, nodes) = (pair.source, pair.source_nodes);
        let factor = nodes.step * source.sign / R::PI;
        let m = source.nodes;
        let densities = part(from.density, source.first, m).iter().zip(part(from.second_density, source.first, m));
        let points = nodes.points().zip(nodes.tangents()).zip(densities);
        for (k, ((g, dg), (one, two))) in points.enumerate() {
            let weight = dg * factor;
            let of = [weight * *one, weight * (*one + *one), weight * *two];
            let mut total = [[R::zero(); LANES]; SUMS];
            for (block, velocity) in
                targets.as_chunks::<TARGET>().0.iter().zip(velocities.as_chunks_mut::<VELOCITY>().0)
            {
                total = lanes_of_pair(g, of, block, velocity, total);
            }
            // Through memory: else the sums are carried lane by lane through the loop above.
            let total = core::hint::black_box(total);
            let twice = weight + weight;
            let weights = [weight, weight, weight, weight, twice, twice];
            for (c, (total, weight)) in total.as_chunks::<2>().0.iter().zip(weights).enumerate() {
                let [x, y] = *total;
                let value = complex(sum_of(x), sum_of(y)) * weight;
                put(sums, sum_at(k, 2 * c), value.re);
                put(sums, sum_at(k, 2 * c + 1), value.im);
            }
        }
    }
}

/// Where column `c` of the source's node `k` is.
#[inline(always)]
fn sum_at(k: usize, c: usize) -> usize {
    k / LANES * SUM + c * LANES + k % LANES
}

/// Eight nodes of the target and one of the source: velocities there, and the source's sums.
#[inline(always)]
fn lanes_of_pair<R: Real>(
    g: Complex<R>,
    [h, k, d]: [Complex<R>; 3],
    block: &[R; TARGET],
    velocity: &mut [R; VELOCITY],
    mut total: [[R; LANES]; SUMS],
) -> [[R; LANES]; SUMS] {
    let ([zx, zy, l, lx, ly, u, ux, uy, ax, ay, bx, by], [hx, hy, kx, ky, dx, dy]) =
        (block.as_chunks::<LANES>().0, velocity.as_chunks_mut::<LANES>().0)
    else {
        return total;
    };
    // 1/(Γ − z)² and 1/(Γ − z)³.
    let zero = [R::zero(); LANES];
    let (mut sx, mut sy, mut cx, mut cy) = (zero, zero, zero, zero);
    for ((((sx, sy), (cx, cy)), x), y) in sx.iter_mut().zip(&mut sy).zip(cx.iter_mut().zip(&mut cy)).zip(zx).zip(zy) {
        let (dx, dy) = (g.re - *x, g.im - *y);
        let inverse = R::one() / (dx * dx + dy * dy);
        let (ex, ey) = (dx * inverse, -dy * inverse);
        (*sx, *sy) = (ex * ex - ey * ey, (ex + ex) * ey);
        (*cx, *cy) = (ex * *sx - ey * *sy, ex * *sy + ey * *sx);
    }
    add_turned(hx, hy, h, &sx, &sy);
    add_turned(kx, ky, k, &cx, &cy);
    add_turned(dx, dy, d, &sx, &sy);
    let [p0x, p0y, p1x, p1y, q0x, q0y, q1x, q1y, e0x, e0y, e1x, e1y] = &mut total;
    for (weight, x, y) in [(l, p0x, p0y), (u, q0x, q0y)] {
        for (((x, y), w), (sx, sy)) in x.iter_mut().zip(y).zip(weight).zip(sx.iter().zip(&sy)) {
            (*x, *y) = (*x + *w * *sx, *y + *w * *sy);
        }
    }
    add_products(p1x, p1y, [lx, ly], [&sx, &sy]);
    add_products(q1x, q1y, [ux, uy], [&sx, &sy]);
    add_products(e0x, e0y, [ax, ay], [&cx, &cy]);
    add_products(e1x, e1y, [bx, by], [&cx, &cy]);
    total
}

/// Adds w s for one w.
#[inline(always)]
fn add_turned<R: Real>(x: &mut [R; LANES], y: &mut [R; LANES], w: Complex<R>, sx: &[R; LANES], sy: &[R; LANES]) {
    for ((x, y), (sx, sy)) in x.iter_mut().zip(y).zip(sx.iter().zip(sy)) {
        (*x, *y) = (*x + (w.re * *sx - w.im * *sy), *y + (w.re * *sy + w.im * *sx));
    }
}

/// Adds a b, lane by lane.
#[inline(always)]
fn add_products<R: Real>(
    x: &mut [R; LANES],
    y: &mut [R; LANES],
    [ax, ay]: [&[R; LANES]; 2],
    [bx, by]: [&[R; LANES]; 2],
) {
    for (((x, y), (ax, ay)), (bx, by)) in x.iter_mut().zip(y).zip(ax.iter().zip(ay)).zip(bx.iter().zip(by)) {
        (*x, *y) = (*x + (*ax * *bx - *ay * *by), *y + (*ax * *by + *ay * *bx));
    }
}

impl<R: Real> PairOf<'_, R> {
    /// The pole terms of D and E.
    #[inline(never)]
    fn add_poles(&self, c: &Configuration<'_, R>, from: TangentSource<'_, R>, s: &mut TangentScratch<'_, R>) {
        let (i, j, m) = (self.i, self.j, self.source.nodes);
        let source = Source {
            record: self.source,
            nodes: self.source_nodes,
            view: c.outline(j, self.source),
            table: self.source.table(c.model.store),
        };
        if source.table.is_empty() {
            return;
        }
        let (turn, shift) = relative(c.pose(i), c.pose(j));
        let targets = Targets { nodes: self.target_nodes, turn, shift, own: false };
        let [weights, velocities, sums] = self.scratch(s);
        let densities = [part(from.density, self.source.first, m), part(from.second_density, self.source.first, m)];
        let factor = self.source.sign / R::PI;
        each_preimage(&source, &targets, &mut |row, p| {
            let (q, lane) = (row / LANES, row % LANES);
            let weight = |k: usize| at(weights, q * TARGET + k * LANES + lane);
            let real = |k: usize| complex(weight(k), R::zero());
            let both = |k: usize| complex(weight(k), weight(k + 1));
            let of = [real(2), both(3), real(5), both(6), both(8), both(10)];
            let bend = source.view.second_rate(at(source.nodes.t, p.node), p.offset);
            let mut found = [Complex::default(); 3];
            pole::each_slope(&p, source.table, m, bend, |k, d, e| {
                let (d, e) = (d * factor, e * factor);
                let (one, two) = (at(densities[0], k), at(densities[1], k));
                for (sum, term) in found.iter_mut().zip([d * one, e * one, d * two]) {
                    *sum += term;
                }
                for (c, (w, x)) in of.iter().zip([d, d, d, d, e, e]).enumerate() {
                    let term = *w * x;
                    add(sums, sum_at(k, 2 * c), term.re);
                    add(sums, sum_at(k, 2 * c + 1), term.im);
                }
            });
            for (c, sum) in found.iter().enumerate() {
                add(velocities, q * VELOCITY + 2 * c * LANES + lane, sum.re);
                add(velocities, q * VELOCITY + (2 * c + 1) * LANES + lane, sum.im);
            }
        });
    }
}

/// Unit motion number `k` (x, y, θ) of a link.
fn unit<R: Real>(k: usize) -> Twist<R> {
    let (zero, one) = (R::zero(), R::one());
    match k {
        0 => Twist { linear: complex(one, zero), angular: zero },
        1 => Twist { linear: complex(zero, one), angular: zero },
        _ => Twist { linear: Complex::default(), angular: one },
    }
}

/// How a pair's target moves in its source's frame.
#[derive(Clone, Copy)]
struct Frames<R> {
    target: Pose<R>,
    source: Pose<R>,
}

impl<R: Real> Frames<R> {
    /// ż = v₀ + v₁ X for twists of both.
    fn rate(&self, [i, j]: &[Twist<R>; 2]) -> [Complex<R>; 2] {
        let shift = self.target.origin - self.source.origin;
        let turn = self.source.unturned(self.target.turn);
        [self.source.unturned(i.linear - j.at(shift)), perp(turn) * (i.angular - j.angular)]
    }

    /// z̈ = a₀ + a₁ X, the mixed derivative along two such motions.
    fn second(&self, [i, j]: &[Twist<R>; 2], [k, l]: &[Twist<R>; 2]) -> [Complex<R>; 2] {
        let shift = self.target.origin - self.source.origin;
        let turn = self.source.unturned(self.target.turn);
        let linear = perp(i.linear - j.linear) * l.angular + perp(k.linear - l.linear) * j.angular;
        let a0 = self.source.unturned(-linear - shift * (j.angular * l.angular));
        [a0, -turn * ((i.angular - j.angular) * (k.angular - l.angular))]
    }
}

/// Takes what the kernel found of one pair to the columns.
struct Distribute<'a, 'b, 'c, 'd, R: Real> {
    c: &'c Configuration<'a, R>,
    pair: PairOf<'a, R>,
    from: TangentSource<'a, R>,
    s: &'c mut TangentScratch<'b, R>,
    out: &'c mut TangentResult<'d, R>,
}

impl<R: Real> Task for Distribute<'_, '_, '_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Distribute { c, pair, from, s, out } = self;
        let frames = Frames { target: c.pose(pair.i), source: c.pose(pair.j) };
        let actual = [boundary_twist(c, from.qd, pair.i), boundary_twist(c, from.qd, pair.j)];
        let still = Twist::default();
        // Unit motions of both: column, twists.
        let ends = [(pair.target.link, true), (pair.source.link, false)];
        let units = ends.into_iter().flat_map(|(link, target)| {
            let motion = move |k| if target { [unit(k), still] } else { [still, unit(k)] };
            link.into_iter().flat_map(move |link| (0..3).map(move |k| (3 * link + k, motion(k))))
        });
        let [targets, velocities, sums] = pair.scratch(s);
        let moments = moments(&pair, targets, velocities);
        let rows = 3 * c.model.links.len();
        combine(&pair.target_nodes, frames.rate(&actual), velocities);
        for (b, motion) in units.clone() {
            let (v, a) = (frames.rate(&motion), frames.second(&motion, &actual));
            let (first, n) = (b * out.ld + pair.target.first, pair.target.nodes);
            let columns = [part_mut(out.rate, first, n), part_mut(out.second, first, n)];
            add_on_target(&pair.target_nodes, [v, a], velocities, columns);
            let (first, m) = (b * out.ld + pair.source.first, pair.source.nodes);
            let columns = [part_mut(out.transposed, first, m), part_mut(out.second_transposed, first, m)];
            add_on_source([v, a], sums, columns);
            let [m0, m1, n0, n1, n2] = moments;
            for (other, along) in units.clone() {
                let (w, a) = (frames.rate(&along), frames.second(&motion, &along));
                let twice = v[0] * w[0] * n0 + (v[0] * w[1] + v[1] * w[0]) * n1 + v[1] * w[1] * n2;
                add(out.hessian, b * rows + other, (twice + a[0] * m0 + a[1] * m1).im);
            }
        }
    }
}

/// What all motions of a pair have in common: D w + ż ∘ E u in place of D w.
#[inline(always)]
fn combine<R: Real>(nodes: &Nodes<'_, R>, [w0, w1]: [Complex<R>; 2], velocities: &mut [R]) {
    let places = nodes.x.chunks(LANES).zip(nodes.y.chunks(LANES));
    for (block, (x, y)) in velocities.as_chunks_mut::<VELOCITY>().0.iter_mut().zip(places) {
        let [_, _, kx, ky, gx, gy] = block.as_chunks_mut::<LANES>().0 else { continue };
        let (x, y) = (lanes(x, R::zero()), lanes(y, R::zero()));
        for ((((gx, gy), kx), ky), (x, y)) in gx.iter_mut().zip(gy).zip(kx).zip(ky).zip(x.iter().zip(&y)) {
            let (re, im) = (w0.re + (w1.re * *x - w1.im * *y), w0.im + (w1.re * *y + w1.im * *x));
            (*gx, *gy) = (*gx + (re * *kx - im * *ky), *gy + (re * *ky + im * *kx));
        }
    }
}

/// Adds Im((v₀ + v₁ X) h), and Im((v₀ + v₁ X) g + (a₀ + a₁ X) h), on the target's nodes.
#[inline(always)]
fn add_on_target<R: Real>(
    nodes: &Nodes<'_, R>,
    [[v0, v1], [a0, a1]]: [[Complex<R>; 2]; 2],
    velocities: &[R],
    [rates, seconds]: [&mut [R]; 2],
) {
    let columns = rates.chunks_mut(LANES).zip(seconds.chunks_mut(LANES));
    let places = nodes.x.chunks(LANES).zip(nodes.y.chunks(LANES));
    for ((block, (x, y)), (rates, seconds)) in velocities.as_chunks::<VELOCITY>().0.iter().zip(places).zip(columns) {
        let [hx, hy, _, _, gx, gy] = block.as_chunks::<LANES>().0 else { continue };
        let (x, y) = (lanes(x, R::zero()), lanes(y, R::zero()));
        let (mut rate, mut second) = (lanes(rates, R::zero()), lanes(seconds, R::zero()));
        let found = hx.iter().zip(hy).zip(gx.iter().zip(gy));
        for (((rate, second), (x, y)), ((hx, hy), (gx, gy))) in
            rate.iter_mut().zip(&mut second).zip(x.iter().zip(&y)).zip(found)
        {
            let (vx, vy) = (v0.re + (v1.re * *x - v1.im * *y), v0.im + (v1.re * *y + v1.im * *x));
            let (ax, ay) = (a0.re + (a1.re * *x - a1.im * *y), a0.im + (a1.re * *y + a1.im * *x));
            *rate += vx * *hy + vy * *hx;
            *second += (vx * *gy + vy * *gx) + (ax * *hy + ay * *hx);
        }
        put_lanes(rate, rates);
        put_lanes(second, seconds);
    }
}

/// Adds Im(v₀ p₀ + v₁ p₁), and Im(v₀ q₀ + v₁ q₁ + a₀ p₀ + a₁ p₁), on the source's nodes.
#[inline(always)]
fn add_on_source<R: Real>([[v0, v1], [a0, a1]]: [[Complex<R>; 2]; 2], sums: &[R], [rates, seconds]: [&mut [R]; 2]) {
    let columns = rates.chunks_mut(LANES).zip(seconds.chunks_mut(LANES));
    for (block, (rates, seconds)) in sums.as_chunks::<SUM>().0.iter().zip(columns) {
        let [p0x, p0y, p1x, p1y, q0x, q0y, q1x, q1y, e0x, e0y, e1x, e1y] = block.as_chunks::<LANES>().0 else {
            continue;
        };
        let (mut rate, mut second) = (lanes(rates, R::zero()), lanes(seconds, R::zero()));
        for ((rate, (x, y)), (z, w)) in rate.iter_mut().zip(p0x.iter().zip(p0y)).zip(p1x.iter().zip(p1y)) {
            *rate += (v0.re * *y + v0.im * *x) + (v1.re * *w + v1.im * *z);
        }
        for ((second, (x, y)), (z, w)) in second.iter_mut().zip(p0x.iter().zip(p0y)).zip(p1x.iter().zip(p1y)) {
            *second += (a0.re * *y + a0.im * *x) + (a1.re * *w + a1.im * *z);
        }
        for (zero, one) in [([q0x, q0y], [q1x, q1y]), ([e0x, e0y], [e1x, e1y])] {
            let parts = zero[0].iter().zip(zero[1]).zip(one[0].iter().zip(one[1]));
            for (second, ((x, y), (z, w))) in second.iter_mut().zip(parts) {
                *second += (v0.re * *y + v0.im * *x) + (v1.re * *w + v1.im * *z);
            }
        }
        put_lanes(rate, rates);
        put_lanes(second, seconds);
    }
}

/// Σ λ h, Σ λ h X, Σ λ k, Σ λ k X, Σ λ k X² over the target's nodes.
#[inline(always)]
fn moments<R: Real>(pair: &PairOf<'_, R>, targets: &[R], velocities: &[R]) -> [Complex<R>; 5] {
    let mut sums = [Complex::<R>::default(); 5];
    let mut x = pair.target_nodes.points();
    for (block, velocity) in targets.as_chunks::<TARGET>().0.iter().zip(velocities.as_chunks::<VELOCITY>().0) {
        let [hx, hy, kx, ky, ..] = velocity.as_chunks::<LANES>().0 else { continue };
        let weights = block.as_chunks::<LANES>().0.get(2).into_iter().flatten();
        for ((weight, (hx, hy)), ((kx, ky), x)) in weights.zip(hx.iter().zip(hy)).zip(kx.iter().zip(ky).zip(&mut x)) {
            let (h, k) = (complex(*hx, *hy) * *weight, complex(*kx, *ky) * *weight);
            let (hx, kx) = (h * x, k * x);
            for (sum, term) in sums.iter_mut().zip([h, hx, k, kx, kx * x]) {
                *sum += term;
            }
        }
    }
    sums
}
