//! A model in motion: state, stepping, diagnostics.

#[cfg(feature = "derivatives")]
pub(crate) mod derivatives;
pub(crate) mod diagnostics;
mod drives;
pub(crate) mod notices;
pub(crate) mod right_hand_side;
mod saved;
pub(crate) mod sim;
#[cfg(feature = "bench")]
pub mod stages;
pub(crate) mod state;
pub(crate) mod stepping;
pub(crate) mod time_error;
pub(crate) mod views;
