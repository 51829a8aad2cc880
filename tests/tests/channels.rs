//! Commands that jump: what is integrated and what is told after [`nekton::Sim::set_channel`] belong to the new command alone.

use nekton::scene::{Drive, Joint, JointKind, Link, Mass, Scene, Signal};
use nekton::{Method, Sim};
use nekton_tests::*;

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
    let step = 0.05;
    let methods = [Method::Rk4 { step }, Method::Abm4 { step }, Method::Gauss6 { step }, adams(1e-10)];
    for method in methods {
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
