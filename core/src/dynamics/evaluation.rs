//! Scratch and results of one evaluation, and its linear part: placement, boundary system, reduced mass, momentum.

use crate::base::memory::{at, axpy, buffers, copy, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::articulation::{jacobian_column, place_links, set_coordinates, velocities};
use crate::fluid::configuration::Configuration;
use crate::fluid::near::buffers::{COLUMNS, LADDER_LIST, Near, NearMut, PREIMAGES};
use crate::fluid::potentials::{
    add_interior_potential, add_potential_moments, fill_flux, flux_moments, to_link_frames, to_world,
};
use crate::fluid::system::{BoundarySystem, column_momenta, solve_columns};
use crate::geometry::pose::Twist;
use crate::geometry::pose::put_three;
use crate::geometry::pose::twist_of;
use crate::geometry::pose::{Poses, put_pose};
use crate::linear::ldl;
use crate::model::{Control, Formulation, Model, ModelHead, NearDims};

/// Numbers that the buffers' lengths follow from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dims {
    pub links: usize,
    pub boundaries: usize,
    pub coordinates: usize,
    pub free: usize,
    /// Unknowns of the boundary system while stepping (0: none).
    pub unknowns: usize,
    pub ld: usize,
    pub columns: usize,
    /// Unknowns if there is circulation, else 0.
    pub circulating: usize,
    /// Driven channels.
    pub channels: usize,
    /// What near contact needs; 0 where it needs nothing.
    pub near: NearDims,
}

impl Dims {
    pub(crate) fn of<R: Real>(head: &ModelHead<R>, coordinates: usize) -> Dims {
        let p = &head.plan;
        Dims {
            links: p.links,
            boundaries: p.links + p.walls,
            coordinates,
            free: p.free_coordinates,
            unknowns: p.unknowns,
            ld: leading(p.unknowns),
            columns: p.free_coordinates + usize::from(head.prescribed_moves),
            circulating: if p.circulation { p.unknowns } else { 0 },
            channels: head.channels,
            near: head.near,
        }
    }
}

/// Leading dimension of the boundary system: an odd multiple of a cache line keeps columns from falling on the same lines,
/// and each begins where a line begins if the first does.
pub(crate) fn leading(unknowns: usize) -> usize {
    if unknowns == 0 { 0 } else { (unknowns.div_ceil(8) | 1) * 8 }
}

/// Reals by which the matrix may be moved to begin with a cache line, where vectors are that long.
fn slack<R>(unknowns: usize) -> usize {
    if unknowns > 0 && cfg!(target_arch = "x86_64") { LINE / size_of::<R>() } else { 0 }
}

/// Bytes of a cache line.
const LINE: usize = 64;

buffers! {
    /// Scratch and results of one evaluation.
    pub(crate) struct Work(d: Dims) {
        q: 3 * d.links,
        qd: 3 * d.links,
        qdd: 3 * d.links,
        poses: 4 * d.boundaries,
        channels: d.channels * crate::model::signal::CHANNEL_LEN,
        s: d.coordinates,
        ds: d.coordinates,
        dds: d.coordinates,
        generalized: d.coordinates,
        jacobian: 3 * d.links * d.columns,
        moving: 3 * d.links * d.columns,
        momenta: 3 * d.links * d.columns,
        reduced: d.free * (d.free + 1),
        reduced_pivots: d.free,
        drift: 3 * d.links,
        v: 3 * d.links,
        inertial: 3 * d.links,
        momentum: 3 * d.links,
        gradient: 3 * d.links,
        force: 3 * d.links,
        outer: 3 * d.links,
        spare: 3 * d.links,
        indicators: 4,
        /// Where in its memory the matrix begins.
        matrix_at: 1,
        walls_ready: 1,
        matrix: d.ld * (d.unknowns + d.columns) + slack::<R>(d.unknowns),
        pivots: d.unknowns,
        regular: d.circulating * d.circulating,
        density: d.unknowns,
        adjoint: d.unknowns,
        rate: d.unknowns,
        transposed: d.unknowns,
        solution: d.unknowns,
        second: d.unknowns,
        zx: d.unknowns,
        zy: d.unknowns,
        hx: d.unknowns,
        hy: d.unknowns,
        fx: d.unknowns,
        fy: d.unknowns,
        stream: d.circulating,
        normal: d.circulating,
        tangential: d.circulating,
        potential: d.circulating,
        circulation_adjoint: d.circulating,
        circulation_spare: d.circulating,
        circulation_second: d.circulating,
        near_nodes: COLUMNS * d.near.nodes,
        near_rungs: d.near.rungs,
        near_ladders: if d.near.nodes > 0 { LADDER_LIST * d.boundaries } else { 0 },
        near_preimages: if d.near.nodes > 0 { PREIMAGES * d.boundaries * d.unknowns } else { 0 },
    }
}

/// The bundles that the lower modules take, borrowed from a `Work`.
macro_rules! system {
    ($w:expr) => {
        BoundarySystem {
            matrix: crate::dynamics::evaluation::from($w.matrix, $w.matrix_at),
            ld: crate::dynamics::evaluation::leading($w.pivots.len()),
            unknowns: $w.pivots.len(),
            pivots: $w.pivots,
            regular: $w.regular,
            walls_ready: $w.walls_ready,
        }
    };
}
macro_rules! flow {
    ($w:expr) => {
        circulation::Flow {
            stream: $w.stream,
            normal: $w.normal,
            tangential: $w.tangential,
            potential: $w.potential,
            adjoint: $w.circulation_adjoint,
            spare: $w.circulation_spare,
            second: $w.circulation_second,
        }
    };
}
macro_rules! scratch {
    ($w:expr) => {
        PairScratch { zx: $w.zx, zy: $w.zy, hx: $w.hx, hy: $w.hy, fx: $w.fx, fy: $w.fy }
    };
}
/// What an evaluation sees of the scene where it was placed.
macro_rules! configuration {
    ($w:expr, $model:expr) => {
        Configuration {
            model: *$model,
            poses: Poses($w.poses),
            near: Near {
                nodes: $w.near_nodes,
                rungs: $w.near_rungs,
                ladders: $w.near_ladders,
                preimages: $w.near_preimages,
                unknowns: $w.density.len(),
            },
        }
    };
}
pub(crate) use {configuration, flow, scratch, system};

/// The matrix in its memory.
pub(crate) fn from<'a, R: Real>(memory: &'a mut [R], at: &[R]) -> &'a mut [R] {
    let at = crate::base::memory::at(at, 0).to_f64() as usize;
    memory.get_mut(at..).unwrap_or(&mut [])
}

/// Counts that a simulation keeps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counters {
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
    /// Factorizations of the boundary system.
    pub factorizations: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
}

impl<R: Real> Work<'_, R> {
    /// Places everything at (t, p, ṗ): coordinates, poses, velocities. Refuses contact and non-finite states.
    pub(crate) fn place(&mut self, model: &Model<'_, R>, t: R, p: &[R], dp: &[R]) -> Result<()> {
        set_coordinates(model, t, p, dp, self.channels, self.s, self.ds, self.dds);
        place_links(model, self.s, self.q, self.poses);
        velocities(model, self.s, self.ds, self.poses, self.qd);
        if !self.q.iter().chain(self.qd.iter()).all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        match crate::fluid::contact::first_contact(model, Poses(self.poses)) {
            Some((a, b, gap)) => Err(Error::new(Status::Contact).at(a).with(b).of("gap", gap.to_f64())),
            None => Ok(()),
        }
    }

    /// Ladders, nodes and preimages where the scene was placed last.
    pub(crate) fn grade(&mut self, model: &Model<'_, R>) -> Result<()> {
        let mut near = NearMut {
            nodes: self.near_nodes,
            rungs: self.near_rungs,
            ladders: self.near_ladders,
            preimages: self.near_preimages,
            unknowns: self.pivots.len(),
        };
        crate::fluid::near::prepare(&mut near, model, Poses(self.poses))
    }

    /// Writes the walls' poses, once.
    pub(crate) fn place_walls(&mut self, model: &Model<'_, R>) {
        for (i, b) in model.boundaries.iter().enumerate().filter(|(_, b)| b.link.is_none()) {
            put_pose(self.poses, i, &b.pose);
        }
    }

    /// Jacobian columns of the free coordinates and, if prescribed coordinates move, the motion they alone make.
    pub(crate) fn fill_jacobian(&mut self, model: &Model<'_, R>) {
        let rows = 3 * model.links.len();
        let unit = &mut *self.generalized;
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            jacobian_column(model, i, self.s, self.poses, unit, part_mut(self.jacobian, c.free * rows, rows));
        }
        if model.head.prescribed_moves {
            for ((u, ds), c) in unit.iter_mut().zip(self.ds.iter()).zip(model.coordinates) {
                *u = if c.control == Control::Prescribed { *ds } else { R::zero() };
            }
            let at = model.head.plan.free_coordinates * rows;
            velocities(model, self.s, unit, self.poses, part_mut(self.jacobian, at, rows));
        }
    }

    /// Solves the boundary system for the columns and forms their momenta (world directions, with density), M_h C.
    pub(crate) fn solve_fluid(&mut self, model: &Model<'_, R>, counters: &mut Counters) -> Result<()> {
        let rows = 3 * model.links.len();
        let density = model.head.fluid_density;
        self.momenta.fill(R::zero());
        if model.head.plan.formulation == Formulation::Kirchhoff {
            for (c, k) in self.jacobian.chunks_exact(rows.max(1)).zip(self.momenta.chunks_exact_mut(rows.max(1))) {
                lone_momentum(&configuration!(self, model), c, k);
            }
            return Ok(());
        }
        if model.head.plan.unknowns == 0 {
            return Ok(());
        }
        let c = &configuration!(self, model);
        for (v, m) in self.jacobian.chunks_exact(rows.max(1)).zip(self.moving.chunks_exact_mut(rows.max(1))) {
            to_link_frames(c, v, m);
        }
        counters.factorizations += 1;
        // Kept as a number, so that memory that is moved later keeps its meaning.
        if at(self.walls_ready, 0) == R::zero() {
            let to_line = self.matrix.as_ptr().align_offset(LINE);
            let fits = to_line <= slack::<R>(self.pivots.len());
            put(self.matrix_at, 0, R::count(if fits { to_line } else { 0 }));
        }
        let mut system = system!(self);
        solve_columns(&mut system, c, self.moving, self.zx, self.zy)?;
        column_momenta(&system, c, self.moving, self.hx, self.hy, self.fx, self.momenta);
        for p in self.momenta.chunks_exact_mut(rows.max(1)) {
            to_world(c, density, p);
        }
        Ok(())
    }

    /// Reduced mass matrix N_pᵀ M N_p, factorized.
    pub(crate) fn reduce_mass(&mut self, model: &Model<'_, R>) -> Result<()> {
        let (n, rows) = (model.head.plan.free_coordinates, 3 * model.links.len());
        let mut asymmetry = R::zero();
        // What does not move adds nothing: of each column the first row that moves and how many follow.
        for (column, (first, count)) in
            self.jacobian.chunks_exact(rows.max(1)).zip(self.drift.iter_mut().zip(self.inertial.iter_mut()))
        {
            let begin = column.iter().position(|x| *x != R::zero()).unwrap_or(0);
            let end = column.iter().rposition(|x| *x != R::zero()).map_or(begin, |last| last + 1);
            (*first, *count) = (R::count(begin), R::count(end - begin));
        }
        let (first, count) = (&*self.drift, &*self.inertial);
        let moves = |k: usize| (at(first, k).to_f64() as usize, at(count, k).to_f64() as usize);
        let product = |column: &[R], (first, count): (usize, usize), momentum: &[R]| {
            let pairs = part(column, first, count).iter().zip(part(momentum, first, count));
            pairs.fold(R::zero(), |s, (x, y)| s + *x * *y)
        };
        for k in 0..n {
            let (column, momentum) = (part(self.jacobian, k * rows, rows), part(self.momenta, k * rows, rows));
            let own = moves(k);
            copy(self.spare, column);
            for (p, l) in self.spare.as_chunks_mut::<3>().0.iter_mut().zip(model.links) {
                for (p, m) in p.iter_mut().zip([l.mass, l.mass, l.inertia]) {
                    *p *= m;
                }
            }
            // The diagonal first: the asymmetry of the others is measured by it.
            for j in (0..=k).rev() {
                let other = part(self.jacobian, j * rows, rows);
                let moved = moves(j);
                let halves =
                    [product(other, moved, momentum), product(column, own, part(self.momenta, j * rows, rows))];
                let common = own.0 < moved.0 + moved.1 && moved.0 < own.0 + own.1;
                let bodies = if common { product(other, moved, self.spare) } else { R::zero() };
                let sum = (halves[0] + halves[1]) * R::HALF + bodies;
                put(self.reduced, k * n + j, sum);
                put(self.reduced, j * n + k, sum);
                if j == k {
                    put(self.reduced_pivots, k, if sum > R::zero() { R::one() / sum.sqrt() } else { R::zero() });
                }
                let scale = at(self.reduced_pivots, k) * at(self.reduced_pivots, j);
                asymmetry = asymmetry.max((halves[0] - halves[1]).abs() * scale);
            }
        }
        put(self.indicators, 0, asymmetry.max(model.head.lone_resolution[0]));
        ldl::factor(part_mut(self.reduced, 0, n * n), n, self.reduced_pivots)
    }

    /// Solves the reduced system in place: the right-hand side is in the last column of `reduced`.
    pub(crate) fn solve_reduced(&mut self, n: usize) {
        let Some((lu, rhs)) = self.reduced.split_at_mut_checked(n * n) else { return };
        ldl::solve(lu, n, self.reduced_pivots, part_mut(rhs, 0, n));
    }

    /// The density of the motion `qd` itself, its adjoint, and its momentum (symmetrized, world directions, with density).
    /// `combined`: `qd` is the motion of the coordinates, whose density is a combination of the solved columns; otherwise
    /// it costs a solve.
    pub(crate) fn solve_motion(&mut self, model: &Model<'_, R>, combined: bool) {
        let rows = 3 * model.links.len();
        if model.head.plan.formulation == Formulation::Kirchhoff {
            lone_momentum(&configuration!(self, model), self.qd, self.momentum);
            return;
        }
        if model.head.plan.unknowns == 0 {
            self.momentum.fill(R::zero());
            return;
        }
        let c = &configuration!(self, model);
        to_link_frames(c, self.qd, self.v);
        let mut system = system!(self);
        if combined {
            let free = model.head.plan.free_coordinates;
            let rates = model.coordinates.iter().zip(self.ds.iter()).filter(|(c, _)| c.control != Control::Prescribed);
            let last = core::iter::repeat_n(R::one(), (self.jacobian.len() / rows.max(1)).saturating_sub(free));
            let rates = rates.map(|(_, ds)| *ds).chain(last);
            system.combine(rates.clone(), self.density);
            self.spare.fill(R::zero());
            for (rate, momentum) in rates.zip(self.momenta.chunks_exact(rows.max(1))) {
                axpy(self.spare, rate, momentum);
            }
        } else {
            self.density.fill(R::zero());
            add_interior_potential(c, self.v, -R::TWO, self.density);
            system.factors().solve(self.density);
            copy(self.solution, self.density);
            add_interior_potential(c, self.v, R::one(), self.solution);
            flux_moments(c, self.solution, self.spare);
            to_world(c, model.head.fluid_density, self.spare);
        }
        fill_flux(c, self.v, self.adjoint);
        // ½ Xᵀ B v now, −Xᵀ λ after the solve: M_hᵀ v = Xᵀ (B v − 2 λ).
        self.momentum.fill(R::zero());
        add_potential_moments(c, self.adjoint, R::HALF, self.momentum);
        system.factors().solve_transposed(self.adjoint);
        add_potential_moments(c, self.adjoint, -R::one(), self.momentum);
        to_world(c, model.head.fluid_density, self.momentum);
        axpy(self.momentum, R::HALF, self.spare);
    }
}

/// Fluid momentum of a lone body with velocity `v` (three reals, world): its constant added mass, turned.
pub(crate) fn lone_momentum<R: Real>(c: &Configuration<'_, R>, v: &[R], out: &mut [R]) {
    let (turn, density) = (c.pose(0), c.model.head.fluid_density);
    let v = twist_of(v, 0);
    let own = Twist { linear: turn.unturned(v.linear), ..v };
    let momentum = crate::dynamics::kirchhoff::times(&c.model.head.lone_added_mass, &own);
    put_three(out, 0, turn.turned(momentum.linear) * density, momentum.angular * density);
}
