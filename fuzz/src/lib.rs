//! Arbitrary bytes as a scene definition and a sequence of calls through the C interface. Whatever the bytes say: every call
//! returns, memory around the objects stays as it is, refused calls change nothing, and no result of a success is NaN.

mod bytes;
mod calls;
mod scene;

pub use bytes::{Bytes, Random};

/// Runs what the bytes say, in the precision that the first byte picks. Returns how far it came.
pub fn run(bytes: &[u8]) -> Reached {
    let mut bytes = Bytes::new(bytes);
    if bytes.byte().is_multiple_of(2) { calls::double::run(&mut bytes) } else { calls::single::run(&mut bytes) }
}

/// How far a run came.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Reached {
    /// The scene was refused.
    Scene,
    /// The model or simulation could not be made.
    Model,
    /// The simulation was made, and not a call succeeded that moves it.
    Simulation,
    /// It moved.
    Motion,
}
