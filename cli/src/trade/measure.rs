//! One timed run, and what its error is.

use std::sync::Arc;
use std::time::{Duration, Instant};

use nekton::scalar::Real;
use nekton::scene::{Description, ForceFormula, Quadrature, Scene};
use nekton::status::{Error, Place, Status};
use nekton::{Formulation, Method, ModelBuf, Plan, SimBuf};

use super::drives::{OUTPUTS, Stride};
use super::setting::{Setting, Variant, counts, method, scaled, unit};
use crate::scene_file::Integrator;

/// With a fixed step the clock is looked at this often between two of them.
const LOOKS: usize = 8;
/// Runs shorter than this are repeated and the shortest time taken.
const REPEATED: Duration = Duration::from_millis(50);
const REPEATS: usize = 5;

/// Positions and headings of all links at the output times, 3 per link.
pub type Path = Vec<Vec<f64>>;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// At its end.
    Done,
    /// Given up because it took too long.
    Limit,
    /// By an error.
    Failed(Error),
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Where everything was.
    pub path: Path,
    /// Time of stepping, s; set-up is not counted.
    pub seconds: f64,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// What the model computes.
    pub plan: Plan,
    /// How it ended.
    pub ended: Ended,
}

/// A scene in both precisions, and what is needed to compare its trajectories.
pub struct Bench<'a> {
    scene: &'a Scene<'a, f64>,
    single: Scene<'static, f32>,
    /// Nodes of the link that has most.
    pub nodes: usize,
    counts: Vec<(Place, usize)>,
    /// For every link the distance of its outermost point from its centre of mass.
    radii: Vec<f64>,
    /// What is computed with the scene's own settings.
    pub plan: Plan,
    /// The scene's own integrator: the limits of its steps hold for all runs.
    own: Integrator,
}

impl<'a> Bench<'a> {
    /// Compiles the scene once. `own` is its integrator.
    pub fn new(scene: &'a Scene<'a, f64>, own: Integrator) -> Result<Self, Error> {
        let model = ModelBuf::new(scene)?;
        let view = model.view();
        let radius = |place: Place| {
            let points = (0..256).filter_map(|k| view.outline_point(place, std::f64::consts::TAU * k as f64 / 256.0));
            points.map(|p| p[0].hypot(p[1])).fold(0.0, f64::max)
        };
        let links = || (0..view.link_count()).filter_map(|i| view.link(i));
        Ok(Bench {
            nodes: links().map(|l| l.nodes).max().unwrap_or(8),
            radii: links().map(|l| radius(l.place)).collect(),
            counts: counts(&view),
            plan: *view.plan(),
            single: super::single::single(scene),
            scene,
            own,
        })
    }

    /// Largest distance by which some material point of a link of `a` is away from where it is in `b`, at any output time: the
    /// distance of the centres plus the difference of headings times the radius.
    pub fn distance(&self, a: &Path, b: &Path) -> f64 {
        self.distances(a, b).fold(0.0, worse)
    }

    /// The same at each output time.
    pub fn distances<'p>(&'p self, a: &'p Path, b: &'p Path) -> impl Iterator<Item = f64> + 'p {
        a.iter().zip(b).map(|(a, b)| {
            let links = a.chunks_exact(3).zip(b.chunks_exact(3)).zip(&self.radii);
            links.map(|((a, b), r)| (a[0] - b[0]).hypot(a[1] - b[1]) + r * (a[2] - b[2]).abs()).fold(0.0, worse)
        })
    }

    /// The length to which errors are relative: the largest distance that a material point travels from its start, but at
    /// least a thousandth of the largest link.
    pub fn travel(&self, path: &Path) -> f64 {
        let start = vec![path[0].clone(); path.len()];
        self.distance(path, &start).max(1e-3 * self.size())
    }

    /// Radius of the largest link.
    pub fn size(&self) -> f64 {
        self.radii.iter().copied().fold(0.0, f64::max)
    }

    /// Runs a setting to a time, repeatedly if that is short.
    pub fn run(&self, setting: &Setting, until: f64, limit: Duration) -> Run {
        let mut best = self.once(setting, until, limit, 0.0);
        let mut total = best.seconds;
        for _ in 1..REPEATS {
            if best.ended != Ended::Done || total > REPEATED.as_secs_f64() {
                break;
            }
            let again = self.once(setting, until, limit, 0.0);
            total += again.seconds;
            if again.ended == Ended::Done && again.seconds < best.seconds {
                best = again;
            }
        }
        best
    }

    /// Runs a setting once, its start moved by up to `shift` in every free coordinate.
    pub fn once(&self, setting: &Setting, until: f64, limit: Duration, shift: f64) -> Run {
        let failed = |error| Run {
            path: Path::new(),
            seconds: 0.0,
            evaluations: 0,
            plan: Plan::default(),
            ended: Ended::Failed(error),
        };
        let setting = &self.limited(setting);
        let result = if setting.single {
            run(&self.variant(&self.single, setting), setting, until, limit, shift)
        } else {
            run(&self.variant(self.scene, setting), setting, until, limit, shift)
        };
        result.unwrap_or_else(failed)
    }

    /// A setting with the scene's own limits of steps.
    pub fn limited(&self, setting: &Setting) -> Setting {
        Setting { integrator: setting.integrator.with_limits_of(self.own), ..*setting }
    }

    /// The path by the implicit method of order 6 with steps that are told beforehand, as many times shorter as `finer` says;
    /// `None` if that takes more than `limit`. It shares neither estimates nor choices of steps with [`Bench::once`].
    ///
    /// # Errors
    /// As [`nekton::Sim::advance`]: longer steps than the motion bears fail too.
    pub fn stride(
        &self,
        nodes: usize,
        strides: &[Stride],
        finer: usize,
        limit: Duration,
    ) -> Result<Option<Path>, Error> {
        let setting = Setting {
            quadrature: Quadrature::Graded,
            force: ForceFormula::ExactGradient,
            single: false,
            integrator: self.own,
            nodes,
        };
        let model = Arc::new(ModelBuf::new(&self.variant(self.scene, &setting))?);
        let until = strides.last().map_or(0.0, |s| s.to);
        let clock = Instant::now();
        let mut sim: Option<(f64, SimBuf<f64>)> = None;
        let mut path: Path = Vec::new();
        for stride in strides {
            let step = (stride.to - stride.from) / (stride.steps * finer) as f64;
            let same = sim.as_ref().is_some_and(|(s, _)| (s / step - 1.0).abs() < 1e-9);
            if !same {
                let mut next = SimBuf::new(model.clone(), Method::Gauss6 { step })?;
                if let Some((_, before)) = &mut sim {
                    let before = before.view();
                    next.view().set_state(before.time(), before.state())?;
                }
                sim = Some((step, next));
            }
            let Some((_, buf)) = &mut sim else { break };
            let mut view = buf.view();
            if path.is_empty() {
                path.push(view.positions().to_vec());
            }
            for k in 1..stride.steps * finer {
                view.step()?;
                if k % 64 == 0 && clock.elapsed() > limit {
                    return Ok(None);
                }
            }
            view.advance(stride.to)?;
            if clock.elapsed() > limit {
                return Ok(None);
            }
            if stride.to == until * path.len() as f64 / OUTPUTS as f64 {
                path.push(view.positions().to_vec());
            }
        }
        Ok((path.len() == OUTPUTS + 1).then_some(path))
    }

    /// The scene.
    pub fn scene(&self) -> &Scene<'a, f64> {
        self.scene
    }

    fn variant<'v, R>(&'v self, base: &'v Scene<'v, R>, setting: &Setting) -> Variant<'v, R> {
        let scale = setting.nodes as f64 / self.nodes as f64;
        Variant { base, counts: &self.counts, scale, force: setting.force, quadrature: setting.quadrature }
    }

    /// Settings that make a difference: a model without boundary system or with conserved impulse has no Christoffel force.
    pub fn forces(&self) -> &'static [ForceFormula] {
        match self.plan.formulation {
            Formulation::Velocity if self.plan.fluid => &[ForceFormula::ExactGradient, ForceFormula::Boundary],
            _ => &[ForceFormula::ExactGradient],
        }
    }

    /// The same for the quadrature: it needs two boundaries.
    pub fn quadratures(&self) -> &'static [Quadrature] {
        if self.plan.fluid && self.plan.links + self.plan.walls > 1 {
            &[Quadrature::Graded, Quadrature::Plain]
        } else {
            &[Quadrature::Graded]
        }
    }

    /// Node counts worth a try, up to a largest.
    pub fn node_counts(&self, most: usize) -> Vec<usize> {
        if !self.plan.fluid {
            return vec![self.nodes];
        }
        let grid = (2..12).flat_map(|k| [1 << (k + 1), 3 << k]);
        let mut counts: Vec<usize> = grid.filter(|n| *n >= 8 && *n <= most).collect();
        counts.dedup_by_key(|n| scaled(self.nodes, *n as f64 / self.nodes as f64));
        counts
    }
}

/// The larger; NaN when either is.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

fn run<R: Real>(
    scene: &impl Description<R>,
    setting: &Setting,
    until: f64,
    limit: Duration,
    shift: f64,
) -> Result<Run, Error> {
    let model = Arc::new(ModelBuf::<R>::new(scene)?);
    let plan = *model.view().plan();
    let unit = unit(&model.view());
    let mut sim = SimBuf::new(model, method(setting.integrator, unit))?;
    let mut sim = sim.view();
    if shift != 0.0 {
        let mut y = sim.state().to_vec();
        // Golden-ratio steps: no direction is left out and none preferred.
        for (k, y) in y.iter_mut().take(plan.free_coordinates).enumerate() {
            *y += R::lit(shift * (2.0 * (0.618_034 * (k + 1) as f64).fract() - 1.0));
        }
        sim.set_state(R::zero(), &y)?;
    }
    let wide = |x: &[R]| -> Vec<f64> { x.iter().map(|x| x.to_f64()).collect() };
    sim.set_step_limit(1000)?;
    let mut path = vec![wide(sim.positions())];
    let mut ended = Ended::Done;
    let clock = Instant::now();
    // Looking at the clock must not cost more than a step: a lone swimmer's velocities need an evaluation to be shown, and a
    // lone body's evaluation is no more than a look.
    let looks = if plan.formulation == Formulation::Velocity { looks(setting, until) } else { 1 };
    for k in 1..=OUTPUTS * looks {
        let t = R::lit(until * k as f64 / (OUTPUTS * looks) as f64);
        // A run that crawls is to be noticed before it has made a million steps.
        let reached = loop {
            match sim.advance_dense(t, R::lit(until)) {
                Err(error) if error.status == Status::TooManySteps && clock.elapsed() <= limit => {}
                reached => break reached,
            }
        };
        if let Err(error) = reached {
            ended = if error.status == Status::TooManySteps { Ended::Limit } else { Ended::Failed(error) };
            break;
        }
        if k % looks == 0 {
            path.push(wide(sim.positions()));
        }
        if clock.elapsed() > limit && k < OUTPUTS * looks {
            ended = Ended::Limit;
            break;
        }
    }
    Ok(Run { path, seconds: clock.elapsed().as_secs_f64(), evaluations: sim.counters().evaluations, plan, ended })
}

/// Fixed steps must end at every look.
fn looks(setting: &Setting, until: f64) -> usize {
    match setting.integrator {
        Integrator::Adams { .. } => 1,
        _ => {
            let steps = (until / OUTPUTS as f64 / super::setting::parameter(setting.integrator)).round() as usize;
            (1..=LOOKS).rev().find(|n| steps.is_multiple_of(*n)).unwrap_or(1)
        }
    }
}
