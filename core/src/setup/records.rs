//! Fills a model's records and store: boundaries, links, coordinates.
//!
//! Tested by `tests/articulated`, `fluid/assembly_test.rs`.

use crate::base::complex::{Complex, cabs, complex};
use crate::base::features;
use crate::base::memory::{copy, part, part_mut, put, take, take_as};
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::fluid::gap::Placed;
use crate::fluid::near::buffers::{LADDERS, LISTS, LadderLists, listed};
use crate::fluid::near::preimage::Source;
use crate::fluid::near::{ladders, pole};
use crate::fluid::rotation::fill_rotation_potential;
use crate::fluid::self_block::{Block, add_flank_terms, fill_self_block};
use crate::geometry::nodes::write_nodes;
use crate::model::boundary::{BoundaryRecord, Core, Slots};
use crate::model::signal::SignalRecord;
use crate::model::{Control, CoordinateRecord, Formulation, Hold, LinkRecord};
use crate::scene::{Description, Drive, Joint, JointKind, Mass, Root, Shape, Signal, each_link, wall_count};
use crate::setup::items::{items, twin_of};
use crate::setup::traits::Traits;

pub(crate) fn build_boundaries<R: Real, S: Description<R>>(
    scene: &S,
    traits: &Traits,
    boundaries: &mut [BoundaryRecord<R>],
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    for (i, item) in items(scene).enumerate() {
        let at_place = |e: Error| e.at(item.place);
        let twin = twin_of(scene, i, &item).and_then(|j| boundaries.get(j).copied());
        let Some(record) = boundaries.get_mut(i) else { return Err(Status::Internal.into()) };
        if let Some(twin) = twin {
            // The rungs of a configuration are its own.
            let slots = Slots { rungs_at: record.slots.rungs_at, rungs_len: record.slots.rungs_len, ..twin.slots };
            *record = BoundaryRecord { first: record.first, slots, ..twin };
        }
        record.place = item.place;
        record.link = item.link;
        record.sign = if item.place == Place::Tank { R::one() } else { -R::one() };
        record.nodes = item.nodes;
        record.circulation = item.circulation;
        record.pose = item.pose;
        if item.link.is_none() {
            record.pose.origin = item.pose.place(item.shape.frame());
        }
        if twin.is_some() {
            continue;
        }
        let own = part_mut(store, record.slots.store_at, record.slots.store_len);
        (record.outline, record.notice) = item.shape.compile(own, scratch).map_err(at_place)?;
        if features::NEAR && traits.graded {
            list_ladders(record, &item.shape, store).map_err(at_place)?;
        }
        let own = part(store, record.slots.store_at, record.slots.store_len);
        if let Some(centre) = item.centre {
            record.measures = record.outline.view(own).properties().map_err(at_place)?;
            record.origin = record.measures.centroid + complex(centre[0], centre[1]);
        }
        fill_nodes(record, store).map_err(at_place)?;
        if !traits.fluid {
            continue;
        }
        if item.link.is_some() {
            if traits.formulation != Formulation::Kirchhoff || record.knows_rotation(store) {
                fill_rotation_potential(record, store, scratch).map_err(at_place)?;
            } else {
                // Nothing reads it: were that to change, it would be seen.
                part_mut(store, record.slots.data_at + 7 * item.nodes, item.nodes).fill(R::NAN);
            }
            if traits.formulation != Formulation::Kirchhoff {
                let n2 = item.nodes * item.nodes;
                // The blocks lie behind the node arrays they are made from.
                let (data, blocks) = store.split_at_mut_checked(record.slots.self_at).ok_or(Status::Internal)?;
                let (block, rest) = blocks.split_at_mut_checked(n2).ok_or(Status::Internal)?;
                let regular = if traits.circulation { part_mut(rest, 0, n2) } else { &mut [] };
                let (mut block, mut regular) =
                    (Block { data: block, ld: item.nodes, at: 0 }, Block { data: regular, ld: item.nodes, at: 0 });
                let source = Source::of(record, data);
                fill_self_block(&source.nodes, record.sign, R::zero(), &mut block, &mut regular);
                add_flank_terms(&source, record.sign, &mut block, &mut regular);
            }
        }
        if let (true, Shape::Ellipse { a, b }) = (traits.circulation, item.shape) {
            record.core = Core { centre: -record.origin, axes: [a, b], ..Core::default() };
        }
    }
    Ok(())
}

/// Lists the permanent ladders, tips and corners of a compiled outline in the store.
fn list_ladders<R: Real>(record: &mut BoundaryRecord<R>, shape: &Shape<'_, R>, store: &mut [R]) -> Result<()> {
    let (most_ladders, most_tips) = shape.ladder_counts()?;
    let (lists, own) = store.split_at_mut_checked(record.slots.store_at).ok_or(Status::Internal)?;
    let own = part(own, 0, record.slots.store_len);
    let (outline, ladders_at, tips_at) = (record.outline, record.slots.ladders_at, record.slots.tips_at);
    (record.ladders, record.tips) = (0, 0);
    outline.each_feature(own, |ladder, tip| {
        if let Some(l) = ladder.filter(|_| record.ladders < most_ladders) {
            copy(part_mut(lists, ladders_at + 3 * record.ladders, 3), &[l.t, l.beta, l.top]);
            record.ladders += 1;
        }
        if record.tips < most_tips {
            put(lists, tips_at + record.tips, tip);
            record.tips += 1;
        }
    });
    Ok(())
}

/// Ladders that walls cause on each other: placed once, they become permanent, and the nodes follow.
pub(crate) fn grade_walls<R: Real>(walls: &mut [BoundaryRecord<R>], store: &mut [R], scratch: &mut [R]) -> Result<()> {
    let rest = &mut { scratch };
    let ladders = take(rest, walls.len() * LADDERS)?;
    let mut lists = LadderLists { lists: take_as(rest, walls.len() * LISTS)?, ladders };
    lists.clear();
    let placed = |b, store| Placed { record: b, nodes: b.nodes(store), pose: b.pose };
    for (i, a) in walls.iter().enumerate() {
        for (j, b) in walls.iter().enumerate().skip(i + 1) {
            ladders::place_pair(store, (i, &placed(a, store)), (j, &placed(b, store)), &mut lists);
        }
    }
    for (i, b) in walls.iter_mut().enumerate() {
        let mut listed = listed(lists.lists, lists.ladders, i).peekable();
        if listed.peek().is_none() {
            continue;
        }
        for l in listed {
            copy(part_mut(store, b.slots.ladders_at + 3 * b.ladders, 3), &[l.t, l.beta, l.top]);
            b.ladders += 1;
        }
        let (before, own) = store.split_at_mut_checked(b.slots.store_at).ok_or(Status::Internal)?;
        let mut outline = b.outline;
        outline.regrade(b.ladders(before), part_mut(own, 0, b.slots.store_len)).map_err(|e| e.at(b.place))?;
        b.outline = outline;
        fill_nodes(b, store).map_err(|e| e.at(b.place))?;
    }
    Ok(())
}

/// Tabulates the isolated circulatory flow of walls that have no closed form, once their nodes are graded.
pub(crate) fn fill_wall_cores<R: Real>(
    walls: &mut [BoundaryRecord<R>],
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    for b in walls.iter_mut().filter(|b| b.slots.core_modes > 0) {
        let place = b.place;
        fill_rotation_potential(b, store, scratch).map_err(|e| e.at(place))?;
    }
    Ok(())
}

pub(crate) fn build_links<R: Real, S: Description<R>>(
    scene: &S,
    links: &mut [LinkRecord<R>],
    boundaries: &[BoundaryRecord<R>],
) -> Result<()> {
    let walls = wall_count(scene);
    let (mut coordinate, mut root) = (0, 0);
    for (i, (b, l, link)) in each_link(scene).enumerate() {
        let Some(boundary) = boundaries.get(walls + i) else { return Err(Status::Internal.into()) };
        let area = boundary.measures;
        let centroid = area.centroid - boundary.origin;
        let (mass, inertia) = match link.mass {
            Mass::Density(d) => (d * area.area, d * area.polar_moment),
            Mass::Given { mass, inertia, .. } => (mass, inertia),
        };
        if l == 0 {
            root = i;
        }
        let parent = link.joint.map_or(i, |j| root + j.parent);
        let parent_centroid = links.get(parent).map_or(Complex::default(), |p| p.centroid);
        let hold = link.joint.map_or(Hold::Root, |j| hold(&j, parent_centroid, centroid));
        let record = LinkRecord {
            place: (b, l),
            parent,
            coordinate,
            hold,
            mass,
            inertia,
            area: area.area,
            perimeter: area.perimeter,
            centroid,
        };
        if let Some(slot) = links.get_mut(i) {
            *slot = record;
        }
        coordinate += if l == 0 { 3 } else { 1 };
    }
    Ok(())
}

/// Anchors are given from the centroids; links are placed by their centres of mass.
fn hold<R: Real>(joint: &Joint<'_, R>, parent_centroid: Complex<R>, centroid: Complex<R>) -> Hold<R> {
    let parent = parent_centroid + complex(joint.parent_anchor[0], joint.parent_anchor[1]);
    let own = centroid + complex(joint.self_anchor[0], joint.self_anchor[1]);
    match joint.kind {
        JointKind::Hinge => Hold::Hinge { parent, own },
        JointKind::Slider { axis, angle } => {
            let axis = complex(axis[0], axis[1]);
            Hold::Slider { parent, own, axis: axis / cabs(axis), angle }
        }
    }
}

pub(crate) fn build_coordinates<R: Real, S: Description<R>>(
    scene: &S,
    coordinates: &mut [CoordinateRecord<R>],
    store: &mut [R],
    signals_at: usize,
) -> Result<usize> {
    let (mut at, mut channels, mut free, mut link) = (signals_at, 0, 0, 0);
    let mut slots = coordinates.iter_mut();
    let mut push = |mut record: CoordinateRecord<R>, signal: Option<Signal<'_, R>>| -> Result<()> {
        if let Some(signal) = signal {
            record.constant = signal.is_constant();
            record.signal = {
                let motion = record.control == Control::Prescribed;
                signal.compile(part_mut(store, at, signal.store_len()), at, channels, motion)?
            };
            channels += usize::from(record.signal.channel().is_some());
            at += signal.store_len();
        } else {
            record.signal = SignalRecord::default();
        }
        if record.control != Control::Prescribed {
            record.free = free;
            free += 1;
        }
        if let Some(slot) = slots.next() {
            *slot = record;
        }
        Ok(())
    };
    for (b, body) in (0..scene.body_count()).filter_map(|b| Some((b, scene.body(b)?))) {
        let root = CoordinateRecord { link, ..CoordinateRecord::default() };
        // A coordinate moves what hangs on its link at the most; a root's x moves no y and no θ, its θ not its own x and y.
        let rows_end = 3 * (link + scene.link_count(b));
        let moves = |first: usize, beyond: usize| (first, rows_end.saturating_sub(beyond + first));
        for (k, (position, velocity)) in body.pose.into_iter().zip(body.velocity).enumerate() {
            let moves = moves(3 * link + k, 2usize.saturating_sub(k));
            let record = CoordinateRecord { component: k, base: position, start: [position, velocity], moves, ..root };
            match body.root {
                Root::Free => push(record, None),
                Root::Prescribed(signals) => {
                    let signal = match (k, signals) {
                        (0, [s, _, _]) | (1, [_, s, _]) | (_, [_, _, s]) => s,
                    };
                    push(CoordinateRecord { control: Control::Prescribed, ..record }, Some(signal))
                }
            }
            .map_err(|e| e.at(Place::Body(b)))?;
        }
        for (l, joint) in (0..scene.link_count(b)).filter_map(|l| Some((l, scene.link(b, l)?.joint?))) {
            let moves = moves(3 * (link + l), 0);
            let joint_of = CoordinateRecord { link: link + l, component: 3, moves, ..CoordinateRecord::default() };
            let given = CoordinateRecord { control: Control::Prescribed, ..joint_of };
            match joint.drive {
                Drive::Locked(value) => push(given, Some(Signal::Constant(value))),
                Drive::Motion(signal) => push(given, Some(signal)),
                Drive::Torque { torque, stiffness, damping, rest, start } => push(
                    CoordinateRecord { control: Control::Torque, stiffness, damping, rest, start, ..joint_of },
                    Some(torque),
                ),
            }
            .map_err(|e| e.at(Place::Link(b, l)))?;
        }
        link += scene.link_count(b);
    }
    Ok(channels)
}

/// Fills the node arrays of a boundary whose frame origin is known, its reach and spacing, and its table of pole terms.
pub(crate) fn fill_nodes<R: Real>(record: &mut BoundaryRecord<R>, store: &mut [R]) -> Result<()> {
    let n = record.nodes;
    let (outlines, data) = store.split_at_mut_checked(record.slots.data_at).ok_or(Status::Internal)?;
    let (reach, speed) = write_nodes(&record.view(outlines), record.origin, n, data)?;
    let t = part(data, 4 * n, n);
    let ends = t.iter().zip(t.iter().cycle().skip(1));
    let longest = record.view(outlines).curve.longest(ends.map(|(from, to)| (*from, *to)));
    record.spacing = longest.max(speed * R::TAU / R::count(n.max(1)));
    // The outline may bulge beyond its nodes by at most half a spacing.
    record.reach = reach + record.spacing * R::HALF;
    if features::NEAR && record.slots.table_len > 0 {
        pole::fill_table(n, part_mut(store, record.slots.table_at, record.slots.table_len));
    }
    if reach.is_finite() && speed.is_finite() { Ok(()) } else { Err(Status::NotFinite.into()) }
}
