//! Scalar functions of time that drive joints and roots: value, rate and acceleration.
//!
//! Tested by the tests at its end, `tests/driving`.

use core::ops::Range;

use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::model::table::Rows;
use crate::scene::{Signal, Window};

/// A time, and which side of it is meant where something jumps there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Moment<R> {
    pub t: R,
    pub after: bool,
}

/// What changes suddenly at a time, the worst last.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Jump {
    None,
    /// ü of a motion, or a torque: the equations' right-hand side jumps, the state does not.
    Force,
    /// The rate of a motion: only an impulse would do that.
    Rate,
    /// The value of a motion: nothing would do that.
    Value,
}

/// How well a step must know what a drive does between its ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Seen {
    /// So that an error estimate sees it: a quarter of a period, an eighth of a ramp.
    Roughly,
    /// For a method without an estimate: a sixteenth of a period, a thirty-second of a ramp.
    Well,
    /// Periods roughly, ramps, the steepest of smooth functions, well.
    RampsWell,
}

/// A signal compiled into a model: numbers live in the model's store.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SignalRecord<R> {
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

    /// Checks the numbers and copies them to the front of `store`, which begins at `at` in the model's store. A motion may not jump, a
    /// torque may.
    pub(crate) fn compile(&self, store: &mut [R], at: usize, channel: usize, motion: bool) -> Result<SignalRecord<R>> {
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
                    // Steps within a ramp take digits of the time.
                    let digits = R::lit(64.0) * R::EPSILON * w.from.abs().max(w.to.abs());
                    if !(w.ramp > digits && w.ramp + w.ramp <= (w.to - w.from) * (R::one() + R::lit(8.0) * R::EPSILON))
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
                    let jump = last == Some(row[0]) && !motion;
                    if last.is_some_and(|t| row[0] <= t) && !jump {
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
    pub(crate) fn evaluate(&self, at: Moment<R>, store: &[R], channels: &[R]) -> [R; 3] {
        let t = at.t;
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
            Kind::Table | Kind::Channel => self.rows(store, channels).evaluate(at),
        }
    }

    fn rows<'s>(&self, store: &'s [R], channels: &'s [R]) -> Rows<'s, R> {
        let all = if matches!(self.kind, Kind::Channel) { channels } else { store };
        Rows(part(all, self.at, self.len))
    }

    /// The longest step from `t`, at most `h`, whose ends tell what the signal does in between, as the drive of a motion (by ü) or as a
    /// torque: a quarter of the shortest period; an eighth of a window's ramp, or as far as its beginning; of a table, as far as ü (or
    /// the torque) stays within half of its size at the ends from the straight line between these. O(terms), or O(rows in the step).
    pub(crate) fn seen(&self, motion: bool, share: Seen, t: R, h: R, store: &[R], channels: &[R]) -> R {
        match self.kind {
            Kind::Constant(_) => h,
            Kind::Table | Kind::Channel => self.rows(store, channels).seen(motion, share, t, h),
            Kind::Harmonic(window) => {
                let (turns, ramps) = match share {
                    Seen::Roughly => (0.25, 0.125),
                    Seen::Well => (0.0625, 0.03125),
                    Seen::RampsWell => (0.25, 0.03125),
                };
                let period = self.shortest_period(motion, store) * R::lit(turns);
                let Some(w) = window else { return h.min(period) };
                let ramp = (w.ramp * R::lit(ramps)).min(period);
                let mut limit = h;
                for (start, end, scale) in [
                    (w.from, w.from + w.ramp, ramp),
                    (w.from + w.ramp, w.to - w.ramp, period),
                    (w.to - w.ramp, w.to, ramp),
                ] {
                    if end > t && start - t < limit {
                        limit = limit.min(scale.max(start - t));
                    }
                }
                limit
            }
        }
    }

    /// Of a harmonic sum: of the fastest term that is more than rounding.
    fn shortest_period(&self, motion: bool, store: &[R]) -> R {
        let terms = || part(store, self.at, self.len).as_chunks::<4>().0.iter();
        let size = |amplitude: R, frequency: R| amplitude.abs() * if motion { frequency * frequency } else { R::one() };
        let all = terms().fold(R::zero(), |s, [a, f, ..]| s + size(*a, *f));
        let fastest = terms()
            .filter(|[a, f, ..]| size(*a, *f) > R::EPSILON * all)
            .fold(R::zero(), |m, [_, f, ..]| m.max(f.abs()));
        if fastest > R::TAU / R::MAX { R::TAU / fastest } else { R::MAX }
    }

    /// What jumps at a time, but for the ends of a channel's piece.
    pub(crate) fn jump_at(&self, motion: bool, t: R, store: &[R]) -> Jump {
        match self.kind {
            Kind::Constant(_) | Kind::Harmonic(_) | Kind::Channel => Jump::None,
            Kind::Table => self.rows(store, &[]).jump_at(motion, t),
        }
    }

    /// What jumps at a time at which a channel's piece begins (row 0) or ends (row 1), unless nothing moves there. Another piece may be
    /// given there until the next step, hence this is a question of its own.
    pub(crate) fn piece_at(&self, motion: bool, t: R, rows: Range<usize>, channels: &[R]) -> Option<Jump> {
        self.channel()?;
        self.rows(&[], channels).end_at(motion, t, rows)
    }

    /// First time strictly within (t, end) at which a table is less smooth than in between.
    pub(crate) fn next_kink(&self, motion: bool, t: R, end: R, store: &[R], channels: &[R]) -> Option<R> {
        match self.kind {
            Kind::Constant(_) | Kind::Harmonic(_) => None,
            Kind::Table | Kind::Channel => self.rows(store, channels).next_kink(motion, t, end),
        }
    }

    /// Whether a table is less smooth at `t`, by so much that it matters to a step of length `h` that ends there; or whether in that step
    /// a window began to rise or fall: infinitely smooth, but no past tells of it.
    pub(crate) fn kinks_at(&self, motion: bool, t: R, h: R, store: &[R]) -> bool {
        match self.kind {
            Kind::Constant(_) | Kind::Harmonic(None) | Kind::Channel => false,
            Kind::Harmonic(Some(w)) => {
                // Not at the beginning of the step: that was seen by the one before, if there was any.
                let began = |edge: R| t == edge || (t - edge) * (edge - (t - h)) > R::zero();
                began(w.from) || began(w.to - w.ramp)
            }
            Kind::Table => self.rows(store, &[]).kinks_at(motion, t, h),
        }
    }

    /// First time strictly within (t, end) at which something jumps.
    pub(crate) fn next_jump(&self, motion: bool, t: R, end: R, store: &[R], channels: &[R]) -> Option<R> {
        match self.kind {
            Kind::Constant(_) | Kind::Harmonic(_) => None,
            Kind::Table | Kind::Channel => self.rows(store, channels).next_jump(motion, t, end),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Harmonic;

    fn at(t: f64) -> Moment<f64> {
        Moment { t, after: false }
    }

    fn derivatives_agree(signal: Signal<'_, f64>, times: &[f64], tolerance: f64) {
        let mut store = [0.0; 64];
        let record = signal.compile(&mut store, 0, 0, true).unwrap();
        let h = 1e-4;
        for &t in times {
            let [_, v, a] = record.evaluate(at(t), &store, &[]);
            let (p, m) = (record.evaluate(at(t + h), &store, &[]), record.evaluate(at(t - h), &store, &[]));
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
        let record = Signal::Table(&rows).compile(&mut store, 0, 0, true).unwrap();
        for row in rows {
            // At rest outside: the first row is seen from after it.
            let [u, v, a] = record.evaluate(Moment { t: row[0], after: row[0] < 3.0 }, &store, &[]);
            assert!((u - row[1]).abs() + (v - row[2]).abs() + (a - row[3]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_table_whose_times_do_not_increase_is_refused_with_the_time_of_the_row() {
        let rows = [[0.0, 5.0, 0.0, 0.0], [2.0, 6.0, 0.0, 0.0], [1.5, 7.0, 0.0, 0.0]];
        let again = [[0.5, 5.0, 0.0, 0.0], [0.5, 6.0, 0.0, 0.0]];
        for (rows, motion, time) in [(&rows[..], true, 1.5), (&rows[..], false, 1.5), (&again[..], true, 0.5)] {
            let told = Signal::Table(rows).compile(&mut [0.0; 12], 0, 0, motion).err().unwrap();
            assert_eq!((told.status, told.what, told.value), (Status::BadTable, "t", time));
        }
        // What is no motion may jump.
        assert!(Signal::Table(&again).compile(&mut [0.0; 12], 0, 0, false).is_ok());
    }

    #[test]
    fn a_window_vanishes_with_all_derivatives_outside_its_support() {
        let w = Window { from: 1.0, to: 3.0, ramp: 1.0 };
        assert_eq!(w.evaluate(1.0), [0.0; 3]);
        assert_eq!(w.evaluate(3.5), [0.0; 3]);
        assert_eq!(w.evaluate(2.0)[0], 1.0);
    }

    #[test]
    fn a_window_is_met_at_its_beginning_and_resolved() {
        let terms = [Harmonic { amplitude: 0.7, frequency: 2.0, phase: 0.3, offset: 0.1 }];
        let window = Some(Window { from: 1000.0, to: 1000.5, ramp: 1e-3 });
        let mut store = [0.0; 4];
        let record = Signal::Harmonic { terms: &terms, window }.compile(&mut store, 0, 0, true).unwrap();
        let seen = |t| record.seen(true, Seen::Roughly, t, 5000.0, &store, &[]);
        assert_eq!(seen(0.0), 1000.0);
        assert_eq!(seen(1000.0), 1.25e-4);
        assert!((seen(1000.1) - 0.399).abs() < 1e-9);
        assert_eq!(seen(1000.5), 5000.0);
    }

    #[test]
    fn a_window_is_a_kink_where_its_ramps_begin_and_nowhere_else() {
        let terms = [Harmonic { amplitude: 0.7, frequency: 2.0, phase: 0.3, offset: 0.1 }];
        let window = Some(Window { from: 1.0, to: 5.0, ramp: 1.0 });
        let mut store = [0.0; 4];
        let record = Signal::Harmonic { terms: &terms, window }.compile(&mut store, 0, 0, true).unwrap();
        for k in 0..=700 {
            // Never on an edge, where rounding would decide.
            let t = 0.01 * f64::from(k) + 0.003;
            let expected = [1.0, 4.0].into_iter().any(|edge: f64| t > edge && t - 0.1 < edge);
            assert_eq!(record.kinks_at(true, t, 0.1, &store), expected, "{t}");
        }
    }
}
