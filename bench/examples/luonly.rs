use nekton_bench::rows::diagonal_dominant;
fn main() {
    let order: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let calls: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let ld = order + 8;
    let a = diagonal_dominant(order, ld);
    let mut big = vec![0.0; a.len() + 16]; let skip = big.as_ptr().align_offset(64); let x = &mut big[skip..][..a.len()];
    let mut q = vec![0.0; order];
    for _ in 0..calls { x.copy_from_slice(&a); nekton::lu::factor(x, ld, order, &mut q).unwrap(); }
}
