//! The section `[run]`: how long, how often, and by which method.

use nekton::STEP_LIMIT;

use super::reader::{Item, Outcome, Section};

/// What `nekton run` is to do.
#[derive(Clone, Debug)]
pub struct RunDef {
    /// Simulated time.
    pub duration: f64,
    /// Time between rows of the tables.
    pub output_interval: f64,
    /// Method of integration.
    pub integrator: Integrator,
}

/// Method of integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Fixed step, order 4, one-step.
    Rk4 {
        /// Step.
        step: f64,
    },
    /// Fixed step, order 4, multistep.
    Abm4 {
        /// Step.
        step: f64,
    },
    /// Fixed step, order 6, implicit: for long runs.
    Gauss6 {
        /// Step.
        step: f64,
    },
    /// Variable step, orders 1 to 12.
    Adams {
        /// Relative and absolute tolerance.
        tolerance: f64,
        /// Longest step; 0: none is given.
        max_step: f64,
        /// First step; 0: the method chooses it.
        first_step: f64,
    },
}

/// Rows of the tables if the scene gives no `output_interval`.
const DEFAULT_ROWS: f64 = 200.0;
/// A run with more rows than this is a slip of the pen.
const MOST_ROWS: f64 = 1e6;
/// Tolerance if the scene gives none.
const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Keys of the section.
pub const RUN: &[&str] =
    &["duration", "output_interval", "integrator", "force", "quadrature", "tolerance", "allow_unresolved", "shortcuts"];

/// Reads the section.
pub fn read_run(section: &Section<'_>) -> Outcome<RunDef> {
    let duration = section.need("duration")?.positive()?;
    let output_interval = section.or("output_interval", duration / DEFAULT_ROWS, Item::positive)?;
    if duration / output_interval > MOST_ROWS {
        let message = format!("makes {} rows", (duration / output_interval).round());
        return Err(section.need("output_interval")?.problem(message).hint("make output_interval larger"));
    }
    let integrator = section
        .or("integrator", Integrator::adams(DEFAULT_TOLERANCE), |item| read_integrator(item, output_interval))?;
    Ok(RunDef { duration, output_interval, integrator })
}

impl Integrator {
    /// The variable-step method, free to choose its steps.
    pub fn adams(tolerance: f64) -> Self {
        Integrator::Adams { tolerance, max_step: 0.0, first_step: 0.0 }
    }

    /// The same with the longest and first step of another, if both choose their steps.
    pub fn with_limits_of(self, other: Integrator) -> Self {
        match (self, other) {
            (Integrator::Adams { tolerance, .. }, Integrator::Adams { max_step, first_step, .. }) => {
                Integrator::Adams { tolerance, max_step, first_step }
            }
            _ => self,
        }
    }

    /// What can be changed where a run needs more steps than it may make between two rows.
    pub fn way_to_fewer_steps(self) -> &'static str {
        match self {
            Integrator::Adams { .. } => {
                "loosen `tolerance` or `max_step` of `integrator`, or shorten `output_interval`: the limit holds between two rows"
            }
            _ => "lengthen `step` of `integrator`, or shorten `output_interval`: the limit holds between two rows",
        }
    }
}

fn read_integrator(item: &Item<'_>, output_interval: f64) -> Outcome<Integrator> {
    let section = item.section("`integrator`", &["method", "tolerance", "max_step", "first_step", "step"])?;
    let method = section.need("method")?.word(&["adams", "rk4", "abm4", "gauss6"])?;
    let strangers: &[&str] = if method == "adams" { &["step"] } else { &["tolerance", "max_step", "first_step"] };
    if let Some(item) = strangers.iter().find_map(|key| section.get(key)) {
        let hint = match item.key {
            "step" => "its steps are of its own choice; their limit is `max_step`",
            "tolerance" => "its accuracy is that of its `step`",
            _ => "all its steps have the length `step`",
        };
        return Err(item.problem(format!("does not go with method `{method}`")).hint(hint));
    }
    let steps = |key: &'static str| -> Outcome<f64> {
        let item = section.need(key)?;
        let step = item.positive()?;
        let count = (output_interval / step).round();
        if count > STEP_LIMIT as f64 {
            let message = format!("= {step} makes {count:.0} steps between two rows, of {STEP_LIMIT} that are allowed");
            return Err(item.problem(message).hint(format!("lengthen `{key}`, or shorten `output_interval`")));
        }
        Ok(step)
    };
    if method == "adams" {
        return Ok(Integrator::Adams {
            tolerance: section.or("tolerance", DEFAULT_TOLERANCE, Item::positive)?,
            max_step: section.or("max_step", 0.0, |_| steps("max_step"))?,
            first_step: section.or("first_step", 0.0, Item::positive)?,
        });
    }
    let step = steps("step")?;
    Ok(match method {
        "rk4" => Integrator::Rk4 { step },
        "gauss6" => Integrator::Gauss6 { step },
        _ => Integrator::Abm4 { step },
    })
}
