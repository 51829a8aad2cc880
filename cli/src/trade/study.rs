//! Which settings are tried, and what each gave.

use std::time::Duration;

use nekton::scene::{ForceFormula, Quadrature};

use super::drives::OUTPUTS;
use super::measure::{Bench, Ended, Run};
use super::reference::Reference;
use super::setting::Setting;
use crate::scene_file::Integrator;

/// A tighter step or tolerance, or more nodes, that leave more than this of the error bought nothing.
const GAIN: f64 = 0.7;
/// Above this error, more effort need not show at once.
const COARSE: f64 = 0.1;
/// What is so many times slower than something equally exact is not carried further: a fixed-step method with the same nodes,
/// or more nodes with the same force, quadrature and precision.
const HOPELESS: f64 = 4.0;
/// Most steps of a fixed-step method between two output times: 2^14 in all.
const HALVINGS: u32 = 10;

/// What became of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// It arrived.
    Done,
    /// It was given up, or would have been: a run with half the work was.
    Limit,
    /// It ended with an error.
    Failed(String),
}

/// One setting and what it gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The setting.
    pub setting: Setting,
    /// Unknowns of the boundary system.
    pub unknowns: usize,
    /// What became of it.
    pub status: Status,
    /// Largest relative error; NaN unless done.
    pub error: f64,
    /// Time per simulated second; NaN unless done.
    pub cost: f64,
    /// Evaluations per simulated second; NaN unless done.
    pub evaluations: f64,
}

/// The settings to try.
pub struct Study<'a> {
    /// The scene.
    pub bench: &'a Bench<'a>,
    /// What errors are measured against.
    pub reference: &'a Reference,
    /// Time for one run.
    pub limit: Duration,
    /// Only the usual force, quadrature and precision, and only `adams`.
    pub quick: bool,
    /// Known from before.
    pub known: Vec<Measured>,
    /// More nodes are not tried once this error is reached.
    pub enough: f64,
}

impl Study<'_> {
    /// Families of settings: quadrature, force, precision.
    fn families(&self) -> Vec<(Quadrature, ForceFormula, bool)> {
        let usual = (Quadrature::Graded, ForceFormula::ExactGradient, false);
        let mut all = vec![usual, (Quadrature::Graded, ForceFormula::ExactGradient, true)];
        for quadrature in self.bench.quadratures() {
            for force in self.bench.forces() {
                all.push((*quadrature, *force, false));
            }
        }
        // Where everything is far apart, single precision may go without the graded quadrature too.
        all.extend(self.bench.quadratures().iter().map(|q| (*q, ForceFormula::ExactGradient, true)));
        let mut seen = Vec::new();
        all.retain(|f| {
            !seen.contains(f) && {
                seen.push(*f);
                true
            }
        });
        if self.quick {
            all.truncate(1);
        }
        all
    }

    fn node_counts(&self) -> Vec<usize> {
        self.bench.node_counts(self.bench.nodes.max(self.reference.nodes))
    }

    /// Groups of runs, for a progress bar.
    pub fn groups(&self) -> u64 {
        (self.families().len() * self.node_counts().len()) as u64
    }

    /// Tries everything. `tell` sees each group's name before it is run, `keep` each new row.
    pub fn run<E>(
        &self,
        mut tell: impl FnMut(String, u64),
        mut keep: impl FnMut(&Measured) -> Result<(), E>,
    ) -> Result<Vec<Measured>, E> {
        let mut rows = Vec::new();
        let counts = self.node_counts();
        let mut group = 0;
        for (quadrature, force, single) in self.families() {
            let (mut best, mut idle, mut beaten) = (f64::INFINITY, 0, 0);
            for (k, nodes) in counts.iter().enumerate() {
                let any = Integrator::adams(0.0);
                let setting = Setting { quadrature, force, single, integrator: any, nodes: *nodes };
                let [q, f, p, _] = setting.names();
                tell(format!("{nodes} nodes, {q}, {f}, {p}"), group + k as u64);
                let start = rows.len();
                for ladder in self.ladders(single) {
                    self.climb(&setting, &ladder, &mut rows, start, &mut keep)?;
                }
                let (others, group_rows): (&[Measured], &[Measured]) = rows.split_at(start);
                let exact =
                    group_rows.iter().filter(|m| m.error.is_finite()).min_by(|a, b| a.error.total_cmp(&b.error));
                let here = exact.map_or(f64::INFINITY, |m| m.error);
                let far = |m: &Measured| others.iter().any(|o| o.error <= m.error && HOPELESS * o.cost < m.cost);
                beaten = if exact.is_some_and(far) { beaten + 1 } else { 0 };
                let slow = group_rows.iter().all(|m| m.status == Status::Limit);
                if here <= GAIN * best {
                    (best, idle) = (here, 0);
                } else if best < COARSE {
                    idle += 1;
                }
                if idle == 2 || beaten == 2 || slow || best <= self.reference.error.max(self.enough) {
                    break;
                }
            }
            group += counts.len() as u64;
        }
        Ok(rows)
    }

    /// Every integrator with its steps or tolerances, from loose to tight.
    fn ladders(&self, single: bool) -> Vec<Vec<Integrator>> {
        let last = if single { 6 } else { 12 };
        let mut all = vec![(2..=last).map(|e| Integrator::adams(10f64.powi(-e))).collect()];
        if !self.quick {
            let steps = (0..HALVINGS).map(|k| self.reference.until / (OUTPUTS << k) as f64);
            all.push(steps.clone().map(|step| Integrator::Rk4 { step }).collect());
            all.push(steps.clone().map(|step| Integrator::Abm4 { step }).collect());
            all.push(steps.map(|step| Integrator::Gauss6 { step }).collect());
        }
        all
    }

    /// Tightens one integrator until that buys nothing more or takes too long.
    fn climb<E>(
        &self,
        setting: &Setting,
        ladder: &[Integrator],
        rows: &mut Vec<Measured>,
        group: usize,
        keep: &mut impl FnMut(&Measured) -> Result<(), E>,
    ) -> Result<(), E> {
        let (mut best, mut idle) = (f64::INFINITY, 0);
        let mut slow = false;
        for integrator in ladder {
            let setting = Setting { integrator: *integrator, ..*setting };
            let known = self.known.iter().find(|m| same(&m.setting, &setting));
            let row = match known {
                Some(row) => row.clone(),
                None => {
                    let row = if slow { self.given_up(setting) } else { self.measure(setting) };
                    keep(&row)?;
                    row
                }
            };
            let fixed = !matches!(integrator, Integrator::Adams { .. });
            let seconds = row.cost * self.reference.until;
            slow = fixed && seconds > 0.6 * self.limit.as_secs_f64();
            let over = row.status == Status::Limit;
            let (error, cost) = (row.error, row.cost);
            let beaten = |m: &Measured| m.error <= error && HOPELESS * m.cost < cost;
            let hopeless = rows[group..].iter().any(beaten);
            rows.push(row);
            if over || hopeless {
                break;
            }
            if error <= GAIN * best {
                (best, idle) = (error, 0);
            } else if best < COARSE {
                idle += 1;
            }
            if idle == 2 || best <= self.reference.error {
                break;
            }
        }
        Ok(())
    }

    fn given_up(&self, setting: Setting) -> Measured {
        let nan = f64::NAN;
        Measured { setting, unknowns: 0, status: Status::Limit, error: nan, cost: nan, evaluations: nan }
    }

    fn measure(&self, setting: Setting) -> Measured {
        let run = self.bench.run(&setting, self.reference.until, self.limit);
        let mut row = Measured { unknowns: run.plan.unknowns, ..self.given_up(setting) };
        match run.ended {
            Ended::Limit => {}
            Ended::Failed(error) => row.status = Status::Failed(error.status.text().to_owned()),
            Ended::Done => self.fill(&mut row, &run),
        }
        row
    }

    fn fill(&self, row: &mut Measured, run: &Run) {
        row.status = Status::Done;
        row.error = self.bench.distance(&run.path, &self.reference.path) / self.reference.travel;
        row.cost = run.seconds / self.reference.until;
        row.evaluations = run.evaluations as f64 / self.reference.until;
    }
}

/// Equal but for the digits that a table does not keep.
fn same(a: &Setting, b: &Setting) -> bool {
    let parameter = |s: &Setting| super::setting::parameter(s.integrator);
    a.names() == b.names() && a.nodes == b.nodes && (parameter(a) / parameter(b) - 1.0).abs() < 1e-9
}

/// The runs than which none is both faster and more exact, from fast to exact. Errors below the reference's own count as that.
pub fn front(rows: &[Measured], floor: f64) -> Vec<&Measured> {
    let error = |m: &Measured| m.error.max(floor);
    let mut done: Vec<&Measured> =
        rows.iter().filter(|m| m.status == Status::Done && m.error.is_finite() && m.error < 1.0).collect();
    done.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut front: Vec<&Measured> = Vec::new();
    for m in done {
        if front.last().is_none_or(|last| error(m) < error(last)) {
            front.push(m);
        }
    }
    front
}

/// The cheapest run with at most this error. A clock is not exact: something unusual must be faster by 5 %, twice unusual by
/// 10 %, and so on.
pub fn cheapest(rows: &[Measured], error: f64) -> Option<&Measured> {
    let price = |m: &Measured| {
        let usual = ["graded", "exact", "f64", "adams"];
        let unusual = m.setting.names().iter().zip(usual).filter(|(a, b)| *a != b).count();
        m.cost * (1.0 + 0.05 * unusual as f64)
    };
    let done = rows.iter().filter(|m| m.status == Status::Done && m.error <= error);
    done.min_by(|a, b| price(a).total_cmp(&price(b)))
}
