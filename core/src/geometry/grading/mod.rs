//! Placement of nodes along an outline: an explicit map t → s that crowds equidistant s at chosen parameters.
//!
//! A *ladder* stands at a parameter t and resolves structure down to the scale β there: rungs at β, 3β, 9β, …
//! below `top`. Every rung adds the primitive of a Poisson kernel,
//!
//! s(t) = [t + Σ w S(t − tₘ; bₘ)] / (1 + Σ w),  S(v; b) = v − 2 arg(1 − e^(−b + iv)),
//!
//! an increasing function that is analytic in |Im t| < min b, so that the trapezoid rule in s keeps its spectral
//! accuracy. Corners and bends bring permanent ladders; a ladder at a contact is one more entry of the list.
//!
//! Tested by the tests at its end, `geometry/curve/tests.rs`.

#[cfg(feature = "derivatives")]
use crate::base::complex::{Complex, complex, csin_cos};
use crate::base::memory::{at, part, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};

mod lanes;

pub(crate) use lanes::{LANES, Offset, walk};

/// Reals of a rung: place p, sin(p/2), weight, e^(−b/2), sinh(b/2), sinh(b)/2, cos(p/2), of the scale b.
pub(crate) const RUNG: usize = 7;
/// Reals before the rungs: weight of the plain parameter, value of the map at t = 0.
const HEAD: usize = 2;
/// Full weight of a rung.
const WEIGHT: f64 = 0.5;
/// Scale at which a permanent ladder has faded out, at most.
pub const TOP: f64 = 1.5;

/// A request for nodes around the parameter `t`, down to the scale `beta` (both in the parameter).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ladder<R> {
    /// Where.
    pub t: R,
    /// Smallest scale to resolve.
    pub beta: R,
    /// Scale at which the ladder has faded out.
    pub top: R,
}

impl<R: Real> Ladder<R> {
    /// Scales and raw weights of the rungs. The last one fades with its distance from `top`, so that the map
    /// changes continuously when a rung enters or leaves.
    fn rungs(self) -> impl Iterator<Item = (R, R)> {
        // Below this scale neighbouring nodes would not be distinct numbers.
        let beta = self.beta.max(R::EPSILON * R::lit(128.0));
        let (three, top) = (R::lit(3.0), self.top);
        core::iter::successors(Some(beta), move |b| Some(*b * three)).take_while(move |b| *b < top).enumerate().map(
            move |(m, b)| {
                let first = if m == 0 { R::lit(1.5) } else { R::one() };
                (b, R::lit(WEIGHT) * first * R::one().min((top / b).ln() / three.ln()))
            },
        )
    }

    /// Number of rungs.
    pub fn count(self) -> usize {
        self.rungs().count()
    }
}

/// Number of reals that a grading of this many rungs occupies; `None` on overflow.
pub fn grading_len(rungs: usize) -> Option<usize> {
    rungs.checked_mul(RUNG)?.checked_add(HEAD)
}

/// Writes the grading of these ladders into `store` and returns its number of rungs.
///
/// Rungs that ask for the same thing share one weight; the result does not depend on the ladders' order
/// (up to rounding). Cost: quadratic in the number of rungs. Errors: `MemoryTooSmall`.
pub fn write_grading<R: Real>(ladders: impl Iterator<Item = Ladder<R>>, store: &mut [R]) -> Result<usize> {
    match write_fitting(ladders, store) {
        Ok((count, true)) => Ok(count),
        _ => Err(Status::MemoryTooSmall.into()),
    }
}

/// [`write_grading`] of as many rungs as there is memory for; also returns whether that was all.
pub(crate) fn write_fitting<R: Real>(
    ladders: impl Iterator<Item = Ladder<R>>,
    store: &mut [R],
) -> Result<(usize, bool)> {
    let (head, body) = store.split_at_mut_checked(HEAD).ok_or(Status::MemoryTooSmall)?;
    let mut free = body.chunks_exact_mut(RUNG);
    let (mut count, mut all) = (0, true);
    for ladder in ladders {
        for (b, weight) in ladder.rungs() {
            let Some([t, scale, _, raw, log, ..]) = free.next() else {
                all = false;
                break;
            };
            (*t, *scale, *raw, *log) = (ladder.t, b, weight, b.ln());
            count += 1;
        }
    }
    let three = R::lit(3.0);
    let mut total = R::one();
    for i in 0..count {
        let Some(&[t, b, _, raw, log, ..]) = body.chunks_exact(RUNG).nth(i) else {
            continue;
        };
        let mut crowd = R::one();
        for (j, other) in body.chunks_exact(RUNG).take(count).enumerate() {
            let &[t2, b2, _, raw2, log2, ..] = other else {
                continue;
            };
            let near = R::one() - (log - log2).abs() / three.ln();
            if j != i && near > R::zero() {
                let d = R::TWO * ((t - t2) * R::HALF).sin() / b.max(b2);
                crowd += R::one().min(raw2 / R::lit(WEIGHT)) * near / (R::one() + d * d);
            }
        }
        total += raw / crowd;
        put(body, i * RUNG + 2, raw / crowd);
    }
    for rung in body.chunks_exact_mut(RUNG).take(count) {
        if let [t, b, weight, decay, sh, half_sinh, cos] = rung {
            let half = *b * R::HALF;
            *weight /= total;
            (*decay, *sh, *half_sinh) = ((-half).exp(), half.sinh(), half.sinh() * half.cosh());
            (*b, *cos) = (*t * R::HALF).sin_cos();
        }
    }
    if let [plain, origin] = head {
        *plain = R::one() / total;
        *origin = R::zero();
    }
    let origin = Grading::read(store, count).jet(R::zero())[0];
    put(store, 1, origin);
    Ok((count, all))
}

/// The map t → s of an outline, s(0) = 0, s(t + 2π) = s(t) + 2π.
#[derive(Clone, Copy, Debug)]
pub struct Grading<'a, R> {
    plain: R,
    origin: R,
    rungs: &'a [R],
}

impl<'a, R: Real> Grading<'a, R> {
    /// The identity.
    pub fn uniform() -> Self {
        Grading { plain: R::one(), origin: R::zero(), rungs: &[] }
    }

    /// The grading that [`write_grading`] left in `store`.
    pub fn read(store: &'a [R], rungs: usize) -> Self {
        let len = rungs.saturating_mul(RUNG);
        Grading { plain: at(store, 0), origin: at(store, 1), rungs: part(store, HEAD, len) }
    }

    /// Weight of the plain parameter: the least slope the map can have.
    pub fn plain(&self) -> R {
        self.plain
    }

    /// Number of rungs.
    pub const fn rungs(&self) -> usize {
        self.rungs.len() / RUNG
    }

    fn each(&self) -> impl Iterator<Item = [R; RUNG]> + '_ {
        self.rungs.as_chunks::<RUNG>().0.iter().copied()
    }

    /// s, s′, s″ at a real parameter. Cost: one sine and one arc tangent per rung.
    pub fn jet(&self, t: R) -> [R; 3] {
        let mut sum = [self.plain * t, self.plain, R::zero()];
        for [place, _, weight, decay, sh, half_sinh, _] in self.each() {
            let v = t - place;
            let (s, c) = (v * R::HALF).sin_cos();
            let m = sh * sh + s * s;
            let slope = weight * half_sinh / m;
            sum[0] += weight * (v + R::TWO * (decay * s * c).atan2(sh + decay * s * s));
            sum[1] += slope;
            sum[2] -= slope * s * c / m;
        }
        sum[0] -= self.origin;
        sum
    }

    /// s′ and s″ at the complex parameter t + u.
    #[cfg(feature = "derivatives")]
    pub(crate) fn slopes(&self, t: R, u: Complex<R>) -> [Complex<R>; 2] {
        let mut sum = [complex(self.plain, R::zero()), Complex::default()];
        for [place, _, weight, _, sh, half_sinh, _] in self.each() {
            let v = t - place;
            let (s, c) = csin_cos((u + (v - R::TAU * (v / R::TAU).round())) * R::HALF);
            let m = s * s + sh * sh;
            let slope = complex(weight * half_sinh, R::zero()) / m;
            sum = [sum[0] + slope, sum[1] - slope * s * c / m];
        }
        sum
    }

    /// The t in [0, 2π] at which the map takes the value `s` in [0, 2π], starting from `guess`.
    ///
    /// Newton's method inside a shrinking bracket. The best iterate is kept, so a converged one is never moved
    /// again by rounding. Errors: `Internal` when the residual exceeds what rounding explains.
    pub fn inverse(&self, s: R, guess: R) -> Result<R> {
        let (mut low, mut high) = (R::zero(), R::TAU);
        let mut t = guess.max(low).min(high);
        let (mut best, mut residual, mut allowed) = (t, R::MAX, R::zero());
        let mut last = R::MAX;
        for _ in 0..160 {
            let [value, slope, _] = self.jet(t);
            let f = value - s;
            if f.abs() < residual {
                (best, residual) = (t, f.abs());
                allowed = R::EPSILON * (R::lit(450.0) + R::lit(9.0) * slope);
            }
            if f.abs() <= R::EPSILON * (R::TWO + slope * t * R::HALF) {
                break;
            }
            if f > R::zero() {
                high = t;
            } else {
                low = t;
            }
            let newton = t - f / slope;
            let middle = low + (high - low) * R::HALF;
            let slow = f.abs() > last * R::HALF;
            last = f.abs();
            let next = if newton > low && newton < high && !slow { newton } else { middle };
            if next == t || low >= high {
                break;
            }
            t = next;
        }
        if residual <= allowed {
            Ok(best)
        } else {
            Err(Error::new(Status::Internal).of("node residual", residual.to_f64()))
        }
    }

    /// Parameter of node `k` of `n`: s = 2πk/n. Errors: `OutOfRange` unless k < n, `Internal` as in
    /// [`inverse`](Self::inverse).
    #[cfg(test)]
    pub fn node(&self, k: usize, n: usize) -> Result<R> {
        if k >= n {
            return Err(Error::new(Status::OutOfRange).of("node", k as f64));
        }
        let s = R::TAU * R::count(k) / R::count(n);
        if k == 0 || self.rungs.is_empty() { Ok(s) } else { self.inverse(s, s) }
    }
}

#[cfg(test)]
#[allow(clippy::indexing_slicing)]
mod tests {
    extern crate std;
    use super::*;
    use crate::base::complex::{Complex, cabs, cis, complex, csin_cos};
    use std::vec;
    use std::vec::Vec;

    fn ladder(t: f64, beta: f64) -> Ladder<f64> {
        Ladder { t, beta, top: TOP }
    }

    fn store(ladders: &[Ladder<f64>]) -> (Vec<f64>, usize) {
        let rungs = ladders.iter().map(|l| l.count()).sum();
        let mut store = vec![f64::NAN; grading_len(rungs).unwrap()];
        assert_eq!(write_grading(ladders.iter().copied(), &mut store).unwrap(), rungs);
        (store, rungs)
    }

    const CASES: [&[Ladder<f64>]; 4] = [
        &[],
        &[Ladder { t: 0.0, beta: 1e-9, top: TOP }],
        &[Ladder { t: 1.0, beta: 0.1, top: TOP }, Ladder { t: 4.0, beta: 1e-4, top: 0.5 }],
        &[Ladder { t: 6.2, beta: 1e-3, top: TOP }, Ladder { t: 0.001, beta: 2e-3, top: TOP }],
    ];

    /// Difference and slope.
    fn jump(grading: &Grading<'_, f64>, t: f64, u: Complex<f64>) -> [Complex<f64>; 2] {
        let ((s, c), lanes) = (csin_cos(u * 0.5), |z: Complex<f64>| [[z.re], [z.im]]);
        let of = grading.difference(&Offset { t: [t], u: lanes(u), sin: lanes(s), cos: lanes(c) });
        of.map(|[[re], [im]]| complex(re, im))
    }

    #[test]
    fn map_gains_one_turn_per_turn_and_increases() {
        for ladders in CASES {
            let (data, rungs) = store(ladders);
            let grading = Grading::read(&data, rungs);
            assert_eq!(grading.jet(0.0)[0], 0.0);
            let mut last = -1.0;
            for k in 0..=1000 {
                let [s, slope, _] = grading.jet(f64::TAU * k as f64 / 1000.0);
                assert!(s > last && slope > 0.0);
                last = s;
            }
            assert!((last - f64::TAU).abs() < 1e-14 + 1e-15 * grading.jet(f64::TAU)[1], "{last}");
        }
    }

    #[test]
    fn derivatives_match_cauchys_formula_and_the_complex_slope() {
        for ladders in CASES {
            let (data, rungs) = store(ladders);
            let grading = Grading::read(&data, rungs);
            for k in 0..200 {
                let t = grading.node(k, 200).unwrap();
                let [_, slope, bend] = grading.jet(t);
                let radius = 0.02 / slope.max(1.0);
                let (mut first, mut second, n) = (Complex::default(), Complex::default(), 32);
                for j in 0..n {
                    let z = cis(f64::TAU * (j as f64 + 0.5) / n as f64);
                    let [difference, slope] = jump(&grading, t, z * radius);
                    first += difference / (z * radius * n as f64);
                    second += slope / (z * radius * n as f64);
                }
                let rounding = 1e-13 + 4e-15 / radius;
                assert!(cabs(first - slope) <= rounding * slope, "{t} {first} {slope}");
                assert!(cabs(second - bend) <= rounding * (bend.abs() + slope / radius), "{t} {second} {bend}");
                assert!(cabs(jump(&grading, t, Complex::default())[1] - slope) <= 1e-13 * slope);
            }
        }
    }

    #[test]
    fn difference_is_that_of_the_map_over_some_nodes_and_relative_at_small_offsets() {
        for ladders in CASES {
            let (data, rungs) = store(ladders);
            let grading = Grading::read(&data, rungs);
            for (i, j) in
                (0i32..60).flat_map(|i| (i - 4..=i + 4).map(move |j| (i, j))).filter(|(_, j)| (0..60).contains(j))
            {
                let (a, b) = (grading.node(i as usize, 60).unwrap(), grading.node(j as usize, 60).unwrap());
                let steep = grading.jet(a)[1] + grading.jet(b)[1];
                let direct = f64::TAU * f64::from(j - i) / 60.0;
                let [got, _] = jump(&grading, a, complex(b - a, 0.0));
                assert!(cabs(got - direct) < 1e-13 + 2e-15 * steep, "{i} {j} {got} {direct}");
                let u = cis(f64::from(j)) * (1e-9 / grading.jet(a)[1]);
                assert!(cabs(jump(&grading, a, u)[0] / u / grading.jet(a)[1] - 1.0) < 1e-8);
            }
        }
    }

    #[test]
    fn heights_are_imaginary_parts_of_the_map() {
        for ladders in CASES {
            let (data, rungs) = store(ladders);
            let grading = Grading::read(&data, rungs);
            let finest = ladders.iter().fold(1.0f64, |m, l| m.min(l.beta));
            for k in 0..60 {
                let t = grading.node(k, 60).unwrap();
                let u = complex(0.3, if k % 2 == 0 { 0.8 } else { -0.8 }) * finest;
                let (w, size) = (cis(t + u.re) * (-u.im).exp(), (-2.0 * u.im).exp());
                let [height] = grading.heights(&[[w.re], [w.im]], &[size]);
                let exact = jump(&grading, t, u)[0].im.abs();
                assert!((height - exact).abs() < 1e-13 * (1.0 + 1.0 / finest), "{t} {height} {exact}");
            }
        }
    }

    #[test]
    fn nodes_stay_distinct_numbers_however_fine_a_scale_is_asked_for() {
        for t in [0.0, 1.0, 6.2] {
            for beta in [1e-12, 1e-15, 1e-300, 0.0] {
                let (data, rungs) = store(&[ladder(t, beta)]);
                let grading = Grading::read(&data, rungs);
                assert!(rungs <= 30, "{beta:e}: {rungs} rungs");
                let nodes: Vec<f64> = (0..64).map(|k| grading.node(k, 64).unwrap()).collect();
                assert!(nodes.windows(2).all(|pair| pair[0] < pair[1]), "{t} {beta:e}: {nodes:?}");
            }
        }
    }

    #[test]
    fn ladders_that_coincide_share_their_weight() {
        let (one, rungs) = store(&[ladder(2.0, 0.01)]);
        let (two, _) = store(&[ladder(2.0, 0.01), ladder(2.0, 0.01)]);
        let (a, b) = (Grading::read(&one, rungs), Grading::read(&two, 2 * rungs));
        // Two requests weigh more than one, but far less than twice as much.
        let (single, double) = (a.jet(2.0)[1], b.jet(2.0)[1]);
        assert!(double > 0.9 * single && double < 1.25 * single, "{single} {double}");
    }

    #[test]
    fn order_of_ladders_does_not_matter() {
        let list = [ladder(0.3, 0.02), ladder(0.35, 0.01), ladder(3.0, 1e-4)];
        let mut other = list;
        other.reverse();
        let ((a, n), (b, _)) = (store(&list), store(&other));
        for k in 0..50 {
            let t = k as f64 / 8.0;
            assert!((Grading::read(&a, n).jet(t)[0] - Grading::read(&b, n).jet(t)[0]).abs() < 1e-14);
        }
    }

    #[test]
    fn map_is_continuous_where_a_rung_enters() {
        for beta in [TOP, TOP / 3.0, TOP / 27.0] {
            let values: Vec<_> = [1.0 - 1e-9, 1.0 + 1e-9]
                .iter()
                .map(|f| {
                    let (data, n) = store(&[ladder(1.0, beta * f), ladder(1.5, 0.2)]);
                    Grading::read(&data, n).jet(1.3)[0]
                })
                .collect();
            assert!((values[0] - values[1]).abs() < 1e-7, "{beta} {values:?}");
        }
    }

    #[test]
    fn too_little_memory_is_refused() {
        let mut short = [0.0; 7];
        assert_eq!(
            write_grading([ladder(0.0, 0.1)].into_iter(), &mut short).unwrap_err().status,
            Status::MemoryTooSmall
        );
    }
}
