//! Fixed walls, whose part of the boundary system is factorized once and kept.

use nekton::Method;
use nekton::scene::{Body, Link, Quadrature, Root, Scene, Shape, Signal, Wall};
use nekton_tests::{body, difference, disc, link, simulation, wall};

fn ellipse(nodes: usize) -> [Link<'static, f64>; 1] {
    [link(Shape::Ellipse { a: 0.6, b: 0.3 }, 1.2, nodes)]
}

fn banks() -> [Wall<'static, f64>; 2] {
    [1.6, -1.7].map(|y| wall(Shape::Ellipse { a: 2.0, b: 0.6 }, [0.1, y], 0.05, 36))
}

/// Rates of a state by a new simulation.
fn rates(scene: &Scene<'_, f64>, change: impl Fn(&mut [f64])) -> Vec<f64> {
    let mut sim = simulation(scene, Method::Rk4 { step: 1e-3 });
    let mut state = sim.view().state().to_vec();
    change(&mut state);
    let mut rate = vec![0.0; state.len()];
    sim.view().rhs(0.0, &state, &mut rate).unwrap();
    rate
}

#[test]
fn fixed_walls_act_as_bodies_that_are_held() {
    let (links, walls) = (ellipse(30), banks());
    let moving = [body(&links, [-0.8, 0.1, 0.4], [0.3, 0.1, 0.2]), body(&links, [0.9, -0.1, 0.0], [-0.2, 0.1, 0.5])];
    let wall_links = walls.map(|w| [link(w.shape, 1.0, w.nodes)]);
    let held = [0, 1].map(|i| Body {
        root: Root::Prescribed([Signal::Constant(0.0); 3]),
        ..body(&wall_links[i], [walls[i].position[0], walls[i].position[1], walls[i].angle], [0.0; 3])
    });
    let all: Vec<_> = moving.into_iter().chain(held).collect();
    for quadrature in [Quadrature::Plain, Quadrature::Graded] {
        let fixed = Scene { bodies: &moving, obstacles: &walls, quadrature, ..Scene::new(1.0, 0.0) };
        let scene = Scene { bodies: &all, quadrature, ..Scene::new(1.0, 0.0) };
        let error = difference(&rates(&fixed, |_| ()), &rates(&scene, |_| ()));
        assert!(error < 1e-12, "{quadrature:?}: {error:e}");
    }
}

#[test]
fn an_evaluation_between_walls_depends_on_its_state_alone() {
    let (links, obstacles) = (ellipse(24), banks());
    let bodies = [body(&links, [0.0, 0.0, 0.1], [0.3, 0.1, 0.2])];
    let tank = wall(disc(5.0), [0.0; 2], 0.0, 40);
    for quadrature in [Quadrature::Plain, Quadrature::Graded] {
        let scene =
            Scene { bodies: &bodies, obstacles: &obstacles, tank: Some(tank), quadrature, ..Scene::new(1.0, 0.0) };
        let mut sim = simulation(&scene, Method::Rk4 { step: 1e-3 });
        let start = sim.view().state().to_vec();
        // From far to close, where the walls' nodes follow, and back.
        for y in [0.0, 0.3, 0.68, 0.1, 0.69, 0.68, 0.0, -0.2, 0.0] {
            let mut state = start.clone();
            state[1] = y;
            let mut rate = vec![0.0; state.len()];
            sim.view().rhs(0.0, &state, &mut rate).unwrap();
            assert_eq!(rate, rates(&scene, |state| state[1] = y), "{quadrature:?} {y}");
        }
    }
}
