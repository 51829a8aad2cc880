//! How fast nekton is: stages, whole evaluations, and both beside OpenBLAS's factorization.

pub mod counted;
pub mod faer;
pub mod lapack;
mod linearize;
pub mod passing;
pub mod rows;
pub mod scenes;
pub mod setups;
pub mod timing;
