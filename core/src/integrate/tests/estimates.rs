//! Estimates of local errors against the local errors.

use super::*;

/// Largest difference of estimated and true local error in `n` steps of y' = y² cos t, relative to the largest true one;
/// `step` makes a step from its time and returns the estimated error of the step made `lag` steps before.
fn mismatch(h: f64, n: usize, lag: usize, mut step: impl FnMut(f64, &mut [f64]) -> Option<f64>) -> f64 {
    // The true local error by ten substeps of the implicit method, which is exact here to rounding.
    let exact = |t: f64, y: f64| {
        let (mut m, mut memory, mut z) = (Gauss6::new(), vec![0.0; 20], [y]);
        for k in 0..10 {
            m.step(&mut ode(1, cosine_growth), t + 0.1 * h * f64::from(k), 0.1 * h, &mut z, &mut memory).unwrap();
        }
        z[0]
    };
    let (mut y, mut errors, mut worst, mut largest) = ([0.5], Vec::new(), 0.0, 0.0);
    for i in 0..n {
        let (t, before) = (h * i as f64, y[0]);
        let estimated = step(t, &mut y);
        let error: f64 = y[0] - exact(t, before);
        largest = f64::max(largest, error.abs());
        errors.push(error);
        if let Some(e) = estimated {
            worst = f64::max(worst, (e - errors[i - lag]).abs());
        }
    }
    worst / largest
}

#[test]
fn estimated_error_of_rk4_is_the_local_error_of_the_step_before() {
    let h = 0.02;
    let (mut m, mut memory) = (Rk4::new(), vec![0.0; 14]);
    let mismatch = mismatch(h, 200, 1, |t, y| {
        m.step(&mut ode(1, cosine_growth), t, h, y, &mut memory).unwrap();
        m.error(1, &memory).map(|e| e[0])
    });
    std::println!("rk4: {mismatch}");
    assert!(mismatch < 0.1, "{mismatch}");
}

#[test]
fn estimated_error_of_abm4_is_the_local_error_of_the_step() {
    let h = 0.01;
    let (mut m, mut memory) = (Abm4::new(), vec![0.0; 9]);
    let mismatch = mismatch(h, 400, 0, |t, y| {
        m.step(&mut ode(1, cosine_growth), t, h, y, &mut memory).unwrap();
        m.error(1, &memory).map(|e| e[0])
    });
    std::println!("abm4: {mismatch}");
    assert!(mismatch < 0.1, "{mismatch}");
}

#[test]
fn rough_error_of_rk4_is_above_the_error_of_every_step() {
    for h in [0.01, 0.05, 0.2] {
        let (mut m, mut memory) = (Rk4::new(), vec![0.0; 14]);
        let (mut y, mut z, mut exact, mut other) = ([0.5], [0.5], Gauss6::new(), vec![0.0; 20]);
        for k in 0..10 {
            let t = h * f64::from(k);
            m.step(&mut ode(1, cosine_growth), t, h, &mut y, &mut memory).unwrap();
            exact.step(&mut ode(1, cosine_growth), t, h, &mut z, &mut other).unwrap();
            let rough = m.rough_error(1, &memory).map(|e| e[0].abs()).unwrap();
            let made = (y[0] - z[0]).abs();
            assert!(rough > made && rough < 1e5 * made, "{h}, step {k}: {rough} {made}");
            y = z;
        }
        m.jump();
        assert!(m.rough_error(1, &memory).is_none());
    }
}
