//! Circulation: the flow of constant circulations γ_i around links and obstacles, its energy gradient and the force
//! linear in the velocities (Kutta–Joukowski), both as exact derivatives of discrete quantities.
//!
//! Core flow of boundary i in its frame: L(z) with Re L its stream function per 2π of strength, L = log z about a point or
//! log W about an ellipse; strengths q_i = γ_i/2π. On all nodes Ψ = Σ q_i Re L, its fluxes dn = Σ q_i Re(ν L') and
//! β = Σ q_i Re(iν L') with ν = n ds. The flow that cancels the cores' normal velocity solves A φ = Re(G) Ψ: one more
//! right-hand side of the same matrix. Energy T_c = ½ (Ψ·dn − φ·β), impulse P = Bᵀφ − Sᵀdn with
//! S = (y, −x, −|X|²/2). Everything here is per unit density of the fluid.

use crate::base::complex::{Complex, cln, complex, csqrt, dot, perp};
use crate::base::memory::{add, at, axpy, buffers, copy, inner, part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::{
    Induced, PairScratch, add_pose_gradient, add_three, boundary_twist, each_induced, relative_rates,
};
use crate::fluid::potentials::{flux_moments, to_world};
use crate::fluid::system::BoundarySystem;
use crate::geometry::nodes::{Nodes, targets};
use crate::geometry::pose::{put_three, twist_of};
use crate::model::boundary::{BoundaryRecord, Core};

buffers! {
    /// The circulatory flow of a configuration, N each, per unit density. Written by [`solve`], for the position placed last.
    pub(crate) struct Flow(unknowns: usize) {
        /// Ψ.
        stream: R = *unknowns,
        /// dn.
        normal: R = *unknowns,
        /// β.
        tangential: R = *unknowns,
        /// φ.
        potential: R = *unknowns,
        /// A⁻ᵀ β · by [`add_energy_gradient`]; then scratch of [`add_gyroscopic_force`].
        adjoint: R = *unknowns,
        /// Scratch of one function.
        spare: R = *unknowns,
        /// Scratch of one function.
        second: R = *unknowns,
    }
}

/// L, L', L'' at z (frame of the core's boundary).
pub(crate) fn core_flow<R: Real>(core: &Core<R>, z: Complex<R>) -> [Complex<R>; 3] {
    let z = z - core.centre;
    let one = complex(R::one(), R::zero());
    let [a, b] = core.axes;
    if a == b {
        let inverse = one / z;
        return [cln(z), inverse, -inverse * inverse];
    }
    // √(z² − c²) on the branch ~ z outside the segment of the foci.
    let c2 = complex(a * a - b * b, R::zero());
    let root = z * csqrt(one - c2 / (z * z));
    let inverse = one / root;
    [cln((z + root) / (a + b)), inverse, -z * inverse * inverse * inverse]
}

/// ν = n ds of a boundary's nodes in its own frame: +i h Γ' on solids, −i h Γ' on the tank.
fn normals<'a, R: Real>(record: &BoundaryRecord<R>, nodes: &'a Nodes<'a, R>) -> impl Iterator<Item = Complex<R>> + 'a {
    let scale = -record.sign * nodes.step;
    nodes.tangents().map(move |d| perp(d) * scale)
}

/// Boundaries that carry circulation, with their strengths γ/2π.
fn cores<'a, R: Real>(
    c: &Configuration<'a, R>,
) -> impl Iterator<Item = (usize, &'a BoundaryRecord<R>, R)> + use<'a, R> {
    c.each_boundary().filter(|(_, b, _)| b.circulation != R::zero()).map(|(i, b, _)| (i, b, b.circulation / R::TAU))
}

/// Sets up the circulatory flow: Ψ, dn, β, φ. One solve.
pub(crate) fn solve<R: Real>(c: &Configuration<'_, R>, system: &BoundarySystem<'_, R>, flow: &mut Flow<'_, R>) {
    flow.stream.fill(R::zero());
    flow.normal.fill(R::zero());
    flow.tangential.fill(R::zero());
    for (i, b, strength) in cores(c) {
        for (m, target, nodes) in c.each_boundary() {
            let turn = c.pose(i).unturned(c.pose(m).turn);
            let values = targets(&nodes, c.pose(m), c.pose(i)).zip(normals(target, &nodes));
            for (k, (z, n)) in values.enumerate() {
                let [l, d, _] = core_flow(&b.core, z);
                let slope = turn * n * d;
                add(flow.stream, target.first + k, strength * l.re);
                add(flow.normal, target.first + k, strength * slope.re);
                // On its own ellipse or disc the core flow is exactly tangential.
                if m != i || b.core.axes[0] == R::zero() {
                    add(flow.tangential, target.first + k, -strength * slope.im);
                }
            }
        }
    }
    multiply(system.regular, flow.stream, flow.potential);
    system.factors().solve(flow.potential);
}

/// How well the nodes resolve the cores' flows, relative to the circulations: their fluxes through every boundary, of which the
/// integral of dn is −γ of the cores inside and that of β is 0; ten times as much, since what follows from them was found up to
/// that much less exact about thin bodies. After [`solve`]; O(N).
pub(crate) fn data_error<R: Real>(c: &Configuration<'_, R>, flow: &Flow<'_, R>) -> R {
    let total = cores(c).fold(R::zero(), |sum, (_, b, _)| sum + b.circulation.abs());
    let all = cores(c).fold(R::zero(), |sum, (_, b, _)| sum + b.circulation);
    let mut worst = R::zero();
    for (_, b, _) in c.each_boundary() {
        let sum = |x: &[R]| part(x, b.first, b.nodes).iter().fold(R::zero(), |sum, x| sum + *x);
        let inside = if b.sign > R::zero() { -all } else { b.circulation };
        worst = worst.max((sum(flow.normal) + inside).abs()).max(sum(flow.tangential).abs());
    }
    worst / total * R::lit(10.0)
}

/// `out = G x` for a column-major square matrix.
fn multiply<R: Real>(g: &[R], x: &[R], out: &mut [R]) {
    out.fill(R::zero());
    for (column, x) in g.chunks_exact(x.len().max(1)).zip(x) {
        axpy(out, *x, column);
    }
}

/// `out = Gᵀ x`.
fn multiply_transposed<R: Real>(g: &[R], x: &[R], out: &mut [R]) {
    for (o, column) in out.iter_mut().zip(g.chunks_exact(x.len().max(1))) {
        *o = inner(column, x);
    }
}

/// T_c per unit density.
pub(crate) fn energy<R: Real>(flow: &Flow<'_, R>) -> R {
    (inner(flow.stream, flow.normal) - inner(flow.potential, flow.tangential)) * R::HALF
}

/// `out = P`, the impulse of the circulatory flow by generalized coordinate, world directions.
pub(crate) fn impulse<R: Real>(c: &Configuration<'_, R>, flow: &Flow<'_, R>, out: &mut [R]) {
    impulse_of(c, flow.potential, flow.normal, out);
    to_world(c, R::one(), out);
}

/// Bᵀφ − Sᵀdn in link frames.
fn impulse_of<R: Real>(c: &Configuration<'_, R>, potential: &[R], normal: &[R], out: &mut [R]) {
    flux_moments(c, potential, out);
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let (mut linear, mut angular) = (Complex::default(), R::zero());
        for (x, n) in nodes.points().zip(part(normal, b.first, b.nodes)) {
            linear += complex(x.im, -x.re) * *n;
            angular -= dot(x, x) * R::HALF * *n;
        }
        let p = twist_of(out, link);
        put_three(out, link, p.linear - linear, p.angular - angular);
    }
}

/// Adds the direct derivatives of the cores' data by the poses: for weights `c` (on L') and `e` (on νL'') given per node of
/// boundary m by `weights(m, k)`, α = q (c L' + e ν L'') conj(turn_i), R = Re Σ q e iν L'.
fn add_core_gradient<R: Real>(
    c: &Configuration<'_, R>,
    scale: R,
    weights: impl Fn(&BoundaryRecord<R>, usize, Complex<R>) -> (R, Complex<R>),
    out: &mut [R],
) {
    for (i, b, strength) in cores(c) {
        let pose = c.pose(i);
        for (m, target, nodes) in c.each_boundary() {
            if m == i || (b.link.is_none() && target.link.is_none()) {
                continue;
            }
            let own = c.pose(m);
            let (turn, shift) = (pose.unturned(own.turn), own.origin - pose.origin);
            let (mut sum, mut about_target, mut about_core, mut spin) =
                (Complex::<R>::default(), R::zero(), R::zero(), R::zero());
            let values = targets(&nodes, own, pose).zip(normals(target, &nodes)).zip(nodes.points());
            for (k, ((z, n), x)) in values.enumerate() {
                let [_, d, dd] = core_flow(&b.core, z);
                let nu = turn * n;
                let (c, e) = weights(target, k, x);
                let alpha = (d * c + e * nu * dd) * pose.turn.conj() * strength;
                let arm = own.turned(x);
                sum += alpha;
                // Re(i α arm) = −Im(α arm)
                about_target -= (alpha * arm).im;
                about_core -= (alpha * (shift + arm)).im;
                spin -= strength * (e * nu * d).im;
            }
            let linear = complex(sum.re, -sum.im) * scale;
            add_three(c, m, linear, (about_target + spin) * scale, out);
            add_three(c, i, -linear, -(about_core + spin) * scale, out);
        }
    }
}

/// What the forces of circulation are formed from: a configuration, its factors, and the circulatory flow there.
pub(crate) struct Circulation<'s, 'a, R: Real> {
    pub c: &'s Configuration<'s, R>,
    pub system: &'s BoundarySystem<'a, R>,
    pub flow: &'s mut Flow<'a, R>,
    pub pairs: &'s mut PairScratch<'a, R>,
}

/// A motion of the links as these forces need it: three reals per link in world and in link directions, and its adjoint λ, Aᵀ λ = B v.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'s, R> {
    pub qd: &'s [R],
    pub in_links: &'s [R],
    pub adjoint: &'s [R],
}

impl<R: Real> Circulation<'_, '_, R> {
    /// Adds ∂T_c/∂q (scaled). One transposed solve, one pass over the pairs.
    pub(crate) fn add_energy_gradient(&mut self, scale: R, out: &mut [R]) {
        let Circulation { c, system, flow, pairs } = self;
        copy(flow.adjoint, flow.tangential);
        system.factors().solve_transposed(flow.adjoint);
        let adjoint = &*flow.adjoint;
        each_induced(c, flow.potential, flow.stream, pairs, |pair| {
            add_pose_gradient(&pair, c, part(adjoint, pair.first, pair.len), -R::HALF * scale, out);
        });
        multiply_transposed(system.regular, adjoint, flow.spare);
        let (spare, flow) = (&*flow.spare, &**flow);
        add_core_gradient(
            c,
            scale,
            |m, k, _| {
                let i = m.first + k;
                let c = (at(flow.normal, i) - at(spare, i)) * R::HALF;
                (c, complex(at(flow.stream, i), -at(flow.potential, i)) * R::HALF)
            },
            out,
        );
    }

    /// Adds −G q̇ (scaled): (G q̇)_a = γ (−v_y, v_x) + ∂_a(q̇·P) − dP_a/dt. `impulse` is scratch of three reals per link. Writes over
    /// A⁻ᵀ β. One solve, one pass.
    pub(crate) fn add_gyroscopic_force(&mut self, motion: Moving<'_, R>, impulse: &mut [R], scale: R, out: &mut [R]) {
        let Circulation { c, system, flow, pairs } = self;
        let Moving { qd, in_links, adjoint } = motion;
        self::impulse(c, flow, impulse);
        for (_, b, _) in c.each_boundary() {
            let Some(link) = b.link else { continue };
            let (u, p) = (twist_of(qd, link), twist_of(impulse, link));
            // γ J v, the turning of P, and −J P.
            let linear = perp(u.linear) * b.circulation - perp(p.linear) * u.angular;
            let angular = u.linear.im * p.linear.re - u.linear.re * p.linear.im;
            let sum = [linear.re, linear.im, angular];
            for (o, x) in part_mut(out, 3 * link, 3).iter_mut().zip(sum) {
                *o -= scale * x;
            }
        }
        // ∂_a(q̇·P): Im λᵀ dG w with w = φ + iΨ, and in the same pass the rate Im(ż D w) of φ's equation.
        let rate = &mut *flow.spare;
        rate.fill(R::zero());
        each_induced(c, flow.potential, flow.stream, pairs, |pair: Induced<'_, R>| {
            add_pose_gradient(&pair, c, part(adjoint, pair.first, pair.len), -scale, out);
            let rates = relative_rates(&pair, c, qd);
            for ((a, zd), (hx, hy)) in
                part_mut(rate, pair.first, pair.len).iter_mut().zip(rates).zip(pair.hx.iter().zip(pair.hy))
            {
                *a += zd.re * *hy + zd.im * *hx;
            }
        });
        multiply_transposed(system.regular, adjoint, flow.second);
        let second = &*flow.second;
        add_core_gradient(
            c,
            -scale,
            |m, k, x| {
                let e = match m.link {
                    Some(link) => {
                        let v = twist_of(in_links, link);
                        -(v.linear.re * x.im - v.linear.im * x.re - v.angular * dot(x, x) * R::HALF)
                    }
                    None => R::zero(),
                };
                (at(second, m.first + k), complex(e, R::zero()))
            },
            out,
        );
        // dP/dt beyond its turning: φ̇ and the rates of the cores' data.
        let (stream_rate, normal_rate) = (&mut *flow.second, &mut *flow.adjoint);
        data_rates(c, qd, stream_rate, normal_rate);
        for (column, x) in system.regular.chunks_exact(system.unknowns.max(1)).zip(&*stream_rate) {
            axpy(rate, *x, column);
        }
        system.factors().solve(rate);
        impulse_of(c, rate, normal_rate, impulse);
        to_world(c, scale, impulse);
        axpy(out, R::one(), impulse);
    }
}

/// Ψ̇ = Σ q Re(L' ż) and dṅ = Σ q Re(ν L'' ż + i (ω_m − ω_i) ν L').
fn data_rates<R: Real>(c: &Configuration<'_, R>, qd: &[R], stream: &mut [R], normal: &mut [R]) {
    stream.fill(R::zero());
    normal.fill(R::zero());
    for (i, b, strength) in cores(c) {
        for (m, target, nodes) in c.each_boundary() {
            if m == i {
                continue;
            }
            let (pose, own) = (c.pose(i), c.pose(m));
            let (turn, shift) = (pose.unturned(own.turn), own.origin - pose.origin);
            let (vm, vi) = (boundary_twist(c, qd, m), boundary_twist(c, qd, i));
            let values = nodes.points().zip(normals(target, &nodes));
            for (k, (x, n)) in values.enumerate() {
                let arm = own.turned(x);
                let [_, d, dd] = core_flow(&b.core, pose.unturned(shift + arm));
                let zd = pose.unturned(vm.at(arm) - vi.at(shift + arm));
                let nu = turn * n;
                let spin = nu * d * (vm.angular - vi.angular);
                add(stream, target.first + k, strength * (d * zd).re);
                add(normal, target.first + k, strength * ((nu * dd * zd).re - spin.im));
            }
        }
    }
}
