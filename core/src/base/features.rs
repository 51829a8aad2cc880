//! What this build has.

/// Graded quadrature (feature `near`). Where it is missing, this constant takes its code out.
pub(crate) const NEAR: bool = cfg!(feature = "near");
