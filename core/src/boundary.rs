//! Nodes of one boundary in its own frame, and what rigid motion leaves unchanged: the self block of the
//! matrix and the interior potential of rotation.
//!
//! With n out of the fluid and G = (sign/π) W, W_ik ≈ ∫ ds Γ'/(Γ − z_i): sign = −1 on links and obstacles, +1 on
//! the tank. The matrix is A = I − Im G. On one boundary W is a principal value:
//! W_ik = h Γ'_k/(Γ_k − Γ_i) − (−1)^(k−i) (h/2) cot((s_k − s_i)/2), W_ii = h Γ''_i/(2Γ'_i); the cotangent is real
//! and matters only for Re G.

use crate::curve::Outline;
use crate::lu::{Factors, factor};
use crate::scalar::{Complex, Real, complex, dot};
use crate::scene::Shape;
use crate::se2::Pose;
use crate::status::{Place, Result, Status};
use crate::workspace::{part, part_mut, put, take};

/// One boundary of the fluid.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryRecord<R> {
    /// Where it stands in the scene.
    pub place: Place,
    /// Link that carries it; `None` for a wall.
    pub link: Option<usize>,
    /// −1 for links and obstacles, +1 for the tank.
    pub sign: R,
    /// Number of nodes.
    pub nodes: usize,
    /// First unknown.
    pub first: usize,
    /// Compiled shape.
    pub outline: Outline<R>,
    /// Where the shape's numbers are in the store.
    pub store_at: usize,
    /// How many they are.
    pub store_len: usize,
    /// Origin of the boundary's frame in the shape's drawing frame.
    pub origin: Complex<R>,
    /// Where the node arrays are in the store.
    pub data_at: usize,
    /// Where the self block of A is in the store (links only).
    pub self_at: usize,
    /// Where Re G of the self block is in the store (links with circulation in the scene only).
    pub regular_at: usize,
    /// Circulation.
    pub circulation: R,
    /// Its isolated circulatory flow.
    pub core: Core<R>,
    /// Placement of a wall.
    pub pose: Pose<R>,
    /// Greatest distance of the outline from the frame's origin.
    pub reach: R,
    /// Greatest distance between neighbouring nodes.
    pub spacing: R,
    /// What set-up noticed.
    pub notice: Status,
}

/// Isolated circulatory flow of one boundary, analytic outside: log z' about a point, or log W of an ellipse.
#[derive(Clone, Copy, Debug, Default)]
pub struct Core<R> {
    /// Origin of z' in the boundary's frame.
    pub centre: Complex<R>,
    /// Semi-axes of an ellipse; (0, 0) for a point vortex.
    pub axes: [R; 2],
}

impl<R: Real> Default for BoundaryRecord<R> {
    fn default() -> Self {
        BoundaryRecord {
            place: Place::Scene,
            link: None,
            sign: -R::one(),
            nodes: 0,
            first: 0,
            outline: Outline::default(),
            store_at: 0,
            store_len: 0,
            origin: Complex::default(),
            data_at: 0,
            self_at: 0,
            regular_at: 0,
            circulation: R::zero(),
            core: Core::default(),
            pose: Pose::default(),
            reach: R::zero(),
            spacing: R::zero(),
            notice: Status::Ok,
        }
    }
}

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
    /// Interior potential of rotation (empty for walls and without fluid).
    pub chi: &'a [R],
    /// Step h = 2π/N of the parameter s.
    pub step: R,
}

impl<R: Real> BoundaryRecord<R> {
    /// Reals of the node arrays.
    pub(crate) fn data_len(nodes: usize, with_chi: bool) -> Option<usize> {
        nodes.checked_mul(if with_chi { 6 } else { 5 })
    }
    pub(crate) fn nodes<'a>(&self, store: &'a [R]) -> Nodes<'a, R> {
        let column = |k: usize| part(store, self.data_at + k * self.nodes, self.nodes);
        Nodes {
            x: column(0),
            y: column(1),
            dx: column(2),
            dy: column(3),
            t: column(4),
            chi: if self.link.is_some() { column(5) } else { &[] },
            step: R::TAU / R::count(self.nodes.max(1)),
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
}

/// Fills the node arrays x, y, x', y', t of a boundary whose frame origin is known, and its reach and spacing.
pub(crate) fn fill_nodes<R: Real>(record: &mut BoundaryRecord<R>, store: &mut [R]) -> Result<()> {
    let n = record.nodes;
    let (mut reach, mut speed) = (R::zero(), R::zero());
    for k in 0..n {
        let node = record.outline.view(part(store, record.store_at, record.store_len)).node(k, n)?;
        let x = node.x - record.origin;
        for (c, value) in [x.re, x.im, node.dx.re, node.dx.im, node.t].into_iter().enumerate() {
            put(store, record.data_at + c * n + k, value);
        }
        reach = reach.max(crate::scalar::cabs(x));
        speed = speed.max(crate::scalar::cabs(node.dx));
    }
    record.spacing = speed * R::TAU / R::count(n.max(1));
    // The outline may bulge beyond its nodes by at most half a spacing.
    record.reach = reach + record.spacing * R::HALF;
    if reach.is_finite() && speed.is_finite() { Ok(()) } else { Err(Status::NotFinite.into()) }
}

/// Calls `entry(i, k, Im W_ik, Re W_ik)` for the self block. O(N²); the cotangents of Re W cost a sine each.
pub(crate) fn self_weights<R: Real>(
    record: &BoundaryRecord<R>,
    store: &[R],
    mut entry: impl FnMut(usize, usize, R, R),
) -> Result<()> {
    let n = record.nodes;
    let nodes = record.nodes(store);
    let h = nodes.step;
    for (k, (g, dg)) in nodes.points().zip(nodes.tangents()).enumerate() {
        let ddg = record.outline.view(part(store, record.store_at, record.store_len)).node(k, n)?.ddx;
        for (i, z) in nodes.points().enumerate() {
            if i == k {
                let w = ddg / dg * (h * R::HALF);
                entry(i, k, w.im, w.re);
            } else {
                let w = dg / (g - z) * h;
                let half = R::count(k.abs_diff(i)) * h * R::HALF;
                let (s, c) = half.sin_cos();
                let cot = if k > i { c / s } else { -c / s };
                let cot = if k.abs_diff(i) % 2 == 0 { cot } else { -cot };
                entry(i, k, w.im, w.re - cot * h * R::HALF);
            }
        }
    }
    Ok(())
}

/// χ₃: the function harmonic inside the outline with the normal derivative of the rotation about the frame's
/// origin. Closed form for an ellipse; otherwise one interior solve, (I − Im W/π + 1/N) χ = −Re W/π |X|²/2, in
/// `scratch` (N² + N reals). O(N³) once.
pub(crate) fn rotation_potential<R: Real>(
    record: &BoundaryRecord<R>,
    shape: &Shape<'_, R>,
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    let n = record.nodes;
    let chi_at = record.data_at + 5 * n;
    if let Shape::Ellipse { a, b } = *shape {
        let ratio = (a * a - b * b) / (a * a + b * b);
        for k in 0..n {
            let nodes = record.nodes(store);
            let x = complex(crate::workspace::at(nodes.x, k), crate::workspace::at(nodes.y, k));
            // About the centre: ratio·x y. The frame's origin is off the centre by `origin`: rotation about it
            // differs by the translation −i·origin, whose potential is linear.
            let centred = x + record.origin;
            let shift = complex(record.origin.im, -record.origin.re);
            put(store, chi_at + k, ratio * centred.re * centred.im + dot(shift, x));
        }
        return Ok(());
    }
    let mut rest = scratch;
    let matrix = take(&mut rest, n * n + n)?;
    let pivots = take(&mut rest, n)?;
    let (block, rhs) = matrix.split_at_mut_checked(n * n).ok_or(Status::Internal)?;
    let constant = R::one() / R::count(n);
    for x in rhs.iter_mut() {
        *x = R::zero();
    }
    {
        let nodes = record.nodes(store);
        self_weights(record, store, |i, k, im, re| {
            let identity = if i == k { R::one() } else { R::zero() };
            put(block, k * n + i, identity - im / R::PI + constant);
            let x = complex(crate::workspace::at(nodes.x, k), crate::workspace::at(nodes.y, k));
            crate::workspace::add(rhs, i, -re / R::PI * dot(x, x) * R::HALF);
        })?;
    }
    factor(matrix, n, n, pivots)?;
    let (block, rhs) = matrix.split_at_mut_checked(n * n).ok_or(Status::Internal)?;
    Factors { lu: block, ld: n, pivots }.back_substitute(rhs);
    crate::workspace::copy(part_mut(store, chi_at, n), rhs);
    Ok(())
}

/// Fills the self block of A = I − Im G (column-major, N × N) and, if asked for, of Re G.
pub(crate) fn fill_self_block<R: Real>(
    record: &BoundaryRecord<R>,
    store: &[R],
    block: &mut [R],
    regular: &mut [R],
) -> Result<()> {
    let n = record.nodes;
    let factor = record.sign / R::PI;
    self_weights(record, store, |i, k, im, re| {
        let identity = if i == k { R::one() } else { R::zero() };
        put(block, k * n + i, identity - factor * im);
        put(regular, k * n + i, factor * re);
    })
}
