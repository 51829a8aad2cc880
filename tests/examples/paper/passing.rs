//! Figures 3 to 7: two ellipses pass each other (9.2). Errors of position, angle and velocities, and time, against nodes.

use super::panels::Panels;
use super::{Outcome, decimals, write};
use nekton::Method;
use nekton::integrate::{Adams, System};
use nekton::scene::{ForceFormula, Quadrature, Scene};
use nekton_cli::plots::colour;
use nekton_cli::plots::log::{Curve, Marks, chart};
use nekton_tests::{paper_ellipse, simulation, two_ellipses};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const END: f64 = 10.0;
const TIMES: usize = 10;
const TOLERANCE: f64 = 1e-12;

/// State (q, v) at every output time.
type States = Vec<Vec<f64>>;

struct Run {
    states: States,
    seconds: f64,
    evaluations: usize,
}

/// A row of the table: scheme, nodes per body, errors, time.
type Row = (Scheme, usize, [f64; 4], f64);

#[derive(Clone, Copy, PartialEq)]
enum Scheme {
    Ours,
    Paper,
    Panels,
}

const SCHEMES: [(Scheme, &str, &str); 3] = [
    (Scheme::Panels, "panels", "constant panels"),
    (Scheme::Paper, "paper", "paper: trapezoid, (2.15)"),
    (Scheme::Ours, "nekton", "nekton"),
];

/// Runs a scheme with `n` nodes per body.
fn run(scheme: Scheme, n: usize, tolerance: f64) -> nekton::Result<Run> {
    if scheme == Scheme::Panels {
        return panels(n, tolerance);
    }
    let links = paper_ellipse::<f64>(n);
    let bodies = two_ellipses(&links);
    let (force, quadrature) = match scheme {
        Scheme::Ours => (ForceFormula::ExactGradient, Quadrature::Graded),
        _ => (ForceFormula::Boundary, Quadrature::Plain),
    };
    let scene = Scene { force, quadrature, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let mut sim = simulation(&scene, Method::adams(tolerance, tolerance));
    let mut sim = sim.view();
    let clock = Instant::now();
    let mut states = Vec::new();
    for k in 1..=TIMES {
        sim.advance_dense(END * k as f64 / TIMES as f64, END)?;
        states.push(sim.positions().iter().chain(sim.velocities()).copied().collect());
    }
    Ok(Run { states, seconds: clock.elapsed().as_secs_f64(), evaluations: sim.counters().evaluations as usize })
}

fn panels(n: usize, tolerance: f64) -> nekton::Result<Run> {
    let mut system = Panels::new(2.0, 0.9, n, 2);
    let y = [2.0, -1.1, 0.0, -2.0, 1.1, 0.0, -0.5, 0.0, 0.0, 0.5, 0.0, 0.0];
    let mut memory = vec![0.0; Adams::<f64>::memory_len(system.dim()).unwrap_or(0)];
    let mut adams = Adams::new(tolerance, tolerance, None)?;
    adams.start(0.0, &y, &mut memory)?;
    let clock = Instant::now();
    let mut states = Vec::new();
    for k in 1..=TIMES {
        let t = END * k as f64 / TIMES as f64;
        while adams.time() < t {
            adams.step(&mut system, END, &mut memory)?;
        }
        let (mut y, mut rate) = (vec![0.0; 12], vec![0.0; 12]);
        adams.interpolate(t, &memory, &mut y, &mut rate)?;
        states.push(y);
    }
    Ok(Run { states, seconds: clock.elapsed().as_secs_f64(), evaluations: system.evaluations })
}

/// Largest errors of position, angle, velocity and angular velocity.
fn errors(states: &States, exact: &States) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for (a, b) in states.iter().zip(exact) {
        // Positions of both bodies come first, then their velocities.
        let d: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        for (k, part) in d.chunks_exact(3).enumerate() {
            let velocity = 2 * usize::from(k >= 2);
            worst[velocity] = worst[velocity].max(part[0].hypot(part[1]));
            worst[velocity + 1] = worst[velocity + 1].max(part[2].abs());
        }
    }
    worst
}

/// Slope of log y against log x, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(a, b), p| (a + p.0.ln() / n, b + p.1.ln() / n));
    let (num, den) = points.iter().fold((0.0, 0.0), |(a, b), p| {
        let (x, y) = (p.0.ln() - mx, p.1.ln() - my);
        (a + x * y, b + x * x)
    });
    num / den
}

/// Makes the figures and their data.
pub fn figures(folder: &Path, quick: bool) -> Outcome {
    let best = [96, 128];
    let exact = run(Scheme::Ours, best[1], 1e-13)?;
    let own = errors(&run(Scheme::Ours, best[0], 2e-13)?.states, &exact.states);
    println!("reference: {} nodes; differs from {} nodes by {:.1e}", best[1], best[0], own[0].max(own[1]));
    let counts: &[usize] = if quick { &[16, 24, 32] } else { &[8, 12, 16, 20, 24, 28, 32, 40, 48, 64, 96, 128, 192] };
    let mut table = String::from("scheme,nodes,position,angle,velocity,angular_velocity,seconds,evaluations\n");
    let mut rows: Vec<Row> = Vec::new();
    for (scheme, name, _) in SCHEMES {
        // nekton has long converged by then.
        let most = if scheme == Scheme::Ours { 128 } else { usize::MAX };
        for n in counts.iter().filter(|n| **n <= most) {
            let (errors, seconds, evaluations) = match run(scheme, *n, TOLERANCE) {
                Ok(done) => (errors(&done.states, &exact.states), done.seconds, done.evaluations),
                Err(error) => {
                    println!("{name}, {n} nodes: {error}");
                    continue;
                }
            };
            println!("{name:<8} {n:>4} nodes: {errors:?}, {seconds:.3} s, {evaluations} evaluations");
            let [a, b, c, d] = errors.map(decimals);
            writeln!(table, "{name},{n},{a},{b},{c},{d},{},{evaluations}", decimals(seconds))?;
            rows.push((scheme, *n, errors, seconds));
        }
    }
    write(folder, "passing.csv", &table)?;
    let curves = |value: &dyn Fn(&Row) -> f64| -> Vec<Curve> {
        let curve = |(k, (scheme, _, title)): (usize, &(Scheme, &str, &str))| Curve {
            name: (*title).to_owned(),
            points: rows.iter().filter(|r| r.0 == *scheme).map(|r| (r.1 as f64, value(r))).collect(),
            colour: colour([1, 2, 0][k]),
            marks: Marks::DottedLine,
        };
        SCHEMES.iter().enumerate().map(curve).collect()
    };
    let names = [
        ("figure3.svg", "Figure 3: position", "largest error of position (m)"),
        ("figure4.svg", "Figure 4: angle", "largest error of angle (rad)"),
        ("figure5.svg", "Figure 5: velocity", "largest error of velocity (m/s)"),
        ("figure6.svg", "Figure 6: angular velocity", "largest error of angular velocity (rad/s)"),
    ];
    for (k, (file, title, axis)) in names.into_iter().enumerate() {
        let title = format!("{title}, two ellipses passing, to t = 10 s");
        write(folder, file, &chart(&title, "nodes per body", axis, &curves(&|r| r.2[k]))?)?;
    }
    let mut times = curves(&|r| r.3);
    for curve in &mut times {
        let from = curve.points.len().saturating_sub(if quick { 3 } else { 5 });
        let exponent = slope(&curve.points[from..]);
        println!("{}: time grows as nodes^{exponent:.2}", curve.name);
        let short = curve.name.split(':').next().unwrap_or_default().trim_start_matches("constant ");
        curve.name = format!("{short}, exponent {exponent:.1}");
    }
    let title = "Figure 7: time to t = 10 s, two ellipses passing";
    write(folder, "figure7.svg", &chart(title, "nodes per body", "time (s)", &times)?)?;
    let reached: Vec<Curve> = SCHEMES
        .iter()
        .enumerate()
        .map(|(k, (scheme, _, title))| Curve {
            name: (*title).to_owned(),
            points: rows.iter().filter(|r| r.0 == *scheme).map(|r| (r.3, r.2[0])).collect(),
            colour: colour([1, 2, 0][k]),
            marks: Marks::DottedLine,
        })
        .collect();
    let title = "Error against time, two ellipses passing, to t = 10 s";
    write(folder, "passing_time.svg", &chart(title, "time (s)", "largest error of position (m)", &reached)?)
}
