//! The loops of the factorization that are worth instructions of their own, and who has them.

use super::divide::divide;
use super::rows::{BLOCK, Rows};
#[cfg(target_arch = "x86_64")]
use super::{eliminate, tile, triangle};
#[cfg(target_arch = "x86_64")]
use crate::base::machine::{Avx2, Avx512, Task};
use crate::base::scalar::Real;

/// The loops that are worth instructions of their own.
pub(super) trait Kernel<R: Real>: Copy {
    /// C ← C − A B, where B and C are rows of the same columns `right` and do not overlap. `left` holds A's columns.
    fn subtract(self, left: &[R], ld: usize, rows: Rows, right: &mut [R]);
    /// Elimination with partial pivoting of at most [`BLOCK`] columns from row `k` on. Returns the smallest and the
    /// largest pivot; `None` when there is none.
    fn eliminate_block(self, block: &mut [R], ld: usize, n: usize, k: usize, pivots: &mut [R::Index])
    -> Option<(R, R)>;
    /// A ← A U⁻¹ in the rows `to ..` of a block of at most [`BLOCK`] columns, whose rows `from ..` hold U.
    fn divide(self, block: &mut [R], ld: usize, rows: Rows) {
        divide(block, ld, rows);
    }
    /// Solves with the unit lower triangle in rows `k ..` of the columns `left` (at most [`BLOCK`]).
    fn solve_lower(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// Solves with the upper triangle there.
    fn solve_upper(self, left: &[R], ld: usize, k: usize, right: &mut [R]);
    /// Most columns that [`Kernel::eliminate_block`] and the solves with triangles take.
    fn block(self) -> usize {
        BLOCK
    }
    /// Solves Uᵀ Lᵀ x = b in place with the factors of order `n`.
    fn solve_transposed(self, lu: &[R], ld: usize, n: usize, b: &mut [R]);
}

#[cfg(target_arch = "x86_64")]
macro_rules! kernel {
    ($machine:ident, $vector:ident) => {
        impl<R: Real> Kernel<R> for $machine {
            kernel!(@fused fn subtract(left: &'a [R], ld: usize, rows: Rows, right: &'a mut [R]) -> () =
                tile::subtract::<R, R::$vector, 3>(left, ld, rows, right));
            kernel!(@fused fn eliminate_block(
                block: &'a mut [R], ld: usize, n: usize, k: usize, pivots: &'a mut [R::Index]
            ) -> Option<(R, R)> = eliminate::eliminate_block::<R, R::$vector>(block, ld, n, k, pivots));
            kernel!(@fused fn divide(block: &'a mut [R], ld: usize, rows: Rows) -> () =
                eliminate::divide::<R, R::$vector>(block, ld, rows));
            kernel!(@fused fn solve_lower(left: &'a [R], ld: usize, k: usize, right: &'a mut [R]) -> () =
                triangle::solve_triangle::<R, R::$vector, false>(left, ld, k, right));
            kernel!(@fused fn solve_upper(left: &'a [R], ld: usize, k: usize, right: &'a mut [R]) -> () =
                triangle::solve_triangle::<R, R::$vector, true>(left, ld, k, right));
            kernel!(@fused fn solve_transposed(lu: &'a [R], ld: usize, n: usize, b: &'a mut [R]) -> () =
                triangle::solve_transposed::<R, R::$vector>(lu, ld, n, b));
        }
    };
    // A function of the trait as a task that the machine's value runs.
    (@fused fn $name:ident($($arg:ident: $type:ty),*) -> $out:ty = $run:expr) => {
        #[inline(always)]
        fn $name<'a>(self, $($arg: $type),*) -> $out {
            struct Arguments<'a, R: Real> { $($arg: $type),* }
            impl<'a, R: Real> Task for Arguments<'a, R> {
                type Output = $out;
                #[inline(always)]
                fn run(self) -> $out {
                    let Arguments { $($arg),* } = self;
                    $run
                }
            }
            self.fused(Arguments::<'a, R> { $($arg),* })
        }
    };
}
#[cfg(target_arch = "x86_64")]
kernel!(Avx2, Short);
#[cfg(target_arch = "x86_64")]
kernel!(Avx512, Long);
