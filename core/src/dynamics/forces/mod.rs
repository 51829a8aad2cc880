//! Forces beside the Christoffel force: buoyancy, repulsion, circulation. Each is absent from the computation
//! when the scene does not ask for it.

pub(crate) mod buoyancy;
pub(crate) mod circulation;
pub(crate) mod close_range;
pub(crate) mod repulsion;
