//! Smooth closed curve through given points: a Gaussian-filtered periodic quintic spline, kept as a Fourier sum.
//!
//! Knots τ follow the chords divided by their local mean. The filtered spline is entire, so the trapezoid rule
//! converges on it faster than any power; the control points are chosen so that the *filtered* curve interpolates.
//! Both the spline's samples and the Gaussian live on a grid of 16 n points; as the Gaussian of width σ = π/n has
//! died away at the grid's Nyquist mode, convolving on the grid is exact to rounding.
//!
//! Tested by the tests at its end, `geometry/curve/tests.rs`, `geometry/curve/added_mass_test.rs`.

use crate::base::complex::{Complex, cabs};
use crate::base::memory::{add, at, axpy, buffers, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::geometry::curve::polyline::{after, boxes_len, point};

/// Samples per point.
const SAMPLES: usize = 16;
/// Modes |k| ≤ 3 n: at the last one the filter is below 10⁻¹⁹.
const MODES: usize = 3;
/// Samples to either side that the Gaussian reaches: 9 σ.
const WINDOW: isize = 72;
/// Knots continued beyond either end.
const EXTRA: usize = 6;

buffers! {
    /// Memory needed only while a curve is being built.
    pub(super) struct Memory(n: usize) {
        /// Knots τ₋₆ … τₙ₊₅.
        knots: R = n.saturating_add(2 * EXTRA),
        /// Collocation matrix by rows, each followed by the two right-hand sides.
        rows: R = n.saturating_mul(n.saturating_add(2)),
        /// Control points of the spline.
        control: R = n.saturating_mul(2),
        /// Roots of unity.
        roots: R = n.saturating_mul(2 * SAMPLES),
        /// Samples of the spline, later of the curve.
        samples: R = n.saturating_mul(2 * SAMPLES),
        /// Bounding boxes for the test of self-intersection.
        boxes: R = boxes_len(n.saturating_mul(SAMPLES)),
    }
}

/// The point at or before sample `i` of the grid.
pub(super) fn point_before<R: Real>(knots: &[R], n: usize, i: usize) -> usize {
    let t = R::TAU * R::count(i) / R::count(samples(n));
    part(knots, EXTRA, n).partition_point(|knot| *knot <= t).saturating_sub(1)
}

/// Parameter of point `k`.
#[cfg(feature = "alloc")]
pub(super) fn knot<R: Real>(knots: &[R], k: usize) -> R {
    at(knots, k.saturating_add(EXTRA))
}

/// Number of samples on the grid.
pub(super) const fn samples(n: usize) -> usize {
    n.saturating_mul(SAMPLES)
}

/// Reals for the coefficients of a curve through `n` points.
pub(super) const fn coefficients_len(n: usize) -> usize {
    n.saturating_mul(2 * MODES).saturating_add(1).saturating_mul(2)
}

/// Writes the knots, continued periodically.
fn write_knots<R: Real>(p: impl Fn(usize) -> Complex<R>, n: usize, knots: &mut [R]) {
    let chord = |k: usize| cabs(p(after(k, n)) - p(k));
    let mut sum = R::zero();
    for k in 0..n {
        put(knots, k + EXTRA, sum);
        // Geometric mean over the neighbours, Gaussian weights two points wide.
        let (mut mean, mut total) = (R::zero(), R::zero());
        for offset in -12_isize..=12 {
            let x = R::lit(offset as f64 / 2.0);
            let weight = (-x * x * R::HALF).exp();
            mean += weight * chord(cyclic(k as isize + offset, n)).ln();
            total += weight;
        }
        sum += chord(k) / (mean / total).exp();
    }
    for k in 0..n {
        put(knots, k + EXTRA, at(knots, k + EXTRA) * R::TAU / sum);
    }
    for j in 0..EXTRA {
        // A shift by n knots is a turn by 2π; for few points several turns.
        let (low, high) = (EXTRA - 1 - j, n + EXTRA + j);
        put(knots, high, at(knots, high - n) + R::TAU);
        put(knots, low, at(knots, low + n) - R::TAU);
    }
}

fn cyclic(i: isize, n: usize) -> usize {
    i.checked_rem_euclid(n as isize).unwrap_or(0) as usize
}

/// The six quintic B-splines that do not vanish at τ in [0, 2π), with the knots of their centres.
fn basis<R: Real>(knots: &[R], n: usize, tau: R) -> impl Iterator<Item = (usize, R)> {
    let i = part(knots, EXTRA, n).partition_point(|knot| *knot <= tau).saturating_sub(1);
    let left = |j: usize| tau - at(knots, i + EXTRA + 1 - j);
    let right = |j: usize| at(knots, i + EXTRA + j) - tau;
    let mut values = [R::one(), R::zero(), R::zero(), R::zero(), R::zero(), R::zero()];
    for degree in 1..=5 {
        let mut saved = R::zero();
        for r in 0..degree {
            let share = at(&values, r) / (right(r + 1) + left(degree - r));
            put(&mut values, r, saved + right(r + 1) * share);
            saved = left(degree - r) * share;
        }
        put(&mut values, degree, saved);
    }
    values.into_iter().enumerate().map(move |(q, value)| (cyclic(i as isize + q as isize - 2, n), value))
}

/// Gaussian elimination with partial pivoting on rows of `n` coefficients and two right-hand sides.
fn solve<R: Real>(rows: &mut [R], n: usize, solution: &mut [R]) -> Result<()> {
    let width = n.saturating_add(2);
    for k in 0..n {
        let (head, tail) = rows.split_at_mut_checked((k + 1) * width).ok_or(Status::Internal)?;
        let pivot = part_mut(head, k * width, width);
        let (mut best, mut size) = (None, at(pivot, k).abs());
        for (i, row) in tail.chunks_exact(width.max(1)).enumerate() {
            if at(row, k).abs() > size {
                (best, size) = (Some(i), at(row, k).abs());
            }
        }
        if let Some(i) = best {
            for (a, b) in pivot.iter_mut().zip(part_mut(tail, i * width, width)) {
                core::mem::swap(a, b);
            }
        }
        let lead = at(pivot, k);
        if lead == R::zero() || !lead.is_finite() {
            return Err(Status::Singular.into());
        }
        for row in tail.chunks_exact_mut(width.max(1)) {
            let factor = at(row, k) / lead;
            // Splines are local: most rows have nothing here.
            if factor == R::zero() {
                continue;
            }
            axpy(part_mut(row, k, width - k), -factor, part(pivot, k, width - k));
        }
    }
    for k in (0..n).rev() {
        let row = part(rows, k * width, width);
        for side in 0..2 {
            let known = (k + 1..n).fold(R::zero(), |sum, j| sum + at(row, j) * at(solution, 2 * j + side));
            put(solution, 2 * k + side, (at(row, n + side) - known) / at(row, k));
        }
    }
    Ok(())
}

/// Coefficients of the filtered spline, from mode −`down` + 1 … up.
pub(super) struct Modes {
    /// Number of modes below mode 1.
    pub down: usize,
    /// Number of modes.
    pub count: usize,
}

/// Writes the Fourier coefficients of the curve through `n` points, in the order given. Point 0 is at t = 0.
///
/// Cost: some 50 n² operations for the control points, 96 n² for the transform (with `fft` n log n). Errors: `Singular` should the spline not
/// be determined by its points.
pub(super) fn write<R: Real>(
    p: impl Fn(usize) -> Complex<R>,
    n: usize,
    memory: &mut Memory<'_, R>,
    store: &mut [R],
) -> Result<Modes> {
    let m = samples(n);
    write_knots(&p, n, memory.knots);
    let knots = &*memory.knots;
    let step = R::TAU / R::count(m);
    let width = n.saturating_add(2);
    memory.rows.fill(R::zero());
    let norm = R::one() / (R::lit(8.0) * R::TAU.sqrt());
    for (k, row) in memory.rows.chunks_exact_mut(width.max(1)).enumerate().take(n) {
        let here = at(knots, k + EXTRA) / step;
        let centre = here.round();
        for offset in -WINDOW..=WINDOW {
            let position = centre + R::lit(offset as f64);
            let x = (position - here) / R::lit(8.0);
            let gauss = norm * (-x * x * R::HALF).exp();
            let sample = cyclic(centre.to_f64() as isize + offset, m);
            for (j, value) in basis(knots, n, step * R::count(sample)) {
                add(row, j, gauss * value);
            }
        }
        put(row, n, p(k).re);
        put(row, n + 1, p(k).im);
    }
    solve(memory.rows, n, memory.control)?;
    for (i, pair) in memory.samples.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let value = basis(knots, n, step * R::count(i))
            .fold(Complex::default(), |sum: Complex<R>, (j, b)| sum + point(memory.control, j) * b);
        *pair = [value.re, value.im];
    }
    let top = MODES.saturating_mul(n);
    transform(memory.samples, memory.roots, top, store);
    let norm = R::one() / R::count(m);
    let mode = |store: &[R], j: usize| point(store, j);
    for j in 0..=2 * top {
        let x = R::PI * R::count(j.abs_diff(top)) / R::count(n);
        let c = mode(store, j) * (norm * (-x * x * R::HALF).exp());
        put(store, 2 * j, c.re);
        put(store, 2 * j + 1, c.im);
    }
    let size = (0..=2 * top).fold(R::zero(), |s, j| s.max(cabs(mode(store, j))));
    let seen = |k: usize| cabs(mode(store, top - k)).max(cabs(mode(store, top + k))) > size * R::EPSILON / R::lit(20.0);
    let last = (2..=top).rev().find(|&k| seen(k)).unwrap_or(1);
    for j in 0..2 * (2 * last + 1) {
        let value = at(store, j + 2 * (top - last));
        put(store, j, value);
    }
    Ok(Modes { down: last + 1, count: 2 * last + 1 })
}

/// Σᵢ fᵢ e^(−2πi k i/m) for k = −top … top, of the m samples f; O(m · top).
#[cfg(not(feature = "fft"))]
fn transform<R: Real>(samples: &[R], roots: &mut [R], top: usize, modes: &mut [R]) {
    let m = samples.len() / 2;
    let step = R::TAU / R::count(m);
    for (i, pair) in roots.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let (s, c) = (step * R::count(i)).sin_cos();
        *pair = [c, -s];
    }
    for (j, pair) in modes.as_chunks_mut::<2>().0.iter_mut().take(2 * top + 1).enumerate() {
        let stride = if j >= top { j - top } else { m + j - top };
        let mut turn = 0;
        let mut sum = Complex::default();
        for &[re, im] in samples.as_chunks::<2>().0 {
            sum += crate::base::complex::complex(re, im) * point(roots, turn);
            turn += stride;
            if turn >= m {
                turn -= m;
            }
        }
        *pair = [sum.re, sum.im];
    }
}

/// The same by the fast transform; allocates its own memory.
#[cfg(feature = "fft")]
fn transform<R: Real>(samples: &[R], _roots: &mut [R], top: usize, modes: &mut [R]) {
    let pairs = samples.as_chunks::<2>().0.iter();
    let mut data: alloc::vec::Vec<_> =
        pairs.map(|&[re, im]| rustfft::num_complex::Complex { re: re.to_f64(), im: im.to_f64() }).collect();
    let m = data.len();
    rustfft::FftPlanner::new().plan_fft_forward(m).process(&mut data);
    for (j, pair) in modes.as_chunks_mut::<2>().0.iter_mut().take(2 * top + 1).enumerate() {
        if let Some(c) = data.get(if j >= top { j - top } else { m + j - top }) {
            *pair = [R::lit(c.re), R::lit(c.im)];
        }
    }
}

#[cfg(test)]
#[allow(clippy::indexing_slicing)]
mod tests {
    extern crate std;
    use super::*;
    use crate::base::complex::complex;
    use crate::geometry::curve::Fourier;
    use std::vec;
    use std::vec::Vec;

    fn memory_of(n: usize) -> Vec<f64> {
        vec![f64::NAN; Memory::<f64>::len(&n).unwrap()]
    }

    #[test]
    fn splines_are_a_partition_of_unity() {
        for n in [3, 4, 7, 20] {
            let p = |k: usize| {
                crate::base::complex::cis(f64::TAU * k as f64 / n as f64 + 0.4 * (k as f64).sin() / n as f64)
            };
            let mut knots = vec![f64::NAN; n + 2 * EXTRA];
            write_knots(p, n, &mut knots);
            assert!(knots.windows(2).all(|w| w[0] < w[1]), "{knots:?}");
            for i in 0..200 {
                let values: Vec<_> = basis(&knots, n, f64::TAU * i as f64 / 200.0).collect();
                let sum: f64 = values.iter().map(|(_, v)| v).sum();
                assert!((sum - 1.0).abs() < 4e-15 && values.iter().all(|(m, v)| *m < n && *v >= 0.0));
            }
        }
    }

    #[test]
    fn curve_takes_its_points_at_the_knots_even_if_unevenly_spaced() {
        for (n, stretch) in [(3, 0.0), (5, 0.3), (24, 0.0), (24, 0.6), (61, 0.5)] {
            let p = |k: usize| {
                let t = f64::TAU * k as f64 / n as f64;
                let t = t + stretch * (3.0 * t).sin() / 3.0;
                complex(5.0 + (1.0 + 0.2 * (2.0 * t).cos()) * t.cos(), 0.6 * t.sin())
            };
            let mut slab = memory_of(n);
            let mut memory = Memory::take(&n, &mut &mut slab[..]).unwrap();
            let mut store = vec![f64::NAN; coefficients_len(n)];
            let modes = write(p, n, &mut memory, &mut store).unwrap();
            let coefficients = part(&store, 0, 2 * modes.count);
            let curve = Fourier { centre: 1.0, stride: 1.0, down: modes.down, coefficients };
            let worst = (0..n).map(|k| cabs(curve.jet_real(at(memory.knots, k + EXTRA))[0] - p(k))).fold(0.0, f64::max);
            assert!(worst < 1e-14 * 6.2, "{n} {stretch}: {worst:e}");
        }
    }

    #[test]
    fn a_sample_belongs_to_the_point_at_or_before_it() {
        for n in [3, 8, 50] {
            let mut knots = vec![f64::NAN; n + 2 * EXTRA];
            write_knots(|k| crate::base::complex::cis(f64::TAU * k as f64 / n as f64), n, &mut knots);
            // Not at the knots themselves, where rounding decides.
            for i in (0..samples(n)).filter(|i| i % SAMPLES != 0) {
                assert_eq!(point_before(&knots, n, i), i / SAMPLES, "{n} {i}");
            }
        }
    }

    #[test]
    fn elimination_exchanges_rows_where_it_must() {
        // Rows that are those of a dominant matrix, turned round: without exchanges pivots are small or 0.
        for n in [2, 3, 8] {
            let entry = |i: usize, j: usize| {
                let smooth = ((3 * i + 5 * j) as f64).sin();
                if i + j + 1 == n {
                    10.0
                } else if i == j {
                    0.0
                } else {
                    smooth
                }
            };
            let x = |j: usize| [1.0 + j as f64, -2.0 * j as f64];
            let side = |i: usize, s: usize| (0..n).map(|j| entry(i, j) * x(j)[s]).sum();
            let row = |i: usize| (0..n).map(|j| entry(i, j)).chain([side(i, 0), side(i, 1)]).collect::<Vec<f64>>();
            let (mut rows, mut solution) = ((0..n).flat_map(row).collect::<Vec<_>>(), vec![f64::NAN; 2 * n]);
            solve(&mut rows, n, &mut solution).unwrap();
            for j in 0..n {
                assert!((0..2).all(|s| (solution[2 * j + s] - x(j)[s]).abs() < 1e-13 * n as f64), "{n}: {solution:?}");
            }
        }
        let zeros = solve(&mut [0.0_f64; 8], 2, &mut [0.0; 4]).unwrap_err();
        assert_eq!(zeros.status, Status::Singular);
    }

    #[test]
    fn transform_is_the_definition() {
        let (m, top) = (48, 9);
        let samples: Vec<f64> = (0..2 * m).map(|i| ((i * i) as f64 * 0.37).sin()).collect();
        let (mut roots, mut modes) = (vec![f64::NAN; 2 * m], vec![f64::NAN; 2 * (2 * top + 1)]);
        transform(&samples, &mut roots, top, &mut modes);
        for j in 0..=2 * top {
            let k = j as f64 - top as f64;
            let sum = (0..m).fold(Complex::default(), |sum: Complex<f64>, i| {
                sum + point(&samples, i) * crate::base::complex::cis(-f64::TAU * k * i as f64 / m as f64)
            });
            assert!(cabs(sum - point(&modes, j)) < 1e-13 * m as f64);
        }
    }
}
