//! Rates that jump, bend or begin late as functions of time: `adams` ends its steps there and is not blind behind them.

use super::*;
use crate::integrate::Adams;

/// y' = f(t) from one piece to the next; at an end of pieces the rate of a step's end is that before it, of its beginning that after.
struct Pieces<'f> {
    /// Ends of pieces, and whether the rate jumps there (else it bends).
    ends: &'f [(f64, bool)],
    /// The rate in a piece, and the longest step that sees it there.
    rate: &'f dyn Fn(usize, f64) -> f64,
    seen: &'f dyn Fn(f64) -> f64,
    /// Beginning of the step.
    start: f64,
    evaluations: usize,
}

impl System<f64> for Pieces<'_> {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, _: &[f64], dydt: &mut [f64]) -> Result<()> {
        self.evaluations += 1;
        let piece = self.ends.iter().filter(|(end, _)| *end < t || (*end == t && t <= self.start)).count();
        dydt[0] = (self.rate)(piece, t);
        Ok(())
    }
    fn clocked(&self) -> bool {
        true
    }
    fn seen(&self, t: f64, h: f64) -> f64 {
        // Up to the next bend, unless that is behind the next digit: jumps are told.
        let bends = self.ends.iter().filter(|(_, jumps)| !*jumps);
        let next = bends.map(|(end, _)| *end - t).find(|way| *way > 4.0 * f64::EPSILON * t);
        h.min(next.unwrap_or(h)).min((self.seen)(t))
    }
    fn next_jump(&self, t: f64, end: f64) -> Option<f64> {
        self.ends.iter().find(|(at, jumps)| *jumps && *at > t && *at < end).map(|(at, _)| *at)
    }
    fn jumps_at(&self, t: f64) -> bool {
        self.ends.iter().any(|(at, jumps)| *jumps && *at == t)
    }
    fn kinks_at(&self, t: f64, h: f64) -> bool {
        let rounding = (4.0 * f64::EPSILON * t).max(1e-9 * h);
        self.ends.iter().any(|(at, jumps)| !*jumps && (*at - t).abs() <= rounding)
    }
}

/// The integral by `adams` up to `end`, the times of its steps, and its evaluations.
fn integral(system: &mut Pieces<'_>, tolerance: f64, end: f64) -> (f64, std::vec::Vec<f64>) {
    let (mut adams, mut memory) = started(tolerance, tolerance, 0.0, &[0.0]);
    let mut times = std::vec::Vec::new();
    while adams.time() < end {
        system.start = adams.time();
        Adams::step(&mut adams, system, end, &mut memory).unwrap();
        times.push(adams.time());
    }
    (adams.state(&memory)[0], times)
}

#[test]
fn adams_ends_a_step_at_a_jump_and_begins_the_next_with_the_rate_after_it() {
    // Constant rates: exact to rounding, unless a step goes across or begins with the rate before.
    let rates = [1.0, 1.1, -2.0];
    let ends = [(0.7, true), (1.9, true)];
    let rate = |piece: usize, _: f64| rates[piece];
    let mut system = Pieces { ends: &ends, rate: &rate, seen: &|_| f64::MAX, start: 0.0, evaluations: 0 };
    let (y, times) = integral(&mut system, 1e-6, 3.0);
    assert!(ends.iter().all(|(end, _)| times.contains(end)), "{times:?}");
    assert!((y - (0.7 + 1.1 * 1.2 - 2.0 * 1.1)).abs() < 1e-14, "{y}");
    assert!(system.evaluations < 60, "{}", system.evaluations);
}

#[test]
fn adams_sees_a_pulse_behind_a_long_rest() {
    // A rest of any length, then (sin πx)⁴ of this width: of its integral 3/8 of the width is left.
    for width in [1e-3, 0.1, 2.0] {
        for rest in [0.3, 30.0, 3000.0] {
            let pulse = |piece: usize, t: f64| {
                let s = (std::f64::consts::PI * (t - rest) / width).sin();
                if piece == 1 { s * s * s * s / width } else { 0.0 }
            };
            let ends = [(rest, false), (rest + width, false)];
            let inside = rest * (1.0 - 4.0 * f64::EPSILON)..rest + width;
            let seen = |t: f64| if inside.contains(&t) { 0.1 * width } else { f64::MAX };
            for tolerance in [1e-5, 1e-7, 1e-9] {
                let mut system = Pieces { ends: &ends, rate: &pulse, seen: &seen, start: 0.0, evaluations: 0 };
                let (y, _) = integral(&mut system, tolerance, rest + width + 1.0);
                let error = (y - 0.375).abs() / tolerance;
                // The digits of the time are what is left of those of the pulse.
                let digits = 10.0 * f64::EPSILON * rest / width / tolerance;
                std::println!(
                    "{width} {rest} {tolerance:e}: {error:.2} tolerances, {} evaluations",
                    system.evaluations
                );
                assert!(error < 5.0 + digits, "{width} {rest} {tolerance:e}: {error} tolerances");
            }
        }
    }
}

#[test]
fn adams_of_high_order_is_not_blind_behind_a_kink() {
    // cos t + c |t − 1|₊: by then its order is high.
    for bend in [0.01, 1.0, 100.0] {
        let rate = |piece: usize, t: f64| t.cos() + if piece == 1 { bend * (t - 1.0) } else { 0.0 };
        for tolerance in [1e-5, 1e-7, 1e-9] {
            let (ends, seen) = ([(1.0, false)], |_: f64| 0.3);
            let mut system = Pieces { ends: &ends, rate: &rate, seen: &seen, start: 0.0, evaluations: 0 };
            let (y, times) = integral(&mut system, tolerance, 1.5);
            let error = (y - (1.5_f64.sin() + bend * 0.125)).abs() / tolerance;
            std::println!("{bend} {tolerance:e}: {error:.2} tolerances, {} steps", times.len());
            assert!(error < 5.0, "{bend} {tolerance:e}: {error} tolerances");
        }
    }
}
