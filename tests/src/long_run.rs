//! Motions that go on for ever, and steps of every length: the tables of docs/accuracy about time.

use crate::{body, disc, hinged, link, simulation, wall};
use nekton::scalar::Real;
use nekton::scene::{Drive, Link, Quadrature, Scene, Shape, Signal};
use nekton::status::Result;
use nekton::{Method, Sim, SimBuf};
use std::fmt::Write;

/// Period of the disc of [`circling_disc`], s.
pub const PERIOD: f64 = 1.0;

/// A disc with circulation alone in the fluid: it runs on a circle (docs/physics.md, section 10) of radius 1/(2π) m.
pub fn circling_disc<R: Real>(method: Method<R>) -> SimBuf<R> {
    // ω = ργ/(m + ρπa²) with a = ρ = 1, m = π.
    let tau = std::f64::consts::TAU;
    let links = [Link { circulation: R::lit(tau * tau / PERIOD), ..link(disc(R::one()), R::one(), 16) }];
    let bodies = [body(&links, [R::zero(); 3], [R::one(), R::zero(), R::zero()])];
    simulation(&Scene { bodies: &bodies, ..Scene::new(R::one(), R::zero()) }, method)
}

/// Distance of that disc from where it should be at time `t`.
pub fn circle_error(positions: &[f64], t: f64) -> f64 {
    let omega = std::f64::consts::TAU / PERIOD;
    // The force ργ (−ẏ, ẋ)… turns the velocity; its sense is the sign of y.
    let (x, y) = ((omega * t).sin() / omega, (1.0 - (omega * t).cos()) / omega);
    f64::hypot(positions[0] - x, positions[1].abs() - y)
}

/// An ellipse that tumbles alone in the fluid.
fn tumbling_ellipse<R: Real>(method: Method<R>) -> SimBuf<R> {
    let r = |x: f64| R::lit(x);
    let links = [link(Shape::Ellipse { a: r(1.0), b: r(0.5) }, r(1.0), 32)];
    let bodies = [body(&links, [r(0.0), r(0.0), r(0.4)], [r(1.0), r(0.0), r(0.3)])];
    simulation(&Scene { bodies: &bodies, ..Scene::new(r(1.0), r(0.0)) }, method)
}

/// Two links that a spring bends, alone in the fluid.
fn sprung_links<R: Real>(method: Method<R>) -> SimBuf<R> {
    let r = |x: f64| R::lit(x);
    // Few nodes: the energy of the discrete system is conserved whatever their number.
    let one = link(Shape::Ellipse { a: r(1.0), b: r(0.4) }, r(1.0), 8);
    let drive = Drive::Torque {
        torque: Signal::Constant(r(0.0)),
        stiffness: r(4.0),
        damping: r(0.0),
        rest: r(0.0),
        start: [r(0.6), r(0.0)],
    };
    let links = [one, hinged(one, 0, [r(-1.3), r(0.0)], [r(1.3), r(0.0)], drive)];
    let bodies = [body(&links, [r(0.0); 3], [r(0.2), r(0.1), r(0.05)])];
    simulation(&Scene { bodies: &bodies, quadrature: Quadrature::Plain, ..Scene::new(r(1.0), r(0.0)) }, method)
}

/// A disc with circulation that circles in a tank; few nodes here, too.
fn disc_in_tank<R: Real>(method: Method<R>) -> SimBuf<R> {
    let r = |x: f64| R::lit(x);
    let links = [Link { circulation: r(3.0), ..link(disc(r(0.5)), r(1.5), 8) }];
    let bodies = [body(&links, [r(0.8), r(0.0), r(0.0)], [r(0.0), r(0.3), r(0.2)])];
    let tank = Some(wall(Shape::Ellipse { a: r(3.0), b: r(2.5) }, [r(0.0); 2], r(0.0), 12));
    simulation(&Scene { tank, bodies: &bodies, quadrature: Quadrature::Plain, ..Scene::new(r(1.0), r(0.0)) }, method)
}

/// A motion, its step, s, and whether its impulse is conserved.
pub struct Motion<R> {
    /// Name in the table.
    pub name: &'static str,
    /// Makes it.
    pub make: fn(Method<R>) -> SimBuf<R>,
    /// Step, s: about a fortieth of the shortest period.
    pub step: f64,
    /// Does nothing hold it?
    pub free: bool,
}

/// Steps of a complete table.
const STEPS: u64 = 1_000_000;
/// Seconds that a run may take: it does not go on to the next power of ten if that will take longer.
const LIMIT: f64 = 1800.0;

/// The motions of the table.
pub fn motions<R: Real>() -> [Motion<R>; 4] {
    [
        Motion { name: "circling_disc", make: circling_disc, step: 0.0271, free: true },
        Motion { name: "tumbling_ellipse", make: tumbling_ellipse, step: 0.1, free: true },
        Motion { name: "sprung_links", make: sprung_links, step: 0.1, free: true },
        Motion { name: "disc_in_tank", make: disc_in_tank, step: 0.1, free: false },
    ]
}

/// The methods of the table, by name.
pub fn methods<R: Real>(step: f64) -> [(&'static str, Method<R>); 4] {
    let h = R::lit(step);
    let tolerance = R::lit(1e-9).max(R::lit(8.0) * R::EPSILON);
    [
        ("rk4", Method::Rk4 { step: h }),
        ("abm4", Method::Abm4 { step: h }),
        ("adams", Method::adams(tolerance, tolerance)),
        ("gauss6", Method::Gauss6 { step: h }),
    ]
}

/// Changes of energy and impulse, relative to their size, at a number of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Steps made.
    pub steps: u64,
    /// Of the energy: mean of 64 samples, less that of the first 64.
    pub energy: f64,
    /// Largest of the impulse; NaN where it is not conserved.
    pub impulse: f64,
}

/// Samples that a mean is taken of, and steps between them: the energy's error oscillates, and is to be averaged out.
const SAMPLES: u64 = 64;
const STRIDE: u64 = 7;

/// Follows a motion, and tells how far energy and impulse have drifted at every power of ten, and how it ended: with which
/// status and after how many steps.
pub fn drifts<R: Real>(motion: &Motion<R>, method: Method<R>, steps: u64) -> (Vec<Drift>, (&'static str, u64)) {
    let mut out = Vec::new();
    let mut sim = (motion.make)(method);
    let mut sim = sim.view();
    let ended = follow(motion, &mut sim, steps, &mut out);
    (out, (ended.map_or_else(|error| error.status.name(), |()| "Ok"), sim.counters().steps))
}

fn follow<R: Real>(motion: &Motion<R>, sim: &mut Sim<'_, R>, steps: u64, out: &mut Vec<Drift>) -> Result<()> {
    let start = sim.impulse()?;
    let size = start.iter().fold(0.0, |m: f64, p| m.max(p.to_f64().abs()));
    let (mut made, mut first, clock) = (0, None, std::time::Instant::now());
    let mut next = SAMPLES * STRIDE;
    while next <= steps {
        while made + SAMPLES * STRIDE < next {
            sim.step()?;
            made += 1;
        }
        let (mut mean, mut kinetic) = (0.0, 0.0_f64);
        for _ in 0..SAMPLES {
            for _ in 0..STRIDE {
                sim.step()?;
                made += 1;
            }
            let e = sim.energy()?;
            mean += (e.total - e.work).to_f64() / SAMPLES as f64;
            kinetic = kinetic.max((e.kinetic_bodies + e.kinetic_fluid).to_f64());
        }
        let (zero, unit) = *first.get_or_insert((mean, kinetic));
        let impulse = if motion.free { impulse_change(sim, &start)? / size } else { f64::NAN };
        out.push(Drift { steps: made, energy: (mean - zero) / unit, impulse });
        next = if next < 1000 { 1000 } else { 10 * next };
        if clock.elapsed().as_secs_f64() * next as f64 / made as f64 > LIMIT {
            break;
        }
    }
    Ok(())
}

fn impulse_change<R: Real>(sim: &mut Sim<'_, R>, start: &[R; 3]) -> Result<f64> {
    let now = sim.impulse()?;
    Ok(now.iter().zip(start).fold(0.0, |m: f64, (a, b)| m.max((a.to_f64() - b.to_f64()).abs())))
}

/// The table of drifts, of which runs whose motion, method and precision are named (or all) are made anew, and the others are those
/// of the table `old`; `part_done` is called with what there is after each run.
pub fn drift_table(old: &str, only: [Option<&str>; 3], part_done: &mut dyn FnMut(&str)) -> String {
    fn part<R: Real>(
        rows: &mut [(String, String)],
        precision: &str,
        only: [Option<&str>; 3],
        done: &mut dyn FnMut(&str),
    ) {
        for motion in motions::<R>() {
            for (name, method) in methods::<R>(motion.step) {
                let names = [motion.name, name, precision];
                if names.iter().zip(only).any(|(name, only)| only.is_some_and(|o| o != *name)) {
                    continue;
                }
                let (key, clock) = (names.join(",") + ",", std::time::Instant::now());
                let (drifts, (status, made)) = drifts(&motion, method, STEPS);
                let mut text = String::new();
                for d in drifts {
                    let _ = writeln!(text, "{key}{},{},Ok,{:.1e},{:.1e}", motion.step, d.steps, d.energy, d.impulse);
                }
                if status != "Ok" {
                    let _ = writeln!(text, "{key}{},{made},{status},NaN,NaN", motion.step);
                }
                println!("{key} {status}, {made} steps: {:.0} s", clock.elapsed().as_secs_f64());
                rows.iter_mut().filter(|r| r.0 == key).for_each(|r| r.1.clone_from(&text));
                done(&table(rows));
            }
        }
    }
    fn table(rows: &[(String, String)]) -> String {
        let head = "motion,method,precision,step_s,steps,status,energy_drift_relative,impulse_drift_relative\n";
        rows.iter().fold(head.into(), |text, row| text + &row.1)
    }
    let mut rows = Vec::new();
    for precision in ["f64", "f32"] {
        for motion in motions::<f64>() {
            for (name, _) in methods::<f64>(motion.step) {
                let key = format!("{},{name},{precision},", motion.name);
                let lines = old.lines().filter(|l| l.starts_with(&key)).map(|l| format!("{l}\n")).collect();
                rows.push((key, lines));
            }
        }
    }
    part::<f64>(&mut rows, "f64", only, part_done);
    part::<f32>(&mut rows, "f32", only, part_done);
    table(&rows)
}

/// What one step length comes to on the circling disc.
#[derive(Clone, Copy, Debug)]
pub struct StepOutcome {
    /// Name of the status with which it ended, or of what was noticed on the way.
    pub status: &'static str,
    /// Steps made.
    pub steps: u64,
    /// Largest distance from the circle, m, at the end of each tenth.
    pub error: f64,
    /// Sum of the estimated errors, brought to the end; NaN if there is none.
    pub estimate: f64,
    /// Steps without estimate.
    pub unknown: u64,
}

/// Runs `steps` steps.
pub fn circle<R: Real>(method: Method<R>, step: f64, steps: u64) -> StepOutcome {
    let mut sim = circling_disc(method);
    let mut sim = sim.view();
    let (mut status, mut error) = ("Ok", 0.0_f64);
    for k in 1..=steps {
        if let Err(e) = sim.step() {
            status = e.status.name();
            break;
        }
        if let Some((_, notice)) = sim.notice() {
            status = notice.status.name();
        }
        if k % (steps / 10).max(1) == 0 {
            let q: Vec<f64> = sim.positions().iter().map(|x| x.to_f64()).collect();
            error = error.max(circle_error(&q, step * k as f64));
        }
    }
    let e = sim.time_error();
    let estimate = if e.length.is_nan() {
        f64::NAN
    } else {
        e.length_sum.to_f64() + e.speed_sum.to_f64() * f64::min(step * steps as f64, PERIOD)
    };
    StepOutcome { status, steps: sim.counters().steps, error, estimate, unknown: e.unknown }
}

/// Rows of the table of step lengths.
pub fn step_table(text: &mut String, most: u64) {
    fn part<R: Real>(text: &mut String, precision: &str, most: u64) {
        for share in [1e-8, 1e-6, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5] {
            let step = share * PERIOD;
            let steps = ((2.0 * PERIOD / step).ceil() as u64).clamp(10, most);
            for (name, method) in methods::<R>(step).into_iter().filter(|m| m.0 != "adams") {
                let o = circle(method, R::lit(step).to_f64(), steps);
                let _ = writeln!(
                    text,
                    "{share:e},{name},{precision},{},{},{:.1e},{:.1e},{}",
                    o.status, o.steps, o.error, o.estimate, o.unknown
                );
            }
        }
    }
    text.push_str(
        "step_by_period,method,precision,status,steps,position_error_m,indicator_time_m,steps_without_estimate\n",
    );
    part::<f64>(text, "f64", most);
    part::<f32>(text, "f32", most);
}
