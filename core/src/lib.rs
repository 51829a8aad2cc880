#![no_std]
#![cfg_attr(not(test), deny(clippy::indexing_slicing, clippy::unwrap_used, clippy::expect_used, clippy::panic))]
//! Rigid and articulated bodies moving in a 2D ideal fluid: unbounded, with obstacles, or in a tank; with buoyancy,
//! circulation, and repulsion on near-contact.
//!
//! A [`scene::Scene`] is compiled into an immutable [`Model`]; any number of [`Sim`]s step it, one per thread. With the
//! feature `alloc` (in `std`, on by default) [`ModelBuf`] and [`SimBuf`] own their memory; without it the caller gives
//! slices of the lengths that [`Model::requirement`] and [`Sim::requirement`] name. Stepping allocates nothing, locks
//! nothing, prints nothing and does not panic.
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
//! let mut sim = SimBuf::new(model, Method::Adams { relative: 1e-9, absolute: 1e-9 })?;
//! let mut sim = sim.view();
//! sim.advance(1.0)?;
//! assert!(sim.positions()[1] < 0.0 && sim.energy()?.kinetic_fluid > 0.0);
//! # Ok::<(), nekton::Error>(())
//! ```
//!
//! Modules in the order of the data: [`scene`] → [`curve`], [`grading`], [`boundary`] → [`compile`] ([`model`], [`plan`]) →
//! the boundary system ([`lu`]) → forces → [`sim`] with the integrators of [`integrate`] → [`diagnostics`].
//! Units are SI per unit depth; angles are in radians.

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod base;
mod dynamics;
mod fluid;
mod geometry;
pub mod integrate;
mod linear;
mod model;
pub mod scene;
mod setup;
mod simulation;

pub use base::{scalar, status};
pub use linear::lu;
#[cfg(feature = "bench")]
#[doc(hidden)]
pub use simulation::stages;

pub use base::scalar::Real;
pub use base::status::{Error, Place, Result, Status};
pub use dynamics::evaluation::Counters;
pub use dynamics::indicators::Resolution;
pub use fluid::contact::Gap;
pub use model::boundary::BoundaryRecord;
pub use model::plan::{Formulation, Plan};
pub use model::{CoordinateRecord, JointInfo, LinkInfo, LinkRecord, Model, ModelHead};
pub use setup::compile::{ModelMemory, ModelRequirement};
#[cfg(feature = "alloc")]
pub use setup::owned::{ModelBuf, SimBuf};
pub use simulation::diagnostics::Energy;
pub use simulation::sim::{STEP_LIMIT, Sim, SimHead, SimRequirement};
pub use simulation::state::Method;
pub use simulation::time_error::TimeError;
