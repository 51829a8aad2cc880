//! The map t → s at many parameters at once: the rungs outside, the parameters in the inner loop, so that it vectorizes.
//!
#![allow(clippy::indexing_slicing)] // All indices run over arrays of the same constant length.

use super::Grading;
use crate::base::elementary::{atan2, catan, ln_1p, nearest, product, quotient, sin_cos, small_sine};
use crate::base::machine::{Machine, Task};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::base::status::Result;

/// Parameters that are treated together.
pub(crate) const LANES: usize = 16;

/// Value, first and second derivative at `L` parameters.
struct Jets<R, const L: usize> {
    value: [R; L],
    slope: [R; L],
    bend: [R; L],
}

/// An offset u from a node at t.
#[derive(Clone, Copy)]
pub(crate) struct Offset<R, const L: usize> {
    /// t.
    pub t: [R; L],
    /// u: real and imaginary part.
    pub u: [[R; L]; 2],
    /// sin(u/2).
    pub sin: [[R; L]; 2],
    /// cos(u/2).
    pub cos: [[R; L]; 2],
}

once! {
    /// Calls `visit` with t, ds/dt and d²s/dt² of `n` nodes in turn, s = 2πk/n.
    ///
    /// # Errors
    /// `Internal` if a node could not be placed to rounding.
    pub(crate) fn walk['a, 'b: 'a](grading: &'a Grading<'b, R>, n: usize, visit: &'a mut (dyn FnMut([R; 3]) + 'a)) -> Result<()> {
        let step = R::TAU / R::count(n.max(1));
        let mut last = [R::zero(), R::zero()];
        for first in (0..n).step_by(LANES) {
            let mut chunk =
                Chunk { t: [R::zero(); LANES], slope: [R::one(); LANES], bend: [R::zero(); LANES], settled: false };
            let s = core::array::from_fn(|i| step * R::count(first + i));
            Machine::here().run(Place { grading, s, start: last, out: &mut chunk });
            if first == 0 {
                chunk.t[0] = R::zero();
            }
            for i in 0..LANES.min(n - first) {
                if !chunk.settled {
                    let guess = if chunk.t[i].is_finite() { chunk.t[i] } else { s[i] };
                    chunk.t[i] = grading.inverse(s[i], guess)?;
                    [_, chunk.slope[i], chunk.bend[i]] = grading.jet(chunk.t[i]);
                }
                visit([chunk.t[i], chunk.slope[i], chunk.bend[i]]);
            }
            last = [s[LANES - 1], chunk.t[LANES - 1]];
        }
        Ok(())
    }
}

impl<R: Real> Grading<'_, R> {
    #[inline(always)]
    fn jets<const L: usize>(&self, t: &[R; L]) -> Jets<R, L> {
        let mut jets = Jets { value: *t, slope: [self.plain; L], bend: [R::zero(); L] };
        let (mut sin, mut cos) = (*t, *t);
        for i in 0..L {
            (sin[i], cos[i]) = sin_cos(t[i] * R::HALF);
            jets.value[i] = self.plain * t[i] - self.origin;
        }
        for [place, sin_p, weight, decay, sh, half_sinh, cos_p] in self.each() {
            for i in 0..L {
                let s = half_sine(t[i] - place, sin[i] * cos_p - cos[i] * sin_p);
                let c = cos[i] * cos_p + sin[i] * sin_p;
                let inverse = R::one() / (sh * sh + s * s);
                let slope = weight * half_sinh * inverse;
                let angle = atan2(decay * s * c, sh + decay * s * s);
                jets.value[i] += weight * (t[i] - place + R::TWO * angle);
                jets.slope[i] += slope;
                jets.bend[i] -= slope * s * c * inverse;
            }
        }
        jets
    }

    /// Slope and second derivative at one parameter.
    #[inline(always)]
    fn slope(&self, t: R) -> [R; 2] {
        let (sin, cos) = sin_cos(t * R::HALF);
        let mut sum = [self.plain, R::zero()];
        for [_, sin_p, weight, _, sh, half_sinh, cos_p] in self.each() {
            let (s, c) = (sin * cos_p - cos * sin_p, cos * cos_p + sin * sin_p);
            let inverse = R::one() / (sh * sh + s * s);
            let slope = weight * half_sinh * inverse;
            sum[0] += slope;
            sum[1] -= slope * s * c * inverse;
        }
        sum
    }

    /// |Im s| at complex parameters t, W = e^(it), of which |W|² is given too: Im S(v; b) = Im v + ln |1 − e^(iv − b)|
    /// − ln |1 − e^(−iv − b)|. Not finite at W = 0.
    #[inline(always)]
    pub(crate) fn heights<const L: usize>(&self, w: &[[R; L]; 2], square: &[R; L]) -> [R; L] {
        let mut height = *square;
        for height in &mut height {
            *height = -ln_1p(*height - R::one()) * R::HALF;
        }
        for [_, sin_p, weight, decay, _, _, cos_p] in self.each() {
            let (fall, half) = (decay * decay, weight * R::HALF);
            let (c, s) = (fall * (cos_p * cos_p - sin_p * sin_p), fall * R::TWO * sin_p * cos_p);
            for i in 0..L {
                let (x, y) = (w[0][i], w[1][i]);
                // W e^(−ip − b) − 1 and W − e^(ip − b)
                let (up, up_y) = (x * c + y * s - R::one(), y * c - x * s);
                let (down, down_y) = (x - c, y - s);
                let (up, down) = (up * up + up_y * up_y, down * down + down_y * down_y);
                height[i] += half * ln_1p((up * square[i] - down) / down);
            }
        }
        height.map(|h| h.abs())
    }

    /// s(t + u) − s(t) to relative accuracy in the complex offset u, and s′(t + u). |Im u| below the smallest rung's scale, and
    /// no rung crossed by more than half its turn: u spans a few nodes.
    ///
    /// S(v; b) = 2 atan(coth(b/2) tan(v/2)), so a difference is one arc tangent of a quotient without cancellation.
    #[inline(always)]
    pub(crate) fn difference<const L: usize>(&self, o: &Offset<R, L>) -> [[[R; L]; 2]; 2] {
        let mut difference = o.u;
        let mut slope = [[self.plain; L], [R::zero(); L]];
        let (mut sin, mut cos) = (o.t, o.t);
        for i in 0..L {
            (sin[i], cos[i]) = sin_cos(o.t[i] * R::HALF);
            difference[0][i] *= self.plain;
            difference[1][i] *= self.plain;
        }
        for [place, sin_p, weight, _, sh, half_sinh, cos_p] in self.each() {
            let square = sh * sh;
            for i in 0..L {
                let s = half_sine(o.t[i] - place, sin[i] * cos_p - cos[i] * sin_p);
                let c = cos[i] * cos_p + sin[i] * sin_p;
                let (su, cu) = ([o.sin[0][i], o.sin[1][i]], [o.cos[0][i], o.cos[1][i]]);
                let turned = [cu[0] * s + su[0] * c, cu[1] * s + su[1] * c];
                let bottom = [cu[0] * square + turned[0] * s, cu[1] * square + turned[1] * s];
                let angle = catan(quotient([su[0] * half_sinh, su[1] * half_sinh], bottom));
                difference[0][i] += angle[0] * (weight * R::TWO);
                difference[1][i] += angle[1] * (weight * R::TWO);
                let [x, y] = product(turned, turned);
                let rate = quotient([weight * half_sinh, R::zero()], [x + square, y]);
                slope[0][i] += rate[0];
                slope[1][i] += rate[1];
            }
        }
        [difference, slope]
    }
}

/// sin(v/2), which `far` is but for an absolute error: near a rung the relative one counts.
#[inline(always)]
fn half_sine<R: Real>(v: R, far: R) -> R {
    let turns = nearest(v * R::lit(0.5 * core::f64::consts::FRAC_1_PI));
    let [a, b, c] = R::HALF_PI;
    let rest = R::TWO * turns;
    let half = ((v * R::HALF - rest * a) - rest * b) - rest * c;
    let near = small_sine(half) * (R::one() - R::TWO * turns * turns);
    if half.abs() < R::lit(0.7) { near } else { far }
}

/// Nodes of a chunk.
struct Chunk<R> {
    t: [R; LANES],
    slope: [R; LANES],
    bend: [R; LANES],
    /// All were found to rounding.
    settled: bool,
}

/// Halley's method for all nodes of a chunk, started by two terms of Taylor's series from node to node.
struct Place<'a, 'b, R> {
    grading: &'b Grading<'a, R>,
    s: [R; LANES],
    /// s and t of the node before.
    start: [R; 2],
    out: &'b mut Chunk<R>,
}

impl<R: Real> Task for Place<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Place { grading, s, start: [mut at, mut t], out } = self;
        for i in 0..LANES {
            let [slope, bend] = grading.slope(t);
            let (h, rate) = (s[i] - at, R::one() / slope);
            t += h * rate * (R::one() - h * R::HALF * bend * rate * rate).max(R::HALF).min(R::TWO);
            (at, out.t[i]) = (s[i], t);
        }
        let mut before = R::MAX;
        for _ in 0..12 {
            let jets = grading.jets(&out.t);
            // Largest residuals in units of what rounding explains in the best and in the worst case.
            let (mut strict, mut wide) = (R::zero(), R::zero());
            for i in 0..LANES {
                let f = (jets.value[i] - s[i]).abs();
                let (one, all) =
                    (R::TWO + jets.slope[i] * out.t[i] * R::HALF, R::lit(450.0) + R::lit(9.0) * jets.slope[i]);
                let (one, all) = (f / one, f / all);
                strict = if one > strict { one } else { strict };
                wide = if all > wide { all } else { wide };
            }
            (out.slope, out.bend) = (jets.slope, jets.bend);
            if strict <= R::EPSILON || strict > before * R::HALF {
                out.settled = wide <= R::EPSILON;
                if out.settled || strict <= R::EPSILON {
                    return;
                }
            }
            before = strict;
            for i in 0..LANES {
                let newton = (s[i] - jets.value[i]) / jets.slope[i];
                let curved = R::one() + newton * jets.bend[i] / jets.slope[i] * R::HALF;
                out.t[i] += newton / if curved < R::HALF { R::HALF } else { curved };
            }
        }
    }
}
