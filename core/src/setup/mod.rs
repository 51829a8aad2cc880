//! From a scene to a model.

pub(crate) mod automatic_nodes;
pub(crate) mod compile;
mod fingerprint;
mod items;
mod layout;
#[cfg(feature = "alloc")]
pub(crate) mod owned;
pub(crate) mod records;
mod traits;
mod validate;
