//! From a scene to a model: the set-up that happens once.
//!
//! Tested by `tests/allocation`, `tests/ingredients`.

use crate::base::features;
use crate::base::memory::{part, part_mut};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::model::boundary::BoundaryRecord;
use crate::model::plan::Plan;
use crate::model::{Control, CoordinateRecord, Formulation, LinkRecord, Model, ModelHead, NearDims};
use crate::scene::{CirculationModel, Description, each_link, motions, wall_count};
use crate::setup::fingerprint::fingerprint;
use crate::setup::items::items;
use crate::setup::layout::{Layout, lay_out};
use crate::setup::records::{build_boundaries, build_coordinates, build_links, fill_wall_cores, grade_walls};
use crate::setup::traits::Traits;
use crate::setup::validate::validate;

/// Lengths of a model's four arrays.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct ModelRequirement {
    /// Number of link records.
    pub links: usize,
    /// Number of coordinate records.
    pub coordinates: usize,
    /// Number of boundary records.
    pub boundaries: usize,
    /// Number of reals.
    pub reals: usize,
}

/// A model's memory, given by the caller.
#[derive(Debug)]
pub struct ModelMemory<'a, R> {
    /// At least `ModelRequirement::links`.
    pub links: &'a mut [LinkRecord<R>],
    /// At least `ModelRequirement::coordinates`.
    pub coordinates: &'a mut [CoordinateRecord<R>],
    /// At least `ModelRequirement::boundaries`.
    pub boundaries: &'a mut [BoundaryRecord<R>],
    /// At least `ModelRequirement::reals`.
    pub reals: &'a mut [R],
}

impl<'a, R: Real> Model<'a, R> {
    /// Memory needed for a scene. Checks everything that can be checked without building shapes.
    ///
    /// # Errors
    /// Any of the set-up errors of [`Status`], with the place in the scene.
    pub fn requirement(scene: &impl Description<R>) -> Result<ModelRequirement> {
        validate(scene)?;
        let layout = lay_out(scene, &Traits::of(scene), |_, _, _| ())?;
        Ok(ModelRequirement {
            links: each_link(scene).count(),
            coordinates: motions(scene).count(),
            boundaries: items(scene).count(),
            reals: layout.reals,
        })
    }

    /// The plan of a scene's model without the model: automatic node counts are those of the rule, which [`ModelBuf::new`](crate::ModelBuf::new)
    /// raises where the start needs more. O(points) and O(bodies), or O(bodies²) where many differ; neither matrices nor outlines are made, nor
    /// are outlines checked.
    ///
    /// # Errors
    /// As [`Model::requirement`], and errors of signals; `OutOfMemory`.
    #[cfg(feature = "alloc")]
    pub fn planned(scene: &impl Description<R>) -> Result<Plan> {
        use crate::base::memory::filled;
        let need = Self::requirement(scene)?;
        let traits = Traits::of(scene);
        let layout = lay_out(scene, &traits, |_, _, _| ())?;
        let mut coordinates = filled(need.coordinates)?;
        let signals = motions(scene).fold(0_usize, |sum, signal| sum.saturating_add(signal.store_len()));
        let channels = build_coordinates(scene, &mut coordinates, &mut filled::<R>(signals)?, 0)?;
        Ok(head(scene, &traits, &layout, &coordinates, channels).plan)
    }

    /// Compiles a scene into the caller's memory. O(N³) once for shapes other than ellipses, else O(N²).
    ///
    /// # Errors
    /// As [`Model::requirement`], and shape errors; the memory's content is then of no use, nothing else is touched.
    pub fn init(scene: &impl Description<R>, memory: &mut ModelMemory<'_, R>) -> Result<ModelHead<R>> {
        let need = Self::requirement(scene)?;
        let given = [memory.links.len(), memory.coordinates.len(), memory.boundaries.len(), memory.reals.len()];
        for (given, need) in given.into_iter().zip([need.links, need.coordinates, need.boundaries, need.reals]) {
            if given < need {
                return Err(Error::new(Status::MemoryTooSmall).of("length", given as f64));
            }
        }
        let traits = Traits::of(scene);
        let layout = lay_out(scene, &traits, |i, first, slots| {
            if let Some(b) = memory.boundaries.get_mut(i) {
                *b = BoundaryRecord { first, slots, ..BoundaryRecord::default() };
            }
        })?;
        let store = &mut *memory.reals;
        let (store, scratch) = store.split_at_mut_checked(layout.scratch_at).ok_or(Status::MemoryTooSmall)?;
        build_boundaries(scene, &traits, memory.boundaries, store, scratch)?;
        build_links(scene, memory.links, memory.boundaries)?;
        let channels = build_coordinates(scene, memory.coordinates, store, layout.signals_at)?;
        let mut head =
            head(scene, &traits, &layout, memory.coordinates.get(..need.coordinates).unwrap_or(&[]), channels);
        if features::NEAR && layout.close_range_len > 0 {
            let tables = part_mut(store, layout.close_range_at, layout.close_range_len);
            crate::dynamics::forces::close_range::fill_tables(tables, scratch)?;
        }
        if features::NEAR && traits.graded && head.plan.walls > 1 {
            let walls = memory.boundaries.get_mut(..head.plan.walls).unwrap_or(&mut []);
            grade_walls(walls, store, scratch)?;
        }
        if traits.fluid {
            let walls = memory.boundaries.get_mut(..head.plan.walls).unwrap_or(&mut []);
            fill_wall_cores(walls, store, scratch)?;
            crate::fluid::assembly::fill_walls(walls, &head, traits.circulation, store);
        }
        if traits.formulation == Formulation::Kirchhoff
            && let (Some(boundary), Some(link)) = (memory.boundaries.first(), memory.links.first())
        {
            (head.lone_added_mass, head.lone_impulse, head.lone_resolution) =
                crate::dynamics::kirchhoff::constants(boundary, store, scratch, traits.circulation)?;
            head.lone_inverse =
                crate::dynamics::kirchhoff::inverse_mass(&head.lone_added_mass, head.fluid_density, link);
        }
        Ok(head)
    }

    /// The view of a model in memory that [`Model::init`] filled (what the arrays hold beyond the requirement is ignored).
    pub fn view(
        head: &'a ModelHead<R>,
        links: &'a [LinkRecord<R>],
        coordinates: &'a [CoordinateRecord<R>],
        boundaries: &'a [BoundaryRecord<R>],
        store: &'a [R],
    ) -> Self {
        let plan = &head.plan;
        Model {
            head,
            links: part(links, 0, plan.links),
            coordinates: part(coordinates, 0, plan.free_coordinates + plan.prescribed_coordinates),
            boundaries: part(boundaries, 0, plan.walls + plan.links),
            store,
        }
    }
}
fn head<R: Real, S: Description<R>>(
    scene: &S,
    traits: &Traits,
    layout: &Layout,
    coordinates: &[CoordinateRecord<R>],
    channels: usize,
) -> ModelHead<R> {
    let free = coordinates.iter().filter(|c| c.control != Control::Prescribed).count();
    let prescribed_moves = coordinates.iter().any(|c| c.control == Control::Prescribed && !c.constant);
    let tracks_work = prescribed_moves || coordinates.iter().any(|c| c.control == Control::Torque);
    let motion = if traits.formulation == Formulation::LockedMomentum { 3 } else { 2 * free };
    let settings = scene.settings();
    let walls = wall_count(scene);
    let stepping = traits.fluid && traits.formulation != Formulation::Kirchhoff;
    let unknowns = if stepping { layout.unknowns } else { 0 };
    // Columns of the boundary system; for the force the adjoint and one solve for each half of the symmetrized added mass,
    // none for a lone swimmer whose work nobody drives, two more where the power of prescribed motion is tracked; for
    // circulation its potential, its adjoint and the rate of its potential.
    let forces = match traits.formulation {
        Formulation::LockedMomentum if !tracks_work => 0,
        _ => 3 + if prescribed_moves { 2 } else { 0 },
    };
    let columns = free + usize::from(prescribed_moves);
    let circulation =
        if traits.circulation { 2 + usize::from(settings.circulation == CirculationModel::Full) } else { 0 };
    let mut plan = Plan {
        formulation: traits.formulation,
        links: each_link(scene).count(),
        walls,
        unknowns,
        moving_unknowns: if stepping { layout.unknowns - layout.wall_nodes } else { 0 },
        right_hand_sides: if stepping { columns + forces + circulation } else { 0 },
        free_coordinates: free,
        prescribed_coordinates: coordinates.len() - free,
        state_len: motion + usize::from(tracks_work),
        fluid: traits.fluid,
        gravity: settings.gravity != R::zero(),
        repulsion: settings.repulsion.is_some_and(|r| r.epsilon != R::zero()),
        circulation: traits.circulation,
        tolerance: crate::setup::automatic_nodes::noticed(settings.tolerance).to_f64(),
        model_bytes: layout.reals.saturating_mul(size_of::<R>()),
        ..Plan::default()
    };
    plan.operations = plan.count_operations(layout.unknowns);
    let mut head = ModelHead {
        fingerprint: fingerprint(scene),
        fluid_density: settings.fluid_density,
        gravity: settings.gravity,
        repulsion: settings.repulsion.filter(|r| r.epsilon != R::zero()),
        gyroscopic: traits.circulation && settings.circulation == CirculationModel::Full,
        force: settings.force,
        tolerance: crate::setup::automatic_nodes::noticed(settings.tolerance),
        allow_unresolved: settings.allow_unresolved,
        wall_nodes: layout.wall_nodes,
        walls_at: layout.walls_at,
        walls_regular_at: layout.walls_regular_at,
        channels,
        near: NearDims {
            nodes: if traits.graded { layout.unknowns } else { 0 },
            rungs: if traits.graded { layout.rungs } else { 0 },
        },
        close_range_at: layout.close_range_at,
        close_range_len: layout.close_range_len,
        tracks_work,
        prescribed_moves,
        lone_added_mass: [R::zero(); 9],
        lone_impulse: [R::zero(); 3],
        lone_inverse: [R::zero(); 9],
        lone_resolution: [R::zero(); 2],
        plan,
    };
    head.plan.sim_bytes = crate::simulation::sim::SimRequirement::of(&head, coordinates.len())
        .map_or(usize::MAX, |r| r.reals.saturating_mul(size_of::<R>()));
    head
}
