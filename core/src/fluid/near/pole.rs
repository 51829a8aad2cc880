//! The pole term of the trapezoidal rule, in closed form.
//!
//! W_ik ≈ ∫ ds Γ'/(Γ − z_i) has residue 1 at every preimage s* of z_i. Near the real axis the trapezoidal rule misses, per
//! node k and with x = s* − s_j, m = j − k, σ = sign Im x,
//!
//! (π/N) (−1)^m e^(iσNx/2) cot((x + mh)/2),
//!
//! exactly for the trigonometric interpolant of the density. Its derivative by z is that of x times dx/dz. The cotangent
//! of a sum needs no transcendental function per node: (c − τ s)/(s + τ c) with τ = tan(x/2), c + is = e^(imh/2).
//!
//! Tested by `fluid/assembly_test.rs:corrected_weights_and_their_derivatives_integrate_a_constant_exactly`,
//! `tests/near_contact`.
#![allow(clippy::indexing_slicing)] // Indices run over arrays of the same constant length.

use crate::base::complex::{Complex, complex};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{copy_some, part};
use crate::base::scalar::Real;
use crate::fluid::near::buffers::Preimage;

/// Reals of the table of one boundary: cos and sin of rπ/N for 2N values of r, modulo N.
pub(crate) fn table_len(nodes: usize) -> Option<usize> {
    nodes.checked_mul(4)
}

/// Fills the table.
pub(crate) fn fill_table<R: Real>(nodes: usize, table: &mut [R]) {
    let len = 2 * nodes;
    for r in 0..len {
        // The cotangent has period π: reduced first, so that the sine of a whole period is exactly 0.
        let reduced = if r < nodes { r } else { r - nodes };
        let (s, c) = (R::PI * R::count(reduced) / R::count(nodes.max(1))).sin_cos();
        crate::base::memory::put(table, r, c);
        crate::base::memory::put(table, len + r, s);
    }
}

/// Cosines and sines of rπ/N with r from (k₀ − j) mod N upwards, for k = k₀ = 0.
#[inline]
fn turned<R: Real>(table: &[R], nodes: usize, j: usize) -> (&[R], &[R]) {
    let from = if j == 0 { 0 } else { nodes.saturating_sub(j) };
    (part(table, from, nodes), part(table, 2 * nodes + from, nodes))
}

/// What a row of pole terms has in common: τ, the factor (π/N) (−1)^j e^(iσNx/2), σN/2.
#[derive(Clone, Copy)]
struct Row<R> {
    tangent: Complex<R>,
    factor: Complex<R>,
    half: R,
}

impl<R: Real> Row<R> {
    #[inline(always)]
    fn of(pre: &Preimage<R>, nodes: usize) -> Self {
        Row { tangent: pre.tangent, factor: pre.factor, half: pre.sign * R::count(nodes) * R::HALF }
    }
}

/// Nodes that are treated together. The terms alternate in sign.
pub(super) const LANES: usize = 16;

/// The elements from `from` on; `fill` where there are no more.
#[inline(always)]
pub(super) fn load<R: Real>(data: &[R], from: usize, fill: R) -> [R; LANES] {
    let rest = data.get(from..).unwrap_or(&[]);
    rest.first_chunk().copied().unwrap_or_else(|| {
        let mut lanes = [fill; LANES];
        copy_some(&mut lanes, rest);
        lanes
    })
}

/// First nodes of blocks of lanes that cover `n` nodes, each with the number of lanes that the one before covers already: the last
/// one begins early instead of ending late, so that memory is read as it lies. Fewer nodes than lanes are one block.
#[inline(always)]
fn blocks(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).step_by(LANES).map(move |first| match first + LANES {
        end if end <= n || n < LANES => (first, 0),
        end => (n - LANES, end - n),
    })
}

/// cot((x + mh)/2), m = j − k, at the nodes from `first` on: the table holds the angle −m h/2. (c − τ s)(τ c + s)* has the
/// imaginary part −Im τ.
#[inline(always)]
fn cotangents<R: Real>(t: Complex<R>, cos: &[R], sin: &[R], first: usize) -> [[R; LANES]; 2] {
    let (c, s) = (load(cos, first, R::one()), load(sin, first, R::one()));
    let (mut re, mut im) = (c, c);
    for i in 0..LANES {
        let (x, y) = (t.re * c[i] - s[i], t.im * c[i]);
        let inverse = R::one() / (x * x + y * y);
        re[i] = ((c[i] + t.re * s[i]) * x + t.im * s[i] * y) * inverse;
        im[i] = -t.im * inverse;
    }
    [re, im]
}

/// Where a row of terms goes, each times a real factor: every `stride`-th element.
pub(crate) struct RowOf<'a, R> {
    pub data: &'a mut [R],
    pub stride: usize,
    pub scale: R,
}

/// Adds the real and the imaginary parts of a row of terms of W_ik, one for every node of the source; nothing to empty memory.
#[inline]
pub(crate) fn add_weights<R: Real>(
    machine: Machine,
    pre: &Preimage<R>,
    table: &[R],
    nodes: usize,
    [re, im]: [RowOf<'_, R>; 2],
) {
    let (cos, sin) = turned(table, nodes, pre.node);
    let row = Row::of(pre, nodes);
    machine.run(Weights { row, cos, sin, out: im, turn: complex(R::zero(), R::one()) });
    if !re.data.is_empty() {
        machine.run(Weights { row, cos, sin, out: re, turn: complex(R::one(), R::zero()) });
    }
}

/// Adds Re(conj(turn) W_ik).
struct Weights<'a, R> {
    row: Row<R>,
    cos: &'a [R],
    sin: &'a [R],
    out: RowOf<'a, R>,
    turn: Complex<R>,
}

impl<R: Real> Task for Weights<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let f = self.row.factor * self.turn.conj() * self.out.scale;
        let mut columns = self.out.data.chunks_mut(self.out.stride.max(1));
        for (first, skip) in blocks(self.cos.len()) {
            let [mut re, im] = cotangents(self.row.tangent, self.cos, self.sin, first);
            let f = f * sign::<R>(first);
            for i in 0..LANES {
                re[i] = (f.re * re[i] - f.im * im[i]) * sign::<R>(i);
            }
            for (w, column) in part(&re, skip, LANES - skip).iter().zip(&mut columns) {
                if let [entry, ..] = column {
                    *entry += *w;
                }
            }
        }
    }
}

/// Σ_k of the terms of W_ik.
pub(crate) fn sum_of_weights<R: Real>(pre: &Preimage<R>, table: &[R], nodes: usize) -> Complex<R> {
    let (mut re, mut im) = (R::zero(), R::zero());
    let (cos, sin) = turned(table, nodes, pre.node);
    for (first, skip) in blocks(cos.len()) {
        let cot = cotangents(pre.tangent, cos, sin, first);
        for i in skip..LANES.min(cos.len()) {
            re += cot[0][i] * sign(first + i);
            im += cot[1][i] * sign(first + i);
        }
    }
    pre.factor * complex(re, im)
}

#[inline(always)]
fn sign<R: Real>(i: usize) -> R {
    if i.is_multiple_of(2) { R::one() } else { -R::one() }
}

/// dW_ik/dz at the nodes from `first` on, apart from the factor: iσ(N/2) cot − (1 + cot²)/2, with the alternating sign.
#[inline(always)]
fn slopes<R: Real>(row: &Row<R>, cos: &[R], sin: &[R], first: usize) -> [[R; LANES]; 2] {
    let [mut re, mut im] = cotangents(row.tangent, cos, sin, first);
    for i in 0..LANES {
        let (sign, x, y) = (sign::<R>(i), re[i], im[i]);
        re[i] = (-row.half * y - (R::one() + x * x - y * y) * R::HALF) * sign;
        im[i] = (row.half * x - x * y) * sign;
    }
    [re, im]
}

/// Σ_k D_ik w_k of the terms of D_ik = dW_ik/dz for one target, scaled, and Im(f D_ik) added to `out_k`.
#[inline(always)]
pub(crate) fn slope_products<R: Real>(
    pre: &Preimage<R>,
    table: &[R],
    w: &[R],
    f: Complex<R>,
    scale: R,
    out: &mut [R],
) -> Complex<R> {
    let (row, (cos, sin)) = (Row::of(pre, w.len()), turned(table, w.len(), pre.node));
    let factor = row.factor * pre.rate * scale;
    let mut sums = [[R::zero(); LANES]; 2];
    for (first, skip) in blocks(w.len()) {
        let [re, im] = slopes(&row, cos, sin, first);
        let mut w = load(w, first, R::zero());
        let out = out.get_mut(first..).unwrap_or(&mut []);
        let mut sum = load(out, 0, R::zero());
        let g = f * factor * sign::<R>(first);
        for i in 0..LANES {
            w[i] = if i < skip { R::zero() } else { w[i] * sign(first) };
            sums[0][i] += re[i] * w[i];
            sums[1][i] += im[i] * w[i];
            sum[i] += if i < skip { R::zero() } else { g.re * im[i] + g.im * re[i] };
        }
        match out.first_chunk_mut() {
            Some(out) => *out = sum,
            None => copy_some(out, &sum),
        }
    }
    factor * total(&sums)
}

fn total<R: Real>([re, im]: &[[R; LANES]; 2]) -> Complex<R> {
    re.iter().zip(im).fold(Complex::default(), |s: Complex<R>, (re, im)| s + complex(*re, *im))
}

/// Σ_k D_ik w_k of the terms for one target and a complex density, scaled.
#[inline(always)]
pub(crate) fn slope_sum<R: Real>(pre: &Preimage<R>, table: &[R], [wx, wy]: [&[R]; 2], scale: R) -> Complex<R> {
    let (row, (cos, sin)) = (Row::of(pre, wx.len()), turned(table, wx.len(), pre.node));
    let mut sums = [[R::zero(); LANES]; 2];
    for (first, skip) in blocks(cos.len()) {
        let [re, im] = slopes(&row, cos, sin, first);
        let (mut x, mut y) = (load(wx, first, R::zero()), load(wy, first, R::zero()));
        for i in 0..LANES {
            let factor = if i < skip { R::zero() } else { sign(first) };
            (x[i], y[i]) = (x[i] * factor, y[i] * factor);
            sums[0][i] += re[i] * x[i] - im[i] * y[i];
            sums[1][i] += re[i] * y[i] + im[i] * x[i];
        }
    }
    row.factor * pre.rate * scale * total(&sums)
}

/// Σ_k W_ik w_k and Σ_k D_ik w_k of the terms for one target and a complex density (an empty imaginary part is 0).
pub(crate) fn sums<R: Real>(pre: &Preimage<R>, table: &[R], [wx, wy]: [&[R]; 2]) -> [Complex<R>; 2] {
    let (row, (cos, sin)) = (Row::of(pre, wx.len()), turned(table, wx.len(), pre.node));
    let (mut weights, mut slopes) = (Complex::<R>::default(), Complex::<R>::default());
    for (first, skip) in blocks(cos.len()) {
        let [re, im] = cotangents(row.tangent, cos, sin, first);
        let (x, y) = (load(wx, first, R::zero()), load(wy, first, R::zero()));
        for i in skip..LANES {
            let (cot, w) = (complex(re[i], im[i]), complex(x[i], y[i]) * sign::<R>(first + i));
            weights += cot * w;
            slopes += (complex(-row.half * cot.im, row.half * cot.re) - (cot * cot + R::one()) * R::HALF) * w;
        }
    }
    [row.factor * weights, row.factor * pre.rate * slopes]
}

/// Visits every node k with the terms of D_ik = dW_ik/dz and of E_ik = dD_ik/dz for one target; `bend`: d²x/dz².
#[cfg(feature = "derivatives")]
pub(crate) fn each_slope<R: Real>(
    pre: &Preimage<R>,
    table: &[R],
    nodes: usize,
    bend: Complex<R>,
    mut visit: impl FnMut(usize, Complex<R>, Complex<R>),
) {
    let (row, (cos, sin)) = (Row::of(pre, nodes), turned(table, nodes, pre.node));
    let (q, square) = (complex(R::zero(), row.half), pre.rate * pre.rate);
    for (first, skip) in blocks(cos.len()) {
        let [re, im] = cotangents(row.tangent, cos, sin, first);
        for i in skip..LANES.min(cos.len() - first) {
            let cot = complex(re[i], im[i]);
            let csc2 = cot * cot + R::one();
            let slope = q * cot - csc2 * R::HALF;
            let second = q * q * cot - q * csc2 + csc2 * cot * R::HALF;
            let factor = row.factor * sign::<R>(first + i);
            visit(first + i, factor * slope * pre.rate, factor * (second * square + slope * bend));
        }
    }
}
