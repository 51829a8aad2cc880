//! The description of a scene, as the caller gives it: plain data borrowed from anywhere.
//!
//! Units are SI per unit depth: lengths m, density kg/m³ (so mass kg/m, inertia kg·m), circulation m²/s,
//! torque N, force N/m, energy J/m. Angles are radians, counter-clockwise.

use crate::base::scalar::Real;

/// Everything that describes a scene. Absent ingredients (no gravity, no repulsion, no circulation, no
/// walls, fluid density 0) cost neither time nor memory.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a, R> {
    /// Density of the fluid, ≥ 0; 0 means bodies in vacuum.
    pub fluid_density: R,
    /// Gravitational acceleration along −y.
    pub gravity: R,
    /// Short-range repulsion of boundaries; `None` is off.
    pub repulsion: Option<Repulsion<R>>,
    /// How circulation enters the motion (only if some circulation is not 0).
    pub circulation: CirculationModel,
    /// The tank: the fluid is inside this outline.
    pub tank: Option<Wall<'a, R>>,
    /// Fixed obstacles: the fluid is outside these outlines.
    pub obstacles: &'a [Wall<'a, R>],
    /// The moving bodies.
    pub bodies: &'a [Body<'a, R>],
    /// Formula of the Christoffel force.
    pub force: ForceFormula,
    /// How integrals over the boundaries are formed where boundaries come close to each other or to themselves.
    pub quadrature: Quadrature,
    /// Relative error in space that is asked for: boundaries of 0 nodes get as many as it takes (`None`:
    /// [`DEFAULT_TOLERANCE`](crate::DEFAULT_TOLERANCE)), and a simulation notices when it is exceeded (`None`: when the bound of the
    /// error exceeds a thousandth).
    pub tolerance: Option<R>,
    /// Go on where the bound of the relative error in space exceeds 1. Off: that is refused (`BoundExceeded`), since such numbers mean
    /// nothing.
    pub allow_unresolved: bool,
    /// Use what symmetry makes unnecessary (a lone body, a lone swimmer). Off only to cross-check.
    pub shortcuts: bool,
}

/// A scene as set-up reads it: item by item, by value. [`Scene`] is one; an interface to another language can be another,
/// without converting its arrays first. Counts and items must not change while a model is made of them.
pub trait Description<R: Real> {
    /// The scalar settings; walls and bodies of the value are not read.
    fn settings(&self) -> Scene<'_, R>;
    /// The tank.
    fn tank(&self) -> Option<Wall<'_, R>>;
    /// Number of obstacles.
    fn obstacle_count(&self) -> usize;
    /// Obstacle `i`; `None` from the count on.
    fn obstacle(&self, i: usize) -> Option<Wall<'_, R>>;
    /// Number of bodies.
    fn body_count(&self) -> usize;
    /// Body `b`; the value's links are not read. `None` from the count on.
    fn body(&self, b: usize) -> Option<Body<'_, R>>;
    /// Number of links of body `b`.
    fn link_count(&self, b: usize) -> usize;
    /// Link `l` of body `b`; `None` from the count on.
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, R>>;
    /// The same as it is compared with others: nodes that [`Description::link`] works out from what is given may be left as they are given.
    fn link_as_given(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.link(b, l)
    }
}

impl<R: Real> Description<R> for Scene<'_, R> {
    fn settings(&self) -> Scene<'_, R> {
        *self
    }
    fn tank(&self) -> Option<Wall<'_, R>> {
        self.tank
    }
    fn obstacle_count(&self) -> usize {
        self.obstacles.len()
    }
    fn obstacle(&self, i: usize) -> Option<Wall<'_, R>> {
        self.obstacles.get(i).copied()
    }
    fn body_count(&self) -> usize {
        self.bodies.len()
    }
    fn body(&self, b: usize) -> Option<Body<'_, R>> {
        self.bodies.get(b).copied()
    }
    fn link_count(&self, b: usize) -> usize {
        self.bodies.get(b).map_or(0, |body| body.links.len())
    }
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.bodies.get(b)?.links.get(l).copied()
    }
}

/// V = ε Σ ∬ |x − x'|^(−α) ds ds' over pairs of boundaries of which at least one moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion<R> {
    /// Exponent α > 0.
    pub alpha: R,
    /// Strength ε ≥ 0.
    pub epsilon: R,
}

/// Model of the force of circulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum CirculationModel {
    /// Energy gradient and the gyroscopic (Kutta–Joukowski) force.
    #[default]
    Full,
    /// The paper's (3.4): without the force linear in the velocities.
    Paper,
}

/// Formula of the Christoffel force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ForceFormula {
    /// Exact gradient of the discrete added mass: conserves the discrete energy at any resolution.
    #[default]
    ExactGradient,
    /// The boundary integral (2.15), as an independent cross-check, for every scene: one transposed solve gives the whole
    /// force. Agrees with the exact gradient where space is resolved; conserves energy only there.
    Boundary,
}

/// Quadrature of boundary integrals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Quadrature {
    /// Nodes crowd where boundaries face each other, and the pole of the kernel beside a boundary is integrated in closed
    /// form: spectral accuracy down to tiny gaps. Costs nothing for pairs that are far apart. Needs the feature `near`, which
    /// `std` includes; without it a scene that asks for it is refused as `Unsupported`.
    #[default]
    Graded,
    /// Fixed nodes and the plain trapezoidal rule: least code and memory; some 36/gap nodes per unit of length are needed.
    Plain,
}

/// A fixed boundary.
#[derive(Clone, Copy, Debug)]
pub struct Wall<'a, R> {
    /// Outline.
    pub shape: Shape<'a, R>,
    /// Where the outline's own origin lies.
    pub position: [R; 2],
    /// Turn about the outline's own origin.
    pub angle: R,
    /// Nodes, even, ≥ 8; 0: as many as the scene's tolerance takes ([`Scene::tolerance`]). With a heap `ModelBuf::new` looks whether they
    /// suffice at the start.
    pub nodes: usize,
    /// Circulation around an obstacle (must be 0 for the tank).
    pub circulation: R,
}

/// A body: a tree of links, of which the first is the root.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a, R> {
    /// (x, y, θ): centre of mass and heading of the first link.
    pub pose: [R; 3],
    /// (ẋ, ẏ, θ̇) of the first link.
    pub velocity: [R; 3],
    /// Free, or moved as prescribed.
    pub root: Root<'a, R>,
    /// Links; the first has no joint, every other one a parent before it.
    pub links: &'a [Link<'a, R>],
}

/// How the first link of a body moves.
#[derive(Clone, Copy, Debug)]
pub enum Root<'a, R> {
    /// By the laws of motion.
    Free,
    /// x(t), y(t), θ(t) are given, added to the body's `pose`; `velocity` is ignored.
    Prescribed([Signal<'a, R>; 3]),
}

/// One rigid part of a body.
#[derive(Clone, Copy, Debug)]
pub struct Link<'a, R> {
    /// Outline, drawn in the link's own frame (any origin).
    pub shape: Shape<'a, R>,
    /// Mass properties.
    pub mass: Mass<R>,
    /// Nodes, even, ≥ 8; 0: as many as the scene's tolerance takes ([`Scene::tolerance`]). With a heap `ModelBuf::new` looks whether they
    /// suffice at the start.
    pub nodes: usize,
    /// Circulation of the fluid around the link, counter-clockwise.
    pub circulation: R,
    /// How it hangs on its parent (`None` for the first link).
    pub joint: Option<Joint<'a, R>>,
}

/// Mass properties of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mass<R> {
    /// Homogeneous, of this density (≥ 0).
    Density(R),
    /// Given mass, moment of inertia about the centre of mass, and that centre measured from the
    /// outline's area centroid, in the link's frame.
    Given {
        /// kg/m, ≥ 0.
        mass: R,
        /// kg·m, ≥ 0.
        inertia: R,
        /// Centre of mass minus centroid.
        centre_of_mass: [R; 2],
    },
}

/// A joint between a link and its parent. Anchors are measured from the area centroids, in the links' own frames.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a, R> {
    /// Index of the parent within the body (smaller than the link's own).
    pub parent: usize,
    /// Hinge or slider.
    pub kind: JointKind<R>,
    /// Anchor on the parent.
    pub parent_anchor: [R; 2],
    /// Anchor on the link itself.
    pub self_anchor: [R; 2],
    /// What moves the joint.
    pub drive: Drive<'a, R>,
}

/// Degree of freedom of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind<R> {
    /// The anchors coincide; u = heading of the link minus heading of the parent.
    Hinge,
    /// The link's anchor slides along an axis of the parent; u = distance along it.
    Slider {
        /// Direction in the parent's frame (need not be of unit length; it is normalized).
        axis: [R; 2],
        /// Constant heading of the link minus that of the parent.
        angle: R,
    },
}

/// What moves a joint.
#[derive(Clone, Copy, Debug)]
pub enum Drive<'a, R> {
    /// Held at this value.
    Locked(R),
    /// u(t) is prescribed.
    Motion(Signal<'a, R>),
    /// The joint moves by the torque ν(t) − stiffness (u − rest) − damping u̇ (Theorem 7.1).
    Torque {
        /// Applied torque (a force for a slider).
        torque: Signal<'a, R>,
        /// Spring constant, ≥ 0.
        stiffness: R,
        /// Damping constant, ≥ 0.
        damping: R,
        /// Position of the unloaded spring.
        rest: R,
        /// u and u̇ at the start.
        start: [R; 2],
    },
}

/// A scalar function of time, with two derivatives.
#[derive(Clone, Copy, Debug)]
pub enum Signal<'a, R> {
    /// Constant.
    Constant(R),
    /// Σ offset + amplitude sin(frequency t + phase), times a window if there is one.
    Harmonic {
        /// Terms of the sum.
        terms: &'a [Harmonic<R>],
        /// Smooth window of compact support.
        window: Option<Window<R>>,
    },
    /// Rows (t, u, u̇, ü) at increasing times, quintic in between, constant outside.
    Table(&'a [[R; 4]]),
    /// Set by the caller while running (`Sim::set_channel`); 0 until then.
    Channel,
}

/// One harmonic term: offset + amplitude sin(frequency t + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Harmonic<R> {
    /// Amplitude.
    pub amplitude: R,
    /// Angular frequency, rad/s.
    pub frequency: R,
    /// Phase, rad.
    pub phase: R,
    /// Constant part.
    pub offset: R,
}

/// 0 outside (from, to), 1 between from + ramp and to − ramp, infinitely smooth in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window<R> {
    /// Start of the support.
    pub from: R,
    /// End of the support.
    pub to: R,
    /// Length of each ramp, at most half the support; more than 64 roundings of the times.
    pub ramp: R,
}

/// An outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<'a, R> {
    /// Semi-axes along x and y.
    Ellipse {
        /// Along x.
        a: R,
        /// Along y.
        b: R,
    },
    /// r(t) = radius (1 + amplitude cos(lobes t)).
    Star {
        /// Mean radius.
        radius: R,
        /// Relative amplitude, |amplitude| < 1.
        amplitude: R,
        /// Number of lobes.
        lobes: usize,
    },
    /// Rectangle about the origin with rounded corners.
    Rectangle {
        /// Along x.
        width: R,
        /// Along y.
        height: R,
        /// Corner radius; `None`: the documented default of a "sharp" corner.
        radius: Option<R>,
    },
    /// Simple polygon with rounded corners.
    Polygon {
        /// Corners.
        vertices: &'a [[R; 2]],
        /// Corner radius; `None`: the documented default of a "sharp" corner.
        radius: Option<R>,
    },
    /// Smooth closed curve through given points.
    Curve {
        /// Points in order (the last joins the first).
        points: &'a [[R; 2]],
        /// Which of them are corners.
        corners: Corners<'a>,
    },
}

impl<'a, R> Shape<'a, R> {
    /// Curve through given points, with the corners that they show.
    pub const fn curve(points: &'a [[R; 2]]) -> Self {
        Shape::Curve { points, corners: Corners::Auto }
    }
}

/// Points of a curve at which its direction jumps. A corner is rounded as those of a polygon are, by a length r of 2·10⁻⁶ of the outline's
/// size (single precision: 6·10⁻⁵), at most 1/64 of the segments beside it: it is cut off by 1.4 r cos(turn/2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corners<'a> {
    /// Where the points show a kink (notice `CornersFound`): a turn of 29° to 175° that is four times its neighbours', as is its curvature,
    /// with at least three points between it and the next corner, or none at a blunt end. Outlines of less than eight points have none.
    #[default]
    Auto,
    /// Nowhere: the curve is smooth.
    None,
    /// At these points, counted from 0; of many, increasing numbers are found quickest.
    At(&'a [usize]),
}

impl<R: Real> Scene<'_, R> {
    /// Fluid of density 1, nothing else.
    pub const fn new(fluid_density: R, gravity: R) -> Self {
        Scene {
            fluid_density,
            gravity,
            repulsion: None,
            circulation: CirculationModel::Full,
            tank: None,
            obstacles: &[],
            bodies: &[],
            force: ForceFormula::ExactGradient,
            quadrature: Quadrature::Graded,
            tolerance: None,
            allow_unresolved: false,
            shortcuts: true,
        }
    }
}

/// Every link with its body and place in the body.
pub(crate) fn each_link<'a, R: Real, S: Description<R>>(
    scene: &'a S,
) -> impl Iterator<Item = (usize, usize, Link<'a, R>)> + Clone {
    (0..scene.body_count())
        .flat_map(move |b| (0..scene.link_count(b)).filter_map(move |l| Some((b, l, scene.link(b, l)?))))
}

/// Every link as it is given.
pub(crate) fn each_link_as_given<'a, R: Real, S: Description<R>>(
    scene: &'a S,
) -> impl Iterator<Item = Link<'a, R>> + Clone {
    (0..scene.body_count()).flat_map(move |b| (0..scene.link_count(b)).filter_map(move |l| scene.link_as_given(b, l)))
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
