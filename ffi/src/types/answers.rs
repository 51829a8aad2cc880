//! Plain data that calls give, and handles. These comments are those of the header; ASCII only.

use core::marker::PhantomData;

/// Outcome of a call: 0 ok, > 0 a notice, < 0 an error (see the list above).
pub type nekton_status = i32;

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
    /// What the value had to keep to (steps that are allowed, the present time); NaN: none.
    pub limit: f64,
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

/// What a simulation did since its start. A call that failed counts nothing but steps that it kept.
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
