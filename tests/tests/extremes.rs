//! Scenes at the edges of what may be asked: results stay right, or a status or an indicator says that they are not.
//! The complete tables are in docs/accuracy.

use nekton::Method;
use nekton::scene::{Drive, Harmonic, Quadrature, Scene, Shape, Signal};
use nekton_tests::extremes::*;
use nekton_tests::long_run::{Motion, circle, drifts, methods, motions};
use nekton_tests::{body, hinged, link, simulation};

/// Rows of a case in both precisions, printed; each reached its end with errors of about its tolerance, and the
/// indicators do not hide them.
fn sound(name: &str, value: f64, case: &Case, errors: [f64; 2], drifts: [f64; 2]) {
    for ((row, error), drift) in case.rows(value).iter().zip(errors).zip(drifts) {
        println!(
            "{name} {value:e} {}: {:.1e}, indicated {:.1e}, {:?}",
            row.precision,
            row.error,
            row.indicated(),
            row.outcome
        );
        assert_eq!(row.outcome.status, "Ok", "{name} {value:e} {}", row.precision);
        assert!(row.error <= error, "{name} {value:e} {}: {:e}", row.precision, row.error);
        assert!(row.outcome.energy_drift <= drift, "{name} {value:e} {}", row.precision);
        assert!(
            row.error <= 10.0 * row.indicated() + 1e-7,
            "{name} {value:e} {}: {:e}",
            row.precision,
            row.indicated()
        );
    }
}

#[test]
fn bodies_may_be_a_million_times_lighter_or_heavier_than_the_fluid() {
    for ratio in [1e-6, 1.0, 1e6, f64::INFINITY] {
        sound("density ratio", ratio, &Case { nodes: 40, ..density(ratio) }, [3e-10, 1e-5], [6e-10, 1e-5]);
    }
}

#[test]
fn bodies_may_be_micrometres_or_megametres_long() {
    for length in [1e-6, 1e6] {
        for time in [1.0, length] {
            sound("length", length, &Case { nodes: 40, ..scale(length, time) }, [2e-10, 2e-5], [2e-10, 3e-5]);
        }
    }
}

#[test]
fn a_change_of_units_by_a_power_of_two_changes_no_digit() {
    fn positions(case: &Case, method: Method<f64>) -> Vec<u64> {
        case.run(method).positions.iter().map(|x| (x / case.size).to_bits()).collect()
    }
    let mut case = scale(1.0, 1.0);
    // Powers and logarithms are not scaled exactly.
    (case.repulsion, case.nodes) = (None, 32);
    for body in &mut case.bodies {
        body.circulation = 0.0;
    }
    for method in [|step| Method::Rk4 { step }, |step| Method::Abm4 { step }, |step| Method::Gauss6 { step }] {
        let usual = positions(&case, method(0.05));
        assert_eq!(usual.len(), 6);
        for (length, time) in
            [(20, 0), (20, 20), (-20, 0), (-20, -20), (0, 30)].map(|(l, t)| (2f64.powi(l), 2f64.powi(t)))
        {
            assert_eq!(positions(&case.scaled(length, time), method(0.05 * time)), usual, "{length} {time}");
        }
    }
}

#[test]
fn a_change_of_units_changes_results_by_rounding_only() {
    let case = Case { nodes: 32, ..scale(1.0, 1.0) };
    let usual = case.run(Method::Rk4 { step: 0.05 });
    for (length, time) in [(1e6, 1.0), (1e-6, 1e-6), (1e-6, 1.0), (1e6, 1e6)] {
        let scaled = case.scaled(length, time);
        let outcome = scaled.run(Method::Rk4 { step: 0.05 * time });
        let positions: Vec<f64> = outcome.positions.iter().map(|x| x / length).collect();
        let error = distance(&positions, &usual.positions);
        println!("{length:e} {time:e}: {error:e}");
        assert!(outcome.status == "Ok" && error <= 2e-13, "{length:e} {time:e}: {error:e}");
    }
}

/// A beam of two links that a torque bends, hit from the side, in a unit of `length` metres: `steps` of `gauss6`.
fn bent<R: nekton::Real>(length: f64, step: f64, steps: u32) -> (&'static str, Vec<f64>) {
    let r = |x: f64| R::lit(x);
    let one = link(Shape::Ellipse { a: r(length), b: r(0.375 * length) }, r(1.0), 12);
    let torque = |x: f64| r(x * length.powi(4));
    let beat = [Harmonic { amplitude: torque(2.0), frequency: r(3.0), phase: r(0.5), offset: r(0.0) }];
    let drive = Drive::Torque {
        torque: Signal::Harmonic { terms: &beat, window: None },
        stiffness: torque(4.0),
        damping: r(0.0),
        rest: r(0.0),
        start: [r(0.0), r(0.0)],
    };
    let anchor = |x: f64| [r(x * length), r(0.0)];
    let links = [one, hinged(one, 0, anchor(-1.25), anchor(1.25), drive)];
    let bodies = [body(&links, [r(0.0); 3], [r(0.0), r(0.25 * length), r(0.0)])];
    let scene =
        Scene { bodies: &bodies, quadrature: Quadrature::Plain, allow_unresolved: true, ..Scene::new(r(1.0), r(0.0)) };
    let mut sim = simulation(&scene, Method::Gauss6 { step: r(step) });
    let mut sim = sim.view();
    let ended = (0..steps).try_for_each(|_| sim.step());
    let unit = |(k, x): (usize, &R)| x.to_f64() / if k % 3 == 2 { 1.0 } else { length };
    let positions = sim.positions().iter().enumerate().map(unit).collect();
    (ended.map_or_else(|e| e.status.name(), |()| "Ok"), positions)
}

#[test]
fn gauss6_settles_or_does_not_in_every_unit_of_length_alike() {
    fn all<R: nekton::Real>() {
        let mut statuses = Vec::new();
        for step in [1e-3, 0.05, 0.2, 0.5, 1.0, 2.0, 4.0] {
            let (status, positions) = bent::<R>(1.0, step, 40);
            println!("{step}: {status} {positions:?}");
            for exponent in [-20, -10, -3, 10, 20] {
                let scaled = bent::<R>(2f64.powi(exponent), step, 40);
                assert_eq!(scaled, (status, positions.clone()), "step {step}, unit 2^{exponent} m");
            }
            statuses.push(status);
        }
        // Both outcomes were met; the longest steps reach Contact.
        assert!(statuses[..2] == ["Ok"; 2] && statuses.contains(&"NoConvergence"), "{statuses:?}");
    }
    all::<f64>();
    all::<f32>();
}

/// How ten steps end that begin at time `t`, of two links that a spring or (`driven`) a signal bends, and what the clock shows.
fn late<R: nekton::Real>(t: f64, driven: bool, method: Method<R>) -> (&'static str, f64) {
    let r = |x: f64| R::lit(x);
    let one = link(Shape::Ellipse { a: r(1.0), b: r(0.375) }, r(1.0), 12);
    let beat = [Harmonic { amplitude: r(0.3), frequency: r(1.0), phase: r(0.0), offset: r(0.0) }];
    let drive = if driven {
        Drive::Motion(Signal::Harmonic { terms: &beat, window: None })
    } else {
        let torque = Signal::Constant(r(0.0));
        Drive::Torque { torque, stiffness: r(4.0), damping: r(0.0), rest: r(0.0), start: [r(0.2), r(0.0)] }
    };
    let links = [one, hinged(one, 0, [r(-1.25), r(0.0)], [r(1.25), r(0.0)], drive)];
    let bodies = [body(&links, [r(0.0); 3], [r(0.0); 3])];
    let scene = Scene { bodies: &bodies, quadrature: Quadrature::Plain, ..Scene::new(r(1.0), r(0.0)) };
    let mut sim = simulation(&scene, method);
    let mut sim = sim.view();
    let state = sim.state().to_vec();
    sim.set_state(r(t), &state).expect("accepted");
    let ended = (0..10).try_for_each(|_| sim.step());
    (ended.map_or_else(|e| e.status.name(), |()| "Ok"), sim.time().to_f64())
}

#[test]
fn a_time_with_too_few_digits_for_the_drives_is_refused_and_harmless_without() {
    fn both<R: nekton::Real>(fine: f64, coarse: f64) {
        let r = |x: f64| R::lit(x);
        let tolerance = nekton_tests::adams::<R>(1e-5);
        let fixed = [Method::Rk4 { step: r(0.02) }, Method::Abm4 { step: r(0.02) }, Method::Gauss6 { step: r(0.02) }];
        for method in fixed.into_iter().chain([tolerance]) {
            assert_eq!(late(fine, true, method).0, "Ok", "{method:?}");
            assert_eq!(late(coarse, true, method), ("StepTooSmall", r(coarse).to_f64()), "{method:?}");
            assert_eq!(late(coarse, false, method).0, "Ok", "{method:?}");
        }
    }
    both::<f32>(1e3, 1e6);
    both::<f64>(1e11, 1e15);
}

#[test]
fn many_bodies_are_as_accurate_as_few() {
    for n in [1, 6] {
        sound("bodies", n as f64, &Case { duration: 0.1, nodes: 24, ..bodies(n) }, [1e-6, 3e-5], [3e-10, 3e-5]);
    }
}

#[test]
fn circulation_may_dominate_everything() {
    for gamma in [1e-2, 1e6] {
        sound("circulation", gamma, &Case { nodes: 40, ..circulation(gamma) }, [1e-10, 5e-6], [4e-10, 2e-5]);
    }
}

#[test]
fn bodies_may_spin_a_thousand_times_faster_than_they_travel() {
    sound("spin", 1e3, &Case { nodes: 40, ..spin(1e3) }, [5e-9, 5e-4], [5e-10, 5e-5]);
}

#[test]
fn repulsion_may_have_any_usual_exponent() {
    for alpha in [1.0, 4.0, 12.0] {
        sound("exponent", alpha, &Case { nodes: 64, ..repulsion(alpha) }, [1e-8, 1e-4], [1e-9, 3e-5]);
    }
}

#[test]
fn steps_of_every_length_are_right_or_known_to_be_wrong() {
    // Of a disc on a circle, whose position is known. 10⁻⁸ of the period: the increments are far below the last digit.
    for (share, steps) in [(1e-8, 500), (1e-4, 500), (0.01, 200), (0.1, 20), (0.3, 12), (0.5, 12)] {
        for (k, (name, method)) in methods::<f64>(share).into_iter().enumerate() {
            let double = circle(method, share, steps);
            let single = circle(methods::<f32>(share)[k].1, f64::from(share as f32), steps);
            println!("{share:e} {name}: {double:?} {single:?}");
            for (o, rounding) in [(double, 1e-14), (single, 1e-6)] {
                match name {
                    // Chooses its steps itself.
                    "adams" => assert_eq!(o.status, "Ok"),
                    "gauss6" if o.status == "Ok" => assert!(o.error <= 2.0 * share.powi(6) + rounding, "{o:?}"),
                    "gauss6" => assert!(o.status == "NoConvergence" && share >= 0.3, "{o:?}"),
                    _ => {
                        assert!(o.error <= 3.0 * o.estimate + rounding, "{name} {share:e}: {o:?}");
                        // Where the error grows to the size of the disc the status says so.
                        assert!(
                            o.status == "StepTooLong" || (o.status == "Ok" && o.error < 0.3),
                            "{name} {share:e}: {o:?}"
                        );
                        assert!(o.status == "Ok" || o.error > 0.1, "{name} {share:e}: {o:?}");
                    }
                }
            }
        }
    }
}

/// Steps of the short runs of the next tests.
const SHORT: u64 = 10_000;

fn named<R: nekton::Real>(name: &str) -> Motion<R> {
    motions().into_iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no motion {name}"))
}

#[test]
fn energy_does_not_drift_with_gauss6_beyond_rounding() {
    for (name, double, single) in [("circling_disc", 1e-13, 1e-4), ("tumbling_ellipse", 1e-11, 1e-4)] {
        for drift in drifts(&named::<f64>(name), methods(named::<f64>(name).step)[3].1, SHORT).0 {
            println!("{name} f64 {drift:?}");
            assert!(drift.energy.abs() <= double && drift.impulse <= 1e-6, "{name} {drift:?}");
        }
        for drift in drifts(&named::<f32>(name), methods(named::<f32>(name).step)[3].1, SHORT).0 {
            println!("{name} f32 {drift:?}");
            // The body's impulse turns with its heading, whose rounding grows with the number of turns.
            assert!(drift.energy.abs() <= single && drift.impulse <= 3e-3, "{name} {drift:?}");
        }
    }
}

#[test]
fn energy_drifts_linearly_with_explicit_methods() {
    for (name, method) in methods::<f64>(0.025).into_iter().take(3) {
        let (all, _) = drifts(&named::<f64>("circling_disc"), method, SHORT);
        println!("{name} {all:?}");
        let [_, thousand, ten] = all[..] else { panic!("{all:?}") };
        let growth = ten.energy / thousand.energy;
        // From the first mean, near step 224, to the others, near 776 and 9776.
        assert!((10.0..25.0).contains(&growth), "{name}: {growth}");
    }
}

#[test]
fn gaps_may_be_a_hundred_thousandth_of_a_body_and_overlaps_are_refused() {
    for (width, single) in [(1e-1, 1e-6), (1e-5, 3e-6)] {
        sound("gap", width, &Case { nodes: 64, ..gap(width) }, [3e-10, single], [3e-10, 1e-5]);
    }
    for width in [1e-9, 0.0, -0.1] {
        assert_eq!(gap(width).run::<f64>(Method::Rk4 { step: 0.1 }).status, "Overlap", "{width}");
    }
}

#[test]
fn bodies_may_be_a_hundred_times_longer_than_wide() {
    for ratio in [1.0, 100.0] {
        sound("aspect", ratio, &Case { nodes: 64, ..aspect(ratio) }, [3e-10, 5e-5], [1e-9, 3e-4]);
    }
}

#[test]
fn a_tank_may_be_hardly_larger_than_the_body() {
    for width in [1.0, 1e-2] {
        sound("tank", width, &Case { nodes: 48, ..tank(width) }, [3e-10, 1e-5], [1e-9, 3e-5]);
    }
}
