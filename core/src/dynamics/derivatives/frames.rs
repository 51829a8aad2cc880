//! What the turning of the links' frames adds to the derivatives of the fluid's force: everything that does not come from pairs.
//!
//! (J_b x)_l turns the linear part of link l by +90° if b is the angle of link l; J_v x = Σ ω_l J_θl x. With M = M^f, p = M q̇,
//! R_ab = P_ab − (J_b e_a)·p − (M J_b q̇)_a = ∂p_a/∂q_b at fixed q̇:
//!
//! C = M_v − J_vᵀ M − M J_v + R − Rᵀ,
//! H_ab = Q_ab − ½ Y_ab − (J_vᵀ P)_ab + (J_a q̇)·P_b + (J_b q̇)·P_a − (J_b e_a)·(M q̈ + M_v q̇ − M J_v q̇) − (M J_b q̈)_a − (M_v J_b q̇)_a
//!  + (M J_v J_b q̇)_a + (J_v e_a)·M J_b q̇ + (J_b J_v e_a)·p − (J_a J_b q̇)·p − (J_a q̇)·M J_b q̇.
//!
//! Tested by `tests/derivatives`.

use crate::base::memory::{add, at, put};
use crate::base::scalar::Real;
use crate::dynamics::derivatives::Derivatives;

/// A square matrix, column-major.
#[derive(Clone, Copy)]
struct Square<'a, R> {
    data: &'a [R],
    n: usize,
}

impl<R: Real> Square<'_, R> {
    #[inline]
    fn get(&self, a: usize, b: usize) -> R {
        at(self.data, b * self.n + a)
    }
    /// (A x)_a.
    fn times(&self, x: &[R], a: usize) -> R {
        x.iter().enumerate().fold(R::zero(), |sum, (c, x)| sum + self.get(a, c) * *x)
    }
    /// (A J_θl x)_a: the linear part of link l of x alone, turned.
    #[inline]
    fn turned(&self, x: &[R], a: usize, l: usize) -> R {
        self.get(a, 3 * l + 1) * at(x, 3 * l) - self.get(a, 3 * l) * at(x, 3 * l + 1)
    }
}

/// Whether a coordinate is an angle.
fn is_angle(a: usize) -> bool {
    a % 3 == 2
}

/// (J_θl e_a)·x for the coordinate a of link l.
#[inline]
fn turned_unit<R: Real>(a: usize, x: impl Fn(usize) -> R) -> R {
    let l = a / 3;
    match a % 3 {
        0 => x(3 * l + 1),
        1 => -x(3 * l),
        _ => R::zero(),
    }
}

/// R_ab = ∂(M q̇)_a/∂q_b at fixed q̇, of the fluid.
fn momentum_slope<R: Real>(
    m: &Square<'_, R>,
    slope: &Square<'_, R>,
    qd: &[R],
    p: impl Fn(usize) -> R,
    a: usize,
    b: usize,
) -> R {
    let mut r = slope.get(a, b);
    if is_angle(b) {
        if a / 3 == b / 3 {
            r -= turned_unit(a, &p);
        }
        r -= m.turned(qd, a, b / 3);
    }
    r
}

/// `out = R`, 3n × 3n.
pub(crate) fn momentum_slopes<R: Real>(qd: &[R], mass: &[R], slope: &[R], p: &[R], out: &mut [R]) {
    let n = qd.len();
    let (m, slope) = (Square { data: mass, n }, Square { data: slope, n });
    for b in 0..n {
        for a in 0..n {
            put(out, b * n + a, momentum_slope(&m, &slope, qd, |k| at(p, k), a, b));
        }
    }
}

/// Adds H and C of the fluid, formed from M^f, M_v, P, Q, Y.
pub(crate) fn complete<R: Real>(qd: &[R], qdd: &[R], d: &mut Derivatives<'_, R>) {
    let n = qd.len();
    let Derivatives { mass, mass_rate, slope, mixed, hessian, position, velocity, .. } = d;
    let square = |data| Square { data, n };
    let (m, mv, p_ab, q, y) =
        (square(&**mass), square(&**mass_rate), square(&**slope), square(&**mixed), square(&**hessian));
    let spin = |l: usize| at(qd, 3 * l + 2);
    // Vectors are formed anew where they are needed: n is small, and they need no memory.
    let momentum = |a: usize| m.times(qd, a);
    let m_turning = |a: usize| (0..n / 3).fold(R::zero(), |sum, l| sum + spin(l) * m.turned(qd, a, l));
    let inertial = |a: usize| m.times(qdd, a) + mv.times(qd, a) - m_turning(a);
    for b in 0..n {
        for a in 0..n {
            let (i, j) = (a / 3, b / 3);
            // J_vᵀ M, M J_v.
            let left = spin(i) * turned_unit(a, |k| m.get(k, b));
            let right = spin(j) * turned_unit(b, |k| m.get(a, k));
            let r = momentum_slope(&m, &p_ab, qd, momentum, a, b) - momentum_slope(&m, &p_ab, qd, momentum, b, a);
            add(velocity, b * n + a, mv.get(a, b) - left - right + r);
            let mut h = q.get(a, b) - y.get(a, b) * R::HALF - spin(i) * turned_unit(a, |k| p_ab.get(k, b));
            // (J_a q̇)·P_b and (J_b q̇)·P_a.
            let along = |angle: usize, column: usize| {
                let l = angle / 3;
                p_ab.get(3 * l + 1, column) * at(qd, 3 * l) - p_ab.get(3 * l, column) * at(qd, 3 * l + 1)
            };
            if is_angle(a) {
                h += along(a, b);
            }
            if is_angle(b) {
                h += along(b, a) - m.turned(qdd, a, j) - mv.turned(qd, a, j);
                // J_v J_b q̇ = −ω_j of the linear part.
                h -= spin(j) * (m.get(a, 3 * j) * at(qd, 3 * j) + m.get(a, 3 * j + 1) * at(qd, 3 * j + 1));
                h += spin(i) * turned_unit(a, |k| m.turned(qd, k, j));
                if i == j {
                    h -= turned_unit(a, inertial);
                    if !is_angle(a) {
                        h -= spin(j) * momentum(a);
                    }
                }
                if a == b {
                    h += at(qd, 3 * j) * momentum(3 * j) + at(qd, 3 * j + 1) * momentum(3 * j + 1);
                }
                if is_angle(a) {
                    // (J_a q̇)·M J_b q̇.
                    h -= at(qd, 3 * i) * m.turned(qd, 3 * i + 1, j) - at(qd, 3 * i + 1) * m.turned(qd, 3 * i, j);
                }
            }
            add(position, b * n + a, h);
        }
    }
}
