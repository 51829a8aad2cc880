//! The converged trajectory that errors are measured against, how good it is itself, and how far it can be trusted.

use std::time::Duration;

use nekton::scene::{ForceFormula, Quadrature};
use nekton::status::Error;

use super::measure::{Bench, Ended, OUTPUTS, Path};
use super::setting::Setting;
use crate::scene_file::Integrator;

/// Nodes with which the search for the reference begins, if the scene has more.
const FIRST: usize = 32;
/// Two trajectories that agree so far are converged, whatever is asked.
const AGREED: f64 = 1e-11;
const ROUNDS: usize = 8;
/// Tightest tolerance.
const TOLERANCE: f64 = 1e-12;
/// A start moved by this fraction of the largest link …
const SHIFT: f64 = 1e-7;
/// … may move the end by this many times as much. Beyond, errors tell about the scene and not about the method.
const GROWTH: f64 = 1e3;
/// The reference may take so many times as long as a run.
const PATIENCE: u32 = 20;

/// A horizon shorter than this part of what was wanted shows nothing.
const SHORTEST: f64 = 1e-4;

/// Why there is no reference.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// The scene cannot be run.
    Core(Error),
    /// The limit allows no reference, not even a short one.
    TooSlow,
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Refusal::Core(error)
    }
}

/// A reference trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Simulated time.
    pub until: f64,
    /// Nodes of the link that has most.
    pub nodes: usize,
    /// Difference from the trajectory with 2/3 of the nodes and twice the tolerance, relative to `travel`.
    pub error: f64,
    /// Length to which errors are relative.
    pub travel: f64,
    /// Positions and headings.
    pub path: Path,
}

fn setting(nodes: usize, tolerance: f64) -> Setting {
    Setting {
        quadrature: Quadrature::Graded,
        force: ForceFormula::ExactGradient,
        single: false,
        integrator: Integrator::adams(tolerance),
        nodes,
    }
}

/// The time until which trajectories can be compared: until the scene ends (by contact, say), or until it has magnified a
/// change of its start a thousand times.
pub fn horizon(bench: &Bench<'_>, wanted: f64, limit: Duration) -> Result<f64, Refusal> {
    let usual = setting(bench.nodes.min(FIRST), 1e-8);
    let shift = SHIFT * bench.size();
    let mut until = wanted;
    loop {
        let (a, b) = (bench.once(&usual, until, limit, 0.0), bench.once(&usual, until, limit, shift));
        let whole = a.path.len().min(b.path.len()).saturating_sub(1);
        if let (0, Ended::Failed(e)) = (whole, a.ended) {
            return Err(e.into());
        }
        let calm = bench.distances(&a.path, &b.path).take_while(|d| *d <= GROWTH * shift).count().saturating_sub(1);
        let good = calm.min(whole);
        if good == OUTPUTS {
            return Ok(until);
        }
        until *= good.max(1) as f64 / OUTPUTS as f64;
        if until < SHORTEST * wanted {
            return Err(Refusal::TooSlow);
        }
    }
}

/// Raises the nodes until two trajectories agree twenty times better than `goal`, the least error to be told. A horizon that
/// makes this too slow is shortened.
pub fn reference(
    bench: &Bench<'_>,
    wanted: f64,
    limit: Duration,
    goal: f64,
    mut tell: impl FnMut(&str),
) -> Result<Reference, Refusal> {
    tell("horizon");
    let (agreed, tolerance) = (AGREED.max(goal / 20.0), TOLERANCE.max(goal / 200.0));
    let mut until = horizon(bench, wanted, limit * PATIENCE)?;
    'shorter: loop {
        if until < SHORTEST * wanted {
            return Err(Refusal::TooSlow);
        }
        let mut nodes = bench.nodes.min(FIRST);
        let mut before: Option<(Path, usize, f64)> = None;
        for round in 0..ROUNDS {
            tell(&format!("reference: {nodes} nodes to t = {until:.4}"));
            let run = bench.once(&setting(nodes, tolerance * (2 - round % 2) as f64), until, limit * PATIENCE, 0.0);
            match (run.ended, &before) {
                (Ended::Failed(e), None) => return Err(e.into()),
                (Ended::Limit, None) => {
                    // Later rounds take more: half of what this one reached.
                    until *= (0.5 * (run.path.len() - 1) as f64 / OUTPUTS as f64).max(0.5 / OUTPUTS as f64);
                    continue 'shorter;
                }
                // Nothing better can be had: what there is says itself how good it is.
                (Ended::Failed(_) | Ended::Limit, Some((path, nodes, error))) if error.is_finite() => {
                    return Ok(found(bench, until, *nodes, *error, path.clone()));
                }
                (Ended::Failed(_) | Ended::Limit, Some(_)) => {
                    until *= 0.5;
                    continue 'shorter;
                }
                (Ended::Done, None) => before = Some((run.path, nodes, f64::INFINITY)),
                (Ended::Done, Some((path, last, error))) => {
                    let now = bench.distance(path, &run.path) / bench.travel(&run.path);
                    if now > 0.5 * error && *error < 1e-6 {
                        return Ok(found(bench, until, *last, *error, path.clone()));
                    }
                    if now < agreed || round + 1 == ROUNDS || !bench.plan.fluid {
                        return Ok(found(bench, until, nodes, now, run.path));
                    }
                    before = Some((run.path, nodes, now));
                }
            }
            nodes = super::setting::scaled(nodes, 1.5);
        }
    }
}

fn found(bench: &Bench<'_>, until: f64, nodes: usize, error: f64, path: Path) -> Reference {
    Reference { until, nodes, error, travel: bench.travel(&path), path }
}
