//! Where everything goes in a model's store: the same lines count and place.
//!
//! Tested by `tests/allocation.rs:memory_of_exactly_the_required_length_suffices_and_one_less_is_refused`.

use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::forces::close_range;
use crate::fluid::near::buffers::{LADDERS, LISTS, MOST_LADDERS, rung_allowance};
use crate::fluid::near::pole;
use crate::fluid::rotation::{core_len, modes_len, potential_scratch};
use crate::geometry::grading::grading_len;
use crate::model::Formulation;
use crate::model::boundary::{BoundaryRecord, Slots};
use crate::scene::{Description, Shape, motions, wall_count};
use crate::setup::items::{items, twin_of};
use crate::setup::traits::Traits;

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

/// The layout: the same lines count and place. `slot` sees each boundary's number, first unknown and offsets in order.
pub(crate) fn lay_out<R: Real, S: Description<R>>(
    scene: &S,
    traits: &Traits,
    mut slot: impl FnMut(usize, usize, Slots),
) -> Result<Layout> {
    let (mut layout, mut at, mut scratch, mut lone_inside) = (Layout::default(), 0, 0, true);
    let fluid = traits.fluid;
    let general = fluid && traits.formulation != Formulation::Kirchhoff;
    let walls = wall_count(scene);
    for (i, item) in items(scene).enumerate() {
        let (first, mut s) = (layout.unknowns, Slots::default());
        layout.unknowns = sum(layout.unknowns, item.nodes)?;
        if item.link.is_none() {
            layout.wall_nodes = sum(layout.wall_nodes, item.nodes)?;
        }
        if traits.graded {
            let at_place = |e: Error| e.at(item.place);
            let own = item.shape.store_len().map_err(at_place)?;
            let walls = if item.link.is_none() { 2 } else { 1 };
            // The shape's store holds at least its permanent rungs.
            let len = grading_len(walls * rung_allowance(item.nodes))
                .and_then(|n| n.checked_add(own))
                .ok_or(Status::SizeOverflow)?;
            (s.rungs_at, s.rungs_len) = (layout.rungs, len);
            layout.rungs = sum(layout.rungs, len)?;
        }
        if twin_of(scene, i, &item).is_none() {
            let at_place = |e: Error| e.at(item.place);
            s.store_len = item.shape.store_len().map_err(at_place)?;
            if traits.graded {
                let (mut ladders, tips) = item.shape.ladder_counts().map_err(at_place)?;
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
            let circulates = item.link.is_some() || item.circulation != R::zero();
            if traits.circulation && circulates && !closed {
                s.core_modes = core_len(traits.graded, item.nodes).ok_or(Status::SizeOverflow)?;
                (s.core_at, at) = (at, sum(at, s.core_modes.saturating_mul(2))?);
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
            scratch = scratch.max(item.shape.scratch_len().map_err(at_place)?);
            // A lone body does without the potential of rotation inside.
            lone_inside = closed || s.core_modes > 0;
            if fluid && !closed && ((general && item.link.is_some()) || s.core_modes > 0) {
                scratch = scratch.max(potential_scratch(&s, item.nodes).ok_or(Status::SizeOverflow)?);
            }
        }
        slot(i, first, s);
    }
    if traits.graded && walls > 1 {
        scratch = scratch.max(walls.checked_mul(LISTS + LADDERS).ok_or(Status::SizeOverflow)?);
    }
    if fluid {
        (layout.walls_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        if traits.circulation {
            (layout.walls_regular_at, at) = (at, sum(at, square(layout.wall_nodes)?)?);
        }
        if traits.formulation == Formulation::Kirchhoff {
            scratch = scratch.max(crate::dynamics::kirchhoff::scratch_len(layout.unknowns, lone_inside)?);
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
