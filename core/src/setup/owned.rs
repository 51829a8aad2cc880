//! Models and simulations that own their memory (feature `alloc`).

use crate::base::memory::filled;
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::model::boundary::BoundaryRecord;
use crate::model::{CoordinateRecord, LinkRecord, Model, ModelHead};
use crate::scene::Description;
use crate::setup::automatic_nodes::{MOST_CHECKED, Resolved, automatic, target};
use crate::setup::compile::ModelMemory;
use crate::setup::items::shapes;
use crate::simulation::sim::{Sim, SimHead};
use crate::simulation::state::Method;
use alloc::{sync::Arc, vec::Vec};

/// A compiled scene that owns its memory. `Send + Sync`.
#[derive(Clone, Debug)]
pub struct ModelBuf<R> {
    head: ModelHead<R>,
    links: Vec<LinkRecord<R>>,
    coordinates: Vec<CoordinateRecord<R>>,
    boundaries: Vec<BoundaryRecord<R>>,
    reals: Vec<R>,
}

impl<R: Real> ModelBuf<R> {
    /// Compiles a scene; automatic node counts are those that its start needs (see [`Resolved::of`]).
    ///
    /// # Errors
    /// As [`Model::init`]; `OutOfMemory` with the bytes.
    pub fn new(scene: &impl Description<R>) -> Result<Self> {
        let mut model = match Resolved::tried(scene)? {
            (_, Some(tried)) => tried,
            (resolved, None) => ModelBuf::compiled(&resolved)?,
        };
        let ModelBuf { links, coordinates, boundaries, reals, .. } = &mut model;
        ModelMemory { links, coordinates, boundaries, reals }.look_at_points(scene)?;
        Ok(model)
    }

    /// Compiles a scene with the counts that its description gives.
    fn compiled(scene: &impl Description<R>) -> Result<Self> {
        let need = Model::requirement(scene)?;
        let (mut links, mut coordinates) = (filled(need.links)?, filled(need.coordinates)?);
        let (mut boundaries, mut reals) = (filled(need.boundaries)?, filled(need.reals)?);
        let mut memory = ModelMemory {
            links: &mut links,
            coordinates: &mut coordinates,
            boundaries: &mut boundaries,
            reals: &mut reals,
        };
        let head = Model::init(scene, &mut memory)?;
        Ok(ModelBuf { head, links, coordinates, boundaries, reals })
    }

    /// The model's view.
    pub fn view(&self) -> Model<'_, R> {
        Model::view(&self.head, &self.links, &self.coordinates, &self.boundaries, &self.reals)
    }
}

impl<R: Real> ModelMemory<'_, R> {
    /// Finds out how well the points of curves tell them, in the memory of a model of this scene: see
    /// [`Model::outline_error`] and the notice `OutlineUncertain`. [`ModelBuf::new`] does so itself.
    ///
    /// # Errors
    /// As [`Shape::outline_error`](crate::scene::Shape::outline_error).
    pub fn look_at_points(&mut self, scene: &impl Description<R>) -> Result<()> {
        for (i, (place, shape)) in shapes(scene).enumerate() {
            let known = shapes(scene).take(i).position(|(_, other)| other == shape);
            let error = match known.and_then(|twin| self.boundaries.get(twin)) {
                Some(twin) => twin.outline_error,
                None => shape.outline_error().map_err(|e| e.at(place))?.unwrap_or(R::NAN),
            };
            if let Some(record) = self.boundaries.get_mut(i) {
                record.outline_error = error;
            }
        }
        Ok(())
    }
}

impl<'s, S> Resolved<'s, S> {
    /// Compares the bound of the error at the start of a scene with its tolerance: automatic node counts that do not meet it are raised
    /// up to four times, as long as that helps, and those kept that come nearest. Costs a model and an evaluation for each attempt, and
    /// nothing if no count is automatic. No attempt has more than [`MOST_CHECKED`](crate::MOST_CHECKED) nodes in all: beyond, the rule stands unchecked, and what
    /// a simulation tells of its bound.
    ///
    /// # Errors
    /// As [`Model::init`].
    pub fn of<R: Real>(scene: &'s S) -> Result<Self>
    where
        S: Description<R>,
    {
        Ok(Self::tried(scene)?.0)
    }

    /// The same with its model, if that was made.
    fn tried<R: Real>(scene: &'s S) -> Result<(Self, Option<ModelBuf<R>>)>
    where
        S: Description<R>,
    {
        let mut best = (Resolved::by_rule(scene), None);
        if !automatic(scene) {
            return Ok(best);
        }
        let asked = target(scene.settings().tolerance);
        let (mut least, mut in_vain, mut likely) = (R::MAX, 0, 1.0);
        for factor in [1.0, 1.25, 1.5, 2.0, 3.0, 4.0] {
            if factor < likely {
                continue;
            }
            let attempt = Resolved { scene, factor };
            if attempt.total() > MOST_CHECKED {
                break;
            }
            let model = Arc::new(ModelBuf::compiled(&attempt)?);
            // What keeps a simulation from starting is told when one is made.
            let error = SimBuf::new(model.clone(), Method::Rk4 { step: R::one() })
                .and_then(|mut sim| sim.view().resolution())
                .map_or(R::zero(), |r| r.bound());
            // What more nodes do not halve is rounding, or takes more than there may be.
            in_vain = if error > R::HALF * least { in_vain + 1 } else { 0 };
            if error < least {
                // The simulation that shared it is gone.
                (best, least) = ((attempt, Arc::into_inner(model)), error);
            }
            if least <= asked || in_vain == 2 {
                break;
            }
            // The bound, a hundred times what is seen, falls exponentially with the nodes: much fewer than so many would not do.
            let digits = |bound: R| Real::ln((bound.to_f64() * 1e-2).clamp(f64::MIN_POSITIVE, 0.1));
            likely = (0.9 * factor * digits(asked) / digits(error)).min(4.0);
        }
        Ok(best)
    }
}

/// A simulation that owns its memory and shares its model. `Send`.
#[derive(Clone, Debug)]
pub struct SimBuf<R> {
    model: Arc<ModelBuf<R>>,
    head: SimHead<R>,
    reals: Vec<R>,
}

impl<R: Real> SimBuf<R> {
    /// Starts a simulation at time 0 and the scene's initial state.
    ///
    /// # Errors
    /// As [`Sim::head`] and [`Sim::init`]; `OutOfMemory` with the bytes.
    pub fn new(model: Arc<ModelBuf<R>>, method: Method<R>) -> Result<Self> {
        let mut head = Sim::head(method)?;
        let mut reals = filled(Sim::requirement(&model.view())?.reals)?;
        Sim::init(model.view(), &mut head, &mut reals)?;
        Ok(SimBuf { model, head, reals })
    }

    /// All that the simulation remembers, as bytes (see [`Sim::save`]).
    ///
    /// # Errors
    /// As [`Sim::save`].
    pub fn save(&mut self) -> Result<Vec<u8>> {
        let sim = self.view();
        let mut bytes = filled(sim.save_len())?;
        sim.save(&mut bytes)?;
        Ok(bytes)
    }

    /// Makes the simulation what was saved (see [`Sim::load`]).
    ///
    /// # Errors
    /// As [`Sim::load`].
    pub fn load(&mut self, bytes: &[u8]) -> Result<()> {
        self.view().load(bytes)
    }

    /// The simulation's view, through which everything is done. O(1).
    #[allow(clippy::expect_used)] // the memory was sized for this model when it was made
    pub fn view(&mut self) -> Sim<'_, R> {
        Sim::view(self.model.view(), &mut self.head, &mut self.reals).expect("memory of the required length")
    }
}
