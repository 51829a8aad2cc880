#![no_std]
//! nekton
#[cfg(feature = "alloc")]
extern crate alloc;
pub mod curve;
pub mod grading;
pub mod scalar;
pub mod scene;
pub mod status;
pub(crate) mod workspace;
