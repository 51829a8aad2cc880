//! The converged trajectory that errors are measured against, how good it is itself, and how far it can be trusted.

use std::time::{Duration, Instant};

use nekton::scene::{ForceFormula, Quadrature};
use nekton::status::Error;

use super::drives::OUTPUTS;
use super::drives::strides;
use super::measure::{Bench, Ended, Path};
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
pub const PATIENCE: u32 = 20;

/// The second opinion halves its steps so many times at most …
const HALVINGS: u32 = 14;
/// … and differs from the reference once the last halving moved it by less than this part of the difference.
const SETTLED: f64 = 0.1;

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
    /// Difference from the trajectory with 2/3 of the nodes and a looser tolerance (by 5 to 20 times), relative to `travel`.
    pub error: f64,
    /// What the second opinion says of it.
    pub opinion: Opinion,
    /// Length to which errors are relative.
    pub travel: f64,
    /// Positions and headings.
    pub path: Path,
}

/// What a method that shares neither estimates nor choices of steps says of a reference; relative to `travel`. NaN: nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opinion {
    /// How far the two are apart: no error below this is certified.
    pub difference: f64,
    /// By how much the second moved when its steps were halved the last time, before extrapolation.
    pub own: f64,
}

impl Opinion {
    /// Nothing is known yet.
    pub const NONE: Opinion = Opinion { difference: f64::NAN, own: f64::NAN };

    /// Whether an error may be certified.
    pub fn certifies(&self, error: f64) -> bool {
        self.difference <= error
    }

    /// Why an error is not certified, and what can be done.
    pub fn against(&self, error: f64) -> (String, &'static str) {
        let Opinion { difference, own } = self;
        if difference.is_nan() {
            let text = format!("an error of {error:e} cannot be certified: no second method arrived");
            return (text, "allow more time with --limit, or ask for less");
        }
        let text = format!(
            "an error of {error:e} cannot be certified: adams and gauss6 on steps that resolve the drives end {difference:.1e} of \
             the travel apart"
        );
        if *own <= SETTLED * difference {
            let way = "one of them is wrong: give adams a `max_step` in [run] integrator, or run with a fixed step, and compare";
            (format!("{text}, of which gauss6 accounts for {own:.1e}"), way)
        } else {
            (format!("{text}, and gauss6 is not exact enough itself"), "allow more time with --limit, or ask for less")
        }
    }
}

/// Asks the second method how far it is from a reference: the implicit one of order 6, on steps that the drives alone determine,
/// halved until the two are not farther apart than `goal`, or until that helps no more. Its nodes are those with which the
/// reference's error was found. `limit` is for the longest run; the path of a reference is all that is looked at.
pub fn second_opinion(bench: &Bench<'_>, reference: &Reference, goal: f64, limit: Duration) -> Opinion {
    let nodes = if bench.plan.fluid { super::setting::scaled(reference.nodes, 2.0 / 3.0) } else { reference.nodes };
    let strides = strides(bench.scene(), reference.until);
    let goal = goal.max(2.0 * reference.error);
    let mut opinion = Opinion::NONE;
    let mut before: Option<Path> = None;
    for halving in 0..HALVINGS {
        let clock = Instant::now();
        let path = match bench.stride(nodes, &strides, 1 << halving, limit) {
            Ok(Some(path)) => path,
            Ok(None) => break,
            // Steps that the motion does not bear are halved.
            Err(_) if 2 * clock.elapsed() <= limit => continue,
            Err(_) => break,
        };
        let best = before.as_ref().map_or_else(|| path.clone(), |before| extrapolated(before, &path));
        opinion.difference = bench.distance(&best, &reference.path) / reference.travel;
        if let Some(before) = &before {
            opinion.own = bench.distance(&path, before) / reference.travel;
        }
        before = Some(path);
        let settled = opinion.own <= SETTLED * opinion.difference;
        if opinion.difference <= goal || settled || 2 * clock.elapsed() > limit {
            break;
        }
    }
    opinion
}

/// What two paths of a method of order 6 tend to, the second with half the steps of the first.
fn extrapolated(coarse: &Path, fine: &Path) -> Path {
    let row = |(c, f): (&Vec<f64>, &Vec<f64>)| c.iter().zip(f).map(|(c, f)| f + (f - c) / 63.0).collect();
    coarse.iter().zip(fine).map(row).collect()
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

/// Raises the nodes, and with them the digits asked of a step, until two trajectories agree twenty times better than `goal`, the least
/// error to be told. A horizon that makes this too slow is shortened.
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
            // Never the same as the round before, also at the tightest.
            let tolerance = TOLERANCE.max(tolerance * 0.1_f64.powi(round as i32)) * (2 - round % 2) as f64;
            let run = bench.once(&setting(nodes, tolerance), until, limit * PATIENCE, 0.0);
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
    Reference { until, nodes, error, opinion: Opinion::NONE, travel: bench.travel(&path), path }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Opinion, reference, second_opinion};
    use crate::scene_file::SceneFile;
    use crate::trade::measure::Bench;

    /// Two links at rest until the hinge between them bends, long after.
    const LATE: &str = "[fluid]\ndensity = 1.0\n[[body]]\n[[body.link]]\nname = \"a\"\nshape = { ellipse = [1.0, 0.3] }\n\
        density = 1.0\nnodes = 24\n[[body.link]]\nname = \"b\"\nshape = { ellipse = [1.0, 0.3] }\ndensity = 1.0\nnodes = 24\n\
        parent = \"a\"\nhinge = { parent = [1.2, 0.0], self = [-1.2, 0.0] }\nmotion = { harmonic = [{ amplitude = 0.3, \
        frequency = 3.0 }], window = { from = 30.0, to = 33.0, ramp = 1.0 } }\n[run]\nduration = 34.0\n\
        integrator = { method = \"adams\", max_step = 0.5 }\n";

    #[test]
    fn a_second_method_certifies_a_right_reference_and_finds_out_a_wrong_one() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("late.toml");
        std::fs::write(&file, LATE).unwrap();
        let scene = SceneFile::open(&file).unwrap();
        scene.with_core(|core| {
            let bench = Bench::new(core, scene.run().unwrap().integrator).unwrap();
            let limit = Duration::from_secs(60);
            let right = reference(&bench, 34.0, limit, 1e-6, |_| ()).unwrap();
            let opinion = second_opinion(&bench, &right, 1e-7, limit);
            assert!(opinion.certifies(1e-6) && right.error < 1e-6, "{opinion:?} {}", right.error);
            // As if the drive had never been seen: everything stays where it is.
            let mut wrong = right.clone();
            wrong.path = vec![right.path[0].clone(); right.path.len()];
            let opinion = second_opinion(&bench, &wrong, 1e-7, limit);
            assert!(!opinion.certifies(0.1) && opinion.own < 0.1 * opinion.difference, "{opinion:?}");
            let (text, way) = opinion.against(1e-4);
            assert!(
                text.starts_with("an error of 1e-4 cannot be certified: adams and gauss6 on steps that resolve"),
                "{text}"
            );
            assert!(text.contains("of which gauss6 accounts for") && way.contains("max_step"), "{text} {way}");
            // A little wrong at the end alone.
            let mut wrong = right.clone();
            wrong.path.last_mut().unwrap()[0] += 1e-5 * right.travel;
            let opinion = second_opinion(&bench, &wrong, 1e-7, limit);
            assert!(opinion.certifies(2e-5) && !opinion.certifies(0.9e-5), "{opinion:?}");
        });
    }

    #[test]
    fn what_nobody_confirmed_is_not_certified() {
        assert!(!Opinion::NONE.certifies(1.0));
        assert!(Opinion::NONE.against(1e-3).0.contains("no second method arrived"));
    }
}
