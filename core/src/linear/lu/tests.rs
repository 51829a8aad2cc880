//! Claims about the factorization.

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
    let mut pivots = std::vec![R::Index::default(); n];
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
fn factors_of_all<R: Real>(a: &[R], ld: usize, n: usize) -> Vec<(Vec<R>, Vec<R::Index>)> {
    let mut all = Vec::new();
    for level in Machine::all() {
        let (mut lu, mut pivots) = (a.to_vec(), std::vec![R::Index::default(); n]);
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
            assert_eq!(pivots[column], row as u64);
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
                let (mut lu, mut pivots) = (a.clone(), std::vec![0; n]);
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
        let (mut all, mut some, mut pivots) = (a.clone(), a, std::vec![0; n]);
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
    assert_eq!(factor(&mut a, 2, 2, &mut [0u64; 2]).unwrap_err().status, Status::Singular);
    let mut a = [1.0, f64::NAN, 2.0, 4.0];
    assert!(factor(&mut a, 2, 2, &mut [0u64; 2]).is_err());
}
