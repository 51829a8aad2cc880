//! Every bad scene is refused with the status and the place that say what is wrong.

use nekton::scene::{
    Body, Drive, Harmonic, Joint, JointKind, Link, Mass, Repulsion, Scene, Shape, Signal, Wall, Window,
};
use nekton::status::{Place, Status};
use nekton::{Method, ModelBuf, SimBuf};
use nekton_tests::*;
use std::sync::Arc;

const LINK: Link<'static, f64> = Link {
    shape: Shape::Ellipse { a: 1.0, b: 0.5 },
    mass: Mass::Density(1.0),
    nodes: 32,
    circulation: 0.0,
    joint: None,
};

const FLUID: Scene<'static, f64> = Scene::new(1.0, 0.0);

/// Asserts that a scene is refused with a status at a place.
#[track_caller]
fn refused(scene: &Scene<'_, f64>, status: Status, place: Place) {
    let error = refusal(scene);
    println!("{error}");
    assert_eq!((error.status, error.place), (status, place), "{error}");
    assert!(!error.to_string().contains('\n'));
}

/// Asserts that a scene of one body with these links is refused.
#[track_caller]
fn refused_links(links: &[Link<'_, f64>], status: Status, place: Place) {
    let bodies = [body(links, [0.0; 3], [0.0; 3])];
    refused(&Scene { bodies: &bodies, ..FLUID }, status, place);
}

/// Asserts that a link is refused.
#[track_caller]
fn refused_link(link: Link<'_, f64>, status: Status) {
    refused_links(&[link], status, Place::Link(0, 0));
}

#[track_caller]
fn refused_shape(shape: Shape<'_, f64>, status: Status) {
    refused_link(Link { shape, ..LINK }, status);
}

/// One good body.
fn bodies<'a>(links: &'a [Link<'a, f64>]) -> [Body<'a, f64>; 1] {
    [body(links, [0.0; 3], [0.0; 3])]
}

#[test]
fn scene_without_bodies() {
    refused(&FLUID, Status::EmptyScene, Place::Scene);
    refused_links(&[], Status::EmptyScene, Place::Body(0));
}

#[test]
fn fluid_density_and_gravity() {
    let links = [LINK];
    let bodies = bodies(&links);
    for density in [f64::NAN, f64::INFINITY] {
        let scene = Scene { fluid_density: density, bodies: &bodies, ..FLUID };
        refused(&scene, Status::NotFinite, Place::Scene);
        assert_eq!(refusal(&scene).what, "density");
    }
    refused(&Scene { fluid_density: -1.0, bodies: &bodies, ..FLUID }, Status::OutOfRange, Place::Scene);
    let scene = Scene { gravity: f64::NAN, bodies: &bodies, ..FLUID };
    refused(&scene, Status::NotFinite, Place::Scene);
    assert_eq!(refusal(&scene).what, "gravity");
}

#[test]
fn repulsion_constants() {
    let links = [LINK];
    let bodies = bodies(&links);
    for (alpha, epsilon, status) in [
        (0.0, 0.01, Status::OutOfRange),
        (4.0, -0.01, Status::OutOfRange),
        (f64::NAN, 0.01, Status::NotFinite),
        (4.0, f64::NAN, Status::NotFinite),
    ] {
        let repulsion = Some(Repulsion { alpha, epsilon });
        refused(&Scene { repulsion, bodies: &bodies, ..FLUID }, status, Place::Scene);
    }
}

#[test]
fn tolerances_in_space() {
    let links = [LINK];
    let bodies = bodies(&links);
    for bad in [0.0, -1e-6, 1e-16, f64::NAN, f64::INFINITY] {
        let scene = Scene { tolerance: Some(bad), bodies: &bodies, ..FLUID };
        refused(&scene, Status::BadTolerance, Place::Scene);
        assert_eq!(refusal(&scene).what, "tolerance");
    }
}

#[test]
fn node_counts() {
    for nodes in [2, 6, 33] {
        refused_link(Link { nodes, ..LINK }, Status::NodeCount);
        let links = [LINK];
        let bodies = bodies(&links);
        let bad = wall(disc(5.0), [0.0; 2], 0.0, nodes);
        refused(&Scene { tank: Some(bad), bodies: &bodies, ..FLUID }, Status::NodeCount, Place::Tank);
        let obstacles = [wall(disc(1.0), [4.0, 0.0], 0.0, 32), wall(disc(1.0), [-4.0, 0.0], 0.0, nodes)];
        refused(&Scene { obstacles: &obstacles, bodies: &bodies, ..FLUID }, Status::NodeCount, Place::Obstacle(1));
    }
    assert_eq!(refusal(&Scene { bodies: &bodies(&[Link { nodes: 33, ..LINK }]), ..FLUID }).value, 33.0);
}

#[test]
fn poses_and_velocities() {
    let links = [LINK];
    for k in 0..3 {
        let mut pose = [0.0; 3];
        pose[k] = f64::NAN;
        let far = [9.0, 0.0, 0.0];
        let both = [body(&links, far, [0.0; 3]), body(&links, pose, [0.0; 3])];
        refused(&Scene { bodies: &both, ..FLUID }, Status::NotFinite, Place::Body(1));
        let both = [body(&links, far, [0.0; 3]), body(&links, [0.0; 3], pose)];
        refused(&Scene { bodies: &both, ..FLUID }, Status::NotFinite, Place::Body(1));
    }
    let bodies = bodies(&links);
    let obstacles = [wall(disc(1.0), [f64::NAN, 0.0], 0.0, 32)];
    refused(&Scene { obstacles: &obstacles, bodies: &bodies, ..FLUID }, Status::NotFinite, Place::Obstacle(0));
}

#[test]
fn masses() {
    let given = |mass, inertia, x| Mass::Given { mass, inertia, centre_of_mass: [x, 0.0] };
    for (mass, status) in [
        (Mass::Density(-1.0), Status::OutOfRange),
        (Mass::Density(f64::NAN), Status::NotFinite),
        (given(-1.0, 1.0, 0.0), Status::OutOfRange),
        (given(1.0, -1.0, 0.0), Status::OutOfRange),
        (given(1.0, f64::NAN, 0.0), Status::NotFinite),
        (given(1.0, 1.0, f64::NAN), Status::NotFinite),
    ] {
        refused_link(Link { mass, ..LINK }, status);
    }
    refused_link(Link { circulation: f64::NAN, ..LINK }, Status::NotFinite);
}

#[test]
fn body_without_mass_in_a_fluid_without_density() {
    let links = [Link { mass: Mass::Density(0.0), ..LINK }];
    let bodies = bodies(&links);
    let error = refusal(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) });
    assert_eq!(error.status, Status::Massless, "{error}");
    assert!(matches!(error.place, Place::Body(0) | Place::Link(0, 0)), "{error}");
}

#[test]
fn measures_of_shapes() {
    let nan = f64::NAN;
    for shape in [
        Shape::Ellipse { a: nan, b: 1.0 },
        Shape::Star { radius: nan, amplitude: 0.1, lobes: 3 },
        Shape::Rectangle { width: 1.0, height: nan, radius: None },
        Shape::Polygon { vertices: &[[0.0, 0.0], [1.0, 0.0], [nan, 1.0]], radius: None },
        Shape::curve(&[[0.0, 0.0], [1.0, 0.0], [1.0, nan], [0.0, 1.0]]),
    ] {
        refused_shape(shape, Status::NotFinite);
    }
    for shape in [
        Shape::Ellipse { a: 0.0, b: 1.0 },
        Shape::Ellipse { a: 1.0, b: -0.5 },
        Shape::Star { radius: 1.0, amplitude: 1.0, lobes: 3 },
        Shape::Rectangle { width: -1.0, height: 1.0, radius: None },
        Shape::Rectangle { width: 1.0, height: 1.0, radius: Some(2.0) },
        Shape::Polygon { vertices: &[[0.0, 0.0], [1.0, 0.0]], radius: None },
        Shape::Polygon { vertices: &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], radius: None },
        Shape::curve(&[[0.0, 0.0], [1.0, 0.0]]),
    ] {
        let links = [Link { shape, ..LINK }];
        let error = refusal(&Scene { bodies: &bodies(&links), ..FLUID });
        println!("{shape:?}: {error}");
        assert!(matches!(error.status, Status::BadShape | Status::OutOfRange), "{shape:?}: {error}");
        assert_eq!(error.place, Place::Link(0, 0), "{shape:?}: {error}");
    }
}

#[test]
fn outlines_that_cross_themselves() {
    let bow_tie = [[0.0, 0.0], [1.0, 0.1], [0.0, 1.0], [1.2, 1.0]];
    refused_shape(Shape::Polygon { vertices: &bow_tie, radius: Some(0.01) }, Status::SelfIntersection);
    let eight = [[1.0, 0.6], [0.0, 0.0], [-1.0, -0.6], [-1.4, 0.1], [-1.0, 0.6], [0.1, 0.0], [1.0, -0.7], [1.4, 0.0]];
    refused_shape(Shape::curve(&eight), Status::SelfIntersection);
}

#[test]
fn clockwise_outline_is_turned_round_with_a_notice() {
    let vertices = [[0.0, 0.0], [1.0, 0.0], [1.2, 0.9], [0.1, 1.0]];
    let mut clockwise = vertices;
    clockwise.reverse();
    let mass = |vertices: &[[f64; 2]], expected: &[(Place, Status)]| {
        let links = [Link { shape: Shape::Polygon { vertices, radius: Some(0.05) }, nodes: 128, ..LINK }];
        let bodies = bodies(&links);
        let model = ModelBuf::new(&Scene { bodies: &bodies, ..FLUID }).unwrap();
        assert_eq!(model.view().notices().collect::<Vec<_>>(), expected);
        let mut sim = SimBuf::new(Arc::new(model), Method::Rk4 { step: 0.1 }).unwrap();
        matrix(&mut sim.view(), |sim, out| sim.mass_matrix(out)).concat()
    };
    let same = mass(&vertices, &[]);
    let turned = mass(&clockwise, &[(Place::Link(0, 0), Status::OutlineReversed)]);
    assert_close(&turned, &same, 2e-14);
}

#[test]
fn boundaries_that_overlap() {
    let links = [LINK];
    let pairs = |status_of: &Scene<'_, f64>, expected: [Place; 2]| {
        let error = refusal(status_of);
        println!("{error}");
        assert_eq!(error.status, Status::Overlap, "{error}");
        let found = [Some(error.place), error.other];
        assert!(expected.iter().all(|place| found.contains(&Some(*place))), "{error}");
    };
    // Crossing, one inside the other, and the same place.
    for x in [1.5, 0.0] {
        let both = [body(&links, [0.0; 3], [0.0; 3]), body(&links, [x, 0.1, 0.0], [0.0; 3])];
        pairs(&Scene { bodies: &both, ..FLUID }, [Place::Link(0, 0), Place::Link(1, 0)]);
    }
    let small = [Link { shape: disc(0.2), ..LINK }];
    let both = [body(&links, [0.0; 3], [0.0; 3]), body(&small, [0.1, 0.1, 0.0], [0.0; 3])];
    pairs(&Scene { bodies: &both, ..FLUID }, [Place::Link(0, 0), Place::Link(1, 0)]);
    let one = bodies(&links);
    let obstacles = [wall(disc(1.0), [1.5, 0.0], 0.0, 32)];
    pairs(&Scene { obstacles: &obstacles, bodies: &one, ..FLUID }, [Place::Link(0, 0), Place::Obstacle(0)]);
    let obstacles = [wall(disc(1.0), [4.0, 0.0], 0.0, 32), wall(disc(1.0), [4.5, 0.0], 0.0, 32)];
    pairs(&Scene { obstacles: &obstacles, bodies: &one, ..FLUID }, [Place::Obstacle(0), Place::Obstacle(1)]);
    let linked = [LINK, hinged(LINK, 0, [-0.5, 0.0], [0.5, 0.0], Drive::Locked(0.0))];
    let one = bodies(&linked);
    pairs(&Scene { bodies: &one, ..FLUID }, [Place::Link(0, 0), Place::Link(0, 1)]);
}

#[test]
fn whatever_is_not_inside_the_tank() {
    let links = [LINK];
    let tank = Some(wall(disc(3.0), [0.0; 2], 0.0, 64));
    for x in [2.5, 9.0] {
        let one = [body(&links, [x, 0.0, 0.0], [0.0; 3])];
        let error = refusal(&Scene { tank, bodies: &one, ..FLUID });
        assert_eq!(error.place, Place::Link(0, 0), "{error}");
        assert!(matches!(error.status, Status::OutsideTank | Status::Overlap), "{error}");
    }
    let one = bodies(&links);
    let obstacles = [wall(disc(1.0), [9.0, 0.0], 0.0, 32)];
    refused(&Scene { tank, obstacles: &obstacles, bodies: &one, ..FLUID }, Status::OutsideTank, Place::Obstacle(0));
}

#[test]
fn circulation_around_the_tank() {
    let links = [LINK];
    let one = bodies(&links);
    let tank = Some(Wall { circulation: 1.0, ..wall(disc(5.0), [0.0; 2], 0.0, 64) });
    refused(&Scene { tank, bodies: &one, ..FLUID }, Status::OutOfRange, Place::Tank);
}

#[test]
fn parents() {
    let child = |parent| hinged(LINK, parent, [-1.2, 0.0], [1.2, 0.0], Drive::Locked(0.0));
    for parent in [1, 2, 7] {
        refused_links(&[LINK, child(parent), child(1)], Status::BadParent, Place::Link(0, 1));
    }
    refused_links(&[LINK, LINK], Status::BadParent, Place::Link(0, 1));
    refused_links(&[child(0)], Status::BadParent, Place::Link(0, 0));
}

/// Asserts that a body is refused whose second link is driven so.
#[track_caller]
fn refused_drive(drive: Drive<'_, f64>, status: Status) {
    refused_links(&[LINK, hinged(LINK, 0, [-1.2, 0.0], [1.2, 0.0], drive)], status, Place::Link(0, 1));
}

#[test]
fn drives() {
    let nan = f64::NAN;
    refused_drive(Drive::Locked(nan), Status::NotFinite);
    refused_drive(Drive::Motion(Signal::Constant(nan)), Status::NotFinite);
    let wave = [Harmonic { amplitude: 1.0, frequency: nan, phase: 0.0, offset: 0.0 }];
    refused_drive(Drive::Motion(Signal::Harmonic { terms: &wave, window: None }), Status::NotFinite);
    let wave = [Harmonic { amplitude: 1.0, frequency: 1.0, phase: 0.0, offset: 0.0 }];
    for (from, to, ramp) in [(0.0, 1.0, 0.0), (0.0, 1.0, 0.6), (1.0, 0.0, 0.1)] {
        let window = Some(Window { from, to, ramp });
        refused_drive(Drive::Motion(Signal::Harmonic { terms: &wave, window }), Status::OutOfRange);
    }
    let torque = |stiffness, damping, start| Drive::Torque {
        torque: Signal::Constant(0.0),
        stiffness,
        damping,
        rest: 0.0,
        start,
    };
    refused_drive(torque(-1.0, 0.0, [0.0; 2]), Status::OutOfRange);
    refused_drive(torque(0.0, -1.0, [0.0; 2]), Status::OutOfRange);
    refused_drive(torque(nan, 0.0, [0.0; 2]), Status::NotFinite);
    refused_drive(torque(0.0, 0.0, [0.0, nan]), Status::NotFinite);
}

#[test]
fn tables() {
    let row = |t| [t, 0.0, 0.0, 0.0];
    for table in [[row(0.0), row(0.0)], [row(1.0), row(0.5)]] {
        refused_drive(Drive::Motion(Signal::Table(&table)), Status::BadTable);
    }
    refused_drive(Drive::Motion(Signal::Table(&[])), Status::BadTable);
    refused_drive(Drive::Motion(Signal::Table(&[row(0.0), [1.0, f64::NAN, 0.0, 0.0]])), Status::NotFinite);
}

#[test]
fn joints() {
    let joint = |kind, anchor| Joint {
        parent: 0,
        kind,
        parent_anchor: anchor,
        self_anchor: [1.2, 0.0],
        drive: Drive::Locked(0.0),
    };
    for (joint, status) in [
        (joint(JointKind::Hinge, [f64::NAN, 0.0]), Status::NotFinite),
        (joint(JointKind::Slider { axis: [0.0, 0.0], angle: 0.0 }, [-1.2, 0.0]), Status::OutOfRange),
        (joint(JointKind::Slider { axis: [1.0, 0.0], angle: f64::NAN }, [-1.2, 0.0]), Status::NotFinite),
    ] {
        refused_links(&[LINK, Link { joint: Some(joint), ..LINK }], status, Place::Link(0, 1));
    }
}

#[test]
fn steps_and_tolerances() {
    let links = [LINK];
    let one = bodies(&links);
    let model = Arc::new(ModelBuf::new(&Scene { bodies: &one, ..FLUID }).unwrap());
    let status = |method| SimBuf::new(Arc::clone(&model), method).err().map(|error| error.status);
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(status(Method::Rk4 { step }), Some(Status::BadStep), "{step}");
        assert_eq!(status(Method::Abm4 { step }), Some(Status::BadStep), "{step}");
    }
    for (relative, absolute) in
        [(0.0, 0.0), (-1e-6, 1e-6), (1e-6, -1e-6), (f64::NAN, 1e-6), (1e-6, f64::NAN), (1e-17, 1e-17)]
    {
        assert_eq!(status(Method::adams(relative, absolute)), Some(Status::BadTolerance), "{relative} {absolute}");
    }
}

#[test]
fn buffers_of_the_wrong_length() {
    let links = [LINK];
    let one = bodies(&links);
    let mut sim = at_start(&Scene { bodies: &one, ..FLUID });
    let mut sim = sim.view();
    assert_eq!(sim.mass_matrix(&mut [0.0; 8]).unwrap_err().status, Status::Length);
    assert_eq!(sim.christoffel(&mut [0.0; 4]).unwrap_err().status, Status::Length);
    assert_eq!(sim.accelerations(&mut []).unwrap_err().status, Status::Length);
}

#[test]
fn contact_is_named_and_leaves_the_state_of_the_last_good_step() {
    let links = [Link { shape: disc(0.5), ..LINK }];
    // Without fluid nothing holds them apart: they meet at t = 1.
    let both = [body(&links, [-1.0, 0.0, 0.0], [0.5, 0.0, 0.0]), body(&links, [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0])];
    let scene = Scene { bodies: &both, ..Scene::new(0.0, 0.0) };
    for method in [Method::Rk4 { step: 0.07 }, Method::Abm4 { step: 0.07 }, adams(1e-8)] {
        let mut sim = simulation(&scene, method);
        let mut sim = sim.view();
        let error = sim.advance(2.0).unwrap_err();
        println!("{method:?}: {error} at t = {}", sim.time());
        assert_eq!(error.status, Status::Contact, "{error}");
        let places = [Some(error.place), error.other];
        assert!(places.contains(&Some(Place::Link(0, 0))) && places.contains(&Some(Place::Link(1, 0))), "{error}");
        let t = sim.time();
        assert!(t < 1.0 && t > 0.8, "{t}");
        assert_near(sim.positions()[0], -1.0 + 0.5 * t, 1e-14);
        assert!(sim.gap().distance > 0.0);
        // Trying again changes nothing.
        let before = (t, sim.positions().to_vec(), sim.velocities().to_vec());
        sim.advance(2.0).unwrap_err();
        assert_eq!((sim.time(), sim.positions().to_vec(), sim.velocities().to_vec()), before);
    }
}

#[test]
fn time_only_goes_forward() {
    let links = [LINK];
    let one = bodies(&links);
    let mut sim = at_start(&Scene { bodies: &one, ..FLUID });
    let mut sim = sim.view();
    sim.advance(0.5).unwrap();
    for (t, status) in [(0.2, Status::PastTime), (f64::NAN, Status::NotFinite), (f64::INFINITY, Status::NotFinite)] {
        assert_eq!(sim.advance(t).unwrap_err().status, status, "{t}");
        assert_eq!(sim.time(), 0.5);
    }
}

#[test]
fn what_is_inside_another_boundary_is_refused_and_what_is_beside_it_is_not() {
    // A rod in every direction, and a small disc at points of which the rod's equation tells where they are.
    let (a, b, small) = (1.0, 0.2, 0.01);
    let rod = [Link { shape: Shape::Ellipse { a, b }, nodes: 64, ..LINK }];
    let disc = [Link { shape: disc(small), nodes: 8, ..LINK }];
    let mut seen = [0; 2];
    for k in 0..160 {
        let (turn, radius, angle) = (0.7 * f64::from(k), 0.05 + 0.006 * f64::from(k), 2.4 * f64::from(k * k));
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let size = (x / a).powi(2) + (y / b).powi(2);
        if (size.sqrt() - 1.0).abs() < 0.15 {
            continue;
        }
        let (sin, cos) = turn.sin_cos();
        let at = [3.0 + cos * x - sin * y, -2.0 + sin * x + cos * y, 0.0];
        let bodies = [body(&rod, [3.0, -2.0, turn], [0.0; 3]), body(&disc, at, [0.0; 3])];
        let scene = Scene { bodies: &bodies, ..FLUID };
        let told = ModelBuf::new(&scene).and_then(|m| SimBuf::new(Arc::new(m), Method::Rk4 { step: 0.01 }));
        let inside = size < 1.0;
        seen[usize::from(inside)] += 1;
        assert_eq!(told.err().map(|e| e.status), inside.then_some(Status::Overlap), "{x} {y} turned by {turn}");
    }
    assert!(seen.into_iter().all(|count| count > 20), "{seen:?}");
}

#[test]
fn of_points_equally_far_too_far_the_first_is_named() {
    let far = [[0.0, 0.0], [1e200, 0.0], [0.0, 1e200]];
    for shape in [Shape::Polygon { vertices: &far, radius: None }, Shape::curve(&far)] {
        let links = [Link { shape, ..LINK }];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        let error = refusal(&Scene { bodies: &bodies, ..FLUID });
        assert_eq!((error.status, error.value), (Status::OutOfRange, 1.0), "{error}");
    }
}

#[test]
fn the_least_tolerance_in_time_is_taken_and_the_next_smaller_refused() {
    let links = [LINK];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let model = Arc::new(ModelBuf::new(&Scene { bodies: &bodies, ..FLUID }).unwrap());
    let told = |relative, absolute| {
        SimBuf::new(Arc::clone(&model), Method::adams(relative, absolute)).err().map(|error| error.status)
    };
    let least = 4.0 * f64::EPSILON;
    assert_eq!(told(least, 1e-9), None);
    assert_eq!(told(least.next_down(), 1e-9), Some(Status::BadTolerance));
    assert_eq!(told(1e-9, f64::MIN_POSITIVE), None);
    assert_eq!(told(1e-9, 0.0), Some(Status::BadTolerance));
}
