//! Scene builders and measures for the tests in `tests/`.

use nekton::scalar::Real;
use nekton::scene::{Body, Drive, Joint, JointKind, Link, Mass, Root, Scene, Shape, Wall};
use nekton::status::{Error, Result};
use nekton::{BoundaryRecord, CoordinateRecord, LinkRecord, Method, Model, ModelBuf, ModelMemory, Sim, SimBuf};
use std::sync::Arc;

pub mod near;

pub mod drive_study;
pub mod extremes;
pub mod indicator_study;
pub mod long_run;
pub mod printed;
pub mod regrading;

/// A sequence of numbers, the same on every machine.
pub struct Numbers(u64);

impl Numbers {
    /// A sequence of its own for every seed but 0.
    pub fn new(seed: u64) -> Self {
        Numbers(seed)
    }
    /// The next number, from a range.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        from + (to - from) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    /// True in this share of cases.
    pub fn chance(&mut self, share: f64) -> bool {
        self.between(0.0, 1.0) < share
    }
}

/// What a scalar type allows; about ten times what is measured.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// Relative error of a value that is known in closed form and resolved in space.
    pub closed_form: f64,
    /// Tolerance that the variable-step method can fulfil with ease.
    pub integrator: f64,
    /// Relative change of a conserved quantity over a few seconds at that tolerance.
    pub conserved: f64,
}

/// The table of tolerances.
pub fn tolerances<R: Real>() -> Tolerances {
    if R::EPSILON.to_f64() > 1e-10 {
        Tolerances { closed_form: 3e-6, integrator: 1e-6, conserved: 4e-6 }
    } else {
        Tolerances { closed_form: 5e-15, integrator: 1e-11, conserved: 2e-10 }
    }
}

/// The example of the README.
#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;

/// A disc.
pub fn disc<R: Real>(radius: R) -> Shape<'static, R> {
    Shape::Ellipse { a: radius, b: radius }
}

/// A link without joint or circulation.
pub fn link<'a, R: Real>(shape: Shape<'a, R>, density: R, nodes: usize) -> Link<'a, R> {
    Link { shape, mass: Mass::Density(density), nodes, circulation: R::zero(), joint: None }
}

/// The same link hinged to link `parent`.
pub fn hinged<'a, R: Real>(
    link: Link<'a, R>,
    parent: usize,
    parent_anchor: [R; 2],
    self_anchor: [R; 2],
    drive: Drive<'a, R>,
) -> Link<'a, R> {
    Link { joint: Some(Joint { parent, kind: JointKind::Hinge, parent_anchor, self_anchor, drive }), ..link }
}

/// A free body.
pub fn body<'a, R: Real>(links: &'a [Link<'a, R>], pose: [R; 3], velocity: [R; 3]) -> Body<'a, R> {
    Body { pose, velocity, root: Root::Free, links }
}

/// A wall without circulation.
pub fn wall<'a, R: Real>(shape: Shape<'a, R>, position: [R; 2], angle: R, nodes: usize) -> Wall<'a, R> {
    Wall { shape, position, angle, nodes, circulation: R::zero() }
}

/// A simulation of a scene that must be accepted.
pub fn simulation<R: Real>(scene: &Scene<'_, R>, method: Method<R>) -> SimBuf<R> {
    let model = ModelBuf::new(scene).unwrap_or_else(|error| panic!("scene refused: {error}"));
    SimBuf::new(Arc::new(model), method).unwrap_or_else(|error| panic!("simulation refused: {error}"))
}

/// `adams` with the same relative and absolute tolerance.
pub fn adams<R: Real>(tolerance: f64) -> Method<R> {
    Method::adams(R::lit(tolerance), R::lit(tolerance))
}

/// A simulation that is only evaluated at its initial state.
pub fn at_start<R: Real>(scene: &Scene<'_, R>) -> SimBuf<R> {
    simulation(scene, Method::Rk4 { step: R::lit(0.01) })
}

/// Nodes of a scene's links with those that the rule gives by description alone, as without a heap.
pub fn nodes_by_rule<R: Real>(scene: &Scene<'_, R>) -> Vec<usize> {
    let need = Model::requirement(scene).unwrap();
    let (mut links, mut coordinates) =
        (vec![LinkRecord::default(); need.links], vec![CoordinateRecord::default(); need.coordinates]);
    let (mut boundaries, mut reals) = (vec![BoundaryRecord::default(); need.boundaries], vec![R::zero(); need.reals]);
    let memory = &mut ModelMemory {
        links: &mut links,
        coordinates: &mut coordinates,
        boundaries: &mut boundaries,
        reals: &mut reals,
    };
    let head = Model::init(scene, memory).unwrap();
    let model = Model::view(&head, &links, &coordinates, &boundaries, &reals);
    (0..need.links).filter_map(|i| model.link(i)).map(|l| l.nodes).collect()
}

/// The error with which a scene or its simulation is refused.
pub fn refusal(scene: &Scene<'_, f64>) -> Error {
    match ModelBuf::new(scene).and_then(|model| SimBuf::new(Arc::new(model), Method::Rk4 { step: 0.01 })) {
        Ok(_) => panic!("the scene was accepted"),
        Err(error) => error,
    }
}

/// Number of coordinates: three per link.
pub fn size<R: Real>(sim: &Sim<'_, R>) -> usize {
    sim.positions().len()
}

/// A vector-valued quantity with one entry per coordinate, such as `Sim::christoffel`.
pub fn vector<R: Real>(sim: &mut Sim<'_, R>, quantity: impl FnOnce(&mut Sim<'_, R>, &mut [R]) -> Result<()>) -> Vec<R> {
    let mut out = vec![R::NAN; size(sim)];
    quantity(sim, &mut out).unwrap_or_else(|error| panic!("not evaluated: {error}"));
    out
}

/// A matrix-valued quantity, such as `Sim::mass_matrix`, as its columns.
pub fn matrix<R: Real>(
    sim: &mut Sim<'_, R>,
    quantity: impl FnOnce(&mut Sim<'_, R>, &mut [R]) -> Result<()>,
) -> Vec<Vec<R>> {
    let n = size(sim);
    let mut out = vec![R::NAN; n * n];
    quantity(sim, &mut out).unwrap_or_else(|error| panic!("not evaluated: {error}"));
    out.chunks(n).map(<[R]>::to_vec).collect()
}

/// Matrix (as columns) times vector.
pub fn times(columns: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (column, x) in columns.iter().zip(x) {
        for (y, a) in y.iter_mut().zip(column) {
            *y += a * x;
        }
    }
    y
}

/// Scalar product.
pub fn inner(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// Solves a small dense system, given by columns, by elimination with row exchanges.
pub fn solve(columns: &[Vec<f64>], rhs: &[f64]) -> Vec<f64> {
    let n = rhs.len();
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| columns.iter().map(|c| c[i]).chain(std::iter::once(rhs[i])).collect()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).unwrap_or(k);
        rows.swap(k, pivot);
        let row = rows[k].clone();
        for other in rows.iter_mut().skip(k + 1) {
            let factor = other[k] / row[k];
            other.iter_mut().zip(&row).for_each(|(o, r)| *o -= factor * r);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x
}

/// Largest difference relative to the largest entry of `exact`.
pub fn difference<R: Real>(computed: &[R], exact: &[R]) -> f64 {
    assert_eq!(computed.len(), exact.len());
    let scale = exact.iter().fold(0.0, |m: f64, x| m.max(x.to_f64().abs()));
    let error = computed.iter().zip(exact).map(|(c, e)| (c.to_f64() - e.to_f64()).abs());
    // NaN must show, and `f64::max` would hide it.
    error.fold(0.0, |m: f64, e| if e <= m { m } else { e }) / scale
}

/// Asserts that `computed` agrees with `exact` within `tolerance`, relative to the largest entry of `exact`.
#[track_caller]
pub fn assert_close<R: Real>(computed: &[R], exact: &[R], tolerance: f64) {
    let error = difference(computed, exact);
    assert!(error <= tolerance, "error {error:.2e} > {tolerance:.0e}: {computed:?} against {exact:?}");
}

/// Asserts that two numbers agree within an absolute tolerance.
#[track_caller]
pub fn assert_near(computed: f64, exact: f64, tolerance: f64) {
    let error = (computed - exact).abs();
    assert!(error <= tolerance, "error {error:.2e} > {tolerance:.0e}: {computed:?} against {exact:?}");
}

/// Derivatives of `quantity` (of the simulation at its start) with respect to each coordinate of a scene of one-link
/// bodies: central differences of sixth order. `[a]` is the derivative with respect to coordinate a.
pub fn derivatives(scene: &Scene<'_, f64>, quantity: impl Fn(&mut Sim<'_, f64>) -> Vec<f64>) -> Vec<Vec<f64>> {
    // Truncation h⁶ f⁽⁷⁾/140 and rounding 1e-15/h both stay below 1e-11 for scenes of size 1 with gaps near 1.
    const STEP: f64 = 4e-3;
    const WEIGHTS: [f64; 3] = [45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0];
    let moved = |coordinate: usize, shift: f64| {
        let mut bodies = scene.bodies.to_vec();
        bodies[coordinate / 3].pose[coordinate % 3] += shift;
        quantity(&mut at_start(&Scene { bodies: &bodies, ..*scene }).view())
    };
    let mut rows = Vec::new();
    for coordinate in 0..3 * scene.bodies.len() {
        let mut row: Vec<f64> = Vec::new();
        for (k, weight) in WEIGHTS.iter().enumerate() {
            let shift = STEP * (k + 1) as f64;
            let (forward, back) = (moved(coordinate, shift), moved(coordinate, -shift));
            row.resize(forward.len(), 0.0);
            for ((r, f), b) in row.iter_mut().zip(forward).zip(back) {
                *r += weight * (f - b) / STEP;
            }
        }
        rows.push(row);
    }
    rows
}

/// The ellipse of the paper's example 9.2: half-axes 2 and 0.9, density 1.
pub fn paper_ellipse<R: Real>(nodes: usize) -> [Link<'static, R>; 1] {
    [link(Shape::Ellipse { a: R::lit(2.0), b: R::lit(0.9) }, R::one(), nodes)]
}

/// The paper's example 9.2: two such ellipses that pass each other in a fluid of density 1.
pub fn two_ellipses<'a, R: Real>(links: &'a [Link<'a, R>]) -> [Body<'a, R>; 2] {
    let (x, y, v) = (R::lit(2.0), R::lit(1.1), R::HALF);
    let zero = R::zero();
    [body(links, [x, -y, zero], [-v, zero, zero]), body(links, [-x, y, zero], [v, zero, zero])]
}
