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

pub(crate) mod articulation;
pub mod boundary;
mod build;
pub(crate) mod christoffel;
pub mod compile;
mod compiled;
pub(crate) mod configuration;
pub(crate) mod contact;
pub mod curve;
pub mod diagnostics;
pub(crate) mod dynamics;
mod elementary;
pub(crate) mod forces;
pub mod grading;
pub mod indicators;
pub mod integrate;
mod layout;
pub(crate) mod ldl;
pub(crate) mod lone;
pub mod lu;
pub mod model;
mod motion;
pub(crate) mod near;
pub(crate) mod nystrom;
#[cfg(all(test, feature = "alloc"))]
mod nystrom_test;
#[cfg(feature = "alloc")]
pub mod owned;
pub(crate) mod pairs;
pub mod plan;
pub(crate) mod potentials;
pub mod resolve;
pub mod scalar;
pub mod scene;
pub mod se2;
pub(crate) mod signal;
pub mod sim;
#[cfg(feature = "bench")]
#[doc(hidden)]
pub mod stages;
pub mod status;
mod stepping;
mod time_error;
mod validate;
pub(crate) mod work;
pub(crate) mod workspace;

pub use compile::{ModelMemory, ModelRequirement};
pub use diagnostics::{Counters, Energy, Gap};
pub use indicators::Resolution;
pub use model::{Formulation, JointInfo, LinkInfo, Model, ModelHead};
#[cfg(feature = "alloc")]
pub use owned::{ModelBuf, SimBuf};
pub use plan::Plan;
pub use scalar::Real;
pub use sim::{Method, STEP_LIMIT, Sim, SimHead, SimRequirement};
pub use status::{Error, Place, Result, Status};
pub use time_error::TimeError;
