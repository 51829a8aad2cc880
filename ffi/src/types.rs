//! Plain data of the interface. These comments are those of the header; ASCII only.

use core::marker::PhantomData;

/// Outcome of a call: 0 ok, > 0 a notice, < 0 an error (see the list above).
pub type nekton_status = i32;

/// Not set: refused.
pub const NEKTON_SHAPE_NONE: i32 = 0;
/// Semi-axes a along x and b along y.
pub const NEKTON_SHAPE_ELLIPSE: i32 = 1;
/// r(t) = radius (1 + amplitude cos(lobes t)).
pub const NEKTON_SHAPE_STAR: i32 = 2;
/// width by height about the origin, corners rounded by corner_radius.
pub const NEKTON_SHAPE_RECTANGLE: i32 = 3;
/// Simple polygon through points, corners rounded by corner_radius.
pub const NEKTON_SHAPE_POLYGON: i32 = 4;
/// Smooth closed curve through points.
pub const NEKTON_SHAPE_CURVE: i32 = 5;

/// An outline. Only the fields of its kind are read.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ShapeDef<R> {
    /// NEKTON_SHAPE_...
    pub kind: i32,
    /// Star: number of lobes.
    pub lobes: u32,
    /// Ellipse: semi-axis along x, m.
    pub a: R,
    /// Ellipse: semi-axis along y, m.
    pub b: R,
    /// Star: mean radius, m.
    pub radius: R,
    /// Star: relative amplitude, |amplitude| < 1.
    pub amplitude: R,
    /// Rectangle: extent along x, m.
    pub width: R,
    /// Rectangle: extent along y, m.
    pub height: R,
    /// Rectangle, polygon: radius of the corners, m; 0: a sharp corner's default.
    pub corner_radius: R,
    /// Polygon, curve: x, y of each point in order (the last joins the first). Declare the array const: before C23, C converts no
    /// `double (*)[2]` to this type without a cast.
    pub points: *const [R; 2],
    /// Number of points.
    pub point_count: usize,
}

/// The constant value.
pub const NEKTON_SIGNAL_CONSTANT: i32 = 0;
/// Sum of harmonic terms, times the window if window.ramp > 0.
pub const NEKTON_SIGNAL_HARMONIC: i32 = 1;
/// Rows (t, u, du/dt, d2u/dt2) at increasing times, quintic in between, constant outside.
pub const NEKTON_SIGNAL_TABLE: i32 = 2;
/// Set while running by nekton_sim_set_channel; 0 until then.
pub const NEKTON_SIGNAL_CHANNEL: i32 = 3;

/// offset + amplitude sin(frequency t + phase).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct HarmonicDef<R> {
    /// Amplitude.
    pub amplitude: R,
    /// Angular frequency, rad/s.
    pub frequency: R,
    /// Phase, rad.
    pub phase: R,
    /// Constant part.
    pub offset: R,
}

/// 0 outside (from, to), 1 between from + ramp and to - ramp, infinitely smooth in between.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WindowDef<R> {
    /// Start of the support, s.
    pub from: R,
    /// End of the support, s.
    pub to: R,
    /// Length of each ramp, s, at most half the support; all three 0: no window.
    pub ramp: R,
}

/// A function of time with two derivatives. All zero: the constant 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SignalDef<R> {
    /// NEKTON_SIGNAL_...
    pub kind: i32,
    /// Constant: its value.
    pub value: R,
    /// Harmonic: the terms.
    pub harmonics: *const HarmonicDef<R>,
    /// Number of terms.
    pub harmonic_count: usize,
    /// Harmonic: the window.
    pub window: WindowDef<R>,
    /// Table: the rows, const as the points of a shape.
    pub rows: *const [R; 4],
    /// Number of rows.
    pub row_count: usize,
}

/// A fixed boundary: the tank or an obstacle.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WallDef<R> {
    /// Outline.
    pub shape: ShapeDef<R>,
    /// Where the outline's own origin lies, m.
    pub position: [R; 2],
    /// Turn about the outline's own origin, rad.
    pub angle: R,
    /// Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes.
    pub nodes: usize,
    /// Circulation around an obstacle, m^2/s; must be 0 for the tank.
    pub circulation: R,
}

/// Homogeneous, of the link's density.
pub const NEKTON_MASS_DENSITY: i32 = 0;
/// The link's mass, inertia and centre_of_mass.
pub const NEKTON_MASS_GIVEN: i32 = 1;

/// The anchors coincide; u = heading of the link minus heading of the parent.
pub const NEKTON_JOINT_HINGE: i32 = 0;
/// The link's anchor slides along an axis of the parent; u = distance along it.
pub const NEKTON_JOINT_SLIDER: i32 = 1;

/// Held at locked_value.
pub const NEKTON_DRIVE_LOCKED: i32 = 0;
/// u(t) is prescribed by the signal.
pub const NEKTON_DRIVE_MOTION: i32 = 1;
/// Moves by the torque signal(t) - stiffness (u - rest) - damping du/dt.
pub const NEKTON_DRIVE_TORQUE: i32 = 2;

/// One rigid part of a body, with the joint by which it hangs on its parent.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct LinkDef<R> {
    /// Outline, drawn in the link's own frame (any origin).
    pub shape: ShapeDef<R>,
    /// Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes.
    pub nodes: usize,
    /// Circulation of the fluid around the link, counter-clockwise, m^2/s.
    pub circulation: R,
    /// NEKTON_MASS_...
    pub mass_kind: i32,
    /// Parent among the body's links; -1: none (the first link of a body, and only that).
    pub parent: i32,
    /// Density, kg/m^3, >= 0.
    pub density: R,
    /// Mass given: kg/m, >= 0.
    pub mass: R,
    /// Mass given: moment of inertia about the centre of mass, kg m, >= 0.
    pub inertia: R,
    /// Mass given: centre of mass minus area centroid, in the link's frame, m.
    pub centre_of_mass: [R; 2],
    /// NEKTON_JOINT_...; like all that follows of no meaning without a parent.
    pub joint: i32,
    /// NEKTON_DRIVE_...
    pub drive: i32,
    /// Anchor on the parent, from the parent's area centroid in the parent's frame, m.
    pub parent_anchor: [R; 2],
    /// Anchor on this link, from its area centroid in its own frame, m.
    pub self_anchor: [R; 2],
    /// Slider: its direction in the parent's frame (of any length but 0).
    pub axis: [R; 2],
    /// Slider: constant heading of the link minus that of the parent, rad.
    pub angle: R,
    /// Locked: the value of u, rad (slider: m).
    pub locked_value: R,
    /// Motion: u(t). Torque: the applied torque, N (slider: force, N/m).
    pub signal: SignalDef<R>,
    /// Torque: spring constant, >= 0.
    pub stiffness: R,
    /// Torque: damping constant, >= 0.
    pub damping: R,
    /// Torque: u of the unloaded spring.
    pub rest: R,
    /// Torque: u and du/dt at the start.
    pub start: [R; 2],
}

/// By the laws of motion.
pub const NEKTON_ROOT_FREE: i32 = 0;
/// x(t), y(t), theta(t) are given by the body's motion, added to its pose; its velocity is ignored.
pub const NEKTON_ROOT_PRESCRIBED: i32 = 1;

/// A body: a tree of links, of which the first is the root.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct BodyDef<R> {
    /// x, y, theta: centre of mass and heading of the first link.
    pub pose: [R; 3],
    /// Their rates.
    pub velocity: [R; 3],
    /// NEKTON_ROOT_...
    pub root: i32,
    /// Prescribed root: x(t), y(t), theta(t).
    pub motion: [SignalDef<R>; 3],
    /// Links; the first has no parent, every other one a parent before it.
    pub links: *const LinkDef<R>,
    /// Number of links, >= 1.
    pub link_count: usize,
}

/// Energy gradient and the gyroscopic (Kutta-Joukowski) force.
pub const NEKTON_CIRCULATION_FULL: i32 = 0;
/// Without the force linear in the velocities.
pub const NEKTON_CIRCULATION_PAPER: i32 = 1;

/// Exact gradient of the discrete added mass: conserves the discrete energy at any resolution.
pub const NEKTON_FORCE_EXACT_GRADIENT: i32 = 0;
/// A boundary integral, as an independent cross-check; not with a prescribed joint or root.
pub const NEKTON_FORCE_BOUNDARY: i32 = 1;

/// Nodes crowd where boundaries come close, and the kernel's pole beside a boundary is integrated in closed form: spectral
/// accuracy down to tiny gaps. Costs nothing for boundaries that are far apart. UNSUPPORTED in archives for
/// microcontrollers, unless they were built with the feature near.
pub const NEKTON_QUADRATURE_GRADED: i32 = 0;
/// Fixed nodes and the plain trapezoidal rule: least code and memory; some 36/gap nodes per unit of length are needed.
pub const NEKTON_QUADRATURE_PLAIN: i32 = 1;

/// Everything that describes a scene. To be filled by nekton_scene_def_init first. Only read while a call runs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SceneDef<R> {
    /// sizeof of this struct; set by nekton_scene_def_init.
    pub struct_size: u32,
    /// NEKTON_ABI_VERSION of the caller; set by nekton_scene_def_init.
    pub abi_version: u32,
    /// Density of the fluid, kg/m^3, >= 0; 0: bodies in vacuum.
    pub fluid_density: R,
    /// Gravitational acceleration along -y, m/s^2.
    pub gravity: R,
    /// Strength of the repulsion of near boundaries, >= 0; 0: none.
    pub repulsion_epsilon: R,
    /// Exponent of the repulsion, > 0.
    pub repulsion_alpha: R,
    /// NEKTON_CIRCULATION_...; of meaning only if some circulation is not 0.
    pub circulation: i32,
    /// NEKTON_FORCE_...
    pub force: i32,
    /// NEKTON_QUADRATURE_...
    pub quadrature: i32,
    /// Relative error in space that is asked for: boundaries of 0 nodes get as many as it takes, and a step that exceeds it
    /// returns NEKTON_N_UNRESOLVED. 0: 1e-8 (single precision: 1.2e-3) if some boundary has 0 nodes, else none is asked for.
    pub tolerance: R,
    /// 1: use what symmetry makes unnecessary (a lone body, a lone swimmer); 0: only to cross-check.
    pub shortcuts: i32,
    /// The fluid is inside this outline; NULL: no tank.
    pub tank: *const WallDef<R>,
    /// Fixed obstacles.
    pub obstacles: *const WallDef<R>,
    /// Number of obstacles.
    pub obstacle_count: usize,
    /// Moving bodies.
    pub bodies: *const BodyDef<R>,
    /// Number of bodies, >= 1.
    pub body_count: usize,
}

/// Classical Runge-Kutta of order 4, fixed step, 4 evaluations a step.
pub const NEKTON_METHOD_RK4: i32 = 1;
/// Adams-Bashforth-Moulton of order 4, fixed step, 2 evaluations a step.
pub const NEKTON_METHOD_ABM4: i32 = 2;
/// Adams-Bashforth-Moulton of variable order 1 to 12 and variable step, 2 evaluations a step.
pub const NEKTON_METHOD_ADAMS: i32 = 3;
/// Implicit Gauss-Legendre of order 6, fixed step, 20 to 40 evaluations a step: the energy does not drift. UNSUPPORTED in
/// archives for microcontrollers, unless they were built with the feature implicit.
pub const NEKTON_METHOD_GAUSS6: i32 = 4;

/// How a simulation is integrated in time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MethodDef<R> {
    /// NEKTON_METHOD_...
    pub kind: i32,
    /// RK4, ABM4, GAUSS6: step, s.
    pub step: R,
    /// ADAMS: relative tolerance of each step.
    pub relative: R,
    /// ADAMS: absolute tolerance of each step.
    pub absolute: R,
}

/// Memory that an object needs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct nekton_req {
    /// Bytes.
    pub size: usize,
    /// Alignment, bytes: a power of two, at most NEKTON_ALIGN.
    pub align: usize,
}

/// No place, or nothing.
pub const NEKTON_PLACE_NONE: i32 = -1;
/// The scene as a whole.
pub const NEKTON_PLACE_SCENE: i32 = 0;
/// The tank.
pub const NEKTON_PLACE_TANK: i32 = 1;
/// Obstacle number index.
pub const NEKTON_PLACE_OBSTACLE: i32 = 2;
/// Body number index.
pub const NEKTON_PLACE_BODY: i32 = 3;
/// Link number link of body number index.
pub const NEKTON_PLACE_LINK: i32 = 4;

/// A place in the scene. Numbers count from 0; -1 where there is none.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct nekton_place {
    /// NEKTON_PLACE_...
    pub kind: i32,
    /// Obstacle or body.
    pub index: i32,
    /// Link within the body.
    pub link: i32,
}

/// What a call has to say: status, where, which value. Every function that takes one accepts NULL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct nekton_diag {
    /// What the call returned.
    pub status: nekton_status,
    /// Where.
    pub place: nekton_place,
    /// The other party of a contact or overlap.
    pub other: nekton_place,
    /// Number of the point, row or harmonic term that is wrong; -1: none.
    pub item: i32,
    /// The offending value; NaN: none.
    pub value: f64,
    /// Simulated time that was reached before the error, s; NaN where there is none.
    pub time: f64,
    /// Name of the offending quantity; empty: none.
    pub what: [core::ffi::c_char; 32],
}

/// The general case: coordinates and their rates.
pub const NEKTON_FORMULATION_VELOCITY: i32 = 0;
/// A lone rigid body: constant added mass.
pub const NEKTON_FORMULATION_KIRCHHOFF: i32 = 1;
/// A lone swimmer: conserved impulse, first order in time.
pub const NEKTON_FORMULATION_LOCKED_MOMENTUM: i32 = 2;

/// What a model computes and what that costs. Counts are per evaluation.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct nekton_plan {
    /// NEKTON_FORMULATION_...
    pub formulation: i32,
    /// 1: a fluid of positive density.
    pub fluid: i32,
    /// 1: gravity and buoyancy.
    pub gravity: i32,
    /// 1: repulsion.
    pub repulsion: i32,
    /// 1: circulation.
    pub circulation: i32,
    /// Moving links.
    pub links: usize,
    /// Fixed boundaries (tank and obstacles).
    pub walls: usize,
    /// Joints.
    pub joints: usize,
    /// Channels (signals set while running).
    pub channels: usize,
    /// Notices of set-up (see nekton_model_notice).
    pub notices: usize,
    /// Coordinates: 3 per link. Length of positions, forces; matrices are coordinates x coordinates.
    pub coordinates: usize,
    /// Coordinates that obey the laws of motion.
    pub free_coordinates: usize,
    /// Coordinates that are prescribed functions of time.
    pub prescribed_coordinates: usize,
    /// Length of the integrated state.
    pub state_len: usize,
    /// Unknowns of the boundary system; 0 when none is solved while stepping.
    pub unknowns: usize,
    /// Unknowns on moving links.
    pub moving_unknowns: usize,
    /// Right-hand sides solved (transposed ones included).
    pub right_hand_sides: usize,
    /// Relative error in space that is asked for; 0: none.
    pub tolerance: f64,
    /// Bytes of the model.
    pub model_bytes: usize,
    /// Bytes of a simulation.
    pub sim_bytes: usize,
    /// Floating-point operations, leading terms.
    pub operations: f64,
}

/// Facts about a link.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkOut<R> {
    /// Body and link.
    pub place: nekton_place,
    /// Nodes on its boundary.
    pub nodes: usize,
    /// Mass, kg/m.
    pub mass: R,
    /// Moment of inertia about the centre of mass, kg m.
    pub inertia: R,
    /// Area, m^2.
    pub area: R,
    /// Perimeter, m.
    pub perimeter: R,
    /// Area centroid minus centre of mass, link frame, m.
    pub centroid: [R; 2],
}

/// Facts about a joint.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct nekton_joint_info {
    /// The link that the joint moves.
    pub place: nekton_place,
    /// 1: moved as prescribed (or locked); 0: by a torque.
    pub prescribed: i32,
}

/// Energies, J/m.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyOut<R> {
    /// Kinetic energy of the fluid moved by the bodies.
    pub kinetic_fluid: R,
    /// Kinetic energy of the bodies.
    pub kinetic_bodies: R,
    /// Potential energy of weight and buoyancy.
    pub buoyancy: R,
    /// Potential energy of repulsion.
    pub repulsion: R,
    /// Kinetic energy of the circulatory flow, up to a constant.
    pub circulation: R,
    /// Sum of the five.
    pub total: R,
    /// Work done by the drives since the start; total - work is constant.
    pub work: R,
}

/// Relative error indicators of the space discretization. They do not see an error of the shape itself.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolutionOut<R> {
    /// Asymmetry of the discrete added mass before it is symmetrized.
    pub mass: R,
    /// Difference of two halves of the force that should be equal, relative to the largest force; 0 with the boundary formula.
    pub force: R,
    /// Error of the constant density as a solution of the boundary system.
    pub quadrature: R,
    /// Estimated error of the double integrals of the repulsion, relative to its largest force between two boundaries; 0 without
    /// repulsion.
    pub repulsion: R,
    /// Bound of the relative error of added mass, force and repulsion: 100 times the largest of the four.
    pub bound: R,
}

/// Estimated local errors of time integration, that is of each step by itself, from nekton_sim_time_error: each the largest over
/// the free coordinates of its kind, 0 if there are none. Lengths are the x and y of bodies and what sliders slide, angles the
/// headings of bodies and hinges.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeErrorOut<R> {
    /// Of lengths in the last step that could be estimated, m; NaN if there was none.
    pub length: R,
    /// Of angles, rad; NaN as above.
    pub angle: R,
    /// Of the rates of lengths, m/s; NaN as above; 0 for a lone swimmer, whose rates are not integrated.
    pub speed: R,
    /// Of the rates of angles, rad/s; NaN and 0 as above.
    pub spin: R,
    /// Sum over all steps that could be estimated, m.
    pub length_sum: R,
    /// The same of angles, rad.
    pub angle_sum: R,
    /// Of the rates of lengths, m/s.
    pub speed_sum: R,
    /// Of the rates of angles, rad/s.
    pub spin_sum: R,
    /// Number of steps that could not be estimated, and are missing in the sums.
    pub unknown: u64,
}

/// The smallest gap between two boundaries of which one moves.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapOut<R> {
    /// Distance, m; infinite when there is only one boundary.
    pub distance: R,
    /// One boundary.
    pub first: nekton_place,
    /// The other.
    pub second: nekton_place,
}

/// What a simulation did since its start. Calls that failed count nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct nekton_counters {
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
    /// Factorizations of the boundary system.
    pub factorizations: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
}

/// A compiled scene. Never changes; any number of threads and simulations may use it at once.
pub struct ModelHandle<R>(PhantomData<R>);

/// A simulation of a model. One thread at a time.
pub struct SimHandle<R>(PhantomData<R>);
