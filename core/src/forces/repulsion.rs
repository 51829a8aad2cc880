//! Repulsion: V = ε Σ_pairs ∬ |x − x'|^(−α) ds ds' over pairs of boundaries of which one moves (5.1), by the trapezoidal
//! rule on the first boundary and, where it is close, on nodes of its own on the second ([`close_range`](super::close_range)),
//! and its gradient
//! ∂V/∂q_a = −α ε Σ ∬ |x − x'|^(−α−2) (x − x')·w_a ds ds'. (The printed (5.2) is wrong: docs/physics.md.) O(N²).

use crate::christoffel::add_three;
use crate::configuration::{Configuration, targets};
use crate::forces::close_range;
use crate::near::preimage::Source;
use crate::scalar::{Complex, Real, cabs};
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

/// Visits every pair once: calls back with the double integrals of |d|^(−α), and of |d|^(−α−2) d (and its moments about
/// both origins), d from the second boundary to the first, in world directions. The inner integral takes the second
/// boundary's nodes, or nodes of its own where the point is close.
fn each_pair<R: Real>(c: &Configuration<'_, R>, alpha: R, mut visit: impl FnMut(usize, usize, R, Complex<R>, R, R)) {
    let tables = c.model.close_range();
    for (i, a, a_nodes) in c.each_boundary() {
        for (j, b, b_nodes) in c.each_boundary().skip(i + 1) {
            if a.link.is_none() && b.link.is_none() {
                continue;
            }
            let source = c.pose(j);
            let inner = Source { record: b, nodes: b_nodes, view: c.outline(j, b), table: &[] };
            let (mut energy, mut force, mut moment_a, mut moment_b) =
                (R::zero(), Complex::default(), R::zero(), R::zero());
            let shift = source.unturned(c.pose(i).origin - source.origin);
            for (z, d) in targets(&a_nodes, c.pose(i), source).zip(a_nodes.tangents()) {
                let mut sums = Sums::default();
                let close = if tables.is_empty() { None } else { inner.footprint(z) };
                match close {
                    Some((t, beta)) => close_range::each_node(&inner.view.curve, tables, t, beta, |x, ds| {
                        sums.add(z, x - b.origin, ds, alpha);
                    }),
                    None => {
                        for (x, dx) in b_nodes.points().zip(b_nodes.tangents()) {
                            sums.add(z, x, (dx.re * dx.re + dx.im * dx.im).sqrt() * b_nodes.step, alpha);
                        }
                    }
                }
                let ds = cabs(d) * a_nodes.step;
                let (arm, f) = (z - shift, sums.force);
                energy += sums.energy * ds;
                force += f * ds;
                moment_a += (arm.re * f.im - arm.im * f.re) * ds;
                moment_b += sums.moment * ds;
            }
            visit(i, j, energy, source.turned(force), moment_a, moment_b);
        }
    }
}

/// V, J/m.
pub(crate) fn energy<R: Real>(c: &Configuration<'_, R>, law: Repulsion<R>) -> R {
    let mut sum = R::zero();
    each_pair(c, law.alpha, |_, _, e, _, _, _| sum += e);
    sum * law.epsilon
}

/// Adds ∂V/∂q.
pub(crate) fn add_gradient<R: Real>(c: &Configuration<'_, R>, law: Repulsion<R>, out: &mut [R]) {
    let scale = -law.alpha * law.epsilon;
    each_pair(c, law.alpha, |i, j, _, force, moment_i, moment_j| {
        add_three(c, i, force * scale, moment_i * scale, out);
        add_three(c, j, -force * scale, -moment_j * scale, out);
    });
}
