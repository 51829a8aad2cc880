//! Factorization L D Lᵀ of a small symmetric positive definite matrix in the caller's memory: the mass matrix, whose rows
//! have different units. No rows are exchanged, and each pivot is judged by the diagonal entry it came from, so that a
//! change of units changes neither the result nor what counts as singular.
//!
//! Not nalgebra's Cholesky factorization: it asks of a pivot no more than that its root is real, so that one lost in rounding
//! passes in one unit and not in another; its other factorizations exchange rows by size, which compares kilograms with kilogram
//! square metres; and all of them own their matrix, on the heap where the size is not known to the compiler.
//!
//! Tested by the tests at its end, `tests/extremes.rs:a_change_of_units_by_a_power_of_two_changes_no_digit`.

use crate::base::memory::{at, axpy, inner, part, part_mut, put};
use crate::base::scalar::Real;

/// Factorizes the n × n matrix in the lower triangle of `a` (column-major) in place; `inverse` gets the inverse pivots. n³/3.
///
/// # Errors
/// The first pivot that is not positive, or lost in the rounding of its diagonal entry.
pub(crate) fn factor<R: Real>(a: &mut [R], n: usize, inverse: &mut [R]) -> Result<(), usize> {
    for k in 0..n {
        put(inverse, k, at(a, k * n + k));
    }
    for k in 0..n {
        let Some((head, tail)) = a.split_at_mut_checked((k + 1) * n) else { return Err(k) };
        let column = part(head, k * n, n);
        let (pivot, diagonal) = (at(column, k), at(inverse, k));
        let sound = pivot > R::EPSILON * diagonal && (R::one() / pivot).is_finite();
        if !sound {
            return Err(k);
        }
        let reciprocal = R::one() / pivot;
        put(inverse, k, reciprocal);
        for (j, later) in (k + 1..n).zip(tail.chunks_exact_mut(n.max(1))) {
            axpy(part_mut(later, j, n - j), -(at(column, j) * reciprocal), part(column, j, n - j));
        }
    }
    Ok(())
}

/// Solves with the factors, in place.
pub(crate) fn solve<R: Real>(a: &[R], n: usize, inverse: &[R], b: &mut [R]) {
    for k in 0..n {
        let x = at(b, k) * at(inverse, k);
        axpy(part_mut(b, k + 1, n - k - 1), -x, part(a, k * n + k + 1, n - k - 1));
    }
    for (b, inverse) in b.iter_mut().zip(inverse) {
        *b *= *inverse;
    }
    for k in (0..n).rev() {
        let known = inner(part(a, k * n + k + 1, n - k - 1), part(b, k + 1, n - k - 1));
        let x = at(b, k) - at(inverse, k) * known;
        put(b, k, x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix of units u, and a right-hand side.
    fn system<const N: usize>(u: [f64; N]) -> (std::vec::Vec<f64>, [f64; N]) {
        let mut a = std::vec![0.0; N * N];
        for i in 0..N {
            for j in 0..N {
                let smooth = 1.0 / (1.0 + (i + j) as f64) + if i == j { 1.0 } else { 0.0 };
                a[j * N + i] = smooth * u[i] * u[j];
            }
        }
        (a, core::array::from_fn(|i| u[i] * (1.0 + i as f64)))
    }

    extern crate std;

    #[test]
    fn solutions_satisfy_their_equations() {
        let (a, b) = system([1.0, 3.0, 0.2, 7.0, 1.0, 0.5, 2.0]);
        // What the memory held before does not matter.
        let (mut lower, mut x, mut inverse) = (a.clone(), b, [f64::NAN; 7]);
        factor(&mut lower, 7, &mut inverse).unwrap();
        solve(&lower, 7, &inverse, &mut x);
        for i in 0..7 {
            let sum: f64 = (0..7).map(|j| a[j * 7 + i] * x[j]).sum();
            assert!((sum - b[i]).abs() < 1e-14 * b[i].abs().max(1.0));
        }
    }

    #[test]
    fn units_change_no_digit() {
        let solved = |u: [f64; 4]| {
            let (mut a, mut x) = system(u);
            let mut inverse = [0.0; 4];
            factor(&mut a, 4, &mut inverse).unwrap();
            solve(&a, 4, &inverse, &mut x);
            core::array::from_fn::<f64, 4, _>(|i| x[i] * u[i])
        };
        let units = [1.0, 2f64.powi(-80), 2f64.powi(70), 2f64.powi(-3)];
        assert_eq!(solved([1.0; 4]), solved(units));
    }

    #[test]
    fn singular_and_indefinite_matrices_are_refused() {
        for (a, pivot) in [
            ([1.0, 1.0, 1.0, 1.0], 1),
            ([1.0, 2.0, 2.0, 1.0], 1),
            ([0.0, 0.0, 0.0, 1.0], 0),
            ([f64::NAN, 0.0, 0.0, 1.0], 0),
        ] {
            assert_eq!(factor(&mut a.clone(), 2, &mut [0.0; 2]), Err(pivot));
        }
        factor::<f64>(&mut [], 0, &mut []).unwrap();
    }
}
