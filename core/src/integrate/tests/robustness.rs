//! Stops, failing right-hand sides, bad input, corner cases.

use super::*;

#[test]
fn adams_stops_exactly_and_never_evaluates_beyond() {
    let latest = std::cell::Cell::new(0.0);
    let stop = std::cell::Cell::new(0.0);
    let mut system = ode(1, |t: f64, y: &[f64], d: &mut [f64]| {
        assert!(t <= stop.get());
        latest.set(f64::max(latest.get(), t));
        cosine_growth(t, y, d)
    });
    let (mut adams, mut memory) = started(1e-9, 1e-9, 0.0, &[0.5]);
    for t in [0.1, 0.1 + 1e-15, 0.3, 0.300001, 1.0, 4.0, 11.7] {
        stop.set(t);
        run(&mut adams, &mut system, t, &mut memory).unwrap();
        assert_eq!((adams.time(), latest.get()), (t, t));
        assert!((adams.state(&memory)[0] - closed(t)).abs() < 1e-8);
        let before = adams.counters();
        adams.step(&mut system, t, &mut memory).unwrap();
        assert_eq!(before, adams.counters());
    }
}

#[test]
fn frequent_stops_cost_one_step_each() {
    let mut system = ode(1, cosine_growth);
    let (mut adams, mut memory) = started(1e-9, 1e-9, 0.0, &[0.5]);
    for i in 1..=400 {
        run(&mut adams, &mut system, 0.05 * f64::from(i), &mut memory).unwrap();
    }
    std::println!("stops {:?}", adams.counters());
    assert!((adams.state(&memory)[0] - closed(20.0)).abs() < 1e-8);
    assert!(adams.counters().steps < 480);
}

/// All that a later call can see: scalars but for the counters, and the persistent part of the memory.
fn snapshot(adams: &Adams<f64>, memory: &[f64], dim: usize) -> (std::string::String, Vec<u64>) {
    let text = std::format!("{adams:?}");
    let scalars = text.split(", counters").next().unwrap().into();
    (scalars, memory[..17 * dim].iter().map(|x| x.to_bits()).collect())
}

#[test]
fn a_failing_right_hand_side_changes_nothing_and_the_run_may_go_on() {
    for (status, rate) in [(Status::Contact, 0.0), (Status::Internal, 0.0), (Status::NonFiniteState, f64::NAN)] {
        let broken = std::cell::Cell::new(false);
        let mut system = ode(4, |t: f64, y: &[f64], d: &mut [f64]| {
            kepler(t, y, d)?;
            if broken.get() {
                d.fill(rate);
                return if rate.is_nan() { Ok(()) } else { Err(status.into()) };
            }
            Ok(())
        });
        let y0 = pericentre(0.6);
        let (mut adams, mut memory) = started(1e-8, 1e-8, 0.0, &y0);
        let (mut other, mut elsewhere) = (adams, memory.clone());
        for i in 0..60 {
            broken.set(true);
            if i % 7 == 0 {
                let before = snapshot(&adams, &memory, 4);
                let error = adams.step(&mut system, 20.0, &mut memory).unwrap_err();
                assert_eq!(error.status, status);
                assert_eq!(snapshot(&adams, &memory, 4), before);
            }
            broken.set(false);
            adams.step(&mut system, 20.0, &mut memory).unwrap();
            other.step(&mut system, 20.0, &mut elsewhere).unwrap();
            assert_eq!(snapshot(&adams, &memory, 4), snapshot(&other, &elsewhere, 4));
        }

        let (mut rk4, mut abm4, mut memory) = (Rk4::new(), Abm4::new(), vec![0.0; 36]);
        let (mut y, mut z) = (y0, y0);
        for i in 0..8 {
            broken.set(true);
            let before = (y, z);
            assert_eq!(rk4.step(&mut system, 0.0, 0.01, &mut y, &mut [0.0; 56]).unwrap_err().status, status);
            assert_eq!(abm4.step(&mut system, 0.0, 0.01, &mut z, &mut memory).unwrap_err().status, status);
            assert_eq!((y, z), before, "{i}");
            broken.set(false);
            rk4.step(&mut system, 0.0, 0.01, &mut y, &mut [0.0; 56]).unwrap();
            abm4.step(&mut system, 0.0, 0.01, &mut z, &mut memory).unwrap();
        }
        assert!(distance(&y, &ellipse(0.6, 0.08)) < 1e-6 && distance(&z, &ellipse(0.6, 0.08)) < 1e-6);
    }
}

#[test]
fn fixed_steps_that_fail_in_a_late_stage_leave_the_state() {
    for fail_at in 1..=4 {
        let mut calls = 0;
        let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
            calls += 1;
            d[0] = y[0];
            if calls == fail_at { Err(Status::Contact.into()) } else { Ok(()) }
        });
        let mut y = [0.1];
        assert!(Rk4::new().step(&mut system, 0.0, 0.1, &mut y, &mut [0.0; 13]).is_err());
        assert_eq!(y, [0.1]);
    }
}

#[test]
fn a_wall_that_the_solution_never_reaches_is_not_hit() {
    // y' = 1 − y with no rate at y ≥ 1: y = 1 − e^{−t}; a predictor of long steps overshoots.
    let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
        d[0] = 1.0 - y[0];
        if y[0] >= 1.0 { Err(Status::Contact.into()) } else { Ok(()) }
    });
    let (mut adams, mut memory) = started(1e-6, 1e-6, 0.0, &[0.0]);
    run(&mut adams, &mut system, 9.0, &mut memory).unwrap();
    assert!((adams.state(&memory)[0] - (1.0 - (-9.0f64).exp())).abs() < 1e-5);
}

#[test]
fn contact_is_approached_to_rounding_and_then_reported() {
    let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
        d[0] = 1.0 + y[0];
        if y[0] > 0.7 { Err(Status::Contact.into()) } else { Ok(()) }
    });
    let (mut adams, mut memory) = started(1e-10, 1e-10, 0.0, &[0.0]);
    let error = run(&mut adams, &mut system, 2.0, &mut memory).unwrap_err();
    std::println!("contact at {:e}, {:?}", adams.time() - 1.7f64.ln(), adams.counters());
    assert_eq!(error.status, Status::Contact);
    assert!((adams.time() - 1.7f64.ln()).abs() < 1e-10 && adams.state(&memory)[0] <= 0.7);
    assert!(adams.counters().evaluations < 1500);
}

#[test]
fn a_solution_that_becomes_infinite_ends_with_an_error_before() {
    let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
        d[0] = y[0] * y[0];
        Ok(())
    });
    let (mut adams, mut memory) = started(1e-8, 1e-8, 0.0, &[1.0]);
    let error = run(&mut adams, &mut system, 2.0, &mut memory).unwrap_err();
    std::println!("{error} {:?}", adams.counters());
    assert!(matches!(error.status, Status::StepTooSmall | Status::NonFiniteState));
    assert!((adams.time() - 1.0).abs() < 1e-6 && adams.state(&memory)[0].is_finite());
}

#[test]
fn a_state_that_cannot_be_passed_ends_a_run_soon() {
    // As at a contact: beyond it there is no rate, and every step towards it is shorter than the one before.
    let mut system = ode(1, |_: f64, y: &[f64], d: &mut [f64]| {
        d[0] = 1.0;
        if y[0] < 30.0 { Ok(()) } else { Err(Status::Contact.into()) }
    });
    let (mut adams, mut memory) = started(1e-3, 1e-3, 0.0, &[0.0]);
    let error = run(&mut adams, &mut system, 100.0, &mut memory).unwrap_err();
    assert!(matches!(error.status, Status::Contact | Status::StepTooSmall), "{error}");
    assert!(adams.counters().evaluations < 300, "{:?}", adams.counters());
}

#[test]
fn runs_repeat_bit_for_bit() {
    let run = || {
        let (mut adams, mut memory) = started(1e-9, 1e-9, 0.0, &pericentre(0.6));
        run(&mut adams, &mut ode(4, kepler), 20.0, &mut memory).unwrap();
        (memory.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), adams.counters())
    };
    assert_eq!(run(), run());
}

#[test]
fn systems_without_unknowns_and_without_motion_reach_the_stop() {
    let (mut adams, mut memory) = started(1e-6, 1e-6, 0.0, &[]);
    run(&mut adams, &mut ode(0, |_, _: &[f64], _: &mut [f64]| Ok(())), 1e6, &mut memory).unwrap();
    assert!(adams.counters().steps < 20);
    let (mut adams, mut memory) = started(1e-6, 1e-6, -5.0, &[3.0]);
    let mut still = ode(1, |_, _: &[f64], d: &mut [f64]| {
        d[0] = 0.0;
        Ok(())
    });
    run(&mut adams, &mut still, 1e6, &mut memory).unwrap();
    assert_eq!(adams.state(&memory), [3.0]);
    let mut none = ode(0, |_, _: &[f64], _: &mut [f64]| Ok(()));
    Rk4::new().step(&mut none, 0.0, 1.0, &mut [], &mut []).unwrap();
    Abm4::new().step(&mut none, 0.0, 1.0, &mut [], &mut []).unwrap();
    Gauss6::new().step(&mut none, 0.0, 1.0, &mut [], &mut []).unwrap();
}

#[test]
fn adams_goes_on_where_its_clock_can_no_longer_tell_its_steps() {
    // Steps of about 0.2, where the time has a last digit of 1/16, 1, 8: the stop is met to half of that.
    for (start, digit) in [(0.0, 0.0), (1e6, 0.0625), (-1e6, 0.0625), (1e7, 1.0), (1e8, 8.0)] {
        let (mut adams, mut memory) = started(1e-6, 1e-6, start, &[1.0, 0.0]);
        let mut system = ode(2, |_: f32, y: &[f32], d: &mut [f32]| {
            d.copy_from_slice(&[y[1], -y[0]]);
            Ok(())
        });
        run(&mut adams, &mut system, start + 64.0, &mut memory).unwrap();
        let [x, v] = [0, 1].map(|i| f64::from(adams.state(&memory)[i]));
        let ahead = (f64::atan2(-v, x) - 64.0).sin().asin();
        std::println!("{start:e}: {:?}, {ahead:e}, {:e}", adams.counters(), x.hypot(v) - 1.0);
        assert!((x.hypot(v) - 1.0).abs() < 3e-4 && adams.counters().steps > 200, "{start}");
        assert!(ahead.abs() < 3e-4 + 0.5 * digit, "{start}");
    }
}

#[test]
fn no_step_is_longer_than_asked() {
    let mut adams = Adams::new(1e-4, 1e-4, Some(0.03)).unwrap();
    let mut memory = [0.0; 21];
    adams.start(0.0, &[0.5], &mut memory).unwrap();
    while adams.time() < 1.0 {
        adams.step(&mut ode(1, cosine_growth), 1.0, &mut memory).unwrap();
        assert!(adams.last_step() <= 0.03);
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let status = |r: Result<Adams<f64>>| r.unwrap_err().status;
    for bad in [0.0, -1e-6, f64::NAN, f64::INFINITY, 3.0 * f64::EPSILON] {
        assert_eq!(status(Adams::new(bad, 1e-6, None)), Status::BadTolerance);
    }
    for bad in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
        assert_eq!(status(Adams::new(1e-6, bad, None)), Status::BadTolerance);
        assert_eq!(status(Adams::new(1e-6, 1e-6, Some(bad))), Status::BadStep);
    }
    let mut system = ode(1, cosine_growth);
    let (mut adams, mut memory) = started(1e-6, 1e-6, 0.0, &[0.5]);
    let status = |r: Result<()>| r.unwrap_err().status;
    assert_eq!(status(adams.start(f64::NAN, &[0.5], &mut memory)), Status::NotFinite);
    assert_eq!(status(adams.start(0.0, &[f64::NAN], &mut memory)), Status::NotFinite);
    assert_eq!(status(adams.start(0.0, &[0.5], &mut [0.0; 20])), Status::MemoryTooSmall);
    assert_eq!(status(adams.step(&mut system, f64::INFINITY, &mut memory)), Status::NotFinite);
    assert_eq!(status(adams.step(&mut system, 1.0, &mut [0.0; 20])), Status::MemoryTooSmall);
    assert_eq!(status(adams.step(&mut ode(2, cosine_growth), 1.0, &mut memory)), Status::Length);
    assert_eq!(status(adams.interpolate(0.0, &memory, &mut [0.0; 2], &mut [0.0])), Status::Length);
    assert_eq!(status(adams.interpolate(0.0, &[0.0; 20], &mut [0.0], &mut [0.0])), Status::MemoryTooSmall);
    assert_eq!(adams.counters(), Counters::default());
    let mut y = [0.5];
    for bad in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(status(Rk4::new().step(&mut system, 0.0, bad, &mut y, &mut memory)), Status::BadStep);
        assert_eq!(status(Abm4::new().step(&mut system, 0.0, bad, &mut y, &mut memory)), Status::BadStep);
    }
    assert_eq!(status(Rk4::new().step(&mut system, f64::NAN, 0.1, &mut y, &mut memory)), Status::NotFinite);
    assert_eq!(status(Rk4::new().step(&mut system, 0.0, 0.1, &mut y, &mut [0.0; 2])), Status::MemoryTooSmall);
    assert_eq!(status(Rk4::new().step(&mut system, 0.0, 0.1, &mut [0.5; 2], &mut memory)), Status::Length);
}

#[test]
fn a_state_that_fails_all_around_ends_the_step_after_a_bounded_number_of_trials() {
    for start in [0.0, 1.0, -1e6] {
        for ulps in [1.0, 15.0, 16.0, 16.5, 17.0, 17.5, 20.0, 1e3, 1e15] {
            let stop = start + ulps * f64::EPSILON * f64::max(1.0, start.abs());
            let mut first = true;
            let mut system = ode(1, |_: f64, _: &[f64], d: &mut [f64]| {
                d[0] = 1.0;
                if core::mem::take(&mut first) { Ok(()) } else { Err(Status::Singular.into()) }
            });
            let (mut adams, mut memory) = started(1e-6, 1e-6, start, &[0.5]);
            assert_eq!(adams.step(&mut system, stop, &mut memory).unwrap_err().status, Status::Singular);
            assert!(adams.counters().evaluations < 70, "{:?}", adams.counters());
            assert_eq!((adams.time(), adams.state(&memory)[0]), (start, 0.5));
        }
    }
}
