//! What a scene requires and where everything goes in a model's store: the same lines count and place.

use crate::base::features;
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::dynamics::forces::close_range;
use crate::fluid::near::{LADDER_LIST, MOST_LADDERS, pole, rung_allowance};
use crate::geometry::grading::grading_len;
use crate::geometry::pose::Pose;
use crate::model::Formulation;
use crate::model::boundary::{BoundaryRecord, modes_len, potential_scratch};
use crate::scene::{Description, Drive, Link, Mass, Quadrature, Root, Shape, Signal};
use crate::setup::automatic_nodes::target;

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
    let settings = scene.settings();
    let tolerance = target(settings.tolerance);
    let nodes = move |given: usize, shape: &Shape<'a, R>| {
        if given == 0 { crate::setup::automatic_nodes::nodes(shape, tolerance, settings.quadrature) } else { given }
    };
    let wall = move |place, w: crate::scene::Wall<'a, R>| Item {
        place,
        link: None,
        shape: w.shape,
        nodes: nodes(w.nodes, &w.shape),
        centre: None,
        circulation: w.circulation,
        pose: Pose::new(w.position[0], w.position[1], w.angle),
    };
    let tank = scene.tank().into_iter().map(move |w| wall(Place::Tank, w));
    let obstacles = (0..scene.obstacle_count()).filter_map(move |i| Some(wall(Place::Obstacle(i), scene.obstacle(i)?)));
    let links = each_link(scene).enumerate().map(move |(i, (b, l, link))| Item {
        place: Place::Link(b, l),
        link: Some(i),
        shape: link.shape,
        nodes: nodes(link.nodes, &link.shape),
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
pub(crate) fn motions<'a, R: Real, S: Description<R>>(scene: &'a S) -> impl Iterator<Item = Signal<'a, R>> + Clone {
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
pub(crate) struct Slots {
    pub(crate) store_at: usize,
    pub(crate) store_len: usize,
    pub(crate) data_at: usize,
    pub(crate) self_at: usize,
    pub(crate) regular_at: usize,
    pub(crate) first: usize,
    pub(crate) shared: Option<usize>,
    pub(crate) ladders_at: usize,
    pub(crate) tips_at: usize,
    pub(crate) modes_at: usize,
    pub(crate) modes: usize,
    pub(crate) table_at: usize,
    pub(crate) table_len: usize,
    pub(crate) rungs_at: usize,
    pub(crate) rungs_len: usize,
}

/// Offsets of everything else, and the total.
#[derive(Clone, Copy, Default)]
pub(crate) struct Layout {
    pub(crate) walls_at: usize,
    pub(crate) walls_regular_at: usize,
    pub(crate) signals_at: usize,
    pub(crate) scratch_at: usize,
    pub(crate) scratch_len: usize,
    pub(crate) reals: usize,
    pub(crate) wall_nodes: usize,
    pub(crate) unknowns: usize,
    /// Reals of the rungs of a configuration.
    pub(crate) rungs: usize,
    pub(crate) close_range_at: usize,
    pub(crate) close_range_len: usize,
}

fn sum(a: usize, b: usize) -> Result<usize> {
    a.checked_add(b).ok_or(Status::SizeOverflow.into())
}

fn square(n: usize) -> Result<usize> {
    n.checked_mul(n).ok_or(Status::SizeOverflow.into())
}

/// The layout: the same lines count and place. `slot` sees each boundary's offsets in order.
pub(crate) fn lay_out<R: Real, S: Description<R>>(
    scene: &S,
    traits: &Traits,
    mut slot: impl FnMut(usize, Slots),
) -> Result<Layout> {
    let (mut layout, mut at, mut scratch) = (Layout::default(), 0, 0);
    let fluid = traits.fluid;
    let general = fluid && traits.formulation != Formulation::Kirchhoff;
    let walls = wall_count(scene);
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
        if traits.graded {
            let here = |e: Error| e.at(item.place);
            let own = item.shape.store_len().map_err(here)?;
            let walls = if item.link.is_none() { 2 } else { 1 };
            // The shape's store holds at least its permanent rungs.
            let len = grading_len(walls * rung_allowance(item.nodes))
                .and_then(|n| n.checked_add(own))
                .ok_or(Status::SizeOverflow)?;
            (s.rungs_at, s.rungs_len) = (layout.rungs, len);
            layout.rungs = sum(layout.rungs, len)?;
        }
        if s.shared.is_none() {
            let here = |e: Error| e.at(item.place);
            s.store_len = item.shape.store_len().map_err(here)?;
            if traits.graded {
                let (mut ladders, tips) = item.shape.ladder_counts().map_err(here)?;
                if item.link.is_none() && walls > 1 {
                    // Ladders that walls cause on each other are permanent.
                    ladders = sum(ladders, MOST_LADDERS)?;
                    let rungs = grading_len(rung_allowance(item.nodes)).ok_or(Status::SizeOverflow)?;
                    s.store_len = sum(s.store_len, rungs)?;
                }
                (s.ladders_at, at) = (at, sum(at, ladders.saturating_mul(3))?);
                (s.tips_at, at) = (at, sum(at, tips)?);
            }
            (s.store_at, at) = (at, sum(at, s.store_len)?);
            if traits.tables {
                s.table_len = pole::table_len(item.nodes).ok_or(Status::SizeOverflow)?;
                (s.table_at, at) = (at, sum(at, s.table_len)?);
            }
            let closed = matches!(item.shape, Shape::Ellipse { .. });
            if traits.graded && fluid && item.link.is_some() && !closed {
                s.modes = modes_len(item.nodes).ok_or(Status::SizeOverflow)?;
                (s.modes_at, at) = (at, sum(at, s.modes)?);
            }
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
            if fluid && item.link.is_some() && !closed {
                scratch = scratch.max(potential_scratch(s.modes, item.nodes).ok_or(Status::SizeOverflow)?);
            }
        }
        slot(i, s);
    }
    if traits.graded && walls > 1 {
        scratch = scratch.max(walls.checked_mul(LADDER_LIST).ok_or(Status::SizeOverflow)?);
    }
    if fluid {
        (layout.walls_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        if traits.circulation {
            (layout.walls_regular_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        }
        if traits.formulation == Formulation::Kirchhoff {
            scratch = scratch.max(crate::dynamics::kirchhoff::scratch_len(layout.unknowns, traits.circulation)?);
        }
    }
    if traits.graded && traits.repels {
        layout.close_range_len = close_range::tables_len::<R>();
        (layout.close_range_at, at) = (at, sum(at, layout.close_range_len)?);
        scratch = scratch.max(close_range::scratch_len::<R>().ok_or(Status::SizeOverflow)?);
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
    /// Nodes follow the configuration.
    pub(crate) graded: bool,
    /// Pole terms are used: also by a lone thin body.
    pub(crate) tables: bool,
    pub(crate) repels: bool,
}

impl Traits {
    pub(crate) fn of<R: Real, S: Description<R>>(scene: &S) -> Traits {
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
        let repels = settings.repulsion.is_some_and(|r| r.epsilon != R::zero());
        let tables = features::NEAR && settings.quadrature == Quadrature::Graded && (fluid || repels);
        let graded = tables && wall_count(scene) + links > 1;
        Traits { fluid, circulation, formulation, graded, tables, repels }
    }
}
