#![no_std]
#![cfg_attr(not(test), deny(clippy::indexing_slicing, clippy::unwrap_used, clippy::expect_used, clippy::panic))]
//! nekton

#[cfg(feature = "alloc")]
extern crate alloc;

pub(crate) mod articulation;
pub mod boundary;
pub(crate) mod christoffel;
pub mod compile;
pub(crate) mod contact;
pub mod curve;
pub mod diagnostics;
pub(crate) mod dynamics;
pub(crate) mod forces;
pub mod grading;
pub mod integrate;
pub(crate) mod lone;
pub mod lu;
pub mod model;
pub(crate) mod nystrom;
#[cfg(feature = "alloc")]
pub mod owned;
pub mod plan;
pub(crate) mod potentials;
pub mod scalar;
pub mod scene;
pub mod se2;
pub(crate) mod signal;
pub mod sim;
pub mod status;
pub(crate) mod workspace;

pub use compile::{ModelMemory, ModelRequirement};
pub use diagnostics::{Counters, Energy, Gap, Resolution};
pub use model::{Formulation, JointInfo, LinkInfo, Model, ModelHead};
#[cfg(feature = "alloc")]
pub use owned::{ModelBuf, SimBuf};
pub use plan::Plan;
pub use scalar::Real;
pub use sim::{Method, Sim, SimHead, SimRequirement};
pub use status::{Error, Place, Result, Status};
