//! LU factorization with partial pivoting over the caller's memory, and the solves that follow.
//!
//! Column-major storage with leading dimension `ld`; an odd multiple of a cache line keeps columns from falling on the same
//! lines. Right-hand sides appended behind the matrix ride along with the elimination. The elimination is recursive
//! (Toledo 1997): it halves the columns down to blocks of eight, so that nearly all work is products of large blocks, which
//! one register tile does, compiled for what the machine at hand offers (module `kernel` chooses: `tile`, `eliminate` and
//! `triangle`, or `portable`).
//! Cost: 2n³/3 for [`factor`], 2n² for each solve.

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

use crate::base::machine::Machine;
use crate::base::memory::{part, part_mut};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use kernel::Kernel;
use rows::{BLOCK, Rows, exchange};

/// Columns of the factors that one pass over the right columns takes: what a row of tiles reads of them fits the first cache.
const DEPTH: usize = 128;

/// A factorized matrix: unit lower and upper triangle in place, and the row exchanged at each step.
pub struct Factors<'a, R> {
    /// The triangles, column-major.
    pub lu: &'a [R],
    /// Leading dimension.
    pub ld: usize,
    /// Pivot row of each column (row numbers kept as reals).
    pub pivots: &'a [R],
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
/// Returns the smallest pivot relative to the largest.
///
/// # Errors
/// `Singular` when a pivot column vanishes to rounding or holds a value that is not finite.
pub fn factor<R: Real>(a: &mut [R], ld: usize, n: usize, pivots: &mut [R]) -> Result<R> {
    factor_further(a, ld, n, 0, pivots, |_| usize::MAX)
}

/// The same where the first `done` rows and columns are factorized already, with their pivots, and where right-hand sides
/// begin with zeros: `begun(row)` tells how many of these columns, from the first on, may hold anything else above that row.
pub(crate) fn factor_further<R: Real>(
    a: &mut [R],
    ld: usize,
    n: usize,
    done: usize,
    pivots: &mut [R],
    begun: impl Fn(usize) -> usize,
) -> Result<R> {
    with_kernel!(Machine::here(), kernel => factor_by(kernel, a, ld, n, done, pivots, begun))
}

fn factor_by<R: Real, K: Kernel<R>>(
    kernel: K,
    a: &mut [R],
    ld: usize,
    n: usize,
    done: usize,
    pivots: &mut [R],
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
    let (mut smallest, mut largest) = eliminate(kernel, right, ld, n, done, second).ok_or(Status::Singular)?;
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

/// Eliminates the columns `block`, which begin at column `k`. Returns the smallest and the largest pivot.
fn eliminate<R: Real, K: Kernel<R>>(
    kernel: K,
    block: &mut [R],
    ld: usize,
    n: usize,
    k: usize,
    pivots: &mut [R],
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
fn exchange_all<R: Real>(columns: &mut [R], ld: usize, k: usize, pivots: &[R]) -> bool {
    if pivots.iter().enumerate().all(|(p, row)| row_of(*row) == k + p) {
        return true;
    }
    for column in columns.chunks_mut(ld.max(1)) {
        for (p, row) in pivots.iter().enumerate() {
            exchange(column, k + p, row_of(*row));
        }
    }
    false
}

#[inline]
fn row_of<R: Real>(pivot: R) -> usize {
    pivot.to_f64() as usize
}

impl<R: Real> Factors<'_, R> {
    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [R]) {
        let b = part_mut(b, 0, self.pivots.len());
        exchange_all(b, self.ld, 0, self.pivots);
        with_kernel!(Machine::here(), kernel => {
            substitute(kernel, self.matrix(), self.ld, 0, b);
            substitute_back(kernel, self.matrix(), self.ld, 0, b);
        });
    }

    /// Solves U x = b in place for each column of `b`, which has the matrix's leading dimension or is one column.
    pub fn back_substitute(&self, b: &mut [R]) {
        with_kernel!(Machine::here(), kernel => substitute_back(kernel, self.matrix(), self.ld, 0, b));
    }

    /// Solves Aᵀ x = b in place.
    pub fn solve_transposed(&self, b: &mut [R]) {
        with_kernel!(Machine::here(), kernel => kernel.solve_transposed(self.lu, self.ld, self.pivots.len(), b));
        for (c, row) in self.pivots.iter().enumerate().rev() {
            exchange(b, c, row_of(*row));
        }
    }

    fn matrix(&self) -> &[R] {
        part(self.lu, 0, self.pivots.len() * self.ld)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    fn random(n: usize, seed: u64) -> Vec<f64> {
        let mut s = seed;
        (0..n)
            .map(|_| {
                s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (s >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            })
            .collect()
    }

    fn largest_residual<R: Real>(n: usize, tolerance: f64) {
        let ld = n + 3;
        let entries = random(n * ld, 7 + n as u64);
        let a: Vec<R> = entries.iter().map(|x| R::lit(*x)).collect();
        let x: Vec<R> = random(n, 3).iter().map(|x| R::lit(*x)).collect();
        let times = |transposed: bool| -> Vec<R> {
            (0..n)
                .map(|i| {
                    (0..n).fold(R::zero(), |s, j| {
                        let entry = if transposed { a[i * ld + j] } else { a[j * ld + i] };
                        s + entry * x[j]
                    })
                })
                .collect()
        };
        let (b, bt) = (times(false), times(true));
        let mut lu = a.clone();
        lu.extend(&b);
        lu.extend([R::zero(); 3]);
        let mut pivots = std::vec![R::zero(); n];
        factor(&mut lu, ld, n, &mut pivots).unwrap();
        let (matrix, carried) = lu.split_at(n * ld);
        let factors = Factors { lu: matrix, ld, pivots: &pivots };
        let mut solutions = [carried[..n].to_vec(), b, bt];
        factors.back_substitute(&mut solutions[0]);
        factors.solve(&mut solutions[1]);
        factors.solve_transposed(&mut solutions[2]);
        for s in solutions {
            for (s, x) in s.iter().zip(&x) {
                assert!((*s - *x).to_f64().abs() < tolerance, "n = {n}: {s} against {x}");
            }
        }
    }

    #[test]
    fn every_solve_gives_the_solution_back() {
        for n in [0, 1, 2, 7, 8, 9, 16, 17, 33, 100] {
            largest_residual::<f64>(n, 1e-10);
        }
        largest_residual::<f32>(33, 2e-3);
    }

    /// Factors by every set of instructions that the machine at hand has.
    fn factors_of_all<R: Real>(a: &[R], ld: usize, n: usize) -> Vec<(Vec<R>, Vec<R>)> {
        let mut all = Vec::new();
        for level in Machine::all() {
            let (mut lu, mut pivots) = (a.to_vec(), std::vec![R::zero(); n]);
            with_kernel!(level, kernel => factor_by(kernel, &mut lu, ld, n, 0, &mut pivots, |_| usize::MAX)).unwrap();
            all.push((lu, pivots));
        }
        all
    }

    fn largest_difference<R: Real>(n: usize, columns: usize, tolerance: f64) {
        for ld in [n, n + 8] {
            let a: Vec<R> = random(ld * (n + columns), 5 + n as u64).iter().map(|x| R::lit(*x)).collect();
            let all = factors_of_all(&a, ld, n);
            let (lu, pivots) = &all[0];
            for (other, others_pivots) in &all[1..] {
                assert_eq!(pivots, others_pivots);
                for (x, y) in lu.chunks(ld).zip(other.chunks(ld)) {
                    for (x, y) in x[..n].iter().zip(y) {
                        assert!((*x - *y).to_f64().abs() < tolerance, "n = {n}, ld = {ld}: {x} and {y}");
                    }
                }
            }
        }
    }

    #[test]
    fn instructions_change_the_factors_by_rounding_only() {
        for n in 1..70 {
            largest_difference::<f64>(n, n % 7, 1e-11);
        }
        largest_difference::<f64>(300, 13, 1e-9);
        for n in [5, 8, 31, 33] {
            largest_difference::<f32>(n, 5, 1e-2);
        }
    }

    /// Dominated by its diagonal, so that no rows need to be exchanged.
    fn dominant(n: usize, ld: usize) -> Vec<f64> {
        let mut a: Vec<f64> = random(n * ld, 9).iter().map(|x| x / n as f64).collect();
        a.iter_mut().step_by(ld + 1).for_each(|x| *x += 1.0);
        a
    }

    #[test]
    fn a_block_that_turns_out_to_need_an_exchange_gets_it() {
        let (n, ld) = (61, 64);
        for (row, column) in [(60, 3), (59, 17), (9, 8), (33, 30)] {
            let mut a = dominant(n, ld);
            a[column * ld + row] = 3.0;
            for (lu, pivots) in factors_of_all(&a, ld, n) {
                assert_eq!(pivots[column], row as f64);
                let factors = Factors { lu: &lu, ld, pivots: &pivots };
                let mut x: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[j * ld + i]).sum()).collect();
                factors.solve(&mut x);
                assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-13));
            }
        }
    }

    #[test]
    fn a_factorization_continued_from_its_first_block_solves_the_system() {
        for level in Machine::all() {
            for (n, done) in [(64, 0), (64, 24), (61, 13), (40, 39), (90, 51), (7, 3)] {
                let ld = n + 3;
                for a in [dominant(n, ld), random(n * ld, 4)] {
                    let (mut lu, mut pivots) = (a.clone(), std::vec![0.0; n]);
                    let sum = |i: usize| (0..n).map(|j| a[j * ld + i]).sum::<f64>();
                    lu.extend((0..n).map(sum).chain([0.0; 3]));
                    with_kernel!(level, kernel => {
                        factor_by(kernel, &mut lu[..done * ld], ld, done, 0, &mut pivots, |_| 1).unwrap();
                        factor_by(kernel, &mut lu, ld, n, done, &mut pivots, |_| 1).unwrap();
                    });
                    let (lu, carried) = lu.split_at(n * ld);
                    let factors = Factors { lu, ld, pivots: &pivots };
                    let (mut x, mut y) = (carried[..n].to_vec(), (0..n).map(sum).collect::<Vec<_>>());
                    factors.back_substitute(&mut x);
                    factors.solve(&mut y);
                    assert!(x.iter().chain(&y).all(|x| (x - 1.0).abs() < 1e-9), "n = {n}, {done} done");
                }
            }
        }
    }

    #[test]
    fn zeros_at_the_top_of_right_hand_sides_need_not_be_carried() {
        let (n, ld) = (60, 64);
        let columns = |a: &mut Vec<f64>| {
            for k in 0..5 {
                a.extend((0..ld).map(|i| if i < 12 * k || i >= n { 0.0 } else { (i * (k + 1)) as f64 % 7.0 }));
            }
        };
        for mut a in [dominant(n, ld), random(n * ld, 4)] {
            columns(&mut a);
            let (mut all, mut some, mut pivots) = (a.clone(), a, std::vec![0.0; n]);
            factor(&mut all, ld, n, &mut pivots).unwrap();
            factor_further(&mut some, ld, n, 0, &mut pivots, |row| row.div_ceil(12)).unwrap();
            for (x, y) in all.chunks(ld).zip(some.chunks(ld)) {
                assert!(x[..n].iter().zip(y).all(|(x, y)| (x - y).abs() < 1e-9 * (1.0 + x.abs())));
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut a = [1.0, 2.0, 2.0, 4.0];
        assert_eq!(factor(&mut a, 2, 2, &mut [0.0; 2]).unwrap_err().status, Status::Singular);
        let mut a = [1.0, f64::NAN, 2.0, 4.0];
        assert!(factor(&mut a, 2, 2, &mut [0.0; 2]).is_err());
    }
}
