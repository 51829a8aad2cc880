//! Asking changes nothing; both precisions agree.

use super::*;
use nekton::{Method, Real};

/// A swimmer with a torque-driven and a prescribed joint, beside another body or alone.
fn run<R: Real, T>(beside: bool, method: Method<R>, look: impl Fn(&mut Sim<'_, R>) -> T) -> T {
    let r = R::lit;
    let terms = [Harmonic { offset: r(0.2), amplitude: r(0.3), frequency: r(0.4), phase: r(0.7) }];
    let signal = Signal::Harmonic { terms: &terms, window: None };
    let torque =
        Drive::Torque { torque: signal, stiffness: r(0.7), damping: r(0.3), rest: r(0.25), start: [r(0.5), r(-0.4)] };
    let part = |a: f64| link(Shape::Ellipse { a: r(a), b: r(0.25) }, r(1.2), 32);
    let joint = |k, drive| hinged(part(0.5), k, [r(0.7), r(0.1)], [r(-0.6), r(0.0)], drive);
    let links = [part(0.6), joint(0, torque), joint(1, Drive::Motion(signal))];
    let other = [link(Shape::Star { radius: r(0.5), amplitude: r(0.1), lobes: 3 }, r(0.8), 32)];
    let bodies = [
        body(&links, [r(0.2), r(-0.1), r(0.3)], [r(0.4), r(-0.3), r(0.7)]),
        body(&other, [r(0.3), r(2.4), r(0.7)], [r(0.2), r(-0.4), r(0.5)]),
    ];
    let scene = Scene {
        bodies: if beside { &bodies } else { &bodies[..1] },
        allow_unresolved: true,
        ..Scene::new(r(1.3), if beside { r(9.81) } else { r(0.0) })
    };
    look(&mut simulation(&scene, method).view())
}

const PARAMETERS: [Parameter; 4] =
    [Parameter::FluidDensity, Parameter::Torque(0), Parameter::Position(1), Parameter::Inertia(1)];

/// A and B.
fn asked<R: Real>(sim: &mut Sim<'_, R>) -> [Vec<R>; 2] {
    let rows = sim.state().len();
    let mut memory = vec![R::NAN; Sim::derivative_requirement(&sim.model()).unwrap()];
    let (mut a, mut b) = (vec![R::NAN; rows * rows], vec![R::NAN; rows * PARAMETERS.len()]);
    let known = sim.linearize(PARAMETERS, &mut a, &mut b, &mut memory).unwrap();
    assert!(known.bound >= R::zero() && known.bound.is_finite());
    let n = sim.positions().len();
    let (mut position, mut velocity) = (vec![R::NAN; n * n], vec![R::NAN; n * n]);
    sim.force_derivatives(&vec![R::HALF; n], &mut position, &mut velocity, &mut memory).unwrap();
    [a, b]
}

fn indicators(sim: &mut Sim<'_, f64>) -> [u64; 5] {
    let r = sim.indicators().unwrap();
    [r.mass, r.force, r.quadrature, r.repulsion, r.bound()].map(f64::to_bits)
}

#[test]
fn a_run_that_is_linearized_between_steps_goes_on_by_the_same_bits() {
    let step: f64 = 0.02;
    for method in [Method::Rk4 { step }, Method::Abm4 { step }, Method::Gauss6 { step }, adams(1e-6)] {
        for beside in [false, true] {
            let shown = |ask: bool| {
                run::<f64, _>(beside, method, |sim| {
                    let mut shown = Vec::new();
                    for _ in 0..6 {
                        if ask {
                            asked(sim);
                        }
                        // Before the first step those of the state shown.
                        shown.extend(indicators(sim));
                        sim.step().unwrap();
                        let t = sim.time();
                        shown.extend(sim.state().iter().chain([&t]).map(|x| x.to_bits()));
                        if ask {
                            asked(sim);
                        }
                        shown.extend(indicators(sim));
                        sim.advance_dense(t + 0.01, t + 0.02).unwrap();
                        if ask {
                            asked(sim);
                        }
                        shown.push(sim.time_error().length_sum.to_bits());
                    }
                    shown
                })
            };
            assert_eq!(shown(true), shown(false), "{method:?}, {beside}");
        }
    }
}

#[test]
fn single_precision_gives_the_linearization_of_double_precision() {
    for beside in [false, true] {
        let single = run::<f32, _>(beside, Method::Rk4 { step: 0.01 }, asked);
        let double = run::<f64, _>(beside, Method::Rk4 { step: 0.01 }, asked);
        for (single, double) in single.iter().zip(&double) {
            let single: Vec<f64> = single.iter().map(|x| f64::from(*x)).collect();
            println!("{beside}: {:.1e}", difference(&single, double));
            assert_close(&single, double, 1e-4);
        }
    }
}
