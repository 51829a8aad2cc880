//! Natural sizes of forces, by which errors are measured.

use crate::base::memory::inner;
use crate::base::scalar::Real;
use crate::model::Model;

/// The largest of forces and of torques over the reach of their links.
pub(crate) fn largest_force<R: Real>(model: &Model<'_, R>, force: &[R]) -> R {
    let reaches = model.boundaries.iter().filter(|b| b.link.is_some()).map(|b| b.reach);
    force.chunks_exact(3).zip(reaches).fold(R::zero(), |most, (f, reach)| match f {
        &[x, y, torque] => most.max(x.abs()).max(y.abs()).max(torque.abs() / reach),
        _ => most,
    })
}

/// A force's natural size: the largest one, or what the motion could exert, its energy over a length, where forces cancel.
pub(crate) fn force_scale<R: Real>(model: &Model<'_, R>, force: &[R], momentum: &[R], velocity: &[R]) -> R {
    let size = model.boundaries.iter().filter(|b| b.link.is_some()).fold(R::zero(), |m, b| m.max(b.reach));
    largest_force(model, force).max(inner(momentum, velocity) * R::HALF / size)
}
