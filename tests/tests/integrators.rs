//! Orders, tolerances and cost of the integrators on the paper's two ellipses.

use nekton::scene::Scene;
use nekton::{Method, STEP_LIMIT, Status};
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
    for method in FIXED.map(|fixed| fixed(0.01)).into_iter().chain([adams(1e-8)]) {
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
    // The limit that nobody set.
    let mut sim = simulation(&Scene { bodies: &bodies[..1], ..scene }, Method::Rk4 { step: 1e-9 });
    let mut sim = sim.view();
    assert_eq!(sim.advance(1.0).unwrap_err().status, Status::TooManySteps);
    assert_eq!(sim.counters().steps, STEP_LIMIT);
}

#[test]
fn estimated_time_errors_tell_the_size_of_the_true_ones() {
    // Up to t = 3 the motion amplifies errors little, and their sum is of the size of the true error.
    let (exact, _) = passage(48, adams(1e-13), 3.0);
    let methods =
        [Method::Rk4 { step: 0.1 }, Method::Rk4 { step: 0.025 }, Method::Abm4 { step: 0.05 }, adams(1e-6), adams(1e-9)];
    for method in methods {
        let links = paper_ellipse(48);
        let bodies = two_ellipses(&links);
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }, method);
        let mut sim = sim.view();
        assert!(f64::is_nan(sim.time_error().position));
        sim.advance(3.0).unwrap();
        let (estimate, truth) = (sim.time_error(), error(sim.positions(), &exact));
        println!("{method:?}: {truth:.1e}, {estimate:?}");
        let sum = estimate.position_sum + 3.0 * estimate.velocity_sum;
        assert!(sum > 0.5 * truth && sum < 200.0 * truth, "{method:?}: {truth:e}, {estimate:?}");
    }
    let links = paper_ellipse(24);
    let mut sim =
        simulation(&Scene { bodies: &two_ellipses(&links), ..Scene::new(1.0, 0.0) }, Method::Gauss6 { step: 0.5 });
    let mut sim = sim.view();
    sim.advance(1.0).unwrap();
    assert!(f64::is_nan(sim.time_error().position) && sim.time_error().unknown == 2);
}
