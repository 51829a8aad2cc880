//! Equations of motion: from a state to accelerations.

pub(crate) mod accelerations;
pub(crate) mod added_mass;
pub(crate) mod articulation;
pub(crate) mod christoffel;
#[cfg(feature = "derivatives")]
pub(crate) mod derivatives;
pub(crate) mod evaluation;
pub(crate) mod forces;
pub(crate) mod indicators;
pub(crate) mod kirchhoff;
pub(crate) mod position;
pub(crate) mod sizes;
