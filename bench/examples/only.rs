//! LU only
use nekton::lu::factor;
use nekton_bench::lapack::Lapack;
use std::time::Instant;
fn main() {
    let lapack = Lapack::load().unwrap();
    for n in std::env::args().skip(1) {
        let n: usize = n.parse().unwrap();
        let ld = n + 8;
        let mut s = 1u64;
        let mut r = move || {
            s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (s >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut a: Vec<f64> = (0..ld * n).map(|_| r() / n as f64).collect();
        for i in 0..n {
            a[i * ld + i] += 1.0;
        }
        let mut x = a.clone();
        let mut p = vec![0.0; n];
        let mut ip = vec![0; n];
        let (mut best, mut other) = (f64::MAX, f64::MAX);
        let reps = ((4e5 / (n * n * n) as f64) as usize).max(1);
        for _ in 0..((8e9 / (n * n * n) as f64) as usize / reps).clamp(8, 3000) {
            let t = Instant::now();
            for _ in 0..reps {
                x.copy_from_slice(&a);
                factor(&mut x, ld, n, &mut p).unwrap();
            }
            best = best.min(t.elapsed().as_secs_f64());
            let t = Instant::now();
            for _ in 0..reps {
                x.copy_from_slice(&a);
                lapack.dgetrf(&mut x, ld, n, &mut ip);
            }
            other = other.min(t.elapsed().as_secs_f64());
        }
        println!(
            "{n:5} {:9.2} us {:9.2} us ratio {:.3}  {:.1} GF/s",
            best * 1e6 / reps as f64,
            other * 1e6 / reps as f64,
            best / other,
            2.0 / 3.0 * (n * n * n * reps) as f64 / best * 1e-9
        );
    }
}
