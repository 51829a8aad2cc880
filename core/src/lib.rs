#![no_std]
//! nekton
#[cfg(feature = "alloc")]
extern crate alloc;
pub mod integrate;
pub mod scalar;
pub mod scene;
pub mod status;
pub(crate) mod workspace;
pub mod lu;
pub mod se2;
