//! Scalar functions of time that drive joints and roots: value, rate and acceleration.

use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::scene::{Signal, Window};

/// A signal compiled into a model: numbers live in the model's store.
#[derive(Clone, Copy, Debug)]
pub struct SignalRecord<R> {
    kind: Kind<R>,
    at: usize,
    len: usize,
}

#[derive(Clone, Copy, Debug)]
enum Kind<R> {
    Constant(R),
    Harmonic(Option<Window<R>>),
    Table,
    Channel,
}

impl<R: Default> Default for SignalRecord<R> {
    fn default() -> Self {
        SignalRecord { kind: Kind::Constant(R::default()), at: 0, len: 0 }
    }
}

/// Reals that one channel keeps: (t, u, u̇, ü) at both ends of the caller's step.
pub const CHANNEL_LEN: usize = 8;

impl<R: Real> Signal<'_, R> {
    /// Reals needed in the store.
    pub(crate) fn store_len(&self) -> usize {
        match self {
            Signal::Constant(_) | Signal::Channel => 0,
            Signal::Harmonic { terms, .. } => 4 * terms.len(),
            Signal::Table(rows) => 4 * rows.len(),
        }
    }

    /// Never moves.
    pub(crate) fn is_constant(&self) -> bool {
        match self {
            Signal::Constant(_) => true,
            Signal::Harmonic { terms, window } => {
                window.is_none() && terms.iter().all(|h| h.amplitude == R::zero() || h.frequency == R::zero())
            }
            Signal::Table(rows) => rows.len() == 1,
            Signal::Channel => false,
        }
    }

    /// Checks the numbers and copies them to the front of `store`, which begins at `at` in the model's store.
    pub(crate) fn compile(&self, store: &mut [R], at: usize, channel: usize) -> Result<SignalRecord<R>> {
        let finite =
            |what, x: R| if x.is_finite() { Ok(()) } else { Err(Error::new(Status::NotFinite).of(what, x.to_f64())) };
        let kind = match self {
            Signal::Constant(c) => {
                finite("value", *c)?;
                Kind::Constant(*c)
            }
            Signal::Harmonic { terms, window } => {
                for (h, slot) in terms.iter().zip(store.chunks_exact_mut(4)) {
                    finite("amplitude", h.amplitude)?;
                    finite("frequency", h.frequency)?;
                    finite("phase", h.phase)?;
                    finite("offset", h.offset)?;
                    for (s, x) in slot.iter_mut().zip([h.amplitude, h.frequency, h.phase, h.offset]) {
                        *s = x;
                    }
                }
                if let Some(w) = window {
                    finite("from", w.from)?;
                    finite("to", w.to)?;
                    if !(w.ramp > R::zero()
                        && w.ramp + w.ramp <= (w.to - w.from) * (R::one() + R::lit(8.0) * R::EPSILON))
                    {
                        return Err(Error::new(Status::OutOfRange).of("ramp", w.ramp.to_f64()));
                    }
                }
                Kind::Harmonic(*window)
            }
            Signal::Table(rows) => {
                let mut last = None;
                for (row, slot) in rows.iter().zip(store.chunks_exact_mut(4)) {
                    for (s, x) in slot.iter_mut().zip(row) {
                        finite("table", *x)?;
                        *s = *x;
                    }
                    if last.is_some_and(|t| row[0] <= t) {
                        return Err(Error::new(Status::BadTable).of("t", row[0].to_f64()));
                    }
                    last = Some(row[0]);
                }
                if rows.is_empty() {
                    return Err(Error::new(Status::BadTable).of("rows", 0.0));
                }
                Kind::Table
            }
            Signal::Channel => {
                return Ok(SignalRecord { kind: Kind::Channel, at: channel * CHANNEL_LEN, len: CHANNEL_LEN });
            }
        };
        Ok(SignalRecord { kind, at, len: self.store_len() })
    }
}

impl<R: Real> SignalRecord<R> {
    /// Value, rate and acceleration at time `t`. O(terms), or O(log rows) for a table.
    pub(crate) fn evaluate(&self, t: R, store: &[R], channels: &[R]) -> [R; 3] {
        match self.kind {
            Kind::Constant(c) => [c, R::zero(), R::zero()],
            Kind::Harmonic(window) => {
                let mut u = [R::zero(); 3];
                for h in part(store, self.at, self.len).chunks_exact(4) {
                    if let &[amplitude, frequency, phase, offset] = h {
                        let (s, c) = (frequency * t + phase).sin_cos();
                        u[0] += offset + amplitude * s;
                        u[1] += amplitude * frequency * c;
                        u[2] -= amplitude * frequency * frequency * s;
                    }
                }
                match window {
                    Some(w) => product(u, w.evaluate(t)),
                    None => u,
                }
            }
            Kind::Table => table(part(store, self.at, self.len), t),
            Kind::Channel => table(part(channels, self.at, self.len), t),
        }
    }

    /// The channel's index, if it is one.
    pub(crate) fn channel(&self) -> Option<usize> {
        matches!(self.kind, Kind::Channel).then_some(self.at / CHANNEL_LEN)
    }
}

/// Product rule.
fn product<R: Real>(u: [R; 3], w: [R; 3]) -> [R; 3] {
    [u[0] * w[0], u[1] * w[0] + u[0] * w[1], u[2] * w[0] + R::TWO * u[1] * w[1] + u[0] * w[2]]
}

impl<R: Real> Window<R> {
    /// Value and two derivatives.
    fn evaluate(&self, t: R) -> [R; 3] {
        let up = smooth_step((t - self.from) / self.ramp, self.ramp);
        let mut down = smooth_step((self.to - t) / self.ramp, self.ramp);
        down[1] = -down[1];
        product(up, down)
    }
}

/// 1/(1 + e^z), z = 1/x − 1/(1−x): 0 for x ≤ 0, 1 for x ≥ 1, infinitely smooth; derivatives by t = x·length.
fn smooth_step<R: Real>(x: R, length: R) -> [R; 3] {
    let one = R::one();
    // Beyond |z| = 80 the function is flat to the last bit of either scalar type.
    let (a, b) = (one / x, one / (one - x));
    if x <= R::zero() || (x < one && a - b > R::lit(80.0)) {
        return [R::zero(); 3];
    }
    if x >= one || a - b < R::lit(-80.0) {
        return [one, R::zero(), R::zero()];
    }
    let s = one / (one + (a - b).exp());
    let z1 = -(a * a + b * b);
    let z2 = R::TWO * (a * a * a - b * b * b);
    let q = s * (one - s);
    [s, -z1 * q / length, (z1 * z1 * (one - s - s) - z2) * q / (length * length)]
}

/// Quintic Hermite interpolation of rows (t, u, u̇, ü); constant outside.
fn table<R: Real>(rows: &[R], t: R) -> [R; 3] {
    let row = |k: usize| match part(rows, 4 * k, 4) {
        &[t, u, v, a] => [t, u, v, a],
        _ => [R::NAN; 4],
    };
    let n = rows.len() / 4;
    if n == 0 {
        return [R::NAN; 3];
    }
    let (first, last) = (row(0), row(n - 1));
    // A step that ends with the table may miss its last time by rounding; it must not find the signal at rest there.
    let slack = R::lit(16.0) * R::EPSILON * first[0].abs().max(last[0].abs());
    for (end, beyond) in [(first, t <= first[0]), (last, t >= last[0])] {
        if beyond {
            let near = (t - end[0]).abs() <= slack;
            return if near { [end[1], end[2], end[3]] } else { [end[1], R::zero(), R::zero()] };
        }
    }
    let (mut low, mut high) = (0, n - 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if row(middle)[0] <= t { low = middle } else { high = middle }
    }
    let ([t0, u0, v0, a0], [t1, u1, v1, a1]) = (row(low), row(high));
    let h = t1 - t0;
    let x = (t - t0) / h;
    // u = u0 + v0 s + a0 s²/2 + c3 x³ + c4 x⁴ + c5 x⁵ with s = h x
    let (v0h, a0h) = (v0 * h, a0 * h * h);
    let d = u1 - u0 - v0h - a0h * R::HALF;
    let e = v1 * h - v0h - a0h;
    let f = a1 * h * h - a0h;
    let c = |k: f64| R::lit(k);
    let c3 = c(10.0) * d - c(4.0) * e + c(0.5) * f;
    let c4 = c(-15.0) * d + c(7.0) * e - f;
    let c5 = c(6.0) * d - c(3.0) * e + c(0.5) * f;
    let u = u0 + x * (v0h + x * (a0h * R::HALF + x * (c3 + x * (c4 + x * c5))));
    let v = (v0h + x * (a0h + x * (c(3.0) * c3 + x * (c(4.0) * c4 + x * c(5.0) * c5)))) / h;
    let a = (a0h + x * (c(6.0) * c3 + x * (c(12.0) * c4 + x * c(20.0) * c5))) / (h * h);
    [u, v, a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Harmonic;

    fn derivatives_agree(signal: Signal<'_, f64>, times: &[f64], tolerance: f64) {
        let mut store = [0.0; 64];
        let record = signal.compile(&mut store, 0, 0).unwrap();
        let h = 1e-4;
        for &t in times {
            let [_, v, a] = record.evaluate(t, &store, &[]);
            let (p, m) = (record.evaluate(t + h, &store, &[]), record.evaluate(t - h, &store, &[]));
            assert!(((p[0] - m[0]) / (2.0 * h) - v).abs() < tolerance, "rate at {t}");
            assert!(((p[1] - m[1]) / (2.0 * h) - a).abs() < tolerance, "acceleration at {t}");
        }
    }

    #[test]
    fn rates_are_derivatives_of_the_values() {
        let terms = [Harmonic { amplitude: 0.7, frequency: 2.0, phase: 0.3, offset: 0.1 }];
        let window = Some(Window { from: 0.0, to: 5.0, ramp: 2.0 });
        let times = [-1.0, 0.4, 1.0, 1.7, 2.5, 3.3, 4.2, 4.9, 6.0];
        derivatives_agree(Signal::Harmonic { terms: &terms, window: None }, &times, 1e-7);
        derivatives_agree(Signal::Harmonic { terms: &terms, window }, &times, 1e-6);
        derivatives_agree(
            Signal::Table(&[[0.0, 1.0, 0.5, -0.2], [1.0, 2.0, 0.0, 0.4], [3.0, -1.0, 0.2, 0.0]]),
            &[0.3, 0.8, 1.2, 2.6],
            1e-6,
        );
    }

    #[test]
    fn a_table_passes_through_its_rows() {
        let rows = [[0.0, 1.0, 0.5, -0.2], [1.0, 2.0, 0.0, 0.4], [3.0, -1.0, 0.2, 0.0]];
        let mut store = [0.0; 12];
        let record = Signal::Table(&rows).compile(&mut store, 0, 0).unwrap();
        for row in rows {
            let [u, v, a] = record.evaluate(row[0], &store, &[]);
            assert!((u - row[1]).abs() + (v - row[2]).abs() + (a - row[3]).abs() < 1e-14);
        }
    }

    #[test]
    fn a_window_vanishes_with_all_derivatives_outside_its_support() {
        let w = Window { from: 1.0, to: 3.0, ramp: 1.0 };
        assert_eq!(w.evaluate(1.0), [0.0; 3]);
        assert_eq!(w.evaluate(3.5), [0.0; 3]);
        assert_eq!(w.evaluate(2.0)[0], 1.0);
    }
}
