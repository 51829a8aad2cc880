//! The ground: scalar types, status codes, and small pieces that everything above is made of. Knows nothing of bodies and fluid.

pub(crate) mod bits;
pub(crate) mod complex;
pub(crate) mod digest;
pub(crate) mod elementary;
pub(crate) mod features;
pub(crate) mod fields;
pub(crate) mod index;
pub(crate) mod lanes;
pub(crate) mod machine;
pub(crate) mod memory;
pub(crate) mod once;
pub mod scalar;
pub mod status;
