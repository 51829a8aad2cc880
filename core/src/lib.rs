#![no_std]
#![cfg_attr(not(test), deny(clippy::indexing_slicing, clippy::unwrap_used, clippy::expect_used, clippy::panic))]
//! Rigid and articulated bodies moving in a 2D ideal fluid: unbounded, with obstacles, or in a tank; with buoyancy,
//! circulation, and repulsion on near-contact.
//!
//! # A first run
//!
//! ```
//! use nekton::scene::{Body, Link, Mass, Root, Scene, Shape};
//! use nekton::{Method, ModelBuf, SimBuf};
//! use std::sync::Arc;
//!
//! let ellipse = Link {
//!     shape: Shape::Ellipse { a: 1.0, b: 0.4 },
//!     mass: Mass::Density(1.2),
//!     nodes: 64,
//!     circulation: 0.0,
//!     joint: None,
//! };
//! let links = [ellipse];
//! let body = Body { pose: [0.0, 0.0, 0.3], velocity: [0.0; 3], root: Root::Free, links: &links };
//! let bodies = [body, Body { pose: [3.0, 0.0, 0.0], ..body }];
//! let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 9.81) };
//!
//! let model = Arc::new(ModelBuf::new(&scene)?);
//! let mut sim = SimBuf::new(model, Method::adams(1e-9, 1e-9))?;
//! let mut sim = sim.view();
//! sim.advance(1.0)?;
//! assert!(sim.positions()[1] < 0.0 && sim.energy()?.kinetic_fluid > 0.0);
//! # Ok::<(), nekton::Error>(())
//! ```
//!
//! Units are SI per metre of depth: kg/m, kg·m, N/m, J/m; angles are in radians, counter-clockwise. The formulas are numbered as
//! in docs/physics.md of the repository, which is the paper of A. Munnier and B. Pinçon with its errata.
//!
//! # From a scene to numbers
//!
//! 1. **Describe.** [`scene`]: a [`Scene`](scene::Scene) is plain, borrowed data: fluid, gravity, repulsion, circulation, tank,
//!    obstacles, and bodies of links with joints. An interface that has scenes of its own implements
//!    [`Description`](scene::Description) instead.
//! 2. **Compile.** [`ModelBuf::new`], or [`Model::init`] in the caller's memory, checks the scene and makes an immutable
//!    [`Model`]: outlines, nodes, what rigid motion leaves unchanged. [`ModelBuf::new`] also looks whether automatic node counts
//!    meet the scene's tolerance at the start. [`Model::plan`] tells what will be computed and what that costs.
//! 3. **Step.** [`SimBuf::new`], or [`Sim::init`], begins a [`Sim`] with one [`Method`]: [`Sim::advance`] to a time, [`Sim::advance_dense`] for
//!    output at many times, [`Sim::step`] for one step; [`Sim::set_state`] and [`Sim::set_channel`] from outside; [`Sim::rhs`] for an
//!    integrator of your own. One model serves any number of simulations, one per thread.
//!    [`Sim::save`] gives the simulation as bytes, from which [`Sim::load`] goes on bit for bit, in any process.
//! 4. **Ask**, between steps. Vectors have 3 numbers per link (x, y, θ, or force along x, y and torque about the centre of
//!    mass), matrices are 3n × 3n, column by column:
//!
//!    | to know | ask | formula |
//!    |---|---|---|
//!    | where everything is and how it moves | [`Sim::positions`], [`Sim::velocities`], [`Sim::joint_values`], [`Sim::accelerations`] | (6.3) |
//!    | energies, impulse, the smallest gap | [`Sim::energy`], [`Sim::impulse`], [`Sim::gap`] | |
//!    | added mass, mass matrix | [`Sim::added_mass`], [`Sim::mass_matrix`] | (2.11) |
//!    | the inertial force of a changing mass matrix | [`Sim::christoffel`], [`Sim::christoffel_tensor`] | (2.15) |
//!    | weight and buoyancy | [`Sim::buoyancy`] | (2.8), (2.16) |
//!    | repulsion | [`Sim::repulsion`] | (5.1) |
//!    | circulation: energy gradient, lift | [`Sim::circulation_gradient`], [`Sim::gyroscopic`] | section 3 |
//!    | torques and powers of the joints | [`Sim::joint_torques`] | (7.2) |
//!    | how rates depend on state and parameters, forces on positions and velocities | [`Sim::linearize`], [`Sim::force_derivatives`] | docs/derivatives.md |
//! 5. **Trust.** Of space: [`Sim::indicators`] of the steps and [`Sim::resolution`] of the state shown, each a [`Resolution`]. Of
//!    time: [`Sim::time_error`]. What exceeds the scene's tolerance: [`Sim::notice`].
//!
//! Every failure is an [`Error`]: a [`Status`], the [`Place`] in the scene, the quantity's name and value. A call that fails leaves the
//! simulation as it was.
//!
//! # Memory
//!
//! With the feature `alloc` [`ModelBuf`] and [`SimBuf`] own their memory; without it the caller gives slices of the lengths that
//! [`Model::requirement`] and [`Sim::requirement`] name. The records in [`ModelMemory`] are opaque. Stepping allocates nothing,
//! locks nothing, prints nothing and does not panic.
//!
//! # Pieces that serve by themselves
//!
//! [`integrate`]: the integrators, for any y′ = f(t, y); [`lu`]: the factorization, in the caller's memory; [`scalar`]: what both are
//! generic over, `f32` and `f64`.
//!
//! # Features
//!
//! * `std` (default): `alloc`, `implicit`, `near`, `derivatives`, and instructions of the processor chosen while running.
//! * `alloc`: [`ModelBuf`] and [`SimBuf`].
//! * `implicit`: [`Method::Gauss6`]. `near`: graded quadrature, [`Quadrature::Graded`](scene::Quadrature::Graded). Without them a program for a microcontroller is smaller.
//! * `derivatives`: [`Sim::linearize`] and [`Sim::force_derivatives`], in memory of their own.
//! * `fft`: rustfft for the set-up of large outlines.
//!
#![cfg_attr(
    not(feature = "alloc"),
    doc = "[`ModelBuf`]: #features\n[`ModelBuf::new`]: #features\n[`SimBuf`]: #features\n[`SimBuf::new`]: #features"
)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

// The layers, from the ground up; each uses itself and those before it (docs/architecture.md).

// Scalars, complex numbers, errors, memory of the caller, the processor's vectors.
mod base;

// Dense linear systems: LU with partial pivoting, L D Lᵀ of mass matrices.
mod linear;

// What the caller describes.
pub mod scene;

// Integrators of any y′ = f(t, y).
pub mod integrate;

// One outline or one pose: curves, placement of nodes, rigid placements.
mod geometry;

// What set-up makes: immutable records, and the plan.
mod model;

// The boundary integral equation (8.2) and its quadrature, near and far; gaps.
mod fluid;

// From positions and velocities to accelerations: kinematics, added mass, forces.
mod dynamics;

// Steps in time, and what can be asked between them.
mod simulation;

// From a scene to a model: checks, node counts, layout of the memory, filling it.
mod setup;

pub use base::{scalar, status};
pub use linear::lu::{self, Factorization};
#[cfg(feature = "bench")]
#[doc(hidden)]
pub use simulation::stages;

/// Vectors and matrices are also to be had as views of this version of nalgebra (see [`Sim::mass_matrix_view`]).
pub use nalgebra;

pub use base::scalar::Real;
pub use base::status::{Error, Place, Result, Status};
#[cfg(feature = "derivatives")]
pub use dynamics::derivatives::motion::Parameter;
pub use dynamics::evaluation::Counters;
pub use dynamics::indicators::Resolution;
pub use fluid::contact::Gap;
pub use model::boundary::BoundaryRecord;
pub use model::plan::{Formulation, Plan};
pub use model::{CoordinateRecord, JointInfo, LinkInfo, LinkRecord, Model, ModelHead};
pub use setup::automatic_nodes::{DEFAULT_TOLERANCE, NOTICED_BOUND};
#[cfg(feature = "alloc")]
pub use setup::automatic_nodes::{MOST_CHECKED, Resolved};
pub use setup::compile::{ModelMemory, ModelRequirement};
#[cfg(feature = "alloc")]
pub use setup::owned::{ModelBuf, SimBuf};
#[cfg(feature = "derivatives")]
pub use simulation::derivatives::Linearization;
pub use simulation::diagnostics::{Energy, EnergyDrift};
pub use simulation::notices::STEP_ERROR_LIMIT;
pub use simulation::sim::{STEP_LIMIT, Sim, SimHead, SimRequirement};
pub use simulation::state::Method;
pub use simulation::time_error::TimeError;
