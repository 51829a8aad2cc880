//! What a run leaves behind, in the user's order of links.

use nekton::{Resolution, TimeError};

/// Everything the tables, plots and the report are made from.
#[derive(Debug, Default)]
pub struct Record {
    /// Names `body.link`.
    pub links: Vec<String>,
    /// Names `body.link` of the links that hang on a joint.
    pub joints: Vec<String>,
    /// Outlines of the links in their own frames (origin = centre of mass).
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// Outlines of the obstacles.
    pub obstacles: Vec<Vec<[f64; 2]>>,
    /// Outline of the tank.
    pub tank: Option<Vec<[f64; 2]>>,
    /// One row per output time.
    pub rows: Vec<Row>,
    /// Whether energy parts are there at all: gravity, repulsion, circulation.
    pub terms: Terms,
    /// Smallest gap met, when and between what.
    pub smallest: Option<Nearest>,
    /// Relative error in space that the scene asks for; 0: none.
    pub tolerance: f64,
    /// Why the run stopped before its end.
    pub stopped: Option<String>,
    /// Remarks on the scene.
    pub notices: Vec<String>,
    /// Drifts of the energy, and what to say of them if nothing explains them: known at the end.
    pub drifts: Vec<(f64, String)>,
    /// The plan, as text.
    pub plan: String,
    /// Settings: name and value.
    pub settings: Vec<(String, String)>,
    /// Error indicators and counters: name and value.
    pub figures: Vec<(String, String)>,
}

/// Parts of the energy that the scene has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms {
    /// Fluid of density > 0.
    pub fluid: bool,
    /// Gravity.
    pub gravity: bool,
    /// Repulsion.
    pub repulsion: bool,
    /// Circulation.
    pub circulation: bool,
    /// Some joint slides, so its torque is a force.
    pub slider: bool,
}

/// A gap.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// Distance.
    pub distance: f64,
    /// Time.
    pub time: f64,
    /// Between what; "" if unknown.
    pub between: String,
}

/// The state and everything derived from it at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Time.
    pub t: f64,
    /// x, y, theta per link.
    pub pose: Vec<[f64; 3]>,
    /// Their rates.
    pub velocity: Vec<[f64; 3]>,
    /// Energies.
    pub energy: Energies,
    /// Linear impulse and angular impulse about the origin.
    pub impulse: [f64; 3],
    /// Smallest gap; infinite if nothing could touch.
    pub gap: f64,
    /// Error indicators of space, the largest since the row before.
    pub resolution: Resolution<f64>,
    /// Estimated errors of time integration, summed since the start.
    pub time_error: TimeError<f64>,
    /// Torque and power per joint.
    pub torque: Vec<[f64; 2]>,
}

/// Energies per unit depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Kinetic, of the fluid.
    pub kinetic_fluid: f64,
    /// Kinetic, of the bodies.
    pub kinetic_bodies: f64,
    /// Of gravity and buoyancy.
    pub buoyancy: f64,
    /// Of repulsion.
    pub repulsion: f64,
    /// Of the circulatory flow.
    pub circulation: f64,
    /// Sum.
    pub total: f64,
    /// Done by the joints since the start.
    pub work: f64,
}

impl Row {
    /// Sums of the estimated local errors of time integration: lengths, angles, their rates. NaN if no step could be estimated.
    pub fn time_errors(&self) -> [f64; 4] {
        let e = &self.time_error;
        if e.length.is_nan() && e.unknown > 0 {
            return [f64::NAN; 4];
        }
        [e.length_sum, e.angle_sum, e.speed_sum, e.spin_sum]
    }
}

impl Record {
    /// An outline in the world at a pose.
    pub fn placed(outline: &[[f64; 2]], pose: &[f64; 3]) -> Vec<[f64; 2]> {
        let (s, c) = pose[2].sin_cos();
        outline.iter().map(|p| [pose[0] + c * p[0] - s * p[1], pose[1] + s * p[0] + c * p[1]]).collect()
    }

    /// A point near which everything is, and from which it is drawn, lest the digits of small bodies get lost far from (0, 0).
    pub fn origin(&self) -> [f64; 2] {
        let reach = self.outlines.iter().flatten().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
        let ranges = [0, 1].map(|c| {
            let walls = self.tank.iter().chain(&self.obstacles).flatten().map(|p| p[c]);
            let poses = self.rows.iter().flat_map(|r| &r.pose).flat_map(|p| [p[c] - reach, p[c] + reach]);
            walls.chain(poses).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        });
        let size = ranges.map(|[low, high]| high - low).into_iter().fold(reach, f64::max);
        ranges.map(|[low, high]| base(low, high, size))
    }

    /// The same with everything moved so that its [`Record::origin`] is (0, 0).
    pub fn placed_from(outline: &[[f64; 2]], pose: &[f64; 3], origin: [f64; 2]) -> Vec<[f64; 2]> {
        Self::placed(outline, &[pose[0] - origin[0], pose[1] - origin[1], pose[2]])
    }

    /// Largest change of (total energy - work of the joints) since the start, and the largest kinetic energy.
    pub fn energy_drift(&self) -> Option<(f64, f64)> {
        let balance = |r: &Row| r.energy.total - r.energy.work;
        let first = balance(self.rows.first()?);
        let drift = self.rows.iter().map(|r| (balance(r) - first).abs()).fold(0.0, f64::max);
        let scale = self.rows.iter().map(|r| r.energy.kinetic_fluid + r.energy.kinetic_bodies).fold(0.0, f64::max);
        Some((drift, scale))
    }
}

/// What is taken off numbers between `low` and `high` to draw them at a scale of `size`: 0, or a number near them with few digits
/// if they are far more than that.
pub fn base(low: f64, high: f64, size: f64) -> f64 {
    let far = low.abs().max(high.abs());
    let unit = 10f64.powf(size.log10().ceil());
    if !(size > 0.0 && far.is_finite() && far > 1e3 * size && unit > 0.0) {
        return 0.0;
    }
    // Below the digits of a number there is nothing to round.
    let middle = low + 0.5 * (high - low);
    let rounded = (middle / unit).round() * unit;
    if rounded.is_finite() { rounded } else { middle }
}

/// A number in its shorter way of writing.
pub fn shortest(x: f64) -> String {
    let (plain, power) = (x.to_string(), format!("{x:e}"));
    if plain.len() <= power.len() { plain } else { power }
}
