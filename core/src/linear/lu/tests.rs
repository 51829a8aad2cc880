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
        with_kernel!(level, kernel => factor_by(kernel, Factorization::Own, &mut lu, ld, n, 0, &mut pivots, |_| usize::MAX)).unwrap();
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
fn a_matrix_with_an_entry_that_is_not_finite_is_refused() {
    let n = 21;
    for (entry, value) in (0..n * n).flat_map(|e| [(e, f64::NAN), (e, f64::INFINITY)]) {
        let mut a = dominant(n, n);
        a[entry] = value;
        for level in Machine::all() {
            let (mut lu, mut pivots) = (a.clone(), std::vec![0; n]);
            let told = with_kernel!(level, kernel =>
                factor_by(kernel, Factorization::Own, &mut lu, n, n, 0, &mut pivots, |_| usize::MAX));
            assert_eq!(told.unwrap_err().status, Status::Singular, "{value} at {} {}", entry % n, entry / n);
        }
    }
}

#[test]
fn every_pivot_is_the_largest_of_its_column() {
    for n in [2, 5, 8, 9, 31, 64] {
        for seed in 0..6 {
            let a = random(n * n, seed);
            let (mut lu, mut pivots) = (a.clone(), std::vec![0; n]);
            factor_with(Factorization::Own, &mut lu, n, n, &mut pivots).unwrap();
            let (mut lu2, mut pivots2) = (a, std::vec![0; n]);
            factor(&mut lu2, n, n, &mut pivots2).unwrap();
            assert_eq!((&lu, &pivots), (&lu2, &pivots2));
            let largest = (0..n).flat_map(|j| &lu[j * n + j + 1..(j + 1) * n]).fold(0.0, |m: f64, l| m.max(l.abs()));
            assert!(largest <= 1.0, "n = {n}: a multiplier is {largest}");
        }
    }
    // Without a first pivot nothing can be done but to exchange.
    let (mut lu, mut pivots) = ([0.0_f64, 2.0, 3.0, 1.0], [0; 2]);
    assert_eq!(factor(&mut lu, 2, 2, &mut pivots).unwrap(), 2.0 / 3.0);
    assert_eq!((lu, pivots[0]), ([2.0, 0.0, 1.0, 3.0], 1));
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
                    factor_by(kernel, Factorization::Own, &mut lu[..done * ld], ld, done, 0, &mut pivots, |_| 1).unwrap();
                    factor_by(kernel, Factorization::Own, &mut lu, ld, n, done, &mut pivots, |_| 1).unwrap();
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
        factor_further(Factorization::Own, &mut some, ld, n, 0, &mut pivots, |row| row.div_ceil(12)).unwrap();
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

/// The own elimination of the columns from `k` on, and faer's on so many threads.
#[cfg(feature = "faer")]
fn compare_with_faer<R: Real>(a: &[f64], (ld, n, k): (usize, usize, usize), threads: usize, tolerance: f64) {
    let a: Vec<R> = a[k * ld..n * ld].iter().map(|x| R::lit(*x)).collect();
    let (mut own, mut pivots) = (a.clone(), std::vec![R::Index::default(); n - k]);
    let (mut other, mut others_pivots) = (a.clone(), pivots.clone());
    let machine = Machine::here();
    let extremes = with_kernel!(machine, kernel => eliminate(kernel, &mut own, ld, n, k, &mut pivots)).unwrap();
    let others_extremes = by_faer::eliminate(&mut other, ld, n, k, &mut others_pivots, threads).unwrap();
    assert_eq!(pivots, others_pivots, "n = {n}, k = {k}, {threads} threads");
    for ((x, y), before) in own.chunks(ld).zip(other.chunks(ld)).zip(a.chunks(ld)) {
        for (i, (x, y)) in x.iter().zip(y).enumerate() {
            let kept = i < k || i >= n;
            assert!((*x - *y).to_f64().abs() <= tolerance && (!kept || *y == before[i]), "{n}, {k}: {x} and {y}");
        }
    }
    for (x, y) in [(extremes.0, others_extremes.0), (extremes.1, others_extremes.1)] {
        assert!((x - y).to_f64().abs() <= tolerance * x.to_f64());
    }
}

#[cfg(feature = "faer")]
#[test]
fn faer_makes_the_own_factors_and_exchanges_but_for_rounding() {
    for (n, k) in [(1, 0), (2, 1), (7, 3), (64, 24), (150, 0), (200, 37)] {
        for a in [dominant(n, n + 3), random(n * (n + 3), 4)] {
            for threads in 1..=3 {
                compare_with_faer::<f64>(&a, (n + 3, n, k), threads, 1e-10);
                compare_with_faer::<f32>(&a, (n + 3, n, k), threads, 1e-2);
            }
        }
    }
}

#[cfg(feature = "faer")]
#[test]
fn systems_that_faer_factorizes_are_solved() {
    let by = Factorization::Faer { threads: 2 };
    for (n, done) in [(by_faer::SMALLEST, 0), (by_faer::SMALLEST + 60, 60)] {
        let ld = n + 5;
        for a in [dominant(n, ld), random(n * ld, 4)] {
            let (mut lu, mut pivots) = (a.clone(), std::vec![0; n]);
            let sum = |i: usize| (0..n).map(|j| a[j * ld + i]).sum::<f64>();
            lu.extend((0..n).map(sum).chain([0.0; 5]));
            factor(&mut lu[..done * ld], ld, done, &mut pivots).unwrap();
            // From the first kept block on, as between walls.
            let mut early = lu[..n * ld].to_vec();
            factor_further(Factorization::Own, &mut early, ld, n, done, &mut pivots.clone(), |_| 1).unwrap();
            factor_further(by, &mut lu, ld, n, done, &mut pivots, |_| 1).unwrap();
            assert_ne!(&lu[..n * ld], early, "not by faer");
            let (lu, carried) = lu.split_at(n * ld);
            let factors = Factors { lu, ld, pivots: &pivots };
            let (mut x, mut y) = (carried[..n].to_vec(), (0..n).map(sum).collect::<Vec<_>>());
            let mut z: Vec<f64> = (0..n).map(|j| a[j * ld..j * ld + n].iter().sum()).collect();
            factors.back_substitute(&mut x);
            factors.solve(&mut y);
            factors.solve_transposed(&mut z);
            assert!(x.iter().chain(&y).chain(&z).all(|x| (x - 1.0).abs() < 1e-8), "{n}, {done} done");
        }
    }
}

#[cfg(feature = "faer")]
#[test]
fn what_the_own_path_refuses_is_refused_by_faer_too() {
    let n = by_faer::SMALLEST;
    let status = |by, a: &[f64]| factor_with(by, &mut a.to_vec(), n, n, &mut std::vec![0; n]).map_err(|e| e.status);
    let mut cases = Vec::new();
    for (row, column) in [(0, 0), (0, n - 1), (n - 1, 0), (n - 1, n - 1), (300, 17), (17, 300)] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut a = dominant(n, n);
            a[column * n + row] = bad;
            cases.push(a);
        }
    }
    // Singular in every rounding: two rows of which one is twice the other, an empty column, rank one, nothing.
    let mut twice: Vec<f64> = (0..n * n).map(|i| f64::from(u8::from(i % (n + 1) == 0))).collect();
    for (row, column, x) in [(5, 5, 1.0), (5, 400, 2.0), (400, 5, 2.0), (400, 400, 4.0)] {
        twice[column * n + row] = x;
    }
    let mut empty = random(n * n, 2);
    empty[77 * n..78 * n].fill(0.0);
    cases.extend([twice, empty, std::vec![1.0; n * n], std::vec![0.0; n * n]]);
    for (i, a) in cases.iter().enumerate() {
        for by in [Factorization::Own, Factorization::Faer { threads: 1 }, Factorization::Faer { threads: 2 }] {
            assert_eq!(status(by, a), Err(Status::Singular), "case {i}, {by:?}");
        }
    }
    assert!(status(Factorization::Faer { threads: 2 }, &dominant(n, n)).is_ok());
}
