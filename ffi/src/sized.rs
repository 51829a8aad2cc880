//! Definitions of callers that were compiled against an older or a newer header. Each begins with its size: what an older caller
//! does not have is at its default, what a newer one has beyond this library must be 0, which means none.

use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome};
use crate::shared::NEKTON_ABI_VERSION;
use core::marker::PhantomData;
use nekton::Status;

/// A struct that begins with its size (`u32`) and grows at its end.
pub(crate) trait Definition: Copy {
    /// The sizes it has had under this version of the interface, the present one last.
    const SIZES: &'static [usize];
    /// What to do if the size is 0.
    const ADVICE: &'static str;
    /// Its defaults, with this size.
    fn filled(struct_size: u32) -> Self;
}

/// No definition is larger. Beyond it the size is rubbish, and nothing is read by it.
const LARGEST: usize = 4096;

fn check_size<T: Definition>(size: usize) -> Outcome {
    let known = if size > size_of::<T>() {
        size <= LARGEST && size.is_multiple_of(align_of::<T>())
    } else {
        T::SIZES.contains(&size)
    };
    if known { Ok(()) } else { Err(Fault::of(Status::AbiVersion, "struct_size", size as f64)) }
}

/// The size that a definition says it has.
unsafe fn size_at<T: Definition>(at: *const T) -> Outcome<usize> {
    // SAFETY: not NULL and aligned; the size comes first in every definition.
    let size = unsafe { at.cast::<u32>().read() } as usize;
    if size == 0 {
        return Err(Fault::of(Status::AbiVersion, T::ADVICE, f64::NAN));
    }
    Ok(size)
}

/// A definition of a checked size, brought to the size of this library's.
unsafe fn read<T: Definition>(at: *const T, size: usize) -> Outcome<T> {
    let own = size_of::<T>();
    // SAFETY: the caller promises so many bytes; every pattern of bits is a value of the fields.
    unsafe {
        if size < own {
            let mut def = T::filled(size as u32);
            core::ptr::copy_nonoverlapping(at.cast::<u8>(), (&raw mut def).cast::<u8>(), size);
            return Ok(def);
        }
        let unknown = (own..size).any(|k| at.cast::<u8>().add(k).read() != 0);
        if unknown {
            return Err(Fault::of(Status::Unsupported, "a field of a newer header", f64::NAN));
        }
        Ok(at.read())
    }
}

/// The definition behind a pointer.
pub(crate) unsafe fn one<T: Definition>(what: &'static str, at: *const T) -> Outcome<T> {
    check_pointer(what, at)?;
    // SAFETY: not NULL, aligned; the caller promises the bytes that the definition says it has.
    unsafe {
        let size = size_at(at)?;
        check_size::<T>(size)?;
        read(at, size)
    }
}

/// Fills a definition of `size` bytes with defaults.
pub(crate) unsafe fn init<T: Definition>(def: *mut T, size: usize, version: u32) -> Outcome<Status> {
    check_pointer("def", def.cast_const())?;
    if version != NEKTON_ABI_VERSION {
        return Err(Fault::of(Status::AbiVersion, "abi_version", f64::from(version)));
    }
    check_size::<T>(size)?;
    let content = T::filled(size as u32);
    // SAFETY: checked; the caller promises room for `size` bytes.
    unsafe {
        def.cast::<u8>().write_bytes(0, size);
        core::ptr::copy_nonoverlapping((&raw const content).cast::<u8>(), def.cast(), size.min(size_of::<T>()));
    }
    Ok(Status::Ok)
}

/// A caller's array of definitions, walked by the size that the first one says.
pub(crate) struct Defs<'a, T> {
    what: &'static str,
    first: *const T,
    count: usize,
    lives: PhantomData<&'a T>,
}

impl<T: Definition> Defs<'_, T> {
    /// Refuses NULL, misaligned pointers and arrays that cannot be addressed; the items are checked by [`Defs::get`].
    pub(crate) unsafe fn new(what: &'static str, first: *const T, count: usize) -> Outcome<Self> {
        if count > 0 {
            check_pointer(what, first)?;
            // SAFETY: not NULL, aligned; the caller promises an item.
            let size = unsafe { first.cast::<u32>().read() } as usize;
            if count > isize::MAX as usize / size.clamp(size_of::<T>(), LARGEST) {
                return Err(Fault::of(Status::SizeOverflow, what, count as f64));
            }
        }
        Ok(Defs { what, first, count, lives: PhantomData })
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// An item; an error if there is none, or if its size is wrong or not that of the first.
    pub(crate) fn get(&self, i: usize) -> Outcome<T> {
        let item = |f: Fault| Fault { item: i32::try_from(i).unwrap_or(i32::MAX), ..f };
        if i >= self.count {
            return Err(item(Fault::of(Status::OutOfRange, self.what, i as f64)));
        }
        // SAFETY: `new` checked the pointer and the count; the caller promises that the items are there.
        unsafe {
            let stride = size_at(self.first)?;
            check_size::<T>(stride)?;
            let at = self.first.byte_add(i * stride);
            let size = size_at(at)?;
            if size != stride {
                return Err(item(Fault::of(Status::AbiVersion, "struct_size", size as f64)));
            }
            read(at, size)
        }
    }
}
