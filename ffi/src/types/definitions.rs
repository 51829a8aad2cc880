//! Plain data that the caller fills: scenes and methods. These comments are those of the header; ASCII only.
//!
//! Walls, links, bodies, scenes and methods begin with their size and grow at their end (sized.rs). What lies within them (shapes,
//! signals, windows) never changes its size, or what follows it would move.

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
    /// Length of each ramp, s, at most half the support, more than 64 roundings of the times; all three 0: no window.
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

/// Where the points of a curve show a kink: a turn of 29 to 175 degrees that stands out (notice NEKTON_N_CORNERS_FOUND).
pub const NEKTON_CORNERS_AUTO: i32 = 0;
/// Nowhere: the curve is smooth.
pub const NEKTON_CORNERS_NONE: i32 = 1;
/// At corner_points.
pub const NEKTON_CORNERS_GIVEN: i32 = 2;

/// A fixed boundary: the tank or an obstacle. To be filled by nekton_wall_def_init first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WallDef<R> {
    /// sizeof of this struct; set by nekton_wall_def_init.
    pub struct_size: u32,
    /// Outline.
    pub shape: ShapeDef<R>,
    /// Where the outline's own origin lies, m.
    pub position: [R; 2],
    /// Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes.
    pub nodes: usize,
    /// Turn about the outline's own origin, rad.
    pub angle: R,
    /// Circulation around an obstacle, m^2/s; must be 0 for the tank.
    pub circulation: R,
    /// Curve: which of its points are corners; NEKTON_CORNERS_...
    pub corners: i32,
    /// Must be 0.
    pub corners_reserved: i32,
    /// Given corners: numbers of the points, from 0.
    pub corner_points: *const usize,
    /// Number of given corners.
    pub corner_count: usize,
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

/// One rigid part of a body, with the joint by which it hangs on its parent. To be filled by nekton_link_def_init first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct LinkDef<R> {
    /// sizeof of this struct; set by nekton_link_def_init.
    pub struct_size: u32,
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
    /// Torque: u of the unloaded spring.
    pub rest: R,
    /// Motion: u(t). Torque: the applied torque, N (slider: force, N/m).
    pub signal: SignalDef<R>,
    /// Torque: spring constant, >= 0.
    pub stiffness: R,
    /// Torque: damping constant, >= 0.
    pub damping: R,
    /// Torque: u and du/dt at the start.
    pub start: [R; 2],
    /// Curve: which of its points are corners; NEKTON_CORNERS_...
    pub corners: i32,
    /// Must be 0.
    pub corners_reserved: i32,
    /// Given corners: numbers of the points, from 0.
    pub corner_points: *const usize,
    /// Number of given corners.
    pub corner_count: usize,
}

/// By the laws of motion.
pub const NEKTON_ROOT_FREE: i32 = 0;
/// x(t), y(t), theta(t) are given by the body's motion, added to its pose; its velocity is ignored.
pub const NEKTON_ROOT_PRESCRIBED: i32 = 1;

/// A body: a tree of links, of which the first is the root. To be filled by nekton_body_def_init first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct BodyDef<R> {
    /// sizeof of this struct; set by nekton_body_def_init.
    pub struct_size: u32,
    /// NEKTON_ROOT_...
    pub root: i32,
    /// x, y, theta: centre of mass and heading of the first link.
    pub pose: [R; 3],
    /// Their rates.
    pub velocity: [R; 3],
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
    /// returns NEKTON_N_UNRESOLVED. 0: boundaries of 0 nodes get as many as 1e-6 takes (single precision: 1.2e-3), and a step whose
    /// bound exceeds 1e-3 returns NEKTON_N_UNRESOLVED.
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
    /// 1: go on where the bound of the relative error in space exceeds 1; 0: that is refused (NEKTON_E_BOUND_EXCEEDED).
    pub allow_unresolved: i32,
    /// 0.
    pub reserved: i32,
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

/// How a simulation is integrated in time. To be filled by nekton_method_init first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MethodDef<R> {
    /// sizeof of this struct; set by nekton_method_init.
    pub struct_size: u32,
    /// NEKTON_METHOD_...
    pub kind: i32,
    /// RK4, ABM4, GAUSS6: step, s.
    pub step: R,
    /// ADAMS: relative tolerance of each step.
    pub relative: R,
    /// ADAMS: absolute tolerance of each step.
    pub absolute: R,
    /// ADAMS: longest step, s; 0: none. Must be 0 for a method of fixed steps.
    pub max_step: R,
    /// ADAMS: first step after a start, s (shorter if the tolerances ask for that); 0: chosen. Must be 0 for a method of fixed steps.
    pub first_step: R,
}

/// Density of the fluid, kg/m^2; the masses of bodies stay.
pub const NEKTON_PARAMETER_FLUID_DENSITY: i32 = 1;
/// Gravity, m/s^2.
pub const NEKTON_PARAMETER_GRAVITY: i32 = 2;
/// Mass of link index, kg/m.
pub const NEKTON_PARAMETER_MASS: i32 = 3;
/// Moment of inertia of link index about its centre of mass, kg m.
pub const NEKTON_PARAMETER_INERTIA: i32 = 4;
/// Force from outside on link index, world: component 0 along x, 1 along y, N/m; 2: torque about the centre of mass, N.
pub const NEKTON_PARAMETER_WRENCH: i32 = 5;
/// Torque (slider: force) added to that of torque-driven joint index.
pub const NEKTON_PARAMETER_TORQUE: i32 = 6;
/// Spring constant of torque-driven joint index.
pub const NEKTON_PARAMETER_STIFFNESS: i32 = 7;
/// Damping constant of torque-driven joint index.
pub const NEKTON_PARAMETER_DAMPING: i32 = 8;
/// Unloaded position of the spring of torque-driven joint index.
pub const NEKTON_PARAMETER_REST: i32 = 9;
/// Value of prescribed joint index; its rate and acceleration stay.
pub const NEKTON_PARAMETER_POSITION: i32 = 10;
/// Rate of prescribed joint index.
pub const NEKTON_PARAMETER_RATE: i32 = 11;
/// Acceleration of prescribed joint index.
pub const NEKTON_PARAMETER_ACCELERATION: i32 = 12;

/// What the motion is differentiated by. Joints and links count from 0, as in nekton_sim_joint_values and nekton_sim_positions.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct nekton_parameter {
    /// NEKTON_PARAMETER_...
    pub kind: i32,
    /// Link or joint.
    pub index: i32,
    /// Of a wrench.
    pub component: i32,
    /// 0.
    pub reserved: i32,
}
