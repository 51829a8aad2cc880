//! The boundary system of one configuration in density form, A u = −2 X v (8.2): assembled, factorized, solved; and what its solutions
//! give, the added mass (2.11).
//!
//! Tested by `tests/near_contact`, `tests/reference_values`, `tests/gradients`.

use crate::base::machine::{Machine, Task};
use crate::base::memory::{axpy, inner, part, part_mut};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::fluid::assembly::assemble;
use crate::fluid::configuration::Configuration;
use crate::fluid::potentials::potential;
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::{Twist, twist_of};
use crate::linear::lu::{Factorization, Factors, factor_further, factor_with};
use crate::model::boundary::BoundaryRecord;

/// The boundary system of one configuration in the caller's buffers: A, column-major with leading dimension `ld`, and behind it the
/// columns of right-hand sides; once solved, the factors and the densities. N unknowns.
pub(crate) struct BoundarySystem<'a, R: Real> {
    /// ld × (N + columns).
    pub matrix: &'a mut [R],
    pub ld: usize,
    pub unknowns: usize,
    pub pivots: &'a mut [R::Index],
    /// Re G · N × N where there is circulation, else empty.
    pub regular: &'a mut [R],
}

impl<R: Real> BoundarySystem<'_, R> {
    /// Column `k` of the right-hand sides (before), of the densities (after [`BoundarySystem::solve`]).
    pub(crate) fn column(&mut self, k: usize) -> &mut [R] {
        part_mut(self.matrix, (self.unknowns + k) * self.ld, self.unknowns)
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

/// The boundary of which the factors of a singular matrix are worst: whose pivot is no number, or the smallest.
#[cold]
fn named<R: Real>(error: Error, c: &Configuration<'_, R>, matrix: &[R], ld: usize) -> Error {
    let pivots = matrix.iter().step_by(ld.saturating_add(1)).map(|x| if x.is_finite() { x.abs() } else { -R::one() });
    let worst = pivots.take(c.model.head.plan.unknowns).enumerate().reduce(|a, b| if b.1 < a.1 { b } else { a });
    let boundary = worst.and_then(|(k, _)| c.model.boundaries.iter().find(|b| k < b.first + b.nodes));
    boundary.map_or(error, |b| error.at(b.place))
}

once! {
    /// Assembles, sets the first right-hand sides to −2 X v for the link-frame motions in `motions` (columns of
    /// three reals per link), factorizes and solves. `zx`, `zy`: scratch of length N. O(N³). The factors of the walls alone, which
    /// come first, are kept (`walls_ready`): they are the model's as long as no wall has nodes of its own here.
    pub(crate) fn solve_columns['a, 'b: 'a](
        by: Factorization, system: &'a mut BoundarySystem<'b, R>, walls_ready: &'a mut bool, c: &'a Configuration<'a, R>, motions: &'a [R],
        zx: &'a mut [R], zy: &'a mut [R],
    ) -> Result<()> {
        let (walls, regraded) = (c.model.head.wall_nodes, c.walls_regraded());
        let mut ready = *walls_ready && !regraded;
        assemble(c, ready, system.matrix, system.ld, system.regular, zx, zy);
        if walls > 0 && !regraded && !ready {
            ready = factor_with(by, part_mut(system.matrix, 0, walls * system.ld), system.ld, walls, system.pivots).is_ok();
            if !ready {
                assemble(c, false, system.matrix, system.ld, system.regular, zx, zy);
            }
        }
        *walls_ready = ready;
        let rows = 3 * c.model.links.len();
        let columns = motions.chunks_exact(rows.max(1)).len();
        let first = system.unknowns * system.ld;
        for (_, b, nodes) in c.each_boundary() {
            for (k, v) in motions.chunks_exact(rows.max(1)).enumerate() {
                let column = part_mut(system.matrix, first + k * system.ld + b.first, b.nodes);
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
            let moved = |b: &&BoundaryRecord<R>| {
                b.link.is_some_and(|link| twist_of(v, link) != Twist::default())
            };
            c.model.boundaries.iter().find(moved).map_or(system.unknowns, |b| b.first)
        };
        let begun = |row: usize| motions.chunks_exact(rows.max(1)).rposition(|v| begins(v) < row).map_or(0, |k| k + 1);
        let used = (system.unknowns + columns) * system.ld;
        let done = if ready { walls } else { 0 };
        let matrix = part_mut(system.matrix, 0, used);
        factor_further(by, matrix, system.ld, system.unknowns, done, system.pivots, begun)
            .map_err(|error| named(error, c, system.matrix, system.ld))?;
        let Some((lu, rest)) = system.matrix.split_at_mut_checked(system.unknowns * system.ld) else {
            return Err(Status::Internal.into());
        };
        let factors = Factors { lu, ld: system.ld, pivots: system.pivots };
        factors.back_substitute(part_mut(rest, 0, columns * system.ld));
        Ok(())
    }

    /// `momenta = Bᵀ (u + X v)` of every solved column, link frames. `bx`, `by`, `bt`: scratch of length N.
    pub(crate) fn column_momenta['a](
        system: &'a BoundarySystem<'a, R>, c: &'a Configuration<'a, R>, motions: &'a [R],
        bx: &'a mut [R], by: &'a mut [R], bt: &'a mut [R], momenta: &'a mut [R],
    ) {
        let columns = part(system.matrix, system.unknowns * system.ld, system.matrix.len() - system.unknowns * system.ld);
        let rows = 3 * c.model.links.len();
        for (_, b, nodes) in c.each_boundary() {
            let Some(link) = b.link else { continue };
            let (bx, by, bt) = (part_mut(bx, 0, b.nodes), part_mut(by, 0, b.nodes), part_mut(bt, 0, b.nodes));
            let (columns, ld) = (columns.get(b.first..).unwrap_or(&[]), system.ld);
            Machine::here().run(Momenta { nodes, bx, by, bt, columns, ld, motions, momenta, rows, link });
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
