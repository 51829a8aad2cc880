//! Simulations whose boundary system faer factorizes, against the same by the own factorization:
//! `cargo test -p nekton --features faer --test factorization`; without the feature, that it is refused.

#![cfg(feature = "alloc")]

use nekton::scene::*;
use nekton::{Factorization, Method, ModelBuf, Real, SimBuf, Status};
use std::sync::Arc;

#[cfg(feature = "faer")]
const ON_TWO: Factorization = Factorization::Faer { threads: 2 };

/// A swimmer of two links and a star, both with circulation, in a tank with an obstacle; so many nodes on each link, two thirds
/// on each wall.
fn simulation<R: Real>(nodes: usize, walls: bool, quadrature: Quadrature) -> SimBuf<R> {
    let lit = R::lit;
    let ellipse = |a: f64, b: f64| Shape::Ellipse { a: lit(a), b: lit(b) };
    let link = |shape, circulation: f64| Link {
        shape,
        mass: Mass::Density(lit(1.2)),
        nodes,
        circulation: lit(circulation),
        joint: None,
    };
    let beat = [Harmonic { amplitude: lit(0.5), frequency: lit(2.0), phase: lit(0.2), offset: R::zero() }];
    let hinge = Joint {
        parent: 0,
        kind: JointKind::Hinge,
        parent_anchor: [lit(-0.75), R::zero()],
        self_anchor: [lit(0.75), R::zero()],
        drive: Drive::Motion(Signal::Harmonic { terms: &beat, window: None }),
    };
    let swimmer = [link(ellipse(0.5, 0.2), 0.4), Link { joint: Some(hinge), ..link(ellipse(0.5, 0.2), 0.0) }];
    let star = [link(Shape::Star { radius: lit(0.5), amplitude: lit(0.1), lobes: 3 }, -0.3)];
    let body = |links, pose: [f64; 3], velocity: [f64; 3]| Body {
        pose: pose.map(lit),
        velocity: velocity.map(lit),
        root: Root::Free,
        links,
    };
    let bodies = [body(&swimmer, [0.7, -0.6, 0.3], [0.2, 0.1, -0.3]), body(&star, [-0.5, 0.9, 0.2], [-0.1, -0.2, 0.5])];
    let nodes = 2 * (nodes / 3);
    let wall = |shape, x: f64, y: f64| Wall {
        shape,
        position: [lit(x), lit(y)],
        angle: R::zero(),
        nodes,
        circulation: R::zero(),
    };
    let obstacles = [wall(ellipse(0.3, 0.3), 1.4, 0.8)];
    let scene = Scene { bodies: &bodies, quadrature, ..Scene::new(R::one(), lit(0.5)) };
    let scene = match walls {
        true => Scene { tank: Some(wall(ellipse(3.0, 2.5), 0.0, 0.0)), obstacles: &obstacles, ..scene },
        false => scene,
    };
    let model = ModelBuf::new(&scene).unwrap_or_else(|error| panic!("scene refused: {error}"));
    SimBuf::new(Arc::new(model), Method::Rk4 { step: lit(0.05) }).unwrap()
}

#[cfg(feature = "faer")]
/// Rates of the start, state after two steps, mass matrix and energy there; every number of it.
fn numbers<R: Real>(mut sim: SimBuf<R>, by: Factorization) -> Vec<R> {
    let mut sim = sim.view();
    sim.set_factorization(by).unwrap();
    assert_eq!(sim.factorization(), by);
    let start = sim.state().to_vec();
    let n = sim.positions().len();
    let (mut rates, mut mass) = (vec![R::NAN; start.len()], vec![R::NAN; n * n]);
    sim.rhs(R::zero(), &start, &mut rates).unwrap();
    sim.step().unwrap();
    sim.step().unwrap();
    sim.mass_matrix(&mut mass).unwrap();
    let energy = sim.energy().unwrap();
    [rates, sim.state().to_vec(), mass, vec![energy.kinetic_fluid, energy.circulation, energy.total]].concat()
}

#[cfg(feature = "faer")]
fn same_but_for_rounding<R: Real>(sim: SimBuf<R>, tolerance: f64) {
    let own = numbers(sim.clone(), Factorization::Own);
    for threads in [1, 2] {
        let other = numbers(sim.clone(), Factorization::Faer { threads });
        assert_ne!(own, other, "not by faer");
        for (x, y) in own.iter().zip(&other) {
            let error = (*x - *y).abs().to_f64() / (1.0 + x.abs().to_f64());
            assert!(error <= tolerance, "{threads} threads: {x} and {y}, {error:e}");
        }
    }
}

#[cfg(feature = "faer")]
#[test]
fn motions_by_faer_are_those_by_the_own_factorization() {
    // Nodes of the three links alone are 528.
    same_but_for_rounding(simulation::<f64>(176, false, Quadrature::Plain), 2e-13);
    same_but_for_rounding(simulation::<f64>(176, true, Quadrature::Graded), 2e-13);
    same_but_for_rounding(simulation::<f32>(176, true, Quadrature::Plain), 1e-4);
}

#[cfg(feature = "faer")]
#[test]
fn small_systems_are_the_own_ones_bit_for_bit() {
    // With walls 592 unknowns, of which 444 are factorized anew.
    for (nodes, walls) in [(16, false), (148, true)] {
        let sim = simulation::<f64>(nodes, walls, Quadrature::Plain);
        let plan = sim.clone().view().model().plan().unknowns;
        assert!(plan < 512 || walls);
        assert_eq!(numbers(sim.clone(), Factorization::Own), numbers(sim, ON_TWO), "{nodes}");
    }
}

#[cfg(feature = "faer")]
#[test]
fn simulations_on_threads_of_their_own_share_the_pool() {
    let sim = simulation::<f64>(176, false, Quadrature::Plain);
    let alone = numbers(sim.clone(), ON_TWO);
    let both = std::thread::scope(|scope| {
        let run = || scope.spawn(|| numbers(sim.clone(), ON_TWO));
        [run(), run()].map(|thread| thread.join().unwrap())
    });
    assert!(both.iter().all(|other| *other == alone));
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut sim = simulation::<f64>(16, false, Quadrature::Plain);
    let mut sim = sim.view();
    let refusal = |error: nekton::Error| (error.status, error.what);
    #[cfg(feature = "faer")]
    {
        sim.set_factorization(ON_TWO).unwrap();
        let none = sim.set_factorization(Factorization::Faer { threads: 0 }).map_err(refusal);
        assert_eq!((none, sim.factorization()), (Err((Status::OutOfRange, "threads")), ON_TWO));
    }
    #[cfg(not(feature = "faer"))]
    for threads in [0, 1, 2] {
        let refused = sim.set_factorization(Factorization::Faer { threads }).map_err(refusal);
        assert_eq!(refused, Err((Status::Unsupported, "factorization")));
        assert_eq!(sim.factorization(), Factorization::Own);
    }
    sim.set_factorization(Factorization::Own).unwrap();
    assert_eq!(sim.factorization(), Factorization::Own);
}
