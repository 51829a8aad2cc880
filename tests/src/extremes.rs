//! Runs at the edges of what a scene may say, measured against finer runs, in both precisions: the tables of docs/accuracy.

use crate::{adams, body, link, wall};
use nekton::scalar::Real;
use nekton::scene::{Body, Link, Repulsion, Scene, Shape};
use nekton::status::Error;
use nekton::{Method, ModelBuf, Sim, SimBuf};
use std::fmt::Write;
use std::sync::Arc;

/// An elliptic body.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    /// Half-axes, m.
    pub axes: [f64; 2],
    /// Density, kg/m³.
    pub density: f64,
    /// Circulation, m²/s.
    pub circulation: f64,
    /// Centre and heading.
    pub pose: [f64; 3],
    /// Their rates.
    pub velocity: [f64; 3],
}

/// A scene of ellipses, and how long it runs.
#[derive(Clone, Debug)]
pub struct Case {
    /// Density of the fluid.
    pub fluid: f64,
    /// Gravity.
    pub gravity: f64,
    /// Exponent and strength of the repulsion.
    pub repulsion: Option<[f64; 2]>,
    /// Half-axes of the tank.
    pub tank: Option<[f64; 2]>,
    /// The bodies.
    pub bodies: Vec<Ellipse>,
    /// Nodes per boundary.
    pub nodes: usize,
    /// Size of a body, m: the unit of lengths in which errors are given.
    pub size: f64,
    /// Duration, s.
    pub duration: f64,
}

/// What a run came to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the status with which it ended.
    pub status: &'static str,
    /// Time reached.
    pub time: f64,
    /// Positions at the end; angles are multiplied by the size of a body.
    pub positions: Vec<f64>,
    /// Largest change of the total energy, relative to the largest kinetic or potential energy.
    pub energy_drift: f64,
    /// Largest error indicators of space: mass, force, quadrature, repulsion.
    pub space: [f64; 4],
    /// Sum of the estimated local errors of the positions, in sizes of a body and radians.
    pub time_error: f64,
    /// Evaluations.
    pub evaluations: u64,
    /// Time of the run, s, set-up and samples included.
    pub seconds: f64,
}

/// Samples of energy and indicators in a run.
const SAMPLES: u32 = 10;
/// Steps from one sample to the next: where space is not resolved, a tight tolerance would take any number.
const STEPS: u64 = 1000;

impl Case {
    /// The same with every length multiplied by `length` and every duration by `time`. Gravity, circulation and repulsion
    /// follow; densities stay.
    pub fn scaled(&self, length: f64, time: f64) -> Case {
        let speed = length / time;
        let bodies = self.bodies.iter().map(|b| Ellipse {
            axes: b.axes.map(|x| x * length),
            density: b.density,
            circulation: b.circulation * length * speed,
            pose: [b.pose[0] * length, b.pose[1] * length, b.pose[2]],
            velocity: [b.velocity[0] * speed, b.velocity[1] * speed, b.velocity[2] / time],
        });
        Case {
            gravity: self.gravity * speed / time,
            // ε L² |x|^−α is an energy, ρ L⁴ / T².
            repulsion: self.repulsion.map(|[alpha, e]| [alpha, e * length.powf(2.0 + alpha) / (time * time)]),
            tank: self.tank.map(|axes| axes.map(|x| x * length)),
            bodies: bodies.collect(),
            size: self.size * length,
            duration: self.duration * time,
            ..self.clone()
        }
    }

    /// Calls `f` with the scene in precision `R`.
    pub fn scene<R: Real, T>(&self, f: impl FnOnce(&Scene<'_, R>) -> T) -> T {
        let r = |x: f64| R::lit(x);
        let ellipse = |axes: [f64; 2]| Shape::Ellipse { a: r(axes[0]), b: r(axes[1]) };
        let one = |b: &Ellipse| -> [Link<'static, R>; 1] {
            [Link { circulation: r(b.circulation), ..link(ellipse(b.axes), r(b.density), self.nodes) }]
        };
        let links: Vec<_> = self.bodies.iter().map(one).collect();
        let bodies: Vec<Body<'_, R>> =
            self.bodies.iter().zip(&links).map(|(b, l)| body(l, b.pose.map(r), b.velocity.map(r))).collect();
        let zero = [R::zero(); 2];
        f(&Scene {
            tank: self.tank.map(|axes| wall(ellipse(axes), zero, R::zero(), self.nodes)),
            repulsion: self.repulsion.map(|[alpha, epsilon]| Repulsion { alpha: r(alpha), epsilon: r(epsilon) }),
            bodies: &bodies,
            // Whatever the bound says: it is a column of the tables.
            allow_unresolved: true,
            ..Scene::new(r(self.fluid), r(self.gravity))
        })
    }

    /// Runs to the end or to the first error.
    pub fn run<R: Real>(&self, method: Method<R>) -> Outcome {
        let clock = std::time::Instant::now();
        let made = self.scene(|scene| ModelBuf::<R>::new(scene)).and_then(|model| SimBuf::new(Arc::new(model), method));
        let mut out = Outcome {
            status: "Ok",
            time: 0.0,
            positions: Vec::new(),
            energy_drift: 0.0,
            space: [0.0; 4],
            time_error: 0.0,
            evaluations: 0,
            seconds: 0.0,
        };
        let ended = made.and_then(|mut sim| {
            let mut sim = sim.view();
            let ended = self.follow(&mut sim, &mut out);
            out.time = sim.time().to_f64();
            let unit = |(k, x): (usize, &R)| x.to_f64() * if k % 3 == 2 { self.size } else { 1.0 };
            out.positions = sim.positions().iter().enumerate().map(unit).collect();
            let estimate = sim.time_error();
            // Errors of the rates act for the rest of the run.
            let acting = |own: R, rate: R| own.to_f64() + self.duration * rate.to_f64();
            let length = acting(estimate.length_sum, estimate.speed_sum) / self.size;
            out.time_error = length.max(acting(estimate.angle_sum, estimate.spin_sum));
            out.evaluations = sim.counters().evaluations;
            ended
        });
        if let Err(error) = ended {
            out.status = error.status.name();
        }
        out.seconds = clock.elapsed().as_secs_f64();
        out
    }

    fn follow<R: Real>(&self, sim: &mut Sim<'_, R>, out: &mut Outcome) -> Result<(), Error> {
        let (mut first, mut drift, mut size) = (None, 0.0_f64, 0.0_f64);
        sim.set_step_limit(STEPS)?;
        for k in 0..=SAMPLES {
            sim.advance(R::lit(self.duration * f64::from(k) / f64::from(SAMPLES)))?;
            let e = sim.energy()?;
            let total = (e.total - e.work).to_f64();
            let start = *first.get_or_insert(total);
            drift = drift.max((total - start).abs());
            let kinetic = (e.kinetic_bodies + e.kinetic_fluid).to_f64();
            size = size.max(kinetic).max((e.total.to_f64() - kinetic - start).abs().min(kinetic.abs()));
            out.energy_drift = if size > 0.0 { drift / size } else { drift };
            let r = sim.resolution()?;
            for (most, now) in out.space.iter_mut().zip([r.mass, r.force, r.quadrature, r.repulsion]) {
                *most = most.max(now.to_f64());
            }
        }
        Ok(())
    }

    /// The variable-step method, with an absolute tolerance in units of this scene.
    pub fn adams<R: Real>(&self, tolerance: f64) -> Method<R> {
        let unit = self.size.min(self.size / self.duration).min(1.0).min(1.0 / self.duration);
        match adams::<R>(tolerance) {
            Method::Adams { relative, absolute, .. } => Method::adams(relative, absolute * R::lit(unit).max(R::TINY)),
            other => other,
        }
    }

    /// A run with twice the nodes and a tighter tolerance.
    pub fn reference(&self) -> Outcome {
        Case { nodes: 2 * self.nodes, ..self.clone() }.run::<f64>(self.adams(1e-13))
    }

    /// Rows of the table for this case, one for each precision.
    pub fn rows(&self, parameter: f64) -> [Row; 2] {
        let exact = self.reference();
        let row = |precision, outcome: Outcome| {
            let comparable = exact.status == "Ok" && outcome.status == "Ok";
            let error = if comparable { distance(&outcome.positions, &exact.positions) / self.size } else { f64::NAN };
            Row { parameter, precision, error, outcome }
        };
        [row("f64", self.run::<f64>(self.adams(1e-10))), row("f32", self.run::<f32>(self.adams(3e-6)))]
    }
}

/// Largest difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m: f64, (a, b)| if (a - b).abs() <= m { m } else { (a - b).abs() })
}

/// A line of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is varied.
    pub parameter: f64,
    /// f32 or f64.
    pub precision: &'static str,
    /// Largest error of positions and angles at the end, in sizes of a body and radians; NaN if it did not get there.
    pub error: f64,
    /// The run.
    pub outcome: Outcome,
}

impl Row {
    /// What the indicators say that the error may be.
    pub fn indicated(&self) -> f64 {
        self.outcome.space.iter().fold(0.0, |m: f64, x| m.max(*x)) + self.outcome.time_error
    }
}

/// The columns after the first.
pub const COLUMNS: &str = "precision,status,time_reached_s,position_error_sizes,energy_drift_relative,indicator_mass,indicator_force,\
                           indicator_quadrature,indicator_repulsion,indicator_time_sizes,evaluations,seconds";

/// A table as CSV.
pub fn csv(parameter: &str, rows: &[Row]) -> String {
    let mut text = format!("{parameter},{COLUMNS}\n");
    for r in rows {
        let o = &r.outcome;
        let _ = writeln!(
            text,
            "{:e},{},{},{:.4e},{:.1e},{:.1e},{:.1e},{:.1e},{:.1e},{:.1e},{:.1e},{},{:.1e}",
            r.parameter,
            r.precision,
            o.status,
            o.time,
            r.error,
            o.energy_drift,
            o.space[0],
            o.space[1],
            o.space[2],
            o.space[3],
            o.time_error,
            o.evaluations,
            o.seconds
        );
    }
    text
}

fn two(fluid: f64, density: f64) -> Case {
    let one = |pose, velocity| Ellipse { axes: [1.0, 0.5], density, circulation: 0.0, pose, velocity };
    Case {
        fluid,
        gravity: 0.0,
        repulsion: None,
        tank: None,
        bodies: vec![one([-1.2, 0.6, 0.3], [0.5, 0.0, 0.2]), one([1.2, -0.6, -0.2], [-0.5, 0.1, 0.1])],
        nodes: 64,
        size: 1.0,
        duration: 1.0,
    }
}

/// Densities of the bodies, in units of the fluid's; infinity stands for a fluid without density.
pub fn density(ratio: f64) -> Case {
    if ratio.is_infinite() { two(0.0, 1.0) } else { two(1.0, ratio) }
}

/// Two ellipses with every term, all lengths multiplied, at the same speeds (`time` = `length`) or durations (`time` = 1).
pub fn scale(length: f64, time: f64) -> Case {
    let mut case = two(1.0, 1.25);
    case.gravity = 0.25;
    case.repulsion = Some([4.0, 0.0078125]);
    (case.bodies[0].circulation, case.bodies[1].circulation) = (0.5, -0.25);
    case.tank = Some([4.0, 3.5]);
    case.scaled(length, time)
}

/// `n` ellipses on a square grid, gaps of about 1.
pub fn bodies(n: usize) -> Case {
    let side = (n as f64).sqrt().ceil() as usize;
    let one = |k: usize| {
        let phase = k as f64 * 2.4;
        Ellipse {
            axes: [0.8, 0.5],
            density: 1.0 + 0.5 * phase.sin(),
            circulation: 0.0,
            pose: [2.5 * (k % side) as f64, 2.5 * (k / side) as f64, phase],
            velocity: [0.3 * phase.cos(), 0.3 * phase.sin(), 0.5 * (2.0 * phase).cos()],
        }
    };
    Case { bodies: (0..n).map(one).collect(), nodes: 16, duration: 0.2, ..two(1.0, 1.0) }
}

/// A disc of radius 1 in a disc tank whose radius is larger by `gap`, off its centre.
pub fn tank(gap: f64) -> Case {
    let disc = Ellipse {
        axes: [1.0, 1.0],
        density: 1.5,
        circulation: 0.0,
        pose: [0.3 * gap, 0.1 * gap, 0.0],
        velocity: [0.1 * gap, -0.2 * gap, 0.5],
    };
    Case { bodies: vec![disc], tank: Some([1.0 + gap, 1.0 + gap]), ..two(1.0, 1.0) }
}

/// Two ellipses flank to flank, `gap` apart, that slide past each other and approach a little.
pub fn gap(gap: f64) -> Case {
    let mut case = two(1.0, 1.25);
    for (b, side) in case.bodies.iter_mut().zip([-1.0, 1.0]) {
        b.pose = [0.0, side * 0.5 * (1.0 + gap), 0.0];
        b.velocity = [0.05 * side, -0.05 * gap * side, 0.0];
    }
    Case { nodes: 96, ..case }
}

/// Two ellipses of half-axes 1 and 1/`ratio`, side by side at a distance of 0.5.
pub fn aspect(ratio: f64) -> Case {
    let mut case = two(1.0, 1.25);
    for (b, side) in case.bodies.iter_mut().zip([-1.0, 1.0]) {
        b.axes = [1.0, 1.0 / ratio];
        b.pose = [0.2 * side, side * (0.25 + 1.0 / ratio), 0.1 * side];
        b.velocity = [0.2 * side, -0.05 * side, 0.1];
    }
    Case { nodes: 96, ..case }
}

/// Two ellipses with circulations ±γ, in units of speed times size; the run ends earlier when they turn faster.
pub fn circulation(gamma: f64) -> Case {
    let mut case = two(1.0, 1.25);
    (case.bodies[0].circulation, case.bodies[1].circulation) = (gamma, -0.5 * gamma);
    case.duration = f64::min(1.0, 5.0 / gamma);
    case
}

/// Two ellipses whose spin is `ratio` times their translation (in sizes).
pub fn spin(ratio: f64) -> Case {
    let mut case = two(1.0, 1.25);
    for (b, sign) in case.bodies.iter_mut().zip([1.0, -0.7]) {
        b.velocity = [b.velocity[0] / ratio, b.velocity[1] / ratio, sign];
        b.pose[0] *= 1.2;
    }
    case.duration = 6.0;
    case
}

/// Two discs that meet and are kept apart by a repulsion with exponent `alpha`.
pub fn repulsion(alpha: f64) -> Case {
    let mut case = two(1.0, 1.25);
    for (b, side) in case.bodies.iter_mut().zip([-1.0, 1.0]) {
        (b.axes, b.pose, b.velocity) = ([0.5, 0.5], [0.9 * side, -0.05 * side, 0.0], [-0.5 * side, 0.0, 0.3]);
    }
    // Strong enough to turn them before they touch.
    let epsilon = 0.3 * 0.5_f64.powf(alpha);
    (case.repulsion, case.duration, case.nodes) = (Some([alpha, epsilon]), 3.0, 96);
    case
}
