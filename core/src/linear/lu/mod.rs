//! LU factorization with partial pivoting over the caller's memory, and the solves that follow.
//!
//! Column-major storage with leading dimension `ld`; an odd multiple of a cache line keeps columns from falling on the same
//! lines. Right-hand sides appended behind the matrix ride along with the elimination. The elimination is recursive
//! (Toledo 1997): it halves the columns down to blocks of eight, so that nearly all work is products of large blocks, which
//! one register tile does, compiled for what the machine at hand offers (module `kernel` chooses: `tile`, `eliminate` and
//! `triangle`, or `portable`).
//! Cost: 2n³/3 for [`factor`], 2n² for each solve.
//!
//! Tested by `linear/lu/tests.rs`.

#[cfg(feature = "faer")]
mod by_faer;
mod divide;
#[cfg(target_arch = "x86_64")]
mod eliminate;
mod kernel;
mod portable;
mod rows;
#[cfg(target_arch = "x86_64")]
mod tile;
#[cfg(target_arch = "x86_64")]
mod triangle;

use crate::base::index::Index;
use crate::base::machine::Machine;
use crate::base::memory::{part, part_mut};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use kernel::Kernel;
use rows::{BLOCK, Rows, exchange};

/// Columns of the factors that one pass over the right columns takes: what a row of tiles reads of them fits the first cache.
const DEPTH: usize = 128;

/// A factorized matrix: unit lower and upper triangle in place, and the row exchanged at each step.
pub struct Factors<'a, R: Real> {
    /// The triangles, column-major.
    pub lu: &'a [R],
    /// Leading dimension.
    pub ld: usize,
    /// Row exchanged at each step, n.
    pub pivots: &'a [R::Index],
}

/// Who factorizes large systems (see [`crate::Sim::set_factorization`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Factorization {
    /// This crate: on the caller's thread, without a heap.
    #[default]
    Own,
    /// The crate [faer](https://docs.rs/faer), from 512 columns on; smaller ones are factorized by this crate all the same. Needs the
    /// feature `faer`. What this crate promises of itself does not hold for faer: it allocates (3n whole numbers, and
    /// its products their buffers), on more than one thread it wakes those of rayon's global pool and waits for them, and it may panic,
    /// say if that pool cannot be started.
    Faer {
        /// How many threads work on it, not more than rayon's global pool has; 1: the caller's alone, without that pool.
        threads: usize,
    },
}

impl Factorization {
    /// This one, if this build has it.
    ///
    /// # Errors
    /// `Unsupported` without the feature `faer`, `OutOfRange` for no thread.
    pub(crate) fn checked(self) -> Result<Self> {
        match self {
            Factorization::Faer { .. } if cfg!(not(feature = "faer")) => {
                Err(Error::new(Status::Unsupported).of("factorization", f64::NAN))
            }
            Factorization::Faer { threads: 0 } => Err(Error::new(Status::OutOfRange).of("threads", 0.0)),
            sound => Ok(sound),
        }
    }
}

/// Runs an expression with the kernel of the machine at hand.
macro_rules! with_kernel {
    ($level:expr, $kernel:ident => $run:expr) => {
        match $level {
            Machine::Portable($kernel) => $run,
            #[cfg(target_arch = "x86_64")]
            Machine::Avx2($kernel) => $run,
            #[cfg(target_arch = "x86_64")]
            Machine::Avx512($kernel) => $run,
        }
    };
}

/// Factorizes the first `n` columns of `a` in place and carries the further columns (right-hand sides) along:
/// they come out as L⁻¹P b, ready for [`Factors::back_substitute`].
///
/// Returns the smallest pivot relative to the largest. `pivots`: n long. 2n³/3 operations, and 2n² for each further column.
///
/// # Errors
/// `Singular` when a pivot column vanishes to rounding or holds a value that is not finite.
pub fn factor<R: Real>(a: &mut [R], ld: usize, n: usize, pivots: &mut [R::Index]) -> Result<R> {
    factor_further(Factorization::Own, a, ld, n, 0, pivots, |_| usize::MAX)
}

/// [`factor`] by whom is said. The factors differ by rounding.
///
/// # Errors
/// As [`factor`]; `Unsupported` for faer without its feature, `OutOfRange` for no thread, `OutOfMemory` where faer got none.
pub fn factor_with<R: Real>(by: Factorization, a: &mut [R], ld: usize, n: usize, pivots: &mut [R::Index]) -> Result<R> {
    factor_further(by.checked()?, a, ld, n, 0, pivots, |_| usize::MAX)
}

/// The same where the first `done` rows and columns are factorized already, with their pivots, and where right-hand sides
/// begin with zeros: `begun(row)` tells how many of these columns, from the first on, may hold anything else above that row.
pub(crate) fn factor_further<R: Real>(
    by: Factorization,
    a: &mut [R],
    ld: usize,
    n: usize,
    done: usize,
    pivots: &mut [R::Index],
    begun: impl Fn(usize) -> usize,
) -> Result<R> {
    with_kernel!(Machine::here(), kernel => factor_by(kernel, by, a, ld, n, done, pivots, begun))
}

fn factor_by<R: Real, K: Kernel<R>>(
    kernel: K,
    by: Factorization,
    a: &mut [R],
    ld: usize,
    n: usize,
    done: usize,
    pivots: &mut [R::Index],
    begun: impl Fn(usize) -> usize,
) -> Result<R> {
    let (matrix, columns) = a.split_at_mut_checked(n * ld).ok_or(Status::Internal)?;
    let pivots = pivots.get_mut(..n).ok_or(Status::Internal)?;
    if n > ld {
        return Err(Status::Internal.into());
    }
    let (left, right) = matrix.split_at_mut_checked(done * ld).ok_or(Status::Internal)?;
    let (first, second) = pivots.split_at_mut_checked(done).ok_or(Status::Internal)?;
    extend(kernel, left, ld, n, done, 0);
    exchange_all(right, ld, 0, first);
    reduce(kernel, left, ld, n, 0, right);
    let (mut smallest, mut largest) = eliminate_by(kernel, by, right, ld, n, done, second)?;
    exchange_all(left, ld, done, second);
    for pivot in left.iter().step_by(ld.saturating_add(1)) {
        (smallest, largest) = (smallest.min(pivot.abs()), largest.max(pivot.abs()));
    }
    let straight = exchange_all(columns, ld, 0, pivots);
    let width = if straight { (n / (8 * BLOCK) * BLOCK).clamp(2 * BLOCK, DEPTH) } else { DEPTH };
    for (i, left) in matrix.chunks((width * ld).max(1)).enumerate() {
        let count = if straight { begun((i + 1) * width) } else { usize::MAX };
        let right = part_mut(columns, 0, count.saturating_mul(ld).min(columns.len()));
        reduce(kernel, left, ld, n, i * width, right);
    }
    let ratio = smallest / largest;
    if n > 0 && (ratio <= R::EPSILON * R::HALF || !ratio.is_finite()) {
        return Err(Status::Singular.into());
    }
    Ok(ratio)
}

/// Eliminates the columns that are left, `block`, by whom is said. Returns the smallest and the largest pivot.
#[inline(always)]
#[cfg_attr(not(feature = "faer"), allow(unused_variables))]
fn eliminate_by<R: Real, K: Kernel<R>>(
    kernel: K,
    by: Factorization,
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
) -> Result<(R, R)> {
    #[cfg(feature = "faer")]
    if let Factorization::Faer { threads } = by
        && pivots.len() >= by_faer::SMALLEST
    {
        return by_faer::eliminate(block, ld, n, k, pivots, threads);
    }
    eliminate(kernel, block, ld, n, k, pivots).ok_or(Status::Singular.into())
}

/// Eliminates the columns `block`, which begin at column `k`. Returns the smallest and the largest pivot.
fn eliminate<R: Real, K: Kernel<R>>(
    kernel: K,
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R::Index],
) -> Option<(R, R)> {
    if pivots.len() <= kernel.block() {
        return kernel.eliminate_block(block, ld, n, k, pivots);
    }
    let half = pivots.len().div_ceil(2 * kernel.block()) * kernel.block();
    let (left, right) = block.split_at_mut_checked(half * ld)?;
    let (first, second) = pivots.split_at_mut_checked(half)?;
    let (smallest, largest) = eliminate(kernel, left, ld, n, k, first)?;
    exchange_all(right, ld, k, first);
    reduce(kernel, left, ld, n, k, right);
    let (low, high) = eliminate(kernel, right, ld, n, k + half, second)?;
    exchange_all(left, ld, k + half, second);
    Some((smallest.min(low), largest.max(high)))
}

/// The multipliers of the rows `top ..` for columns whose rows above are factorized already: A U⁻¹.
fn extend<R: Real, K: Kernel<R>>(kernel: K, block: &mut [R], ld: usize, n: usize, top: usize, k: usize) {
    let width = block.len().checked_div(ld).unwrap_or(0);
    if width <= BLOCK {
        return kernel.divide(block, ld, Rows { to: top, count: n - top, from: k });
    }
    let half = width.div_ceil(2 * BLOCK) * BLOCK;
    let Some((left, right)) = block.split_at_mut_checked(half * ld) else { return };
    extend(kernel, left, ld, n, top, k);
    kernel.subtract(left, ld, Rows { to: top, count: n - top, from: k }, right);
    extend(kernel, right, ld, n, top, k + half);
}

/// What the eliminated columns `left`, from column `k` on, do to the columns `right`: rows `k ..` are solved with the unit
/// triangle, those below reduced.
fn reduce<R: Real, K: Kernel<R>>(kernel: K, left: &[R], ld: usize, n: usize, k: usize, right: &mut [R]) {
    if right.is_empty() {
        return;
    }
    for (i, left) in left.chunks((DEPTH * ld).max(1)).enumerate() {
        let k = k + i * DEPTH;
        let width = left.len().checked_div(ld).unwrap_or(0);
        substitute(kernel, left, ld, k, right);
        kernel.subtract(left, ld, Rows { to: k + width, count: n - k - width, from: k }, right);
    }
}

/// Solves with the unit triangle in the rows `k ..` of the columns `left`.
fn substitute<R: Real, K: Kernel<R>>(kernel: K, left: &[R], ld: usize, k: usize, right: &mut [R]) {
    let width = left.len().checked_div(ld).unwrap_or(0);
    if width <= kernel.block() {
        return kernel.solve_lower(left, ld, k, right);
    }
    let half = width.div_ceil(2 * kernel.block()) * kernel.block();
    let (first, second) = left.split_at_checked(half * ld).unwrap_or((&[], &[]));
    substitute(kernel, first, ld, k, right);
    kernel.subtract(first, ld, Rows { to: k + half, count: width - half, from: k }, right);
    substitute(kernel, second, ld, k + half, right);
}

/// Solves with the upper triangle in the rows `k ..` of the columns `left`.
fn substitute_back<R: Real, K: Kernel<R>>(kernel: K, left: &[R], ld: usize, k: usize, right: &mut [R]) {
    let width = left.len().checked_div(ld).unwrap_or(0);
    if width <= kernel.block() {
        return kernel.solve_upper(left, ld, k, right);
    }
    let half = width.div_ceil(2 * kernel.block()) * kernel.block();
    let (first, second) = left.split_at_checked(half * ld).unwrap_or((&[], &[]));
    substitute_back(kernel, second, ld, k + half, right);
    kernel.subtract(second, ld, Rows { to: k, count: half, from: k + half }, right);
    substitute_back(kernel, first, ld, k, right);
}

/// Applies the exchanges of steps `k`, `k + 1`, … in order to every column. Returns whether there were none.
fn exchange_all<R: Real>(columns: &mut [R], ld: usize, k: usize, pivots: &[R::Index]) -> bool {
    if pivots.iter().enumerate().all(|(p, row)| row.get() == k + p) {
        return true;
    }
    for column in columns.chunks_mut(ld.max(1)) {
        for (p, row) in pivots.iter().enumerate() {
            exchange(column, k + p, row.get());
        }
    }
    false
}

impl<R: Real> Factors<'_, R> {
    /// Solves A x = b in place; `b`: n long. 2n² operations.
    pub fn solve(&self, b: &mut [R]) {
        let b = part_mut(b, 0, self.pivots.len());
        exchange_all(b, self.ld, 0, self.pivots);
        with_kernel!(Machine::here(), kernel => {
            substitute(kernel, self.matrix(), self.ld, 0, b);
            substitute_back(kernel, self.matrix(), self.ld, 0, b);
        });
    }

    /// Solves A x = b in place for each column of `b`, which has the matrix's leading dimension.
    #[cfg(feature = "derivatives")]
    pub(crate) fn solve_columns(&self, b: &mut [R]) {
        exchange_all(b, self.ld, 0, self.pivots);
        with_kernel!(Machine::here(), kernel => {
            reduce(kernel, self.matrix(), self.ld, self.pivots.len(), 0, b);
            substitute_back(kernel, self.matrix(), self.ld, 0, b);
        });
    }

    /// Solves U x = b in place for each column of `b`, which has the matrix's leading dimension or is one column.
    pub fn back_substitute(&self, b: &mut [R]) {
        with_kernel!(Machine::here(), kernel => substitute_back(kernel, self.matrix(), self.ld, 0, b));
    }

    /// Solves Aᵀ x = b in place; `b`: n long. 2n² operations.
    pub fn solve_transposed(&self, b: &mut [R]) {
        with_kernel!(Machine::here(), kernel => kernel.solve_transposed(self.lu, self.ld, self.pivots.len(), b));
        for (c, row) in self.pivots.iter().enumerate().rev() {
            exchange(b, c, row.get());
        }
    }

    fn matrix(&self) -> &[R] {
        part(self.lu, 0, self.pivots.len() * self.ld)
    }
}

#[cfg(test)]
mod tests;
