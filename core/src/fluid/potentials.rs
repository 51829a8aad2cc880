//! Elementary potentials in density form, and the small vectors that surround them.
//!
//! Per link and per unit density of the fluid, in the link's frame: X = (x, y, χ₃) are the potentials of rigid motion
//! inside, B = h (−y', x', x x' + y y') the fluxes b ds. A u = −2 X v gives the density of the motion v, and
//! ψ = u + X v its potential on the boundary. The added mass is Bᵀ ψ; its transpose costs no further solve of
//! its own: M_hᵀ v = Xᵀ (B v − 2 λ) with Aᵀ λ = B v.

use crate::base::complex::{Complex, complex, dot};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{at, axpy, inner, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::dynamics::articulation::{put_three, twist_of};
use crate::fluid::assembly::assemble;
use crate::fluid::configuration::Configuration;
use crate::geometry::pose::Twist;
use crate::linear::lu::{Factors, factor, factor_further};
use crate::model::boundary::Nodes;

/// Three reals per link, world to link frame (linear parts turned).
pub(crate) fn to_link_frames<R: Real>(c: &Configuration<'_, R>, world: &[R], out: &mut [R]) {
    for i in 0..c.model.links.len() {
        let v = twist_of(world, i);
        put_three(out, i, c.pose(c.model.head.plan.walls + i).unturned(v.linear), v.angular);
    }
}

/// Three reals per link, link frame to world, in place, scaled.
pub(crate) fn to_world<R: Real>(c: &Configuration<'_, R>, scale: R, vector: &mut [R]) {
    for i in 0..c.model.links.len() {
        let v = twist_of(vector, i);
        put_three(vector, i, c.pose(c.model.head.plan.walls + i).turned(v.linear) * scale, v.angular * scale);
    }
}

fn potential<'a, R: Real>(nodes: &'a Nodes<'a, R>, v: Twist<R>) -> impl Iterator<Item = R> + 'a {
    nodes
        .x
        .iter()
        .zip(nodes.y)
        .zip(nodes.chi)
        .map(move |((x, y), chi)| v.linear.re * *x + v.linear.im * *y + v.angular * *chi)
}

/// Normal velocity times ds of a rigid motion given in the boundary's frame.
fn flux<'a, R: Real>(nodes: &'a Nodes<'a, R>, v: Twist<R>) -> impl Iterator<Item = R> + 'a {
    let h = nodes.step;
    nodes
        .points()
        .zip(nodes.tangents())
        .map(move |(x, d)| h * (v.linear.im * d.re - v.linear.re * d.im + v.angular * dot(x, d)))
}

/// `out += scale · X v` on the links' nodes (v in link frames).
pub(crate) fn add_interior_potential<R: Real>(c: &Configuration<'_, R>, v: &[R], scale: R, out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        if let Some(link) = b.link {
            for (o, x) in part_mut(out, b.first, b.nodes).iter_mut().zip(potential(&nodes, twist_of(v, link))) {
                *o += scale * x;
            }
        }
    }
}

/// `out = B v` on the links' nodes, 0 on walls.
pub(crate) fn fill_flux<R: Real>(c: &Configuration<'_, R>, v: &[R], out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let out = part_mut(out, b.first, b.nodes);
        match b.link {
            Some(link) => {
                for (o, f) in out.iter_mut().zip(flux(&nodes, twist_of(v, link))) {
                    *o = f;
                }
            }
            None => out.fill(R::zero()),
        }
    }
}

/// `out = Bᵀ f`: three reals per link, link frames.
pub(crate) fn flux_moments<R: Real>(c: &Configuration<'_, R>, f: &[R], out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let (mut linear, mut angular) = (Complex::default(), R::zero());
        for ((x, d), f) in nodes.points().zip(nodes.tangents()).zip(part(f, b.first, b.nodes)) {
            linear += complex(-d.im, d.re) * *f;
            angular += dot(x, d) * *f;
        }
        put_three(out, link, linear * nodes.step, angular * nodes.step);
    }
}

/// `out += scale · Xᵀ f`: three reals per link, link frames.
pub(crate) fn add_potential_moments<R: Real>(c: &Configuration<'_, R>, f: &[R], scale: R, out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let mut sum = [R::zero(); 3];
        for (((f, x), y), chi) in part(f, b.first, b.nodes).iter().zip(nodes.x).zip(nodes.y).zip(nodes.chi) {
            sum[0] += *f * *x;
            sum[1] += *f * *y;
            sum[2] += *f * *chi;
        }
        for (o, s) in part_mut(out, 3 * link, 3).iter_mut().zip(sum) {
            *o += scale * s;
        }
    }
}

/// Momenta of all columns on one boundary.
struct Momenta<'a, 'b, R> {
    nodes: Nodes<'a, R>,
    bx: &'b mut [R],
    by: &'b mut [R],
    bt: &'b mut [R],
    columns: &'b [R],
    ld: usize,
    motions: &'b [R],
    momenta: &'b mut [R],
    rows: usize,
    link: usize,
}

impl<R: Real> Task for Momenta<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let (n, h) = (self.nodes, self.nodes.step);
        let weights = self.bx.iter_mut().zip(self.by.iter_mut()).zip(self.bt.iter_mut());
        for ((((bx, by), bt), (x, y)), (dx, dy)) in weights.zip(n.x.iter().zip(n.y)).zip(n.dx.iter().zip(n.dy)) {
            (*bx, *by, *bt) = (-*dy * h, *dx * h, (*x * *dx + *y * *dy) * h);
        }
        let b = [&*self.bx, &*self.by, &*self.bt];
        // BᵀX, for the potential inside.
        let inside = b.map(|b| [n.x, n.y, n.chi].map(|x| inner(b, x)));
        for (k, v) in self.motions.chunks_exact(self.rows.max(1)).enumerate() {
            let u = part(self.columns, k * self.ld, n.x.len());
            let v = twist_of(v, self.link);
            let moments = b
                .iter()
                .zip(inside)
                .map(|(b, [x, y, chi])| inner(b, u) + (x * v.linear.re + y * v.linear.im + chi * v.angular));
            let momentum = part_mut(self.momenta, k * self.rows + 3 * self.link, 3);
            for (p, moment) in momentum.iter_mut().zip(moments) {
                *p = moment;
            }
        }
    }
}

/// The boundary system of one configuration in the caller's buffers.
pub(crate) struct BoundarySystem<'a, R> {
    pub matrix: &'a mut [R],
    pub ld: usize,
    pub unknowns: usize,
    pub pivots: &'a mut [R],
    pub regular: &'a mut [R],
    /// Not 0 while the walls' own rows and columns of `matrix` hold their factors.
    pub walls_ready: &'a mut [R],
}

impl<R: Real> BoundarySystem<'_, R> {
    /// Column `k` of the right-hand sides (before), of the densities (after [`BoundarySystem::solve`]).
    pub(crate) fn column(&mut self, k: usize) -> &mut [R] {
        part_mut(self.matrix, (self.unknowns + k) * self.ld, self.unknowns)
    }

    /// Assembles, sets the first right-hand sides to −2 X v for the link-frame motions in `motions` (columns of
    /// three reals per link), factorizes and solves. O(N³). The factors of the walls alone, which come first, are kept: they
    /// are the model's as long as no wall has nodes of its own here.
    pub(crate) fn solve(&mut self, c: &Configuration<'_, R>, motions: &[R], zx: &mut [R], zy: &mut [R]) -> Result<()> {
        let (walls, regraded) = (c.model.head.wall_nodes, c.walls_regraded());
        let mut ready = at(self.walls_ready, 0) != R::zero() && !regraded;
        assemble(c, ready, self.matrix, self.ld, self.regular, zx, zy);
        if walls > 0 && !regraded && !ready {
            ready = factor(part_mut(self.matrix, 0, walls * self.ld), self.ld, walls, self.pivots).is_ok();
            if !ready {
                assemble(c, false, self.matrix, self.ld, self.regular, zx, zy);
            }
        }
        put(self.walls_ready, 0, if ready { R::one() } else { R::zero() });
        let rows = 3 * c.model.links.len();
        let columns = motions.chunks_exact(rows.max(1)).len();
        let first = self.unknowns * self.ld;
        for (_, b, nodes) in c.each_boundary() {
            for (k, v) in motions.chunks_exact(rows.max(1)).enumerate() {
                let column = part_mut(self.matrix, first + k * self.ld + b.first, b.nodes);
                match b.link.map(|link| twist_of(v, link)).filter(|v| *v != Twist::default()) {
                    Some(v) => {
                        for (o, x) in column.iter_mut().zip(potential(&nodes, v)) {
                            *o = -R::TWO * x;
                        }
                    }
                    None => column.fill(R::zero()),
                }
            }
        }
        // A motion that moves only later links leaves the rows of the earlier ones zero.
        let begins = |v: &[R]| {
            let moved = |b: &&crate::model::boundary::BoundaryRecord<R>| {
                b.link.is_some_and(|link| twist_of(v, link) != Twist::default())
            };
            c.model.boundaries.iter().find(moved).map_or(self.unknowns, |b| b.first)
        };
        let begun = |row: usize| motions.chunks_exact(rows.max(1)).rposition(|v| begins(v) < row).map_or(0, |k| k + 1);
        let used = (self.unknowns + columns) * self.ld;
        let done = if ready { walls } else { 0 };
        factor_further(part_mut(self.matrix, 0, used), self.ld, self.unknowns, done, self.pivots, begun)?;
        let Some((lu, rest)) = self.matrix.split_at_mut_checked(self.unknowns * self.ld) else {
            return Err(crate::base::status::Status::Internal.into());
        };
        let factors = Factors { lu, ld: self.ld, pivots: self.pivots };
        factors.back_substitute(part_mut(rest, 0, columns * self.ld));
        Ok(())
    }

    /// `momenta = Bᵀ (u + X v)` of every solved column, link frames. `scratch`: three vectors of length N.
    pub(crate) fn momenta(&self, c: &Configuration<'_, R>, motions: &[R], scratch: [&mut [R]; 3], momenta: &mut [R]) {
        let columns = part(self.matrix, self.unknowns * self.ld, self.matrix.len() - self.unknowns * self.ld);
        let rows = 3 * c.model.links.len();
        let [bx, by, bt] = scratch;
        for (_, b, nodes) in c.each_boundary() {
            let Some(link) = b.link else { continue };
            let (bx, by, bt) = (part_mut(bx, 0, b.nodes), part_mut(by, 0, b.nodes), part_mut(bt, 0, b.nodes));
            let (columns, ld) = (columns.get(b.first..).unwrap_or(&[]), self.ld);
            Machine::here().run(Momenta { nodes, bx, by, bt, columns, ld, motions, momenta, rows, link });
        }
    }

    /// The factors.
    pub(crate) fn factors(&self) -> Factors<'_, R> {
        Factors { lu: part(self.matrix, 0, self.unknowns * self.ld), ld: self.ld, pivots: self.pivots }
    }

    /// `out = Σ_k c_k u_k` over the solved columns.
    pub(crate) fn combine(&mut self, coefficients: impl Iterator<Item = R>, out: &mut [R]) {
        out.fill(R::zero());
        for (k, c) in coefficients.enumerate() {
            axpy(out, c, self.column(k));
        }
    }
}
