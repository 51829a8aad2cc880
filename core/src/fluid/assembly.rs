//! The boundary system (8.2) in density form: A u = −2χ with A = I − Im G, and the weights that pairs of boundaries add.
//!
//! For target z and source node Γ_k of boundary j (both in j's frame) G_ik = (sign_j/π) h Γ'_k/(Γ_k − z_i).
//! n points out of the fluid. On the tank A also carries 1/N_T in every entry, which fixes the mean of u over the
//! tank's nodes to 0. Blocks of a boundary with itself and of walls with walls come ready from the model; only
//! blocks between different boundaries of which one moves are computed: one division per pair of nodes.
//!
//! Tested by `fluid/assembly_test.rs` (identities of potential theory), `tests/gradients`, `tests/walls`.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::lanes::LANES;
use crate::base::machine::{Machine, Task};
use crate::base::memory::{copy, part, part_mut, put};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::near::preimage::{Source, Targets, each_preimage};
use crate::fluid::self_block::{Block, add_flank_terms, add_pole_term, fill_self_block};
use crate::geometry::nodes::{Nodes, fill_targets, targets};
use crate::geometry::pose::relative;
use crate::model::ModelHead;
use crate::model::boundary::BoundaryRecord;

/// 1/N_T in every entry of the tank's own block.
fn completion<R: Real>(b: &BoundaryRecord<R>) -> R {
    if b.sign > R::zero() { R::one() / R::count(b.nodes.max(1)) } else { R::zero() }
}

/// Fills the constant block of the walls (and of Re G) in the store.
pub(crate) fn fill_walls<R: Real>(
    walls: &[BoundaryRecord<R>],
    head: &ModelHead<R>,
    circulation: bool,
    store: &mut [R],
) {
    let n = head.wall_nodes;
    let Some((data, blocks)) = store.split_at_mut_checked(head.walls_at) else { return };
    let Some((block, rest)) = blocks.split_at_mut_checked(n * n) else { return };
    let regular: &mut [R] = if circulation { part_mut(rest, 0, n * n) } else { &mut [] };
    for b in walls {
        let source = Source::of(b, data);
        let factor = b.sign / R::PI;
        for target in walls {
            let at = b.first * n + target.first;
            let (mut a, mut g) = (Block { data: &mut *block, ld: n, at }, Block { data: &mut *regular, ld: n, at });
            if target.first == b.first {
                fill_self_block(&source.nodes, b.sign, completion(b), &mut a, &mut g);
                add_flank_terms(&source, b.sign, &mut a, &mut g);
                continue;
            }
            let points = target.nodes(data);
            for (k, (x, dx)) in source.nodes.points().zip(source.nodes.tangents()).enumerate() {
                for (i, z) in targets(&points, target.pose, b.pose).enumerate() {
                    let w = dx / (x - z) * (source.nodes.step * factor);
                    put(a.data, at + k * n + i, -w.im);
                    if let Some(g) = g.data.get_mut(at + k * n + i) {
                        *g = w.re;
                    }
                }
            }
            if !features::NEAR || source.table.is_empty() {
                continue;
            }
            let (turn, shift) = relative(target.pose, b.pose);
            each_preimage(&source, &Targets { nodes: points, turn, shift, own: false }, &mut |i, p| {
                add_pole_term(&p, source.table, b.nodes, b.sign, i, &mut a, &mut g);
            });
        }
    }
}

/// Assembles A (leading dimension `ld`) and, if `regular` is not empty, Re G (leading dimension N).
/// `zx`, `zy` are scratch of length N. `keep_walls`: the walls' own rows and columns of A stay as they are. O(N²).
pub(crate) fn assemble<R: Real>(
    c: &Configuration<'_, R>,
    keep_walls: bool,
    matrix: &mut [R],
    ld: usize,
    regular: &mut [R],
    zx: &mut [R],
    zy: &mut [R],
) {
    let (n, walls) = (zx.len(), c.model.head.wall_nodes);
    let store = c.model.store;
    let walls_anew = c.walls_regraded();
    let machine = Machine::here();
    for (j, source, nodes) in c.each_boundary() {
        let ready_walls = source.link.is_none() && !walls_anew;
        for (i, target, points) in c.each_boundary().filter(|(i, t, _)| *i != j && !(ready_walls && t.link.is_none())) {
            let (zx, zy) = (part_mut(zx, target.first, target.nodes), part_mut(zy, target.first, target.nodes));
            fill_targets(&points, c.pose(i), c.pose(j), zx, zy);
        }
        let factor = nodes.step * source.sign / R::PI;
        // Rows that come otherwise: the walls' for a wall, its own for a link; ready made, or from nodes of their own.
        let (ready, ready_len) = if ready_walls { (0, walls) } else { (source.first, source.nodes) };
        let anew = if source.link.is_some() { c.regraded(j) } else { walls_anew };
        let own_at = source.first * ld + source.first;
        let (mut a, mut g) = (
            Block { data: &mut *matrix, ld, at: own_at },
            Block { data: &mut *regular, ld: n, at: source.first * (n + 1) },
        );
        if anew {
            fill_self_block(&nodes, source.sign, completion(source), &mut a, &mut g);
        }
        let ready_at = |links: usize, walls_at: usize| match source.link {
            _ if anew => &[],
            Some(_) => part(store, links, ready_len * source.nodes),
            None => part(store, walls_at + source.first * walls, ready_len * source.nodes),
        };
        let (zx, zy) = (&*zx, &*zy);
        let own = if source.link.is_none() && keep_walls {
            &[]
        } else {
            ready_at(source.slots.self_at, c.model.head.walls_at)
        };
        let columns = part_mut(matrix, source.first * ld, source.nodes * ld);
        let parts = (ready, ready_len);
        machine.run(BlockColumns { nodes, factor: complex(factor, R::zero()), zx, zy, parts, own, columns, ld });
        if !regular.is_empty() {
            // Re(w/(g−z)) = −Im(−i w/(g−z)): the same kernel with the weight turned by −90°.
            let own = ready_at(source.slots.regular_at, c.model.head.walls_regular_at);
            let (columns, factor) =
                (part_mut(regular, source.first * n, source.nodes * n), complex(R::zero(), -factor));
            machine.run(BlockColumns { nodes, factor, zx, zy, parts, own, columns, ld: n });
        }
        if !source.table(store).is_empty() {
            let (mut a, mut g) = (
                Block { data: &mut *matrix, ld, at: source.first * ld },
                Block { data: &mut *regular, ld: n, at: source.first * n },
            );
            // Walls come first among the unknowns.
            for row in if ready_walls { walls } else { 0 }..n {
                for p in c.preimages(j, row) {
                    add_pole_term(&p, source.table(store), source.nodes, source.sign, row, &mut a, &mut g);
                }
            }
        }
    }
}

/// The columns of one boundary: −Im(weight/(g − z)) with the targets z; in the rows `parts` (first, count) what is ready
/// made instead, if anything is.
struct BlockColumns<'a, 'b, R> {
    nodes: Nodes<'a, R>,
    /// Weights are tangents times this.
    factor: Complex<R>,
    zx: &'b [R],
    zy: &'b [R],
    parts: (usize, usize),
    own: &'a [R],
    columns: &'b mut [R],
    ld: usize,
}

impl<R: Real> Task for BlockColumns<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let (ready, len) = self.parts;
        let (before, after) = (ready, self.zx.len().saturating_sub(ready + len));
        let first = [part(self.zx, 0, before), part(self.zy, 0, before)];
        let last = [part(self.zx, ready + len, after), part(self.zy, ready + len, after)];
        let mut own = self.own.chunks_exact(len.max(1));
        let nodes = self.nodes.points().zip(self.nodes.tangents());
        for ((g, dg), column) in nodes.zip(self.columns.chunks_mut(self.ld.max(1))) {
            let weight = dg * self.factor;
            let (above, rest) = column.split_at_mut_checked(before).unwrap_or((&mut [], &mut []));
            let (middle, below) = rest.split_at_mut_checked(len).unwrap_or((&mut [], &mut []));
            if let Some(own) = own.next() {
                copy(middle, own);
            }
            kernel_column(first, g, weight, above);
            kernel_column(last, g, weight, below);
        }
    }
}

/// −Im(weight/(g − z)) for targets z, in lanes that vectorize.
#[inline(always)]
fn kernel_column<R: Real>([zx, zy]: [&[R]; 2], g: Complex<R>, weight: Complex<R>, out: &mut [R]) {
    let value = |x: R, y: R| {
        let (dx, dy) = (g.re - x, g.im - y);
        (weight.re * dy - weight.im * dx) / (dx * dx + dy * dy)
    };
    let values = |x: &[R; LANES], y: &[R; LANES]| {
        let mut lanes = [R::zero(); LANES];
        for ((lane, x), y) in lanes.iter_mut().zip(x).zip(y) {
            *lane = value(*x, *y);
        }
        lanes
    };
    let out = part_mut(out, 0, zx.len());
    for ((out, x), y) in out.as_chunks_mut().0.iter_mut().zip(zx.as_chunks().0).zip(zy.as_chunks().0) {
        *out = values(x, y);
    }
    // What is left, together with some that were there already: no boundary has fewer nodes than lanes.
    if !zx.len().is_multiple_of(LANES)
        && let (Some(out), Some(x), Some(y)) = (out.last_chunk_mut(), zx.last_chunk(), zy.last_chunk())
    {
        *out = values(x, y);
    }
}
