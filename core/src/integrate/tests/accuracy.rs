//! Order, accuracy and cost.

use super::*;

/// Order seen in the largest error between 256 and 512 steps.
fn observed_order(error: impl Fn(usize) -> f64) -> f64 {
    (error(256) / error(512)).log2()
}

#[test]
fn rk4_converges_with_order_four_at_four_evaluations() {
    let order = observed_order(|n| {
        let (mut m, mut memory, mut y) = (Rk4::new(), vec![0.0; Rk4::<f64>::memory_len(1).unwrap()], [0.5]);
        let (h, mut worst) = (4.0 / n as f64, 0.0);
        for i in 0..n {
            m.step(&mut ode(1, cosine_growth), h * i as f64, h, &mut y, &mut memory).unwrap();
            worst = f64::max(worst, (y[0] - closed(h * (i + 1) as f64)).abs());
        }
        assert_eq!(m.counters(), Counters { evaluations: 4 * n as u64, steps: n as u64, rejected: 0 });
        worst
    });
    std::println!("rk4 order {order}");
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

#[test]
fn abm4_converges_with_order_four_at_two_evaluations() {
    let order = observed_order(|n| {
        let (mut m, mut y) = (Abm4::new(), [0.5]);
        let mut memory = vec![0.0; Abm4::<f64>::memory_len(1).unwrap()];
        let (h, mut worst) = (4.0 / n as f64, 0.0);
        for i in 0..n {
            m.step(&mut ode(1, cosine_growth), h * i as f64, h, &mut y, &mut memory).unwrap();
            worst = f64::max(worst, (y[0] - closed(h * (i + 1) as f64)).abs());
        }
        assert_eq!(m.counters().evaluations, 12 + 2 * (n as u64 - 3));
        worst
    });
    std::println!("abm4 order {order}");
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

#[test]
fn abm4_forgets_its_past_when_the_step_changes_or_is_reset() {
    let mut system = ode(1, cosine_growth);
    for reset in [false, true] {
        let h = if reset { 0.1 } else { 0.05 };
        let (mut m, mut y, mut memory) = (Abm4::new(), [0.5], vec![0.0; 9]);
        for i in 0..6 {
            m.step(&mut system, 0.1 * f64::from(i), 0.1, &mut y, &mut memory).unwrap();
        }
        if reset {
            m.reset();
        }
        let (mut fresh, mut z, mut other) = (Abm4::new(), y, vec![0.0; 9]);
        for i in 0..6 {
            m.step(&mut system, 0.6 + h * f64::from(i), h, &mut y, &mut memory).unwrap();
            fresh.step(&mut system, 0.6 + h * f64::from(i), h, &mut z, &mut other).unwrap();
            // A reset forgets the rest of the compensated sum, a change of step does not.
            assert!((y[0] - z[0]).abs() <= f64::EPSILON);
        }
    }
}

/// Largest errors of a run over 20 units of time, over all steps: of the states and of the dense output
/// (seven points in each step); highest order; evaluations.
fn observe<F: FnMut(f64, &[f64], &mut [f64]) -> Result<()>>(
    f: F,
    exact: impl Fn(f64) -> Vec<f64>,
    tolerance: f64,
) -> (f64, f64, usize, u64) {
    let mut y = exact(0.0);
    let mut rate = y.clone();
    let mut system = ode(y.len(), f);
    let (mut adams, mut memory) = started(tolerance, tolerance, 0.0, &y);
    let (mut error, mut dense, mut order) = (0.0, 0.0, 0);
    while adams.time() < 20.0 {
        adams.step(&mut system, 20.0, &mut memory).unwrap();
        order = order.max(adams.last_order());
        error = f64::max(error, distance(adams.state(&memory), &exact(adams.time())));
        for k in 1..8 {
            let t = adams.time() - adams.last_step() * f64::from(k) / 8.0;
            adams.interpolate(t, &memory, &mut y, &mut rate).unwrap();
            dense = f64::max(dense, distance(&y, &exact(t)));
        }
    }
    (error, dense, order, adams.counters().evaluations)
}

#[test]
fn adams_errors_follow_the_tolerance_at_the_cost_of_the_published_method() {
    // Evaluations of a translation of Shampine & Gordon's ODE (Euclidean norm, end interpolated) at 1e-4 … 1e-12.
    let orbit = [367, 478, 594, 725, 889, 1050, 1230, 1530, 1724];
    let body = [182, 235, 337, 361, 475, 555, 605, 833, 839];
    for (i, (orbit, body)) in orbit.into_iter().zip(body).enumerate() {
        let tolerance = 10f64.powi(-4 - i as i32);
        let kepler = observe(kepler, |t| ellipse(0.6, t).to_vec(), tolerance);
        let rigid = observe(rigid_body, |t| jacobi(t, 0.51).to_vec(), tolerance);
        for (name, (error, dense, order, evaluations), theirs, growth) in
            [("orbit", kepler, orbit, 2e4), ("body", rigid, body, 50.0)]
        {
            std::println!("{name} {tolerance:e}: {error:.1e} {dense:.1e} order {order}, {evaluations} ({theirs})");
            // Along three revolutions an orbit's phase error grows; the body's equations are neutral.
            assert!(error < growth * tolerance, "{name} {tolerance:e} {error:e}");
            assert!(dense < 1.5 * error, "{name} {tolerance:e} {dense:e} {error:e}");
            assert!(evaluations as f64 <= 1.1 * f64::from(theirs), "{name} {evaluations}");
            assert!(tolerance > 2e-12 || order >= 8, "{order}");
        }
    }
}

#[test]
fn dense_rates_are_the_derivative_of_the_solution() {
    let y0 = [0.0, 1.0, 1.0];
    let (mut adams, mut memory) = started(1e-10, 1e-10, 0.0, &y0);
    let mut system = ode(3, rigid_body);
    let (mut y, mut rate, mut want) = (y0, y0, y0);
    let mut worst = 0.0;
    while adams.time() < 10.0 {
        adams.step(&mut system, 10.0, &mut memory).unwrap();
        for part in [0.2, 0.5, 0.9] {
            adams.interpolate(adams.time() - part * adams.last_step(), &memory, &mut y, &mut rate).unwrap();
            rigid_body(0.0, &y, &mut want).unwrap();
            worst = f64::max(worst, distance(&rate, &want));
        }
        adams.interpolate(adams.time(), &memory, &mut y, &mut rate).unwrap();
        assert_eq!((&y[..], &rate[..]), (adams.state(&memory), adams.rate(&memory)));
    }
    std::println!("dense rates {worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}

#[test]
fn single_precision_reaches_its_tolerances() {
    for tolerance in [1e-4f32, 1e-5] {
        let y0 = pericentre(0.3).map(|x| x as f32);
        let (mut adams, mut memory) = started(tolerance, tolerance, 0.0, &y0);
        run(&mut adams, &mut ode(4, kepler), 20.0, &mut memory).unwrap();
        let end: Vec<f64> = adams.state(&memory).iter().map(|x| x.to_f64()).collect();
        let error = distance(&end, &ellipse(0.3, 20.0));
        std::println!("f32 {tolerance:e}: {error:e} {:?}", adams.counters());
        assert!(error < 1e3 * tolerance.to_f64(), "{error:e}");
    }
}

#[test]
fn compensated_sums_keep_single_precision_over_many_short_steps() {
    // 10⁵ steps, each of whose increments loses up to 3e-8 in a plain sum.
    let mut adams = Adams::new(1e-6f32, 1e-6, Some(1e-4)).unwrap();
    let mut memory = [0.0; 42];
    adams.start(0.0, &[1.0f32, 0.0], &mut memory).unwrap();
    let mut system = ode(2, |_: f32, y: &[f32], d: &mut [f32]| {
        d.copy_from_slice(&[-y[1], y[0]]);
        Ok(())
    });
    run(&mut adams, &mut system, 10.0, &mut memory).unwrap();
    let error = distance(&[f64::from(memory[0]), f64::from(memory[1])], &[10f64.cos(), 10f64.sin()]);
    std::println!("f32 short steps {error:e} {:?}", adams.counters());
    assert!(adams.counters().steps > 99_000 && error < 1e-6, "{error:e}");
}

#[test]
fn a_kink_in_the_right_hand_side_is_crossed_within_the_tolerance() {
    let mut system = ode(1, |t: f64, y: &[f64], d: &mut [f64]| {
        d[0] = (t - 1.0).abs() - 0.1 * y[0];
        Ok(())
    });
    // y' = |t − 1| − y/10: e^(−t/10) and the particular solutions 110 − 10 t and 10 t − 110.
    let left = |t: f64| -110.0 * (-0.1 * t).exp() - 10.0 * t + 110.0;
    let right = |t: f64| (left(1.0) + 100.0) * (-0.1 * (t - 1.0)).exp() + 10.0 * t - 110.0;
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let (mut adams, mut memory) = started(tolerance, tolerance, 0.0, &[0.0]);
        run(&mut adams, &mut system, 3.0, &mut memory).unwrap();
        let error = (adams.state(&memory)[0] - right(3.0)).abs();
        std::println!("kink {tolerance:e} {error:e} {:?}", adams.counters());
        assert!(error < 10.0 * tolerance, "{error:e}");
        assert!(adams.counters().evaluations < 400);
    }
}

#[test]
fn after_a_jump_a_restart_goes_on_accurately() {
    let slope = std::cell::Cell::new(1.0);
    let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
        d[0] = slope.get() * y[0];
        Ok(())
    });
    let (mut adams, mut memory) = started(1e-10, 1e-10, 0.0, &[1.0]);
    run(&mut adams, &mut system, 1.0, &mut memory).unwrap();
    slope.set(-1.0);
    adams.restart();
    run(&mut adams, &mut system, 2.0, &mut memory).unwrap();
    assert!((adams.state(&memory)[0] - 1.0).abs() < 1e-9);
}

#[test]
fn time_may_run_backwards() {
    let y0 = pericentre(0.6);
    let mut system = ode(4, kepler);
    let (mut adams, mut memory) = started(1e-11, 1e-11, 0.0, &y0);
    run(&mut adams, &mut system, -3.0, &mut memory).unwrap();
    assert!(distance(adams.state(&memory), &ellipse(0.6, -3.0)) < 1e-9);
    run(&mut adams, &mut system, 0.0, &mut memory).unwrap();
    assert!(distance(adams.state(&memory), &y0) < 1e-8);
    let (mut y, mut d) = (y0, y0);
    adams.interpolate(-1e-3, &memory, &mut y, &mut d).unwrap();
    assert!(distance(&y, &ellipse(0.6, -1e-3)) < 1e-8);
}

#[test]
fn the_tightest_tolerance_ends_at_rounding() {
    let tolerance = 4.0 * f64::EPSILON;
    let (mut adams, mut memory) = started(tolerance, tolerance, 0.0, &pericentre(0.6));
    run(&mut adams, &mut ode(4, kepler), 6.0, &mut memory).unwrap();
    let error = distance(adams.state(&memory), &ellipse(0.6, 6.0));
    std::println!("tightest {error:e} {:?}", adams.counters());
    assert!(error < 3e-13 && adams.counters().evaluations < 2000, "{error:e}");
}

#[test]
fn steps_and_orders_of_adams_are_the_same_in_every_unit_of_time() {
    // Units that are powers of 2 round nothing otherwise: every state is the same to the last digit. Stops shorten some steps.
    let steps = |unit: f64| {
        let mut system = ode(4, |t: f64, y: &[f64], d: &mut [f64]| {
            kepler(t, y, d)?;
            d.iter_mut().for_each(|d| *d /= unit);
            Ok(())
        });
        let (mut adams, mut memory) = started(1e-8, 1e-8, 0.0, &pericentre(0.6));
        let mut seen = Vec::new();
        for stop in [1.0, 1.001, 3.0, 3.01, 20.0] {
            while adams.time() != stop * unit {
                adams.step(&mut system, stop * unit, &mut memory).unwrap();
                seen.push((adams.time() / unit, adams.last_order(), adams.state(&memory).to_vec()));
            }
        }
        (seen, adams.counters().rejected)
    };
    let one = steps(1.0);
    for unit in [2f64.powi(-30), 2f64.powi(30)] {
        assert!(steps(unit) == one, "{unit:e}");
    }
}
