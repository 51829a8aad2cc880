//! Drives that a window lets in: ramps of any steepness after rests of any length, against closed forms.

use nekton::scene::{Drive, Harmonic, Link, Root, Scene, Shape, Signal, Window};
use nekton::{Method, ModelBuf, Status};
use nekton_tests::*;

/// A constant torque, let in by a window.
const ONE: [Harmonic<f64>; 1] = [Harmonic { amplitude: 0.0, frequency: 0.0, phase: 0.0, offset: 1.0 }];
const STILL: Signal<'static, f64> = Signal::Constant(0.0);

fn inertia() -> f64 {
    0.3 * std::f64::consts::PI * (1.0 + 0.09) / 4.0
}

/// Hands over a scene in vacuum: a link that is held, and one that a window's torque turns about its centre.
fn turned(window: Window<f64>, look: impl FnOnce(&Scene<'_, f64>)) {
    let one = link(Shape::Ellipse { a: 1.0, b: 0.3 }, 1.0, 16);
    let torque = Signal::Harmonic { terms: &ONE, window: Some(window) };
    let drive = Drive::Torque { torque, stiffness: 0.0, damping: 0.0, rest: 0.0, start: [0.0; 2] };
    let links: [Link<'_, f64>; 2] = [one, hinged(one, 0, [3.0, 0.0], [0.0, 0.0], drive)];
    let bodies = [nekton::scene::Body { root: Root::Prescribed([STILL; 3]), ..body(&links, [0.0; 3], [0.0; 3]) }];
    look(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) });
}

#[test]
fn a_window_of_torque_gives_its_impulse_whatever_the_first_step() {
    // Each ramp is antisymmetric about its middle and counts half; the centre of the pulse is that of the window.
    for (from, ramp) in [(20.0, 1e-4), (20.0, 1e-2), (20.0, 0.4), (0.5, 1e-3), (300.0, 1e-6)] {
        let window = Window { from, to: from + 1.0, ramp };
        let (impulse, end) = ((1.0 - ramp) / inertia(), from + 2.0);
        let exact = [impulse * 1.5, impulse];
        for first_step in [0.0, 1e-3, 1.0, 40.0, 1e4] {
            for tolerance in [1e-3, 1e-6, 1e-9] {
                let method = Method::Adams { relative: tolerance, absolute: tolerance, max_step: 0.0, first_step };
                turned(window, |scene| {
                    let mut sim = simulation(scene, method);
                    let mut sim = sim.view();
                    sim.advance(end).unwrap();
                    let (mut u, mut du) = ([f64::NAN], [f64::NAN]);
                    sim.joint_values(&mut u, &mut du);
                    let error = (u[0] - exact[0]).abs().max((du[0] - exact[1]).abs()) / tolerance;
                    println!("{from} {ramp:e} {first_step} {tolerance:e}: {error:.2} tolerances, {:?}", sim.counters());
                    assert!(error < 100.0, "{from} {ramp:e} {first_step} {tolerance:e}: {error}");
                });
            }
        }
    }
}

#[test]
fn steps_of_gauss6_resolve_the_ramps_of_a_window_whatever_their_length() {
    // Without an outer impulse a lone body in vacuum ends as it was once its joint is back.
    let terms = [Harmonic { amplitude: 0.27, frequency: 0.0, phase: 1.57, offset: 0.0 }];
    for from in [0.467, 97.3] {
        let window = Some(Window { from, to: from + 0.225, ramp: 0.1125 });
        for step in [0.45, 0.05, 0.03, 0.014, 0.01, 0.005, 0.002] {
            let one = link(Shape::Ellipse { a: 1.0, b: 0.35 }, 1.0, 16);
            let drive = Drive::Motion(Signal::Harmonic { terms: &terms, window });
            let links = [one, hinged(one, 0, [-1.4, 0.0], [1.2, 0.1], drive)];
            let alone = [link(disc(0.2), 1.0, 16)];
            let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&alone, [0.0, 5.0, 0.0], [0.0; 3])];
            let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, Method::Gauss6 { step });
            let mut sim = sim.view();
            sim.advance(from + 1.0).unwrap();
            let worst = sim.velocities()[..6].iter().fold(0.0_f64, |m, v: &f64| m.max(v.abs()));
            println!("{from} {step}: {worst:e}");
            assert!(worst < 2e-6, "{from} {step}: {worst:e}");
        }
    }
}

#[test]
fn a_ramp_that_the_digits_of_the_time_cannot_hold_is_refused() {
    for (from, ramp) in [(500.0, 1e-14), (1.0, 1e-16), (20.0, 1e-17), (1e6, 1e-10)] {
        turned(Window { from, to: from + 1.0, ramp }, |scene| {
            let e = ModelBuf::new(scene).unwrap_err();
            assert_eq!((e.status, e.what), (Status::OutOfRange, "ramp"));
        });
        turned(Window { from, to: from + 1.0, ramp: 1e-13 * (from + 1.0) }, |scene| {
            ModelBuf::new(scene).unwrap();
        });
    }
}
