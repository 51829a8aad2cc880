//! Single precision against double precision, and claims that both fulfil to their own rounding.

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
        ("mass_matrix", &single.mass_matrix, &double.mass_matrix, 1e-6),
        ("christoffel", &single.christoffel, &double.christoffel, 3e-6),
        ("repulsion", &single.repulsion, &double.repulsion, 3e-6),
        ("buoyancy", &single.buoyancy, &double.buoyancy, 3e-6),
        ("circulation", &single.circulation, &double.circulation, 4e-6),
        ("gyroscopic", &single.gyroscopic, &double.gyroscopic, 2e-6),
        ("accelerations", &single.accelerations, &double.accelerations, 2e-6),
        ("torques", &single.torques, &double.torques, 3e-5),
        ("energy", &vec![single.energy], &vec![double.energy], 1e-6),
        ("positions", &single.positions, &double.positions, 2e-6),
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

/// Added mass of an ellipse (Lamb) and of a disc in a concentric tank, and the lift of a disc, against closed forms.
fn closed_forms<R: Real>() {
    let (lit, zero) = (R::lit, R::zero());
    let of = |matrix: Vec<Vec<R>>, k: usize| matrix[k][k].to_f64();
    let close = |computed: f64, exact: f64| {
        let error = (computed - exact).abs() / exact.abs();
        println!("{:.1} units of rounding", error / R::EPSILON.to_f64());
        assert!(error <= tolerances::<R>().closed_form, "{computed} against {exact}: {error:e}");
    };
    let links = [link(Shape::Ellipse { a: lit(1.25), b: lit(0.5) }, R::one(), 64)];
    let bodies = [body(&links, [zero; 3], [zero; 3])];
    for shortcuts in [true, false] {
        let mut sim = at_start(&Scene { shortcuts, bodies: &bodies, ..Scene::new(lit(1.5), zero) });
        let columns = matrix(&mut sim.view(), |sim, out| sim.added_mass(out));
        let c = 1.5 * std::f64::consts::PI;
        for (k, exact) in [c * 0.25, c * 1.5625, c * 1.3125 * 1.3125 / 8.0].into_iter().enumerate() {
            close(of(columns.clone(), k), exact);
        }
    }
    let links = [Link { circulation: lit(0.75), ..link(disc(R::one()), R::one(), 64) }];
    let bodies = [body(&links, [lit(0.5), zero, zero], [zero; 3])];
    let tank = Some(wall(disc(R::TWO), [lit(0.5), zero], zero, 64));
    let mut sim = at_start(&Scene { tank, bodies: &bodies, ..Scene::new(lit(1.5), zero) });
    let columns = matrix(&mut sim.view(), |sim, out| sim.added_mass(out));
    close(of(columns, 0), 1.5 * std::f64::consts::PI * 5.0 / 3.0);
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(lit(1.5), zero) });
    let columns = matrix(&mut sim.view(), |sim, out| sim.gyroscopic(out));
    close(columns[0][1].to_f64(), 1.5 * 0.75);
}

#[test]
fn closed_forms_hold_to_rounding_in_both_precisions() {
    closed_forms::<f32>();
    closed_forms::<f64>();
}

/// Largest change of energy and impulse of two free bodies, relative to their sizes.
fn conserved<R: Real>() {
    let lit = R::lit;
    let at = |x: f64, y: f64, z: f64| [lit(x), lit(y), lit(z)];
    let links = [
        [link(Shape::Ellipse { a: lit(0.7), b: lit(0.35) }, lit(0.8), 48)],
        [link(Shape::Star { radius: lit(0.5), amplitude: lit(0.1), lobes: 2 }, lit(1.1), 48)],
    ];
    let bodies = [
        body(&links[0], at(-1.0, 0.3, 0.3), at(0.3, -0.1, 0.5)),
        body(&links[1], at(0.9, -0.2, 0.0), at(0.1, 0.2, -0.3)),
    ];
    let limits = tolerances::<R>();
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(R::one(), R::zero()) }, adams(limits.integrator));
    let mut sim = sim.view();
    let (energy, impulse) = (sim.energy().unwrap().total.to_f64(), sim.impulse().unwrap());
    for k in 1..=4 {
        sim.advance(lit(0.5 * f64::from(k))).unwrap();
        let drift = (sim.energy().unwrap().total.to_f64() / energy - 1.0).abs();
        let change = difference(&sim.impulse().unwrap(), &impulse);
        println!("energy {drift:.1e}, impulse {change:.1e}");
        assert!(drift <= limits.conserved && change <= limits.conserved, "{drift:e} {change:e}");
    }
}

#[test]
fn energy_and_impulse_are_conserved_in_both_precisions() {
    conserved::<f32>();
    conserved::<f64>();
}
