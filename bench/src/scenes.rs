//! Scenes that are timed.

use nekton::scalar::Real;
use nekton::scene::{Body, Drive, Harmonic, Link, Quadrature, Root, Scene, Shape, Signal, Wall};
use nekton::{Factorization, Method, SimBuf};
use nekton_tests::{hinged, link, simulation, wall};

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

    /// From now on by this factorization.
    ///
    /// # Errors
    /// As `Sim::set_factorization`.
    pub fn factorize(&mut self, by: Factorization) -> nekton::Result<()> {
        self.sim.view().set_factorization(by)
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

/// An ellipse with semi-axes 1 and ½.
pub fn ellipse<R: Real>(nodes: usize) -> Link<'static, R> {
    link(Shape::Ellipse { a: R::one(), b: R::HALF }, R::lit(1.2), nodes)
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
    let (front, back) = ([R::lit(1.25), R::zero()], [R::lit(-1.25), R::zero()]);
    let drive = Drive::Motion(Signal::Harmonic { terms: beat, window: None });
    (0..count)
        .map(|i| if i == 0 { ellipse(nodes) } else { hinged(ellipse(nodes), i - 1, back, front, drive) })
        .collect()
}

/// Two banks of a channel, 3 apart.
pub fn banks<R: Real>(nodes: usize) -> [Wall<'static, R>; 2] {
    [2.5, -2.5].map(|y| wall(Shape::Ellipse { a: R::lit(4.0), b: R::one() }, [R::zero(), R::lit(y)], R::zero(), nodes))
}
