//! Gravity and buoyancy (2.8), (2.16): P = g Σ [m_i y_i − m_f (y_i + c₂)], m_f = ρ·area, c the turned vector from
//! the centre of mass to the area centroid. O(links).
//!
//! Tested by `tests/offset_mass`, `tests/gradients`, `tests/circulation.rs:heavy_disc_with_circulation_drifts_along_a_trochoid`,
//! `tests/conservation`.

use crate::base::memory::{add, at};
use crate::base::scalar::Real;
use crate::geometry::pose::{Poses, twist_of};
use crate::model::Model;

/// Potential energy, J/m.
pub(crate) fn energy<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, q: &[R]) -> R {
    let walls = model.head.plan.walls;
    model.links.iter().enumerate().fold(R::zero(), |sum, (i, link)| {
        let displaced = model.head.fluid_density * link.area;
        let c = poses.get(walls + i).turned(link.centroid);
        let y = at(q, 3 * i + 1);
        sum + model.head.gravity * (link.mass * y - displaced * (y + c.im))
    })
}

/// Adds ∂P/∂q.
pub(crate) fn add_gradient<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, out: &mut [R]) {
    let (walls, g) = (model.head.plan.walls, model.head.gravity);
    for (i, link) in model.links.iter().enumerate() {
        let displaced = model.head.fluid_density * link.area;
        let c = poses.get(walls + i).turned(link.centroid);
        add(out, 3 * i + 1, g * (link.mass - displaced));
        add(out, 3 * i + 2, -g * displaced * c.re);
    }
}

/// Adds the derivative of the gradient by masses (0) and by the density of the fluid (1), times two numbers: at `gravity` and with these
/// numbers for the masses' share and the density.
#[cfg(feature = "derivatives")]
pub(crate) fn add_slope<R: Real>(
    model: &Model<'_, R>,
    poses: Poses<'_, R>,
    gravity: R,
    [masses, density]: [R; 2],
    out: &mut [R],
) {
    let walls = model.head.plan.walls;
    for (i, link) in model.links.iter().enumerate() {
        let (c, displaced) = (poses.get(walls + i).turned(link.centroid), density * link.area);
        add(out, 3 * i + 1, gravity * (masses * link.mass - displaced));
        add(out, 3 * i + 2, -gravity * displaced * c.re);
    }
}

/// Adds ∂²P/∂q² · 3n × 3n, column-major.
#[cfg(feature = "derivatives")]
pub(crate) fn add_hessian<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, out: &mut [R]) {
    let (walls, g, n) = (model.head.plan.walls, model.head.gravity, 3 * model.links.len());
    for (i, link) in model.links.iter().enumerate() {
        let c = poses.get(walls + i).turned(link.centroid);
        add(out, (3 * i + 2) * (n + 1), g * model.head.fluid_density * link.area * c.im);
    }
}

/// ½ Σ m |v|² + I ω², J/m.
pub(crate) fn kinetic_bodies<R: Real>(model: &Model<'_, R>, qd: &[R]) -> R {
    model.links.iter().enumerate().fold(R::zero(), |sum, (i, link)| {
        let v = twist_of(qd, i);
        sum + (link.mass * crate::base::complex::dot(v.linear, v.linear) + link.inertia * v.angular * v.angular)
            * R::HALF
    })
}
