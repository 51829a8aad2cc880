//! One way to compute a scene: what can be traded for speed.

use nekton::scalar::Real;
use nekton::scene::{Body, Description, ForceFormula, Link, Quadrature, Scene, Wall};
use nekton::status::Place;
use nekton::{Method, Model};

use crate::scene_file::Integrator;

/// Everything that decides how exact and how costly a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Quadrature of boundary integrals.
    pub quadrature: Quadrature,
    /// Formula of the Christoffel force.
    pub force: ForceFormula,
    /// `f32` instead of `f64`.
    pub single: bool,
    /// Integrator with its step or tolerance.
    pub integrator: Integrator,
    /// Nodes of the link that has most; all other boundaries in proportion.
    pub nodes: usize,
}

impl Setting {
    /// The names under which it stands in tables.
    pub fn names(&self) -> [&'static str; 4] {
        [
            match self.quadrature {
                Quadrature::Graded => "graded",
                Quadrature::Plain => "plain",
            },
            match self.force {
                ForceFormula::ExactGradient => "exact",
                ForceFormula::Boundary => "boundary",
            },
            if self.single { "f32" } else { "f64" },
            method_name(self.integrator),
        ]
    }
}

/// Name of an integrator, as in scene files.
pub fn method_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Rk4 { .. } => "rk4",
        Integrator::Abm4 { .. } => "abm4",
        Integrator::Gauss6 { .. } => "gauss6",
        Integrator::Adams { .. } => "adams",
    }
}

/// Step or tolerance of an integrator.
pub fn parameter(integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Rk4 { step } | Integrator::Abm4 { step } | Integrator::Gauss6 { step } => step,
        Integrator::Adams { tolerance, .. } => tolerance,
    }
}

/// The integrator of a name.
pub fn integrator(name: &str, value: f64) -> Option<Integrator> {
    Some(match name {
        "rk4" => Integrator::Rk4 { step: value },
        "abm4" => Integrator::Abm4 { step: value },
        "gauss6" => Integrator::Gauss6 { step: value },
        "adams" => Integrator::adams(value),
        _ => return None,
    })
}

/// What the absolute tolerance is a part of: 1, or the mean diameter of the smallest link if that is less (m). Otherwise a body
/// of a micrometre would be lost in a tolerance that suits one of a metre.
pub fn unit<R: Real>(model: &Model<'_, R>) -> f64 {
    let links = (0..model.link_count()).filter_map(|i| model.link(i));
    links.map(|l| l.perimeter.to_f64() / std::f64::consts::PI).fold(1.0, f64::min)
}

/// The core's method; `unit` as the function of that name has it.
pub fn method<R: Real>(integrator: Integrator, unit: f64) -> Method<R> {
    match integrator {
        Integrator::Rk4 { step } => Method::Rk4 { step: R::lit(step) },
        Integrator::Abm4 { step } => Method::Abm4 { step: R::lit(step) },
        Integrator::Gauss6 { step } => Method::Gauss6 { step: R::lit(step) },
        Integrator::Adams { tolerance, max_step, first_step } => Method::Adams {
            relative: R::lit(tolerance),
            absolute: R::lit(tolerance * unit),
            max_step: R::lit(max_step),
            first_step: R::lit(first_step),
        },
    }
}

/// A scene with other nodes, force or quadrature.
pub struct Variant<'a, R> {
    /// The scene.
    pub base: &'a Scene<'a, R>,
    /// Nodes of every boundary with the scene's own setting.
    pub counts: &'a [(Place, usize)],
    /// Factor of all node counts.
    pub scale: f64,
    /// Force.
    pub force: ForceFormula,
    /// Quadrature.
    pub quadrature: Quadrature,
}

/// Nodes of every boundary of a model: what `nodes = "auto"` came to is known only then.
pub fn counts<R: Real>(model: &Model<'_, R>) -> Vec<(Place, usize)> {
    let links = (0..model.link_count()).filter_map(|i| Some(model.link(i)?.place));
    let walls = std::iter::once(Place::Tank).chain((0..model.plan().walls).map(Place::Obstacle));
    links.chain(walls).filter_map(|place| Some((place, model.nodes(place)?))).collect()
}

impl<R> Variant<'_, R> {
    fn nodes(&self, place: Place, given: usize) -> usize {
        let own = self.counts.iter().find(|(p, _)| *p == place).map_or(given, |(_, nodes)| *nodes);
        scaled(own, self.scale)
    }
}

/// An even number of nodes near a multiple of what the scene asks for; at least 8.
pub fn scaled(nodes: usize, scale: f64) -> usize {
    (2 * (0.5 * nodes as f64 * scale).round() as usize).max(8)
}

impl<R: Real> Description<R> for Variant<'_, R> {
    fn settings(&self) -> Scene<'_, R> {
        Scene { force: self.force, quadrature: self.quadrature, ..*self.base }
    }
    fn tank(&self) -> Option<Wall<'_, R>> {
        self.base.tank.map(|w| Wall { nodes: self.nodes(Place::Tank, w.nodes), ..w })
    }
    fn obstacle_count(&self) -> usize {
        self.base.obstacles.len()
    }
    fn obstacle(&self, i: usize) -> Option<Wall<'_, R>> {
        self.base.obstacles.get(i).map(|w| Wall { nodes: self.nodes(Place::Obstacle(i), w.nodes), ..*w })
    }
    fn body_count(&self) -> usize {
        self.base.bodies.len()
    }
    fn body(&self, b: usize) -> Option<Body<'_, R>> {
        self.base.bodies.get(b).copied()
    }
    fn link_count(&self, b: usize) -> usize {
        self.base.link_count(b)
    }
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.base.link(b, l).map(|link| Link { nodes: self.nodes(Place::Link(b, l), link.nodes), ..link })
    }
}

/// A number without zeros at its end.
pub fn shown(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}
