//! What the motion conserves, and what it does not.

use nekton::Sim;
use nekton::scene::{Body, Drive, Harmonic, Link, Quadrature, Repulsion, Root, Scene, Shape, Signal, Wall, Window};
use nekton_tests::*;

const OBSTACLES: [Wall<'static, f64>; 2] = [
    Wall {
        shape: Shape::Rectangle { width: 3.0, height: 0.4, radius: Some(0.2) },
        position: [0.2, 1.0],
        angle: 0.1,
        nodes: 128,
        circulation: 0.0,
    },
    Wall {
        shape: Shape::Rectangle { width: 2.0, height: 0.5, radius: Some(0.2) },
        position: [-0.4, -1.2],
        angle: 0.0,
        nodes: 128,
        circulation: 0.0,
    },
];

/// Three free bodies of different densities.
fn three(nodes: usize, circulations: [f64; 3]) -> [[Link<'static, f64>; 1]; 3] {
    let one = |shape, density, circulation| [Link { circulation, ..link(shape, density, nodes) }];
    [
        one(Shape::Ellipse { a: 0.7, b: 0.35 }, 0.8, circulations[0]),
        one(disc(0.5), 1.3, circulations[1]),
        one(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 2 }, 1.1, circulations[2]),
    ]
}

fn bodies<'a>(links: &'a [[Link<'a, f64>; 1]; 3]) -> [Body<'a, f64>; 3] {
    [
        body(&links[0], [-1.5, 0.3, 0.3], [0.3, -0.1, 0.5]),
        body(&links[1], [0.4, -0.9, 0.0], [-0.1, 0.3, -0.2]),
        body(&links[2], [1.2, 0.9, -0.5], [-0.3, -0.1, 0.4]),
    ]
}

/// Largest change of the total energy less the work of the joints, and the largest kinetic energy.
fn drift(sim: &mut Sim<'_, f64>, duration: f64) -> (f64, f64) {
    let balance = |sim: &mut Sim<'_, f64>| {
        let energy = sim.energy().unwrap();
        (energy.total - energy.work, energy.kinetic_bodies + energy.kinetic_fluid)
    };
    let (start, mut kinetic) = balance(sim);
    let mut drift = 0.0_f64;
    for k in 1..=10 {
        sim.advance(duration * f64::from(k) / 10.0).unwrap();
        let (total, motion) = balance(sim);
        drift = drift.max((total - start).abs());
        kinetic = kinetic.max(motion);
    }
    println!("drift {drift:.1e} of {kinetic:.1e}, gap {:?}, {:?}", sim.gap().distance, sim.counters());
    (drift, kinetic)
}

#[test]
fn energy_of_free_bodies_with_every_term_is_conserved() {
    let links = three(64, [0.6, -0.9, 0.4]);
    let bodies = bodies(&links);
    let obstacles = [Wall { circulation: 0.3, ..wall(disc(0.3), [-0.2, 1.4], 0.0, 64) }];
    let tank = Some(wall(Shape::Ellipse { a: 4.0, b: 3.2 }, [0.0, 0.0], 0.2, 128));
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    let scene = Scene { tank, repulsion, obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.1, 0.5) };
    let (drift, kinetic) = drift(&mut simulation(&scene, adams(1e-11)).view(), 1.5);
    assert!(drift <= 3e-10 * kinetic, "{drift:e} of {kinetic:e}");
}

#[test]
fn energy_is_conserved_even_when_space_is_not_resolved() {
    let links = three(12, [0.0; 3]);
    let bodies = bodies(&links);
    // Nodes that follow the configuration would change the discrete energy as they move.
    let scene =
        Scene { quadrature: Quadrature::Plain, allow_unresolved: true, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let (drift, kinetic) = drift(&mut simulation(&scene, adams(1e-11)).view(), 2.0);
    assert!(drift <= 3e-10 * kinetic, "{drift:e} of {kinetic:e}");
}

/// Largest change of the impulse until `duration`, relative to its largest component.
fn impulse_drift(scene: &Scene<'_, f64>, duration: f64) -> f64 {
    let mut sim = simulation(scene, adams(1e-11));
    let mut sim = sim.view();
    let start = sim.impulse().unwrap();
    let mut drift = 0.0_f64;
    for k in 1..=5 {
        sim.advance(duration * f64::from(k) / 5.0).unwrap();
        drift = drift.max(difference(&sim.impulse().unwrap(), &start));
    }
    println!("impulse {start:?}, drift {drift:.1e}, gap {:?}, {:?}", sim.gap().distance, sim.counters());
    drift
}

#[test]
fn impulse_of_free_bodies_is_conserved_at_any_resolution() {
    // The discrete added mass moves with the bodies as a whole: Noether's theorem holds for it as it is.
    for nodes in [24, 64] {
        let links = three(nodes, [0.0; 3]);
        let bodies = bodies(&links);
        let drift = impulse_drift(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, 1.5);
        assert!(drift <= 1.5e-10, "{nodes} nodes: {drift:e}");
    }
}

#[test]
fn impulse_of_circulating_bodies_is_conserved() {
    // With the canonical impulse of the circulations; their sum is not zero. Two bodies, and three of them.
    for nodes in [24, 64] {
        let links = three(nodes, [0.6, -0.9, 0.4]);
        let bodies = bodies(&links);
        for bodies in [&bodies[..2], &bodies] {
            let drift = impulse_drift(&Scene { bodies, ..Scene::new(1.1, 0.0) }, 1.5);
            assert!(drift <= 5e-10, "{nodes} nodes, {} bodies: {drift:e}", bodies.len());
        }
    }
}

#[test]
fn impulse_is_not_conserved_in_the_paper_model_of_circulation() {
    let links = three(64, [0.6, -0.9, 0.4]);
    let bodies = bodies(&links);
    let circulation = nekton::scene::CirculationModel::Paper;
    let drift = impulse_drift(&Scene { circulation, bodies: &bodies[..2], ..Scene::new(1.1, 0.0) }, 1.5);
    assert!(drift >= 0.1, "{drift:e}");
}

#[test]
fn impulse_is_the_sum_of_the_momenta() {
    let links = three(64, [0.0; 3]);
    let bodies = bodies(&links);
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    let mut sim = sim.view();
    let p = times(&matrix(&mut sim, |sim, out| sim.mass_matrix(out)), sim.velocities());
    let mut sum = [0.0; 3];
    for (q, p) in sim.positions().chunks(3).zip(p.chunks(3)) {
        sum[0] += p[0];
        sum[1] += p[1];
        sum[2] += p[2] + q[0] * p[1] - q[1] * p[0];
    }
    assert_close(&sim.impulse().unwrap(), &sum, 2e-15);
}

#[test]
fn energy_is_the_quadratic_form_of_the_mass_matrices() {
    let links = three(64, [0.0; 3]);
    let bodies = bodies(&links);
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    let mut sim = sim.view();
    let energy = sim.energy().unwrap();
    let qd = sim.velocities().to_vec();
    let all = 0.5 * inner(&times(&matrix(&mut sim, |sim, out| sim.mass_matrix(out)), &qd), &qd);
    let fluid = 0.5 * inner(&times(&matrix(&mut sim, |sim, out| sim.added_mass(out)), &qd), &qd);
    assert_close(&[energy.kinetic_fluid, energy.kinetic_bodies], &[fluid, all - fluid], 2e-15);
}

#[test]
fn momentum_form_gives_the_same_motion_as_the_acceleration_form() {
    // ṗ = ½ ∂(q̇ᵀ M q̇)/∂q with p = M q̇, by differences of M alone, integrated here by the classical Runge–Kutta method.
    let ellipse = |a, b, density| [link(Shape::Ellipse { a, b }, density, 24)];
    let links = [ellipse(0.8, 0.5, 0.8), ellipse(0.6, 0.4, 1.4)];
    let bodies =
        [body(&links[0], [-0.9, 0.1, 0.4], [0.5, 0.1, 0.3]), body(&links[1], [0.9, -0.2, -0.3], [-0.4, 0.2, 0.6])];
    let obstacles = [wall(disc(0.4), [0.1, 1.4], 0.0, 24)];
    let scene = Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let placed = |q: &[f64]| {
        let mut placed = bodies;
        placed.iter_mut().zip(q.chunks(3)).for_each(|(body, q)| body.pose.copy_from_slice(q));
        placed
    };
    let mass = |sim: &mut Sim<'_, f64>| matrix(sim, |sim, out| sim.mass_matrix(out));
    let rate = |y: &[f64]| -> Vec<f64> {
        let (q, p) = y.split_at(6);
        let bodies = placed(q);
        let scene = Scene { bodies: &bodies, ..scene };
        let qd = solve(&mass(&mut at_start(&scene).view()), p);
        let force = derivatives(&scene, |sim| vec![0.5 * inner(&times(&mass(sim), &qd), &qd)]);
        qd.iter().copied().chain(force.concat()).collect()
    };
    let mut sim = simulation(&scene, adams(1e-12));
    let mut sim = sim.view();
    let momentum = times(&mass(&mut sim), sim.velocities());
    let start: Vec<f64> = sim.positions().iter().copied().chain(momentum).collect();
    let duration = 0.3;
    let integrate = |steps: u32| {
        let (mut y, h) = (start.clone(), duration / f64::from(steps));
        for _ in 0..steps {
            let shifted = |k: &[f64], c: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + c * k).collect() };
            let k1 = rate(&y);
            let k2 = rate(&shifted(&k1, h / 2.0));
            let k3 = rate(&shifted(&k2, h / 2.0));
            let k4 = rate(&shifted(&k3, h));
            y = (0..12).map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])).collect();
        }
        y
    };
    // Richardson's extrapolation of order 4.
    let (coarse, fine) = (integrate(8), integrate(16));
    let exact: Vec<f64> = coarse.iter().zip(&fine).map(|(c, f)| f + (f - c) / 15.0).collect();
    sim.advance(duration).unwrap();
    let gap = sim.gap().distance;
    assert!(gap > 0.3, "{gap}");
    let momentum = times(&mass(&mut sim), sim.velocities());
    println!("{:.1e}, {:.1e}", difference(sim.positions(), &exact[..6]), difference(&momentum, &exact[6..]));
    assert_close(sim.positions(), &exact[..6], 1e-11);
    assert_close(&momentum, &exact[6..], 5e-11);
}

#[test]
fn gyroscopic_matrix_without_circulation_is_zero_whatever_the_memory_held() {
    let links = three(32, [0.0; 3]);
    let bodies = bodies(&links);
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.1, 0.0) });
    let g = matrix(&mut sim.view(), |sim, out| sim.gyroscopic(out)).concat();
    assert!(g.iter().all(|x| *x == 0.0), "{g:?}");
}

#[test]
fn gyroscopic_matrix_is_antisymmetric_and_does_no_work() {
    let links = three(64, [0.6, -0.9, 0.4]);
    let bodies = bodies(&links);
    let tank = Some(wall(Shape::Ellipse { a: 4.0, b: 3.2 }, [0.0, 0.0], 0.2, 128));
    for tank in [None, tank] {
        let mut sim = at_start(&Scene { tank, obstacles: &OBSTACLES[..0], bodies: &bodies, ..Scene::new(1.1, 0.0) });
        let mut sim = sim.view();
        let g = matrix(&mut sim, |sim, out| sim.gyroscopic(out));
        let negative_transpose: Vec<f64> = (0..9).flat_map(|i| g.iter().map(move |column| -column[i])).collect();
        assert_close(&g.concat(), &negative_transpose, 5e-15);
        let qd = sim.velocities().to_vec();
        assert_near(inner(&times(&g, &qd), &qd), 0.0, 1e-15);
    }
}

/// Strokes of a three-link fish, at rest outside of [0.2, 4.2].
const WINDOW: Option<Window<f64>> = Some(Window { from: 0.2, to: 4.2, ramp: 1.5 });
const STROKES: [[Harmonic<f64>; 1]; 2] = [
    [Harmonic { amplitude: 0.6, frequency: 3.0, phase: 0.3, offset: 0.0 }],
    [Harmonic { amplitude: 0.6, frequency: 3.0, phase: -1.0, offset: 0.0 }],
];

fn fish(nodes: usize, density: f64) -> [Link<'static, f64>; 3] {
    let one = link(Shape::Ellipse { a: 0.5, b: 0.2 }, density, nodes);
    let motion = |k: usize| Drive::Motion(Signal::Harmonic { terms: &STROKES[k], window: WINDOW });
    [one, hinged(one, 0, [-0.7, 0.0], [0.7, 0.0], motion(0)), hinged(one, 1, [-0.7, 0.0], [0.7, 0.0], motion(1))]
}

/// Peak speed of a fish that starts at rest, and the speed that is left after its strokes.
fn peak_and_final_speed(scene: &Scene<'_, f64>) -> (f64, f64) {
    let mut sim = simulation(scene, adams(1e-9));
    let mut sim = sim.view();
    let speed = |sim: &Sim<'_, f64>| sim.velocities().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut peak = 0.0_f64;
    for k in 1..=21 {
        sim.advance(0.2 * f64::from(k)).unwrap();
        peak = peak.max(speed(&sim));
    }
    sim.advance(4.3).unwrap();
    println!("peak {peak:.2e}, final {:.2e}, {:?}", speed(&sim), sim.counters());
    (peak, speed(&sim))
}

#[test]
fn fish_alone_ends_at_rest() {
    let links = fish(64, 1.0);
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let (peak, last) = peak_and_final_speed(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    assert!(last <= 1e-15 * peak, "{last:e} of {peak:e}");
}

#[test]
fn fish_between_obstacles_does_not_end_at_rest() {
    let links = fish(64, 1.0);
    let bodies = [body(&links, [0.8, 0.0, 0.0], [0.0; 3])];
    let (peak, last) = peak_and_final_speed(&Scene { obstacles: &OBSTACLES, bodies: &bodies, ..Scene::new(1.0, 0.0) });
    assert!(last >= 1e-3 * peak, "{last:e} of {peak:e}");
}

#[test]
fn energy_of_a_swimmer_changes_by_the_work_of_its_joints() {
    let links = fish(64, 1.2);
    let bodies = [body(&links, [0.8, 0.0, 0.0], [0.1, 0.0, 0.0])];
    let scene = Scene { obstacles: &OBSTACLES, bodies: &bodies, ..Scene::new(1.0, 0.3) };
    let (drift, kinetic) = drift(&mut simulation(&scene, adams(1e-10)).view(), 3.0);
    assert!(drift <= 5e-9 * kinetic, "{drift:e} of {kinetic:e}");
}

#[test]
fn rate_of_the_energy_is_the_power_of_the_joints() {
    let links = fish(64, 1.2);
    let bodies = [body(&links, [0.8, 0.0, 0.0], [0.1, 0.0, 0.0])];
    let scene = Scene { obstacles: &OBSTACLES, bodies: &bodies, ..Scene::new(1.0, 0.3) };
    let mut sim = simulation(&scene, adams(1e-11));
    let mut sim = sim.view();
    let h = 0.01;
    let mut energy = Vec::new();
    let mut power = 0.0;
    for k in -3..=3 {
        sim.advance(1.5 + h * f64::from(k)).unwrap();
        energy.push(sim.energy().unwrap().total);
        if k == 0 {
            let (mut torques, mut powers) = ([0.0; 2], [0.0; 2]);
            sim.joint_torques(&mut torques, &mut powers).unwrap();
            let (mut u, mut du) = ([0.0; 2], [0.0; 2]);
            sim.joint_values(&mut u, &mut du);
            assert_close(&powers, &[torques[0] * du[0], torques[1] * du[1]], 1e-15);
            power = powers.iter().sum();
        }
    }
    let slope = (45.0 * (energy[4] - energy[2]) - 9.0 * (energy[5] - energy[1]) + (energy[6] - energy[0])) / (60.0 * h);
    assert_close(&[slope], &[power], 1e-7);
}

#[test]
fn work_on_a_led_disc_is_the_energy_that_it_gains() {
    // ½ (m + ρπa²) v² + ½ I ω² + (m − m_f) g y, from rest: led up to speed, along, up, and round.
    let (radius, density, gravity, t) = (0.5_f64, 1.4, 2.0, 1.0);
    let area = std::f64::consts::PI * radius * radius;
    let path = |rate: f64| [[0.0, 0.0, 0.0, rate], [2.0, 2.0 * rate, 2.0 * rate, rate]];
    let (along, up, round) = (path(0.7), path(0.4), path(-1.1));
    let root = Root::Prescribed([Signal::Table(&along), Signal::Table(&up), Signal::Table(&round)]);
    let links = [link(disc(radius), density, 16)];
    let bodies = [Body { root, ..body(&links, [0.0; 3], [0.0; 3]) }];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, gravity) }, adams(1e-11));
    let mut sim = sim.view();
    sim.advance(t).unwrap();
    let inertia = 0.5 * density * area * radius * radius;
    let kinetic = 0.5 * ((density + 1.0) * area * (0.7 * 0.7 + 0.4 * 0.4) + inertia * 1.1 * 1.1) * t * t;
    let lifted = (density - 1.0) * area * gravity * 0.5 * 0.4 * t * t;
    assert_close(&[sim.energy().unwrap().work], &[kinetic + lifted], 1e-10);
}

#[test]
fn energy_of_led_bodies_changes_by_the_work_of_their_roots_and_joints() {
    let wave = [Harmonic { amplitude: 0.3, frequency: 2.0, phase: 0.5, offset: 0.1 }];
    let signal = Signal::Harmonic { terms: &wave, window: None };
    let one = link(Shape::Ellipse { a: 0.5, b: 0.2 }, 1.2, 64);
    let free =
        Drive::Torque { torque: Signal::Constant(0.2), stiffness: 0.0, damping: 0.0, rest: 0.0, start: [0.2, 0.0] };
    let links = [
        one,
        hinged(one, 0, [-0.7, 0.0], [0.7, 0.0], Drive::Motion(signal)),
        hinged(one, 1, [-0.7, 0.0], [0.7, 0.0], free),
    ];
    let root = Root::Prescribed([signal, Signal::Constant(0.1), signal]);
    let obstacles = [wall(disc(0.4), [-0.4, 1.6], 0.0, 64)];
    let other = [link(disc(0.3), 0.8, 64)];
    let bodies = [Body { root, ..body(&links, [0.8, 0.0, 0.0], [0.0; 3]) }, body(&other, [2.2, 0.2, 0.0], [0.0; 3])];
    let scene = Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.3) };
    let (drift, kinetic) = drift(&mut simulation(&scene, adams(1e-10)).view(), 0.8);
    assert!(drift <= 5e-9 * kinetic, "{drift:e} of {kinetic:e}");
}
