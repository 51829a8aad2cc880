//! Tables and channels as functions of time: quintic pieces between rows (t, u, u̇, ü), constant outside; where they jump, and how
//! long a step may be that sees all they do.
//!
//! Tested by the tests at its end, `tests/channels`, `tests/drives`.

use core::ops::Range;

use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::model::signal::{Jump, Moment, Seen};

/// Rows (t, u, u̇, ü) at times that do not decrease; two at one time are a jump.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a, R>(pub(super) &'a [R]);

/// Where a time lies.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Region {
    Before,
    /// Behind this row.
    Piece(usize),
    After,
}

/// A quintic between two rows: u = u₀ + c₁ x + … + c₅ x⁵ with x = (t − t₀)/h.
#[derive(Clone, Copy)]
struct Piece<R> {
    t0: R,
    h: R,
    u0: R,
    c: [R; 5],
}

impl<R: Real> Piece<R> {
    fn new([t0, u0, v0, a0]: [R; 4], [t1, u1, v1, a1]: [R; 4]) -> Self {
        let h = t1 - t0;
        let k = |x: f64| R::lit(x);
        let (v0h, a0h) = (v0 * h, a0 * h * h);
        let d = u1 - u0 - v0h - a0h * R::HALF;
        let e = v1 * h - v0h - a0h;
        let f = a1 * h * h - a0h;
        let c3 = k(10.0) * d - k(4.0) * e + k(0.5) * f;
        let c4 = k(-15.0) * d + k(7.0) * e - f;
        let c5 = k(6.0) * d - k(3.0) * e + k(0.5) * f;
        Piece { t0, h, u0, c: [v0h, a0h * R::HALF, c3, c4, c5] }
    }

    fn evaluate(&self, t: R) -> [R; 3] {
        let k = |x: f64| R::lit(x);
        let ([c1, c2, c3, c4, c5], x) = (self.c, (t - self.t0) / self.h);
        let u = self.u0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
        let v = (c1 + x * (c2 * R::TWO + x * (k(3.0) * c3 + x * (k(4.0) * c4 + x * k(5.0) * c5)))) / self.h;
        let a = (c2 * R::TWO + x * (k(6.0) * c3 + x * (k(12.0) * c4 + x * k(20.0) * c5))) / (self.h * self.h);
        [u, v, a]
    }

    /// d³u/dt³.
    fn jerk(&self, t: R) -> R {
        let ([_, _, c3, c4, c5], x) = (self.c, (t - self.t0) / self.h);
        (R::lit(6.0) * c3 + x * (R::lit(24.0) * c4 + x * R::lit(60.0) * c5)) / (self.h * self.h * self.h)
    }

    /// What drives: ü of a motion, the value of a torque.
    fn drives(&self, motion: bool, t: R) -> R {
        let [u, _, a] = self.evaluate(t);
        if motion { a } else { u }
    }

    /// What rounding may make of that.
    fn rounding(&self, motion: bool) -> R {
        let size = self.c.iter().fold(self.u0.abs(), |s, c| s + c.abs()) * R::lit(64.0) * R::EPSILON;
        if motion { size / (self.h * self.h) } else { size }
    }
}

impl<R: Real> Rows<'_, R> {
    fn count(&self) -> usize {
        self.0.len() / 4
    }

    fn row(&self, k: usize) -> [R; 4] {
        match part(self.0, 4 * k, 4) {
            &[t, u, v, a] => [t, u, v, a],
            _ => [R::NAN; 4],
        }
    }

    fn time(&self, k: usize) -> R {
        self.row(k)[0]
    }

    fn piece(&self, k: usize) -> Piece<R> {
        Piece::new(self.row(k), self.row(k + 1))
    }

    /// Number of rows at or before `t`.
    fn rows_until(&self, t: R) -> usize {
        let (mut low, mut high) = (0, self.count());
        while low < high {
            let middle = (low + high) / 2;
            if self.time(middle) <= t { low = middle + 1 } else { high = middle }
        }
        low
    }

    /// How far rounding may have taken a time from the row that is meant: a step that ends with a row must not find itself beyond it.
    fn slack(&self, k: usize, t: R) -> R {
        let gap = |k: usize| if k + 1 < self.count() { self.time(k + 1) - self.time(k) } else { R::MAX };
        let (before, behind) = (if k > 0 { gap(k - 1) } else { R::MAX }, gap(k));
        let room = |gap: R| if gap > R::zero() { gap * R::lit(0.25) } else { R::MAX };
        (R::lit(16.0) * R::EPSILON * t.abs()).min(room(before)).min(room(behind))
    }

    /// The row that a time means, if it means one.
    fn row_at(&self, t: R) -> Option<usize> {
        let k = self.rows_until(t);
        let near = |k: usize| k < self.count() && (t - self.time(k)).abs() <= self.slack(k, t);
        if k > 0 && near(k - 1) {
            Some(k - 1)
        } else if near(k) {
            Some(k)
        } else {
            None
        }
    }

    /// The first and the last row of one time.
    fn of_one_time(&self, k: usize) -> (usize, usize) {
        let (mut first, mut last, t) = (k, k, self.time(k));
        while first > 0 && self.time(first - 1) == t {
            first -= 1;
        }
        while last + 1 < self.count() && self.time(last + 1) == t {
            last += 1;
        }
        (first, last)
    }

    /// The first row that is clearly later.
    fn first_after(&self, t: R) -> usize {
        self.row_at(t).map_or_else(|| self.rows_until(t), |k| self.of_one_time(k).1 + 1)
    }

    /// Rows strictly within (t, end), by their numbers.
    fn within(&self, t: R, end: R) -> impl Iterator<Item = usize> {
        let last = self.row_at(end).map_or(self.count(), |k| self.of_one_time(k).0);
        (self.first_after(t)..last).take_while(move |k| self.time(*k) < end)
    }

    fn region(&self, at: Moment<R>) -> Region {
        let behind = match self.row_at(at.t) {
            Some(k) if !at.after => self.of_one_time(k).0,
            _ => self.first_after(at.t),
        };
        match behind.checked_sub(1) {
            None => Region::Before,
            Some(k) if k + 1 < self.count() => Region::Piece(k),
            Some(_) => Region::After,
        }
    }

    fn end(&self, region: Region) -> [R; 3] {
        let k = if region == Region::Before { 0 } else { self.count().saturating_sub(1) };
        [self.row(k)[1], R::zero(), R::zero()]
    }

    fn in_region(&self, region: Region, t: R) -> [R; 3] {
        match region {
            Region::Piece(k) => self.piece(k).evaluate(t),
            end => self.end(end),
        }
    }

    /// Value, rate, acceleration. O(log rows).
    pub(super) fn evaluate(&self, at: Moment<R>) -> [R; 3] {
        if self.count() == 0 {
            return [R::NAN; 3];
        }
        self.in_region(self.region(at), at.t)
    }

    /// By how much d³u/dt³ jumps at a row between two pieces.
    fn kink(&self, k: usize) -> R {
        let t = self.time(k);
        (self.piece(k.saturating_sub(1)).jerk(t) - self.piece(k).jerk(t)).abs()
    }

    /// What changes suddenly at a row: (value, rate, acceleration) before and after it.
    fn sides(&self, k: usize) -> ([R; 3], [R; 3]) {
        let (first, last) = self.of_one_time(k);
        let [_, u0, v0, a0] = self.row(first);
        let [_, u1, v1, a1] = self.row(last);
        let zero = R::zero();
        (
            if first == 0 { [u0, zero, zero] } else { [u0, v0, a0] },
            if last + 1 == self.count() { [u1, zero, zero] } else { [u1, v1, a1] },
        )
    }

    fn jump_of(&self, motion: bool, k: usize) -> Jump {
        let (before, after) = self.sides(k);
        let (first, last) = self.of_one_time(k);
        let beside = [first.checked_sub(1), (last + 1 < self.count()).then_some(last)];
        judge(motion, before, after, beside.into_iter().flatten().map(|k| self.piece(k)))
    }

    /// What jumps at a time.
    pub(super) fn jump_at(&self, motion: bool, t: R) -> Jump {
        self.row_at(t).map_or(Jump::None, |k| self.jump_of(motion, k))
    }

    /// What jumps at a time if one of these rows, the first or the last, is there, unless nothing moves.
    pub(super) fn end_at(&self, motion: bool, t: R, rows: Range<usize>) -> Option<Jump> {
        let k = self.row_at(t).filter(|k| rows.contains(k))?;
        let jump = self.jump_of(motion, k);
        (jump != Jump::None || self.matters(motion, k, R::zero())).then_some(jump)
    }

    /// First jump strictly within (t, end). O(rows in between).
    pub(super) fn next_jump(&self, motion: bool, t: R, end: R) -> Option<R> {
        self.within(t, end).find(|k| self.jump_of(motion, *k) != Jump::None).map(|k| self.time(k))
    }

    /// First row strictly within (t, end) at which the drive loses smoothness that matters within that time: by more than a thousandth of
    /// its size. A method without an estimate ends its steps there. O(rows in between).
    pub(super) fn next_kink(&self, motion: bool, t: R, end: R) -> Option<R> {
        self.within(t, end).find(|k| self.matters(motion, *k, end - t)).map(|k| self.time(k))
    }

    /// Whether the row that a time means is such a one.
    pub(super) fn kinks_at(&self, motion: bool, t: R, h: R) -> bool {
        self.row_at(t).is_some_and(|k| self.matters(motion, self.of_one_time(k).0, h.abs()))
    }

    fn matters(&self, motion: bool, k: usize, h: R) -> bool {
        let flat = |k: usize| self.piece(k).c.iter().all(|c| *c == R::zero());
        if self.count() < 2 {
            return false;
        }
        if k == 0 || k + 1 == self.count() {
            return !flat(k.min(self.count() - 2));
        }
        let size = |k: usize| if motion { self.row(k)[3].abs() } else { self.row(k)[1].abs() };
        let jump = self.kink(k) * if motion { h } else { h * h * h };
        jump > R::lit(1e-3) * [k - 1, k, k + 1].map(size).into_iter().fold(R::zero(), R::max)
    }

    /// See [`crate::model::signal::SignalRecord::seen`]. O(rows in the step).
    pub(super) fn seen(&self, motion: bool, share: Seen, t: R, h: R) -> R {
        let part = R::lit(match share {
            Seen::Roughly | Seen::RampsWell => 0.5,
            Seen::Well => 0.05,
        });
        let drives = |at: Moment<R>| if motion { self.evaluate(at)[2] } else { self.evaluate(at)[0] };
        let begin = Moment { t, after: true };
        let start = match self.region(begin) {
            Region::After => return h,
            Region::Before => None,
            Region::Piece(k) => Some(k),
        };
        let first = drives(begin);
        let mut limit = h;
        if share == Seen::Well {
            // Within one quintic, which a method of order 6 integrates exactly.
            let next = self.first_after(t);
            if next < self.count() {
                limit = limit.min(self.time(next) - t);
            }
        }
        // Every round at least halves the step, or ends it where something begins.
        for _ in 0..1100 {
            let end = t + limit;
            let last = drives(Moment { t: end, after: false });
            let allowed = part * first.abs().max(last.abs());
            let line = |s: R| first + (last - first) * ((s - t) / limit);
            let mut pieces = start.unwrap_or(0)..self.count().saturating_sub(1);
            let unseen = pieces.by_ref().take_while(|k| end - self.time(*k) > self.slack(*k, end)).find(|k| {
                let (from, to) = (self.time(*k).max(t), self.time(*k + 1).min(end));
                if to - from <= self.slack(*k, end) {
                    return false;
                }
                let piece = self.piece(*k);
                // A kink of ü inside a step is half unseen: the step ends there, or is so short that it does not matter.
                if motion
                    && *k > 0
                    && self.time(*k) > t
                    && self.kink(*k) * limit > R::lit(0.01) * first.abs().max(last.abs())
                {
                    return true;
                }
                let allowed = allowed + piece.rounding(motion);
                [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().any(|x| {
                    let s = from + R::lit(x) * (to - from);
                    (piece.drives(motion, s) - line(s)).abs() > allowed
                })
            });
            let Some(k) = unseen else { break };
            // To where its piece begins, else to where it ends.
            let (begin, end) = (self.time(k) - t, self.time(k + 1) - t);
            let corner = if begin > R::zero() { begin } else { end };
            limit = if corner < limit { corner.max(limit * R::HALF) } else { limit * R::HALF };
            if t + limit <= t {
                break;
            }
        }
        limit
    }
}

/// What jumps when a channel of one piece is given another piece at time `t`.
pub(crate) fn channel_jump<R: Real>(motion: bool, t: R, old: &[R], new: &[R]) -> Jump {
    let (old, new) = (Rows(old), Rows(new));
    let (before, after) = (old.evaluate(Moment { t, after: false }), new.evaluate(Moment { t, after: true }));
    let beside = [old, new].into_iter().filter(|rows| rows.time(1) > rows.time(0)).map(|rows| rows.piece(0));
    judge(motion, before, after, beside)
}

/// Whether the slope of what drives (ü, or a torque) changes at `t` from one piece of a channel to the next, by more than a thousandth of
/// its size over a piece.
pub(crate) fn channel_kink<R: Real>(motion: bool, t: R, old: &[R], new: &[R]) -> bool {
    let (old, new) = (Rows(old), Rows(new));
    let slope = |rows: &Rows<'_, R>, at: Moment<R>| match rows.region(at) {
        Region::Piece(k) if motion => rows.piece(k).jerk(at.t),
        Region::Piece(k) => rows.piece(k).evaluate(at.t)[1],
        _ => R::zero(),
    };
    let change = slope(&old, Moment { t, after: false }) - slope(&new, Moment { t, after: true });
    let size = |rows: &Rows<'_, R>, k: usize| if motion { rows.row(k)[3].abs() } else { rows.row(k)[1].abs() };
    let largest =
        [(&old, 0), (&old, 1), (&new, 0), (&new, 1)].into_iter().fold(R::zero(), |m, (rows, k)| m.max(size(rows, k)));
    change.abs() * (new.time(1) - new.time(0)) > R::lit(1e-3) * largest
}

/// What kind of jump the difference of both sides is. Rounding is none, nor is a millionth of what the pieces beside it do in a motion's
/// value and rate. Of a torque only the value acts.
fn judge<R: Real>(motion: bool, before: [R; 3], after: [R; 3], beside: impl Iterator<Item = Piece<R>>) -> Jump {
    let kinds: &[Jump] = if motion { &[Jump::Value, Jump::Rate, Jump::Force] } else { &[Jump::Force] };
    if before.iter().zip(&after).take(kinds.len()).all(|(a, b)| a == b) {
        return Jump::None;
    }
    let mut allowed = [R::zero(); 3];
    for piece in beside {
        let change = piece.c.iter().fold(R::zero(), |s, c| s + c.abs());
        let rounding = R::lit(64.0) * R::EPSILON * (piece.u0.abs() + change);
        let small = if motion { R::lit(1e-6) * change + rounding } else { rounding };
        for (allowed, x) in allowed.iter_mut().zip([small, small / piece.h, rounding / (piece.h * piece.h)]) {
            *allowed = allowed.max(x);
        }
    }
    let mut sides = before.into_iter().zip(after).zip(allowed);
    let jumps = |_: &&Jump| sides.next().is_some_and(|((a, b), allowed)| (b - a).abs() > allowed);
    kinds.iter().find(jumps).copied().unwrap_or(Jump::None)
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn at(t: f64) -> Moment<f64> {
        Moment { t, after: true }
    }

    #[test]
    fn a_jump_has_two_sides() {
        let rows = [0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 3.0, 0.0, 0.0, 2.0, 3.0, 0.0, 0.0];
        let rows = Rows(&rows);
        assert_eq!(rows.evaluate(Moment { t: 1.0, after: false })[0], 1.0);
        assert_eq!(rows.evaluate(at(1.0))[0], 3.0);
        assert_eq!(rows.evaluate(at(1.0 - 1e-9))[0], 1.0);
        // A step that is meant to end there sees the value before, wherever rounding took it.
        assert_eq!(rows.evaluate(Moment { t: 1.0 + 2e-16, after: false })[0], 1.0);
        assert_eq!(rows.evaluate(at(1.0 - 2e-16))[0], 3.0);
        assert_eq!(rows.next_jump(false, 0.0, 10.0), Some(1.0));
        assert_eq!(rows.next_jump(false, 1.0, 10.0), None);
        assert_eq!(rows.jump_at(false, 1.0), Jump::Force);
        assert_eq!(rows.jump_at(true, 1.0), Jump::Value);
    }

    #[test]
    fn the_end_of_a_motion_that_still_moves_is_a_jump_of_its_rate() {
        let rows = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 0.0];
        let rows = Rows(&rows);
        assert_eq!(rows.next_jump(true, 0.0, 2.0), Some(1.0));
        assert_eq!(rows.jump_at(true, 1.0), Jump::Rate);
        assert_eq!(rows.evaluate(Moment { t: 1.0, after: false })[1], 2.0);
        assert_eq!(rows.evaluate(at(1.0))[1], 0.0);
    }

    #[test]
    fn a_pulse_after_any_pause_is_met_at_its_beginning() {
        for (pause, pulse) in [(1000.0, 1e-3), (1e-3, 1e-3), (10.0, 5.0), (1e6, 1e-3)] {
            let end = pause + pulse;
            let row = |t, u| [t, u, 0.0, 0.0];
            let rows =
                [row(0.0, 0.0), row(pause, 0.0), row(pause + 0.5 * pulse, 1.0), row(end, 0.0), row(2.0 * end, 0.0)];
            let rows = Rows(rows.as_flattened());
            for motion in [false, true] {
                let h = rows.seen(motion, Seen::Roughly, 0.0, 3.0 * end);
                assert!(h >= 0.5 * pause && h <= pause + 0.25 * pulse, "{pause} {pulse} {h}");
                assert!(rows.seen(motion, Seen::Roughly, pause, end) <= 0.5 * pulse);
                assert_eq!(rows.seen(motion, Seen::Roughly, end, end), end);
            }
        }
    }

    #[test]
    fn dense_rows_of_a_slow_motion_do_not_shorten_steps() {
        let rows: std::vec::Vec<[f64; 4]> =
            (0..=10_000).map(|k| 1e-3 * f64::from(k)).map(|t| [t, t.sin(), t.cos(), -t.sin()]).collect();
        let rows = Rows(rows.as_flattened());
        for k in 0..80 {
            let h = rows.seen(true, Seen::Roughly, 0.1 * f64::from(k), 0.5);
            assert_eq!(h, 0.5);
        }
        // A wiggle of a thousandth between two rows of them is seen.
        let mut rough = rows.0.to_vec();
        rough[4 * 3000 + 1] += 1e-3;
        assert!(Rows(&rough).seen(true, Seen::Roughly, 2.8, 0.5) <= 0.2);
    }
}
