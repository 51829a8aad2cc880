//! Arrays and numbers on their way in and out.

use crate::convert::{array, check_pointer};
use crate::diag::{Fault, Outcome};
use crate::sim_object::SimParts;
use nekton::{Real, Status};

/// An input buffer of a known length.
pub(crate) unsafe fn input<'a, R: Real>(
    what: &'static str,
    first: *const R,
    n: usize,
    need: usize,
) -> Outcome<&'a [R]> {
    length(n, need)?;
    // SAFETY: the caller's promise about the buffer.
    let values = unsafe { array(what, first, n) }?;
    for x in values {
        finite(what, *x)?;
    }
    Ok(values)
}

/// An output buffer of a known length, outside the object, filled with zeros.
pub(crate) unsafe fn output<'a, R: Real, T: Copy + Default>(
    parts: &SimParts<'_, R>,
    what: &'static str,
    first: *mut T,
    n: usize,
    need: usize,
) -> Outcome<&'a mut [T]> {
    length(n, need)?;
    if n == 0 {
        return Ok(&mut []);
    }
    check_pointer(what, first.cast_const())?;
    if n > isize::MAX as usize / size_of::<T>() {
        return Err(Fault::of(Status::SizeOverflow, what, n as f64));
    }
    if parts.overlaps(first.cast_const(), n) {
        return Err(Fault::of(Status::Aliasing, what, f64::NAN));
    }
    // SAFETY: not NULL, aligned, of an addressable size; the caller promises room. Written before it is a slice, since it
    // may never have been.
    Ok(unsafe {
        for i in 0..n {
            first.add(i).write(T::default());
        }
        core::slice::from_raw_parts_mut(first, n)
    })
}

pub(crate) fn length(given: usize, need: usize) -> Outcome {
    if given == need { Ok(()) } else { Err(Fault::of(Status::Length, "length", given as f64)) }
}

pub(crate) fn finite<R: Real>(what: &'static str, x: R) -> Outcome {
    if x.is_finite() { Ok(()) } else { Err(Fault::of(Status::NotFinite, what, x.to_f64())) }
}

/// Refuses to call a result that is not finite a success.
pub(crate) fn sound<R: Real>(values: impl IntoIterator<Item = R>) -> Outcome<Status> {
    match values.into_iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Fault::of(Status::NonFiniteState, "result", x.to_f64())),
        None => Ok(Status::Ok),
    }
}

pub(crate) fn disjoint<R>(what: &'static str, a: *const R, b: *const R, n: usize) -> Outcome {
    let bytes = n.saturating_mul(size_of::<R>());
    let (a, b) = (a.addr(), b.addr());
    if n > 0 && a < b.saturating_add(bytes) && b < a.saturating_add(bytes) {
        return Err(Fault::of(Status::Aliasing, what, f64::NAN));
    }
    Ok(())
}
