//! The implicit method.

use super::*;

/// A run of `n` steps; evaluations.
fn steps<R: Real, S: System<R>>(system: &mut S, h: R, n: usize, y: &mut [R], mut seen: impl FnMut(&[R])) -> u64 {
    let (mut m, mut memory) = (Gauss6::new(), vec![R::zero(); Gauss6::<R>::memory_len(y.len()).unwrap()]);
    for i in 0..n {
        m.step(system, h * R::count(i), h, y, &mut memory).unwrap();
        seen(y);
    }
    m.counters().evaluations
}

/// Energy and angular momentum of Kepler's problem.
fn invariants<R: Real>(y: &[R]) -> [f64; 2] {
    let [x, y, u, v] = [0, 1, 2, 3].map(|i| y[i].to_f64());
    [0.5 * (u * u + v * v) - 1.0 / x.hypot(y), x * v - y * u]
}

#[test]
fn gauss6_converges_with_order_six() {
    let error = |n: usize| {
        let (mut y, h, mut k, mut worst) = ([0.5], 4.0 / n as f64, 0, 0.0);
        let evaluations = steps(&mut ode(1, cosine_growth), h, n, &mut y, |y| {
            k += 1;
            worst = f64::max(worst, (y[0] - closed(h * f64::from(k))).abs());
        });
        std::println!("{n} steps: {worst:e}, {} a step", evaluations as f64 / n as f64);
        worst
    };
    let order = (error(32) / error(64)).log2();
    assert!((order - 6.0).abs() < 0.2, "{order}");
}

#[test]
fn gauss6_runs_back_to_where_it_came_from() {
    // Symmetry: the step −h undoes the step h, here to rounding.
    let (mut system, mut memory) = (ode(4, kepler), vec![0.0; Gauss6::<f64>::memory_len(4).unwrap()]);
    let (mut m, mut y) = (Gauss6::new(), pericentre(0.5));
    for h in [0.3, -0.3] {
        for _ in 0..100 {
            m.step(&mut system, 0.0, h, &mut y, &mut memory).unwrap();
        }
    }
    assert!(distance(&y, &pericentre(0.5)) < 1e-11, "{:e}", distance(&y, &pericentre(0.5)));
}

/// Largest deviation of the mean of energy and angular momentum over a hundredth of the run from the first such mean.
fn drift<R: Real>(h: R, n: usize) -> [f64; 2] {
    let y0 = pericentre(0.2);
    let (mut y, mut k) = (y0.map(R::lit), 0);
    let (mut sum, mut means) = ([0.0; 2], Vec::new());
    steps(&mut ode(4, kepler), h, n, &mut y, |y| {
        let now = invariants(y);
        sum = [sum[0] + now[0], sum[1] + now[1]];
        k += 1;
        if k % (n / 100) == 0 {
            means.push(core::mem::take(&mut sum).map(|s| s / (n / 100) as f64));
        }
    });
    means.iter().fold([0.0; 2], |m, now| [0, 1].map(|i| f64::max(m[i], (now[i] - means[0][i]).abs())))
}

#[test]
fn energy_of_gauss6_drifts_like_the_random_walk_of_rounding_only() {
    // 2⁻⁵³ √n × a few for n = 10⁵ steps of a 100th of the period; a loss of ε/2 in each step would be 10⁻¹¹.
    let [energy, momentum] = drift(std::f64::consts::TAU / 100.0, 100_000);
    std::println!("f64: energy {energy:e}, angular momentum {momentum:e}");
    assert!(energy < 5e-14 && momentum < 5e-15, "{energy:e} {momentum:e}");
    let [energy, momentum] = drift(std::f32::consts::TAU / 100.0, 100_000);
    std::println!("f32: energy {energy:e}, angular momentum {momentum:e}");
    assert!(energy < 1e-5 && momentum < 5e-6, "{energy:e} {momentum:e}");
}

#[test]
fn too_long_a_step_does_not_converge_and_says_so() {
    let mut system = ode(2, |_: f64, y: &[f64], d: &mut [f64]| {
        d.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    });
    let (mut m, mut memory) = (Gauss6::new(), vec![0.0; Gauss6::<f64>::memory_len(2).unwrap()]);
    for h in [2.0, 3.0, 10.0, 1e3, 1e200] {
        let mut y = [1.0, 0.25];
        let outcome = m.step(&mut system, 0.0, h, &mut y, &mut memory);
        let status = outcome.map_err(|e| e.status);
        std::println!("{h}: {status:?} {:?}", m.counters());
        if h >= 10.0 {
            assert!(matches!(status, Err(Status::NoConvergence | Status::NonFiniteState)));
            assert_eq!(y, [1.0, 0.25]);
        } else if status.is_ok() {
            // What is accepted is the step of the method: the Padé approximation (3, 3) of the exponential.
            let z = nalgebra::Complex::new(0.0, -h);
            let half = |s: f64| 1.0 + z * (0.5 * s) + z * z * 0.1 + z * z * z * (s / 120.0);
            let want = half(1.0) / half(-1.0) * nalgebra::Complex::new(1.0, 0.25);
            assert!(distance(&y, &[want.re, want.im]) < 1e-9, "{h}: {y:?} {want}");
        }
        m.reset();
    }
}
