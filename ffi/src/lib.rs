#![no_std]
#![allow(non_camel_case_types)]
//! C interface of nekton: `include/nekton.h` and `include/nekton32.h` are generated from the exported functions and types here.
//!
//! Every exported function is a line or two around generic code: `api64` is written by hand, `api32` is made from it by
//! `cargo xtask header`, `shared` has no twin.
//!
//! Definitions say their size, so that callers of older and newer headers are understood (`sized`); `defaults` has what they do not
//! have. A simulation that is in use is refused to others (`turns`).
//!
//! Pointers: each is checked for NULL and alignment, each count for overflow, each kind for its range, before anything is read
//! through it or written. What cannot be checked is the caller's duty: that a pointer with a count points to so many items,
//! that definitions have the size that they say, and that memory stays until the object is not used.

#[cfg(all(not(feature = "std"), not(panic = "abort")))]
compile_error!("without std the library must be built with panic = \"abort\": cargo build --profile embedded");

#[cfg(feature = "std")]
extern crate std;

pub mod api32;
pub mod api64;
mod buffers;
mod check;
mod convert;
mod defaults;
mod derivatives;
pub mod diag;
mod memory;
mod model;
mod model_object;
mod questions;
pub mod shared;
mod sim;
mod sim_object;
mod sized;
mod turns;
pub mod types;

#[cfg(not(feature = "std"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(feature = "panic-handler")]
    loop {}
    #[cfg(not(feature = "panic-handler"))]
    {
        unsafe extern "C" {
            fn nekton_panicked() -> !;
        }
        // SAFETY: nothing defines this function, so that an archive in which a panic could happen does not link.
        unsafe { nekton_panicked() }
    }
}
