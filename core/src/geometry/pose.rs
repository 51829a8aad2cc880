//! Rigid placements and velocities of the plane, and the slices of reals that hold many of them.

use crate::base::complex::{Complex, cis, complex, perp};
use crate::base::memory::{copy, part, part_mut};
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

/// Placements of all boundaries, kept as four reals each.
#[derive(Clone, Copy)]
pub(crate) struct Poses<'a, R>(pub &'a [R]);

impl<R: Real> Poses<'_, R> {
    #[inline]
    pub(crate) fn get(&self, boundary: usize) -> Pose<R> {
        match part(self.0, 4 * boundary, 4) {
            &[x, y, c, s] => Pose { origin: complex(x, y), turn: complex(c, s) },
            _ => Pose::default(),
        }
    }
}

/// Writes a placement.
pub(crate) fn put_pose<R: Real>(poses: &mut [R], boundary: usize, pose: &Pose<R>) {
    let values = [pose.origin.re, pose.origin.im, pose.turn.re, pose.turn.im];
    copy(part_mut(poses, 4 * boundary, 4), &values);
}

/// Turn and shift from one boundary's frame to another's.
#[inline]
pub(crate) fn relative<R: Real>(pose: Pose<R>, source: Pose<R>) -> (Complex<R>, Complex<R>) {
    (source.unturned(pose.turn), source.unturned(pose.origin - source.origin))
}

/// The twist of link `i` in a vector of three reals per link.
#[inline]
pub(crate) fn twist_of<R: Real>(rates: &[R], i: usize) -> Twist<R> {
    match part(rates, 3 * i, 3) {
        &[x, y, w] => Twist { linear: complex(x, y), angular: w },
        _ => Twist::default(),
    }
}

/// Writes three reals of link `i`.
#[inline]
pub(crate) fn put_three<R: Real>(rates: &mut [R], i: usize, linear: Complex<R>, angular: R) {
    for (slot, value) in part_mut(rates, 3 * i, 3).iter_mut().zip([linear.re, linear.im, angular]) {
        *slot = value;
    }
}
