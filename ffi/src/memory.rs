//! Memory of the caller: how much is needed, where things lie in it, and what is refused. An object is a head with a mark at the
//! front, records and reals behind it.

use crate::diag::{Fault, Outcome};
use crate::shared::{NEKTON_ABI_VERSION, NEKTON_ALIGN as ALIGN};
use crate::types::nekton_req;
use nekton::Status;

/// Reals begin on a cache line, wherever the object begins.
pub(crate) const LINE: usize = 64;

/// The mark of an object of a precision.
pub(crate) fn mark<R>(of: u64) -> u64 {
    of ^ size_of::<R>() as u64 ^ (u64::from(NEKTON_ABI_VERSION) << 8)
}

/// Adds up bytes.
pub(crate) struct Sum(pub(crate) Option<usize>);

impl Sum {
    /// Adds `n` items; returns where they begin.
    pub(crate) fn items<T>(&mut self, n: usize) -> usize {
        let at = self.0.and_then(|at| at.checked_next_multiple_of(align_of::<T>()));
        self.0 = at.and_then(|at| at.checked_add(n.checked_mul(size_of::<T>())?));
        at.unwrap_or(0)
    }
    pub(crate) fn bytes(&self) -> Outcome<usize> {
        self.0.filter(|n| *n <= isize::MAX as usize).ok_or(Status::SizeOverflow.into())
    }
}

pub(crate) fn round(bytes: usize) -> Outcome<usize> {
    bytes.checked_next_multiple_of(ALIGN).ok_or(Status::SizeOverflow.into())
}

/// Whether two stretches of memory have a byte in common.
pub(crate) fn overlap(a: usize, a_len: usize, b: usize, b_len: usize) -> bool {
    a < b.saturating_add(b_len) && b < a.saturating_add(a_len)
}

/// Refuses memory that is NULL, misaligned or short, or that what it is made from lies in. Writes nothing.
pub(crate) fn check_memory(mem: *mut u8, len: usize, req: &nekton_req, source: (usize, usize)) -> Outcome {
    if mem.is_null() {
        return Err(Fault::of(Status::NullPointer, "mem", f64::NAN));
    }
    if !mem.addr().is_multiple_of(ALIGN) {
        return Err(Fault::of(Status::Misaligned, "mem", ALIGN as f64));
    }
    if len < req.size {
        return Err(Fault::of(Status::MemoryTooSmall, "len", len as f64));
    }
    if overlap(mem.addr(), req.size, source.0, source.1) {
        return Err(Fault::of(Status::Aliasing, "mem", f64::NAN));
    }
    Ok(())
}

/// The offset at or behind `at` that lies on a cache line.
pub(crate) fn on_line(mem: *const u8, at: usize) -> usize {
    at + mem.wrapping_add(at).addr().wrapping_neg() % LINE
}

/// Fills `n` items with a value and gives them as a slice.
pub(crate) unsafe fn fill<'a, T: Copy>(mem: *mut u8, at: usize, n: usize, value: T) -> &'a mut [T] {
    // SAFETY: the memory was checked to be long enough and aligned for offsets made by `Sum`.
    unsafe {
        let first = mem.add(at).cast::<T>();
        for i in 0..n {
            first.add(i).write(value);
        }
        core::slice::from_raw_parts_mut(first, n)
    }
}

/// Copies item by item: no call, no check of lengths that could panic.
pub(crate) fn copy<R: Copy>(to: &mut [R], from: &[R]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t = *f;
    }
}

/// What `free` needs to know: where, how many bytes.
#[cfg(feature = "std")]
pub(crate) struct Owned {
    pub(crate) mem: *mut u8,
    pub(crate) bytes: usize,
}

/// Ends the life of an object that came from `create`: the mark goes, the memory is to be freed.
#[cfg(feature = "std")]
pub(crate) unsafe fn retire(object: Owned, owned: u64, what: &'static str) -> Outcome<Owned> {
    if owned == 0 {
        return Err(Fault::of(Status::BadHandle, what, f64::NAN));
    }
    // SAFETY: the front of a live object. Volatile, or the write before a deallocation might be dropped.
    unsafe { object.mem.cast::<u64>().write_volatile(0) };
    Ok(object)
}
