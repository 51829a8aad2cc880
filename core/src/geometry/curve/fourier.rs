//! Outline given by a finite Fourier sum: an entire function of the parameter.
//!
//! Tested by `geometry/curve/tests.rs`.

use crate::base::complex::{Complex, cexp, cexpm1, cis, complex, perp};
use crate::base::lanes::{LANES, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::scalar::Real;

/// γ(t) = Σ cⱼ e^(i kⱼ t), modes kⱼ = centre + stride (j − down) for j = 0, 1, ….
#[derive(Clone, Copy, Debug)]
pub struct Fourier<'a, R> {
    pub(super) centre: R,
    pub(super) stride: R,
    /// Number of modes below the centre.
    pub(super) down: usize,
    /// Real and imaginary parts in turn.
    pub(super) coefficients: &'a [R],
}

impl<'a, R: Real> Fourier<'a, R> {
    /// Mode numbers and coefficients.
    pub fn modes(&self) -> impl Iterator<Item = (R, Complex<R>)> + 'a {
        let (centre, stride, down) = (self.centre, self.stride, R::count(self.down));
        let pairs = self.coefficients.as_chunks::<2>().0.iter().enumerate();
        pairs.map(move |(j, &[re, im])| (centre + stride * (R::count(j) - down), complex(re, im)))
    }

    /// Coefficients from the centre upwards, and from below the centre downwards. Powers then start at the largest
    /// coefficients and lose accuracy only towards the small ones.
    fn branches(&self) -> [Branch<'a, R>; 2] {
        let pairs = self.coefficients.as_chunks::<2>().0;
        let (low, high) = pairs.split_at_checked(self.down).unwrap_or((&[], &[]));
        let (centre, stride) = (self.centre, self.stride);
        [
            Branch { start: centre, stride, coefficients: high, down: false },
            Branch { start: centre - stride, stride: -stride, coefficients: low, down: true },
        ]
    }

    /// Sums with the powers of `z(k) = e^(ikt)`.
    fn sum(&self, z: impl Fn(R) -> Complex<R>) -> [Complex<R>; 3] {
        let mut jet = [Complex::default(); 3];
        for branch in self.branches() {
            let powers = [z(branch.start), z(branch.stride), z(branch.stride * R::count(LANES))];
            let sums = computed(branch, Powers { branch, powers });
            for (total, part) in jet.iter_mut().zip(sums) {
                *total += part;
            }
        }
        let [value, first, second] = jet;
        [value, perp(first), -second]
    }

    pub(super) fn jet(&self, t: Complex<R>) -> [Complex<R>; 3] {
        self.sum(|k| cexp(perp(t * k)))
    }

    pub(super) fn jet_real(&self, t: R) -> [Complex<R>; 3] {
        self.sum(|k| cis(t * k))
    }

    /// γ(t + u) − γ(t) and γ′(t + u), in one pass.
    pub(super) fn change(&self, t: R, u: Complex<R>) -> [Complex<R>; 2] {
        let mut sums = [Complex::default(); 2];
        for branch in self.branches() {
            let (start, stride) = (branch.start, branch.stride);
            let long = stride * R::count(LANES);
            let powers = [cis(t * start), cis(t * stride), cis(t * long)];
            let changes = [start, stride, long].map(|k| cexpm1(perp(u * k)));
            for (total, part) in sums.iter_mut().zip(computed(branch, Changes { branch, powers, changes })) {
                *total += part;
            }
        }
        let [change, slope] = sums;
        [change, perp(slope)]
    }
}

/// Coefficients worth the machine's own vectors.
const LONG: usize = 2 * LANES;

/// Runs a task on the machine's vectors if that pays. Where there are none it is a loop of calls: small, and the same digits.
#[inline(never)]
fn computed<R: Real, T: Task>(branch: Branch<'_, R>, task: T) -> T::Output {
    if cfg!(target_arch = "x86_64") && branch.coefficients.len() < LONG {
        task.run()
    } else {
        Machine::here().run(task)
    }
}

/// Modes from `start` on, in steps of `stride`.
#[derive(Clone, Copy)]
struct Branch<'a, R> {
    start: R,
    stride: R,
    coefficients: &'a [[R; 2]],
    /// The coefficients stand in the order of falling powers.
    down: bool,
}

impl<'a, R: Real> Branch<'a, R> {
    /// The coefficients in vectors, in the order of the powers, then what fills none.
    #[inline(always)]
    fn parts(self) -> (impl Iterator<Item = [[R; LANES]; 2]> + 'a, impl Iterator<Item = Complex<R>> + 'a) {
        let (up, down) = if self.down { (&[][..], self.coefficients) } else { (self.coefficients, &[][..]) };
        let ((up, after), (before, down)) = (up.as_chunks::<LANES>(), down.as_rchunks::<LANES>());
        let lane = |c: &[[R; 2]; LANES], back: bool| {
            let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
            for ((x, y), [a, b]) in re.iter_mut().zip(im.iter_mut()).zip(c) {
                (*x, *y) = (*a, *b);
            }
            if back {
                re.reverse();
                im.reverse();
            }
            [re, im]
        };
        let chunks = up.iter().map(move |c| lane(c, false)).chain(down.iter().rev().map(move |c| lane(c, true)));
        (chunks, after.iter().chain(before.iter().rev()).map(|&[re, im]| complex(re, im)))
    }
}

type Vector<R> = [R; LANES];

/// Lane by lane.
#[inline(always)]
fn by<R: Real>(a: Vector<R>, b: Vector<R>, f: impl Fn(R, R) -> R) -> Vector<R> {
    let mut out = a;
    for (o, b) in out.iter_mut().zip(b) {
        *o = f(*o, b);
    }
    out
}

#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn plus<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    by(a, b, |a, b| a + b)
}

#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn times<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    by(a, b, |a, b| a * b)
}

/// Product of complex numbers.
#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn product<R: Real>([a, b]: [Vector<R>; 2], [x, y]: [Vector<R>; 2]) -> [Vector<R>; 2] {
    [by(times(a, x), times(b, y), |p, q| p - q), plus(times(a, y), times(b, x))]
}

#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn all<R: Real>(z: Complex<R>) -> [Vector<R>; 2] {
    [[z.re; LANES], [z.im; LANES]]
}

#[inline(always)]
fn first_of<R: Real>([re, im]: [Vector<R>; 2]) -> Complex<R> {
    let ([re, ..], [im, ..]) = (re, im);
    complex(re, im)
}

/// Lane by lane, the first value and what comes of it again and again.
#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn spread<R: Real>(first: Complex<R>, next: impl Fn(Complex<R>) -> Complex<R>) -> [[R; LANES]; 2] {
    let (mut re, mut im, mut z) = ([R::zero(); LANES], [R::zero(); LANES], first);
    for (x, y) in re.iter_mut().zip(im.iter_mut()) {
        (*x, *y) = (z.re, z.im);
        z = next(z);
    }
    [re, im]
}

/// Σ c zᵏ, Σ k c zᵏ, Σ k² c zᵏ of one branch, given the powers `start`, `stride` and `LANES` times it.
struct Powers<'a, R> {
    branch: Branch<'a, R>,
    powers: [Complex<R>; 3],
}

impl<R: Real> Task for Powers<'_, R> {
    type Output = [Complex<R>; 3];
    #[inline(always)]
    fn run(self) -> [Complex<R>; 3] {
        let Powers { branch, powers: [first, ratio, leap] } = self;
        let (chunks, rest) = branch.parts();
        let mut power = spread(first, |z| z * ratio);
        let leap = all(leap);
        let [mut k, _] = spread(complex(branch.start, R::zero()), |k| complex(k.re + branch.stride, R::zero()));
        let far = [branch.stride * R::count(LANES); LANES];
        let [mut value, mut slope, mut bend] = [[[R::zero(); LANES]; 2]; 3];
        for c in chunks {
            let [u, v] = product(c, power);
            let first = [times(k, u), times(k, v)];
            let second = first.map(|x| times(k, x));
            value = [plus(value[0], u), plus(value[1], v)];
            slope = [plus(slope[0], first[0]), plus(slope[1], first[1])];
            bend = [plus(bend[0], second[0]), plus(bend[1], second[1])];
            (power, k) = (product(power, leap), plus(k, far));
        }
        let mut out = [value, slope, bend].map(|[a, b]| complex(sum_of(a), sum_of(b)));
        let ([mut k, ..], mut power) = (k, first_of(power));
        for c in rest {
            let term = c * power;
            for (sum, factor) in out.iter_mut().zip([R::one(), k, k * k]) {
                *sum += term * factor;
            }
            k += branch.stride;
            power *= ratio;
        }
        out
    }
}

/// Σ c zᵏ (e^(iku) − 1) and Σ k c zᵏ e^(iku) of one branch: the same powers, and the changes of their modes. e^(iku) − 1 goes from mode to
/// mode, so that its relative accuracy in u is kept.
struct Changes<'a, R> {
    branch: Branch<'a, R>,
    powers: [Complex<R>; 3],
    changes: [Complex<R>; 3],
}

impl<R: Real> Task for Changes<'_, R> {
    type Output = [Complex<R>; 2];
    #[inline(always)]
    fn run(self) -> [Complex<R>; 2] {
        let Changes { branch, powers: [first, ratio, leap], changes: [change, step, far] } = self;
        let (chunks, rest) = branch.parts();
        let mut power = spread(first, |z| z * ratio);
        let mut moved = spread(change, |z| z * step + z + step);
        let (leap, far) = (all(leap), all(far));
        let [mut k, _] = spread(complex(branch.start, R::zero()), |k| complex(k.re + branch.stride, R::zero()));
        let along = [branch.stride * R::count(LANES); LANES];
        let [mut sum, mut slope] = [[[R::zero(); LANES]; 2]; 2];
        for c in chunks {
            let [x, y] = product(c, power);
            let [u, v] = product([x, y], moved);
            sum = [plus(sum[0], u), plus(sum[1], v)];
            slope = [plus(slope[0], times(k, plus(x, u))), plus(slope[1], times(k, plus(y, v)))];
            (power, k) = (product(power, leap), plus(k, along));
            let [s, t] = product(moved, far);
            moved = [plus(plus(s, moved[0]), far[0]), plus(plus(t, moved[1]), far[1])];
        }
        let [mut sum, mut slope] = [sum, slope].map(|[a, b]| complex(sum_of(a), sum_of(b)));
        let ([mut k, ..], mut power, mut change) = (k, first_of(power), first_of(moved));
        for c in rest {
            let term = c * power;
            let moved = term * change;
            sum += moved;
            slope += (term + moved) * k;
            k += branch.stride;
            power *= ratio;
            change = change * step + change + step;
        }
        [sum, slope]
    }
}
