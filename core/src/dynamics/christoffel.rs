//! The Christoffel force as the exact gradient of the discrete added mass, and the paper's (2.15) beside it.
//!
//! With v the velocity, A u = −2 X v and Aᵀ λ = B v, the derivative of the discrete added mass along any motion of
//! the boundaries is vᵀ dM_h v = λᵀ Im(dG) u: only the blocks between different boundaries contribute, through
//! D = dW/dz. One pass over the pairs gives the rate a = Im(ż ∘ D u) along the actual motion, and
//! g_a = q̇ᵀ (∂M/∂q_a) q̇. Then F = (T₁ + T₂)/2 + J p − M J q̇ − g/2 with T₁ = Bᵀ A⁻¹ a, T₂ = −2 Xᵀ A⁻ᵀ l,
//! l = Im((λ ż)ᵀ D) from the same pass, p = M q̇, (J v)_i = ω_i (−v_y, v_x, 0). Either half alone delivers the discrete
//! power; their mean is the derivative of the symmetrized M and so delivers the discrete impulse too.

use crate::base::complex::{Complex, cabs, complex, dot, perp};
use crate::base::memory::{copy, part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::geometry::pose::twist_of;

/// Completes a force of per-unit-density quantities in world directions, in place:
/// `force += J p − g/2`, where the angular part of g also holds the turning of the frames.
pub(crate) fn add_frame_terms<R: Real>(links: usize, qd: &[R], momentum: &[R], gradient: &[R], force: &mut [R]) {
    for i in 0..links {
        let (v, p, g) = (twist_of(qd, i), twist_of(momentum, i), twist_of(gradient, i));
        let turning = R::TWO * (v.linear.im * p.linear.re - v.linear.re * p.linear.im);
        let linear = perp(p.linear) * v.angular - g.linear * R::HALF;
        let angular = -(g.angular + turning) * R::HALF;
        for (f, x) in part_mut(force, 3 * i, 3).iter_mut().zip([linear.re, linear.im, angular]) {
            *f += x;
        }
    }
}

/// (J v)_i = ω_i (−v_y, v_x, 0), subtracted: `out = base − J q̇`.
pub(crate) fn without_turning<R: Real>(links: usize, base: &[R], qd: &[R], out: &mut [R]) {
    copy(out, base);
    for i in 0..links {
        let v = twist_of(qd, i);
        let j = perp(v.linear) * v.angular;
        for (o, x) in part_mut(out, 3 * i, 3).iter_mut().zip([j.re, j.im, R::zero()]) {
            *o -= x;
        }
    }
}

/// The derivative by the boundary's parameter of samples at N equispaced parameters (the trigonometric
/// interpolant's; the highest mode's derivative is 0). O(N²), for cross-checks.
pub(crate) fn periodic_derivative<R: Real>(f: &[R], k: usize) -> R {
    let n = f.len();
    let h = R::PI / R::count(n.max(1));
    let mut sum = R::zero();
    for (j, fj) in f.iter().enumerate().filter(|(j, _)| *j != k) {
        let d = j.abs_diff(k);
        let (s, c) = (R::count(d) * h).sin_cos();
        let weight = if d % 2 == 0 { c / s } else { -c / s };
        // ½ (−1)^(k−j) cot((s_k − s_j)/2)
        sum += if k > j { *fj * weight } else { -*fj * weight };
    }
    sum * R::HALF
}

/// (2.15) per unit density: fills `kernel` so that the force is Σ ψ_a kernel, and adds to `out` (link frames) the part
/// that multiplies b_a. With ∂τ integrated by parts, −∫ ∂τψ_a ∂τψ v_n = ∫ ψ_a ∂τ(∂τψ v_n).
///
/// `potential` is ψ of the motion; `v` the links' velocities in their frames; `products` scratch of length N. O(N²).
pub(crate) fn boundary_formula<R: Real>(
    c: &Configuration<'_, R>,
    potential: &[R],
    v: &[R],
    kernel: &mut [R],
    products: &mut [R],
    out: &mut [R],
) {
    kernel.fill(R::zero());
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let twist = twist_of(v, link);
        let psi = part(potential, b.first, b.nodes);
        let product = part_mut(products, b.first, b.nodes);
        let kernel = part_mut(kernel, b.first, b.nodes);
        let (mut linear, mut angular) = (Complex::default(), R::zero());
        for (k, (x, d)) in nodes.points().zip(nodes.tangents()).enumerate() {
            let speed = cabs(d);
            // n = i T into the link, τ = i n = −T: ∂τ = −d/ds / speed.
            let normal = perp(d) / speed;
            let velocity = twist.at(x);
            let (xi, zeta) = (dot(velocity, perp(normal)), dot(velocity, normal));
            let slope = -periodic_derivative(psi, k) / speed;
            if let Some(p) = product.get_mut(k) {
                *p = slope * zeta;
            }
            let second = complex(periodic_derivative(nodes.dx, k), periodic_derivative(nodes.dy, k));
            let curvature = dot(perp(d), second) / (speed * speed * speed);
            let arm = dot(x, normal);
            let s =
                curvature * (xi * xi - zeta * zeta) + R::TWO * xi * twist.angular - arm * twist.angular * twist.angular;
            if let Some(g) = kernel.get_mut(k) {
                *g = s * speed * nodes.step;
            }
            let half = (slope * slope + zeta * zeta) * R::HALF * nodes.step;
            linear += perp(d) * half;
            angular += dot(x, d) * half;
        }
        for (k, g) in kernel.iter_mut().enumerate() {
            // ds ∂τ = −h d/ds
            *g -= periodic_derivative(product, k) * nodes.step;
        }
        for (o, x) in part_mut(out, 3 * link, 3).iter_mut().zip([linear.re, linear.im, angular]) {
            *o += x;
        }
    }
}
