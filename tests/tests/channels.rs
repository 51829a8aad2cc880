//! Commands that jump: what is integrated and what is told after [`nekton::Sim::set_channel`] belong to the new command alone.

use nekton::scene::{Body, Drive, Joint, JointKind, Link, Mass, Root, Scene, Shape, Signal};
use nekton::{Method, ModelBuf, Sim, SimBuf};
use nekton_tests::*;
use std::sync::Arc;

const MASSES: [f64; 2] = [0.7, 1.9];
const START: [f64; 2] = [2.0, 0.1];

/// A disc.
fn one(mass: f64) -> Link<'static, f64> {
    let mass = Mass::Given { mass, inertia: 0.3, centre_of_mass: [0.0; 2] };
    Link { mass, ..link(disc(0.5), 0.0, 16) }
}

fn slider(drive: Drive<'_, f64>) -> Joint<'_, f64> {
    let kind = JointKind::Slider { axis: [1.0, 0.0], angle: 0.0 };
    Joint { parent: 0, kind, parent_anchor: [0.0; 2], self_anchor: [0.0; 2], drive }
}

/// Two discs in vacuum on a common axis, pushed apart by a force: u″ = ν (1/m₁ + 1/m₂).
fn pushed(method: Method<f64>, look: impl FnOnce(&mut Sim<'_, f64>)) {
    let drive = Drive::Torque { torque: Signal::Channel, stiffness: 0.0, damping: 0.0, rest: 0.0, start: START };
    let links = [one(MASSES[0]), Link { joint: Some(slider(drive)), ..one(MASSES[1]) }];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    look(&mut simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, method).view());
}

/// The same, moved by a channel in a fluid, beside a third disc.
fn moved_beside_another(method: Method<f64>, look: impl FnOnce(&mut Sim<'_, f64>)) {
    let joint = Joint { parent_anchor: [2.0, 0.0], ..slider(Drive::Motion(Signal::Channel)) };
    let links = [one(MASSES[0]), Link { joint: Some(joint), ..one(MASSES[1]) }];
    let alone = [one(1.0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&alone, [0.0, 5.0, 0.0], [0.0; 3])];
    look(&mut simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method).view());
}

fn every_method(tolerance: f64) -> [Method<f64>; 4] {
    let step = 0.05;
    [Method::Rk4 { step }, Method::Abm4 { step }, Method::Gauss6 { step }, adams(tolerance)]
}

fn joint(sim: &Sim<'_, f64>) -> [f64; 2] {
    let (mut u, mut du) = ([f64::NAN], [f64::NAN]);
    sim.joint_values(&mut u, &mut du);
    [u[0], du[0]]
}

fn command(sim: &mut Sim<'_, f64>, force: f64) {
    sim.set_channel(0, [0.0, force, 0.0, 0.0], [100.0, force, 0.0, 0.0]).unwrap();
}

#[test]
fn motion_after_a_jump_of_the_command_is_the_parabola_of_the_new_one() {
    let growth = 1.0 / MASSES[0] + 1.0 / MASSES[1];
    let after = |[u, du]: [f64; 2], force: f64, t: f64| {
        let a = force * growth;
        [u + du * t + 0.5 * a * t * t, du + a * t]
    };
    // Every method is exact for parabolas, unless it looks back, or has looked ahead, across a jump.
    for method in every_method(1e-10) {
        for dense in [false, true] {
            pushed(method, |sim| {
                let mut exact = START;
                for (k, force) in [0.3, -0.5, 0.8, -0.2].into_iter().enumerate() {
                    command(sim, force);
                    let t = 0.5 * (k + 1) as f64;
                    if dense { sim.advance_dense(t, 50.0) } else { sim.advance(t) }.unwrap();
                    exact = after(exact, force, 0.5);
                    let [u, du] = joint(sim);
                    assert_near(u, exact[0], 1e-9);
                    assert_near(du, exact[1], 1e-9);
                    if !matches!(method, Method::Adams { .. }) {
                        assert_near(u, exact[0], 1e-14);
                        assert_near(du, exact[1], 1e-14);
                    }
                }
            });
        }
    }
}

#[test]
fn what_is_told_at_a_jump_of_the_command_is_of_the_new_one() {
    let growth = [-1.0 / MASSES[0], 1.0 / MASSES[1]];
    pushed(Method::Rk4 { step: 0.05 }, |sim| {
        for force in [0.3, -0.5, 0.8] {
            command(sim, force);
            // Asked twice, the second answer may come from the first's evaluation, but never from another command's.
            for _ in 0..2 {
                let accelerations = vector(sim, |sim, out| sim.accelerations(out));
                assert_close(&accelerations, &[force * growth[0], 0.0, 0.0, force * growth[1], 0.0, 0.0], 1e-14);
            }
            let mut power = [f64::NAN];
            let mut told = [f64::NAN];
            sim.joint_torques(&mut told, &mut power).unwrap();
            assert_close(&[told[0], power[0]], &[force, force * START[1]], 1e-14);
        }
    });
}

#[test]
fn a_motion_told_at_a_jump_of_the_command_is_of_the_new_one() {
    // Prescribed: the force that the motion takes, μ u″ for two discs in vacuum.
    let joint = Joint { parent_anchor: [2.0, 0.0], ..slider(Drive::Motion(Signal::Channel)) };
    let links = [one(MASSES[0]), Link { joint: Some(joint), ..one(MASSES[1]) }];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    for shortcuts in [true, false] {
        let mut sim = at_start(&Scene { shortcuts, bodies: &bodies, ..Scene::new(0.0, 0.0) });
        let mut sim = sim.view();
        for growth in [0.4, -0.9] {
            sim.set_channel(0, [0.0, 0.0, 0.0, growth], [1.0, 0.5 * growth, growth, growth]).unwrap();
            let (mut told, mut power) = ([f64::NAN], [f64::NAN]);
            sim.joint_torques(&mut told, &mut power).unwrap();
            assert_close(&told, &[growth / (1.0 / MASSES[0] + 1.0 / MASSES[1])], 1e-14);
        }
    }
}

#[test]
fn adams_goes_on_from_a_jump_of_the_command_with_the_rate_after_it() {
    // Forces that are constant between jumps: with the rate before, a step after a jump errs by h² times the jump, and steps would have
    // to be as short as the root of the tolerance.
    pushed(adams(1e-10), |sim| {
        let mut most = 0;
        for tick in 0..20 {
            let before = sim.counters().evaluations;
            command(sim, if tick % 2 == 0 { 0.8 } else { -0.5 });
            sim.advance(f64::from(tick + 1)).unwrap();
            most = most.max(sim.counters().evaluations - before);
        }
        println!("{most} evaluations");
        assert!(most < 60, "{most}");
    });
}

#[test]
fn what_is_told_on_arriving_at_a_jump_of_a_table_is_of_before_it() {
    let growth = [-1.0 / MASSES[0], 1.0 / MASSES[1]];
    let rows = [(0.0, 0.3), (1.0, 0.3), (1.0, -0.8), (9.0, -0.8)].map(|(t, force)| [t, force, 0.0, 0.0]);
    let drive = Drive::Torque { torque: Signal::Table(&rows), stiffness: 0.0, damping: 0.0, rest: 0.0, start: START };
    let links = [one(MASSES[0]), Link { joint: Some(slider(drive)), ..one(MASSES[1]) }];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    for method in every_method(1e-9) {
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, method);
        let mut sim = sim.view();
        for (until, force) in [(0.9, 0.3), (1.0, 0.3), (1.1, -0.8)] {
            sim.advance(until).unwrap();
            let accelerations = vector(&mut sim, |sim, out| sim.accelerations(out));
            assert_close(&accelerations, &[force * growth[0], 0.0, 0.0, force * growth[1], 0.0, 0.0], 1e-13);
            let (mut told, mut power) = ([f64::NAN], [f64::NAN]);
            sim.joint_torques(&mut told, &mut power).unwrap();
            assert_near(told[0], force, 1e-13);
        }
        // Set there by hand, it is of after.
        let y = sim.state().to_vec();
        sim.set_state(1.0, &y).unwrap();
        let accelerations = vector(&mut sim, |sim, out| sim.accelerations(out));
        assert_near(accelerations[3], -0.8 * growth[1], 1e-13);
    }
}

#[test]
fn a_command_that_tears_a_motion_is_noticed_by_every_method() {
    // The rate jumps: with a second body the momentum is nobody's, and the motion would take an impulse.
    for method in every_method(1e-9) {
        for torn in [false, true] {
            moved_beside_another(method, |sim| {
                sim.set_channel(0, [0.0, 0.0, 0.1, 0.0], [1.0, 0.1, 0.1, 0.0]).unwrap();
                sim.advance(0.5).unwrap();
                assert_eq!(sim.notice(), None, "{method:?}");
                let rate = if torn { 0.3 } else { 0.1 };
                sim.set_channel(0, [0.5, 0.05, rate, 0.0], [1.5, 0.05 + rate, rate, 0.0]).unwrap();
                sim.advance(1.0).unwrap();
                match sim.notice() {
                    Some((t, e)) => {
                        assert!(torn, "{method:?}: {t} {e:?}");
                        assert_near(t, 0.5, 1e-15);
                        assert_eq!((e.status, e.place), (nekton::Status::DriveUnresolved, nekton::Place::Link(0, 1)));
                    }
                    None => assert!(!torn, "{method:?}: not noticed"),
                }
            });
        }
    }
}

#[test]
fn a_motion_torn_by_a_piece_given_early_or_not_followed_is_noticed_by_every_method() {
    let motion = Joint { parent_anchor: [2.0, 0.0], ..slider(Drive::Motion(Signal::Channel)) };
    let push = Drive::Torque { torque: Signal::Channel, stiffness: 1.0, damping: 0.0, rest: 0.0, start: [0.0; 2] };
    let push = Joint { parent_anchor: [-2.0, 0.0], ..slider(push) };
    let links = [one(1.0), Link { joint: Some(motion), ..one(1.0) }, Link { joint: Some(push), ..one(1.0) }];
    let alone = [one(1.0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&alone, [0.0, 5.0, 0.0], [0.0; 3])];
    for method in every_method(1e-9) {
        for early in [true, false] {
            for other in [true, false] {
                let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method);
                let mut sim = sim.view();
                // Moves from 0.5 s on with the rate 0.1, or until then.
                let from = if early { 0.5 } else { 0.0 };
                sim.set_channel(0, [from, 0.0, 0.1, 0.0], [from + 0.5, 0.05, 0.1, 0.0]).unwrap();
                sim.advance(0.5).unwrap();
                assert_eq!(sim.notice(), None, "{method:?}");
                if other {
                    sim.set_channel(1, [0.5, 0.1, 0.0, 0.0], [2.0, 0.1, 0.0, 0.0]).unwrap();
                }
                sim.advance(0.9).unwrap();
                let (t, e) = sim.notice().unwrap_or_else(|| panic!("{method:?} {early} {other}: not noticed"));
                assert_near(t, 0.5, 1e-15);
                assert_eq!((e.status, e.place), (nekton::Status::DriveUnresolved, nekton::Place::Link(0, 1)));
            }
        }
    }
}

#[test]
fn pieces_that_meet_but_for_the_last_digit_of_the_time_continue_each_other() {
    let row = |t: f64| [t, 0.1 * t + 0.02 * (3.0 * t).sin(), 0.1 + 0.06 * (3.0 * t).cos(), -0.18 * (3.0 * t).sin()];
    for method in every_method(1e-9) {
        for dense in [false, true] {
            moved_beside_another(method, |sim| {
                for tick in 0..60 {
                    let (from, to) = (0.05 * f64::from(tick), 0.05 * f64::from(tick) + 0.05);
                    // The energy before the first command is not held against what follows.
                    let drift = sim.energy_drift().unwrap();
                    assert!(drift.amount.abs() <= 1e-3 * drift.kinetic, "{method:?} {dense} {tick}: {drift:?}");
                    sim.set_channel(0, row(from), row(to)).unwrap();
                    let t = 0.05 * f64::from(tick + 1);
                    if dense { sim.advance_dense(t, 10.0) } else { sim.advance(t) }.unwrap();
                    assert_eq!(sim.notice(), None, "{method:?} {dense} {tick}");
                }
            });
        }
    }
}

/// Two ellipses in a fluid, hinged, with a spring; `torque` drives the hinge.
fn hinged_pair(torque: Signal<'_, f64>, method: Method<f64>, look: impl FnOnce(&mut Sim<'_, f64>)) {
    let one = link(nekton::scene::Shape::Ellipse { a: 0.5, b: 0.12 }, 1.0, 24);
    let drive = Drive::Torque { torque, stiffness: 0.5, damping: 0.02, rest: 0.0, start: [0.1, 0.0] };
    let links = [one, hinged(one, 0, [-0.6, 0.0], [0.6, 0.0], drive)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    look(&mut simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method).view());
}

#[test]
fn the_same_command_again_costs_nothing() {
    for (method, most) in [(Method::Abm4 { step: 1e-3 }, 2.1), (Method::Rk4 { step: 1e-3 }, 4.0), (adams(1e-8), 2.2)] {
        hinged_pair(Signal::Channel, method, |sim| {
            for tick in 0..200 {
                let t = 1e-3 * f64::from(tick);
                sim.set_channel(0, [t, 0.2, 0.0, 0.0], [t + 1e-3, 0.2, 0.0, 0.0]).unwrap();
                sim.advance(t + 1e-3).unwrap();
            }
            let each = sim.counters().evaluations as f64 / 200.0;
            println!("{method:?}: {each}");
            assert!(each <= most, "{method:?}: {each}");
        });
    }
}

#[test]
fn a_motion_fed_piece_by_piece_costs_no_more_than_the_same_motion_built_in() {
    let terms = [nekton::scene::Harmonic { amplitude: 0.2, frequency: 5.0, phase: 0.3, offset: 0.0 }];
    let one = link(nekton::scene::Shape::Ellipse { a: 0.5, b: 0.12 }, 1.0, 24);
    let alone = [link(disc(0.4), 1.0, 16)];
    let row = |t: f64| {
        let x = 5.0 * t + 0.3;
        [t, 0.2 * x.sin(), x.cos(), -5.0 * x.sin()]
    };
    for (method, most) in [
        (Method::Rk4 { step: 1e-2 }, 0),
        (Method::Abm4 { step: 1e-2 }, 3),
        (Method::Gauss6 { step: 1e-2 }, 250),
        (adams(1e-8), 40),
    ] {
        let mut evaluations = Vec::new();
        let mut ends = Vec::new();
        for fed in [false, true] {
            let signal = if fed { Signal::Channel } else { Signal::Harmonic { terms: &terms, window: None } };
            let links = [one, hinged(one, 0, [-0.6, 0.0], [0.6, 0.0], Drive::Motion(signal))];
            let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&alone, [0.0, 2.0, 0.0], [0.0; 3])];
            let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method);
            let mut sim = sim.view();
            for tick in 0..200 {
                let (from, to) = (1e-2 * f64::from(tick), 1e-2 * f64::from(tick + 1));
                if fed {
                    sim.set_channel(0, row(from), row(to)).unwrap();
                }
                sim.advance(to).unwrap();
                assert_eq!(sim.notice(), None, "{method:?}");
            }
            evaluations.push(sim.counters().evaluations);
            ends.push(sim.state().to_vec());
        }
        println!("{method:?}: {evaluations:?}, difference {:e}", difference(&ends[0], &ends[1]));
        assert_close(&ends[0], &ends[1], 1e-6);
        assert!(evaluations[1] <= evaluations[0] + most, "{method:?}: {evaluations:?}");
    }
}

#[test]
fn a_piece_given_early_begins_with_a_jump_and_one_that_is_not_followed_ends_with_one() {
    // Given at 0.3 s: ü = 0.5 from 1 s to 2 s, at rest before and held after. The common centre of mass stays where it was.
    for method in every_method(1e-10) {
        let joint = Joint { parent_anchor: [2.0, 0.0], ..slider(Drive::Motion(Signal::Channel)) };
        let links = [one(MASSES[0]), Link { joint: Some(joint), ..one(MASSES[1]) }];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, method);
        let mut sim = sim.view();
        sim.advance(0.3).unwrap();
        sim.set_channel(0, [1.0, 0.0, 0.0, 0.5], [2.0, 0.25, 0.5, 0.5]).unwrap();
        for (t, u) in [(0.9, 0.0), (1.5, 0.0625), (2.0, 0.25), (2.5, 0.25)] {
            sim.advance(t).unwrap();
            assert_near(sim.positions()[0], -u * MASSES[1] / (MASSES[0] + MASSES[1]), 1e-9);
            assert_eq!(sim.notice(), None);
        }
    }
}

#[test]
fn a_channel_fed_with_pieces_of_a_harmonic_costs_at_most_twice_what_the_harmonic_does() {
    let terms = [nekton::scene::Harmonic { amplitude: 0.3, frequency: 5.0, phase: 0.0, offset: 0.0 }];
    let (mut built_in, mut end) = (0, Vec::new());
    hinged_pair(Signal::Harmonic { terms: &terms, window: None }, adams(1e-8), |sim| {
        for tick in 1..=400 {
            sim.advance(1e-2 * f64::from(tick)).unwrap();
        }
        (built_in, end) = (sim.counters().evaluations, sim.state().to_vec());
    });
    hinged_pair(Signal::Channel, adams(1e-8), |sim| {
        let row = |t: f64| [t, 0.3 * (5.0 * t).sin(), 1.5 * (5.0 * t).cos(), -7.5 * (5.0 * t).sin()];
        for tick in 0..400 {
            let (from, to) = (1e-2 * f64::from(tick), 1e-2 * f64::from(tick + 1));
            sim.set_channel(0, row(from), row(to)).unwrap();
            sim.advance(to).unwrap();
            assert_eq!(sim.notice(), None);
        }
        let fed = sim.counters().evaluations;
        println!("built in {built_in}, fed {fed}, difference {:e}", difference(sim.state(), &end));
        assert!(fed <= 2 * built_in, "{fed}, built in {built_in}");
        assert_close(sim.state(), &end, 1e-7);
    });
}

#[test]
fn commands_held_between_ticks_are_followed_by_every_method_as_the_table_of_their_jumps() {
    let force = |tick: u32| 0.2 * f64::from((tick * 7) % 5) - 0.4;
    let rows: Vec<[f64; 4]> = (0..100)
        .flat_map(|tick| [0.02 * f64::from(tick), 0.02 * f64::from(tick + 1)].map(|t| [t, force(tick), 0.0, 0.0]))
        .collect();
    for (method, tolerance) in [
        (adams(1e-9), 1e-7),
        (Method::Rk4 { step: 0.005 }, 1e-12),
        (Method::Abm4 { step: 0.005 }, 1e-12),
        (Method::Gauss6 { step: 0.01 }, 1e-12),
    ] {
        let mut end = Vec::new();
        hinged_pair(Signal::Table(&rows), method, |sim| {
            sim.advance(2.0).unwrap();
            assert_eq!(sim.notice(), None, "{method:?}");
            end = sim.state().to_vec();
        });
        hinged_pair(Signal::Channel, method, |sim| {
            for tick in 0..100 {
                let (from, to) = (0.02 * f64::from(tick), 0.02 * f64::from(tick + 1));
                sim.set_channel(0, [from, force(tick), 0.0, 0.0], [to, force(tick), 0.0, 0.0]).unwrap();
                sim.advance(to).unwrap();
            }
            println!("{method:?}: {:e}, {:?}", difference(sim.state(), &end), sim.counters());
            assert_close(sim.state(), &end, tolerance);
            let e = sim.time_error();
            let blind = matches!(method, Method::Gauss6 { .. });
            assert_eq!(e.angle_sum.is_nan(), blind, "{e:?}");
            // Where better estimates follow, those of the steps after each jump are counted as unknown.
            let most = if matches!(method, Method::Abm4 { .. }) { 300 } else { 5 };
            assert!(blind || (e.spin_sum > 0.0 && e.unknown <= most), "{e:?}");
        });
    }
}

#[test]
fn steps_far_too_long_are_told_with_and_without_commands() {
    // A spring of 1.8 radians per step: its error of a step is z⁵/120 of the amplitude.
    let growth = 1.0 / MASSES[0] + 1.0 / MASSES[1];
    let step = 0.1;
    let stiffness = (1.8 / step) * (1.8 / step) / growth;
    for command in ["none", "the same", "jumps"] {
        let torque = if command == "none" { Signal::Constant(0.0) } else { Signal::Channel };
        let drive = Drive::Torque { torque, stiffness, damping: 0.0, rest: 2.0, start: [2.4, 0.0] };
        let links = [one(MASSES[0]), Link { joint: Some(slider(drive)), ..one(MASSES[1]) }];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, Method::Rk4 { step });
        let mut sim = sim.view();
        let mut told = 0;
        for tick in 0..20 {
            let (from, to) = (step * f64::from(tick), step * f64::from(tick + 1));
            let force = if command == "jumps" && tick % 2 == 0 { 0.1 } else { 0.0 };
            if command != "none" {
                sim.set_channel(0, [from, force, 0.0, 0.0], [to, force, 0.0, 0.0]).unwrap();
            }
            sim.advance(to).unwrap();
            told += usize::from(sim.notice().is_some_and(|(_, e)| e.status == nekton::Status::StepTooLong));
        }
        println!("{command}: {told} of 20, {:?}", sim.time_error());
        assert!(told >= 5 && sim.time_error().length_sum > 0.2, "{command}: {told}, {:?}", sim.time_error());
    }
}

/// A body whose position follows two channels.
fn led(method: Method<f64>) -> SimBuf<f64> {
    let links = [link(Shape::Ellipse { a: 0.5, b: 0.3 }, 1.0, 16)];
    let root = Root::Prescribed([Signal::Channel, Signal::Channel, Signal::Constant(0.0)]);
    let bodies = [Body { pose: [0.0; 3], velocity: [0.0; 3], root, links: &links }];
    SimBuf::new(Arc::new(ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap()), method).unwrap()
}

#[test]
fn every_channel_follows_its_own_piece_also_if_another_was_given_the_same() {
    let ends = |to: f64| ([0.0; 4], [1.0, to, 0.0, 0.0]);
    for [x, y] in [[0.3, 0.3], [0.3, -0.2], [0.0, 0.4], [0.4, 0.0]] {
        let mut sim = led(Method::Rk4 { step: 0.25 });
        let mut sim = sim.view();
        for (channel, to) in [x, y].into_iter().enumerate() {
            let (from, to) = ends(to);
            sim.set_channel(channel, from, to).unwrap();
        }
        sim.advance(1.0).unwrap();
        let [found_x, found_y] = [0, 1].map(|k| sim.positions()[k]);
        assert!((found_x - x).abs() + (found_y - y).abs() < 1e-13, "{found_x} {found_y}");
    }
}

#[test]
fn every_step_counts_once() {
    let step = 0.125;
    let adams = Method::Adams { relative: 1e-6, absolute: 1e-6, max_step: 1.0, first_step: 0.0 };
    for method in [Method::Rk4 { step }, Method::Abm4 { step }, Method::Gauss6 { step }, adams] {
        let mut sim = led(method);
        let mut sim = sim.view();
        for k in 1..=5 {
            sim.step().unwrap();
            assert_eq!(sim.counters().steps, k, "{method:?}");
        }
        // A whole step and a shortened one.
        if method != adams {
            sim.advance(6.5 * step).unwrap();
            assert_eq!(sim.counters().steps, 7, "{method:?}");
        }
    }
}
