//! Plain data of the interface.

mod answers;
mod definitions;

pub use answers::*;
pub use definitions::*;
