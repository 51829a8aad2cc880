//! What an ingredient of a scene costs, from counts: what is absent adds nothing, not a byte, and what is there adds what theory says.

use nekton::scene::{
    Body, CirculationModel, Drive, ForceFormula, Harmonic, Link, Quadrature, Repulsion, Scene, Shape, Signal, Wall,
};
use nekton::{Formulation, Model, ModelBuf, ModelRequirement, Plan};
use nekton_tests::*;

const NODES: usize = 32;

/// Everything that is counted.
fn counts(scene: &Scene<'_, f64>) -> (Plan, ModelRequirement) {
    let need = Model::requirement(scene).unwrap();
    let model = ModelBuf::new(scene).unwrap();
    (*model.view().plan(), need)
}

fn path(scene: &Scene<'_, f64>) -> Vec<f64> {
    let mut sim = simulation(scene, adams(1e-6));
    let mut sim = sim.view();
    sim.advance(0.4).unwrap();
    assert!(sim.counters().evaluations > 5);
    sim.positions().iter().chain(sim.velocities()).copied().collect()
}

fn links(circulation: f64) -> [Link<'static, f64>; 1] {
    [Link { circulation, ..link(Shape::Ellipse { a: 0.8, b: 0.4 }, 1.3, NODES) }]
}

fn pair<'a>(links: &'a [Link<'a, f64>]) -> [Body<'a, f64>; 2] {
    [body(links, [-1.2, 0.1, 0.3], [0.2, 0.0, 0.4]), body(links, [1.1, -0.2, 0.7], [-0.1, 0.3, 0.0])]
}

fn tank() -> Wall<'static, f64> {
    wall(Shape::Ellipse { a: 4.0, b: 3.0 }, [0.0; 2], 0.0, 2 * NODES)
}

#[test]
fn an_absent_ingredient_adds_exactly_zero() {
    let links = links(0.0);
    let bodies = pair(&links);
    let none = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    for base in [none, Scene { tank: Some(tank()), ..none }, Scene { fluid_density: 0.0, ..none }] {
        let (without, trajectory) = (counts(&base), path(&base));
        let absent = [
            Scene { repulsion: Some(Repulsion { alpha: 4.0, epsilon: 0.0 }), ..base },
            Scene { circulation: CirculationModel::Paper, ..base },
            Scene { gravity: -0.0, ..base },
            Scene { shortcuts: false, ..base },
        ];
        for scene in absent {
            assert_eq!(counts(&scene), without);
            assert_eq!(path(&scene), trajectory);
        }
    }
    let vacuum = Scene { fluid_density: 0.0, ..none };
    let (plan, _) = counts(&vacuum);
    assert_eq!((plan.unknowns, plan.right_hand_sides, plan.operations), (0, 0, 0.0));
    // In vacuum circulation, and the formula of a force that is not there, are absent as well.
    let swirling = self::links(0.7);
    let bodies = pair(&swirling);
    for scene in [Scene { bodies: &bodies, ..vacuum }, Scene { force: ForceFormula::Boundary, ..vacuum }] {
        assert_eq!(counts(&scene), counts(&vacuum));
        assert_eq!(path(&scene), path(&vacuum));
    }
}

#[test]
fn gravity_and_repulsion_add_no_unknown_and_no_right_hand_side() {
    let links = links(0.0);
    let bodies = pair(&links);
    let base = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let (mut plan, need) = counts(&base);
    plan.gravity = true;
    assert_eq!(counts(&Scene { gravity: 9.81, ..base }), (plan, need));
    plan.gravity = false;
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    plan.repulsion = true;
    plan.operations += 12.5 * (2.0 * NODES as f64).powi(2);
    // Close range takes tables, once; the plain quadrature takes not a byte.
    let (mut graded, _) = counts(&Scene { repulsion, ..base });
    assert!(graded.model_bytes > plan.model_bytes);
    graded.model_bytes = plan.model_bytes;
    assert_eq!(graded, plan);
    let base = Scene { quadrature: Quadrature::Plain, ..base };
    let (mut plain, need) = counts(&base);
    (plain.repulsion, plain.operations) = (true, plan.operations);
    assert_eq!(counts(&Scene { repulsion, ..base }), (plain, need));
}

#[test]
fn walls_add_their_nodes_and_no_right_hand_side() {
    let links = links(0.0);
    let bodies = pair(&links);
    let base = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let (open, _) = counts(&base);
    let obstacles = [wall(disc(0.5), [0.0, 2.0], 0.0, NODES)];
    let (closed, _) = counts(&Scene { tank: Some(tank()), obstacles: &obstacles, ..base });
    assert_eq!(closed.unknowns, open.unknowns + 3 * NODES);
    assert_eq!(closed.moving_unknowns, open.moving_unknowns);
    assert_eq!(closed.right_hand_sides, open.right_hand_sides);
    assert_eq!(closed.state_len, open.state_len);
}

#[test]
fn circulation_adds_its_potential_its_adjoint_and_the_lift_one_more() {
    let (still, swirling) = (links(0.0), links(0.7));
    let (still, swirling) = (pair(&still), pair(&swirling));
    let (before, _) = counts(&Scene { bodies: &still, ..Scene::new(1.0, 0.0) });
    let full = Scene { bodies: &swirling, ..Scene::new(1.0, 0.0) };
    let (with, _) = counts(&full);
    let (paper, _) = counts(&Scene { circulation: CirculationModel::Paper, ..full });
    // Six potentials of motion, the adjoint of the force and a solve for each half of the symmetrized added mass.
    assert_eq!(before.right_hand_sides, 9);
    assert_eq!(paper.right_hand_sides, 11);
    assert_eq!(with.right_hand_sides, 12);
    assert_eq!(with.unknowns, before.unknowns);
}

#[test]
fn joints_that_are_held_cost_less_than_the_same_links_free() {
    let segment = link(Shape::Ellipse { a: 1.0, b: 0.3 }, 1.0, NODES);
    let beat = [Harmonic { amplitude: 0.3, frequency: 2.0, phase: 0.0, offset: 0.0 }];
    let obstacles = [wall(disc(0.5), [0.0, 3.0], 0.0, NODES)];
    let plan = |drive: Option<Drive<'_, f64>>| {
        let chain = drive.map(|d| [segment, hinged(segment, 0, [-1.1, 0.0], [1.1, 0.0], d)]);
        let single = [segment];
        let bodies: Vec<Body<'_, f64>> = match &chain {
            Some(chain) => vec![body(chain, [0.0; 3], [0.0; 3])],
            None => vec![body(&single, [0.0; 3], [0.0; 3]), body(&single, [-2.2, 0.0, 0.0], [0.0; 3])],
        };
        counts(&Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.0) }).0
    };
    let free = plan(None);
    let held = plan(Some(Drive::Locked(0.1)));
    let moved = plan(Some(Drive::Motion(Signal::Harmonic { terms: &beat, window: None })));
    let driven = plan(Some(Drive::Torque {
        torque: Signal::Constant(0.1),
        stiffness: 0.0,
        damping: 0.0,
        rest: 0.0,
        start: [0.0; 2],
    }));
    // Potentials of the free coordinates and three solves of the force; prescribed motion has a potential of its own and two
    // solves for its power.
    let sides = [free, held, moved, driven].map(|p| p.right_hand_sides);
    assert_eq!(sides, [6 + 3, 3 + 3, 3 + 1 + 3 + 2, 4 + 3]);
    assert!(held.operations < free.operations && driven.operations < free.operations);
    assert!([held, moved, driven].iter().all(|p| p.unknowns == free.unknowns));
}

#[test]
fn a_lone_body_and_a_lone_swimmer_at_rest_of_its_joints_have_no_force_to_compute() {
    let links = links(0.0);
    let alone = [pair(&links)[0]];
    let (body, _) = counts(&Scene { bodies: &alone, ..Scene::new(1.0, 0.0) });
    assert_eq!(body.formulation, Formulation::Kirchhoff);
    assert_eq!((body.unknowns, body.right_hand_sides, body.operations), (0, 0, 0.0));
    let (general, _) = counts(&Scene { shortcuts: false, bodies: &alone, ..Scene::new(1.0, 0.0) });
    assert_eq!((general.unknowns, general.right_hand_sides), (NODES, 6));
    let segment = links[0];
    let chain = [segment, hinged(segment, 0, [-0.9, 0.0], [0.9, 0.0], Drive::Locked(0.2))];
    let bodies = [nekton_tests::body(&chain, [0.0; 3], [0.1, 0.0, 0.2])];
    let (swimmer, _) = counts(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    assert_eq!(swimmer.formulation, Formulation::LockedMomentum);
    assert_eq!((swimmer.right_hand_sides, swimmer.state_len), (3, 3));
}

#[test]
fn what_boundaries_do_to_themselves_is_kept_once_and_in_vacuum_not_at_all() {
    // What a boundary does to itself is a number for every pair of nodes: it is kept where a boundary system is solved. For a lone body
    // that is done once, in memory of the same size.
    let reals = |nodes: usize, scene: &Scene<'_, f64>, count: usize| {
        let links = [link(Shape::Ellipse { a: 0.8, b: 0.4 }, 1.3, nodes)];
        let bodies = pair(&links);
        Model::requirement(&Scene { bodies: &bodies[..count], ..*scene }).unwrap().reals
    };
    let square = 4 * NODES * NODES;
    for (fluid_density, shortcuts, count, kept) in
        [(1.0, true, 2, 1), (1.0, false, 1, 1), (1.0, true, 1, 1), (0.0, true, 2, 0), (0.0, true, 1, 0)]
    {
        let scene = Scene { shortcuts, ..Scene::new(fluid_density, 0.0) };
        let [one, two, three] = [1, 2, 3].map(|k| reals(2 * k * NODES, &scene, count));
        // The second difference of k² is 2.
        assert_eq!(three + one - 2 * two, 2 * kept * square, "{fluid_density} {shortcuts} {count}");
    }
}
