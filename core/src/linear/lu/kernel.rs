//! The dispatch point: which instructions of the machine at hand the loops beside it are compiled for.
//!
//! The only module of this crate with `unsafe`, for two things:
//! * Calls of functions compiled for instructions that not every machine has. A value of [`Avx2`] or [`Avx512`] is the
//!   proof that the machine has them: both are made in [`Level::here`] alone, after asking.
//! * Vectors made from arrays of the same size and back, where every bit pattern is valid on both sides; and the
//!   arithmetic on such vectors, which is reached through the functions above alone because the types are named nowhere else.
#![allow(unsafe_code)]

use super::Rows;
use super::portable::{Portable, divide};
#[cfg(target_arch = "x86_64")]
use super::tile::{self, Lanes};
#[cfg(target_arch = "x86_64")]
use super::{eliminate, triangle};
use crate::base::scalar::Real;

/// The loops that are worth instructions of their own.
pub(super) trait Kernel<R: Real>: Copy {
    /// C ← C − A B, where B and C are rows of the same columns `right` and do not overlap. `left` holds A's columns.
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]);
    /// Elimination with partial pivoting of at most [`super::BLOCK`] columns from row `k` on. Returns the smallest and the
    /// largest pivot; `None` when there is none.
    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R]) -> Option<(R, R)>;
    /// A ← A U⁻¹ in the rows `to ..` of a block of at most [`super::BLOCK`] columns, whose rows `from ..` hold U.
    fn divide(self, block: &mut [R], ld: usize, rows: Rows) {
        divide(block, ld, rows);
    }
    /// Solves with the unit lower triangle in rows `k ..` of the columns `left` (at most [`super::BLOCK`]).
    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// Solves with the upper triangle there.
    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// Most columns that [`Kernel::eliminate_block`] and the solves with triangles take.
    fn block(self) -> usize {
        super::BLOCK
    }
    /// Solves Uᵀ Lᵀ x = b in place with the factors of order `n`.
    fn solve_transposed(self, lu: &[R], ld: usize, n: usize, b: &mut [R]);
}

/// A computation that is worth compiling for the machine's own instructions: everything that `run` calls must be inlined.
pub(crate) trait Task {
    /// Computes.
    fn run(self);
}

/// Vector types of a scalar.
pub trait Vectors: Sized {
    /// For [`Avx2`].
    #[cfg(target_arch = "x86_64")]
    #[doc(hidden)]
    #[allow(private_bounds)]
    type Short: Lanes<Self>;
    /// For [`Avx512`].
    #[cfg(target_arch = "x86_64")]
    #[doc(hidden)]
    #[allow(private_bounds)]
    type Long: Lanes<Self>;
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::Level;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use core::arch::x86_64::*;
    use core::mem::transmute;

    /// What the machine at hand can do.
    #[derive(Clone, Copy)]
    pub(crate) enum Level {
        Portable(Portable),
        Avx2(Avx2),
        Avx512(Avx512),
    }

    impl Level {
        /// Asks the machine; without `std`, the compiler's options. `--cfg nekton_portable` says that it can do nothing special.
        #[inline]
        pub(crate) fn here() -> Self {
            #[cfg(feature = "std")]
            macro_rules! has {
                ($f:tt) => {
                    std::arch::is_x86_feature_detected!($f)
                };
            }
            #[cfg(not(feature = "std"))]
            macro_rules! has {
                ($f:tt) => {
                    cfg!(target_feature = $f)
                };
            }
            if cfg!(nekton_portable) || !(has!("avx2") && has!("fma")) {
                Level::Portable(Portable)
            } else if has!("avx512f") && has!("avx512vl") && has!("avx512dq") {
                Level::Avx512(Avx512(()))
            } else {
                Level::Avx2(Avx2(()))
            }
        }
    }

    #[cfg(test)]
    impl Level {
        /// Everything the machine at hand can do, the least first.
        pub(in super::super) fn all() -> std::vec::Vec<Self> {
            let mut all = std::vec![Level::Portable(Portable)];
            match Self::here() {
                Level::Portable(_) => {}
                Level::Avx2(kernel) => all.push(Level::Avx2(kernel)),
                Level::Avx512(kernel) => all.extend([Level::Avx2(Avx2(())), Level::Avx512(kernel)]),
            }
            all
        }
    }

    /// A machine with AVX2 and FMA: 16 registers of 256 bits.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx2(());

    /// A machine with AVX-512: 32 registers.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx512(());

    impl Level {
        /// Runs a task compiled for the machine.
        #[inline]
        pub(crate) fn run<T: Task>(self, task: T) {
            #[target_feature(enable = "avx2")]
            fn short<T: Task>(task: T) {
                task.run();
            }
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
            fn long<T: Task>(task: T) {
                task.run();
            }
            match self {
                Level::Portable(_) => task.run(),
                // SAFETY: the value proves that the machine has these instructions.
                Level::Avx2(_) => unsafe { short(task) },
                // SAFETY: the same.
                Level::Avx512(_) => unsafe { long(task) },
            }
        }
    }

    macro_rules! kernel {
        ($level:ident, $features:literal, $vector:ident) => {
            impl<R: Real> Kernel<R> for $level {
                #[inline(always)]
                fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
                        tile::subtract::<R, R::$vector, 3>(left, ld, rows, right);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(left, ld, rows, right) }
                }
                #[inline(always)]
                fn eliminate_block(
                    self,
                    block: &mut [R],
                    ld: usize,
                    n: usize,
                    k: usize,
                    pivots: &mut [R],
                ) -> Option<(R, R)> {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(
                        block: &mut [R],
                        ld: usize,
                        n: usize,
                        k: usize,
                        pivots: &mut [R],
                    ) -> Option<(R, R)> {
                        eliminate::eliminate_block::<R, R::$vector>(block, ld, n, k, pivots)
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(block, ld, n, k, pivots) }
                }
                #[inline(always)]
                fn divide(self, block: &mut [R], ld: usize, rows: Rows) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(block: &mut [R], ld: usize, rows: Rows) {
                        eliminate::divide::<R, R::$vector>(block, ld, rows);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(block, ld, rows) }
                }
                #[inline(always)]
                fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(left: &[R], ld: usize, k: usize, right: &mut [R]) {
                        triangle::solve_triangle::<R, R::$vector, false>(left, ld, k, right);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(left, ld, k, right) }
                }
                #[inline(always)]
                fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(left: &[R], ld: usize, k: usize, right: &mut [R]) {
                        triangle::solve_triangle::<R, R::$vector, true>(left, ld, k, right);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(left, ld, k, right) }
                }
                #[inline(always)]
                fn solve_transposed(self, lu: &[R], ld: usize, n: usize, b: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(lu: &[R], ld: usize, n: usize, b: &mut [R]) {
                        triangle::solve_transposed::<R, R::$vector>(lu, ld, n, b);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(lu, ld, n, b) }
                }
            }
        };
    }
    kernel!(Avx2, "avx2,fma", Short);
    kernel!(Avx512, "avx512f,avx512vl,avx512dq,avx2,fma", Long);

    impl Vectors for f64 {
        type Short = Double4;
        type Long = Double8;
    }
    impl Vectors for f32 {
        type Short = Single8;
        // Eight rows are what a block has.
        type Long = Single8;
    }

    /// The first elements of a slice that is too short, followed by 0.
    #[cold]
    #[inline(never)]
    fn begin<R: Real, const W: usize>(from: &[R]) -> [R; W] {
        let mut lanes = [R::zero(); W];
        crate::base::memory::copy(&mut lanes, from);
        lanes
    }

    /// Writes the first elements to a slice that is too short for all.
    #[cold]
    #[inline(never)]
    fn end<R: Real, const W: usize>(lanes: [R; W], to: &mut [R]) {
        crate::base::memory::copy(to, &lanes);
    }

    macro_rules! vector {
        ($name:ident, $inner:ident, $t:ident, $width:literal, $splat:ident, $fnmadd:ident, $max:ident, $abs:expr) => {
            /// A vector of a machine's own.
            #[derive(Clone, Copy)]
            pub struct $name($inner);

            // SAFETY, for all of it: see the top of the file.
            impl Lanes<$t> for $name {
                const WIDTH: usize = $width;
                #[inline(always)]
                fn splat(x: $t) -> Self {
                    unsafe { $name($splat(x)) }
                }
                #[inline(always)]
                fn load(from: &[$t]) -> Option<Self> {
                    from.first_chunk().map(|lanes| unsafe { $name(transmute::<[$t; $width], $inner>(*lanes)) })
                }
                #[inline(always)]
                fn begin(from: &[$t]) -> Self {
                    // Each branch has an array of its own: one for both would pass through memory.
                    match from.first_chunk::<$width>() {
                        Some(lanes) => unsafe { $name(transmute::<[$t; $width], $inner>(*lanes)) },
                        None => unsafe { $name(transmute::<[$t; $width], $inner>(begin(from))) },
                    }
                }
                #[inline(always)]
                fn store(self, to: &mut [$t]) {
                    match to.first_chunk_mut() {
                        Some(to) => *to = unsafe { transmute::<$inner, [$t; $width]>(self.0) },
                        None => end(unsafe { transmute::<$inner, [$t; $width]>(self.0) }, to),
                    }
                }
                #[inline(always)]
                fn minus_product(self, a: Self, b: Self) -> Self {
                    unsafe { $name($fnmadd(a.0, b.0, self.0)) }
                }
                #[inline(always)]
                fn sum(self) -> $t {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    let (pairs, _) = lanes.as_chunks::<4>();
                    pairs.iter().fold(0.0, |s, [a, b, c, d]| s + ((a + b) + (c + d)))
                }
                #[inline(always)]
                fn max_abs(self, x: Self) -> Self {
                    // The instruction gives its second operand when one is NaN.
                    unsafe { $name($max(($abs)(x.0), self.0)) }
                }
                #[inline(always)]
                fn prefetch(from: &[$t]) {
                    // A hint, which no address makes wrong.
                    unsafe { _mm_prefetch::<_MM_HINT_T0>(from.as_ptr().cast()) }
                }
                #[inline(always)]
                fn within_one(self) -> bool {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    lanes.into_iter().fold(true, |all, x| all & (x <= 1.0))
                }
                #[inline(always)]
                fn row(self, i: usize) -> $t {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    crate::base::memory::at(&lanes, i)
                }
                #[inline(always)]
                fn largest(self) -> $t {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    lanes.into_iter().fold(0.0, |m, x| if x > m { x } else { m })
                }
            }
        };
    }
    vector!(Double4, __m256d, f64, 4, _mm256_set1_pd, _mm256_fnmadd_pd, _mm256_max_pd, |x| _mm256_andnot_pd(
        _mm256_set1_pd(-0.0),
        x
    ));
    vector!(Double8, __m512d, f64, 8, _mm512_set1_pd, _mm512_fnmadd_pd, _mm512_max_pd, |x| _mm512_abs_pd(x));
    vector!(Single8, __m256, f32, 8, _mm256_set1_ps, _mm256_fnmadd_ps, _mm256_max_ps, |x| _mm256_andnot_ps(
        _mm256_set1_ps(-0.0),
        x
    ));
}

#[cfg(not(target_arch = "x86_64"))]
/// What the machine at hand can do.
#[derive(Clone, Copy)]
pub(crate) enum Level {
    Portable(Portable),
}

#[cfg(not(target_arch = "x86_64"))]
impl Level {
    #[inline]
    pub(crate) fn here() -> Self {
        Level::Portable(Portable)
    }
    /// Runs a task.
    #[inline]
    pub(crate) fn run<T: Task>(self, task: T) {
        task.run();
    }
    #[cfg(test)]
    pub(super) fn all() -> [Self; 1] {
        [Self::here()]
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f32 {}
#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f64 {}
