//! Scenes that are timed.

use nekton::scalar::Real;
use nekton::scene::{Body, Drive, Joint, JointKind, Link, Mass, Harmonic, Quadrature, Root, Scene, Shape, Signal, Wall};
use nekton::{Method, ModelBuf, SimBuf};
use std::sync::Arc;

/// A right-hand side to be evaluated again and again at one state.
pub struct Evaluation<R: Real> {
    sim: SimBuf<R>,
    state: Vec<R>,
    rate: Vec<R>,
}

impl<R: Real> Evaluation<R> {
    /// Of a scene's initial state.
    pub fn new(scene: &Scene<'_, R>) -> Self {
        let mut sim = simulation(scene, Method::Rk4 { step: R::lit(1e-3) });
        let state = sim.view().state().to_vec();
        let rate = vec![R::zero(); state.len()];
        Self { sim, state, rate }
    }

    /// One evaluation of the equations of motion.
    pub fn run(&mut self) {
        self.sim.view().rhs(R::zero(), &self.state, &mut self.rate).expect("the scene can be evaluated");
        std::hint::black_box(&self.rate);
    }

    /// Accelerations (after [`Evaluation::run`]).
    pub fn accelerations(&self) -> &[R] {
        &self.rate[self.rate.len() / 2..]
    }

    /// Unknowns of the boundary system.
    pub fn unknowns(&mut self) -> usize {
        self.sim.view().model().plan().unknowns
    }
}

/// A simulation of a scene that must be accepted.
pub fn simulation<R: Real>(scene: &Scene<'_, R>, method: Method<R>) -> SimBuf<R> {
    let model = ModelBuf::new(scene).unwrap_or_else(|error| panic!("scene refused: {error}"));
    SimBuf::new(Arc::new(model), method).unwrap_or_else(|error| panic!("simulation refused: {error}"))
}

/// A link of density 1.2 without joint or circulation.
pub fn link<R: Real>(shape: Shape<'_, R>, nodes: usize) -> Link<'_, R> {
    Link { shape, mass: Mass::Density(R::lit(1.2)), nodes, circulation: R::zero(), joint: None }
}

/// An ellipse with semi-axes 1 and ½.
pub fn ellipse<R: Real>(nodes: usize) -> Link<'static, R> {
    link(Shape::Ellipse { a: R::one(), b: R::HALF }, nodes)
}

/// A rectangular array of bodies like `link` with the given gaps, all in motion, no two alike.
pub fn array<'a, R: Real>(link: &'a [Link<'a, R>; 1], columns: usize, rows: usize, gap: f64) -> Vec<Body<'a, R>> {
    let place = |i: usize| {
        let (column, row) = ((i % columns) as f64, (i / columns) as f64);
        let phase = i as f64;
        Body {
            pose: [column * (2.0 + gap), row * (1.0 + gap), 0.0].map(R::lit),
            velocity: [0.3 * phase.cos(), 0.3 * phase.sin(), 0.2 + 0.1 * phase.cos()].map(R::lit),
            root: Root::Free,
            links: link,
        }
    };
    (0..columns * rows).map(place).collect()
}

/// Fluid of density 1, no gravity.
pub fn scene<'a, R: Real>(bodies: &'a [Body<'a, R>], quadrature: Quadrature) -> Scene<'a, R> {
    Scene { bodies, quadrature, ..Scene::new(R::one(), R::zero()) }
}

/// Links in a row, hinged and beating as `beat` says.
pub fn swimmer<R: Real>(count: usize, nodes: usize, beat: &[Harmonic<R>]) -> Vec<Link<'_, R>> {
    let hinge = |parent| Joint {
        parent,
        kind: JointKind::Hinge,
        parent_anchor: [R::lit(-1.25), R::zero()],
        self_anchor: [R::lit(1.25), R::zero()],
        drive: Drive::Motion(Signal::Harmonic { terms: beat, window: None }),
    };
    (0..count).map(|i| Link { joint: (i > 0).then(|| hinge(i - 1)), ..ellipse(nodes) }).collect()
}

/// The two ellipses of the paper's section 9.2, which pass each other at a distance of 0.117.
pub fn passing<'a, R: Real>(link: &'a [Link<'a, R>; 1]) -> Vec<Body<'a, R>> {
    unimplemented!()
}

/// Obstacles around bodies: two long ellipses above and below.
pub fn banks<R: Real>(nodes: usize) -> [Wall<'static, R>; 2] {
    [3.0, -3.0].map(|y| Wall {
        shape: Shape::Ellipse { a: R::lit(4.0), b: R::one() },
        position: [R::zero(), R::lit(y)],
        angle: R::zero(),
        nodes,
        circulation: R::zero(),
    })
}
