//! The Christoffel force as the exact gradient of the discrete added mass, and the paper's (2.15) beside it.
//!
//! With v the velocity, A u = −2 X v and Aᵀ λ = B v, the derivative of the discrete added mass along any motion of
//! the boundaries is vᵀ dM_h v = λᵀ Im(dG) u: only the blocks between different boundaries contribute, through
//! D = dW/dz. One pass over the pairs gives the rate a = Im(ż ∘ D u) along the actual motion, and
//! g_a = q̇ᵀ (∂M/∂q_a) q̇. Then F = (T₁ + T₂)/2 + J p − M J q̇ − g/2 with T₁ = Bᵀ A⁻¹ a, T₂ = −2 Xᵀ A⁻ᵀ l,
//! l = Im((λ ż)ᵀ D) from the same pass, p = M q̇, (J v)_i = ω_i (−v_y, v_x, 0). Either half alone delivers the discrete
//! power; their mean is the derivative of the symmetrized M and so delivers the discrete impulse too.

use crate::base::complex::{Complex, cabs, complex, dot, perp};
use crate::base::lanes::{LANES, lanes, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{copy, part, part_mut};
use crate::base::scalar::Real;
use crate::dynamics::articulation::twist_of;
use crate::fluid::assembly::{add_pole_velocity, induced_velocity};
use crate::fluid::configuration::Configuration;
use crate::fluid::configuration::fill_targets;
use crate::geometry::pose::Twist;
use crate::model::boundary::Nodes;

/// Scratch of the pair passes: six vectors of length N.
pub(crate) struct PairScratch<'a, R> {
    pub fx: &'a mut [R],
    pub fy: &'a mut [R],
    pub zx: &'a mut [R],
    pub zy: &'a mut [R],
    pub hx: &'a mut [R],
    pub hy: &'a mut [R],
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

/// Completes a force of per-unit-density quantities in world directions, in place:
/// `force += J p − g/2`, where the angular part of g also holds the turning of the frames.
pub(crate) fn add_frame_terms<R: Real>(links: usize, qd: &[R], momentum: &[R], gradient: &[R], force: &mut [R]) {
    for i in 0..links {
        let (v, p, g) = (twist_of(qd, i), twist_of(momentum, i), twist_of(gradient, i));
        let turning = R::TWO * (v.linear.im * p.linear.re - v.linear.re * p.linear.im);
        let linear = perp(p.linear) * v.angular - g.linear * R::HALF;
        let angular = -(g.angular + turning) * R::HALF;
        for (f, x) in part_mut(force, 3 * i, 3).iter_mut().zip([linear.re, linear.im, angular]) {
            *f += x;
        }
    }
}

/// (J v)_i = ω_i (−v_y, v_x, 0), subtracted: `out = base − J q̇`.
pub(crate) fn without_turning<R: Real>(links: usize, base: &[R], qd: &[R], out: &mut [R]) {
    copy(out, base);
    for i in 0..links {
        let v = twist_of(qd, i);
        let j = perp(v.linear) * v.angular;
        for (o, x) in part_mut(out, 3 * i, 3).iter_mut().zip([j.re, j.im, R::zero()]) {
            *o -= x;
        }
    }
}

/// The derivative by the boundary's parameter of samples at N equispaced parameters (the trigonometric
/// interpolant's; the highest mode's derivative is 0). O(N²), for cross-checks.
pub(crate) fn periodic_derivative<R: Real>(f: &[R], k: usize) -> R {
    let n = f.len();
    let h = R::PI / R::count(n.max(1));
    let mut sum = R::zero();
    for (j, fj) in f.iter().enumerate().filter(|(j, _)| *j != k) {
        let d = j.abs_diff(k);
        let (s, c) = (R::count(d) * h).sin_cos();
        let weight = if d % 2 == 0 { c / s } else { -c / s };
        // ½ (−1)^(k−j) cot((s_k − s_j)/2)
        sum += if k > j { *fj * weight } else { -*fj * weight };
    }
    sum * R::HALF
}

/// (2.15) per unit density: fills `kernel` so that the force is Σ ψ_a kernel, and adds to `out` (link frames) the part
/// that multiplies b_a. With ∂τ integrated by parts, −∫ ∂τψ_a ∂τψ v_n = ∫ ψ_a ∂τ(∂τψ v_n).
///
/// `potential` is ψ of the motion; `v` the links' velocities in their frames; `work` scratch of length N. O(N²).
pub(crate) fn boundary_formula<R: Real>(
    c: &Configuration<'_, R>,
    potential: &[R],
    v: &[R],
    kernel: &mut [R],
    work: &mut [R],
    out: &mut [R],
) {
    kernel.fill(R::zero());
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let twist = twist_of(v, link);
        let psi = part(potential, b.first, b.nodes);
        let product = part_mut(work, b.first, b.nodes);
        let kernel = part_mut(kernel, b.first, b.nodes);
        let (mut linear, mut angular) = (Complex::default(), R::zero());
        for (k, (x, d)) in nodes.points().zip(nodes.tangents()).enumerate() {
            let speed = cabs(d);
            // n = i T into the link, τ = i n = −T: ∂τ = −d/ds / speed.
            let normal = perp(d) / speed;
            let velocity = twist.at(x);
            let (xi, zeta) = (dot(velocity, perp(normal)), dot(velocity, normal));
            let slope = -periodic_derivative(psi, k) / speed;
            if let Some(p) = product.get_mut(k) {
                *p = slope * zeta;
            }
            let second = complex(periodic_derivative(nodes.dx, k), periodic_derivative(nodes.dy, k));
            let curvature = dot(perp(d), second) / (speed * speed * speed);
            let arm = dot(x, normal);
            let s =
                curvature * (xi * xi - zeta * zeta) + R::TWO * xi * twist.angular - arm * twist.angular * twist.angular;
            if let Some(g) = kernel.get_mut(k) {
                *g = s * speed * nodes.step;
            }
            let half = (slope * slope + zeta * zeta) * R::HALF * nodes.step;
            linear += perp(d) * half;
            angular += dot(x, d) * half;
        }
        for (k, g) in kernel.iter_mut().enumerate() {
            // ds ∂τ = −h d/ds
            *g -= periodic_derivative(product, k) * nodes.step;
        }
        for (o, x) in part_mut(out, 3 * link, 3).iter_mut().zip([linear.re, linear.im, angular]) {
            *o += x;
        }
    }
}
