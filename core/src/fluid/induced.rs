//! What the density on one boundary induces at another that moves: velocities D w, and the sums over pairs from which gradients by
//! the poses are made.
//!
//! D = dW/dz, D_ik = (sign_j/π) h Γ'_k/(Γ_k − z_i)². Tested by `tests/gradients` against differences and by `assembly_test`.

use crate::base::complex::{Complex, complex, perp};
use crate::base::lanes::{LANES, lanes, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{buffers, part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::near::buffers::Near;
use crate::fluid::near::pole;
use crate::geometry::nodes::{Nodes, fill_targets};
use crate::geometry::pose::{Twist, twist_of};
use crate::model::boundary::BoundaryRecord;

buffers! {
    /// Scratch of the passes over pairs: six vectors of length N, of which nothing outlives a pass.
    pub(crate) struct PairScratch(unknowns: usize) {
        /// Nodes of the target in the source's frame.
        zx: R = *unknowns,
        zy: R = *unknowns,
        /// What is induced there.
        hx: R = *unknowns,
        hy: R = *unknowns,
        /// Weights times rates.
        fx: R = *unknowns,
        fy: R = *unknowns,
    }
}

/// One ordered pair (target i, source j) as a pass sees it: nodes of the target in the source's frame and what
/// the source induces there.
pub(crate) struct Induced<'a, R> {
    pub target: usize,
    pub source: usize,
    /// First unknown and number of unknowns of the target.
    pub first: usize,
    pub len: usize,
    pub nodes: Nodes<'a, R>,
    pub hx: &'a [R],
    pub hy: &'a [R],
}

/// Visits every ordered pair of different boundaries of which one moves, with h = D_ij w_j at the target's nodes.
/// `w` is complex (an empty imaginary part is 0). 20 flops per pair of nodes.
pub(crate) fn each_induced<R: Real>(
    c: &Configuration<'_, R>,
    wx: &[R],
    wy: &[R],
    s: &mut PairScratch<'_, R>,
    mut visit: impl FnMut(Induced<'_, R>),
) {
    for (j, source, source_nodes) in c.each_boundary() {
        for (i, target, nodes) in c.each_boundary() {
            if i == j || (source.link.is_none() && target.link.is_none()) {
                continue;
            }
            let n = target.nodes;
            let (zx, zy) = (part_mut(s.zx, 0, n), part_mut(s.zy, 0, n));
            fill_targets(&nodes, c.pose(i), c.pose(j), zx, zy);
            let (hx, hy) = (part_mut(s.hx, 0, n), part_mut(s.hy, 0, n));
            hx.fill(R::zero());
            hy.fill(R::zero());
            let (wx, wy) = (part(wx, source.first, source.nodes), part(wy, source.first, source.nodes));
            induced_velocity(source, &source_nodes, wx, wy, zx, zy, hx, hy);
            add_pole_velocity(c, (j, source), target.first, [wx, wy], [&[], &[]], [hx, hy], &mut []);
            visit(Induced { target: i, source: j, first: target.first, len: n, nodes, hx, hy });
        }
    }
}

/// Complex velocity that a density `w` (real and imaginary part; an empty imaginary part is 0) on boundary j
/// induces at the targets: Σ_k D_ik w_k, D = (sign_j/π) h Γ'_k/(Γ_k − z_i)². Adds to `hx`, `hy`. One division per pair.
pub(crate) fn induced_velocity<R: Real>(
    source: &BoundaryRecord<R>,
    nodes: &Nodes<'_, R>,
    wx: &[R],
    wy: &[R],
    zx: &[R],
    zy: &[R],
    hx: &mut [R],
    hy: &mut [R],
) {
    let factor = nodes.step * source.sign / R::PI;
    for (k, ((g, dg), wx)) in nodes.points().zip(nodes.tangents()).zip(wx).enumerate() {
        let c = dg * complex(*wx, wy.get(k).copied().unwrap_or(R::zero())) * factor;
        for (((hx, hy), x), y) in hx.iter_mut().zip(hy.iter_mut()).zip(zx).zip(zy) {
            let (dx, dy) = (g.re - *x, g.im - *y);
            let inverse = R::one() / (dx * dx + dy * dy);
            let (ex, ey) = (dx * inverse, -dy * inverse);
            let (sx, sy) = (ex * ex - ey * ey, (ex + ex) * ey);
            *hx += c.re * sx - c.im * sy;
            *hy += c.re * sy + c.im * sx;
        }
    }
}

/// Adds the pole terms of D to what the plain rule gives: h_i += Σ_k D_ik w_k at the targets of one boundary and, where
/// `f` and `out` are not empty, Im Σ_i f_i D_ik to `out_k`.
pub(crate) fn add_pole_velocity<R: Real>(
    c: &Configuration<'_, R>,
    (j, source): (usize, &BoundaryRecord<R>),
    first: usize,
    [wx, wy]: [&[R]; 2],
    [fx, fy]: [&[R]; 2],
    [hx, hy]: [&mut [R]; 2],
    out: &mut [R],
) {
    let table = source.table(c.model.store);
    if table.is_empty() {
        return;
    }
    let scale = source.sign / R::PI;
    Machine::here().run(PoleVelocity {
        near: c.near,
        j,
        first,
        table,
        scale,
        w: [wx, wy],
        f: [fx, fy],
        h: [hx, hy],
        out,
    });
}

/// The loop of [`add_pole_velocity`].
struct PoleVelocity<'a, 'b, R: Real> {
    near: Near<'a, R>,
    j: usize,
    first: usize,
    table: &'a [R],
    scale: R,
    w: [&'b [R]; 2],
    f: [&'b [R]; 2],
    h: [&'b mut [R]; 2],
    out: &'b mut [R],
}

impl<R: Real> Task for PoleVelocity<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let PoleVelocity { near, j, first, table, scale, w, f: [fx, fy], h: [hx, hy], out } = self;
        for (i, (hx, hy)) in hx.iter_mut().zip(hy).enumerate() {
            for p in near.preimages(j, first + i) {
                let h = match fx.get(i).zip(fy.get(i)) {
                    Some((fx, fy)) => pole::slope_products(&p, table, w[0], complex(*fx, *fy), scale, out),
                    None => pole::slope_sum(&p, table, w, scale),
                };
                (*hx, *hy) = (*hx + h.re, *hy + h.im);
            }
        }
    }
}

/// Twist of a boundary (0 for walls) from velocities of the links.
#[inline]
pub(crate) fn boundary_twist<R: Real>(c: &Configuration<'_, R>, rates: &[R], boundary: usize) -> Twist<R> {
    link_of(c, boundary).map_or_else(Twist::default, |link| twist_of(rates, link))
}

#[inline]
fn link_of<R: Real>(c: &Configuration<'_, R>, boundary: usize) -> Option<usize> {
    c.model.boundaries.get(boundary).and_then(|b| b.link)
}

/// Where a target's nodes x (own frame) are in its source's frame, z₀ + z₁ x, and how they move there, v₀ + v₁ x.
pub(crate) struct Relative<R> {
    pub place: [Complex<R>; 2],
    pub rate: [Complex<R>; 2],
}

impl<R: Real> Relative<R> {
    pub(crate) fn of(c: &Configuration<'_, R>, target: usize, source: usize, rates: &[R]) -> Self {
        let (p, q) = (c.pose(target), c.pose(source));
        let (vi, vj) = (boundary_twist(c, rates, target), boundary_twist(c, rates, source));
        let shift = p.origin - q.origin;
        let turn = q.unturned(p.turn);
        let rate = [q.unturned(vi.linear - vj.at(shift)), perp(turn) * (vi.angular - vj.angular)];
        Relative { place: [q.unturned(shift), turn], rate }
    }
}

/// Rate of change of the target's nodes in the source's frame, node by node.
pub(crate) fn relative_rates<'a, R: Real>(
    pair: &Induced<'a, R>,
    c: &Configuration<'_, R>,
    rates: &[R],
) -> impl Iterator<Item = Complex<R>> + 'a {
    let [v0, v1] = Relative::of(c, pair.target, pair.source, rates).rate;
    let nodes = pair.nodes;
    // `nodes` borrows the model's store, not the pair.
    nodes.x.iter().zip(nodes.y).map(move |(x, y)| v0 + v1 * complex(*x, *y))
}

/// Adds scale · Im Σ f (1, i, i·arm) to the gradient by the target's pose, and subtracts it (with the arm from the
/// source) from the source's; f = weight · h, turned to world directions.
pub(crate) fn add_pose_gradient<R: Real>(
    pair: &Induced<'_, R>,
    c: &Configuration<'_, R>,
    weight: &[R],
    scale: R,
    gradient: &mut [R],
) {
    let mut sums = [Complex::default(); 2];
    Machine::here().run(PairSums { weight, nodes: pair.nodes, h: [pair.hx, pair.hy], sums: &mut sums });
    add_pose_sums(c, pair.target, pair.source, sums, scale, gradient);
}

/// The same from the sums Σ w h and Σ w h x over the target's nodes x.
pub(crate) fn add_pose_sums<R: Real>(
    c: &Configuration<'_, R>,
    target: usize,
    source: usize,
    sums: [Complex<R>; 2],
    scale: R,
    gradient: &mut [R],
) {
    let (p, q) = (c.pose(target), c.pose(source));
    let [force, moment] = sums.map(|sum| sum * q.turn.conj());
    // Im(i f arm) = Re(f arm); the arm from the source is longer by the distance of the origins.
    let turn_target = (moment * p.turn).re;
    let turn_source = (force * (p.origin - q.origin)).re + turn_target;
    // (Im Σf, Im iΣf) = (Im, Re)
    let linear = complex(force.im, force.re) * scale;
    add_three(c, target, linear, turn_target * scale, gradient);
    add_three(c, source, -linear, -turn_source * scale, gradient);
}

/// [`pose_sums`] as a task.
struct PairSums<'a, 'b, R> {
    weight: &'b [R],
    nodes: Nodes<'a, R>,
    h: [&'b [R]; 2],
    sums: &'b mut [Complex<R>; 2],
}

impl<R: Real> Task for PairSums<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        *self.sums = pose_sums(self.weight, &self.nodes, self.h);
    }
}

/// Σ w h and Σ w h x over the nodes x of a target.
#[inline(always)]
pub(crate) fn pose_sums<R: Real>(weight: &[R], nodes: &Nodes<'_, R>, [hx, hy]: [&[R]; 2]) -> [Complex<R>; 2] {
    let (w, x, y) = (weight.as_chunks(), nodes.x.as_chunks(), nodes.y.as_chunks());
    let (hx, hy) = (hx.as_chunks(), hy.as_chunks());
    let mut sums = [[R::zero(); LANES]; 4];
    for ((w, (x, y)), (hx, hy)) in w.0.iter().zip(x.0.iter().zip(y.0)).zip(hx.0.iter().zip(hy.0)) {
        sums = pair_lanes([*w, *x, *y, *hx, *hy], sums);
    }
    if !w.1.is_empty() {
        sums = pair_lanes([w.1, x.1, y.1, hx.1, hy.1].map(|rest| lanes(rest, R::zero())), sums);
    }
    let [a, b, c, d] = sums.map(sum_of);
    [complex(a, b), complex(c, d)]
}

#[inline(always)]
fn pair_lanes<R: Real>(
    [w, x, y, hx, hy]: [[R; LANES]; 5],
    [mut a, mut b, mut c, mut d]: [[R; LANES]; 4],
) -> [[R; LANES]; 4] {
    let (mut fx, mut fy) = (hx, hy);
    for ((fx, fy), w) in fx.iter_mut().zip(&mut fy).zip(w) {
        (*fx, *fy) = (*fx * w, *fy * w);
    }
    for ((a, b), (fx, fy)) in a.iter_mut().zip(&mut b).zip(fx.iter().zip(&fy)) {
        (*a, *b) = (*a + *fx, *b + *fy);
    }
    for (((c, d), (x, y)), (fx, fy)) in c.iter_mut().zip(&mut d).zip(x.iter().zip(&y)).zip(fx.iter().zip(&fy)) {
        (*c, *d) = (*c + (*fx * *x - *fy * *y), *d + (*fx * *y + *fy * *x));
    }
    [a, b, c, d]
}

/// Adds to a boundary's three reals, if it moves.
pub(crate) fn add_three<R: Real>(
    c: &Configuration<'_, R>,
    boundary: usize,
    linear: Complex<R>,
    angular: R,
    out: &mut [R],
) {
    if let Some(link) = link_of(c, boundary) {
        for (o, x) in part_mut(out, 3 * link, 3).iter_mut().zip([linear.re, linear.im, angular]) {
            *o += x;
        }
    }
}
