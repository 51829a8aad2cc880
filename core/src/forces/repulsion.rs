//! Repulsion: V = ε Σ_pairs ∬ |x − x'|^(−α) ds ds' over pairs of boundaries of which one moves (5.1), by the product
//! trapezoidal rule, and its exact gradient
//! ∂V/∂q_a = −α ε Σ ∬ |x − x'|^(−α−2) (x − x')·w_a ds ds'. (The printed (5.2) is wrong: docs/physics.md.) O(N²).

use crate::christoffel::add_three;
use crate::configuration::{Configuration, targets};
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

/// Visits every pair once: calls back with the sums over its nodes of |d|^(−α), and of |d|^(−α−2) d (and its moments about
/// both origins), d from the second boundary to the first, in world directions.
fn each_pair<R: Real>(c: &Configuration<'_, R>, alpha: R, mut visit: impl FnMut(usize, usize, R, Complex<R>, R, R)) {
    for (i, a, a_nodes) in c.each_boundary() {
        for (j, b, b_nodes) in c.each_boundary().skip(i + 1) {
            if a.link.is_none() && b.link.is_none() {
                continue;
            }
            let source = c.pose(j);
            let (mut energy, mut force, mut moment_a, mut moment_b) =
                (R::zero(), Complex::default(), R::zero(), R::zero());
            let shift = source.unturned(c.pose(i).origin - source.origin);
            for (z, d) in targets(&a_nodes, c.pose(i), source).zip(a_nodes.tangents()) {
                let (mut e, mut f, mut m) = (R::zero(), Complex::default(), R::zero());
                for (x, dx) in b_nodes.points().zip(b_nodes.tangents()) {
                    let arm = z - x;
                    let square = arm.re * arm.re + arm.im * arm.im;
                    let power = inverse_power(square, alpha) * (dx.re * dx.re + dx.im * dx.im).sqrt();
                    e += power;
                    let strength = arm * (power / square);
                    f += strength;
                    m += x.re * strength.im - x.im * strength.re;
                }
                let ds = cabs(d) * a_nodes.step * b_nodes.step;
                let arm = z - shift;
                energy += e * ds;
                force += f * ds;
                moment_a += (arm.re * f.im - arm.im * f.re) * ds;
                moment_b += m * ds;
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
