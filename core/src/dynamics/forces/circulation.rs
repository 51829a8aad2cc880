//! Circulation (section 3 of the paper, (3.5), (3.6)): the flow of constant circulations γ_i around links and
//! obstacles, its energy gradient and the force linear in the velocities (Kutta–Joukowski), both as exact derivatives of discrete
//! quantities.
//!
//! Core flow of boundary i in its frame: L(z) with Re L its stream function per 2π of strength, the boundary's isolated flow, 0 on
//! itself: log W about an ellipse, about other outlines that of a vortex sheet (`fluid/isolated.rs`); strengths q_i = γ_i/2π. On all nodes Ψ = Σ q_i Re L, its fluxes dn = Σ q_i Re(ν L') and
//! β = Σ q_i Re(iν L') with ν = n ds. The flow that cancels the cores' normal velocity solves A φ = Re(G) Ψ: one more
//! right-hand side of the same matrix. Energy T_c = ½ (Ψ·dn − φ·β), impulse P = Bᵀφ − Sᵀdn with
//! S = (y, −x, −|X|²/2). Everything here is per unit density of the fluid.
//!
//! Tested by `tests/circulation` (closed forms), `tests/gradients`, `tests/conservation`, `tests/near_contact`, `tests/errata`.

use crate::base::complex::{Complex, cabs, complex, csqrt, dot, perp};
use crate::base::memory::{add, at, axpy, buffers, copy, inner, part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::{
    Induced, PairScratch, add_pose_gradient, add_three, boundary_twist, each_induced, relative_rates,
};
use crate::fluid::isolated::{FlowAt, Sheet, write_sheet};
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
        /// θ − s of the isolated flows without closed form, each on its boundary's nodes.
        angle: R = *unknowns,
        /// θ′ h.
        sheet: R = *unknowns,
        /// θ′/Γ′.
        sheet_x: R = *unknowns,
        sheet_y: R = *unknowns,
    }
}

/// The flow about an ellipse at z (frame of its boundary).
pub(crate) fn ellipse_flow<R: Real>(core: &Core<R>, z: Complex<R>) -> FlowAt<R> {
    let z = z - core.centre;
    let one = complex(R::one(), R::zero());
    let [a, b] = core.axes;
    if a == b {
        let inverse = one / z;
        return FlowAt { stream: (cabs(z) / a).ln(), slope: inverse, velocity: inverse, bend: -inverse * inverse };
    }
    // √(z² − c²) on the branch ~ z outside the segment of the foci.
    let c2 = complex(a * a - b * b, R::zero());
    let root = z * csqrt(one - c2 / (z * z));
    let inverse = one / root;
    let (stream, bend) = ((cabs(z + root) / (a + b)).ln(), -z * inverse * inverse * inverse);
    FlowAt { stream, slope: inverse, velocity: inverse, bend }
}

/// The core flow of boundary i at other boundaries' nodes: z in its frame, at unknown `row`.
fn core_flow<R: Real>(sheet: &Sheet<'_, R>, z: Complex<R>, row: usize, stream: bool) -> FlowAt<R> {
    if sheet.record.slots.core_modes > 0 { sheet.at(z, row, stream) } else { ellipse_flow(&sheet.record.core, z) }
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

/// The same with their flows, of which [`solve`] left θ in `columns`: θ − s, θ′ h, θ′/Γ′.
fn sheets<'s, R: Real>(
    c: &'s Configuration<'s, R>,
    columns: [&'s [R]; 4],
) -> impl Iterator<Item = (usize, R, Sheet<'s, R>)> {
    let circulating = c.each_boundary().filter(|(_, b, _)| b.circulation != R::zero());
    circulating.map(move |(boundary, record, nodes)| {
        let [angle, density, x, y] = columns.map(|x| part(x, record.first, record.nodes));
        let sheet = Sheet { c, boundary, record, nodes, angle, density, velocity: [x, y] };
        (boundary, record.circulation / R::TAU, sheet)
    })
}

/// By what the fluxes through a boundary are measured: its own circulation, or that of all, less by as much as it is smaller than the
/// largest that carries some; what is small beside a large circulation may be all that a small body feels.
fn flux_sizes<R: Real>(c: &Configuration<'_, R>) -> impl Fn(&BoundaryRecord<R>) -> R + use<R> {
    let (mut total, mut reach) = (R::zero(), R::zero());
    for (_, b, _) in cores(c) {
        (total, reach) = (total + b.circulation.abs(), reach.max(b.reach));
    }
    move |b| b.circulation.abs().max(total * (b.reach / reach).min(R::one()))
}

/// Sets up the circulatory flow: Ψ, dn, β, φ. One solve. Returns the largest flux through a boundary, by its size, by which the two
/// approximations of one core's flow differ.
pub(crate) fn solve<R: Real>(c: &Configuration<'_, R>, system: &BoundarySystem<'_, R>, flow: &mut Flow<'_, R>) -> R {
    let (mut worst, size) = (R::zero(), flux_sizes(c));
    flow.stream.fill(R::zero());
    flow.normal.fill(R::zero());
    flow.tangential.fill(R::zero());
    for (i, b, nodes) in c.each_boundary().filter(|(_, b, _)| b.circulation != R::zero() && b.slots.core_modes > 0) {
        let columns = [&mut *flow.angle, &mut *flow.sheet, &mut *flow.sheet_x, &mut *flow.sheet_y];
        write_sheet(c, (i, b, nodes), columns.map(|x| part_mut(x, b.first, b.nodes)));
    }
    for (i, strength, sheet) in sheets(c, [flow.angle, flow.sheet, flow.sheet_x, flow.sheet_y]) {
        for (m, target, nodes) in c.each_boundary() {
            if m == i {
                // On itself the flow is exactly tangential: Ψ and β are 0.
                own_flux(&sheet, -strength, part_mut(flow.normal, target.first, target.nodes));
                continue;
            }
            let turn = c.pose(i).unturned(c.pose(m).turn);
            let mut difference = R::zero();
            let values = targets(&nodes, c.pose(m), c.pose(i)).zip(normals(target, &nodes));
            for (k, (z, n)) in values.enumerate() {
                let at = core_flow(&sheet, z, target.first + k, true);
                let slope = turn * n * at.velocity;
                add(flow.stream, target.first + k, strength * at.stream);
                add(flow.normal, target.first + k, strength * slope.re);
                add(flow.tangential, target.first + k, -strength * slope.im);
                difference += cabs(n * (at.slope - at.velocity));
            }
            worst = worst.max(difference * strength.abs() / size(target));
        }
    }
    multiply(system.regular, flow.stream, flow.potential);
    system.factors().solve(flow.potential);
    worst
}

/// Adds `scale` θ′ h on the flow's own boundary, of which dn is the negative per strength.
fn own_flux<R: Real>(sheet: &Sheet<'_, R>, scale: R, out: &mut [R]) {
    if sheet.record.slots.core_modes > 0 {
        axpy(out, scale, sheet.density);
        return;
    }
    let points = sheet.nodes.points().zip(normals(sheet.record, &sheet.nodes));
    for (o, (x, n)) in out.iter_mut().zip(points) {
        *o -= scale * (n * ellipse_flow(&sheet.record.core, x).velocity).re;
    }
}

/// How well the nodes resolve the cores' flows, relative to the circulations: their fluxes through every boundary, of which the
/// integral of dn is −γ of the cores inside and that of β is 0; ten times as much, since what follows from them was found up to
/// that much less exact about thin bodies; how much the tabulated stream functions vary on their own boundaries; and, once, the
/// difference that [`solve`] returned, found to be at least as large as the error of the gradient (and often far larger). O(N).
pub(crate) fn data_error<R: Real>(c: &Configuration<'_, R>, flow: &Flow<'_, R>, difference: R) -> R {
    let (size, all) = (flux_sizes(c), cores(c).fold(R::zero(), |sum, (_, b, _)| sum + b.circulation));
    let mut worst = cores(c).fold(R::zero(), |worst, (_, b, _)| worst.max(b.core.spread));
    for (_, b, _) in c.each_boundary() {
        let sum = |x: &[R]| part(x, b.first, b.nodes).iter().fold(R::zero(), |sum, x| sum + *x);
        let inside = if b.sign > R::zero() { -all } else { b.circulation };
        worst = worst.max((sum(flow.normal) + inside).abs().max(sum(flow.tangential).abs()) / size(b));
    }
    (worst * R::lit(10.0)).max(difference)
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
    columns: [&[R]; 4],
    scale: R,
    weights: impl Fn(&BoundaryRecord<R>, usize, Complex<R>) -> (R, Complex<R>),
    out: &mut [R],
) {
    for (i, strength, sheet) in sheets(c, columns) {
        let pose = c.pose(i);
        for (m, target, nodes) in c.each_boundary() {
            if m == i || (sheet.record.link.is_none() && target.link.is_none()) {
                continue;
            }
            let own = c.pose(m);
            let (turn, shift) = (pose.unturned(own.turn), own.origin - pose.origin);
            let (mut sum, mut about_target, mut about_core, mut spin) =
                (Complex::<R>::default(), R::zero(), R::zero(), R::zero());
            let values = targets(&nodes, own, pose).zip(normals(target, &nodes)).zip(nodes.points());
            for (k, ((z, n), x)) in values.enumerate() {
                let FlowAt { slope, velocity, bend, .. } = core_flow(&sheet, z, target.first + k, false);
                let nu = turn * n;
                let (c, e) = weights(target, k, x);
                let alpha = (slope * c + e * nu * bend) * pose.turn.conj() * strength;
                let arm = own.turned(x);
                sum += alpha;
                // Re(i α arm) = −Im(α arm)
                about_target -= (alpha * arm).im;
                about_core -= (alpha * (shift + arm)).im;
                spin -= strength * (e * nu * velocity).im;
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
            [flow.angle, flow.sheet, flow.sheet_x, flow.sheet_y],
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
        let columns = [&*flow.angle, &*flow.sheet, &*flow.sheet_x, &*flow.sheet_y];
        add_core_gradient(
            c,
            columns,
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
        data_rates(c, columns, qd, stream_rate, normal_rate);
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
fn data_rates<R: Real>(c: &Configuration<'_, R>, columns: [&[R]; 4], qd: &[R], stream: &mut [R], normal: &mut [R]) {
    stream.fill(R::zero());
    normal.fill(R::zero());
    for (i, strength, sheet) in sheets(c, columns) {
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
                let z = pose.unturned(shift + arm);
                let FlowAt { slope, velocity, bend, .. } = core_flow(&sheet, z, target.first + k, false);
                let zd = pose.unturned(vm.at(arm) - vi.at(shift + arm));
                let nu = turn * n;
                let spin = nu * velocity * (vm.angular - vi.angular);
                add(stream, target.first + k, strength * (slope * zd).re);
                add(normal, target.first + k, strength * ((nu * bend * zd).re - spin.im));
            }
        }
    }
}
