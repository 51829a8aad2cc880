//! A lone rigid body: its added mass and the impulse of its circulation are constant in its own frame, so they are
//! computed once and no boundary system is solved while stepping (Kirchhoff's equations; docs/physics.md, section 9). O(1) a step.
//!
//! Tested by `tests/articulated.rs:shortcut_for_a_lone_body_agrees_with_the_general_path`, `tests/circulation`,
//! `tests/reference_values`.

use crate::base::complex::{Complex, cis, complex, dot, perp};
use crate::base::memory::{add, at, axpy, copy, part_mut, put, take, take_as};
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::dynamics::evaluation::{Counters, Evaluation, Indicators};
use crate::dynamics::forces::circulation::ellipse_flow;
use crate::dynamics::indicators::of_motions;
use crate::fluid::configuration::Configuration;
use crate::fluid::isolated::own_density;
use crate::fluid::near::preimage::Source;
use crate::fluid::self_block::{Block, add_flank_terms, fill_self_block};
use crate::geometry::pose::{Pose, Twist, put_pose, put_three, twist_of};
use crate::linear::ldl;
use crate::linear::lu::{Factors, factor};
use crate::model::boundary::BoundaryRecord;
use crate::model::{LinkRecord, Model};

impl<R: Real> Evaluation<'_, R> {
    /// Accelerations of a lone body by Kirchhoff's equations, M (q̈ − J q̇) + J p + f = 0 with p = M q̇, in its own frame, where
    /// M and its inverse are constant: what [`Evaluation::evaluate`] gives, which fills every buffer.
    pub(crate) fn evaluate_lone(
        &mut self,
        model: &Model<'_, R>,
        p: &[R],
        dp: &[R],
        counters: &mut Counters,
    ) -> Result<[R; 3]> {
        counters.evaluations += 1;
        self.kept.shown = false;
        let (&[x, y, heading], &[dx, dy, spin]) = (p, dp) else { return Err(Status::Internal.into()) };
        if ![x, y, heading, dx, dy, spin].iter().all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        let (head, turn) = (model.head, cis(heading));
        if head.lone_inverse.iter().any(|x| !x.is_finite()) {
            return Err(Error::new(Status::Singular).at(Place::Link(0, 0)));
        }
        let mut outer = Twist::default();
        if head.plan.gravity || head.plan.circulation {
            copy(self.velocity.qd, dp);
            put_pose(self.placement.poses, 0, &Pose { origin: complex(x, y), turn });
            self.outer_forces(model);
            outer = twist_of(self.forces.outer, 0);
        }
        let linear = turn.conj() * complex(dx, dy);
        let momentum = times(&head.lone_added_mass, &Twist { linear, angular: spin });
        let turning = Twist { linear: -perp(linear) * spin, angular: R::zero() };
        let inertial = times(&head.lone_added_mass, &turning);
        let force = inertial.linear + perp(momentum.linear) * spin;
        let torque = inertial.angular + dot(perp(linear), momentum.linear);
        let force = Twist {
            linear: -(force * head.fluid_density + turn.conj() * outer.linear),
            angular: -(torque * head.fluid_density + outer.angular),
        };
        let acceleration = times(&head.lone_inverse, &force);
        let linear = turn * acceleration.linear;
        self.kept.indicators = Indicators { mass: head.lone_resolution[0], ..Indicators::default() };
        let found = [linear.re, linear.im, acceleration.angular];
        if found.iter().all(|x| x.is_finite()) { Ok(found) } else { Err(Status::NonFiniteState.into()) }
    }
}

/// A symmetric 3 × 3 matrix times a velocity or a force, both in the body's frame.
#[inline]
pub(crate) fn times<R: Real>(matrix: &[R; 9], v: &Twist<R>) -> Twist<R> {
    let &[a, b, c, d, e, f, g, h, i] = matrix;
    let (x, y, w) = (v.linear.re, v.linear.im, v.angular);
    Twist { linear: complex(a * x + d * y + g * w, b * x + e * y + h * w), angular: c * x + f * y + i * w }
}

/// The inverse of the mass matrix of body and fluid in the body's frame; NaN if it is singular.
pub(crate) fn inverse_mass<R: Real>(added: &[R; 9], density: R, link: &LinkRecord<R>) -> [R; 9] {
    let (mut mass, mut pivots, mut inverse) = (added.map(|m| m * density), [R::zero(); 3], [R::zero(); 9]);
    for (k, m) in [link.mass, link.mass, link.inertia].into_iter().enumerate() {
        add(&mut mass, 4 * k, m);
    }
    if ldl::factor(&mut mass, 3, &mut pivots).is_err() {
        return [R::NAN; 9];
    }
    for (k, column) in inverse.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        put(column, k, R::one());
        ldl::solve(&mass, 3, &pivots, column);
    }
    inverse
}

/// Reals of scratch for `n` nodes; twice the matrix where the potential of rotation inside is not known.
pub(crate) fn scratch_len(n: usize, inside: bool) -> Result<usize> {
    let matrices = n.checked_mul(n).and_then(|b| b.checked_mul(if inside { 1 } else { 2 }));
    matrices.and_then(|b| b.checked_add(4 * n)).ok_or(Status::SizeOverflow.into())
}

/// Added mass (3 × 3, column-major, symmetrized) and circulation impulse, both per unit density and in the body's frame;
/// and two error indicators: asymmetry of the mass before, relative to its largest entry (rotation: over the body's reach),
/// and error of the constant density. Where χ₃ is not known, ψ₃ is found from its stream function −|X|²/2:
/// (I + Im W/π) ψ₃ = Re W/π |X|²/2.
pub(crate) fn constants<R: Real>(
    body: &BoundaryRecord<R>,
    store: &[R],
    scratch: &mut [R],
    circulation: bool,
) -> Result<([R; 9], [R; 3], [R; 2])> {
    let n = body.nodes;
    let nodes = body.nodes(store);
    let h = nodes.step;
    let inside = body.knows_rotation(store);
    let mut rest = scratch;
    let system = take(&mut rest, n * n + 3 * n)?;
    let pivots = take_as(&mut rest, n)?;
    let regular = take(&mut rest, if inside { 0 } else { n * n })?;
    let (block, columns) = system.split_at_mut_checked(n * n).ok_or(Status::Internal)?;
    let source = Source::of(body, store);
    let (mut a, mut g) = (Block { data: &mut *block, ld: n, at: 0 }, Block { data: &mut *regular, ld: n, at: 0 });
    fill_self_block(&source.nodes, body.sign, R::zero(), &mut a, &mut g);
    add_flank_terms(&source, body.sign, &mut a, &mut g);
    let potential = |k: usize| [at(nodes.x, k), at(nodes.y, k), if inside { at(nodes.chi, k) } else { R::zero() }];
    for k in 0..n {
        for (c, x) in potential(k).into_iter().enumerate() {
            put(columns, c * n + k, -R::TWO * x);
        }
    }
    for (column, x) in regular.chunks_exact(n.max(1)).zip(nodes.points()) {
        axpy(part_mut(columns, 2 * n, n), -dot(x, x) * R::HALF, column);
    }
    factor(system, n, n, pivots)?;
    let (lu, columns) = system.split_at_mut_checked(n * n).ok_or(Status::Internal)?;
    for column in columns.chunks_exact_mut(n.max(1)) {
        Factors { lu, ld: n, pivots }.back_substitute(column);
    }
    let (mut mass, mut impulse) = ([R::zero(); 9], [R::zero(); 3]);
    let strength = body.circulation / R::TAU;
    for (k, (x, d)) in nodes.points().zip(nodes.tangents()).enumerate() {
        let flux = [-d.im * h, d.re * h, dot(x, d) * h];
        let chi = potential(k);
        for (row, b) in flux.into_iter().enumerate() {
            for (column, chi) in chi.into_iter().enumerate() {
                let psi = at(columns, column * n + k) + chi;
                if let Some(m) = mass.get_mut(3 * column + row) {
                    *m += b * psi;
                }
            }
        }
        if circulation {
            // The isolated flow alone: its stream function is constant on the outline, its potential 0.
            let normal = if body.slots.core_modes > 0 {
                -strength * own_density(body, store, k, h)
            } else {
                // dn = q Re(ν L'), ν = i h Γ'
                let nu: Complex<R> = complex(-d.im, d.re) * h;
                strength * (nu * ellipse_flow(&body.core, x).velocity).re
            };
            for (p, s) in impulse.iter_mut().zip([x.im, -x.re, -dot(x, x) * R::HALF]) {
                *p -= s * normal;
            }
        }
    }
    // The constant density solves A 1 = 2; a column that is no longer needed serves.
    let constant = part_mut(columns, 0, n);
    constant.fill(R::TWO);
    Factors { lu, ld: n, pivots }.solve(constant);
    let quadrature = of_motions(constant);
    let [a, b, c, d, e, f, g, i, j] = mass;
    let (bd, cg, fi) = ((b + d) * R::HALF, (c + g) * R::HALF, (f + i) * R::HALF);
    let size = (a.abs().max(e.abs())).max(j.abs() / (body.reach * body.reach));
    let difference = (b - d).abs().max((c - g).abs() / body.reach).max((f - i).abs() / body.reach);
    let asymmetry = if size > R::zero() { difference / size } else { R::zero() };
    Ok(([a, bd, cg, bd, e, fi, cg, fi, j], impulse, [asymmetry, quadrature]))
}

/// Fluid momentum of a lone body with velocity `v` (three reals, world): its constant added mass, turned.
pub(crate) fn lone_momentum<R: Real>(c: &Configuration<'_, R>, v: &[R], out: &mut [R]) {
    let (turn, density) = (c.pose(0), c.model.head.fluid_density);
    let v = twist_of(v, 0);
    let own = Twist { linear: turn.unturned(v.linear), ..v };
    let momentum = times(&c.model.head.lone_added_mass, &own);
    put_three(out, 0, turn.turned(momentum.linear) * density, momentum.angular * density);
}

/// −G q̇ of a lone body: its circulation impulse turns with it.
pub(crate) fn add_lone_circulation<R: Real>(c: &Configuration<'_, R>, qd: &[R], force: &mut [R]) {
    let Some((body, _)) = c.boundary(0) else { return };
    let [px, py, _] = c.model.head.lone_impulse;
    let p = c.pose(0).turned(complex(px, py));
    let v = twist_of(qd, 0);
    let linear = perp(v.linear) * body.circulation - perp(p) * v.angular;
    let angular = v.linear.im * p.re - v.linear.re * p.im;
    let f = twist_of(force, 0);
    let density = c.model.head.fluid_density;
    put_three(force, 0, f.linear - linear * density, f.angular - angular * density);
}
