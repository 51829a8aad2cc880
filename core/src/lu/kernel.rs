//! The dispatch point: which instructions of the machine at hand the loops of [`super::tile`] are compiled for.
//!
//! The only module of this crate with `unsafe`, for two things:
//! * Calls of functions compiled for instructions that not every machine has. A value of [`Avx2`] or [`Avx512`] is the
//!   proof that the machine has them: both are made in [`Level::here`] alone, after asking.
//! * Vectors made from arrays of the same size and back, where every bit pattern is valid on both sides; and the
//!   arithmetic on such vectors, which is reached through the functions above alone because the types are named nowhere else.
#![allow(unsafe_code)]

use super::tile::{self, Lanes, Rows};
use crate::scalar::Real;
use crate::workspace::inner;

/// The loops that are worth instructions of their own.
pub(super) trait Kernel<R: Real>: Copy {
    /// [`tile::subtract`].
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]);
    /// [`tile::eliminate_block`].
    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R]) -> Option<(R, R)>;
    /// [`tile::solve_triangle`].
    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// [`tile::solve_triangle`].
    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// Scalar product.
    fn inner(self, a: &[R], b: &[R]) -> R;
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

/// Any machine.
#[derive(Clone, Copy)]
pub(super) struct Portable;

/// Rows of a vector where the compiler has to find the machine's own: as many as 16 registers hold four columns of.
#[cfg(target_arch = "arm")]
const PORTABLE: usize = 2;
#[cfg(not(target_arch = "arm"))]
const PORTABLE: usize = 4;

impl<R: Real> Kernel<R> for Portable {
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]) {
        tile::subtract::<R, [R; PORTABLE], 1>(left, ld, rows, right);
    }
    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R]) -> Option<(R, R)> {
        tile::eliminate_block::<R, [R; PORTABLE]>(block, ld, n, k, pivots)
    }
    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        tile::solve_triangle::<R, [R; PORTABLE], false>(left, ld, k, right);
    }
    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
        tile::solve_triangle::<R, [R; PORTABLE], true>(left, ld, k, right);
    }
    fn inner(self, a: &[R], b: &[R]) -> R {
        inner(a, b)
    }
}

impl<R: Real, const W: usize> Lanes<R> for [R; W] {
    const WIDTH: usize = W;
    #[inline(always)]
    fn splat(x: R) -> Self {
        [x; W]
    }
    #[inline(always)]
    fn load(from: &[R]) -> Option<Self> {
        from.first_chunk().copied()
    }
    #[inline(always)]
    fn begin(from: &[R]) -> Self {
        from.first_chunk().copied().unwrap_or_else(|| begin(from))
    }
    #[inline(always)]
    fn store(self, to: &mut [R]) {
        match to.first_chunk_mut() {
            Some(to) => *to = self,
            None => crate::workspace::copy(to, &self),
        }
    }
    #[inline(always)]
    fn minus_product(mut self, a: Self, b: Self) -> Self {
        for ((s, a), b) in self.iter_mut().zip(a).zip(b) {
            *s -= a * b;
        }
        self
    }
    #[inline(always)]
    fn max_abs(mut self, x: Self) -> Self {
        for (s, x) in self.iter_mut().zip(x) {
            let size = x.abs();
            if size > *s {
                *s = size;
            }
        }
        self
    }
    #[inline(always)]
    fn row(self, i: usize) -> R {
        crate::workspace::at(&self, i)
    }
    #[inline(always)]
    fn largest(self) -> R {
        self.into_iter().fold(R::zero(), |m, x| if x > m { x } else { m })
    }
}

/// The first elements of a slice that is too short, followed by 0.
#[cold]
#[inline(never)]
fn begin<R: Real, const W: usize>(from: &[R]) -> [R; W] {
    let mut lanes = [R::zero(); W];
    crate::workspace::copy(&mut lanes, from);
    lanes
}

#[cfg(target_arch = "x86_64")]
pub(super) use x86::Level;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use core::arch::x86_64::*;
    use core::mem::transmute;

    /// What the machine at hand can do.
    pub(in super::super) enum Level {
        Portable(Portable),
        Avx2(Avx2),
        Avx512(Avx512),
    }

    impl Level {
        /// Asks the machine; without `std`, the compiler's options.
        #[inline]
        pub(in super::super) fn here() -> Self {
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
            if !(has!("avx2") && has!("fma")) {
                Level::Portable(Portable)
            } else if has!("avx512f") && has!("avx512vl") && has!("avx512dq") {
                Level::Avx512(Avx512(()))
            } else {
                Level::Avx2(Avx2(()))
            }
        }
    }

    /// A machine with AVX2 and FMA: 16 registers of 256 bits.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx2(());

    /// A machine with AVX-512: 32 registers.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx512(());

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
                        tile::eliminate_block::<R, R::$vector>(block, ld, n, k, pivots)
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(block, ld, n, k, pivots) }
                }
                #[inline(always)]
                fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(left: &[R], ld: usize, k: usize, right: &mut [R]) {
                        tile::solve_triangle::<R, R::$vector, false>(left, ld, k, right);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(left, ld, k, right) }
                }
                #[inline(always)]
                fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]) {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(left: &[R], ld: usize, k: usize, right: &mut [R]) {
                        tile::solve_triangle::<R, R::$vector, true>(left, ld, k, right);
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(left, ld, k, right) }
                }
                #[inline(always)]
                fn inner(self, a: &[R], b: &[R]) -> R {
                    #[target_feature(enable = $features)]
                    fn compiled<R: Real>(a: &[R], b: &[R]) -> R {
                        inner(a, b)
                    }
                    // SAFETY: `self` proves that the machine has these instructions.
                    unsafe { compiled(a, b) }
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
                    let lanes: [$t; $width] = Lanes::<$t>::begin(from);
                    unsafe { $name(transmute::<[$t; $width], $inner>(lanes)) }
                }
                #[inline(always)]
                fn store(self, to: &mut [$t]) {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    match to.first_chunk_mut() {
                        Some(to) => *to = lanes,
                        None => crate::workspace::copy(to, &lanes),
                    }
                }
                #[inline(always)]
                fn minus_product(self, a: Self, b: Self) -> Self {
                    unsafe { $name($fnmadd(a.0, b.0, self.0)) }
                }
                #[inline(always)]
                fn max_abs(self, x: Self) -> Self {
                    // The instruction gives its second operand when one is NaN.
                    unsafe { $name($max(($abs)(x.0), self.0)) }
                }
                #[inline(always)]
                fn row(self, i: usize) -> $t {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    crate::workspace::at(&lanes, i)
                }
                #[inline(always)]
                fn largest(self) -> $t {
                    let lanes = unsafe { transmute::<$inner, [$t; $width]>(self.0) };
                    Lanes::<$t>::largest(lanes)
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
pub(super) enum Level {
    Portable(Portable),
}

#[cfg(not(target_arch = "x86_64"))]
impl Level {
    #[inline]
    pub(super) fn here() -> Self {
        Level::Portable(Portable)
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f32 {}
#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f64 {}
