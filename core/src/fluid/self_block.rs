//! What rigid motion leaves unchanged of the matrix: the block of a boundary with itself, and pole terms in any block.
//!
//! With n out of the fluid and G = (sign/π) W, W_ik ≈ ∫ ds Γ'/(Γ − z_i): sign = −1 on links and obstacles, +1 on
//! the tank. The matrix is A = I − Im G. On one boundary W is a principal value:
//! W_ik = h Γ'_k/(Γ_k − Γ_i) − (−1)^(k−i) (h/2) cot((s_k − s_i)/2), W_ii = h Γ''_i/(2Γ'_i); the cotangent is real
//! and matters only for Re G.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::machine::Machine;
use crate::base::memory::part_mut;
use crate::base::scalar::Real;
use crate::fluid::near::buffers::Preimage;
use crate::fluid::near::pole;
use crate::fluid::near::preimage::{Source, Targets, each_preimage};
use crate::geometry::nodes::Nodes;

/// Where the entries of a block go: column-major, the block's first entry at `at`.
pub(crate) struct Block<'a, R> {
    pub data: &'a mut [R],
    pub ld: usize,
    pub at: usize,
}

impl<R: Real> Block<'_, R> {
    /// Column `k` of the block, `n` rows.
    #[inline]
    pub(crate) fn column(&mut self, k: usize, n: usize) -> &mut [R] {
        part_mut(self.data, self.at + k * self.ld, n)
    }
}

/// Fills the block of A = I − Im G of a boundary with itself by the plain rule, with `completion` in every entry, and of
/// Re G if there is memory for it. O(N²).
pub(crate) fn fill_self_block<R: Real>(
    nodes: &Nodes<'_, R>,
    sign: R,
    completion: R,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    let (n, h, factor) = (nodes.x.len(), nodes.step, sign / R::PI);
    for (k, ((g, dg), ddg)) in nodes.points().zip(nodes.tangents()).zip(nodes.seconds()).enumerate() {
        let weight = dg * (h * factor);
        let own = ddg / dg * (h * R::HALF * factor);
        for (i, (a, z)) in matrix.column(k, n).iter_mut().zip(nodes.points()).enumerate() {
            let d = g - z;
            let im = (weight.im * d.re - weight.re * d.im) / (d.re * d.re + d.im * d.im);
            *a = completion + if i == k { R::one() - own.im } else { -im };
        }
        if regular.data.is_empty() {
            continue;
        }
        for (i, (a, z)) in regular.column(k, n).iter_mut().zip(nodes.points()).enumerate() {
            if i == k {
                *a = own.re;
                continue;
            }
            let half = R::count(k.abs_diff(i)) * h * R::HALF;
            let (s, c) = half.sin_cos();
            let cot = if (k > i) == (k.abs_diff(i) % 2 == 0) { c / s } else { -c / s };
            *a = (weight / (g - z)).re - cot * h * R::HALF * factor;
        }
    }
}

/// Adds the pole term of a preimage to row `i` of both blocks.
pub(crate) fn add_pole_term<R: Real>(
    p: &Preimage<R>,
    table: &[R],
    nodes: usize,
    sign: R,
    i: usize,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    let factor = sign / R::PI;
    let (at, from) = (matrix.at + i, regular.at + i);
    let out = [
        pole::RowOf { data: regular.data.get_mut(from..).unwrap_or(&mut []), stride: regular.ld, scale: factor },
        pole::RowOf { data: matrix.data.get_mut(at..).unwrap_or(&mut []), stride: matrix.ld, scale: -factor },
    ];
    pole::add_weights(Machine::here(), p, table, nodes, out);
}

/// Adds the pole terms of the opposite flank to a boundary's block with itself.
pub(crate) fn add_flank_terms<R: Real>(
    source: &Source<'_, R>,
    sign: R,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    if !features::NEAR || source.table.is_empty() {
        return;
    }
    let (turn, shift) = (complex(R::one(), R::zero()), Complex::default());
    let targets = Targets { nodes: source.nodes, turn, shift, own: true };
    each_preimage(source, &targets, &mut |i, p| {
        add_pole_term(&p, source.table, source.nodes.x.len(), sign, i, matrix, regular);
    });
}
