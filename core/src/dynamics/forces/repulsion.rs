//! Repulsion: V = ε Σ_pairs ∬ |x − x'|^(−α) ds ds' over pairs of boundaries of which one moves (5.1), by the trapezoidal
//! rule on the first boundary and, where it is close, on nodes of its own on the second ([`close_range`](super::close_range)),
//! and its gradient
//! ∂V/∂q_a = −α ε Σ ∬ |x − x'|^(−α−2) (x − x')·w_a ds ds'. (The printed (5.2) is wrong: docs/physics.md.) O(N²).
//!
//! Tested by `tests/gradients`, `tests/repulsion` (another quadrature), `tests/near_contact`, `tests/errata`.

use crate::base::complex::{Complex, cabs, cis, complex};
use crate::base::scalar::Real;
#[cfg(feature = "derivatives")]
use crate::base::{
    complex::{dot, perp},
    memory::add,
};
use crate::dynamics::forces::close_range;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::add_three;
use crate::fluid::near::preimage::Source;
use crate::geometry::nodes::targets;
use crate::scene::Repulsion;

/// d^(−α/2) for the square of a distance; even integer exponents by multiplication.
#[inline]
fn inverse_power<R: Real>(square: R, alpha: R) -> R {
    let half = alpha * R::HALF;
    if half == R::TWO {
        let x = R::one() / square;
        return x * x;
    }
    square.powf(-half)
}

/// Sums of |d|^(−α) ds', of |d|^(−α−2) d ds' and of its moment, d from the source to z (source frame).
#[derive(Clone, Copy, Default)]
struct Sums<R> {
    energy: R,
    force: Complex<R>,
    moment: R,
}

impl<R: Real> Sums<R> {
    #[inline]
    fn add(&mut self, z: Complex<R>, x: Complex<R>, ds: R, alpha: R) {
        let arm = z - x;
        let square = arm.re * arm.re + arm.im * arm.im;
        let power = inverse_power(square, alpha) * ds;
        self.energy += power;
        let strength = arm * (power / square);
        self.force += strength;
        self.moment += x.re * strength.im - x.im * strength.re;
    }
}

/// What a pair comes to: the double integrals of |d|^(−α), and of |d|^(−α−2) d (and its moments about both origins), d from the
/// second boundary to the first, in world directions; and how far the second can be trusted.
struct Pair<R> {
    first: usize,
    second: usize,
    energy: R,
    force: Complex<R>,
    moments: [R; 2],
    /// Size of the force (of moments over the reach, or of the energy over a length if that is more), and its estimated error.
    size: R,
    error: R,
}

/// Visits (point, |dγ|) of the nodes of the inner integral: the boundary's own, or those of a place close by.
#[inline(always)]
fn each_inner<R: Real>(
    source: &Source<'_, R>,
    tables: &[R],
    close: Option<(R, R)>,
    mut visit: impl FnMut(Complex<R>, R),
) {
    match close {
        Some((t, beta)) => close_range::each_node(&source.view.curve, tables, t, beta, |x, ds| {
            visit(x - source.record.origin, ds);
        }),
        None => {
            for (x, dx) in source.nodes.points().zip(source.nodes.tangents()) {
                visit(x, cabs(dx) * source.nodes.step);
            }
        }
    }
}

/// Visits every pair once. The inner integral takes the second boundary's nodes, or nodes of its own where the point is close.
fn each_pair<R: Real>(c: &Configuration<'_, R>, alpha: R, mut visit: impl FnMut(Pair<R>)) {
    let tables = c.model.close_range();
    for (i, a, a_nodes) in c.each_boundary() {
        for (j, b, b_nodes) in c.each_boundary().skip(i + 1) {
            if a.link.is_none() && b.link.is_none() {
                continue;
            }
            let source = c.pose(j);
            let inner = Source { record: b, nodes: b_nodes, view: c.outline(j, b), table: &[] };
            let close = |z| if tables.is_empty() { None } else { inner.footprint(z) };
            let sums_at = |z, close: Option<(R, R)>| {
                let mut sums = Sums::default();
                each_inner(&inner, tables, close, |x, ds| sums.add(z, x, ds, alpha));
                sums
            };
            let (mut energy, mut force, mut moment_a, mut moment_b) =
                (R::zero(), Complex::<R>::default(), R::zero(), R::zero());
            let mut outer = Harmonics::new(a.nodes);
            let mut worst = (R::zero(), Complex::<R>::default());
            let shift = source.unturned(c.pose(i).origin - source.origin);
            for (z, d) in targets(&a_nodes, c.pose(i), source).zip(a_nodes.tangents()) {
                let sums = sums_at(z, close(z));
                let ds = cabs(d) * a_nodes.step;
                let (arm, f) = (z - shift, sums.force);
                let (turn_a, turn_b) = ((arm.re * f.im - arm.im * f.re) * ds, sums.moment * ds);
                energy += sums.energy * ds;
                force += f * ds;
                moment_a += turn_a;
                moment_b += turn_b;
                outer.add([f.re * ds, f.im * ds, turn_a / a.reach, turn_b / b.reach]);
                let weight = cabs(f) * ds;
                if weight > worst.0 {
                    worst = (weight, z);
                }
            }
            // Where forces cancel (in the middle of a tank) their energy over a length tells how large they are.
            let (reach, least) = (a.reach.max(b.reach), a.reach.min(b.reach));
            let turning = (moment_a / a.reach).abs().max((moment_b / b.reach).abs());
            let size = cabs(force).max(turning).max(energy / reach);
            let z = worst.1;
            let inner_error = match close(z) {
                // Other nodes, of the next finer table, have another error.
                Some((t, beta)) => {
                    let (here, other) = (sums_at(z, Some((t, beta))), sums_at(z, Some((t, beta / R::lit(3.0)))));
                    cabs(other.force - here.force) / cabs(here.force)
                }
                None => {
                    let (mut last, mut sum) = (Harmonics::new(b.nodes), Complex::<R>::default());
                    for (x, dx) in b_nodes.points().zip(b_nodes.tangents()) {
                        let mut one = Sums::default();
                        one.add(z, x, cabs(dx) * b_nodes.step, alpha);
                        sum += one.force;
                        last.add([one.force.re, one.force.im, R::zero(), R::zero()]);
                    }
                    last.error(cabs(sum).max(R::TINY))
                }
            };
            // Coordinates are known to ε times their size, which the force magnifies by (α + 1)/distance, and energy over force
            // is the distance. This is no estimate but a bound; a hundredth of it, as of the others, is told.
            let rounding = R::EPSILON * (alpha + R::TWO) * (cabs(shift) + least) * size / energy.max(R::TINY);
            let share = outer.error(size.max(R::TINY)) + inner_error + rounding * R::lit(0.01);
            visit(Pair {
                first: i,
                second: j,
                energy,
                force: source.turned(force),
                moments: [moment_a, moment_b],
                size,
                error: size * share.min(R::one()),
            });
        }
    }
}

/// Harmonics of the integrands of force and moments: the three before the last that the nodes of a closed curve can tell (the
/// last itself is blind to what is symmetric about the middle between two nodes, one alone to what happens to interfere), and
/// one half as high.
struct Harmonics<R> {
    weights: [Complex<R>; 4],
    turns: [Complex<R>; 4],
    sums: [[Complex<R>; 4]; 4],
}

impl<R: Real> Harmonics<R> {
    fn new(nodes: usize) -> Self {
        let turn = |k: usize| cis(R::TAU * R::count(k) / R::count(nodes));
        let top = |k: usize| turn((nodes / 2).saturating_sub(k));
        Harmonics {
            weights: [complex(R::one(), R::zero()); 4],
            turns: [top(1), top(2), top(3), turn(nodes / 4)],
            sums: [[Complex::default(); 4]; 4],
        }
    }

    #[inline]
    fn add(&mut self, terms: [R; 4]) {
        for ((sums, weight), turn) in self.sums.iter_mut().zip(&mut self.weights).zip(self.turns) {
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += *weight * term;
            }
            *weight *= turn;
        }
    }

    /// Relative error of the trapezoidal rule: harmonics decay geometrically, and what the rule misses is twice as high as the
    /// last.
    fn error(&self, size: R) -> R {
        let [a, b, c, half] = self.sums.map(|sums| sums.iter().fold(R::zero(), |m, s| m.max(cabs(*s))));
        let last = a.max(b).max(c);
        let decay = (last / half.max(R::TINY)).min(R::one());
        // Where the harmonics of several poles interfere, this was too small by up to 144 without the factor (median: 18 too large).
        R::lit(4.0) * last / size * decay * decay
    }
}

/// V, J/m.
pub(crate) fn energy<R: Real>(c: &Configuration<'_, R>, law: Repulsion<R>) -> R {
    let mut sum = R::zero();
    each_pair(c, law.alpha, |p| sum += p.energy);
    sum * law.epsilon
}

/// Adds ∂V/∂q. Gives the estimated error of the integrals, relative to the largest pair's force.
pub(crate) fn add_gradient<R: Real>(c: &Configuration<'_, R>, law: Repulsion<R>, out: &mut [R]) -> R {
    let scale = -law.alpha * law.epsilon;
    let (mut error, mut size) = (R::zero(), R::TINY);
    each_pair(c, law.alpha, |p| {
        let (force, [a, b]) = (p.force, p.moments);
        add_three(c, p.first, force * scale, a * scale, out);
        add_three(c, p.second, -force * scale, -b * scale, out);
        error += p.error;
        size = size.max(p.size);
    });
    error / size
}

/// Adds ∂²V/∂q² · 3n × 3n, column-major, with the nodes of the inner integrals where they are:
/// ε ΣΣ ds ds' [α (α + 2) |d|^(−α−4) (d·ḋ_a)(d·ḋ_b) − α |d|^(−α−2) (ḋ_a·ḋ_b + d·d̈_ab)]. O(N²), about five gradients.
#[cfg(feature = "derivatives")]
pub(crate) fn add_hessian<R: Real>(c: &Configuration<'_, R>, law: Repulsion<R>, out: &mut [R]) {
    let (tables, alpha, rows) = (c.model.close_range(), law.alpha, 3 * c.model.links.len());
    for (i, a, a_nodes) in c.each_boundary() {
        for (j, b, b_nodes) in c.each_boundary().skip(i + 1) {
            if a.link.is_none() && b.link.is_none() {
                continue;
            }
            let source = c.pose(j);
            let inner = Source { record: b, nodes: b_nodes, view: c.outline(j, b), table: &[] };
            let shift = source.unturned(c.pose(i).origin - source.origin);
            // Unit motions of the first boundary and of the second; linear parts in the world's directions, seen in the frame.
            let [ex, ey] = [complex(R::one(), R::zero()), complex(R::zero(), R::one())].map(|e| source.unturned(e));
            let mut sums = [[R::zero(); 6]; 6];
            for (z, d) in targets(&a_nodes, c.pose(i), source).zip(a_nodes.tangents()) {
                let (outer, arm) = (cabs(d) * a_nodes.step, z - shift);
                let close = if tables.is_empty() { None } else { inner.footprint(z) };
                each_inner(&inner, tables, close, |x, ds| {
                    let d = z - x;
                    let square = dot(d, d);
                    let weight = inverse_power(square, alpha) * ds * outer * (law.epsilon * alpha) / square;
                    let along = [ex, ey, perp(arm), -ex, -ey, -perp(x)];
                    let parts = along.map(|e| dot(d, e));
                    let second = (alpha + R::TWO) / square;
                    for ((sums, e), p) in sums.iter_mut().zip(along).zip(parts) {
                        for ((sum, f), q) in sums.iter_mut().zip(along).zip(parts) {
                            *sum += weight * (second * p * q - dot(e, f));
                        }
                    }
                    let [_, _, first, _, _, last] = &mut sums;
                    first[2] += weight * dot(d, arm);
                    last[5] -= weight * dot(d, x);
                });
            }
            let coordinate = |k: usize| if k < 3 { a.link.map(|l| 3 * l + k) } else { b.link.map(|l| 3 * l + k - 3) };
            for (p, sums) in sums.iter().enumerate() {
                for (q, sum) in sums.iter().enumerate() {
                    if let (Some(p), Some(q)) = (coordinate(p), coordinate(q)) {
                        add(out, q * rows + p, *sum);
                    }
                }
            }
        }
    }
}
