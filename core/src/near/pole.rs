//! The pole term of the trapezoidal rule, in closed form.
//!
//! W_ik ≈ ∫ ds Γ'/(Γ − z_i) has residue 1 at every preimage s* of z_i. Near the real axis the trapezoidal rule misses, per
//! node k and with x = s* − s_j, m = j − k, σ = sign Im x,
//!
//! (π/N) (−1)^m e^(iσNx/2) cot((x + mh)/2),
//!
//! exactly for the trigonometric interpolant of the density. Its derivative by z is that of x times dx/dz. The cotangent
//! of a sum needs no transcendental function per node: (c − τ s)/(s + τ c) with τ = tan(x/2), c + is = e^(imh/2).

use crate::lu::{Machine, Task};
use crate::near::Preimage;
use crate::scalar::{Complex, Real, complex};
use crate::workspace::part;

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
        crate::workspace::put(table, r, c);
        crate::workspace::put(table, len + r, s);
    }
}

/// Cosines and sines of rπ/N with r from (k₀ − j) mod N upwards, for k = k₀ = 0.
#[inline]
fn turned<R: Real>(table: &[R], nodes: usize, j: usize) -> (&[R], &[R]) {
    let from = if j == 0 { 0 } else { nodes.saturating_sub(j) };
    (part(table, from, nodes), part(table, 2 * nodes + from, nodes))
}

/// What a row of pole terms has in common: τ, the factor (π/N) (−1)^j e^(iσNx/2), σN/2.
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

/// cot((x + mh)/2), m = j − k: the table holds the angle −m h/2.
#[inline(always)]
fn cotangent<R: Real>(t: Complex<R>, c: R, s: R) -> Complex<R> {
    let (top, bottom) = (complex(c + t.re * s, t.im * s), complex(t.re * c - s, t.im * c));
    let inverse = R::one() / (bottom.re * bottom.re + bottom.im * bottom.im);
    complex((top.re * bottom.re + top.im * bottom.im) * inverse, (top.im * bottom.re - top.re * bottom.im) * inverse)
}

/// Lanes of the loops over nodes, so that they vectorize; the terms alternate in sign.
const LANES: usize = 8;

#[inline(always)]
fn signs<R: Real>() -> [R; LANES] {
    let (plus, minus) = (R::one(), -R::one());
    [plus, minus, plus, minus, plus, minus, plus, minus]
}

/// Calls back with (k, term of W_ik) for the nodes of the source.
#[inline]
pub(crate) fn each_weight<R: Real>(
    machine: Machine,
    pre: &Preimage<R>,
    table: &[R],
    nodes: usize,
    visit: impl FnMut(usize, Complex<R>),
) {
    let (cos, sin) = turned(table, nodes, pre.node);
    machine.run(Weights { row: Row::of(pre, nodes), cos, sin, visit });
}

struct Weights<'a, R, F> {
    row: Row<R>,
    cos: &'a [R],
    sin: &'a [R],
    visit: F,
}

impl<R: Real, F: FnMut(usize, Complex<R>)> Task for Weights<'_, R, F> {
    #[inline(always)]
    fn run(mut self) {
        let f = self.row.factor;
        let chunks = self.cos.chunks(LANES).zip(self.sin.chunks(LANES));
        for (first, (cos, sin)) in (0..).step_by(LANES).zip(chunks) {
            let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
            let out = re.iter_mut().zip(im.iter_mut()).zip(signs());
            for (((re, im), sign), (c, s)) in out.zip(cos.iter().zip(sin)) {
                let cot = cotangent(self.row.tangent, *c, *s);
                (*re, *im) = ((f.re * cot.re - f.im * cot.im) * sign, (f.re * cot.im + f.im * cot.re) * sign);
            }
            for (k, (re, im)) in re.iter().zip(&im).enumerate().take(cos.len()) {
                (self.visit)(first + k, complex(*re, *im));
            }
        }
    }
}

/// Σ_k of the terms of W_ik.
pub(crate) fn sum_of_weights<R: Real>(pre: &Preimage<R>, table: &[R], nodes: usize) -> Complex<R> {
    let mut sum = Complex::default();
    each_weight(Machine::here(), pre, table, nodes, |_, w| sum += w);
    sum
}

/// dW_ik/dz apart from its sign and from the factor: iσ(N/2) cot − (1 + cot²)/2.
#[inline(always)]
fn slope<R: Real>(row: &Row<R>, c: R, s: R) -> Complex<R> {
    let cot = cotangent(row.tangent, c, s);
    complex(
        -row.half * cot.im - (R::one() + cot.re * cot.re - cot.im * cot.im) * R::HALF,
        row.half * cot.re - cot.re * cot.im,
    )
}

/// Σ_k D_ik w_k of the terms of D_ik = dW_ik/dz for one target, scaled, and Im(f D_ik) added to `out_k`.
pub(crate) fn slope_products<R: Real>(
    machine: Machine,
    pre: &Preimage<R>,
    table: &[R],
    w: &[R],
    f: Complex<R>,
    scale: R,
    out: &mut [R],
) -> Complex<R> {
    let (row, (cos, sin)) = (Row::of(pre, w.len()), turned(table, w.len(), pre.node));
    let factor = row.factor * pre.rate * scale;
    let mut sum = Complex::default();
    machine.run(Products { row, cos, sin, w, g: f * factor, out, sum: &mut sum });
    factor * sum
}

struct Products<'a, R> {
    row: Row<R>,
    cos: &'a [R],
    sin: &'a [R],
    w: &'a [R],
    g: Complex<R>,
    out: &'a mut [R],
    sum: &'a mut Complex<R>,
}

impl<R: Real> Task for Products<'_, R> {
    #[inline(always)]
    fn run(self) {
        let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
        let g = self.g;
        let angles = self.cos.chunks(LANES).zip(self.sin.chunks(LANES));
        for ((cos, sin), (w, out)) in angles.zip(self.w.chunks(LANES).zip(self.out.chunks_mut(LANES))) {
            let sums = re.iter_mut().zip(im.iter_mut()).zip(signs());
            let nodes = cos.iter().zip(sin).zip(w.iter().zip(out));
            for (((re, im), sign), ((c, s), (w, out))) in sums.zip(nodes) {
                let d = slope(&self.row, *c, *s);
                let signed = *w * sign;
                *re += d.re * signed;
                *im += d.im * signed;
                *out += (g.re * d.im + g.im * d.re) * sign;
            }
        }
        *self.sum = total(&re, &im);
    }
}

fn total<R: Real>(re: &[R], im: &[R]) -> Complex<R> {
    re.iter().zip(im).fold(Complex::default(), |s: Complex<R>, (re, im)| s + complex(*re, *im))
}

/// Σ_k D_ik w_k of the terms for one target and a complex density, scaled.
pub(crate) fn slope_sum<R: Real>(
    machine: Machine,
    pre: &Preimage<R>,
    table: &[R],
    [wx, wy]: [&[R]; 2],
    scale: R,
) -> Complex<R> {
    let (row, (cos, sin)) = (Row::of(pre, wx.len()), turned(table, wx.len(), pre.node));
    let factor = row.factor * pre.rate * scale;
    let mut sum = Complex::default();
    machine.run(Sum { row, cos, sin, wx, wy, sum: &mut sum });
    factor * sum
}

struct Sum<'a, R> {
    row: Row<R>,
    cos: &'a [R],
    sin: &'a [R],
    wx: &'a [R],
    wy: &'a [R],
    sum: &'a mut Complex<R>,
}

impl<R: Real> Task for Sum<'_, R> {
    #[inline(always)]
    fn run(self) {
        let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
        let angles = self.cos.chunks(LANES).zip(self.sin.chunks(LANES));
        for ((cos, sin), (wx, wy)) in angles.zip(self.wx.chunks(LANES).zip(self.wy.chunks(LANES))) {
            let sums = re.iter_mut().zip(im.iter_mut()).zip(signs());
            for (((re, im), sign), ((c, s), (x, y))) in sums.zip(cos.iter().zip(sin).zip(wx.iter().zip(wy))) {
                let d = slope(&self.row, *c, *s);
                *re += (d.re * *x - d.im * *y) * sign;
                *im += (d.re * *y + d.im * *x) * sign;
            }
        }
        *self.sum = total(&re, &im);
    }
}
