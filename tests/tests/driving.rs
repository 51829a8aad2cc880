//! What the caller of a simulation may rely on: states set, rates asked for, channels driven, and steps that fail.

use nekton::scene::{Body, Drive, Harmonic, Link, Root, Scene, Shape, Signal};
use nekton::{Formulation, Method, Place, Sim, Status};
use nekton_tests::*;

const WAVE: [Harmonic<f64>; 1] = [Harmonic { amplitude: 0.5, frequency: 2.0, phase: 0.2, offset: 0.1 }];
const WAVES: Signal<'static, f64> = Signal::Harmonic { terms: &WAVE, window: None };

/// A link of the swimmer.
const fn segment() -> Link<'static, f64> {
    Link {
        shape: Shape::Ellipse { a: 0.5, b: 0.2 },
        mass: nekton::scene::Mass::Density(1.2),
        nodes: 32,
        circulation: 0.0,
        joint: None,
    }
}

/// A joint driven by a torque that follows `signal`.
fn torque(signal: Signal<'_, f64>) -> Drive<'_, f64> {
    Drive::Torque { torque: signal, stiffness: 0.3, damping: 0.1, rest: 0.1, start: [0.2, 0.1] }
}

/// Two links and a hinge.
fn swimmer(drive: Drive<'_, f64>) -> [Link<'_, f64>; 2] {
    [segment(), hinged(segment(), 0, [-0.75, 0.0], [0.75, 0.0], drive)]
}

/// Runs `check` on bodies with an obstacle under weight and drives, on a lone swimmer and on a lone body: one scene for
/// each formulation of the equations of motion.
fn each_formulation(check: impl Fn(&Scene<'_, f64>)) {
    let driven = swimmer(torque(WAVES));
    let moved = swimmer(Drive::Motion(WAVES));
    let star = [Link { circulation: 0.5, ..link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32) }];
    let bodies = [body(&driven, [0.3, -0.8, 0.3], [0.2, 0.1, -0.3]), body(&star, [-0.5, 0.9, 0.2], [0.3, -0.1, 0.4])];
    let alone = [body(&moved, [0.1, 0.2, 0.3], [0.0; 3])];
    let obstacles = [wall(disc(0.3), [1.6, 0.8], 0.0, 32)];
    let everything = Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.1, 0.5) };
    let lone_swimmer = Scene { bodies: &alone, ..Scene::new(1.1, 0.0) };
    let lone_body = Scene { bodies: &bodies[1..], ..Scene::new(1.1, 0.5) };
    let scenes = [
        (everything, Formulation::Velocity),
        (lone_swimmer, Formulation::LockedMomentum),
        (lone_body, Formulation::Kirchhoff),
    ];
    for (scene, formulation) in scenes {
        assert_eq!(at_start(&scene).view().model().plan().formulation, formulation);
        check(&scene);
    }
}

fn each_method(check: impl Fn(Method<f64>)) {
    for method in [Method::Rk4 { step: 0.05 }, Method::Abm4 { step: 0.05 }, adams(1e-7)] {
        check(method);
    }
}

/// Everything that a simulation shows, to the bit.
fn shown(sim: &mut Sim<'_, f64>) -> Vec<u64> {
    let joints = sim.model().joint_count();
    let (mut u, mut du) = (vec![0.0; joints], vec![0.0; joints]);
    sim.joint_values(&mut u, &mut du);
    let energy = sim.energy().unwrap();
    let numbers = [sim.time(), energy.total, energy.work, sim.gap().distance];
    let all = sim.state().iter().chain(sim.positions()).chain(sim.velocities()).chain(&u).chain(&du).chain(&numbers);
    all.map(|x| x.to_bits()).collect()
}

#[test]
fn rates_under_a_hand_written_rk4_give_the_motion_of_method_rk4() {
    each_formulation(|scene| {
        let (h, steps) = (0.05, 10);
        let mut own = simulation(scene, Method::Rk4 { step: h });
        let mut own = own.view();
        let mut y = own.state().to_vec();
        let n = y.len();
        for k in 0..steps {
            let t = h * f64::from(k);
            let mut rate = |t: f64, y: &[f64]| {
                let mut out = vec![f64::NAN; n];
                own.rhs(t, y, &mut out).unwrap();
                out
            };
            let shifted = |k: &[f64], c: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + c * k).collect() };
            let k1 = rate(t, &y);
            let k2 = rate(t + h / 2.0, &shifted(&k1, h / 2.0));
            let k3 = rate(t + h / 2.0, &shifted(&k2, h / 2.0));
            let k4 = rate(t + h, &shifted(&k3, h));
            y = (0..n).map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])).collect();
        }
        let mut built_in = simulation(scene, Method::Rk4 { step: h });
        let mut built_in = built_in.view();
        for _ in 0..steps {
            built_in.step().unwrap();
        }
        println!("{:.1e}", difference(&y, built_in.state()));
        assert_close(&y, built_in.state(), 1e-15);
        // The state is where the positions come from.
        own.set_state(h * f64::from(steps), &y).unwrap();
        assert_close(own.positions(), built_in.positions(), 1e-15);
        assert_close(own.velocities(), built_in.velocities(), 1e-15);
    });
}

#[test]
fn rates_leave_the_simulation_as_it_is() {
    each_formulation(|scene| {
        each_method(|method| {
            let (mut asked, mut quiet) = (simulation(scene, method), simulation(scene, method));
            let (mut asked, mut quiet) = (asked.view(), quiet.view());
            for k in 1..=3 {
                // Refused rates, and those of a state from which the way back leads through another body.
                let mut y = asked.state().to_vec();
                let mut out = vec![0.0; y.len()];
                y[1] = f64::NAN;
                assert_eq!(asked.rhs(3.0, &y, &mut out).unwrap_err().status, Status::NonFiniteState);
                assert_eq!(asked.rhs(3.0, &y[1..], &mut out).unwrap_err().status, Status::Length);
                y[1] = asked.state()[1] + 20.0;
                asked.rhs(3.0, &y, &mut out).unwrap();
                asked.advance(0.1 * f64::from(k)).unwrap();
                quiet.advance(0.1 * f64::from(k)).unwrap();
                assert_eq!(shown(&mut asked), shown(&mut quiet), "{method:?}");
            }
        });
    });
}

#[test]
fn motion_goes_on_from_a_state_that_was_set() {
    each_formulation(|scene| {
        each_method(|method| {
            let (mut first, mut second) = (simulation(scene, method), simulation(scene, method));
            let (mut first, mut second) = (first.view(), second.view());
            println!("{method:?}, {:?}", first.model().plan().formulation);
            first.advance(0.3).unwrap();
            second.set_state(0.3, first.state()).unwrap();
            assert_eq!(shown(&mut first), shown(&mut second), "{method:?}");
            first.restart();
            first.advance(0.7).unwrap();
            second.advance(0.7).unwrap();
            assert_eq!(shown(&mut first), shown(&mut second), "{method:?}");
        });
    });
}

#[test]
fn refused_state_leaves_the_simulation_as_it_is() {
    let star = [link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32)];
    let small = [link(disc(0.05), 0.8, 16)];
    let bodies = [body(&star, [-1.0, 0.0, 0.2], [0.3, -0.1, 0.4]), body(&small, [1.0, 0.0, 0.2], [0.0; 3])];
    let tank = Some(wall(disc(4.0), [0.0; 2], 0.0, 64));
    let scene = Scene { tank, bodies: &bodies, ..Scene::new(1.1, 0.5) };
    each_method(|method| {
        let (mut asked, mut quiet) = (simulation(&scene, method), simulation(&scene, method));
        let (mut asked, mut quiet) = (asked.view(), quiet.view());
        asked.advance(0.2).unwrap();
        quiet.advance(0.2).unwrap();
        let y = asked.state().to_vec();
        let with = |i: usize, value: f64| {
            let mut y = y.clone();
            y[i] = value;
            y
        };
        let before = shown(&mut asked);
        for (t, y, status) in [
            (0.0, y[1..].to_vec(), Status::Length),
            (f64::NAN, y.clone(), Status::NotFinite),
            (0.0, with(2, f64::INFINITY), Status::NotFinite),
            // The bodies crossing, one inside the other, and one outside the tank.
            (0.0, with(0, y[3] - 0.5), Status::Contact),
            (0.0, with(0, y[3]), Status::Contact),
            (0.0, with(0, 9.0), Status::Contact),
        ] {
            assert_eq!(asked.set_state(t, &y).unwrap_err().status, status, "{y:?}");
            if status == Status::Contact {
                assert_eq!(asked.rhs(t, &y, &mut vec![0.0; y.len()]).unwrap_err().status, status, "{y:?}");
            }
            assert_eq!(shown(&mut asked), before);
        }
        asked.advance(0.4).unwrap();
        quiet.advance(0.4).unwrap();
        assert_eq!(shown(&mut asked), shown(&mut quiet), "{method:?}");
    });
}

/// Rows of a table: u = 0.4 sin² t, with two derivatives.
fn rows() -> Vec<[f64; 4]> {
    (0..=20)
        .map(|k| 0.05 * f64::from(k))
        .map(|t: f64| [t, 0.4 * t.sin().powi(2), 0.4 * (2.0 * t).sin(), 0.8 * (2.0 * t).cos()])
        .collect()
}

#[test]
fn channel_moves_a_joint_as_a_table_with_the_same_rows_does() {
    let rows = rows();
    let obstacles = [wall(disc(0.3), [1.6, 0.8], 0.0, 32)];
    let run = |signal: Signal<'_, f64>, set: bool, as_torque: bool| {
        let links = swimmer(if as_torque { torque(signal) } else { Drive::Motion(signal) });
        let bodies = [body(&links, [0.3, -0.8, 0.3], [0.2, 0.1, -0.3])];
        let scene = Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.1, 0.5) };
        let mut sim = simulation(&scene, Method::Rk4 { step: 0.05 });
        let mut sim = sim.view();
        for pair in rows.windows(2) {
            if set {
                sim.set_channel(0, pair[0], pair[1]).unwrap();
            }
            sim.advance(pair[1][0]).unwrap();
        }
        let (mut u, mut du) = ([f64::NAN], [f64::NAN]);
        sim.joint_values(&mut u, &mut du);
        let mut nu = [f64::NAN];
        sim.joint_torques(&mut nu, &mut [0.0]).unwrap();
        println!("u {u:?}, u' {du:?}, torque {nu:?}");
        let work = sim.energy().unwrap().work;
        [sim.positions(), sim.velocities(), &u, &du, &nu, &[work]].concat()
    };
    for as_torque in [false, true] {
        let table = run(Signal::Table(&rows), false, as_torque);
        let channel = run(Signal::Channel, true, as_torque);
        println!("{:.1e}", difference(&channel, &table));
        assert_close(&channel, &table, 3e-15);
        if !as_torque {
            assert_near(channel[12], 0.4 * 1.0_f64.sin().powi(2), 1e-15);
        }
    }
}

#[test]
fn bad_channels_are_refused_and_change_nothing() {
    let links = swimmer(torque(Signal::Channel));
    let bodies = [body(&links, [0.3, -0.8, 0.3], [0.2, 0.1, -0.3])];
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.1, 0.5) });
    let mut sim = sim.view();
    let row = |t: f64, u: f64| [t, u, 0.0, 0.0];
    sim.set_channel(0, row(0.0, 0.3), row(1.0, 0.3)).unwrap();
    let mut before = [f64::NAN];
    sim.joint_torques(&mut before, &mut [0.0]).unwrap();
    for (channel, from, to, status) in [
        (1, row(0.0, 0.0), row(1.0, 0.0), Status::Unsupported),
        (0, row(0.0, f64::NAN), row(1.0, 0.0), Status::NotFinite),
        (0, row(0.0, 0.0), row(f64::INFINITY, 0.0), Status::NotFinite),
        (0, row(1.0, 0.0), row(1.0, 0.0), Status::BadTable),
        (0, row(1.0, 0.0), row(0.0, 0.0), Status::BadTable),
    ] {
        assert_eq!(sim.set_channel(channel, from, to).unwrap_err().status, status);
        let mut after = [f64::NAN];
        sim.joint_torques(&mut after, &mut [0.0]).unwrap();
        assert_eq!(after, before);
    }
    // Torque 0.3 − stiffness (u − rest) − damping u̇.
    assert_near(before[0], 0.3 - 0.3 * 0.1 - 0.1 * 0.1, 1e-15);
}

#[test]
fn failed_step_leaves_the_state_to_the_bit() {
    // A torque beyond all bounds makes the accelerations infinite; before, every term is at work.
    let driven = swimmer(torque(Signal::Channel));
    let star = [Link { circulation: 0.5, ..link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32) }];
    let bodies = [body(&driven, [0.3, -0.8, 0.3], [0.2, 0.1, -0.3]), body(&star, [-0.5, 0.9, 0.2], [0.3, -0.1, 0.4])];
    let scene = Scene { bodies: &bodies, ..Scene::new(1.1, 0.5) };
    each_method(|method| {
        let (mut sim, mut twin) = (simulation(&scene, method), simulation(&scene, method));
        let (mut sim, mut twin) = (sim.view(), twin.view());
        for sim in [&mut sim, &mut twin] {
            sim.set_channel(0, [0.0, 0.1, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]).unwrap();
            sim.advance(0.21).unwrap();
        }
        let before = shown(&mut sim);
        let huge = 1e300;
        // The torque jumps for both, lest one have a longer memory.
        for sim in [&mut sim, &mut twin] {
            sim.set_channel(0, [0.0, huge, 0.0, 0.0], [1.0, huge, 0.0, 0.0]).unwrap();
        }
        for _ in 0..2 {
            let error = sim.step().unwrap_err();
            println!("{method:?}: {error}");
            assert!(matches!(error.status, Status::NonFiniteState | Status::StepTooSmall | Status::Contact), "{error}");
            assert_eq!(sim.state(), twin.state());
            assert_eq!(
                (sim.time(), sim.positions(), sim.velocities()),
                (twin.time(), twin.positions(), twin.velocities())
            );
        }
        // With the old torque everything is as it was, and goes on as if nothing had been tried.
        for sim in [&mut sim, &mut twin] {
            sim.set_channel(0, [0.0, 0.1, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]).unwrap();
        }
        assert_eq!(shown(&mut sim), before);
        sim.advance(0.4).unwrap();
        twin.advance(0.4).unwrap();
        assert_eq!(shown(&mut sim), shown(&mut twin), "{method:?}");
    });
}

/// Asserts that one step of every method fails by contact of `moving` with `still` and changes nothing.
fn jump(moving: Body<'_, f64>, still: Body<'_, f64>, methods: &[Method<f64>]) {
    let bodies = [moving, still];
    let scene = Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) };
    for &method in methods {
        let mut sim = simulation(&scene, method);
        let mut sim = sim.view();
        let before = shown(&mut sim);
        for _ in 0..2 {
            // The variable-step method may take small steps before it dares to jump.
            let outcome = match method {
                Method::Adams { .. } => sim.advance(10.0),
                _ => sim.step(),
            };
            let Err(error) = outcome else { panic!("{method:?}: jumped to {:?}", sim.positions()) };
            assert_eq!(error.status, Status::Contact, "{method:?}: {error}");
            let places = [Some(error.place), error.other];
            assert!(places.contains(&Some(Place::Link(0, 0))) && places.contains(&Some(Place::Link(1, 0))), "{error}");
            if !matches!(method, Method::Adams { .. }) {
                assert_eq!(shown(&mut sim), before, "{method:?}");
            }
        }
        assert!(sim.gap().distance > 0.0);
    }
}

#[test]
fn body_cannot_jump_across_another_within_one_step() {
    let small = [link(disc(0.1), 1.0, 16)];
    let still = body(&small, [1.0, 0.05, 0.0], [0.0; 3]);
    let methods = [Method::Rk4 { step: 0.1 }, Method::Abm4 { step: 0.1 }, adams(1e-3)];
    for speed in [15.0, 40.0, 400.0] {
        jump(body(&small, [0.0; 3], [speed, 0.0, 0.0]), still, &methods);
    }
    // One that only passes by is let through.
    let near = body(&small, [0.0, -0.16, 0.0], [40.0, 0.0, 0.0]);
    let bodies = [near, still];
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, methods[0]);
    sim.view().step().unwrap();
    assert_near(sim.view().positions()[0], 4.0, 1e-14);
}

#[test]
fn body_cannot_jump_across_a_wall_or_out_of_the_tank_within_one_step() {
    let small = [link(disc(0.1), 1.0, 16)];
    let bodies = [body(&small, [-0.5, 0.0, 0.0], [100.0, 0.0, 0.0])];
    let obstacles = [wall(Shape::Rectangle { width: 0.1, height: 2.0, radius: Some(0.04) }, [0.5, 0.0], 0.0, 128)];
    let tank = wall(disc(2.0), [0.0; 2], 0.0, 64);
    let empty = Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) };
    for (scene, place) in [
        (Scene { obstacles: &obstacles, ..empty }, Place::Obstacle(0)),
        (Scene { tank: Some(tank), ..empty }, Place::Tank),
    ] {
        for method in [Method::Rk4 { step: 0.1 }, Method::Abm4 { step: 0.1 }] {
            let mut sim = simulation(&scene, method);
            let mut sim = sim.view();
            let before = shown(&mut sim);
            let error = sim.step().unwrap_err();
            assert_eq!(error.status, Status::Contact, "{error}");
            assert!([Some(error.place), error.other].contains(&Some(place)), "{error}");
            assert_eq!(shown(&mut sim), before);
        }
    }
}

#[test]
fn rod_cannot_swing_across_a_body_within_one_step() {
    let rod = [link(Shape::Ellipse { a: 1.0, b: 0.05 }, 1.0, 64)];
    let small = [link(disc(0.1), 1.0, 16)];
    let still = body(&small, [0.0, 0.7, 0.0], [0.0; 3]);
    for angle in [2.0, 2.8, 3.5, 4.5, 6.0, std::f64::consts::TAU, 9.0] {
        println!("turn {angle} in a step");
        jump(
            body(&rod, [0.0; 3], [0.0, 0.0, angle / 0.1]),
            still,
            &[Method::Rk4 { step: 0.1 }, Method::Abm4 { step: 0.1 }],
        );
    }
}

#[test]
fn prescribed_root_cannot_be_led_through_a_body() {
    let small = [link(disc(0.1), 1.0, 16)];
    let path = [[0.0, 0.0, 20.0, 0.0], [1.0, 20.0, 20.0, 0.0]];
    let still = Signal::Constant(0.0);
    let led = Body { root: Root::Prescribed([Signal::Table(&path), still, still]), ..body(&small, [0.0; 3], [0.0; 3]) };
    jump(led, body(&small, [1.0, 0.05, 0.0], [0.0; 3]), &[Method::Rk4 { step: 0.1 }, Method::Abm4 { step: 0.1 }]);
}

#[test]
fn a_state_that_is_set_is_shown_whatever_was_asked_before() {
    each_formulation(|scene| {
        each_method(|method| {
            let (mut first, mut second) = (simulation(scene, method), simulation(scene, method));
            let (mut first, mut second) = (first.view(), second.view());
            first.advance(0.3).unwrap();
            // Now the buffers hold everything of another state.
            let before = shown(&mut second);
            let mut force = vec![0.0; second.positions().len()];
            second.accelerations(&mut force).unwrap();
            second.set_state(0.3, first.state()).unwrap();
            assert_eq!(shown(&mut first), shown(&mut second), "{method:?}");
            assert_ne!(before, shown(&mut second));
        });
    });
}

#[test]
fn a_slide_along_a_wall_is_followed_for_any_number_of_gaps() {
    let gap = 0.004;
    let plate = |width, angle| (Shape::Rectangle { width, height: 0.2, radius: Some(0.02) }, angle);
    let (long, _) = plate(4.0, 0.0);
    let small = [link(disc(0.1), 1.0, 16)];
    let obstacles = [wall(long, [0.0, -0.1], 0.0, 256)];
    for gaps in [100.0, 300.0, 900.0] {
        let h = 0.1;
        let bodies = [body(&small, [-0.5 * gaps * gap, 0.1 + gap, 0.0], [gaps * gap / h, 0.0, 0.0])];
        let scene = Scene { obstacles: &obstacles, bodies: &bodies, ..Scene::new(0.0, 0.0) };
        let mut sim = simulation(&scene, Method::Rk4 { step: h });
        let mut sim = sim.view();
        println!("{:e}", sim.gap().distance / gap - 1.0);
        let told = sim.step().err().map(|error| error.status);
        println!("{:e}", sim.gap().distance / gap - 1.0);
        assert_eq!(told, None, "{gaps}");
    }
}

#[test]
fn each_channel_moves_its_own_joint() {
    let drive =
        |start| Drive::Torque { torque: Signal::Channel, stiffness: 0.0, damping: 0.0, rest: 0.0, start: [start, 0.0] };
    let chain = [
        segment(),
        hinged(segment(), 0, [-0.75, 0.0], [0.75, 0.0], Drive::Motion(Signal::Channel)),
        hinged(segment(), 1, [-0.75, 0.0], [0.75, 0.0], drive(0.2)),
        hinged(segment(), 2, [-0.75, 0.0], [0.75, 0.0], Drive::Motion(Signal::Channel)),
    ];
    let bodies = [body(&chain, [0.0; 3], [0.0; 3])];
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.1, 0.0) });
    let mut sim = sim.view();
    // Quintics through their ends: half way are the means of values, and 15/8 of the mean slope.
    let ends = [[0.1, 0.3], [0.7, 0.9], [-0.2, 0.4]];
    for order in [[0, 1, 2], [2, 0, 1]] {
        for channel in order {
            let [u0, u1] = ends[channel];
            sim.set_channel(channel, [-1.0, u0, 0.0, 0.0], [1.0, u1, 0.0, 0.0]).unwrap();
        }
        let (mut nu, mut power) = ([f64::NAN; 3], [f64::NAN; 3]);
        sim.joint_torques(&mut nu, &mut power).unwrap();
        assert_near(nu[1], 0.8, 1e-15);
        let mut out = vec![0.0; sim.state().len()];
        let y = sim.state().to_vec();
        sim.rhs(0.0, &y, &mut out).unwrap();
        sim.set_state(0.0, &y).unwrap();
        let (mut u, mut du) = ([f64::NAN; 3], [f64::NAN; 3]);
        sim.joint_values(&mut u, &mut du);
        assert_close(&u, &[0.2, 0.2, 0.1], 1e-15);
        assert_close(&du, &[0.2 * 15.0 / 16.0, 0.0, 0.6 * 15.0 / 16.0], 1e-15);
    }
}
