//! From a scene file to a model and a simulation of the core, with the orders of links and joints between them.

mod sketch;

use std::path::Path;
use std::sync::Arc;

use nekton::status::{Error, Place, Status};

use crate::scene_file::words::percent;
use crate::scene_file::{Integrator, Problem, SceneFile};
use crate::trade::{Choice, Variant, counts, method, unit};
use crate::waiting::Waiting;
use nekton::{Model, ModelBuf, Plan, Resolved, Sim, SimBuf};
use sketch::Dry;

/// A scene with its model.
pub struct Setup {
    /// The scene as written.
    pub scene: SceneFile,
    /// The scene compiled.
    pub model: Arc<ModelBuf<f64>>,
    /// For every link in the user's order, its index in the core.
    pub links: Vec<usize>,
    /// For every joint in the user's order, its index in the core and the index of its link in the user's order.
    pub joints: Vec<(usize, usize)>,
}

/// Refuses to take more memory than there is: taken all the same, it would end the process, or another one.
fn afford(scene: &SceneFile, reals: usize) -> Result<(), Problem> {
    let bytes = reals.saturating_mul(size_of::<f64>());
    let told = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let available = told
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:")?.trim().strip_suffix("kB")?.trim().parse().ok());
    match available.map(|kib: usize| kib.saturating_mul(1024)) {
        Some(available) if bytes > available => {
            let text = format!("takes {bytes} bytes of memory, and {available} are available");
            Err(Problem::file(scene.path(), text).hint(scene.largest()))
        }
        _ => Ok(()),
    }
}

impl Setup {
    /// Reads and compiles a scene.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        Self::of(SceneFile::open(path)?)
    }

    /// Reads a scene, and compiles what takes no matrices: a model without fluid, for its outlines and nodes, those of the rule where they
    /// are automatic; with it the plan of the scene's own.
    pub fn sketch(path: &Path) -> Result<(Self, Plan), Problem> {
        let scene = SceneFile::open(path)?;
        let made = scene.with_core(|core| {
            let ruled = Resolved::by_rule(core);
            Ok((Model::planned(&ruled)?, ModelBuf::new(&Dry(&ruled))?))
        });
        let (plan, model) = made.map_err(|e| scene.problem(&e))?;
        Ok((Self::with(scene, model), plan))
    }

    /// Compiles a scene.
    pub fn of(scene: SceneFile) -> Result<Self, Problem> {
        let _told = Waiting::new("setting up");
        let need = scene.with_core(|core| Model::requirement(core)).map_err(|e| scene.problem(&e))?;
        afford(&scene, need.reals)?;
        let model = scene.with_core(|core| ModelBuf::new(core)).map_err(|e| scene.problem(&e))?;
        Ok(Self::with(scene, model))
    }

    fn with(scene: SceneFile, model: ModelBuf<f64>) -> Self {
        let view = model.view();
        let links = scene.core_order();
        let places: Vec<Option<Place>> = (0..view.link_count()).map(|i| view.link(i).map(|l| l.place)).collect();
        let mut joints: Vec<(usize, usize)> = (0..view.joint_count())
            .filter_map(|j| {
                let place = view.joint(j)?.place;
                let user = links.iter().position(|core| places.get(*core) == Some(&Some(place)))?;
                Some((j, user))
            })
            .collect();
        joints.sort_by_key(|(_, user)| *user);
        Setup { model: Arc::new(model), links, joints, scene }
    }

    /// Compiles the scene anew with another setting.
    pub fn remake(&mut self, choice: &Choice) -> Result<(), Problem> {
        let _told = Waiting::new("setting up");
        let Choice { setting, scale, .. } = choice;
        let counts = counts(&self.model.view());
        let (force, quadrature) = (setting.force, setting.quadrature);
        let model = self
            .scene
            .with_core(|base| ModelBuf::new(&Variant { base, counts: &counts, scale: *scale, force, quadrature }));
        self.model = Arc::new(model.map_err(|e| self.problem(&e))?);
        Ok(())
    }

    /// Starts a simulation.
    pub fn simulate(&self, integrator: Integrator) -> Result<SimBuf<f64>, Problem> {
        let _told = Waiting::new("evaluating the start");
        afford(&self.scene, Sim::requirement(&self.model.view()).map_err(|e| self.problem(&e))?.reals)?;
        SimBuf::new(self.model.clone(), method(integrator, unit(&self.model.view()))).map_err(|e| self.problem(&e))
    }

    /// An error of the core as a complaint about the scene file.
    pub fn problem(&self, error: &Error) -> Problem {
        self.scene.problem(error)
    }

    /// Every boundary with its nodes.
    pub fn nodes(&self) -> Vec<String> {
        self.counts(|_| "")
    }

    /// The same, with a word before each of them.
    pub fn counts(&self, word: impl Fn(Place) -> &'static str) -> Vec<String> {
        let view = self.model.view();
        let labels = self.scene.labels();
        let links = self.links.iter().zip(labels).filter_map(|(core, label)| Some((label, view.link(*core)?.place)));
        let obstacles = (0..self.scene.obstacles.len()).map(Place::Obstacle);
        let walls = self.scene.tank.iter().map(|_| Place::Tank).chain(obstacles);
        let walls = walls.map(|place| (self.scene.name_of(place).trim_start_matches("the ").to_owned(), place));
        links
            .chain(walls)
            .filter_map(|(name, place)| Some(format!("{name} {}{}", word(place), view.nodes(place)?)))
            .collect()
    }

    /// What there is to say of a bound of the error in space.
    pub fn unresolved(&self, bound: f64) -> Option<String> {
        let asked = self.model.view().plan().tolerance;
        (bound > asked).then(|| {
            let help = if self.scene.gives_nodes() {
                "give boundaries more nodes, or none, and they get what they need"
            } else {
                "give boundaries more nodes, or simpler outlines"
            };
            format!("the error in space may be as large as {bound:.1e}, asked {asked:.1e}: {help}")
        })
    }

    /// Whose outlines are given by points, what was read of them, and how well these tell them.
    pub fn outlines(&self) -> Vec<(String, String)> {
        let line = |(whose, place, told): (String, Place, Option<String>)| {
            let known = self.outline_error(place).map(|e| format!("its points tell it to about {}", percent(e)));
            let all: Vec<String> = told.into_iter().chain(known).collect();
            (!all.is_empty()).then(|| (whose, all.join("; ")))
        };
        self.scene.outlines().filter_map(line).collect()
    }

    /// How well points tell an outline: the core's estimate, or what smoothing may have changed if that is more.
    fn outline_error(&self, place: Place) -> Option<f64> {
        let known = self.model.view().outline_error(place)?;
        Some(self.scene.smoothing(place).map_or(known, |smoothing| known.max(smoothing)))
    }

    /// The estimated errors of outlines given by points, with whose they are.
    pub fn outline_errors(&self) -> impl Iterator<Item = (String, f64)> {
        self.scene.outlines().filter_map(move |(whose, place, _)| Some((whose, self.outline_error(place)?)))
    }

    /// What set-up mended, and what the user should know of tables and channels.
    pub fn notices(&self) -> Vec<String> {
        let view = self.model.view();
        let mended = view.notices().map(|(place, status)| {
            let name = self.scene.name_of(place);
            match status {
                Status::CornersFound => format!("{name}: {}", self.scene.corners_found(place)),
                Status::OutlineUncertain => {
                    let error = view.outline_error(place).unwrap_or(f64::NAN);
                    format!("{name}: {}", self.scene.uncertain(place, error))
                }
                other => format!("{name}: {}", other.text()),
            }
        });
        let asked = view.plan().tolerance;
        let smoothed = self.scene.outlines().filter_map(|(whose, place, _)| {
            let error = self.scene.smoothing(place).filter(|e| *e > asked)?;
            Some(format!(
                "{whose}: smoothing may have changed its added mass by up to about {}, which no bound contains: less where its points scatter \
                 independently, as much where they are rounded or `smooth` is more than their scatter takes",
                percent(error)
            ))
        });
        mended.chain(smoothed).chain(self.scene.notices()).collect()
    }
}
