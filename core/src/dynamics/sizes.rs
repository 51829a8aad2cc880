//! Natural sizes of forces, by which errors are measured.
//!
//! Tested by `tests/indicators`, above all by independence of the unit of length.

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

/// The largest ratio, over the links, of a difference of forces to what a force on that link is measured by: itself, the energy of its
/// own motion over its reach, or the largest force on any link, less by as much as the link is smaller than the largest. Torques count
/// over the reach.
pub(crate) fn relative_force<R: Real>(
    model: &Model<'_, R>,
    difference: &[R],
    force: &[R],
    momentum: &[R],
    velocity: &[R],
) -> R {
    let links = || model.boundaries.iter().filter(|b| b.link.is_some());
    let size = |f: &[R], reach: R| match f {
        &[x, y, torque] => x.abs().max(y.abs()).max(torque.abs() / reach),
        _ => R::zero(),
    };
    let reach = links().fold(R::zero(), |m, b| m.max(b.reach));
    let all = largest_force(model, force).max(inner(momentum, velocity) * R::HALF / reach);
    let motions = momentum.chunks_exact(3).zip(velocity.chunks_exact(3));
    let forces = difference.chunks_exact(3).zip(force.chunks_exact(3)).zip(motions);
    links().zip(forces).fold(R::zero(), |most, (b, ((difference, force), (p, v)))| {
        let own = size(force, b.reach).max(inner(p, v).abs() * R::HALF / b.reach).max(all * b.reach / reach);
        if own > R::zero() { most.max(size(difference, b.reach) / own) } else { most }
    })
}
