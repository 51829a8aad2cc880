//! Closed forms, identities, near contact and extremes.

use super::*;
use nekton_tests::near::Case;
use std::f64::consts::PI;

/// Σ λᵏ over the eigenvalues of a matrix, k = 1, …, its size: they tell all eigenvalues.
fn power_sums(a: &[f64], n: usize) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = a.chunks_exact(n).map(<[f64]>::to_vec).collect();
    let mut power = columns.clone();
    (0..n)
        .map(|_| {
            let trace = (0..n).map(|i| power[i][i]).sum();
            power = power.iter().map(|column| times(&columns, column)).collect();
            trace
        })
        .collect()
}

/// Checks the linearization of an ellipse that coasts along one of its axes; the square of the rates of growth.
fn coasting(half_axes: [f64; 2], along: usize, speed: f64, nodes: usize) -> f64 {
    let ([a, b], heading) = (half_axes, 0.6);
    let (density, of_body) = (1.3, 0.7);
    let links = [link(Shape::Ellipse { a, b }, of_body, nodes)];
    let (sin, cos) = f64::sin_cos(heading + [0.0, PI / 2.0][along]);
    let bodies = [body(&links, [0.2, -0.1, heading], [speed * cos, speed * sin, 0.0])];
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(density, 0.0) });
    let mut sim = sim.view();
    let [matrix, _] = linearized(&mut sim, &[]);
    // Kirchhoff's equations about a translation along one axis: only the speed across and the spin grow.
    let own = of_body * PI * a * b;
    let masses = [own + density * PI * b * b, own + density * PI * a * a];
    let inertia = own * (a * a + b * b) / 4.0 + density * PI * (a * a - b * b).powi(2) / 8.0;
    let (m, across) = (masses[along], masses[1 - along]);
    let growth = m * (across - m) * speed * speed / (across * inertia);
    let rows = sim.state().len();
    assert_eq!(rows, 6);
    let scale = growth.abs().sqrt();
    for (k, sum) in power_sums(&matrix, rows).into_iter().enumerate() {
        let exact = if k % 2 == 0 { 0.0 } else { 2.0 * growth.powi(k as i32 / 2 + 1) };
        assert_near(sum / scale.powi(k as i32 + 1), exact / scale.powi(k as i32 + 1), 1e-11);
    }
    growth
}

#[test]
fn a_coasting_ellipse_is_stable_broadside_and_unstable_along_its_long_axis_at_kirchhoffs_rates() {
    for half_axes in [[0.8, 0.4], [2.0, 1.9], [1.0, 0.01]] {
        assert!(coasting(half_axes, 0, 0.7, 64) > 0.0);
        assert!(coasting(half_axes, 1, 0.7, 64) < 0.0);
    }
}

#[test]
fn a_force_quadratic_in_the_velocities_has_half_its_derivative_along_them() {
    let check = |place: &str, scene: &Scene<'_, f64>| {
        let mut sim = at_start(scene);
        let mut sim = sim.view();
        let n = sim.positions().len();
        let [_, by_velocity] = force_derivatives(&mut sim, &vec![0.0; n]);
        let columns: Vec<Vec<f64>> = by_velocity.chunks_exact(n).map(<[f64]>::to_vec).collect();
        let found = times(&columns, sim.velocities());
        let exact: Vec<f64> = vector(&mut sim, |sim, out| sim.christoffel(out)).iter().map(|f| 2.0 * f).collect();
        println!("{place}: {:.1e}", difference(&found, &exact));
        assert_close(&found, &exact, 1e-13);
    };
    everywhere(16, Quadrature::Plain, None, check);
    everywhere(48, Quadrature::Graded, None, check);
}

/// r, H, C, M (columns) at the start.
fn all_of(sim: &mut Sim<'_, f64>, qdd: &[f64]) -> (Vec<f64>, [Vec<Vec<f64>>; 3]) {
    let n = qdd.len();
    let y = sim.state().to_vec();
    let force = residual(sim, &y, qdd);
    let mass = matrix(sim, |sim, out| sim.mass_matrix(out));
    let [h, c] = force_derivatives(sim, qdd).map(|m| m.chunks_exact(n).map(<[f64]>::to_vec).collect());
    (force, [h, c, mass])
}

#[test]
fn shifting_and_turning_everything_shifts_and_turns_the_force() {
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    for (nodes, quadrature) in [(16, Quadrature::Plain), (128, Quadrature::Graded)] {
        let links = links(nodes);
        let bodies: Vec<_> = (0..3).map(|k| body(&links[k], POSES[k], VELOCITIES[k])).collect();
        // A round tank about the origin leaves the turning.
        let tank = Some(wall(disc(5.0), [0.0; 2], 0.3, 64));
        let alone = Scene { repulsion, quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(1.3, 0.0) };
        for scene in [alone, Scene { tank, ..alone }] {
            let mut sim = at_start(&scene);
            let mut sim = sim.view();
            let qdd = accelerations(9);
            let (force, [h, c, mass]) = all_of(&mut sim, &qdd);
            let scale = |columns: &[Vec<f64>]| columns.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
            if scene.tank.is_none() {
                for k in 0..2 {
                    let shift: Vec<f64> = (0..9).map(|i| if i % 3 == k { 1.0 } else { 0.0 }).collect();
                    let change = times(&h, &shift).iter().fold(0.0, |m: f64, x| m.max(x.abs())) / scale(&h);
                    println!("{quadrature:?}, shift {k}: {change:.1e}");
                    assert!(change < 1e-13, "{change:.1e}");
                }
            }
            let turned =
                |x: &[f64], spin: f64| -> Vec<f64> { x.chunks_exact(3).flat_map(|x| [-x[1], x[0], spin]).collect() };
            let directions = [turned(sim.positions(), 1.0), turned(sim.velocities(), 0.0), turned(&qdd, 0.0)];
            let parts = [times(&h, &directions[0]), times(&c, &directions[1]), times(&mass, &directions[2])];
            let found: Vec<f64> = (0..9).map(|i| parts.iter().map(|p| p[i]).sum()).collect();
            let error = difference(&found, &turned(&force, 0.0));
            println!("{quadrature:?}, turned: {error:.1e}");
            assert!(error < 1e-13, "{error:.1e}");
        }
    }
}

/// Two ellipses of which the second is moved away.
const PAIR: Case = Case {
    name: "two ellipses",
    bodies: &[(Shape::Ellipse { a: 1.0, b: 0.5 }, [0.0, 0.0, 0.3])],
    last: (Shape::Ellipse { a: 0.7, b: 0.4 }, [1.4, 0.6, -0.6], [0.9, 0.4]),
    tank: None,
    obstacle: None,
};

#[test]
fn derivatives_near_contact_converge_as_the_force_does() {
    for (gap, tolerance) in [(0.1, 1e-14), (1e-2, 2e-13), (1e-3, 1.2e-11)] {
        let shift = PAIR.shift(gap);
        let at =
            |nodes| PAIR.at(shift, nodes, Quadrature::Graded, &[], |sim| force_derivatives(sim, &accelerations(6)));
        let (coarse, fine) = (at(64), at(192));
        let errors = [0, 1].map(|k| difference(&coarse[k], &fine[k]));
        println!("gap {gap}: by position {:.1e}, by velocity {:.1e}", errors[0], errors[1]);
        assert!(errors.iter().all(|e| *e <= tolerance), "gap {gap}: {errors:?}");
    }
}

#[test]
fn bodies_in_vacuum_keep_their_velocities() {
    let links = links(16);
    let bodies: Vec<_> = (0..3).map(|k| body(&links[k], POSES[k], VELOCITIES[k])).collect();
    for gravity in [0.0, 9.81] {
        let scene = Scene { bodies: &bodies, ..Scene::new(0.0, gravity) };
        let mut sim = at_start(&scene);
        let mut sim = sim.view();
        let found = force_derivatives(&mut sim, &accelerations(9));
        assert!(found.concat().iter().all(|x| *x == 0.0));
        let [a, b] = linearized(&mut sim, &[Parameter::Gravity, Parameter::Wrench(1, 2)]);
        let exact: Vec<f64> = (0..18 * 18).map(|k| if k / 18 == k % 18 + 9 { 1.0 } else { 0.0 }).collect();
        assert_eq!(a, exact);
        let inertia = sim.model().link(1).unwrap().inertia;
        for (k, x) in b.iter().enumerate() {
            let falls = (9..18).contains(&k) && k % 3 == 1;
            let turns = k == 18 + 9 + 5;
            assert_near(*x, if falls { -1.0 } else { f64::from(turns) / inertia }, 1e-14 / inertia);
        }
    }
    let torque = swimmer(16, [driven(), prescribed()]);
    let lone = [body(&torque, [0.2, -0.1, 0.3], [0.4, -0.3, 0.7])];
    check_motion("swimmer in vacuum", &Scene { bodies: &lone, ..Scene::new(0.0, 9.81) });
}

#[test]
fn derivatives_of_the_force_on_thin_ellipses_are_exact() {
    let thin = [link(Shape::Ellipse { a: 1.0, b: 0.01 }, 1.2, 192)];
    let bodies = [body(&thin, [0.0, 0.0, 0.1], [0.3, -0.5, 0.7]), body(&thin, [0.4, 0.8, -0.3], [-0.2, 0.4, 0.9])];
    let scene = Scene { bodies: &bodies, quadrature: Quadrature::Graded, ..Scene::new(1.3, 9.81) };
    check("1:100", &scene, 2e-3, 4e-11);
}

#[test]
fn derivatives_scale_with_a_power_of_the_length() {
    let found = |s: f64| {
        let links = [
            [link(Shape::Ellipse { a: 0.8 * s, b: 0.4 * s }, 0.7, 32)],
            [link(Shape::Rectangle { width: s, height: 0.6 * s, radius: Some(0.1 * s) }, 1.1, 48)],
        ];
        let scaled = |x: [f64; 3]| [s * x[0], s * x[1], x[2]];
        let bodies = [0, 1].map(|k| body(&links[k], scaled(POSES[k]), scaled(VELOCITIES[k])));
        let scene = Scene { bodies: &bodies, allow_unresolved: true, ..Scene::new(1.3, 9.81 * s) };
        let qdd: Vec<f64> =
            accelerations(6).into_iter().enumerate().map(|(k, a)| if k % 3 == 2 { a } else { a * s }).collect();
        let mut sim = at_start(&scene);
        // Torques and angles bring one length each.
        force_derivatives(&mut sim.view(), &qdd).map(|m| {
            let power = |k: usize| 2 + i32::from(k % 6 % 3 == 2) + i32::from(k / 6 % 3 == 2);
            m.iter().enumerate().map(|(k, x)| x / s.powi(power(k))).collect::<Vec<f64>>()
        })
    };
    let one = found(1.0);
    for s in [1e-6, 1e6] {
        let other = found(s);
        for k in [0, 1] {
            println!("{s:e}: {:.1e}", difference(&other[k], &one[k]));
            assert_close(&other[k], &one[k], 1e-12);
        }
    }
}
