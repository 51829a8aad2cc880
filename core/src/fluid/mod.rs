//! The fluid around all boundaries of one configuration: boundary system, potentials, induced velocities, gaps.

pub(crate) mod assembly;
#[cfg(all(test, feature = "alloc"))]
mod assembly_test;
pub(crate) mod clearance;
pub(crate) mod configuration;
pub(crate) mod contact;
pub(crate) mod gap;
pub(crate) mod induced;
pub(crate) mod isolated;
pub(crate) mod near;
pub(crate) mod pair_pass;
pub(crate) mod potentials;
pub(crate) mod rotation;
pub(crate) mod self_block;
pub(crate) mod system;
#[cfg(feature = "derivatives")]
pub(crate) mod tangent_pass;
