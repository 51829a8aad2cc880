//! The paper's example 9.2 to t = 10: error against time for nekton, for the paper's scheme in nekton, and for the paper's
//! algorithm in Octave (`matlab/reference`).

use crate::timing::{Measured, median, thread_seconds};
use nekton::scene::{ForceFormula, Quadrature, Scene};
use nekton_tests::{adams, paper_ellipse, simulation, two_ellipses};
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

const END: f64 = 10.0;
/// Error that runs are compared at: the largest of any position (m) or angle (rad) at the end.
const WANTED: f64 = 1e-9;

/// How a run is made.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scheme {
    /// Graded quadrature, exact gradient.
    Nekton,
    /// Plain trapezoidal rule, boundary formula (2.15).
    Plain,
    /// The paper's algorithm in Octave.
    Octave,
}

impl Scheme {
    /// As tables have it.
    pub fn name(self) -> &'static str {
        match self {
            Scheme::Nekton => "nekton",
            Scheme::Plain => "plain",
            Scheme::Octave => "octave",
        }
    }

    /// Nodes per body and tolerances that are tried.
    fn tried(self) -> (&'static [usize], &'static [f64]) {
        match self {
            Scheme::Nekton => (&[16, 20, 24, 28, 32, 40], &[1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 3e-11, 1e-11, 1e-12]),
            Scheme::Plain => (&[64, 96, 128, 160], &[1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11]),
            Scheme::Octave => (&[64, 96, 128], &[1e-7, 1e-9, 1e-11]),
        }
    }
}

/// A run: its setting, its error, what it took.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// How.
    pub scheme: Scheme,
    /// Nodes per body.
    pub nodes: usize,
    /// Of the integrator, relative and absolute.
    pub tolerance: f64,
    /// At the end.
    pub error: f64,
    /// Processor time.
    pub seconds: f64,
    /// Of the right-hand side.
    pub evaluations: u64,
}

impl Point {
    /// Columns of [`Point::line`].
    pub const HEAD: &'static str = "scheme,nodes,tolerance,error,seconds,evaluations";

    /// A line of a table.
    pub fn line(&self) -> String {
        let Point { nodes, tolerance, error, seconds, evaluations, .. } = self;
        format!("{},{nodes},{tolerance:e},{error:.2e},{seconds:.4e},{evaluations}", self.scheme.name())
    }
}

/// Final positions, seconds, evaluations.
type End = (Vec<f64>, f64, u64);

fn run(scheme: Scheme, nodes: usize, tolerance: f64) -> Result<End, String> {
    if scheme == Scheme::Octave {
        return in_octave(nodes, tolerance);
    }
    let links = paper_ellipse(nodes);
    let bodies = two_ellipses(&links);
    let (quadrature, force) = match scheme {
        Scheme::Plain => (Quadrature::Plain, ForceFormula::Boundary),
        _ => (Quadrature::Graded, ForceFormula::ExactGradient),
    };
    let scene = Scene { bodies: &bodies, quadrature, force, ..Scene::new(1.0, 0.0) };
    let mut sim = simulation(&scene, adams(tolerance));
    let mut sim = sim.view();
    let start = thread_seconds();
    sim.advance(END).map_err(|error| error.to_string())?;
    let seconds = thread_seconds() - start;
    Ok((sim.positions().to_vec(), seconds, sim.counters().evaluations))
}

/// One thread, processor time, set-up and Octave's own start not counted.
fn in_octave(nodes: usize, tolerance: f64) -> Result<End, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../matlab/reference");
    let mut octave = Command::new("octave-cli");
    octave.args(["--norc", "--no-history", "--quiet", "--eval"]);
    // Cut off, it would leave a file.
    octave
        .arg(format!("sigterm_dumps_octave_core(false); addpath('..'); reference_run({nodes}, {tolerance:e}, {END})"));
    let output = octave.env("OPENBLAS_NUM_THREADS", "1").env("OMP_NUM_THREADS", "1").current_dir(folder).output();
    let output = output.map_err(|error| format!("octave-cli: {error}; Debian: apt-get install octave"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    match numbers.as_deref() {
        Some([seconds, evaluations, end @ ..]) if end.len() == 6 => Ok((end.to_vec(), *seconds, *evaluations as u64)),
        _ => Err(format!("octave-cli: {text}{}", String::from_utf8_lossy(&output.stderr))),
    }
}

fn reference() -> &'static Result<Vec<f64>, String> {
    static END: OnceLock<Result<Vec<f64>, String>> = OnceLock::new();
    END.get_or_init(|| run(Scheme::Nekton, 96, 1e-13).map(|(end, ..)| end))
}

fn point(scheme: Scheme, nodes: usize, tolerance: f64) -> Result<Point, String> {
    let exact = reference().as_ref()?;
    let (end, seconds, evaluations) = run(scheme, nodes, tolerance)?;
    let error = end.iter().zip(exact).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
    Ok(Point { scheme, nodes, tolerance, error, seconds, evaluations })
}

/// All runs of a scheme that pay: for each number of nodes ever tighter tolerances, as long as that lowers the error.
pub fn points(scheme: Scheme) -> &'static Result<Vec<Point>, String> {
    static ALL: [OnceLock<Result<Vec<Point>, String>>; 3] = [const { OnceLock::new() }; 3];
    ALL[scheme as usize].get_or_init(|| {
        let (counts, tolerances) = scheme.tried();
        let mut all: Vec<Point> = Vec::new();
        for nodes in counts {
            let (mut best, mut idle) = (f64::INFINITY, 0);
            for tolerance in tolerances {
                let point = point(scheme, *nodes, *tolerance)?;
                eprintln!("  {}", point.line());
                all.push(point);
                // Once may be chance.
                idle = if point.error > 0.7 * best { idle + 1 } else { 0 };
                best = best.min(point.error);
                if idle == 2 {
                    break;
                }
            }
        }
        Ok(all)
    })
}

/// The fastest run of a scheme with an error of at most `error`.
fn fastest(scheme: Scheme, error: f64) -> Result<Point, String> {
    let within = points(scheme).as_ref()?.iter().filter(|point| point.error <= error);
    within
        .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
        .copied()
        .ok_or_else(|| format!("{}: an error of {error:.0e} is not reached", scheme.name()))
}

/// Two settings in turns: medians of their times and of the ratio.
fn in_turns(one: Point, other: Point, rounds: usize) -> Result<Measured, String> {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..rounds {
        for (point, times) in [one, other].iter().zip(&mut times) {
            times.push(run(point.scheme, point.nodes, point.tolerance)?.1);
        }
    }
    let ratio = median(times[0].iter().zip(&times[1]).map(|(a, b)| a / b).collect());
    let [time, by] = times.map(median);
    let note = format!(
        "{} and {} nodes per body; errors {:.0e} and {:.0e}; {} and {} evaluations",
        one.nodes, other.nodes, one.error, other.error, one.evaluations, other.evaluations
    );
    Ok(Measured { time, by, ratio, note })
}

fn told(point: &Point) -> String {
    format!("{} nodes per body; error {:.0e}; {} evaluations", point.nodes, point.error, point.evaluations)
}

/// The whole run.
pub fn whole() -> Result<Measured, String> {
    let best = fastest(Scheme::Nekton, WANTED)?;
    let times: Result<Vec<f64>, String> = (0..9).map(|_| Ok(run(best.scheme, best.nodes, best.tolerance)?.1)).collect();
    Ok(Measured::seconds(median(times?), told(&best)))
}

/// Evaluations of the same run.
pub fn evaluations() -> Result<Measured, String> {
    let best = fastest(Scheme::Nekton, WANTED)?;
    Ok(Measured { time: best.seconds, by: f64::NAN, ratio: best.evaluations as f64, note: told(&best) })
}

/// The paper's scheme in nekton.
pub fn against_plain() -> Result<Measured, String> {
    in_turns(fastest(Scheme::Nekton, WANTED)?, fastest(Scheme::Plain, WANTED)?, 5)
}

/// The paper's algorithm in Octave, at 1e-9 or, if it does not reach that, at about the best that it reaches. nekton's error
/// is not larger.
pub fn against_octave() -> Result<Measured, String> {
    let best = points(Scheme::Octave).as_ref()?.iter().fold(f64::INFINITY, |m, point| m.min(point.error));
    let other = fastest(Scheme::Octave, WANTED.max(1.5 * best))?;
    in_turns(fastest(Scheme::Nekton, other.error)?, other, 3)
}
