//! From a scene to a model: validation, layout of the store, and the set-up that happens once.

use crate::boundary::BoundaryRecord;
use crate::build::{build_boundaries, build_coordinates, build_links};
use crate::model::{Control, CoordinateRecord, Formulation, LinkRecord, Model, ModelHead};
use crate::plan::Plan;
use crate::scalar::Real;
use crate::scene::{CirculationModel, Description, Drive, Link, Mass, Root, Shape, Signal};
use crate::se2::Pose;
use crate::status::{Error, Place, Result, Status};
use crate::validate::validate;

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

/// One boundary as the scene gives it.
#[derive(Clone, Copy)]
pub(crate) struct Item<'a, R> {
    pub(crate) place: Place,
    pub(crate) link: Option<usize>,
    pub(crate) shape: Shape<'a, R>,
    pub(crate) nodes: usize,
    /// Centre of mass from the centroid; `None` for walls (frame = drawing frame).
    pub(crate) centre: Option<[R; 2]>,
    pub(crate) circulation: R,
    pub(crate) pose: Pose<R>,
}

pub(crate) fn items<'a, R: Real, S: Description<R>>(scene: &'a S) -> impl Iterator<Item = Item<'a, R>> + Clone {
    let wall = |place, w: crate::scene::Wall<'a, R>| Item {
        place,
        link: None,
        shape: w.shape,
        nodes: w.nodes,
        centre: None,
        circulation: w.circulation,
        pose: Pose::new(w.position[0], w.position[1], w.angle),
    };
    let tank = scene.tank().into_iter().map(move |w| wall(Place::Tank, w));
    let obstacles = (0..scene.obstacle_count()).filter_map(move |i| Some(wall(Place::Obstacle(i), scene.obstacle(i)?)));
    let links = each_link(scene).enumerate().map(|(i, (b, l, link))| Item {
        place: Place::Link(b, l),
        link: Some(i),
        shape: link.shape,
        nodes: link.nodes,
        centre: Some(match link.mass {
            Mass::Density(_) => [R::zero(); 2],
            Mass::Given { centre_of_mass, .. } => centre_of_mass,
        }),
        circulation: link.circulation,
        pose: Pose::default(),
    });
    tank.chain(obstacles).chain(links)
}

/// Every link with its body and place in the body.
pub(crate) fn each_link<'a, R: Real, S: Description<R>>(
    scene: &'a S,
) -> impl Iterator<Item = (usize, usize, Link<'a, R>)> + Clone {
    (0..scene.body_count())
        .flat_map(move |b| (0..scene.link_count(b)).filter_map(move |l| Some((b, l, scene.link(b, l)?))))
}

/// The signal of every coordinate, in their order.
fn motions<'a, R: Real, S: Description<R>>(scene: &'a S) -> impl Iterator<Item = Signal<'a, R>> + Clone {
    (0..scene.body_count()).filter_map(move |b| Some((b, scene.body(b)?))).flat_map(move |(b, body)| {
        let root = match body.root {
            Root::Prescribed(signals) => signals,
            Root::Free => [Signal::Constant(R::zero()); 3],
        };
        let joints = (0..scene.link_count(b)).filter_map(move |l| scene.link(b, l)?.joint);
        root.into_iter().chain(joints.map(|j| match j.drive {
            Drive::Locked(value) => Signal::Constant(value),
            Drive::Motion(signal) => signal,
            Drive::Torque { torque, .. } => torque,
        }))
    })
}

/// Number of fixed boundaries.
pub(crate) fn wall_count<R: Real, S: Description<R>>(scene: &S) -> usize {
    scene.obstacle_count() + usize::from(scene.tank().is_some())
}

/// Offsets into the store of one boundary.
#[derive(Clone, Copy, Default)]
struct Slots {
    store_at: usize,
    store_len: usize,
    data_at: usize,
    self_at: usize,
    regular_at: usize,
    first: usize,
    shared: Option<usize>,
}

/// Offsets of everything else, and the total.
#[derive(Clone, Copy, Default)]
struct Layout {
    walls_at: usize,
    walls_regular_at: usize,
    signals_at: usize,
    scratch_at: usize,
    scratch_len: usize,
    reals: usize,
    wall_nodes: usize,
    unknowns: usize,
}

fn sum(a: usize, b: usize) -> Result<usize> {
    a.checked_add(b).ok_or(Status::SizeOverflow.into())
}

fn square(n: usize) -> Result<usize> {
    n.checked_mul(n).ok_or(Status::SizeOverflow.into())
}

/// The layout: the same lines count and place. `slot` sees each boundary's offsets in order.
fn lay_out<R: Real, S: Description<R>>(
    scene: &S,
    traits: &Traits,
    mut slot: impl FnMut(usize, Slots),
) -> Result<Layout> {
    let (mut layout, mut at, mut scratch) = (Layout::default(), 0, 0);
    let fluid = traits.fluid;
    let general = fluid && traits.formulation != Formulation::Kirchhoff;
    for (i, item) in items(scene).enumerate() {
        let same = |j: &(usize, Item<'_, R>)| {
            j.1.link.is_some()
                && item.link.is_some()
                && j.1.shape == item.shape
                && j.1.nodes == item.nodes
                && j.1.centre == item.centre
        };
        let mut s = Slots { first: layout.unknowns, ..Slots::default() };
        s.shared = items(scene).enumerate().take(i).find(same).map(|(j, _)| j);
        layout.unknowns = sum(layout.unknowns, item.nodes)?;
        if item.link.is_none() {
            layout.wall_nodes = sum(layout.wall_nodes, item.nodes)?;
        }
        if s.shared.is_none() {
            let here = |e: Error| e.at(item.place);
            s.store_len = item.shape.store_len().map_err(here)?;
            (s.store_at, at) = (at, sum(at, s.store_len)?);
            let with_chi = item.link.is_some();
            let data = BoundaryRecord::<R>::data_len(item.nodes, with_chi).ok_or(Status::SizeOverflow)?;
            (s.data_at, at) = (at, sum(at, data)?);
            if item.link.is_some() && general {
                (s.self_at, at) = (at, sum(at, square(item.nodes)?)?);
                if traits.circulation {
                    (s.regular_at, at) = (at, sum(at, square(item.nodes)?)?);
                }
            }
            scratch = scratch.max(item.shape.scratch_len().map_err(here)?);
            if fluid && item.link.is_some() && !matches!(item.shape, Shape::Ellipse { .. }) {
                scratch = scratch.max(sum(square(item.nodes)?, 2 * item.nodes)?);
            }
        }
        slot(i, s);
    }
    if fluid {
        (layout.walls_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        if traits.circulation {
            (layout.walls_regular_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        }
        if traits.formulation == Formulation::Kirchhoff {
            scratch = scratch.max(crate::lone::scratch_len(layout.unknowns, traits.circulation)?);
        }
    }
    layout.signals_at = at;
    for signal in motions(scene) {
        at = sum(at, signal.store_len())?;
    }
    (layout.scratch_at, layout.scratch_len) = (at, scratch);
    layout.reals = sum(at, scratch)?;
    Ok(layout)
}

/// What a scene requires.
#[derive(Clone, Copy)]
pub(crate) struct Traits {
    pub(crate) fluid: bool,
    pub(crate) circulation: bool,
    pub(crate) formulation: Formulation,
}

impl Traits {
    fn of<R: Real, S: Description<R>>(scene: &S) -> Traits {
        let settings = scene.settings();
        let fluid = settings.fluid_density > R::zero();
        let circulation = fluid && items(scene).any(|i| i.circulation != R::zero());
        let lone = settings.shortcuts && scene.body_count() == 1 && wall_count(scene) == 0;
        let free_root =
            (0..scene.body_count()).all(|b| scene.body(b).is_some_and(|body| matches!(body.root, Root::Free)));
        let links = each_link(scene).count();
        let given_joints =
            each_link(scene).all(|(_, _, l)| l.joint.is_none_or(|j| !matches!(j.drive, Drive::Torque { .. })));
        let formulation = if lone && free_root && links == 1 && fluid {
            Formulation::Kirchhoff
        } else if lone && free_root && links > 1 && given_joints && settings.gravity == R::zero() && !circulation {
            Formulation::LockedMomentum
        } else {
            Formulation::Velocity
        };
        Traits { fluid, circulation, formulation }
    }
}

impl<'a, R: Real> Model<'a, R> {
    /// Memory needed for a scene. Checks everything that can be checked without building shapes.
    ///
    /// # Errors
    /// Any of the set-up errors of [`Status`], with the place in the scene.
    pub fn requirement(scene: &impl Description<R>) -> Result<ModelRequirement> {
        validate(scene)?;
        let layout = lay_out(scene, &Traits::of(scene), |_, _| ())?;
        Ok(ModelRequirement {
            links: each_link(scene).count(),
            coordinates: motions(scene).count(),
            boundaries: items(scene).count(),
            reals: layout.reals,
        })
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
        let layout = lay_out(scene, &traits, |i, s| {
            if let Some(b) = memory.boundaries.get_mut(i) {
                *b = BoundaryRecord {
                    first: s.first,
                    store_at: s.store_at,
                    store_len: s.store_len,
                    data_at: s.data_at,
                    self_at: s.self_at,
                    regular_at: s.regular_at,
                    ..BoundaryRecord::default()
                };
            }
        })?;
        let store = &mut *memory.reals;
        let (store, scratch) = store.split_at_mut_checked(layout.scratch_at).ok_or(Status::MemoryTooSmall)?;
        build_boundaries(scene, &traits, memory.boundaries, store, scratch)?;
        build_links(scene, memory.links, memory.boundaries, store)?;
        let channels = build_coordinates(scene, memory.coordinates, store, layout.signals_at)?;
        let mut head =
            head(scene, &traits, &layout, memory.coordinates.get(..need.coordinates).unwrap_or(&[]), channels);
        if traits.fluid {
            let walls = memory.boundaries.get(..head.plan.walls).unwrap_or(&[]);
            crate::nystrom::fill_walls(walls, &head, traits.circulation, store);
        }
        if traits.formulation == Formulation::Kirchhoff
            && let Some(boundary) = memory.boundaries.first()
        {
            (head.lone_added_mass, head.lone_impulse) =
                crate::lone::constants(boundary, store, scratch, traits.circulation)?;
        }
        Ok(head)
    }

    /// The view of a model in memory that [`Model::init`] filled.
    pub fn view(
        head: &'a ModelHead<R>,
        links: &'a [LinkRecord<R>],
        coordinates: &'a [CoordinateRecord<R>],
        boundaries: &'a [BoundaryRecord<R>],
        store: &'a [R],
    ) -> Self {
        Model { head, links, coordinates, boundaries, store }
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
    // Columns of the boundary system, one transposed and one ordinary solve for the force, and for circulation
    // its potential, its transposed potential and the rate of its potential.
    let columns = free + usize::from(prescribed_moves);
    let circulation =
        if traits.circulation { 2 + usize::from(settings.circulation == CirculationModel::Full) } else { 0 };
    let mut plan = Plan {
        formulation: traits.formulation,
        links: each_link(scene).count(),
        walls,
        unknowns,
        moving_unknowns: if stepping { layout.unknowns - layout.wall_nodes } else { 0 },
        right_hand_sides: if stepping { columns + 2 + circulation } else { 0 },
        free_coordinates: free,
        prescribed_coordinates: coordinates.len() - free,
        state_len: motion + usize::from(tracks_work),
        fluid: traits.fluid,
        gravity: settings.gravity != R::zero(),
        repulsion: settings.repulsion.is_some_and(|r| r.epsilon != R::zero()),
        circulation: traits.circulation,
        model_bytes: layout.reals.saturating_mul(size_of::<R>()),
        ..Plan::default()
    };
    plan.operations = plan.count_operations();
    let mut head = ModelHead {
        fluid_density: settings.fluid_density,
        gravity: settings.gravity,
        repulsion: settings.repulsion.filter(|r| r.epsilon != R::zero()),
        gyroscopic: traits.circulation && settings.circulation == CirculationModel::Full,
        force: settings.force,
        wall_nodes: layout.wall_nodes,
        walls_at: layout.walls_at,
        walls_regular_at: layout.walls_regular_at,
        channels,
        tracks_work,
        prescribed_moves,
        lone_added_mass: [R::zero(); 9],
        lone_impulse: [R::zero(); 3],
        plan,
    };
    head.plan.sim_bytes = crate::sim::SimRequirement::of(&head, coordinates.len())
        .map_or(usize::MAX, |r| r.reals.saturating_mul(size_of::<R>()));
    head
}
