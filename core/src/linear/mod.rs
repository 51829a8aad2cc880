//! Linear systems in the caller's memory.

pub(crate) mod ldl;
pub mod lu;
