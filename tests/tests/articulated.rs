//! Articulated bodies: joints that are moved, driven or held.

use nekton::scene::{Body, Drive, Harmonic, Joint, JointKind, Link, Root, Scene, Shape, Signal, Wall, Window};
use nekton::{Formulation, Sim};
use nekton_tests::*;

const ANCHOR: f64 = 0.7;
const WINDOW: Option<Window<f64>> = Some(Window { from: 0.2, to: 3.2, ramp: 1.5 });
const STROKES: [[Harmonic<f64>; 1]; 2] = [
    [Harmonic { amplitude: 0.6, frequency: 3.0, phase: 0.3, offset: 0.0 }],
    [Harmonic { amplitude: 0.5, frequency: 2.5, phase: -1.0, offset: 0.0 }],
];

fn segment(density: f64, nodes: usize) -> Link<'static, f64> {
    link(Shape::Ellipse { a: 0.5, b: 0.2 }, density, nodes)
}

/// Three links in a row with two hinges.
fn chain<'a>(density: f64, nodes: usize, drives: [Drive<'a, f64>; 2]) -> [Link<'a, f64>; 3] {
    let one = segment(density, nodes);
    [
        one,
        hinged(one, 0, [-ANCHOR, 0.0], [ANCHOR, 0.0], drives[0]),
        hinged(one, 1, [-ANCHOR, 0.0], [ANCHOR, 0.0], drives[1]),
    ]
}

fn strokes(window: Option<Window<f64>>) -> [Drive<'static, f64>; 2] {
    [0, 1].map(|k: usize| Drive::Motion(Signal::Harmonic { terms: &STROKES[k], window }))
}

/// A driven hinge without spring or damper.
fn torque(torque: Signal<'_, f64>, start: [f64; 2]) -> Drive<'_, f64> {
    Drive::Torque { torque, stiffness: 0.0, damping: 0.0, rest: 0.0, start }
}

fn obstacle() -> [Wall<'static, f64>; 1] {
    [wall(disc(0.4), [-0.4, 1.2], 0.0, 64)]
}

fn joint_values(sim: &Sim<'_, f64>) -> ([f64; 2], [f64; 2]) {
    let (mut u, mut du) = ([f64::NAN; 2], [f64::NAN; 2]);
    sim.joint_values(&mut u, &mut du);
    (u, du)
}

#[test]
fn prescribed_motion_gives_torques_that_give_the_motion_back() {
    let scene = Scene::new(1.0, 0.0);
    let obstacles = obstacle();
    let moved = chain(1.2, 48, strokes(WINDOW));
    let bodies = [body(&moved, [0.0; 3], [0.0; 3])];
    let mut prescribed = simulation(&Scene { obstacles: &obstacles, bodies: &bodies, ..scene }, adams(1e-11));
    let mut prescribed = prescribed.view();

    // Torques every h; they and their derivatives vanish at both ends of the window.
    let (h, rows) = (0.01, 341);
    let mut samples = Vec::new();
    for k in 0..rows {
        let t = h * k as f64;
        if k > 0 {
            prescribed.advance(t).unwrap();
        }
        let (mut torques, mut powers) = ([f64::NAN; 2], [f64::NAN; 2]);
        prescribed.joint_torques(&mut torques, &mut powers).unwrap();
        samples.push(torques);
    }
    let table = |joint: usize| -> Vec<[f64; 4]> {
        let at = |k: isize| samples[k.clamp(0, rows as isize - 1) as usize][joint];
        (0..rows as isize)
            .map(|k| {
                let odd = |j: isize| at(k + j) - at(k - j);
                let even = |j: isize| at(k + j) + at(k - j);
                let first = (45.0 * odd(1) - 9.0 * odd(2) + odd(3)) / (60.0 * h);
                let second = (270.0 * even(1) - 27.0 * even(2) + 2.0 * even(3) - 490.0 * at(k)) / (180.0 * h * h);
                [h * k as f64, at(k), first, second]
            })
            .collect()
    };
    let (first, second) = (table(0), table(1));
    let start = |k: usize| {
        let (u, du) = ([0.0; 2], [0.0; 2]);
        [u[k], du[k]]
    };
    let driven = chain(1.2, 48, [torque(Signal::Table(&first), start(0)), torque(Signal::Table(&second), start(1))]);
    let bodies = [body(&driven, [0.0; 3], [0.0; 3])];
    let mut free = simulation(&Scene { obstacles: &obstacles, bodies: &bodies, ..scene }, adams(1e-11));
    let mut free = free.view();
    free.advance(h * (rows - 1) as f64).unwrap();
    println!("{:.1e}", difference(free.positions(), prescribed.positions()));
    assert_close(free.positions(), prescribed.positions(), 2e-9);
    let (u, _) = joint_values(&free);
    let (exact, _) = joint_values(&prescribed);
    for (u, exact) in u.iter().zip(exact) {
        assert_near(*u, exact, 5e-9);
    }
}

#[test]
fn torque_driven_accelerations_are_the_prescribed_ones_at_the_torques_of_the_prescribed_motion() {
    // The same statement at one instant, to rounding.
    let obstacles = obstacle();
    let scene = Scene { obstacles: &obstacles, ..Scene::new(1.0, 0.7) };
    let moved = chain(1.2, 64, strokes(None));
    let bodies = [body(&moved, [0.1, 0.2, 0.3], [0.2, -0.1, 0.4])];
    let mut prescribed = at_start(&Scene { bodies: &bodies, ..scene });
    let mut prescribed = prescribed.view();
    let exact = vector(&mut prescribed, |sim, out| sim.accelerations(out));
    let (mut torques, mut powers) = ([f64::NAN; 2], [f64::NAN; 2]);
    prescribed.joint_torques(&mut torques, &mut powers).unwrap();
    let (u, du) = joint_values(&prescribed);
    let drives = [0, 1].map(|k: usize| torque(Signal::Constant(torques[k]), [u[k], du[k]]));
    let driven = chain(1.2, 64, drives);
    let bodies = [body(&driven, [0.1, 0.2, 0.3], [0.2, -0.1, 0.4])];
    let mut driven = at_start(&Scene { bodies: &bodies, ..scene });
    let accelerations = vector(&mut driven.view(), |sim, out| sim.accelerations(out));
    assert_close(&accelerations, &exact, 5e-14);
}

#[test]
fn hinges_stay_together() {
    let links = chain(1.2, 48, strokes(WINDOW));
    let bodies = [body(&links, [0.3, -0.2, 0.4], [0.2, 0.1, 0.3])];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-8));
    let mut sim = sim.view();
    sim.advance(1.7).unwrap();
    let (u, du) = joint_values(&sim);
    for (k, (pair, rates)) in sim.positions().windows(6).zip(sim.velocities().windows(6)).step_by(3).enumerate() {
        let end = |q: &[f64], side: f64| [q[0] + side * ANCHOR * q[2].cos(), q[1] + side * ANCHOR * q[2].sin()];
        let (behind, front) = (end(&pair[..3], -1.0), end(&pair[3..], 1.0));
        assert_near(behind[0], front[0], 1e-15);
        assert_near(behind[1], front[1], 2e-15);
        assert_near(pair[5] - pair[2], u[k], 1e-15);
        assert_near(rates[5] - rates[2], du[k], 1e-15);
    }
}

#[test]
fn swimmer_in_vacuum_keeps_its_centre_of_mass_and_angular_momentum() {
    let mut links = chain(1.2, 32, strokes(None));
    links[1].shape = Shape::Ellipse { a: 0.5, b: 0.3 };
    let bodies = [body(&links, [0.3, -0.2, 0.4], [0.2, 0.1, 0.3])];
    for shortcuts in [true, false] {
        let mut sim = simulation(&Scene { shortcuts, bodies: &bodies, ..Scene::new(0.0, 0.0) }, adams(1e-12));
        let mut sim = sim.view();
        let masses: Vec<(f64, f64)> =
            (0..3).map(|i| sim.model().link(i).unwrap()).map(|link| (link.mass, link.inertia)).collect();
        let moments = |sim: &Sim<'_, f64>| {
            let (mut centre, mut momentum, mut angular, mut total) = ([0.0; 2], [0.0; 2], 0.0, 0.0);
            for ((m, i), (q, v)) in masses.iter().zip(sim.positions().chunks(3).zip(sim.velocities().chunks(3))) {
                total += m;
                for k in 0..2 {
                    centre[k] += m * q[k];
                    momentum[k] += m * v[k];
                }
                angular += i * v[2] + m * (q[0] * v[1] - q[1] * v[0]);
            }
            (centre.map(|c| c / total), momentum.map(|p| p / total), angular)
        };
        let (centre, speed, angular) = moments(&sim);
        for k in 1..=4 {
            let t = 0.5 * f64::from(k);
            sim.advance(t).unwrap();
            let (now, still, turning) = moments(&sim);
            for k in 0..2 {
                assert_near(now[k], centre[k] + speed[k] * t, 2e-11);
                assert_near(still[k], speed[k], 1e-11);
            }
            assert_near(turning, angular, 1e-11);
        }
    }
}

#[test]
fn slider_in_vacuum_moves_both_links_about_their_common_centre_of_mass() {
    let axis = [3.0, 4.0];
    let stroke = [Harmonic { amplitude: 0.4, frequency: 2.0, phase: 0.0, offset: 2.5 }];
    let joint = Joint {
        parent: 0,
        kind: JointKind::Slider { axis, angle: 0.3 },
        parent_anchor: [0.1, 0.0],
        self_anchor: [0.0, 0.2],
        drive: Drive::Motion(Signal::Harmonic { terms: &stroke, window: None }),
    };
    let first = segment(1.0, 32);
    let second = Link { joint: Some(joint), ..segment(3.0, 32) };
    let links = [first, second];
    // At the start u̇ = 0.8; the root moves so that the total momentum is zero.
    let mut bodies = [body(&links, [0.0; 3], [0.0; 3])];
    bodies[0].velocity = [-0.75 * 0.8 * 0.6, -0.75 * 0.8 * 0.8, 0.0];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, adams(1e-12));
    let mut sim = sim.view();
    let start = sim.positions().to_vec();
    let centre = |q: &[f64], k: usize| 0.25 * q[k] + 0.75 * q[3 + k];
    sim.advance(1.3).unwrap();
    let q = sim.positions();
    assert_near(centre(q, 0), centre(&start, 0), 1e-13);
    assert_near(centre(q, 1), centre(&start, 1), 1e-13);
    assert_near(q[5] - q[2], 0.3, 1e-15);
    // Anchor of the second link, in the frame of the first, lies on the axis at u from the anchor of the first.
    let turned = |v: [f64; 2], angle: f64| {
        let (s, c) = angle.sin_cos();
        [c * v[0] - s * v[1], s * v[0] + c * v[1]]
    };
    let tip = turned([0.0, 0.2], q[5]);
    let offset = turned([q[3] + tip[0] - q[0], q[4] + tip[1] - q[1]], -q[2]);
    let u = 2.5 + 0.4 * (2.0_f64 * 1.3).sin();
    assert_near(offset[0] - 0.1, 0.6 * u, 1e-15);
    assert_near(offset[1], 0.8 * u, 1e-15);
    let (mut value, mut rate) = ([f64::NAN], [f64::NAN]);
    sim.joint_values(&mut value, &mut rate);
    assert_near(value[0], u, 1e-15);
    assert_near(rate[0], 0.8 * (2.0_f64 * 1.3).cos(), 1e-15);
}

#[test]
fn prescribed_root_moves_as_prescribed() {
    let wave = [Harmonic { amplitude: 0.3, frequency: 2.0, phase: 0.5, offset: 0.1 }];
    let signal = Signal::Harmonic { terms: &wave, window: None };
    let damped =
        Drive::Torque { torque: Signal::Constant(0.0), stiffness: 0.5, damping: 0.5, rest: 0.0, start: [0.2, 0.0] };
    let links = chain(1.2, 48, [Drive::Motion(signal), damped]);
    let root = Root::Prescribed([signal, Signal::Constant(0.4), signal]);
    let bodies = [Body { root, ..body(&links, [0.3, -0.2, 0.4], [0.0; 3]) }];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-8));
    let mut sim = sim.view();
    let t = 0.6;
    sim.advance(t).unwrap();
    assert!(sim.gap().distance > 0.3);
    let value = 0.1 + 0.3 * (2.0_f64 * t + 0.5).sin();
    let rate = 0.6 * (2.0_f64 * t + 0.5).cos();
    for (computed, exact) in sim.positions().iter().zip([0.3 + value, 0.2, 0.4 + value]) {
        assert_near(*computed, exact, 1e-15);
    }
    for (computed, exact) in sim.velocities().iter().zip([rate, 0.0, rate]) {
        assert_near(*computed, exact, 1e-15);
    }
}

#[test]
fn acceleration_of_a_prescribed_root_is_equivalent_to_gravity() {
    let (g, duration) = (2.0, 2.0);
    let rise = [[0.0, 0.0, 0.0, g], [duration, 0.5 * g * duration * duration, g * duration, g]];
    let still = Signal::Constant(0.0);
    let swing = |gravity: f64, height: Signal<'_, f64>| {
        let links = chain(1.2, 32, [torque(still, [-1.2, 0.3]), torque(still, [0.4, 0.0])]);
        let root = Root::Prescribed([still, height, still]);
        let bodies = [Body { root, ..body(&links, [0.0; 3], [0.0; 3]) }];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, gravity) }, adams(1e-11));
        let mut sim = sim.view();
        sim.advance(1.5).unwrap();
        joint_values(&sim).0
    };
    let (lifted, heavy) = (swing(0.0, Signal::Table(&rise)), swing(g, still));
    println!("{lifted:?} {heavy:?}");
    assert_close(&lifted, &heavy, 1e-14);
    assert!((lifted[0] + 1.2).abs() > 0.1, "it does not swing: {lifted:?}");
}

#[test]
fn spring_and_damper_take_what_the_motion_loses() {
    let (stiffness, rest) = (0.7, 0.3);
    for damping in [0.0, 0.2] {
        let drive = |start| Drive::Torque { torque: Signal::Constant(0.0), stiffness, damping, rest, start };
        let links = chain(1.2, 48, [drive([0.8, 0.0]), drive([-0.4, 0.1])]);
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-11));
        let mut sim = sim.view();
        let mechanical = |sim: &mut Sim<'_, f64>| {
            let (u, _) = joint_values(sim);
            let springs: f64 = u.iter().map(|u| 0.5 * stiffness * (u - rest).powi(2)).sum();
            let energy = sim.energy().unwrap();
            energy.kinetic_fluid + energy.kinetic_bodies + springs
        };
        let start = mechanical(&mut sim);
        sim.advance(1.5).unwrap();
        let end = mechanical(&mut sim);
        if damping == 0.0 {
            assert_close(&[end], &[start], 2e-10);
        } else {
            assert!(end < 0.99 * start, "{end} of {start}");
        }
    }
}

#[test]
fn locked_joint_is_a_constant_motion() {
    let run = |drives| {
        let links = chain(1.2, 48, drives);
        let bodies = [body(&links, [0.0; 3], [0.3, 0.2, 0.5])];
        let obstacles = obstacle();
        let mut sim =
            simulation(&Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.4) }, adams(1e-10));
        let mut sim = sim.view();
        sim.advance(0.7).unwrap();
        sim.positions().to_vec()
    };
    let locked = run([Drive::Locked(0.4), Drive::Locked(-0.2)]);
    let constant = run([Drive::Motion(Signal::Constant(0.4)), Drive::Motion(Signal::Constant(-0.2))]);
    assert_eq!(locked, constant);
}

/// Positions and velocities with and without the shortcuts of symmetry.
fn both_ways(scene: &Scene<'_, f64>, t: f64) -> [Vec<f64>; 2] {
    [true, false].map(|shortcuts| {
        let mut sim = simulation(&Scene { shortcuts, ..*scene }, adams(1e-11));
        let mut sim = sim.view();
        assert_eq!(sim.model().plan().formulation == Formulation::Velocity, !shortcuts);
        sim.advance(t).unwrap();
        sim.positions().iter().chain(sim.velocities()).copied().collect()
    })
}

#[test]
fn shortcut_for_a_lone_body_agrees_with_the_general_path() {
    for shape in [Shape::Ellipse { a: 1.0, b: 0.4 }, Shape::Star { radius: 0.7, amplitude: 0.2, lobes: 2 }] {
        for (gravity, circulation) in [(0.0, 0.0), (0.8, 0.0), (0.0, 0.9), (0.8, 0.9)] {
            let links = [Link { circulation, ..link(shape, 1.4, 96) }];
            let bodies = [body(&links, [0.3, 0.2, 0.5], [0.4, -0.3, 0.6])];
            let [short, general] = both_ways(&Scene { bodies: &bodies, ..Scene::new(1.0, gravity) }, 3.0);
            println!("g = {gravity}, γ = {circulation}: {:.1e}", difference(&short, &general));
            assert_close(&short, &general, 1e-10);
        }
    }
}

#[test]
fn shortcut_for_a_lone_swimmer_agrees_with_the_general_path() {
    let links = chain(1.2, 64, strokes(None));
    // From rest of the root and from a motion: the impulse is not zero in either case.
    for velocity in [[0.0; 3], [0.4, -0.3, 0.6]] {
        let bodies = [body(&links, [0.3, 0.2, 0.5], velocity)];
        let [short, general] = both_ways(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, 1.5);
        println!("{:.1e}", difference(&short, &general));
        assert_close(&short, &general, 1e-10);
    }
}

#[test]
fn acceleration_of_a_slider_on_a_turning_link_is_that_of_its_closed_form() {
    // r = r₀ + R(θ) (h + u a) − R(θ + α) o with θ(t) and u(t) given: both derivatives by the product rule, in complex numbers.
    let turn = [Harmonic { amplitude: 0.8, frequency: 1.3, phase: 0.4, offset: 0.2 }];
    let slide = [Harmonic { amplitude: 0.4, frequency: 2.0, phase: 1.0, offset: 2.5 }];
    let wave = |h: &Harmonic<f64>, t: f64| {
        let (s, c) = (h.frequency * t + h.phase).sin_cos();
        [h.offset + h.amplitude * s, h.amplitude * h.frequency * c, -h.amplitude * h.frequency.powi(2) * s]
    };
    let (parent, own, angle) = ([0.1, -0.2], [0.3, 0.2], 0.3);
    let joint = Joint {
        parent: 0,
        kind: JointKind::Slider { axis: [3.0, 4.0], angle },
        parent_anchor: parent,
        self_anchor: own,
        drive: Drive::Motion(Signal::Harmonic { terms: &slide, window: None }),
    };
    // A third link that is free makes the motion of the other two part of an equation.
    let free = hinged(segment(1.0, 16), 1, [-ANCHOR, 0.0], [ANCHOR, 0.0], torque(Signal::Constant(0.0), [0.2, 0.1]));
    let links = [segment(1.0, 16), Link { joint: Some(joint), ..segment(3.0, 16) }, free];
    let still = Signal::Constant(0.0);
    let root = Root::Prescribed([still, still, Signal::Harmonic { terms: &turn, window: None }]);
    let bodies = [Body { root, ..body(&links, [0.3, -0.2, 0.4], [0.0; 3]) }];
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    let mut sim = sim.view();
    let turned = |[x, y]: [f64; 2], angle: f64| {
        let (s, c) = angle.sin_cos();
        [c * x - s * y, s * x + c * y]
    };
    for t in [0.0, 0.7, 1.9] {
        let y = sim.state().to_vec();
        sim.set_state(t, &y).unwrap();
        let ([theta, spin, twist], [u, rate, growth]) = (wave(&turn[0], t), wave(&slide[0], t));
        let heading = 0.4 + theta;
        let axis = turned([0.6, 0.8], heading);
        let (h, o) = (turned(parent, heading), turned(own, heading + angle));
        // What turns with the parent: h + u a − o.
        let arm = [0, 1].map(|k| h[k] + u * axis[k] - o[k]);
        let perp = |v: [f64; 2]| [-v[1], v[0]];
        let (across, turning) = (perp(axis), perp(arm));
        let exact = [0, 1]
            .map(|k| growth * axis[k] + 2.0 * spin * rate * across[k] + twist * turning[k] - spin * spin * arm[k]);
        let accelerations = vector(&mut sim, |sim, out| sim.accelerations(out));
        assert_close(&accelerations[3..6], &[exact[0], exact[1], twist], 1e-14);
        let velocity = [0, 1].map(|k| rate * axis[k] + spin * turning[k]);
        assert_close(&sim.velocities()[3..6], &[velocity[0], velocity[1], spin], 1e-14);
    }
}

#[test]
fn shortcut_for_a_lone_swimmer_with_a_slider_agrees_with_the_general_path() {
    // The one integrates velocities that follow from the impulse, the other accelerations.
    let joint = Joint {
        parent: 0,
        kind: JointKind::Slider { axis: [3.0, 4.0], angle: 0.3 },
        parent_anchor: [0.1, 0.0],
        self_anchor: [0.0, 0.2],
        drive: Drive::Motion(Signal::Harmonic {
            terms: &[Harmonic { amplitude: 0.4, frequency: 2.0, phase: 0.0, offset: 2.5 }],
            window: None,
        }),
    };
    let links = [segment(1.0, 32), Link { joint: Some(joint), ..segment(3.0, 32) }];
    for density in [0.0, 1.0] {
        let bodies = [body(&links, [0.0; 3], [0.1, -0.2, 0.8])];
        let [short, general] = both_ways(&Scene { bodies: &bodies, ..Scene::new(density, 0.0) }, 1.3);
        println!("{:.1e}", difference(&short, &general));
        assert_close(&short, &general, 1e-9);
    }
}
