//! Orders, tolerances and cost of the integrators on the paper's two ellipses.

use nekton::scene::{Body, Drive, Joint, JointKind, Link, Mass, Root, Scene, Shape, Signal};
use nekton::{Method, STEP_LIMIT, Sim, Status};
use nekton_tests::*;

/// The methods of fixed step.
const FIXED: [fn(f64) -> Method<f64>; 3] =
    [|step| Method::Rk4 { step }, |step| Method::Abm4 { step }, |step| Method::Gauss6 { step }];

/// Positions of both ellipses at time `t`, and the number of evaluations.
fn passage(nodes: usize, method: Method<f64>, t: f64) -> (Vec<f64>, u64) {
    let links = paper_ellipse(nodes);
    let bodies = two_ellipses(&links);
    let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method);
    let mut sim = sim.view();
    sim.advance(t).unwrap();
    let evaluations = sim.counters().evaluations;
    (sim.positions().to_vec(), evaluations as u64)
}

/// Largest absolute difference.
fn error(computed: &[f64], exact: &[f64]) -> f64 {
    computed.iter().zip(exact).fold(0.0, |m: f64, (c, e)| m.max((c - e).abs()))
}

/// Order observed when the step is halved from `step` four times. Until t = 3 the gap is above 0.5: 64 nodes resolve it, and
/// the right-hand side is smooth.
fn order(step: f64, method: impl Fn(f64) -> Method<f64>) -> f64 {
    let (exact, _) = passage(64, adams(1e-13), 3.0);
    let errors = [1.0, 0.5, 0.25, 0.125].map(|part| error(&passage(64, method(step * part), 3.0).0, &exact));
    let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    println!("errors {errors:?}, orders {orders:?}");
    orders[2]
}

#[test]
fn rk4_has_order_4() {
    assert_near(order(0.2, |step| Method::Rk4 { step }), 4.0, 0.05);
}

#[test]
fn abm4_has_order_4() {
    assert_near(order(0.1, |step| Method::Abm4 { step }), 4.0, 0.1);
}

#[test]
fn error_of_adams_is_proportional_to_the_tolerance() {
    let (exact, _) = passage(48, adams(1e-13), 5.0);
    let mut last = f64::INFINITY;
    for exponent in (4..=10).step_by(2) {
        let tolerance = 10.0_f64.powi(-exponent);
        let (q, evaluations) = passage(48, adams(tolerance), 5.0);
        let error = error(&q, &exact);
        println!("tolerance {tolerance:.0e}: error {error:.1e}, {evaluations} evaluations");
        assert!(error <= 30.0 * tolerance, "tolerance {tolerance:e}: {error:e}");
        // A hundredth of the tolerance gains at least a factor ten.
        assert!(error <= 0.1 * last, "{error:e} after {last:e}");
        last = error;
    }
}

#[test]
fn adams_passes_the_two_ellipses_to_4e_11_with_500_evaluations() {
    // The gap falls to 0.118 near t = 7. Fewer nodes leave a ripple of the force there that no integrator can follow.
    let (exact, _) = passage(320, adams(1e-13), 10.0);
    let (q, evaluations) = passage(280, adams(1e-12), 10.0);
    println!("error {:.1e}, {evaluations} evaluations", error(&q, &exact));
    assert!(error(&q, &exact) <= 4e-11, "{:e}", error(&q, &exact));
    assert!(evaluations <= 500, "{evaluations}");
}

#[test]
fn advance_stops_exactly_and_dense_output_agrees_with_it() {
    let links = paper_ellipse(48);
    let bodies = two_ellipses(&links);
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    for method in FIXED.map(|fixed| fixed(0.03)).into_iter().chain([adams(1e-9)]) {
        let (mut stopped, mut dense) = (simulation(&scene, method), simulation(&scene, method));
        let (mut stopped, mut dense) = (stopped.view(), dense.view());
        for k in 1..=7 {
            let t = 0.31 * f64::from(k);
            stopped.advance(t).unwrap();
            dense.advance_dense(t, 3.0).unwrap();
            assert_eq!(stopped.time(), t);
            assert_eq!(dense.time(), t);
            let error = error(stopped.positions(), dense.positions());
            assert!(error <= 1e-7, "{method:?} at {t}: {error:e}");
        }
    }
}

#[test]
fn runs_repeat_bit_for_bit() {
    for method in FIXED.map(|fixed| fixed(0.1)).into_iter().chain([adams(1e-7)]) {
        assert_eq!(passage(32, method, 2.0), passage(32, method, 2.0));
    }
}

#[test]
fn gauss6_has_order_6() {
    // Shorter steps end at rounding.
    let (exact, _) = passage(64, Method::Gauss6 { step: 0.05 }, 3.0);
    assert!(error(&exact, &passage(64, adams(1e-13), 3.0).0) <= 3e-12);
    let [long, short] = [0.3, 0.15].map(|step| error(&passage(64, Method::Gauss6 { step }, 3.0).0, &exact));
    println!("errors {long:e}, {short:e}");
    assert_near((long / short).log2(), 6.0, 0.6);
}

#[test]
fn an_advance_ends_after_the_steps_allowed_and_may_go_on() {
    let links = paper_ellipse(24);
    let bodies = two_ellipses(&links);
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    for method in [adams::<f64>(1e-8)] {
        let (mut limited, mut free) = (simulation(&scene, method), simulation(&scene, method));
        let (mut limited, mut free) = (limited.view(), free.view());
        assert_eq!(limited.set_step_limit(0).unwrap_err().status, Status::OutOfRange);
        limited.set_step_limit(4).unwrap();
        let mut calls = 0;
        while let Err(error) = limited.advance(0.5) {
            assert_eq!(error.status, Status::TooManySteps);
            calls += 1;
            assert_eq!(limited.counters().steps, 4 * calls);
            // What is shown is the state after the last of them.
            let t = limited.time();
            assert!(t > 0.0 && limited.energy().unwrap().total.is_finite(), "{t}");
        }
        free.advance(0.5).unwrap();
        assert!(calls >= 2, "{calls}");
        assert_eq!(limited.positions(), free.positions(), "{method:?}");
    }
    // Of fixed steps the number is known before: nothing is done.
    for method in FIXED.map(|fixed| fixed(0.01)) {
        let mut limited = simulation(&scene, method);
        let mut limited = limited.view();
        limited.set_step_limit(49).unwrap();
        let error = limited.advance(0.5).unwrap_err();
        assert_eq!((error.status, error.value, error.limit), (Status::TooManySteps, 50.0, 49.0));
        assert_eq!((limited.counters().steps, limited.time()), (0, 0.0));
        limited.set_step_limit(50).unwrap();
        limited.advance(0.5).unwrap();
    }
    // The limit that nobody set.
    let mut sim = simulation(&Scene { bodies: &bodies[..1], ..scene }, Method::Rk4 { step: 1e-9 });
    let error = sim.view().advance(1.0).unwrap_err();
    assert_eq!((error.status, error.limit), (Status::TooManySteps, STEP_LIMIT as f64));
    assert!(error.to_string().contains("steps = 1000000000 beside 1000000)"), "{error}");
}

/// Where angles are in the state of [`crawler`], before the rates.
const ANGLES: [usize; 3] = [2, 5, 6];

/// An ellipse, and three links of which a spring bends one hinge and another moves one slider; `unit` times as long, at the same
/// durations, so that the estimates must tell lengths from angles.
fn crawler(unit: f64, method: Method<f64>, look: impl FnOnce(&mut Sim<'_, f64>)) {
    let ellipse = |a: f64, b: f64| link(Shape::Ellipse { a: a * unit, b: b * unit }, 1.0, 48);
    let spring = |stiffness, start| Drive::Torque {
        torque: Signal::Constant(0.0),
        stiffness,
        damping: 0.0,
        rest: 0.0,
        start: [start, 0.0],
    };
    let bend = hinged(ellipse(0.6, 0.3), 0, [1.2 * unit, 0.0], [-0.9 * unit, 0.0], spring(2.0 * unit.powi(4), 0.5));
    let slide = Joint {
        parent: 0,
        kind: JointKind::Slider { axis: [1.0, 0.2], angle: 0.3 },
        parent_anchor: [-2.2 * unit, 0.0],
        self_anchor: [0.0; 2],
        drive: spring(3.0 * unit * unit, 0.3 * unit),
    };
    let (alone, links) =
        ([ellipse(0.8, 0.5)], [ellipse(0.8, 0.4), bend, Link { joint: Some(slide), ..ellipse(0.5, 0.4) }]);
    let bodies = [
        body(&alone, [0.3 * unit, 2.5 * unit, 0.4], [0.1 * unit, -0.2 * unit, 0.3]),
        body(&links, [0.0; 3], [0.0, 0.1 * unit, 0.2]),
    ];
    look(&mut simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method).view());
}

/// Runs to `end` and compares sums of the estimates (rates act for the rest of the run) with the errors of the coordinates.
fn told_and_true(sim: &mut Sim<'_, f64>, end: f64, exact: &[f64], angles: &[usize]) -> [[f64; 2]; 2] {
    assert!(sim.time_error().length.is_nan() && sim.time_error().length_sum.is_nan());
    sim.advance(end).unwrap();
    let (e, mut truth) = (sim.time_error(), [0.0_f64; 2]);
    for (k, (a, b)) in sim.state().iter().zip(exact).enumerate() {
        let kind = usize::from(angles.contains(&k));
        truth[kind] = truth[kind].max((a - b).abs());
    }
    [[e.length_sum + end * e.speed_sum, truth[0]], [e.angle_sum + end * e.spin_sum, truth[1]]]
}

#[test]
fn estimated_time_errors_tell_lengths_and_angles_within_a_known_factor() {
    // These motions amplify errors little within this time. The sums are of magnitudes, so they know of no cancellation:
    // measured are 2 to 8 (rk4), 2 to 22 (abm4) and 3 to 380 (adams) times the true errors.
    let (rk4, abm4, variable) = (20.0, 60.0, 1000.0);
    for unit in [1e-3_f64, 1.0, 1e3] {
        let tight = |tolerance: f64| Method::adams(tolerance, tolerance * unit.min(1.0));
        let mut exact = Vec::new();
        crawler(unit, tight(1e-13), |sim| {
            sim.advance(2.0).unwrap();
            exact = sim.state()[..8].to_vec();
        });
        let passing = passage(48, adams(1e-13), 3.0).0;
        for (method, most) in [
            (Method::Rk4 { step: 0.05 }, rk4),
            (Method::Rk4 { step: 0.0125 }, rk4),
            (Method::Abm4 { step: 0.025 }, abm4),
            (Method::Abm4 { step: 0.00625 }, abm4),
            (tight(1e-5), variable),
            (tight(1e-7), variable),
            (tight(1e-9), variable),
        ] {
            let check = |[told, truth]: [f64; 2]| {
                println!("{unit:e} {method:?}: {:.2}; {truth:.1e}", told / truth);
                assert!(told > truth && told < most * truth, "{unit:e} {method:?}: {truth:e}, {told:e}");
            };
            crawler(unit, method, |sim| {
                told_and_true(sim, 2.0, &exact, &ANGLES).into_iter().for_each(check);
            });
            if unit == 1.0 {
                let links = paper_ellipse(48);
                let mut sim = simulation(&Scene { bodies: &two_ellipses(&links), ..Scene::new(1.0, 0.0) }, method);
                let mut sim = sim.view();
                told_and_true(&mut sim, 3.0, &passing, &[2, 5]).into_iter().for_each(check);
            }
        }
    }
    crawler(1.0, Method::Gauss6 { step: 0.1 }, |sim| {
        sim.advance(0.2).unwrap();
        assert!(sim.time_error().length.is_nan() && sim.time_error().angle.is_nan() && sim.time_error().unknown == 2);
    });
}

#[test]
fn sums_of_time_errors_are_sums_of_what_every_step_tells() {
    for method in [Method::Rk4 { step: 0.05 }, Method::Abm4 { step: 0.05 }, adams(1e-7)] {
        crawler(1.0, method, |sim| {
            let mut sums = [0.0; 4];
            let (mut unknown, mut told) = (0, 0);
            for _ in 0..30 {
                sim.step().unwrap();
                let e = sim.time_error();
                if e.unknown > unknown {
                    unknown = e.unknown;
                    continue;
                }
                told += 1;
                for (sum, error) in sums.iter_mut().zip([e.length, e.angle, e.speed, e.spin]) {
                    assert!(error > 0.0, "{method:?}: {e:?}");
                    *sum += error;
                }
            }
            let e = sim.time_error();
            assert!(told >= 20, "{method:?}: {told}");
            assert_eq!(unknown + told, 30);
            for (told, sum) in [e.length_sum, e.angle_sum, e.speed_sum, e.spin_sum].into_iter().zip(sums) {
                assert_near(told / sum, 1.0, 1e-14);
            }
        });
    }
}

#[test]
fn times_of_fixed_steps_are_counted_not_summed() {
    // A sum of n steps 0.1 would be off by some n ulps after n steps; n·h is rounded once.
    let links = [link(disc(0.5), 1.0, 8)];
    let bodies = [body(&links, [0.0; 3], [0.1, 0.0, 0.0])];
    let step = 0.1;
    for method in FIXED.map(|fixed| fixed(step)) {
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, method);
        let mut sim = sim.view();
        for n in 1..=1000 {
            sim.step().unwrap();
            assert_eq!(sim.time(), f64::from(n) * step, "{method:?}");
        }
        // From a time that is set, the count begins there.
        let y = sim.state().to_vec();
        sim.set_state(7.0, &y).unwrap();
        for n in 1..=300 {
            sim.step().unwrap();
            assert_eq!(sim.time(), 7.0 + f64::from(n) * step, "{method:?}");
        }
    }
}

#[test]
fn gauss6_takes_fewer_evaluations_where_it_knows_the_last_step() {
    // Stages extrapolated from the last step are close to those of the next; without a past the iteration begins farther away.
    let links = paper_ellipse(32);
    let bodies = two_ellipses(&links);
    let count = |forget: bool| {
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, Method::Gauss6 { step: 0.05 });
        let mut sim = sim.view();
        for _ in 0..20 {
            if forget {
                sim.restart();
            }
            sim.step().unwrap();
        }
        sim.counters().evaluations
    };
    let (known, forgotten) = (count(false), count(true));
    println!("{known} of {forgotten}");
    assert!(10 * known <= 8 * forgotten, "{known} of {forgotten}");
}

#[test]
fn error_that_a_long_step_tells_is_that_of_a_spring_in_every_unit_of_time() {
    // On a spring rk4 multiplies y + i ẏ/ω by Σ zᵏ/k! to k = 4, z = iωh, instead of eᶻ: a local error of |z|⁵/120 of the amplitude,
    // which position and rate take in turns. Told is the largest of position and rate over a step, of lengths in reaches (of the nodes,
    // and half of their spacing).
    let (z, reach, inertia) = (0.2_f64, 0.1, 2.0);
    let mass = Mass::Given { mass: inertia, inertia, centre_of_mass: [0.0; 2] };
    let slider = JointKind::Slider { axis: [1.0, 0.0], angle: 0.0 };
    for (h, (kind, unit)) in
        [1e-3, 0.1, 1.0, 30.0, 1e3].into_iter().flat_map(|h| [(h, (slider, reach)), (h, (JointKind::Hinge, 1.0))])
    {
        let (stiffness, amplitude) = (inertia * (z / h).powi(2), 0.3 * unit * 120.0 / z.powi(5));
        let torque = Signal::Constant(0.0);
        let drive = Drive::Torque { torque, stiffness, damping: 0.0, rest: 0.0, start: [amplitude, 0.0] };
        // So far away that nothing touches on the way.
        let joint = Joint { parent: 0, kind, parent_anchor: [0.0, 1e3], self_anchor: [0.0; 2], drive };
        let small = Link { mass, ..link(disc(reach), 1.0, 400) };
        let links = [small, Link { joint: Some(joint), ..small }];
        let held = [Signal::Constant(0.0); 3];
        let bodies = [Body { root: Root::Prescribed(held), ..body(&links, [0.0; 3], [0.0; 3]) }];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, Method::Rk4 { step: h });
        let mut sim = sim.view();
        sim.advance(10.0 * h).unwrap();
        // More than a period.
        sim.advance(50.0 * h).unwrap();
        let (_, notice) = sim.notice().unwrap();
        assert_eq!(notice.status, Status::StepTooLong);
        println!("{h} {kind:?}: {}", notice.value / (0.3 * z.hypot(1.0)));
        assert_near(notice.value / (0.3 * z.hypot(1.0)), 1.0, 0.03);
    }
}
