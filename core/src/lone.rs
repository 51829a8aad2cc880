//! A lone rigid body: its added mass and the impulse of its circulation are constant in its own frame, so they are
//! computed once and no boundary system is solved while stepping (Kirchhoff's equations).

use crate::articulation::twist_of;
use crate::boundary::{Block, BoundaryRecord, add_flank_terms, fill_self_block};
use crate::configuration::{Configuration, Poses, put_pose};
use crate::ldl;
use crate::lu::{Factors, factor};
use crate::model::Model;
use crate::near::Near;
use crate::scalar::{Complex, Real, cln, complex, dot};
use crate::se2::Pose;
use crate::status::{Result, Status};
use crate::work::{Counters, Work, configuration, lone_momentum};
use crate::workspace::{add, at, copy, part, part_mut, put, take};

impl<R: Real> Work<'_, R> {
    /// Accelerations of a lone body by Kirchhoff's equations, M (q̈ − J q̇) + J p + f = 0 with p = M q̇: what
    /// [`Work::evaluate`] gives, which fills every buffer.
    pub(crate) fn evaluate_lone(
        &mut self,
        model: &Model<'_, R>,
        p: &[R],
        dp: &[R],
        counters: &mut Counters,
    ) -> Result<()> {
        counters.evaluations += 1;
        for (to, from) in [(&mut *self.q, p), (&mut *self.s, p), (&mut *self.qd, dp), (&mut *self.ds, dp)] {
            copy(to, from);
        }
        if !self.q.iter().chain(self.qd.iter()).all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        let pose = Pose::new(at(p, 0), at(p, 1), at(p, 2));
        put_pose(self.poses, 0, &pose);
        let Some(link) = model.links.first() else { return Err(Status::Internal.into()) };
        let v = twist_of(dp, 0);
        let (one, zero) = (R::one(), R::zero());
        let c = configuration!(self, model);
        let momentum = |v: [R; 3]| {
            let mut momentum = [zero; 3];
            lone_momentum(&c, &v, &mut momentum);
            momentum
        };
        let columns = [[one, zero, zero], [zero, one, zero], [zero, zero, one]].map(momentum);
        let [px, py, _] = momentum([v.linear.re, v.linear.im, v.angular]);
        let [fx, fy, torque] = momentum([v.linear.im * v.angular, -v.linear.re * v.angular, zero]);
        let mut force = [fx - py * v.angular, fy + px * v.angular, torque + v.linear.re * py - v.linear.im * px];
        if model.head.plan.gravity || model.head.plan.circulation {
            self.outer_forces(model);
            for (f, outer) in force.iter_mut().zip(self.outer.iter()) {
                *f += *outer;
            }
        }
        for (k, (column, m)) in columns.iter().zip([link.mass, link.mass, link.inertia]).enumerate() {
            copy(part_mut(self.reduced, 3 * k, 3), column);
            add(self.reduced, 4 * k, m);
            put(self.reduced, 9 + k, -at(&force, k));
        }
        ldl::factor(part_mut(self.reduced, 0, 9), 3, self.reduced_pivots)?;
        self.solve_reduced(3);
        copy(self.dds, part(self.reduced, 9, 3));
        copy(self.indicators, &[model.head.lone_resolution[0], R::zero()]);
        if self.dds.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Status::NonFiniteState.into()) }
    }
}

/// Reals of scratch for `n` nodes.
pub(crate) fn scratch_len(n: usize, circulation: bool) -> Result<usize> {
    let blocks = if circulation { 2 } else { 1 };
    n.checked_mul(n)
        .and_then(|b| b.checked_mul(blocks))
        .and_then(|b| b.checked_add(5 * n))
        .ok_or(Status::SizeOverflow.into())
}

/// Added mass (3 × 3, column-major, symmetrized) and circulation impulse, both per unit density and in the body's frame;
/// and two error indicators: asymmetry of the mass before, relative to its largest entry (rotation: over the body's reach),
/// and error of the constant density.
pub(crate) fn constants<R: Real>(
    body: &BoundaryRecord<R>,
    store: &[R],
    scratch: &mut [R],
    circulation: bool,
) -> Result<([R; 9], [R; 3], [R; 2])> {
    let n = body.nodes;
    let nodes = body.nodes(store);
    let h = nodes.step;
    let mut rest = scratch;
    let system = take(&mut rest, n * n + 4 * n)?;
    let pivots = take(&mut rest, n)?;
    let regular = if circulation { take(&mut rest, n * n)? } else { &mut [] };
    let (block, columns) = system.split_at_mut_checked(n * n).ok_or(Status::Internal)?;
    let source = body.source(store);
    let (mut a, mut g) = (Block { data: &mut *block, ld: n, at: 0 }, Block { data: &mut *regular, ld: n, at: 0 });
    fill_self_block(&source.nodes, body.sign, R::zero(), &mut a, &mut g);
    add_flank_terms(&source, body.sign, &mut a, &mut g);
    let potential = |k: usize| [at(nodes.x, k), at(nodes.y, k), at(nodes.chi, k)];
    // The circulatory flow: on an ellipse or disc its stream function is constant and its potential 0.
    let point = circulation && body.core.axes[0] == R::zero();
    for k in 0..n {
        for (c, x) in potential(k).into_iter().enumerate() {
            put(columns, c * n + k, -R::TWO * x);
        }
        let mut sum = R::zero();
        if point {
            for (j, x) in nodes.points().enumerate() {
                sum += at(regular, j * n + k) * cln(x - body.core.centre).re;
            }
        }
        put(columns, 3 * n + k, sum * body.circulation / R::TAU);
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
            if let Some(p) = impulse.get_mut(row) {
                *p += b * at(columns, 3 * n + k);
            }
        }
        if circulation {
            let [_, slope, _] = crate::forces::circulation::core_flow(&body.core, x);
            // dn = q Re(ν L'), ν = i h Γ'
            let nu: Complex<R> = complex(-d.im, d.re) * h;
            let normal = strength * (nu * slope).re;
            for (p, s) in impulse.iter_mut().zip([x.im, -x.re, -dot(x, x) * R::HALF]) {
                *p -= s * normal;
            }
        }
    }
    // The constant density solves A 1 = 2; a column that is no longer needed serves.
    let constant = part_mut(columns, 0, n);
    constant.fill(R::TWO);
    Factors { lu, ld: n, pivots }.solve(constant);
    let quadrature = constant.iter().fold(R::zero(), |m, x| m.max((*x - R::one()).abs()));
    let [a, b, c, d, e, f, g, i, j] = mass;
    let (bd, cg, fi) = ((b + d) * R::HALF, (c + g) * R::HALF, (f + i) * R::HALF);
    let size = (a.abs().max(e.abs())).max(j.abs() / (body.reach * body.reach));
    let difference = (b - d).abs().max((c - g).abs() / body.reach).max((f - i).abs() / body.reach);
    let asymmetry = if size > R::zero() { difference / size } else { R::zero() };
    Ok(([a, bd, cg, bd, e, fi, cg, fi, j], impulse, [asymmetry, quadrature]))
}
