//! Values known in closed form or converged by an independent code (docs/physics.md, section "Reference values").
//!
//! Gaps below 0.1 are left out: the plain trapezoidal rule needs about 36/gap nodes per body there.

use nekton::scene::{Body, Drive, Harmonic, Link, Scene, Shape, Signal};
use nekton_tests::*;
use std::f64::consts::PI;

/// Columns of the added mass of a scene.
fn added_mass(scene: &Scene<'_, f64>) -> Vec<Vec<f64>> {
    let mut sim = at_start(scene);
    matrix(&mut sim.view(), |sim, out| sim.added_mass(out))
}

/// Two discs on the x-axis, centres `distance` apart; columns of their added mass.
fn added_mass_of_discs(radii: [f64; 2], distance: f64, density: f64, nodes: usize) -> Vec<Vec<f64>> {
    let links = radii.map(|radius| [link(disc(radius), 1.0, nodes)]);
    let bodies = [body(&links[0], [0.0; 3], [0.0; 3]), body(&links[1], [distance, 0.0, 0.0], [0.0; 3])];
    added_mass(&Scene { bodies: &bodies, ..Scene::new(density, 0.0) })
}

#[test]
fn added_mass_of_ellipse_is_that_of_lamb() {
    let (a, b, density) = (1.2, 0.3, 1.3);
    let links = [link(Shape::Ellipse { a, b }, 1.0, 128)];
    let bodies = [body(&links, [0.3, -0.2, 0.0], [0.0; 3])];
    let m = added_mass(&Scene { bodies: &bodies, ..Scene::new(density, 0.0) }).concat();
    let c = density * PI;
    let exact = [b * b, a * a, (a * a - b * b).powi(2) / 8.0].map(|x| c * x);
    assert_close(&m, &[exact[0], 0.0, 0.0, 0.0, exact[1], 0.0, 0.0, 0.0, exact[2]], 1e-15);
}

#[test]
fn added_mass_turns_with_the_body() {
    let (a, b, theta): (f64, f64, f64) = (1.0, 0.5, 0.7);
    let links = [link(Shape::Ellipse { a, b }, 1.0, 64)];
    let bodies = [body(&links, [0.0, 0.0, theta], [0.0; 3])];
    let m = added_mass(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    let (s, c) = theta.sin_cos();
    let exact =
        [PI * (b * b * c * c + a * a * s * s), PI * (b * b - a * a) * s * c, PI * (b * b * s * s + a * a * c * c)];
    assert_close(&[m[0][0], m[0][1], m[1][1]], &exact, 1e-15);
}

#[test]
fn added_mass_of_disc_is_rho_pi_a2() {
    let links = [link(disc(0.7), 2.0, 16)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let m = added_mass(&Scene { bodies: &bodies, ..Scene::new(1.5, 0.0) }).concat();
    let exact = 1.5 * PI * 0.49;
    assert_close(&m, &[exact, 0.0, 0.0, 0.0, exact, 0.0, 0.0, 0.0, 0.0], 2e-15);
}

#[test]
fn added_mass_of_disc_in_concentric_tank() {
    let (a, radius, density) = (1.0_f64, 2.0_f64, 1.7);
    let links = [link(disc(a), 1.0, 64)];
    let bodies = [body(&links, [0.4, 0.1, 0.5], [0.0; 3])];
    let tank = Some(wall(disc(radius), [0.4, 0.1], 0.0, 64));
    let m = added_mass(&Scene { tank, bodies: &bodies, ..Scene::new(density, 0.0) }).concat();
    let exact = density * PI * a * a * (radius * radius + a * a) / (radius * radius - a * a);
    assert_close(&m, &[exact, 0.0, 0.0, 0.0, exact, 0.0, 0.0, 0.0, 0.0], 4e-15);
}

#[test]
fn added_mass_of_two_unit_discs() {
    // Gap, nodes, m11, |m12|, tolerance.
    let table = [
        (1.0, 64, 3.241_889_679_167_403, 0.712_688_885_146_498_1, 6e-15),
        (0.1, 360, 3.847_141_498_805_278, 1.755_243_452_689_908_5, 6e-15),
    ];
    for (gap, nodes, m11, m12, tolerance) in table {
        let m = added_mass_of_discs([1.0, 1.0], 2.0 + gap, 1.0, nodes);
        assert_close(
            &[m[0][0], m[3][3], m[0][3], m[1][1], m[4][4], m[1][4]],
            &[m11, m11, -m12, m11, m11, m12],
            tolerance,
        );
    }
}

#[test]
fn added_mass_of_two_discs_in_bipolar_coordinates() {
    let (a, b, d, density): (f64, f64, f64, f64) = (1.0, 0.4, 2.1, 1.2);
    let x1 = (d * d + a * a - b * b) / (2.0 * d);
    let c = (x1 * x1 - a * a).sqrt();
    let (t1, t2) = ((c / a).asinh(), (c / b).asinh());
    let sum = |shift: f64| (1..60).map(|n| (f64::from(n) * (t1 + t2) + shift).sinh().powi(-2)).sum::<f64>();
    let m11 = density * PI * (a * a + 2.0 * c * c * sum(t1));
    let m22 = density * PI * (b * b + 2.0 * c * c * sum(t2));
    let m12 = 2.0 * density * PI * c * c * sum(0.0);
    let m = added_mass_of_discs([a, b], d, density, 96);
    assert_close(&[m[0][0], m[3][3], m[0][3], m[1][4]], &[m11, m22, -m12, m12], 2e-15);
}

#[test]
fn added_mass_of_disc_beside_a_wall() {
    // By symmetry two discs that approach, or go side by side in step, are one disc and its mirror image in the wall.
    let (a, h): (f64, f64) = (1.0, 1.4);
    let mu = (h / a).acosh();
    let sum: f64 = (2..80).map(|k| (mu.sinh() / (f64::from(k) * mu).sinh()).powi(2)).sum();
    let exact = PI * a * a * (1.0 + 2.0 * sum);
    let m = added_mass_of_discs([a, a], 2.0 * h, 1.0, 96);
    assert_close(&[m[0][0] - m[0][3], m[1][1] + m[1][4]], &[exact, exact], 2e-15);
}

#[test]
fn mass_matrix_is_symmetric_and_positive_definite() {
    let links = [
        [link(Shape::Ellipse { a: 1.0, b: 0.3 }, 0.5, 64)],
        [link(Shape::Star { radius: 0.5, amplitude: 0.2, lobes: 3 }, 2.0, 96)],
        [link(Shape::Rectangle { width: 1.0, height: 0.5, radius: Some(0.1) }, 1.0, 128)],
    ];
    let bodies = [
        body(&links[0], [-1.6, 0.3, 0.4], [0.0; 3]),
        body(&links[1], [0.2, -0.8, 1.0], [0.0; 3]),
        body(&links[2], [1.5, 0.5, 0.3], [0.0; 3]),
    ];
    let obstacles = [wall(disc(0.4), [0.1, 1.3], 0.0, 64)];
    let tank = Some(wall(Shape::Ellipse { a: 4.0, b: 3.0 }, [0.0, 0.0], 0.1, 128));
    let scene = Scene { tank, obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let mut sim = at_start(&scene);
    let m = matrix(&mut sim.view(), |sim, out| sim.mass_matrix(out));
    let transposed: Vec<f64> = (0..9).flat_map(|i| m.iter().map(move |column| column[i])).collect();
    assert_eq!(m.concat(), transposed);
    // Sylvester: every pivot of the elimination is positive.
    let mut rows = m;
    for k in 0..9 {
        assert!(rows[k][k] > 0.0, "pivot {k} is {}", rows[k][k]);
        let row = rows[k].clone();
        for other in rows.iter_mut().skip(k + 1) {
            let factor = other[k] / row[k];
            other.iter_mut().zip(&row).for_each(|(o, r)| *o -= factor * r);
        }
    }
}

#[test]
fn two_ellipses_of_the_paper_pass_as_tabulated() {
    let links = paper_ellipse(240);
    let bodies = two_ellipses(&links);
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-12));
    let mut sim = sim.view();
    // Position and heading of the first body at t, tolerance. The gap falls to 0.118 near t = 7.
    let table = [
        (4.0, [-0.0631558367301, -1.1605272570319, 0.1087586354437], 1e-11),
        (8.0, [-1.95119755853, -1.19464491956, 0.69460723836], 4e-11),
        (16.0, [-4.4566299139, -0.0703918602, 2.6164405953], 2e-10),
    ];
    for (t, exact, tolerance) in table {
        sim.advance(t).unwrap();
        assert_eq!(sim.time(), t);
        let q = &sim.positions()[..3];
        println!("t = {t}: error {:.1e}, {:?}", difference(q, &exact), sim.counters());
        for (computed, exact) in q.iter().zip(exact) {
            assert_near(*computed, exact, tolerance);
        }
    }
}

#[test]
fn two_eggs_fly_as_tabulated() {
    let links =
        [[link(Shape::Ellipse { a: 2.0, b: 1.0 }, 1.0, 128)], [link(Shape::Ellipse { a: 1.5, b: 0.8 }, 1.0, 128)]];
    let bodies = [
        body(&links[0], [0.0, 0.0, PI / 3.0], [0.5, 0.0, -0.5]),
        body(&links[1], [3.0, 3.0, PI / 4.0], [-0.6, 0.5, 0.0]),
    ];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-11));
    let mut sim = sim.view();
    sim.advance(10.0).unwrap();
    let exact =
        [7.2064755992337, -1.1070979855674, -1.2591097272845, -2.8584118752586, 7.6710947047387, 0.8190183042321];
    println!("error {:.1e}, {:?}", difference(sim.positions(), &exact), sim.counters());
    assert_close(sim.positions(), &exact, 3e-11);
}

/// Links of the three-link swimmer: the middle one, the one behind it, the one before it. Hinges lie a + c = 1.2 from
/// the centres; the angles are −cos t behind and sin t in front.
fn three_links<'a>(
    b: f64,
    nodes: usize,
    behind: &'a [Harmonic<f64>],
    front: &'a [Harmonic<f64>],
) -> [Link<'a, f64>; 3] {
    let middle = link(Shape::Ellipse { a: 1.0, b }, 1.0, nodes);
    let motion = |terms| Drive::Motion(Signal::Harmonic { terms, window: None });
    [
        middle,
        hinged(middle, 0, [-1.2, 0.0], [1.2, 0.0], motion(behind)),
        hinged(middle, 0, [1.2, 0.0], [-1.2, 0.0], motion(front)),
    ]
}

#[test]
fn three_link_swimmer_moves_as_tabulated() {
    let sine = |phase| [Harmonic { amplitude: 1.0, frequency: 1.0, phase, offset: 0.0 }];
    let (behind, front) = (sine(-PI / 2.0), sine(0.0));
    // Half-width of the links, nodes, displacement of the middle link in one period.
    let table = [(0.2, 96, [-1.0224076186636, 0.2806998872847]), (0.1, 160, [-1.7892077654792, 0.5260872699337])];
    for (b, nodes, exact) in table {
        let links = three_links(b, nodes, &behind, &front);
        let with = |velocity| [Body { velocity, ..body(&links, [0.0; 3], [0.0; 3]) }];
        let scene = Scene::new(1.0, 0.0);
        let impulse = |velocity| {
            let bodies = with(velocity);
            at_start(&Scene { bodies: &bodies, ..scene }).view().impulse().unwrap()
        };
        // The impulse is an affine function of the velocity of the root: start where it is zero.
        let rest = impulse([0.0; 3]);
        let columns: Vec<Vec<f64>> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|unit| impulse(unit).iter().zip(rest).map(|(i, r)| i - r).collect())
            .to_vec();
        let start = solve(&columns, &rest.map(|x| -x));
        let bodies = with([start[0], start[1], start[2]]);
        let mut sim = simulation(&Scene { bodies: &bodies, ..scene }, adams(1e-12));
        let mut sim = sim.view();
        assert_close(&[sim.impulse().unwrap(), [1.0; 3]].concat(), &[[0.0; 3], [1.0; 3]].concat(), 1e-13);
        sim.advance(2.0 * PI).unwrap();
        let q = sim.positions()[..3].to_vec();
        let way = holonomy(b, nodes);
        println!("b = {b}: {q:?}, by the connection {way:?}, {:?}", sim.counters());
        assert_close(&q, &[way[0], way[1], 0.0], 1e-12);
        assert_close(&q, &[exact[0], exact[1], 0.0], 1e-12);
        assert_close(&[sim.impulse().unwrap(), [1.0; 3]].concat(), &[[0.0; 3], [1.0; 3]].concat(), 1e-13);
    }
}

/// The same displacement without integrating motion: at zero impulse the velocity of the middle link, in its own frame, is a
/// function of the time alone, found here from the mass matrix at equidistant times. Everything is periodic, so that sums
/// over a period converge geometrically.
fn holonomy(b: f64, nodes: usize) -> [f64; 2] {
    const SAMPLES: usize = 160;
    let reach = 1.2;
    let times: Vec<f64> = (0..SAMPLES).map(|k| 2.0 * PI * k as f64 / SAMPLES as f64).collect();
    let velocities: Vec<Vec<f64>> = times
        .iter()
        .map(|t| {
            let (u, du) = ([-t.cos(), t.sin()], [t.sin(), t.cos()]);
            let middle = link(Shape::Ellipse { a: 1.0, b }, 1.0, nodes);
            let links = [
                middle,
                hinged(middle, 0, [-reach, 0.0], [reach, 0.0], Drive::Locked(u[0])),
                hinged(middle, 0, [reach, 0.0], [-reach, 0.0], Drive::Locked(u[1])),
            ];
            let bodies = [body(&links, [0.0; 3], [0.0; 3])];
            let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
            let mut sim = sim.view();
            let mass = matrix(&mut sim, |sim, out| sim.mass_matrix(out));
            // Motions of all links: by the velocity of the first, and by the joints.
            let unit = |k: usize| -> Vec<f64> {
                let of_link = |q: &[f64]| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-q[1], q[0], 1.0]][k];
                sim.positions().chunks(3).flat_map(of_link).collect()
            };
            let units = [unit(0), unit(1), unit(2)];
            let mut strokes = vec![0.0; 9];
            for (k, side) in [-1.0, 1.0].into_iter().enumerate() {
                let (s, c) = u[k].sin_cos();
                let joint = [-side * reach * s * du[k], side * reach * c * du[k], du[k]];
                strokes[3 * k + 3..3 * k + 6].copy_from_slice(&joint);
            }
            let momenta: Vec<Vec<f64>> = units.iter().map(|unit| nekton_tests::times(&mass, unit)).collect();
            let columns: Vec<Vec<f64>> =
                momenta.iter().map(|p| units.iter().map(|unit| inner(unit, p)).collect()).collect();
            let stroke = nekton_tests::times(&mass, &strokes);
            solve(&columns, &units.iter().map(|unit| -inner(unit, &stroke)).collect::<Vec<_>>())
        })
        .collect();
    // Heading: the integral of the trigonometric interpolant of the angular velocity, whose mean is zero.
    let heading = |t: f64| -> f64 {
        let scale = 2.0 / SAMPLES as f64;
        (1..SAMPLES / 2)
            .map(|m| {
                let m = m as f64;
                let term = |(s, v): (&f64, &Vec<f64>)| v[2] * ((m * (t - s)).sin() + (m * s).sin()) / m;
                scale * times.iter().zip(&velocities).map(term).sum::<f64>()
            })
            .sum()
    };
    let mut way = [0.0; 2];
    for (t, v) in times.iter().zip(&velocities) {
        let (s, c) = heading(*t).sin_cos();
        way[0] += (c * v[0] - s * v[1]) * 2.0 * PI / SAMPLES as f64;
        way[1] += (s * v[0] + c * v[1]) * 2.0 * PI / SAMPLES as f64;
    }
    way
}
