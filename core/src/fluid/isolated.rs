//! The isolated circulatory flow of a boundary of any shape: a vortex sheet on the outline, of unit total strength per 2π, with
//! nothing moving inside.
//!
//! On the outline L = i θ up to a constant, θ growing by 2π per turn, and outside 2π L(z) = ∫ θ′ log(z − Γ) ds. θ′ is the null
//! vector of the interior matrix transposed. At a point, with φ = θ − s periodic,
//!
//! L = (1/N) Σ log(z − Γ_k) − W φ/2π,  L′ = −W (θ′/Γ′)/2π,  L″ = −D (θ′/Γ′)/2π,
//!
//! each with the pole terms of W and D = dW/dz, the logarithm with its own: the trapezoidal rule adds (1/N) log(1 − e^(iσNx)).
//! The derivative of the first as it is computed is a second approximation of L′; what is derived from the stream function uses
//! it, so that every derivative is that of the numbers.
//!
//! Tested by `tests/isolated_flow`, `tests/gradients`.

use crate::base::complex::{Complex, cabs, complex, dot};
use crate::base::features;
use crate::base::memory::{put, take};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::fluid::configuration::Configuration;
use crate::fluid::near::buffers::Preimage;
use crate::fluid::near::pole;
use crate::fluid::near::preimage::{Source, Targets, each_preimage};
use crate::fluid::rotation::fourier_modes;
use crate::geometry::nodes::Nodes;
use crate::linear::lu::Factors;
use crate::model::boundary::{BoundaryRecord, Core, fourier_sum};

/// Tabulates θ on the source's nodes, from the factors and Re G of its interior matrix: Fourier sums of θ′ and θ − s, one after
/// the other, into `modes`. O(M²).
pub(crate) fn tabulate<R: Real>(
    source: &Source<'_, R>,
    factors: &Factors<'_, R>,
    regular: &[R],
    modes: &mut [R],
    scratch: &mut [R],
) -> Result<Core<R>> {
    let (nodes, m) = (source.nodes, source.nodes.x.len());
    let count = R::count(m.max(1));
    let mut rest = scratch;
    let (density, stream) = (take(&mut rest, m)?, take(&mut rest, m)?);
    density.fill(R::one());
    factors.solve_transposed(density);
    let total = density.iter().fold(R::zero(), |sum, x| sum + *x);
    for x in density.iter_mut() {
        *x *= count / total;
    }
    let (slope, angle) = modes.split_at_mut_checked(modes.len() / 2).ok_or(Status::Internal)?;
    fourier_modes(density, slope);
    let pairs = angle.as_chunks_mut::<2>().0.iter_mut().zip(slope.as_chunks::<2>().0);
    for (k, (angle, [a, b])) in pairs.enumerate() {
        let inner = k > 0 && 2 * k < m;
        *angle = if inner { [-*b / R::count(k), *a / R::count(k)] } else { [R::zero(); 2] };
    }
    // The stream function on the outline.
    for (k, (z, d)) in nodes.points().zip(nodes.tangents()).enumerate() {
        let others = nodes.points().enumerate().filter(|(j, _)| *j != k);
        let sum = others.fold(cabs(d).ln() - count.ln(), |sum, (_, x)| sum + cabs(x - z).ln());
        put(stream, k, sum / count);
    }
    for (k, column) in regular.chunks_exact(m.max(1)).enumerate() {
        let angle = fourier_sum(angle, nodes.step * R::count(k)) * R::HALF;
        crate::base::memory::axpy(stream, -angle, column);
    }
    if features::NEAR && !source.table.is_empty() {
        let (turn, shift) = (complex(R::one(), R::zero()), Complex::default());
        each_preimage(source, &Targets { nodes, turn, shift, own: true }, &mut |k, p| {
            crate::base::memory::add(stream, k, log_term(&p, m)[0].re);
        });
    }
    let level = stream.iter().zip(&*density).fold(R::zero(), |sum, (x, weight)| sum + *x * *weight) / count;
    let spread = stream.iter().fold(R::zero(), |worst, x| worst.max((*x - level).abs()));
    if level.is_finite() { Ok(Core { level, spread, ..Core::default() }) } else { Err(Status::Singular.into()) }
}

/// −(1/N) log(1 − E), E = e^(iσNx), and its derivative by z.
fn log_term<R: Real>(p: &Preimage<R>, nodes: usize) -> [Complex<R>; 2] {
    let count = R::count(nodes.max(1));
    let root = p.factor * (count / R::PI);
    let e = root * root;
    let rest = complex(R::one(), R::zero()) - e;
    let slope = complex(-p.rate.im, p.rate.re) * p.sign * e / rest;
    [complex(-dot(rest, rest).ln() * R::HALF / count, R::zero()), slope]
}

/// Isolated flow of strength 2π at a point outside, in the frame of its boundary.
#[derive(Clone, Copy)]
pub(crate) struct FlowAt<R> {
    /// Re L.
    pub(crate) stream: R,
    /// Derivative of `stream` + i (its conjugate).
    pub(crate) slope: Complex<R>,
    /// L′ for fluxes.
    pub(crate) velocity: Complex<R>,
    /// Its derivative.
    pub(crate) bend: Complex<R>,
}

/// The sheet of one boundary on the nodes that it has in a configuration.
pub(crate) struct Sheet<'s, R: Real> {
    pub(crate) c: &'s Configuration<'s, R>,
    pub(crate) boundary: usize,
    pub(crate) record: &'s BoundaryRecord<R>,
    pub(crate) nodes: Nodes<'s, R>,
    /// θ − s.
    pub(crate) angle: &'s [R],
    /// θ′ h.
    pub(crate) density: &'s [R],
    /// θ′/Γ′.
    pub(crate) velocity: [&'s [R]; 2],
}

impl<R: Real> Sheet<'_, R> {
    /// The flow at z, the node at unknown `row` of another boundary; `stream` is left 0 unless asked for. O(N).
    pub(crate) fn at(&self, z: Complex<R>, row: usize, stream: bool) -> FlowAt<R> {
        let (nodes, n) = (&self.nodes, self.nodes.x.len());
        let count = R::count(n.max(1));
        let zero = Complex::<R>::default();
        let (mut logs, mut plain) = (R::zero(), zero);
        let (mut first, mut second, mut velocity, mut bend) = (R::zero(), zero, zero, zero);
        let weights = self.angle.iter().zip(self.density);
        for ((x, d), (angle, density)) in nodes.points().zip(nodes.tangents()).zip(weights) {
            let away = x - z;
            let square = dot(away, away);
            if stream {
                logs += square.ln();
            }
            let inverse = away.conj() / square;
            let weighted = d * inverse * *angle;
            first += weighted.re;
            plain += inverse;
            second += weighted * inverse;
            let induced = inverse * *density;
            velocity += induced;
            bend += induced * inverse;
        }
        let (mut value, mut slope) = (logs * R::HALF / count, -plain / count);
        let (mut first, mut second) = (first * nodes.step, second * nodes.step);
        let table = self.record.table(self.c.model.store);
        if features::NEAR && !table.is_empty() {
            for p in self.c.preimages(self.boundary, row) {
                let [w, d] = pole::sums(&p, table, [self.angle, &[]]);
                (first, second) = (first + w.re, second + d);
                let [w, d] = pole::sums(&p, table, self.velocity);
                (velocity, bend) = (velocity + w, bend + d);
                let [l, d] = log_term(&p, n);
                (value, slope) = (value + l.re, slope + d);
            }
        }
        let scale = -R::one() / R::TAU;
        FlowAt {
            stream: value + first * scale - self.record.core.level,
            slope: slope + second * scale,
            velocity: velocity * scale,
            bend: bend * scale,
        }
    }
}

/// Writes the columns of [`Sheet`] at the nodes of a boundary.
pub(crate) fn write_sheet<R: Real>(
    c: &Configuration<'_, R>,
    (i, record, nodes): (usize, &BoundaryRecord<R>, Nodes<'_, R>),
    [angle, density, vx, vy]: [&mut [R]; 4],
) {
    let (own, here) = (record.view(c.model.store).grading, c.outline(i, record).grading);
    for (k, (t, d)) in nodes.t.iter().zip(nodes.tangents()).enumerate() {
        let s = nodes.step * R::count(k);
        let (permanent, ratio) = if c.regraded(i) {
            let [permanent, slope, _] = own.jet(*t);
            (permanent, slope / here.jet(*t)[1])
        } else {
            (s, R::one())
        };
        let [slope, periodic] = record.isolated(c.model.store, permanent);
        let slope = slope * ratio;
        let velocity = d.conj() * (slope / dot(d, d));
        put(angle, k, permanent + periodic - s);
        put(density, k, slope * nodes.step);
        put(vx, k, velocity.re);
        put(vy, k, velocity.im);
    }
}

/// θ′ h at the nodes of a boundary that are the model's own.
pub(crate) fn own_density<R: Real>(record: &BoundaryRecord<R>, store: &[R], k: usize, step: R) -> R {
    record.isolated(store, step * R::count(k))[0] * step
}
