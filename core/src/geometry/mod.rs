//! Outlines, their nodes, and where they are in the plane.

pub(crate) mod curve;
pub(crate) mod grading;
pub(crate) mod nodes;
pub(crate) mod pose;
