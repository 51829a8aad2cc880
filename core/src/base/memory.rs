//! Memory given by the caller: one run of a layout counts, the same run splits.
//!
//! Nothing in this crate allocates while it computes. A layout is written once with [`buffers!`]; its
//! `len` and its `take` come from the same lines and cannot disagree.
//!
//! Tested by `tests/allocation`.

use crate::base::scalar::Real;
#[cfg(feature = "alloc")]
use crate::base::status::Error;
use crate::base::status::{Result, Status};

/// Splits `n` elements off the front of `rest`.
pub(crate) fn take<'a, T>(rest: &mut &'a mut [T], n: usize) -> Result<&'a mut [T]> {
    let (head, tail) = core::mem::take(rest).split_at_mut_checked(n).ok_or(Status::MemoryTooSmall)?;
    *rest = tail;
    Ok(head)
}

/// The same as elements of another type of the same size.
pub(crate) fn take_as<'a, R: Real, T: bytemuck::Pod>(rest: &mut &'a mut [R], n: usize) -> Result<&'a mut [T]> {
    bytemuck::try_cast_slice_mut(take(rest, n)?).map_err(|_| Status::Internal.into())
}

/// An empty vector with room for `n` elements; `OutOfMemory` with its bytes if there is none.
#[cfg(feature = "alloc")]
pub(crate) fn room<T>(n: usize) -> Result<alloc::vec::Vec<T>> {
    let mut memory = alloc::vec::Vec::new();
    let none = Error::new(Status::OutOfMemory).of("bytes", n as f64 * size_of::<T>() as f64);
    memory.try_reserve_exact(n).map_err(|_| none)?;
    Ok(memory)
}

/// `n` elements on the heap; `OutOfMemory` with their bytes if there is no room.
#[cfg(feature = "alloc")]
pub(crate) fn filled<T: Clone + Default>(n: usize) -> Result<alloc::vec::Vec<T>> {
    let mut memory = room(n)?;
    memory.resize(n, T::default());
    Ok(memory)
}

/// The elements `at .. at + n`, or an empty slice when they are not all there.
#[inline]
pub(crate) fn part<T>(data: &[T], at: usize, n: usize) -> &[T] {
    debug_assert!(n == 0 || at + n <= data.len(), "{at} + {n} of {}", data.len());
    at.checked_add(n).and_then(|end| data.get(at..end)).unwrap_or(&[])
}

/// The elements `at .. at + n`, or an empty slice when they are not all there.
#[inline]
pub(crate) fn part_mut<T>(data: &mut [T], at: usize, n: usize) -> &mut [T] {
    debug_assert!(n == 0 || at + n <= data.len(), "{at} + {n} of {}", data.len());
    at.checked_add(n).and_then(|end| data.get_mut(at..end)).unwrap_or(&mut [])
}

/// The element at `i`; NaN when there is none, so that a mistake shows in the result and cannot panic.
#[inline]
pub(crate) fn at<R: Real>(data: &[R], i: usize) -> R {
    debug_assert!(i < data.len(), "{i} of {}", data.len());
    data.get(i).copied().unwrap_or(R::NAN)
}

/// Writes the element at `i`, if it is there.
#[inline]
pub(crate) fn put<R: Real>(data: &mut [R], i: usize, value: R) {
    debug_assert!(i < data.len(), "{i} of {}", data.len());
    if let Some(x) = data.get_mut(i) {
        *x = value;
    }
}

/// Adds to the element at `i`, if it is there.
#[inline]
pub(crate) fn add<R: Real>(data: &mut [R], i: usize, value: R) {
    debug_assert!(i < data.len(), "{i} of {}", data.len());
    if let Some(x) = data.get_mut(i) {
        *x += value;
    }
}

/// Copies element by element, as far as both reach.
#[inline]
pub(crate) fn copy_some<T: Copy>(to: &mut [T], from: &[T]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t = *f;
    }
}

/// Copies element by element; both have the same length.
#[inline]
pub(crate) fn copy<T: Copy>(to: &mut [T], from: &[T]) {
    debug_assert_eq!(to.len(), from.len());
    copy_some(to, from);
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
/// `buffers! { struct Name(dims: Dims) { field: Type = length, … } }` makes `Name<'a, R>` with `Name::len(&dims)` and
/// `Name::take(&dims, &mut slab)`; the type is `R`, or `R::Index` for whole numbers.
macro_rules! buffers {
    ($(#[$doc:meta])* $vis:vis struct $name:ident($dims:ident: $dty:ty) {
        $( $(#[$fdoc:meta])* $field:ident: $type:ty = $len:expr, )*
    }) => {
        $(#[$doc])*
        $vis struct $name<'a, R: $crate::base::scalar::Real> { $( $(#[$fdoc])* pub $field: &'a mut [$type], )* }
        impl<'a, R: $crate::base::scalar::Real> $name<'a, R> {
            /// Number of reals needed.
            #[allow(unused_variables)]
            $vis fn len($dims: &$dty) -> Option<usize> {
                let total = 0usize;
                $( let n: usize = $len; let total = total.checked_add(n)?; )*
                Some(total)
            }
            /// Takes them from the front of a slab of at least `len` reals.
            #[allow(unused_variables)]
            $vis fn take($dims: &$dty, slab: &mut &'a mut [R]) -> $crate::base::status::Result<Self> {
                $( let $field = $crate::base::memory::take_as::<R, $type>(slab, $len)?; )*
                Ok($name { $($field,)* })
            }
        }
    };
}
pub(crate) use buffers;
