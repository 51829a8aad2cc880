//! Errata of the paper (docs/physics.md, section "Errata"): each test shows that the printed form fails and that the
//! corrected one holds.

use nekton::scene::{Body, CirculationModel, Drive, Harmonic, Link, Repulsion, Scene, Shape, Signal};
use nekton_tests::*;
use std::f64::consts::{PI, TAU};

const ALPHA: f64 = 4.0;
const EPSILON: f64 = 0.01;

/// Node of an ellipse's outline: position, outward normal, length element, curvature.
struct Node {
    x: [f64; 2],
    normal: [f64; 2],
    ds: f64,
    curvature: f64,
}

fn outline(a: f64, b: f64, pose: [f64; 3]) -> Vec<Node> {
    let n = 200;
    let (s, c) = pose[2].sin_cos();
    let turned = |v: [f64; 2]| [c * v[0] - s * v[1], s * v[0] + c * v[1]];
    (0..n)
        .map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            let speed = (a * sin).hypot(b * cos);
            let x = turned([a * cos, b * sin]);
            Node {
                x: [pose[0] + x[0], pose[1] + x[1]],
                normal: turned([b * cos / speed, a * sin / speed]),
                ds: speed * TAU / f64::from(n),
                curvature: a * b / speed.powi(3),
            }
        })
        .collect()
}

/// Two ellipses for the repulsion.
const AXES: [[f64; 2]; 2] = [[0.8, 0.4], [0.5, 0.3]];
const POSES: [[f64; 3]; 2] = [[-0.7, 0.1, 0.4], [1.0, -0.2, 1.2]];

/// Gradients of V with respect to the positions of both bodies in the manner of (5.2): the derivative of a boundary
/// integral along the normal, which has a curvature term, with `factor` in front of the displacement.
fn normal_form(factor: f64) -> [[f64; 2]; 2] {
    let outlines = [0, 1].map(|i: usize| outline(AXES[i][0], AXES[i][1], POSES[i]));
    [0, 1].map(|i: usize| {
        let mut sum = [0.0; 2];
        for p in &outlines[i] {
            for q in &outlines[1 - i] {
                let d = [p.x[0] - q.x[0], p.x[1] - q.x[1]];
                let r = d[0].hypot(d[1]);
                let along = -factor * (d[0] * p.normal[0] + d[1] * p.normal[1]) * r.powf(-ALPHA - 2.0);
                let density = EPSILON * (along + p.curvature * r.powf(-ALPHA)) * p.ds * q.ds;
                sum[0] += density * p.normal[0];
                sum[1] += density * p.normal[1];
            }
        }
        sum
    })
}

#[test]
fn printed_factor_of_the_repulsion_violates_action_and_reaction() {
    let links = AXES.map(|[a, b]| [link(Shape::Ellipse { a, b }, 1.0, 200)]);
    let bodies = [body(&links[0], POSES[0], [0.0; 3]), body(&links[1], POSES[1], [0.0; 3])];
    let repulsion = Some(Repulsion { alpha: ALPHA, epsilon: EPSILON });
    let scene = Scene { repulsion, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let force = vector(&mut at_start(&scene).view(), |sim, out| sim.repulsion(out));
    let slope = derivatives(&scene, |sim| vec![sim.energy().unwrap().repulsion]).concat();
    assert_close(&force, &slope, 3e-11);
    assert_close(&[force[0], force[1]], &[-force[3], -force[4]], 1e-14);

    // With the exponent as factor the normal form is the same gradient; with 2, as printed, it is another one, and
    // the forces do not cancel.
    let corrected = normal_form(ALPHA);
    assert_close(&corrected.concat(), &[force[0], force[1], force[3], force[4]], 1e-13);
    let printed = normal_form(2.0);
    let error = difference(&printed.concat(), &[slope[0], slope[1], slope[3], slope[4]]);
    let unbalanced = (printed[0][0] + printed[1][0]).hypot(printed[0][1] + printed[1][1]);
    let size = printed[0][0].hypot(printed[0][1]);
    println!("error of the printed form {error:.2}, forces {printed:?} unbalanced by {unbalanced:.2e} of {size:.2e}");
    assert!(error > 0.3, "{error}");
    assert!(unbalanced > 0.1 * size, "{unbalanced} of {size}");
}

#[test]
fn printed_equation_with_circulation_lacks_the_lift() {
    // A disc in unbounded fluid: its circulatory energy does not depend on where it is, so without the force linear in
    // the velocity there is no force at all, against the lift ρ γ U of Kutta and Joukowski.
    let links = [Link { circulation: 1.3, ..link(disc(0.5), 1.0, 32) }];
    let bodies = [body(&links, [0.0; 3], [0.7, 0.0, 0.0])];
    for shortcuts in [true, false] {
        let acceleration = |circulation| {
            let scene = Scene { circulation, shortcuts, bodies: &bodies, ..Scene::new(1.0, 0.0) };
            vector(&mut at_start(&scene).view(), |sim, out| sim.accelerations(out))
        };
        let total_mass = 2.0 * PI * 0.25;
        for (a, exact) in acceleration(CirculationModel::Full).iter().zip([0.0, 1.3 * 0.7 / total_mass, 0.0]) {
            assert_near(*a, exact, 5e-15);
        }
        for a in acceleration(CirculationModel::Paper) {
            assert_near(a, 0.0, 5e-15);
        }
    }
}

#[test]
fn printed_sign_of_the_circulatory_potential_contradicts_its_gradient() {
    // A disc with circulation off the centre of a disc tank: fluid is fast and its pressure low in the narrow gap, so
    // the wall attracts. T_c = +ρ γ² Δ/4π falls towards the wall and is that potential; −T_c would repel.
    let (a, radius, d, gamma): (f64, f64, f64, f64) = (0.5, 2.0, 0.6, 1.4);
    let links = [Link { circulation: gamma, ..link(disc(a), 1.0, 64) }];
    let bodies = [body(&links, [d, 0.0, 0.0], [0.0; 3])];
    let tank = Some(wall(disc(radius), [0.0; 2], 0.0, 96));
    let scene = Scene { tank, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let mut sim = at_start(&scene);
    let force = vector(&mut sim.view(), |sim, out| sim.circulation_gradient(out));
    // dΔ/dd of cosh Δ = (R² + a² − d²)/2aR.
    let cosh: f64 = (radius * radius + a * a - d * d) / (2.0 * a * radius);
    let slope = -gamma * gamma / (4.0 * PI) * d / (a * radius * (cosh * cosh - 1.0).sqrt());
    assert_close(&force, &[slope, 0.0, 0.0], 1e-15);
    let of_energy = derivatives(&scene, |sim| vec![sim.energy().unwrap().circulation]).concat();
    assert_close(&of_energy, &force, 4e-13);
    let acceleration = vector(&mut sim.view(), |sim, out| sim.accelerations(out));
    assert!(acceleration[0] > 0.0, "the wall must attract: {acceleration:?}");
}

#[test]
fn energy_is_constant_only_for_joints_at_rest() {
    let wave = [Harmonic { amplitude: 0.6, frequency: 2.0, phase: 0.0, offset: 0.2 }];
    let moving = Drive::Motion(Signal::Harmonic { terms: &wave, window: None });
    let one = link(Shape::Ellipse { a: 0.5, b: 0.2 }, 1.2, 64);
    for (drive, constant) in [(Drive::Locked(0.2), true), (moving, false)] {
        let links = [one, hinged(one, 0, [-0.7, 0.0], [0.7, 0.0], drive)];
        let bodies: [Body<'_, f64>; 1] = [body(&links, [0.0; 3], [0.3, 0.2, 0.4])];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-11));
        let mut sim = sim.view();
        let start = sim.energy().unwrap();
        let (mut change, mut balance) = (0.0_f64, 0.0_f64);
        for k in 1..=6 {
            sim.advance(0.25 * f64::from(k)).unwrap();
            let now = sim.energy().unwrap();
            change = change.max((now.total - start.total).abs() / start.total);
            balance = balance.max((now.total - start.total - (now.work - start.work)).abs() / start.total);
        }
        println!("change {change:.1e}, balance {balance:.1e}");
        assert!(balance <= 3e-11, "{balance:e}");
        assert!(if constant { change <= 2e-11 } else { change > 0.1 }, "{change:e}");
    }
}
