//! Claims about the integrators, checked against closed forms and against each other.

extern crate std;
use std::vec;
use std::vec::Vec;

use super::*;
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};

mod accuracy;
mod clocked;
mod estimates;
mod implicit;
mod robustness;

/// A right-hand side from a closure.
struct Ode<F> {
    dim: usize,
    f: F,
}

impl<R, F: FnMut(R, &[R], &mut [R]) -> Result<()>> System<R> for Ode<F> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn rhs(&mut self, t: R, y: &[R], dydt: &mut [R]) -> Result<()> {
        (self.f)(t, y, dydt)
    }
}

fn ode<R, F: FnMut(R, &[R], &mut [R]) -> Result<()>>(dim: usize, f: F) -> Ode<F> {
    Ode { dim, f }
}

/// y' = y² cos t, y(0) = 1/2: y = 1 / (2 − sin t).
fn cosine_growth(t: f64, y: &[f64], d: &mut [f64]) -> Result<()> {
    d[0] = y[0] * y[0] * t.cos();
    Ok(())
}
fn closed(t: f64) -> f64 {
    1.0 / (2.0 - t.sin())
}

/// Kepler's problem, GM = 1.
fn kepler<R: Real>(_: R, y: &[R], d: &mut [R]) -> Result<()> {
    let r = y[0].hypot(y[1]);
    let k = -R::one() / (r * r * r);
    d.copy_from_slice(&[y[2], y[3], k * y[0], k * y[1]]);
    Ok(())
}
/// Pericentre of the ellipse of eccentricity `e`, semi-major axis 1 (period 2π).
fn pericentre(e: f64) -> [f64; 4] {
    [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()]
}
/// The state on that ellipse at time t, by Kepler's equation.
fn ellipse(e: f64, t: f64) -> [f64; 4] {
    let mean = t - std::f64::consts::TAU * (t / std::f64::consts::TAU).floor();
    let mut u = mean;
    for _ in 0..50 {
        u -= (u - e * u.sin() - mean) / (1.0 - e * u.cos());
    }
    let (b, rate) = ((1.0 - e * e).sqrt(), 1.0 / (1.0 - e * u.cos()));
    [u.cos() - e, b * u.sin(), -u.sin() * rate, b * u.cos() * rate]
}

/// Euler's equations of a free rigid body: y = (sn, cn, dn) with modulus k² = 0.51, y(0) = (0, 1, 1).
fn rigid_body(_: f64, y: &[f64], d: &mut [f64]) -> Result<()> {
    d.copy_from_slice(&[y[1] * y[2], -y[0] * y[2], -0.51 * y[0] * y[1]]);
    Ok(())
}
/// Jacobi's sn, cn, dn by descending Landen (arithmetic–geometric mean) steps.
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut a, mut b, mut c) = (1.0_f64, (1.0 - m).sqrt(), m.sqrt());
    let mut levels = vec![(a, c)];
    while c.abs() > 1e-16 {
        (a, b, c) = ((a + b) / 2.0, (a * b).sqrt(), (a - b) / 2.0);
        levels.push((a, c));
    }
    let mut phi = a * u * (1u64 << (levels.len() - 1)) as f64;
    for &(a, c) in levels[1..].iter().rev() {
        phi = (phi + (c / a * phi.sin()).asin()) / 2.0;
    }
    let (sn, cn) = (phi.sin(), phi.cos());
    [sn, cn, (1.0 - m * sn * sn).sqrt()]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()))
}

/// Integrator and its memory memory, started.
fn started<R: Real>(relative: R, absolute: R, t: R, y: &[R]) -> (Adams<R>, Vec<R>) {
    let mut adams = Adams::new(relative, absolute, None).unwrap();
    let mut memory = vec![R::zero(); Adams::<R>::memory_len(y.len()).unwrap()];
    adams.start(t, y, &mut memory).unwrap();
    (adams, memory)
}

/// Steps until `t_stop` is reached.
fn run<R: Real, S: System<R>>(adams: &mut Adams<R>, system: &mut S, t_stop: R, memory: &mut [R]) -> Result<()> {
    while adams.time() != t_stop {
        adams.step(system, t_stop, memory)?;
    }
    Ok(())
}
