//! A scene compiled into an immutable model: records, node arrays and everything that rigid motion leaves
//! unchanged. One model serves any number of simulations; it is `Sync`.
//!
//! Order of boundaries (and of unknowns): tank, obstacles, then the links of all bodies.

pub(crate) mod boundary;
pub(crate) mod drives;
pub(crate) mod plan;
pub(crate) mod signal;
pub(crate) mod table;

use crate::base::complex::Complex;
use crate::base::features;
use crate::base::scalar::Real;
use crate::base::status::{Place, Status};
use crate::geometry::nodes::Nodes;
use crate::model::boundary::BoundaryRecord;
pub use crate::model::plan::Formulation;
use crate::model::plan::Plan;
use crate::model::signal::SignalRecord;
use crate::scene::{ForceFormula, Repulsion};

/// One rigid link.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinkRecord<R> {
    /// Body and link within the body.
    pub(crate) place: (usize, usize),
    /// Parent among all links; itself for a root.
    pub(crate) parent: usize,
    /// First coordinate: the root's three, or the joint's one.
    pub(crate) coordinate: usize,
    /// How it hangs on its parent.
    pub(crate) hold: Hold<R>,
    /// Mass, kg/m.
    pub(crate) mass: R,
    /// Moment of inertia about the centre of mass, kg·m.
    pub(crate) inertia: R,
    /// Area, m².
    pub(crate) area: R,
    /// Perimeter, m.
    pub(crate) perimeter: R,
    /// Area centroid minus centre of mass, link frame.
    pub(crate) centroid: Complex<R>,
}

/// Attachment of a link. Vectors are in centre-of-mass frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Hold<R> {
    /// First link of its body.
    #[default]
    Root,
    /// Anchors coincide; the coordinate is the relative heading.
    Hinge {
        /// Anchor on the parent.
        parent: Complex<R>,
        /// Anchor on the link.
        own: Complex<R>,
    },
    /// The link's anchor slides along an axis of the parent.
    Slider {
        /// Anchor on the parent.
        parent: Complex<R>,
        /// Anchor on the link.
        own: Complex<R>,
        /// Unit axis in the parent's frame.
        axis: Complex<R>,
        /// Constant relative heading.
        angle: R,
    },
}

/// What determines a coordinate.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Control {
    /// The laws of motion.
    #[default]
    Free,
    /// The laws of motion with a joint torque.
    Torque,
    /// A prescribed function of time.
    Prescribed,
}

/// One coordinate of the articulated system: a root's x, y or θ, or a joint's u.
#[derive(Clone, Copy, Debug, Default)]
pub struct CoordinateRecord<R> {
    /// Link it moves.
    pub(crate) link: usize,
    /// 0, 1, 2 for a root's x, y, θ; 3 for a joint.
    pub(crate) component: usize,
    /// What determines it.
    pub(crate) control: Control,
    /// Index among the free coordinates (unless prescribed).
    pub(crate) free: usize,
    /// Prescribed value or applied torque.
    pub(crate) signal: SignalRecord<R>,
    /// Prescribed and constant, or never driven.
    pub(crate) constant: bool,
    /// Added to a prescribed value.
    pub(crate) base: R,
    /// Spring constant.
    pub(crate) stiffness: R,
    /// Damping constant.
    pub(crate) damping: R,
    /// Unloaded spring.
    pub(crate) rest: R,
    /// Value and rate at the start, if free.
    pub(crate) start: [R; 2],
    /// Which of the three reals of all links it moves: the first, and how many from there on.
    pub(crate) moves: (usize, usize),
}

/// Sizes of what near contact needs in a simulation; 0 where it needs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NearDims {
    /// Nodes of all boundaries.
    pub nodes: usize,
    /// Reals of all rungs.
    pub rungs: usize,
}

/// Everything of a model that has a fixed size.
#[derive(Clone, Copy, Debug)]
pub struct ModelHead<R> {
    /// See [`Model::fingerprint`].
    pub(crate) fingerprint: u64,
    pub(crate) fluid_density: R,
    pub(crate) gravity: R,
    pub(crate) repulsion: Option<Repulsion<R>>,
    pub(crate) gyroscopic: bool,
    pub(crate) force: ForceFormula,
    /// Relative error in space that the scene asks for; 0: none.
    pub(crate) tolerance: R,
    /// Whether to go on above a bound of 1.
    pub(crate) allow_unresolved: bool,
    /// Nodes on walls; they come first.
    pub(crate) wall_nodes: usize,
    pub(crate) walls_at: usize,
    pub(crate) walls_regular_at: usize,
    pub(crate) channels: usize,
    pub(crate) near: NearDims,
    pub(crate) close_range_at: usize,
    pub(crate) close_range_len: usize,
    pub(crate) tracks_work: bool,
    pub(crate) prescribed_moves: bool,
    /// Lone body: added mass (without mass) and flux impulse of its circulation, per unit density, body frame.
    pub(crate) lone_added_mass: [R; 9],
    pub(crate) lone_impulse: [R; 3],
    /// Lone body: inverse of the mass of body and fluid, body frame.
    pub(crate) lone_inverse: [R; 9],
    /// Lone body: asymmetry of its discrete added mass, and error of the constant density.
    pub(crate) lone_resolution: [R; 2],
    pub(crate) plan: Plan,
}

/// A view of a compiled model. Thread-safe: shared by any number of simulations.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a, R> {
    pub(crate) head: &'a ModelHead<R>,
    pub(crate) links: &'a [LinkRecord<R>],
    pub(crate) coordinates: &'a [CoordinateRecord<R>],
    pub(crate) boundaries: &'a [BoundaryRecord<R>],
    pub(crate) store: &'a [R],
}

/// What a model tells about one of its links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkInfo<R> {
    /// Body and link.
    pub place: Place,
    /// Mass, kg/m.
    pub mass: R,
    /// Moment of inertia about the centre of mass, kg·m.
    pub inertia: R,
    /// Area, m².
    pub area: R,
    /// Perimeter, m.
    pub perimeter: R,
    /// Area centroid minus centre of mass, link frame, m.
    pub centroid: [R; 2],
    /// Nodes on its boundary.
    pub nodes: usize,
}

/// What a model tells about one of its joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointInfo {
    /// The link that the joint moves.
    pub place: Place,
    /// Moved as prescribed (or locked), not by a torque.
    pub prescribed: bool,
}

impl<'a, R: Real> Model<'a, R> {
    /// What is computed and what it costs.
    pub fn plan(&self) -> &'a Plan {
        &self.head.plan
    }
    /// A number that tells models apart: two scenes that differ in any value of any definition, in their precision or in the nodes
    /// that were chosen have different ones (but for a chance of 2⁻⁶⁴), equal scenes the same, on every machine. 0 and −0 count as
    /// different. O(1).
    pub fn fingerprint(&self) -> u64 {
        self.head.fingerprint
    }
    /// Is a coordinate an angle, and not a length?
    pub(crate) fn is_angle(&self, c: &CoordinateRecord<R>) -> bool {
        let slides = || self.links.get(c.link).is_some_and(|l| matches!(l.hold, Hold::Slider { .. }));
        c.component == 2 || (c.component == 3 && !slides())
    }
    /// Reach of the link that a coordinate moves.
    pub(crate) fn reach_of(&self, c: &CoordinateRecord<R>) -> R {
        self.boundaries.get(self.head.plan.walls + c.link).map_or(R::one(), |b| b.reach)
    }
    /// Number of links of all bodies.
    pub fn link_count(&self) -> usize {
        self.links.len()
    }
    /// Facts about link `i` (links of the first body first).
    pub fn link(&self, i: usize) -> Option<LinkInfo<R>> {
        let l = self.links.get(i)?;
        Some(LinkInfo {
            place: Place::Link(l.place.0, l.place.1),
            mass: l.mass,
            inertia: l.inertia,
            area: l.area,
            perimeter: l.perimeter,
            centroid: [l.centroid.re, l.centroid.im],
            nodes: self.boundaries.get(self.head.plan.walls + i)?.nodes,
        })
    }
    /// Nodes on a boundary, automatic or given. `None` if there is no such boundary.
    pub fn nodes(&self, place: Place) -> Option<usize> {
        self.boundaries.iter().find(|b| b.place == place).map(|b| b.nodes)
    }
    /// Number of channels (`Signal::Channel`), in the order of the coordinates.
    pub fn channel_count(&self) -> usize {
        self.head.channels
    }
    /// Number of joints of all bodies.
    pub fn joint_count(&self) -> usize {
        self.joints().count()
    }
    /// Facts about joint `j` (in the order of the links they move).
    pub fn joint(&self, j: usize) -> Option<JointInfo> {
        let c = self.joints().nth(j)?;
        let l = self.links.get(c.link)?;
        Some(JointInfo { place: Place::Link(l.place.0, l.place.1), prescribed: c.control == Control::Prescribed })
    }
    /// Tables of nodes for points close to an outline (empty: plain rule or no repulsion).
    pub(crate) fn close_range(&self) -> &'a [R] {
        let len = if features::NEAR { self.head.close_range_len } else { 0 };
        crate::base::memory::part(self.store, self.head.close_range_at, len)
    }
    pub(crate) fn joints(&self) -> impl Iterator<Item = &'a CoordinateRecord<R>> + use<'a, R> {
        self.coordinates.iter().filter(|c| c.component == 3)
    }
    /// What set-up noticed and mended, such as an outline that was turned round.
    pub fn notices(&self) -> impl Iterator<Item = (Place, Status)> + use<'a, R> {
        let limit = self.head.tolerance;
        self.boundaries.iter().flat_map(move |b| {
            let uncertain = b.outline_error > limit;
            let told = [(uncertain, Status::OutlineUncertain), (b.notice != Status::Ok, b.notice)];
            told.into_iter().filter_map(|(is, status)| is.then_some((b.place, status)))
        })
    }
    /// Of a curve through points, the relative error of added mass and area that may come from what is between the points
    /// ([`Shape::outline_error`](crate::scene::Shape::outline_error)); it is no part of the bound of the error in space. `None` for other
    /// shapes, and where there was no heap to find it ([`ModelMemory::look_at_points`](crate::ModelMemory::look_at_points)).
    pub fn outline_error(&self, place: Place) -> Option<R> {
        self.boundaries.iter().find(|b| b.place == place).map(|b| b.outline_error).filter(|e| !e.is_nan())
    }
    /// A point of an outline at parameter `t` ∈ [0, 2π): links in their own frame with the centre of mass as
    /// origin, walls in the world. `None` if there is no such boundary.
    pub fn outline_point(&self, place: Place, t: R) -> Option<[R; 2]> {
        let b = self.boundaries.iter().find(|b| b.place == place)?;
        let x = b.view(self.store).curve.jet_real(t)[0] - b.origin;
        let x = if b.link.is_none() { b.pose.place(x) } else { x };
        Some([x.re, x.im])
    }
    pub(crate) fn boundary(&self, i: usize) -> Option<(&'a BoundaryRecord<R>, Nodes<'a, R>)> {
        self.boundaries.get(i).map(|b| (b, b.nodes(self.store)))
    }
    /// Every boundary with its nodes, in the order of the unknowns.
    pub(crate) fn each_boundary(
        &self,
    ) -> impl Iterator<Item = (usize, &'a BoundaryRecord<R>, Nodes<'a, R>)> + Clone + use<'a, R> {
        let store = self.store;
        self.boundaries.iter().enumerate().map(move |(i, b)| (i, b, b.nodes(store)))
    }
    /// Place of a boundary.
    pub(crate) fn place(&self, boundary: usize) -> Place {
        self.boundaries.get(boundary).map_or(Place::Scene, |b| b.place)
    }
}
