//! Whole numbers in a slab of reals: of the scalar's own size, so that one slab holds both.

use core::fmt::Debug;

/// A row number or a count that takes as much memory as a scalar: `u64` beside `f64`, `u32` beside `f32`.
pub trait Index: bytemuck::Pod + Default + Ord + Debug + Send + Sync {
    /// From a number that fits 32 bits (larger ones are cut off).
    fn of(n: usize) -> Self;
    /// The number.
    fn get(self) -> usize;
}

macro_rules! index {
    ($t:ident) => {
        impl Index for $t {
            #[inline(always)]
            fn of(n: usize) -> Self {
                n as $t
            }
            #[inline(always)]
            fn get(self) -> usize {
                self as usize
            }
        }
    };
}
index!(u32);
index!(u64);
