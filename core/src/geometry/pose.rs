//! Rigid placements and velocities of the plane.

use crate::base::complex::{Complex, cis, complex, perp};
use crate::base::scalar::Real;

/// Placement of a frame: `x_world = origin + turn · x_frame`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<R> {
    /// Origin of the frame in the world.
    pub origin: Complex<R>,
    /// Unit number: heading of the frame.
    pub turn: Complex<R>,
}

impl<R: Real> Default for Pose<R> {
    fn default() -> Self {
        Pose { origin: Complex::default(), turn: complex(R::one(), R::zero()) }
    }
}

impl<R: Real> Pose<R> {
    /// From position and heading.
    pub fn new(x: R, y: R, theta: R) -> Self {
        Pose { origin: complex(x, y), turn: cis(theta) }
    }
    /// Offset from this frame's origin, in world directions, of a point given in the frame.
    #[inline]
    pub fn turned(&self, x: Complex<R>) -> Complex<R> {
        self.turn * x
    }
    /// A world vector in the frame's directions.
    #[inline]
    pub fn unturned(&self, x: Complex<R>) -> Complex<R> {
        self.turn.conj() * x
    }
    /// World position of a point given in the frame.
    #[inline]
    pub fn place(&self, x: Complex<R>) -> Complex<R> {
        self.origin + self.turn * x
    }
}

/// Velocity of a frame: linear velocity of its origin (world directions) and angular velocity.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Twist<R> {
    /// Linear velocity of the origin.
    pub linear: Complex<R>,
    /// Angular velocity.
    pub angular: R,
}

impl<R: Real> Twist<R> {
    /// Velocity of the material point at world offset `arm` from the origin.
    #[inline]
    pub fn at(&self, arm: Complex<R>) -> Complex<R> {
        self.linear + perp(arm) * self.angular
    }
}
