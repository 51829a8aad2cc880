//! The dispatch point: which instructions of the machine at hand a loop is compiled for, and the machine's vectors.
//!
//! The only module of this crate with `unsafe`, for two things:
//! * Calls of functions compiled for instructions that not every machine has. A value of [`Avx2`] or [`Avx512`] is the
//!   proof that the machine has them: both are made in [`Machine::here`] alone, after asking.
//! * Vectors made from arrays of the same size and back, where every bit pattern is valid on both sides; and the
//!   arithmetic on such vectors, which is reached through [`Task`]s run by such a value alone because the types are named
//!   nowhere else.
//!
//! Tested by the factorizations of [`crate::linear::lu`], on everything that the machine at hand can do.
#![allow(unsafe_code)]

/// A computation that is worth compiling for the machine's own instructions: everything that `run` calls must be inlined.
pub(crate) trait Task {
    /// What it gives.
    type Output;
    /// Computes.
    fn run(self) -> Self::Output;
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

/// A vector of a few rows of one column.
#[cfg(target_arch = "x86_64")]
pub trait Lanes<R>: Copy {
    /// Rows.
    const WIDTH: usize;
    /// The same value in every row.
    fn splat(x: R) -> Self;
    /// The first rows of a slice, if it has them all.
    fn load(from: &[R]) -> Option<Self>;
    /// The first rows of a slice; 0 where it ends early.
    fn begin(from: &[R]) -> Self;
    /// Writes as many rows as the slice has.
    fn store(self, to: &mut [R]);
    /// `self − a b`.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Sum of the rows.
    fn sum(self) -> R;
    /// The larger of `self` and |x|, row by row; `self` where x is NaN.
    fn max_abs(self, x: Self) -> Self;
    /// Asks for the memory of a slice's first element ahead of its use.
    fn prefetch(from: &[R]);
    /// Whether no row, all ≥ 0, exceeds 1.
    fn within_one(self) -> bool;
    /// One row.
    fn row(self, i: usize) -> R;
    /// The largest row.
    fn largest(self) -> R;
}

/// A machine of which nothing is known.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512, Machine};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Lanes, Portable, Task, Vectors};
    use core::arch::x86_64::*;
    use core::mem::transmute;

    /// What the machine at hand can do.
    #[derive(Clone, Copy)]
    pub(crate) enum Machine {
        Portable(Portable),
        Avx2(Avx2),
        Avx512(Avx512),
    }

    impl Machine {
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
                Machine::Portable(Portable)
            } else if has!("avx512f") && has!("avx512vl") && has!("avx512dq") {
                Machine::Avx512(Avx512(()))
            } else {
                Machine::Avx2(Avx2(()))
            }
        }

        /// Runs a task compiled for the machine, its arithmetic as written.
        #[inline]
        pub(crate) fn run<T: Task>(self, task: T) -> T::Output {
            #[target_feature(enable = "avx2")]
            fn short<T: Task>(task: T) -> T::Output {
                task.run()
            }
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
            fn long<T: Task>(task: T) -> T::Output {
                task.run()
            }
            match self {
                Machine::Portable(_) => task.run(),
                // SAFETY: the value proves that the machine has these instructions.
                Machine::Avx2(_) => unsafe { short(task) },
                // SAFETY: the same.
                Machine::Avx512(_) => unsafe { long(task) },
            }
        }
    }

    #[cfg(test)]
    impl Machine {
        /// Everything the machine at hand can do, the least first.
        pub(crate) fn all() -> std::vec::Vec<Self> {
            let mut all = std::vec![Machine::Portable(Portable)];
            match Self::here() {
                Machine::Portable(_) => {}
                Machine::Avx2(kernel) => all.push(Machine::Avx2(kernel)),
                Machine::Avx512(kernel) => all.extend([Machine::Avx2(Avx2(())), Machine::Avx512(kernel)]),
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

    impl Avx2 {
        /// Runs a task that may use [`Vectors::Short`] and fused products.
        #[inline(always)]
        pub(crate) fn fused<T: Task>(self, task: T) -> T::Output {
            #[target_feature(enable = "avx2,fma")]
            fn compiled<T: Task>(task: T) -> T::Output {
                task.run()
            }
            // SAFETY: `self` proves that the machine has these instructions.
            unsafe { compiled(task) }
        }
    }

    impl Avx512 {
        /// Runs a task that may use [`Vectors::Long`] and fused products.
        #[inline(always)]
        pub(crate) fn fused<T: Task>(self, task: T) -> T::Output {
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
            fn compiled<T: Task>(task: T) -> T::Output {
                task.run()
            }
            // SAFETY: `self` proves that the machine has these instructions.
            unsafe { compiled(task) }
        }
    }

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
    fn begin<R: Copy + Default, const W: usize>(from: &[R]) -> [R; W] {
        let mut lanes = [R::default(); W];
        lanes.iter_mut().zip(from).for_each(|(lane, x)| *lane = *x);
        lanes
    }

    /// Writes the first elements to a slice that is too short for all.
    #[cold]
    #[inline(never)]
    fn end<R: Copy, const W: usize>(lanes: [R; W], to: &mut [R]) {
        to.iter_mut().zip(lanes).for_each(|(x, lane)| *x = lane);
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
                    lanes.get(i).copied().unwrap_or($t::NAN)
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

/// What the machine at hand can do.
#[cfg(not(target_arch = "x86_64"))]
#[derive(Clone, Copy)]
pub(crate) enum Machine {
    Portable(Portable),
}

#[cfg(not(target_arch = "x86_64"))]
impl Machine {
    /// Nothing special.
    #[inline]
    pub(crate) fn here() -> Self {
        Machine::Portable(Portable)
    }
    /// Runs a task.
    #[inline]
    pub(crate) fn run<T: Task>(self, task: T) -> T::Output {
        task.run()
    }
    #[cfg(test)]
    pub(crate) fn all() -> [Self; 1] {
        [Self::here()]
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f32 {}
#[cfg(not(target_arch = "x86_64"))]
impl Vectors for f64 {}
