//! The nodes of one boundary in its own frame, and where they are in another's.

use crate::base::complex::{Complex, cabs, complex};
use crate::base::memory::{part, put};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::geometry::curve::OutlineView;
use crate::geometry::pose::{Pose, relative};

/// Node arrays of one boundary in its own frame (origin: centre of mass, or the drawing origin of a wall).
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a, R> {
    /// x of the nodes.
    pub x: &'a [R],
    /// y of the nodes.
    pub y: &'a [R],
    /// dx/ds.
    pub dx: &'a [R],
    /// dy/ds.
    pub dy: &'a [R],
    /// Outline parameter t.
    pub t: &'a [R],
    /// d²x/ds².
    pub ddx: &'a [R],
    /// d²y/ds².
    pub ddy: &'a [R],
    /// Interior potential of rotation (empty for walls and without fluid).
    pub chi: &'a [R],
    /// Step h = 2π/N of the parameter s.
    pub step: R,
}

impl<'a, R: Real> Nodes<'a, R> {
    /// Reads the columns x, y, x', y', t, x'', y'', χ of `n` nodes (without the last: χ is empty).
    pub(crate) fn read(data: &'a [R], n: usize) -> Self {
        let column = |k: usize| part(data, k * n, n);
        Nodes {
            x: column(0),
            y: column(1),
            dx: column(2),
            dy: column(3),
            t: column(4),
            ddx: column(5),
            ddy: column(6),
            chi: data.get(7 * n..8 * n).unwrap_or(&[]),
            step: R::TAU / R::count(n.max(1)),
        }
    }
}

impl<R: Real> Nodes<'_, R> {
    /// Positions.
    #[inline]
    pub(crate) fn points(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.x.iter().zip(self.y).map(|(x, y)| complex(*x, *y))
    }
    /// Tangents dΓ/ds.
    #[inline]
    pub(crate) fn tangents(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.dx.iter().zip(self.dy).map(|(x, y)| complex(*x, *y))
    }
    /// d²Γ/ds².
    #[inline]
    pub(crate) fn seconds(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.ddx.iter().zip(self.ddy).map(|(x, y)| complex(*x, *y))
    }
}

/// Writes the columns x, y, x', y', t, x'', y'' of `n` nodes about `origin`; returns the largest distance from it and the
/// largest speed.
pub(crate) fn write_nodes<R: Real>(
    view: &OutlineView<'_, R>,
    origin: Complex<R>,
    n: usize,
    data: &mut [R],
) -> Result<(R, R)> {
    let (mut reach, mut speed) = (R::zero(), R::zero());
    let mut k = 0;
    view.walk(n, |node| {
        let x = node.x - origin;
        let values = [x.re, x.im, node.dx.re, node.dx.im, node.t, node.ddx.re, node.ddx.im];
        for (c, value) in values.into_iter().enumerate() {
            put(data, c * n + k, value);
        }
        reach = reach.max(cabs(x));
        speed = speed.max(cabs(node.dx));
        k += 1;
    })?;
    Ok((reach, speed))
}

/// Nodes of one boundary in another's frame: z = conj(turn_j)(r_i − r_j + turn_i X). Differences of origins are
/// taken first, so a scene far from the world's origin loses no digits.
#[inline]
pub(crate) fn targets<'a, R: Real>(
    nodes: &'a Nodes<'a, R>,
    pose: Pose<R>,
    source: Pose<R>,
) -> impl Iterator<Item = Complex<R>> + 'a {
    let (turn, shift) = relative(pose, source);
    nodes.points().map(move |x| shift + turn * x)
}

/// Writes the nodes of one boundary in another's frame.
pub(crate) fn fill_targets<R: Real>(nodes: &Nodes<'_, R>, pose: Pose<R>, source: Pose<R>, zx: &mut [R], zy: &mut [R]) {
    for ((x, y), z) in zx.iter_mut().zip(zy).zip(targets(nodes, pose, source)) {
        (*x, *y) = (z.re, z.im);
    }
}
