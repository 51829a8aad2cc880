//! Memory given by the caller: one run of a layout counts, the same run splits.
//!
//! Nothing in this crate allocates while it computes. A layout is written once with [`buffers!`]; its
//! `len` and its `split` come from the same lines and cannot disagree.

use crate::base::scalar::Real;
use crate::base::status::{Result, Status};

/// Splits `n` elements off the front of `rest`.
pub(crate) fn take<'a, T>(rest: &mut &'a mut [T], n: usize) -> Result<&'a mut [T]> {
    let (head, tail) = core::mem::take(rest).split_at_mut_checked(n).ok_or(Status::MemoryTooSmall)?;
    *rest = tail;
    Ok(head)
}

/// The elements `at .. at + n`, or an empty slice when they are not all there.
#[inline]
pub(crate) fn part<T>(data: &[T], at: usize, n: usize) -> &[T] {
    at.checked_add(n).and_then(|end| data.get(at..end)).unwrap_or(&[])
}

/// The elements `at .. at + n`, or an empty slice when they are not all there.
#[inline]
pub(crate) fn part_mut<T>(data: &mut [T], at: usize, n: usize) -> &mut [T] {
    at.checked_add(n).and_then(|end| data.get_mut(at..end)).unwrap_or(&mut [])
}

/// The element at `i`; NaN when there is none, so that a mistake shows in the result and cannot panic.
#[inline]
pub(crate) fn at<R: Real>(data: &[R], i: usize) -> R {
    data.get(i).copied().unwrap_or(R::NAN)
}

/// Writes the element at `i`, if it is there.
#[inline]
pub(crate) fn put<R: Real>(data: &mut [R], i: usize, value: R) {
    if let Some(x) = data.get_mut(i) {
        *x = value;
    }
}

/// Adds to the element at `i`, if it is there.
#[inline]
pub(crate) fn add<R: Real>(data: &mut [R], i: usize, value: R) {
    if let Some(x) = data.get_mut(i) {
        *x += value;
    }
}

/// Copies element by element, as far as both reach.
#[inline]
pub(crate) fn copy<T: Copy>(to: &mut [T], from: &[T]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t = *f;
    }
}

/// Scalar product, summed in eight lanes so that it vectorizes.
#[inline]
pub(crate) fn inner<R: Real>(a: &[R], b: &[R]) -> R {
    let mut lanes = [R::zero(); 8];
    // Arrays: the length of a chunk that the compiler does not know might be 0, and be divided by.
    let ((a8, a_rest), b8) = (a.as_chunks::<8>(), b.as_chunks::<8>().0);
    let rest = a_rest.iter().zip(part(b, a.len() - a_rest.len(), a_rest.len()));
    let tail = rest.fold(R::zero(), |s, (x, y)| s + *x * *y);
    if a8.is_empty() {
        return tail;
    }
    for (a, b) in a8.iter().zip(b8) {
        for ((s, x), y) in lanes.iter_mut().zip(a).zip(b) {
            *s += *x * *y;
        }
    }
    let [a, b, c, d, e, f, g, h] = lanes;
    tail + (((a + e) + (c + g)) + ((b + f) + (d + h)))
}

/// `y += a x`.
#[inline]
pub(crate) fn axpy<R: Real>(y: &mut [R], a: R, x: &[R]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * *x;
    }
}

/// Declares a bundle of buffers that live one after the other in a slab of reals.
///
/// `buffers! { struct Name(dims: Dims) { field: length, … } }` makes `Name<'a, R>` with
/// `Name::len(&dims)` and `Name::split(&dims, slab)`.
macro_rules! buffers {
    ($(#[$doc:meta])* $vis:vis struct $name:ident($dims:ident: $dty:ty) { $( $(#[$fdoc:meta])* $field:ident: $len:expr, )* }) => {
        $(#[$doc])*
        $vis struct $name<'a, R> { $( $(#[$fdoc])* pub $field: &'a mut [R], )* }
        impl<'a, R: $crate::base::scalar::Real> $name<'a, R> {
            /// Number of reals needed.
            #[allow(unused_variables)]
            $vis fn len($dims: &$dty) -> Option<usize> {
                let total = 0usize;
                $( let n: usize = $len; let total = total.checked_add(n)?; )*
                Some(total)
            }
            /// Splits a slab of at least `len` reals.
            #[allow(unused_variables, unused_mut, unused_assignments)]
            $vis fn split($dims: &$dty, slab: &'a mut [R]) -> $crate::base::status::Result<Self> {
                let mut rest = slab;
                $( let $field = $crate::base::memory::take(&mut rest, $len)?; )*
                Ok($name { $($field,)* })
            }
        }
    };
}
pub(crate) use buffers;
