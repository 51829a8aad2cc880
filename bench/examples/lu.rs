use nekton::lu::{Factors, factor};
use nekton_bench::{lapack::Lapack, timing::in_turns};
fn main() {
    let lapack = Lapack::load().unwrap();
    println!("{}", lapack.name);
    println!("    n     lu us  getrf us  ratio  GF/s | f32 ratio | copy | solve, solveT, back12/lu");
    let only: Vec<usize> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let sizes = if only.is_empty() { vec![6, 12, 24, 48, 64, 96, 100, 128, 192, 256, 512, 1024, 2048] } else { only };
    for n in sizes {
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
        let a32: Vec<f32> = a.iter().map(|x| *x as f32).collect();
        let (mut x, mut y, mut z) = (a.clone(), a.clone(), a.clone());
        let (mut x32, mut y32) = (a32.clone(), a32.clone());
        let mut p = vec![0.0; n];
        let mut p32 = vec![0f32; n];
        let (mut ip, mut ip2) = (vec![0; n], vec![0; n]);
        let mut lu = a.clone();
        let mut lup = vec![0.0; n];
        factor(&mut lu, ld, n, &mut lup).unwrap();
        let f = Factors { lu: &lu, ld, pivots: &lup };
        let mut b = vec![1.0; n];
        let mut c = vec![1.0; n];
        let mut d = vec![1.0; 12 * ld];
        let t = in_turns(
            if n > 600 { 7 } else { 25 },
            2e-3,
            &mut [
                &mut || {
                    x.copy_from_slice(&a);
                    factor(&mut x, ld, n, &mut p).unwrap();
                },
                &mut || {
                    y.copy_from_slice(&a);
                    lapack.dgetrf(&mut y, ld, n, &mut ip);
                },
                &mut || {
                    z.copy_from_slice(&a);
                    std::hint::black_box(&mut z);
                },
                &mut || {
                    x32.copy_from_slice(&a32);
                    factor(&mut x32, ld, n, &mut p32).unwrap();
                },
                &mut || {
                    y32.copy_from_slice(&a32);
                    lapack.sgetrf(&mut y32, ld, n, &mut ip2);
                },
                &mut || {
                    b.fill(1.0);
                    f.solve(&mut b);
                },
                &mut || {
                    c.fill(1.0);
                    f.solve_transposed(&mut c);
                },
                &mut || {
                    d.fill(1.0);
                    for c in d.chunks_exact_mut(ld) {
                        f.back_substitute(&mut c[..n]);
                    }
                },
            ],
        );
        let (l, g) = (t[0] - t[2], t[1] - t[2]);
        println!(
            "{n:5} {:9.2} {:9.2} {:6.3} {:5.1} | {:6.3} | {:.2} | {:.3} {:.3} {:.3}",
            l * 1e6,
            g * 1e6,
            l / g,
            2.0 / 3.0 * (n * n * n) as f64 / l * 1e-9,
            t[3] / t[4],
            t[2] * 1e6,
            t[5] / l,
            t[6] / l,
            t[7] / l
        );
    }
}
