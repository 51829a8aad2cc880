use nekton_bench::lapack::Lapack;
use nekton_bench::rows::{diagonal_dominant, rows};
use nekton_bench::timing::Turns;
fn main() {
    let lapack = Lapack::load().unwrap();
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words[0] == "lu" {
        for order in [64, 128, 256, 512, 1024] {
            let ld = order + 8;
            let a = diagonal_dominant(order, ld);
            let (mut big, mut y) = (vec![0.0; a.len() + 16], a.clone());
            let want: usize = words.get(1).map_or(0, |w| w.parse().unwrap());
            let skip = big.as_ptr().align_offset(64) + want;
            let x = &mut big[skip..][..a.len()];
            let mut p = vec![0; order];
            let mut q = vec![0.0; order];
            let (t, r) = Turns::THREAD.run(&mut [
                &mut || { x.copy_from_slice(&a); nekton::lu::factor(x, ld, order, &mut q).unwrap(); },
                &mut || { y.copy_from_slice(&a); lapack.dgetrf(&mut y, ld, order, &mut p); },
            ]);
            println!("lu {order}: {:.3} {:.3e} {:.3e}", r[0], t[0], t[1]);
        }
        return;
    }
    for row in rows().iter().filter(|r| words.iter().any(|w| r.name.contains(w.as_str()))) {
        println!("{}", row.line(&row.measure(&lapack)));
    }
}
