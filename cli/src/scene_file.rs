//! Scene files: TOML in, a checked description out, errors with file and line.

mod body;
mod channels;
mod file;
mod outline;
mod range;
mod reader;
mod run;
mod shape;
mod signal;
mod slopes;
mod table;
pub mod words;

use std::path::{Path, PathBuf};

use nekton::scene::{Body, CirculationModel, ForceFormula, Link, Quadrature, Repulsion, Scene, Wall};
use nekton::status::Place;

pub use body::{BodyDef, LinkDef};
pub use reader::Problem;
use reader::{Item, Lines, Outcome, Section, Source};
pub use run::{Integrator, RunDef};
use run::{RUN, read_run};
use shape::{ShapeDef, nodes};

/// A scene with its own data and the lines on which everything stands.
#[derive(Clone, Debug)]
pub struct SceneFile {
    source: Source,
    fluid_density: f64,
    /// Gravitational acceleration along −y.
    pub gravity: f64,
    repulsion: Option<Repulsion<f64>>,
    circulation: CirculationModel,
    /// The tank.
    pub tank: Option<WallDef>,
    /// Fixed obstacles.
    pub obstacles: Vec<WallDef>,
    /// Bodies.
    pub bodies: Vec<BodyDef>,
    force: ForceFormula,
    quadrature: Quadrature,
    tolerance: Option<f64>,
    allow_unresolved: bool,
    shortcuts: bool,
    run: Option<RunDef>,
    lines: Lines,
}

/// A fixed boundary.
#[derive(Clone, Debug)]
pub struct WallDef {
    shape: ShapeDef,
    /// Where the outline's own origin lies.
    pub position: [f64; 2],
    /// Turn about the outline's own origin.
    pub angle: f64,
    nodes: usize,
    circulation: f64,
    lines: Lines,
}

const TOP: &[&str] = &["fluid", "repulsion", "circulation", "tank", "obstacle", "body", "run"];
impl SceneFile {
    /// Reads and checks a scene file.
    pub fn open(path: &Path) -> Outcome<Self> {
        let source = Source::open(path)?;
        let mut scene = read(&source)?;
        scene.source = source;
        Ok(scene)
    }

    /// Puts tables in place of channels: the name of each channel and the path of its table.
    pub fn feed(&mut self, feeds: &[(String, PathBuf)]) -> Outcome<()> {
        channels::feed(&self.source.path, &mut self.bodies, feeds)
    }

    /// Every channel, and what stands for it.
    pub fn channels(&self) -> Vec<(String, String)> {
        let text = |c: &signal::Channel| match &c.feed {
            Some((file, _)) => file.clone(),
            None => format!("{}: no table is given", c.value),
        };
        channels::channels(&self.bodies).map(|c| (format!("channel {}", c.name), text(c))).collect()
    }

    /// What the user should know of tables and channels.
    pub fn notices(&self) -> Vec<String> {
        self.bodies.iter().flat_map(BodyDef::signals).flat_map(signal::SignalDef::notices).collect()
    }

    /// Every outline: whose it is, where the core has it, and what the user is told of points that are not in the scene file
    /// or scatter.
    pub fn outlines(&self) -> impl Iterator<Item = (String, Place, Option<String>)> {
        self.shapes().map(|(whose, place, shape)| (whose, place, shape.told()))
    }

    /// What smoothing may have changed the added mass of a boundary by.
    pub fn smoothing(&self, place: Place) -> Option<f64> {
        self.shape(place).and_then(ShapeDef::smoothing)
    }

    fn shapes(&self) -> impl Iterator<Item = (String, Place, &ShapeDef)> {
        let links = self.bodies.iter().enumerate().flat_map(|(b, body)| {
            let place = move |l| Place::Link(b, body.core_index(l));
            body.links
                .iter()
                .enumerate()
                .map(move |(l, link)| (format!("{}.{}", body.name, link.name), place(l), &link.shape))
        });
        let tank = self.tank.iter().map(|t| ("tank".to_owned(), Place::Tank, &t.shape));
        let walls = self.obstacles.iter().enumerate();
        let walls = walls.map(|(k, o)| (format!("obstacle {}", k + 1), Place::Obstacle(k), &o.shape));
        links.chain(tank).chain(walls)
    }

    fn shape(&self, place: Place) -> Option<&ShapeDef> {
        self.shapes().find(|(_, p, _)| *p == place).map(|(_, _, shape)| shape)
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.source.path
    }

    /// What `nekton run` is to do.
    pub fn run(&self) -> Outcome<&RunDef> {
        self.run.as_ref().ok_or_else(|| {
            Problem::file(self.path(), "there is no [run] section").hint("add [run] with duration = … (s)")
        })
    }

    /// Hands the scene in the core's own terms to a function.
    pub fn with_core<T>(&self, f: impl FnOnce(&Scene<'_, f64>) -> T) -> T {
        let links: Vec<Vec<Link<'_, f64>>> = self.bodies.iter().map(BodyDef::core_links).collect();
        let bodies: Vec<Body<'_, f64>> = self
            .bodies
            .iter()
            .zip(&links)
            .map(|(b, links)| Body { pose: b.pose, velocity: b.velocity, root: b.core_root(), links })
            .collect();
        let obstacles: Vec<Wall<'_, f64>> = self.obstacles.iter().map(WallDef::core).collect();
        f(&Scene {
            fluid_density: self.fluid_density,
            gravity: self.gravity,
            repulsion: self.repulsion,
            circulation: self.circulation,
            tank: self.tank.as_ref().map(WallDef::core),
            obstacles: &obstacles,
            bodies: &bodies,
            force: self.force,
            quadrature: self.quadrature,
            tolerance: self.tolerance,
            allow_unresolved: self.allow_unresolved,
            shortcuts: self.shortcuts,
        })
    }

    /// Names `body.link` in the user's order.
    pub fn labels(&self) -> Vec<String> {
        self.bodies.iter().flat_map(|b| b.links.iter().map(move |l| format!("{}.{}", b.name, l.name))).collect()
    }

    /// Whether some joint is a slider.
    pub fn has_slider(&self) -> bool {
        self.bodies.iter().flat_map(|b| &b.links).any(|l| l.joint.as_ref().is_some_and(|j| j.is_slider()))
    }

    /// For every link in the user's order, its index in the core's order.
    pub fn core_order(&self) -> Vec<usize> {
        let mut first = 0;
        let mut order = Vec::new();
        for b in &self.bodies {
            order.extend((0..b.links.len()).map(|l| first + b.core_index(l)));
            first += b.links.len();
        }
        order
    }

    /// A place of the core in the user's names.
    pub fn name_of(&self, place: Place) -> String {
        match place {
            Place::Scene => "the scene".to_owned(),
            Place::Tank => "the tank".to_owned(),
            Place::Obstacle(k) => format!("obstacle {}", k + 1),
            Place::Body(b) => match self.bodies.get(b) {
                Some(body) => format!("body `{}`", body.name),
                None => place.to_string(),
            },
            Place::Link(b, l) => match self.link(b, l) {
                Some((body, link)) => format!("link `{}.{}`", body.name, link.name),
                None => place.to_string(),
            },
            other => other.to_string(),
        }
    }

    fn link(&self, body: usize, link: usize) -> Option<(&BodyDef, &LinkDef)> {
        let body = self.bodies.get(body)?;
        Some((body, body.links.get(*body.order.get(link)?)?))
    }
}

impl SceneFile {
    /// Every boundary, as the core places it, with its nodes as given; 0 if automatic.
    fn given_nodes(&self) -> impl Iterator<Item = (Place, usize)> {
        let links = self.bodies.iter().enumerate().flat_map(|(b, body)| {
            let own = body.order.iter().filter_map(|user| body.links.get(*user));
            own.enumerate().map(move |(l, link)| (Place::Link(b, l), link.nodes))
        });
        let obstacles = self.obstacles.iter().enumerate().map(|(k, wall)| (Place::Obstacle(k), wall.nodes));
        let walls = obstacles.chain(self.tank.iter().map(|wall| (Place::Tank, wall.nodes)));
        links.chain(walls)
    }

    /// Whether some boundary's nodes are given.
    pub fn gives_nodes(&self) -> bool {
        self.given_nodes().any(|(_, nodes)| nodes > 0)
    }

    /// Whose nodes are automatic.
    pub fn chosen_nodes(&self) -> Vec<Place> {
        self.given_nodes().filter(|(_, nodes)| *nodes == 0).map(|(place, _)| place).collect()
    }
}

impl WallDef {
    fn read(item: &Item<'_>, title: &str, allowed: &'static [&'static str]) -> Outcome<Self> {
        let section = item.section(title, allowed)?;
        let shape = ShapeDef::read(&section.need("shape")?)?;
        Ok(WallDef {
            position: section.or("position", [0.0; 2], Item::pair)?,
            angle: section.or("angle", 0.0, Item::number)?,
            nodes: nodes(section.get("nodes"))?,
            circulation: section.or("circulation", 0.0, Item::number)?,
            lines: section.lines(&[]),
            shape,
        })
    }
    fn core(&self) -> Wall<'_, f64> {
        Wall {
            shape: self.shape.core(),
            position: self.position,
            angle: self.angle,
            nodes: self.nodes,
            circulation: self.circulation,
        }
    }
}

fn read(source: &Source) -> Outcome<SceneFile> {
    let document = source.parse()?;
    let top = Section::new(source, 1, "the scene", document.get_ref(), TOP)?;
    let (mut density, mut gravity) = (1.0, 0.0);
    if let Some(fluid) = top.get("fluid") {
        let fluid = fluid.section("[fluid]", &["density", "gravity"])?;
        density = fluid.or("density", density, Item::not_negative)?;
        gravity = fluid.or("gravity", gravity, Item::number)?;
    }
    let mut repulsion = None;
    if let Some(item) = top.get("repulsion") {
        let section = item.section("[repulsion]", &["alpha", "epsilon"])?;
        repulsion = Some(Repulsion {
            alpha: section.or("alpha", 4.0, Item::positive)?,
            epsilon: section.or("epsilon", 0.01, Item::not_negative)?,
        });
    }
    let mut circulation = CirculationModel::Full;
    if let Some(item) = top.get("circulation") {
        let section = item.section("[circulation]", &["model"])?;
        if section.or("model", "full", |m| m.word(&["full", "paper"]))? == "paper" {
            circulation = CirculationModel::Paper;
        }
    }
    let tank = top.get("tank").map(|t| WallDef::read(&t, "[tank]", &["shape", "position", "angle", "nodes"]));
    let mut obstacles = Vec::new();
    for (k, item) in top.or("obstacle", Vec::new(), Item::list)?.iter().enumerate() {
        let title = format!("[[obstacle]] {}", k + 1);
        obstacles.push(WallDef::read(item, &title, &["shape", "position", "angle", "nodes", "circulation"])?);
    }
    let mut bodies: Vec<BodyDef> = Vec::new();
    for (k, item) in top.or("body", Vec::new(), Item::list)?.iter().enumerate() {
        let body = BodyDef::read(item, k + 1, &bodies)?;
        bodies.push(body);
    }
    if bodies.is_empty() {
        return Err(
            Problem::file(&source.path, "the scene has no body").hint("add [[body]] with one or more [[body.link]]")
        );
    }
    channels::refuse_duplicates(source, &bodies)?;
    let run = top.get("run").map(|r| r.section("[run]", RUN)).transpose()?;
    let mut force = ForceFormula::ExactGradient;
    let mut quadrature = Quadrature::Graded;
    let mut tolerance = None;
    let (mut shortcuts, mut allow_unresolved) = (true, false);
    if let Some(section) = &run {
        if section.or("force", "exact", |m| m.word(&["exact", "boundary"]))? == "boundary" {
            force = ForceFormula::Boundary;
        }
        if section.or("quadrature", "graded", |m| m.word(&["graded", "plain"]))? == "plain" {
            quadrature = Quadrature::Plain;
        }
        tolerance = section.get("tolerance").map(|t| t.positive()).transpose()?;
        shortcuts = section.or("shortcuts", true, Item::flag)?;
        allow_unresolved = section.or("allow_unresolved", false, Item::flag)?;
    }
    Ok(SceneFile {
        source: Source::empty(),
        fluid_density: density,
        gravity,
        repulsion,
        circulation,
        tank: tank.transpose()?,
        obstacles,
        bodies,
        force,
        quadrature,
        tolerance,
        allow_unresolved,
        shortcuts,
        run: run.as_ref().map(read_run).transpose()?,
        lines: top.lines(&["body", "obstacle", "tank"]),
    })
}
