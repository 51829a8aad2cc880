//! What has no precision: versions, capabilities, texts.

use crate::diag::describe;
use crate::types::{nekton_diag, nekton_status};
use core::ffi::c_char;
use nekton::Status;

/// Version of the interface. Goes up with every change that is not compatible; fields appended to a definition are
/// compatible, by its struct_size.
pub const NEKTON_ABI_VERSION: u32 = 2;

/// Capability: nekton_model_create, nekton_sim_create and their free work.
pub const NEKTON_CAP_ALLOC: u32 = 1;

/// Alignment that is enough for every object, bytes.
pub const NEKTON_ALIGN: usize = 8;

/// The library's NEKTON_ABI_VERSION, to be compared with the header's. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_abi_version() -> u32 {
    NEKTON_ABI_VERSION
}

/// What this build can do: a sum of NEKTON_CAP_... Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_capabilities() -> u32 {
    if cfg!(feature = "std") { NEKTON_CAP_ALLOC } else { 0 }
}

/// One line of text about a status; "unknown status" for any other number. Never NULL; static. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_status_text(status: nekton_status) -> *const c_char {
    Status::from_code(status).map_or("unknown status\0", Status::text_with_nul).as_ptr().cast()
}

/// The status's name in CamelCase, as in a Matlab identifier "nekton:Contact"; "Unknown" for any other number. Never NULL;
/// static. Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_status_name(status: nekton_status) -> *const c_char {
    Status::from_code(status).map_or("Unknown\0", Status::name_with_nul).as_ptr().cast()
}

/// Writes "place: text (with other) (what = value beside limit) at t = time" into text (size bytes, ended by 0, cut off if too
/// long; 256 are enough). Does nothing when diag or text is NULL or size is 0. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton_diag_text(diag: *const nekton_diag, text: *mut c_char, size: usize) {
    if diag.is_null() || !diag.is_aligned() || text.is_null() || size == 0 || size > isize::MAX as usize {
        return;
    }
    // SAFETY: checked; the caller promises `size` bytes. They are filled first, since they may never have been written.
    unsafe {
        let diag = *diag;
        text.write_bytes(0, size);
        describe(&diag, core::slice::from_raw_parts_mut(text.cast(), size));
    }
}
