#![cfg_attr(not(feature = "std"), no_std)]
// Exported names.
#![allow(unsafe_code)]
//! The factorization of a matrix of order 48, as three links with 16 nodes have it, for `lu.c`.

use nekton::Real;

const N: usize = 48;
/// As in a simulation.
const LD: usize = N + 8;

#[cfg(not(feature = "std"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// Fills a matrix, factorizes it if `whole`; 0 if all is well.
fn lu<R: Real>(whole: bool) -> i32 {
    let (mut a, mut pivots) = ([R::zero(); LD * N], [R::Index::default(); N]);
    let mut s = 1u32;
    for (k, x) in a.iter_mut().enumerate() {
        s = s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let unit = if k % (LD + 1) == 0 { R::one() } else { R::zero() };
        *x = unit + R::count((s >> 16) as usize) / R::count(65_536 * N);
    }
    let a = core::hint::black_box(&mut a);
    let done = !whole || nekton::lu::factor(a, LD, N, &mut pivots).is_ok();
    core::hint::black_box((a, pivots));
    i32::from(!done)
}

/// Multiply-adds of the factorization.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_bench_multiply_adds() -> u32 {
    ((N - 1) * N * (2 * N - 1) / 6) as u32
}

/// In single precision.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_bench_lu32(whole: bool) -> i32 {
    lu::<f32>(whole)
}

/// In double precision.
#[unsafe(no_mangle)]
pub extern "C" fn nekton_bench_lu64(whole: bool) -> i32 {
    lu::<f64>(whole)
}
