//! Single precision against double precision.

use nekton::Method;
use nekton::scalar::Real;
use nekton::scene::{Body, Drive, Harmonic, Link, Repulsion, Scene, Shape, Signal};
use nekton_tests::*;

/// Everything that one evaluation gives, and the positions after a while, for one scalar type.
struct Results {
    mass_matrix: Vec<f64>,
    christoffel: Vec<f64>,
    repulsion: Vec<f64>,
    buoyancy: Vec<f64>,
    circulation: Vec<f64>,
    gyroscopic: Vec<f64>,
    accelerations: Vec<f64>,
    torques: Vec<f64>,
    energy: f64,
    positions: Vec<f64>,
}

/// A swimmer of two links, a star and an obstacle in a tank, with every term.
fn results<R: Real>() -> Results {
    let lit = R::lit;
    let wave = [Harmonic { amplitude: lit(0.5), frequency: lit(2.0), phase: lit(0.2), offset: R::zero() }];
    let one = Link { circulation: lit(0.4), ..link(Shape::Ellipse { a: lit(0.5), b: lit(0.2) }, lit(1.2), 48) };
    let drive = Drive::Motion(Signal::Harmonic { terms: &wave, window: None });
    let swimmer = [one, hinged(one, 0, [lit(-0.75), R::zero()], [lit(0.75), R::zero()], drive)];
    let star = [link(Shape::Star { radius: lit(0.5), amplitude: lit(0.1), lobes: 3 }, lit(0.8), 64)];
    let at = |x: f64, y: f64, z: f64| [lit(x), lit(y), lit(z)];
    let bodies: [Body<'_, R>; 2] =
        [body(&swimmer, at(0.7, -0.6, 0.3), at(0.2, 0.1, -0.3)), body(&star, at(-0.5, 0.9, 0.2), at(-0.1, -0.2, 0.5))];
    let obstacles = [wall(disc(lit(0.3)), [lit(1.4), lit(0.8)], R::zero(), 48)];
    let tank = Some(wall(Shape::Ellipse { a: lit(3.0), b: lit(2.5) }, [R::zero(); 2], R::zero(), 96));
    let repulsion = Some(Repulsion { alpha: lit(4.0), epsilon: lit(0.01) });
    let scene = Scene { tank, repulsion, obstacles: &obstacles, bodies: &bodies, ..Scene::new(R::one(), lit(0.5)) };
    let mut sim = simulation(&scene, Method::Rk4 { step: lit(0.02) });
    let mut sim = sim.view();
    let wide = |x: Vec<R>| -> Vec<f64> { x.into_iter().map(Real::to_f64).collect() };
    let mut torques = [R::NAN];
    sim.joint_torques(&mut torques, &mut [R::NAN]).unwrap();
    let mut results = Results {
        mass_matrix: wide(matrix(&mut sim, |sim, out| sim.mass_matrix(out)).concat()),
        christoffel: wide(vector(&mut sim, |sim, out| sim.christoffel(out))),
        repulsion: wide(vector(&mut sim, |sim, out| sim.repulsion(out))),
        buoyancy: wide(vector(&mut sim, |sim, out| sim.buoyancy(out))),
        circulation: wide(vector(&mut sim, |sim, out| sim.circulation_gradient(out))),
        gyroscopic: wide(matrix(&mut sim, |sim, out| sim.gyroscopic(out)).concat()),
        accelerations: wide(vector(&mut sim, |sim, out| sim.accelerations(out))),
        torques: wide(torques.to_vec()),
        energy: sim.energy().unwrap().total.to_f64(),
        positions: Vec::new(),
    };
    sim.advance(lit(1.0)).unwrap();
    results.positions = wide(sim.positions().to_vec());
    results
}

#[test]
fn single_precision_agrees_with_double_precision() {
    let (single, double) = (results::<f32>(), results::<f64>());
    let table = [
        ("mass_matrix", &single.mass_matrix, &double.mass_matrix, 2e-6),
        ("christoffel", &single.christoffel, &double.christoffel, 2e-5),
        ("repulsion", &single.repulsion, &double.repulsion, 2e-5),
        ("buoyancy", &single.buoyancy, &double.buoyancy, 5e-6),
        ("circulation", &single.circulation, &double.circulation, 2e-5),
        ("gyroscopic", &single.gyroscopic, &double.gyroscopic, 2e-5),
        ("accelerations", &single.accelerations, &double.accelerations, 2e-5),
        ("torques", &single.torques, &double.torques, 2e-5),
        ("energy", &vec![single.energy], &vec![double.energy], 1e-5),
        ("positions", &single.positions, &double.positions, 2e-5),
    ];
    for (name, single, double, _) in table {
        println!("{name}: {:.1e}", difference(single, double));
    }
    for (name, single, double, tolerance) in table {
        let error = difference(single, double);
        assert!(error <= tolerance, "{name}: {error:e} > {tolerance:e}");
    }
}

#[test]
fn adams_reaches_single_precision_tolerances() {
    let links = paper_ellipse::<f32>(48);
    let bodies = two_ellipses(&links);
    let mut single = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-5));
    let mut single = single.view();
    single.advance(4.0).unwrap();
    let links = paper_ellipse::<f64>(48);
    let bodies = two_ellipses(&links);
    let mut double = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-10));
    let mut double = double.view();
    double.advance(4.0).unwrap();
    let wide: Vec<f64> = single.positions().iter().map(|&x| f64::from(x)).collect();
    println!("{:.1e}", difference(&wide, double.positions()));
    assert_close(&wide, double.positions(), 1e-4);
}
