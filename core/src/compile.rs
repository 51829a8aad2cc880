//! From a scene to a model: validation, layout of the store, and the set-up that happens once.

use crate::boundary::{BoundaryRecord, Core, fill_nodes, fill_self_block, rotation_potential};
use crate::model::{Control, CoordinateRecord, Formulation, Hold, LinkRecord, Model, ModelHead};
use crate::plan::Plan;
use crate::scalar::{Complex, Real, cabs, complex};
use crate::scene::{CirculationModel, Drive, Joint, JointKind, Link, Mass, Root, Scene, Shape, Signal};
use crate::se2::Pose;
use crate::signal::SignalRecord;
use crate::status::{Error, Place, Result, Status};
use crate::workspace::part_mut;

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

/// Most nodes allowed on one boundary.
const MOST_NODES: usize = 1 << 16;

/// One boundary as the scene gives it.
#[derive(Clone, Copy)]
struct Item<'a, R> {
    place: Place,
    link: Option<usize>,
    shape: Shape<'a, R>,
    nodes: usize,
    /// Centre of mass from the centroid; `None` for walls (frame = drawing frame).
    centre: Option<[R; 2]>,
    circulation: R,
    pose: Pose<R>,
}

fn items<'a, R: Real>(scene: &'a Scene<'a, R>) -> impl Iterator<Item = Item<'a, R>> + Clone {
    let wall = |place, w: &crate::scene::Wall<'a, R>| Item {
        place,
        link: None,
        shape: w.shape,
        nodes: w.nodes,
        centre: None,
        circulation: w.circulation,
        pose: Pose::new(w.position[0], w.position[1], w.angle),
    };
    let tank = scene.tank.iter().map(move |w| wall(Place::Tank, w));
    let obstacles = scene.obstacles.iter().enumerate().map(move |(i, w)| wall(Place::Obstacle(i), w));
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

fn each_link<'a, R: Real>(scene: &'a Scene<'a, R>) -> impl Iterator<Item = (usize, usize, &'a Link<'a, R>)> + Clone {
    scene
        .bodies
        .iter()
        .enumerate()
        .flat_map(|(b, body)| body.links.iter().enumerate().map(move |(l, link)| (b, l, link)))
}

fn motions<'a, R: Real>(scene: &'a Scene<'a, R>) -> impl Iterator<Item = Signal<'a, R>> + Clone {
    scene.bodies.iter().flat_map(|body| {
        let root = match body.root {
            Root::Prescribed(signals) => signals,
            Root::Free => [Signal::Constant(R::zero()); 3],
        };
        root.into_iter().chain(body.links.iter().filter_map(|l| l.joint).map(|j| match j.drive {
            Drive::Locked(value) => Signal::Constant(value),
            Drive::Motion(signal) => signal,
            Drive::Torque { torque, .. } => torque,
        }))
    })
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
fn lay_out<R: Real>(scene: &Scene<'_, R>, traits: &Traits, mut slot: impl FnMut(usize, Slots)) -> Result<Layout> {
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
struct Traits {
    fluid: bool,
    circulation: bool,
    formulation: Formulation,
}

impl Traits {
    fn of<R: Real>(scene: &Scene<'_, R>) -> Traits {
        let fluid = scene.fluid_density > R::zero();
        let circulation = fluid && items(scene).any(|i| i.circulation != R::zero());
        let lone = scene.shortcuts && scene.bodies.len() == 1 && scene.tank.is_none() && scene.obstacles.is_empty();
        let free_root = scene.bodies.iter().all(|b| matches!(b.root, Root::Free));
        let links = each_link(scene).count();
        let given_joints =
            each_link(scene).all(|(_, _, l)| l.joint.is_none_or(|j| !matches!(j.drive, Drive::Torque { .. })));
        let formulation = if lone && free_root && links == 1 && fluid {
            Formulation::Kirchhoff
        } else if lone && free_root && links > 1 && given_joints && scene.gravity == R::zero() && !circulation {
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
    pub fn requirement(scene: &Scene<'_, R>) -> Result<ModelRequirement> {
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
    pub fn init(scene: &Scene<'_, R>, memory: &mut ModelMemory<'_, R>) -> Result<ModelHead<R>> {
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

fn finite<R: Real>(what: &'static str, x: R) -> Result<()> {
    if x.is_finite() { Ok(()) } else { Err(Error::new(Status::NotFinite).of(what, x.to_f64())) }
}

fn at_least_zero<R: Real>(what: &'static str, x: R) -> Result<()> {
    finite(what, x)?;
    if x >= R::zero() { Ok(()) } else { Err(Error::new(Status::OutOfRange).of(what, x.to_f64())) }
}

fn validate<R: Real>(scene: &Scene<'_, R>) -> Result<()> {
    at_least_zero("density", scene.fluid_density)?;
    finite("gravity", scene.gravity)?;
    if let Some(r) = scene.repulsion {
        at_least_zero("epsilon", r.epsilon)?;
        finite("alpha", r.alpha)?;
        if r.alpha <= R::zero() {
            return Err(Error::new(Status::OutOfRange).of("alpha", r.alpha.to_f64()));
        }
    }
    if scene.bodies.is_empty() {
        return Err(Status::EmptyScene.into());
    }
    for item in items(scene) {
        let here = |e: Error| e.at(item.place);
        if item.nodes < 8 || item.nodes % 2 != 0 || item.nodes > MOST_NODES {
            return Err(here(Error::new(Status::NodeCount).of("nodes", item.nodes as f64)));
        }
        for (what, x) in [
            ("circulation", item.circulation),
            ("position", item.pose.origin.re),
            ("position", item.pose.origin.im),
            ("angle", item.pose.turn.re),
        ] {
            finite(what, x).map_err(here)?;
        }
        if item.place == Place::Tank && item.circulation != R::zero() {
            return Err(here(Error::new(Status::OutOfRange).of("circulation", item.circulation.to_f64())));
        }
    }
    for (b, body) in scene.bodies.iter().enumerate() {
        let here = |e: Error| e.at(Place::Body(b));
        for (what, values) in [("position", body.pose), ("velocity", body.velocity)] {
            for x in values {
                finite(what, x).map_err(here)?;
            }
        }
        if body.links.is_empty() {
            return Err(here(Error::new(Status::EmptyScene).of("links", 0.0)));
        }
    }
    for (b, l, link) in each_link(scene) {
        validate_link(scene, l, link).map_err(|e| e.at(Place::Link(b, l)))?;
    }
    Ok(())
}

fn validate_link<R: Real>(scene: &Scene<'_, R>, l: usize, link: &Link<'_, R>) -> Result<()> {
    let zero = R::zero();
    match link.mass {
        Mass::Density(d) => {
            at_least_zero("density", d)?;
            if d == zero && scene.fluid_density == zero {
                return Err(Status::Massless.into());
            }
        }
        Mass::Given { mass, inertia, centre_of_mass } => {
            at_least_zero("mass", mass)?;
            at_least_zero("inertia", inertia)?;
            finite("centre_of_mass", centre_of_mass[0])?;
            finite("centre_of_mass", centre_of_mass[1])?;
            if scene.fluid_density == zero && (mass == zero || inertia == zero) {
                return Err(Status::Massless.into());
            }
        }
    }
    let Some(joint) = link.joint else {
        return if l == 0 { Ok(()) } else { Err(Status::BadParent.into()) };
    };
    if l == 0 || joint.parent >= l {
        return Err(Error::new(Status::BadParent).of("parent", joint.parent as f64));
    }
    for x in joint.parent_anchor.into_iter().chain(joint.self_anchor) {
        finite("anchor", x)?;
    }
    if let JointKind::Slider { axis, angle } = joint.kind {
        finite("angle", angle)?;
        let length = axis[0].hypot(axis[1]);
        if !(length.is_finite() && length > zero) {
            return Err(Error::new(Status::OutOfRange).of("axis", length.to_f64()));
        }
    }
    match joint.drive {
        Drive::Locked(value) => finite("locked", value),
        Drive::Motion(_) => Ok(()),
        Drive::Torque { stiffness, damping, rest, start, .. } => {
            at_least_zero("stiffness", stiffness)?;
            at_least_zero("damping", damping)?;
            finite("rest", rest)?;
            finite("start", start[0])?;
            finite("start", start[1])
        }
    }
}

fn build_boundaries<R: Real>(
    scene: &Scene<'_, R>,
    traits: &Traits,
    boundaries: &mut [BoundaryRecord<R>],
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    for (i, item) in items(scene).enumerate() {
        let here = |e: Error| e.at(item.place);
        let shared = items(scene).enumerate().take(i).find(|(_, j)| {
            j.link.is_some()
                && item.link.is_some()
                && j.shape == item.shape
                && j.nodes == item.nodes
                && j.centre == item.centre
        });
        let twin = shared.and_then(|(j, _)| boundaries.get(j).copied());
        let Some(record) = boundaries.get_mut(i) else { return Err(Status::Internal.into()) };
        if let Some(twin) = twin {
            *record = BoundaryRecord { first: record.first, ..twin };
        }
        record.place = item.place;
        record.link = item.link;
        record.sign = if item.place == Place::Tank { R::one() } else { -R::one() };
        record.nodes = item.nodes;
        record.circulation = item.circulation;
        record.pose = item.pose;
        if twin.is_some() {
            continue;
        }
        let own = part_mut(store, record.store_at, record.store_len);
        (record.outline, record.notice) = item.shape.compile(own, scratch).map_err(here)?;
        if let Some(centre) = item.centre {
            let area = record.outline.view(own).properties().map_err(here)?;
            record.origin = area.centroid + complex(centre[0], centre[1]);
        }
        fill_nodes(record, store).map_err(here)?;
        if !traits.fluid {
            continue;
        }
        if item.link.is_some() {
            rotation_potential(record, &item.shape, store, scratch).map_err(here)?;
            if traits.formulation != Formulation::Kirchhoff {
                let n2 = item.nodes * item.nodes;
                // The blocks lie behind the node arrays they are made from.
                let (nodes, blocks) = store.split_at_mut_checked(record.self_at).ok_or(Status::Internal)?;
                let (block, rest) = blocks.split_at_mut_checked(n2).ok_or(Status::Internal)?;
                let regular = if traits.circulation { part_mut(rest, 0, n2) } else { &mut [] };
                fill_self_block(record, nodes, block, regular).map_err(here)?;
            }
        }
        if traits.circulation {
            record.core = core_of(record, &item.shape, store);
        }
    }
    Ok(())
}

/// Isolated circulatory flow: an ellipse's own, otherwise a vortex at the centroid or, if that is outside or
/// close to the outline, at the innermost point of a coarse grid.
fn core_of<R: Real>(record: &BoundaryRecord<R>, shape: &Shape<'_, R>, store: &[R]) -> Core<R> {
    if let Shape::Ellipse { a, b } = *shape {
        return Core { centre: -record.origin, axes: [a, b] };
    }
    let nodes = record.nodes(store);
    let clearance = |z: Complex<R>| {
        if crate::contact::encloses(&nodes, z) {
            nodes.points().fold(R::MAX, |d, x| d.min(cabs(x - z)))
        } else {
            -R::one()
        }
    };
    let count = R::count(nodes.x.len().max(1));
    let mean = nodes.points().fold(Complex::default(), |s, x| s + x) / count;
    let mut best = (clearance(mean), mean);
    let first = best.0;
    const GRID: usize = 32;
    for i in 0..GRID {
        for k in 0..GRID {
            let side = |i| (R::count(2 * i + 1) / R::count(GRID) - R::one()) * record.reach;
            let z = complex(side(i), side(k));
            let d = clearance(z);
            // The mean of the nodes is kept unless another point is clearly deeper inside.
            if d > best.0 && d > first * R::TWO {
                best = (d, z);
            }
        }
    }
    Core { centre: best.1, axes: [R::zero(); 2] }
}

fn build_links<R: Real>(
    scene: &Scene<'_, R>,
    links: &mut [LinkRecord<R>],
    boundaries: &[BoundaryRecord<R>],
    store: &[R],
) -> Result<()> {
    let walls = scene.obstacles.len() + usize::from(scene.tank.is_some());
    let (mut coordinate, mut root) = (0, 0);
    for (i, (b, l, link)) in each_link(scene).enumerate() {
        let Some(boundary) = boundaries.get(walls + i) else { return Err(Status::Internal.into()) };
        let area =
            boundary.outline.view(crate::workspace::part(store, boundary.store_at, boundary.store_len)).properties()?;
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

fn build_coordinates<R: Real>(
    scene: &Scene<'_, R>,
    coordinates: &mut [CoordinateRecord<R>],
    store: &mut [R],
    signals_at: usize,
) -> Result<usize> {
    let (mut at, mut channels, mut free, mut link) = (signals_at, 0, 0, 0);
    let mut slots = coordinates.iter_mut();
    let mut push = |mut record: CoordinateRecord<R>, signal: Option<Signal<'_, R>>| -> Result<()> {
        if let Some(signal) = signal {
            record.constant = signal.is_constant();
            record.signal = signal.compile(part_mut(store, at, signal.store_len()), at, channels)?;
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
    for (b, body) in scene.bodies.iter().enumerate() {
        let root = CoordinateRecord { link, ..CoordinateRecord::default() };
        for (k, (position, velocity)) in body.pose.into_iter().zip(body.velocity).enumerate() {
            let record = CoordinateRecord { component: k, base: position, start: [position, velocity], ..root };
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
        for (l, joint) in body.links.iter().enumerate().filter_map(|(l, x)| x.joint.map(|j| (l, j))) {
            let joint_of = CoordinateRecord { link: link + l, component: 3, ..CoordinateRecord::default() };
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
        link += body.links.len();
    }
    Ok(channels)
}

fn head<R: Real>(
    scene: &Scene<'_, R>,
    traits: &Traits,
    layout: &Layout,
    coordinates: &[CoordinateRecord<R>],
    channels: usize,
) -> ModelHead<R> {
    let free = coordinates.iter().filter(|c| c.control != Control::Prescribed).count();
    let prescribed_moves = coordinates.iter().any(|c| c.control == Control::Prescribed && !c.constant);
    let tracks_work = prescribed_moves || coordinates.iter().any(|c| c.control == Control::Torque);
    let motion = if traits.formulation == Formulation::LockedMomentum { 3 } else { 2 * free };
    let walls = scene.obstacles.len() + usize::from(scene.tank.is_some());
    let stepping = traits.fluid && traits.formulation != Formulation::Kirchhoff;
    let unknowns = if stepping { layout.unknowns } else { 0 };
    // Columns of the boundary system, one transposed and one ordinary solve for the force, and for circulation
    // its potential, its transposed potential and the rate of its potential.
    let columns = free + usize::from(prescribed_moves);
    let circulation = if traits.circulation { 2 + usize::from(scene.circulation == CirculationModel::Full) } else { 0 };
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
        gravity: scene.gravity != R::zero(),
        repulsion: scene.repulsion.is_some_and(|r| r.epsilon != R::zero()),
        circulation: traits.circulation,
        model_bytes: layout.reals.saturating_mul(size_of::<R>()),
        ..Plan::default()
    };
    plan.operations = plan.count_operations();
    let mut head = ModelHead {
        fluid_density: scene.fluid_density,
        gravity: scene.gravity,
        repulsion: scene.repulsion.filter(|r| r.epsilon != R::zero()),
        gyroscopic: traits.circulation && scene.circulation == CirculationModel::Full,
        force: scene.force,
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
