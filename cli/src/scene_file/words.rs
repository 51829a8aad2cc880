//! What the user is told of a scene: the core's errors in the names and lines of the file, and what helps.

use nekton::status::{Error, Place, Status};
use nekton::{ModelBuf, STEP_LIMIT};

use super::SceneFile;
use super::reader::{Lines, Problem};
use super::shape::ShapeDef;

/// Points that a notice names, at most.
const MOST_NAMED: usize = 12;

/// A part in per cent, one digit.
pub fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    match percent {
        p if p >= 1.0 => format!("{p:.0} %"),
        p if p >= 0.01 => format!("{p:.2} %"),
        p => format!("{p:.0e} %"),
    }
}

fn listed(points: &[usize]) -> String {
    let more = points.len().saturating_sub(MOST_NAMED);
    let named: Vec<String> = points.iter().take(MOST_NAMED).map(usize::to_string).collect();
    named.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

impl SceneFile {
    /// The points that were taken as corners of a curve, for a notice.
    pub fn corners_found(&self, place: Place) -> String {
        let mut all = Vec::new();
        if let Some(shape) = self.shape(place) {
            shape.core().each_corner(|k| all.push(k));
        }
        format!(
            "kinks at its points {} (counted from 0) were taken as corners; `corners` in its shape gives others, or \"none\"",
            listed(&all)
        )
    }

    /// What there is to say of a curve whose points tell it no better than to this error.
    pub fn uncertain(&self, place: Place, error: f64) -> String {
        if let Some(far) = self.shape(place).and_then(ShapeDef::far) {
            return format!(
                "its points tell its outline no better than to about {} of added mass, which no bound contains: {far}",
                percent(error)
            );
        }
        if let Some((a, b)) = self.shape(place).and_then(ShapeDef::twins) {
            return format!(
                "its points tell its outline no better than to about {} of added mass, which no bound contains: its points {a} and {b} (counted \
                 from 0) are so close that the line through them bends the curve; leave one of them out",
                percent(error)
            );
        }
        let sharp = self.shape(place).and_then(ShapeDef::sharp).map_or_else(String::new, |(points, turn)| {
            format!(
                "; it turns by up to {turn:.0}° at its points {} (counted from 0), which are no corners",
                listed(&points)
            )
        });
        let bends = || "give more where it bends, or name its corners in `corners`".to_owned();
        let help = self.shape(place).and_then(ShapeDef::scatter).unwrap_or_else(bends);
        format!(
            "its points tell its outline no better than to about {} of added mass, which no bound contains: {help}{sharp}",
            percent(error)
        )
    }

    fn lines_of(&self, place: Place) -> &Lines {
        let found = match place {
            Place::Tank => self.tank.as_ref().map(|t| &t.lines),
            Place::Obstacle(k) => self.obstacles.get(k).map(|o| &o.lines),
            Place::Body(b) => self.bodies.get(b).map(|b| &b.lines),
            Place::Link(b, l) => self.link(b, l).map(|(_, l)| &l.lines),
            _ => None,
        };
        found.unwrap_or(&self.lines)
    }

    /// An error of the core in the user's names.
    pub fn describe(&self, error: &Error) -> String {
        let mut text = match (error.place, error.other) {
            // Nobody can raise the limit here.
            (Place::Scene, None) if error.status == Status::TooManySteps => {
                format!("between two rows more steps are needed than the {STEP_LIMIT} allowed")
            }
            (Place::Scene, None) => error.status.text().to_owned(),
            (place, None) if error.status == Status::BadShape && matches!(error.what, "point" | "vertex") => {
                return format!(
                    "{}: its {} {} repeats the one before it",
                    self.name_of(place),
                    error.what,
                    error.value
                );
            }
            (place, None) => format!("{}: {}", self.name_of(place), error.status.text()),
            (place, Some(other)) => {
                format!("{} and {}: {}", self.name_of(place), self.name_of(other), error.status.text())
            }
        };
        // The gap of boundaries that touch is rounding only, and a limit of steps is told already.
        let told =
            matches!(error.status, Status::Overlap | Status::Contact | Status::TooManySteps | Status::DriveUnresolved);
        if error.status == Status::DriveUnresolved {
            text = match error.value {
                0.0 => format!("{text} (its position or speed jumps, which would take an impulse)"),
                step => format!("{text} (it takes steps of {step:.3e} s or less)"),
            };
        }
        if !error.what.is_empty() && !told {
            let size = error.value.abs();
            let value = if size == 0.0 || (1e-3..1e6).contains(&size) {
                error.value.to_string()
            } else {
                format!("{:.3e}", error.value)
            };
            text = format!("{text} ({} = {value})", error.what);
        }
        text
    }

    /// Line of what puts a boundary where it is.
    fn line_of_position(&self, place: Place) -> usize {
        let lines = self.lines_of(place);
        let body = match place {
            Place::Link(b, _) => self.bodies.get(b).and_then(|b| b.lines.find(&["position"])),
            _ => None,
        };
        lines.find(&["hinge", "slider", "position"]).or(body).or(lines.find(&["shape"])).unwrap_or(lines.own)
    }

    /// An error of the core as a complaint about the line that caused it.
    pub fn problem(&self, error: &Error) -> Problem {
        let lines = self.lines_of(error.place);
        let keys: &[&str] = match error.status {
            Status::BadShape | Status::SelfIntersection => &["shape"],
            Status::NodeCount | Status::BoundExceeded => &["nodes", "shape"],
            Status::BadParent => &["parent"],
            Status::Massless => &["density", "mass"],
            Status::BadTable => &["table"],
            Status::BadTolerance => &["tolerance", "integrator"],
            Status::BadStep => &["step", "integrator"],
            _ => &[],
        };
        let line = match error.status {
            Status::Overlap | Status::OutsideTank | Status::Contact => self.line_of_position(error.place),
            _ => match (lines.find(&[error.what]).or_else(|| lines.find(keys)), error.place) {
                (Some(line), _) => line,
                // No line stands for the whole scene.
                (None, Place::Scene) => return Problem::file(self.path(), self.describe(error)),
                (None, _) => lines.own,
            },
        };
        let hint = match error.status {
            Status::Overlap | Status::Contact => {
                let other = error.other.map(|o| self.line_of_position(o));
                other.map(|l| format!("move them apart; the other is placed on line {l}"))
            }
            Status::OutsideTank => Some("move it inside, or make the tank larger".to_owned()),
            Status::SelfIntersection => Some(self.shape(error.place).and_then(ShapeDef::far).unwrap_or_else(|| {
                "list the points in order along the outline; a curve through uneven points may cross itself where the polygon does not, as \
                 beside a long side without points: give it some, name its ends in `corners`, or write `polygon`; through points that \
                 scatter it crosses itself too: `smooth = s` beside `curve`"
                    .to_owned()
            })),
            Status::NodeCount => Some("there are more than the core takes".to_owned()),
            Status::BoundExceeded | Status::Singular => Some(self.more_nodes(error.place)),
            Status::OutOfMemory => Some(self.largest()),
            Status::BadTolerance => Some("1e-12 is near the least that can be met".to_owned()),
            Status::Massless => Some("give it a density, or give the fluid one".to_owned()),
            Status::BadShape if error.what == "corner" => Some("name every corner once".to_owned()),
            Status::BadShape if error.what == "point" || error.what == "vertex" => Some(
                self.shape(error.place)
                    .and_then(ShapeDef::far)
                    .unwrap_or_else(|| "leave one of the two out (points count from 0)".to_owned()),
            ),
            Status::BadShape => Some("look at the lengths, the points and the corner radius".to_owned()),
            _ => None,
        };
        self.source.problem(line, self.describe(error)).maybe_hint(hint)
    }

    /// Which boundary has most nodes, of those that the scene gives.
    pub fn largest(&self) -> String {
        match self.given_nodes().max_by_key(|(_, nodes)| *nodes) {
            Some((place, nodes)) if nodes > 0 => format!("most nodes has {}: {nodes}", self.name_of(place)),
            _ => "give boundaries fewer nodes, or the scene fewer boundaries".to_owned(),
        }
    }

    /// What helps where the nodes of a place do not: those that it would get if the scene gave none at all, since a neighbour's may be
    /// what is missing.
    fn more_nodes(&self, place: Place) -> String {
        let go_on = "`allow_unresolved = true` in [run] goes on all the same";
        if !self.gives_nodes() {
            return format!(
                "it takes more nodes than are chosen automatically: give it more, or a simpler outline; {go_on}"
            );
        }
        let mut scene = self.clone();
        scene.bodies.iter_mut().flat_map(|b| &mut b.links).for_each(|l| l.nodes = 0);
        scene.obstacles.iter_mut().chain(&mut scene.tank).for_each(|w| w.nodes = 0);
        match scene.with_core(|core| ModelBuf::new(core)).ok().and_then(|m| m.view().nodes(place)) {
            Some(nodes) => format!("without any `nodes` in the scene it gets {nodes}; {go_on}"),
            None => format!("leave `nodes` out, and it gets as many as it needs; {go_on}"),
        }
    }
}
