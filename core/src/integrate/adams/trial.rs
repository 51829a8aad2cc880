//! One step of [`Adams`]: how long it may be, the trial, the judgement of its error, what follows from it.
//!
//! Tested by `integrate/tests/accuracy.rs`, `integrate/tests/robustness.rs`, `tests/drives`.

use super::{Adams, Buffers, columns, columns_mut};
use crate::base::memory::copy;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::integrate::control::{Estimate, step_factor};
use crate::integrate::formula::{Formula, MAX_ORDER, moulton};
use crate::integrate::system::{System, all_finite, evaluate, recoverable};

impl<R: Real> Adams<R> {
    /// Tries steps until one is accepted. `b` is changed in its trial parts only, until then.
    pub(super) fn search<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        t_stop: R,
        b: &mut Buffers<'_, R>,
    ) -> Result<()> {
        let remaining = (t_stop - self.time) - self.time_rest;
        if self.last_step * remaining < R::zero() {
            self.forget();
        }
        let sign = if remaining < R::zero() { -R::one() } else { R::one() };
        if self.proposed == R::zero() {
            self.proposed = self.first_step(remaining.abs(), b);
        }
        // Shorter steps would be lost even in the two parts of the time (where time counts, in the first), or are beyond hope
        // beside those made before.
        let lost = (R::lit(16.0) * self.time.abs()).max(self.proposed.min(remaining.abs()));
        let clock = if system.clocked() { self.time.abs() } else { R::zero() };
        let shortest = R::EPSILON * ((R::lit(16.0) * self.longest).max(clock)).max(R::EPSILON * lost);
        let shortest = shortest.max(R::TINY);
        let mut length = self.proposed.max(shortest);
        let mut failures = 0;
        loop {
            // A step ends where the rates jump.
            let reach = if R::TWO * length < remaining.abs() { self.time + R::TWO * length * sign } else { t_stop };
            let jump = system.next_jump(self.time, reach);
            let (stop, room) = jump.map_or((t_stop, remaining), |t| (t, (t - self.time) - self.time_rest));
            let (mut step, mut last) = self.fit(length, room);
            let seen = system.seen(self.time, step);
            if seen.abs() < step.abs() {
                // Unless rounding is all that is missing.
                (step, last) = if seen.abs() < shortest { (shortest * sign, false) } else { (seen, false) };
            }
            // Beside steps that were much longer all orders are the trapezoidal rule, and do not differ: the estimate is blind.
            if R::lit(3.0) * step.abs() < self.last_step.abs() {
                self.kink();
            }
            let time = if last { stop } else { self.time + (self.time_rest + step) };
            let formula = Formula::new(self.order, step, &self.spans);
            let trial = self.attempt(system, &formula, time, b);
            let (error, shorter) = match trial {
                Ok(estimate) if estimate.step <= R::one() => {
                    match evaluate(system, &mut self.counters, time, b.trial, b.trial_rate) {
                        Ok(()) => {
                            let wanted = (failures == 0 && step.abs() < length).then_some(length);
                            self.accept(&formula, &estimate, time, last, wanted, b);
                            self.jumped = system.jumps_at(self.time);
                            if self.jumped || system.kinks_at(self.time, step) {
                                self.kink();
                            }
                            return Ok(());
                        }
                        Err(e) => (Some(e), R::lit(0.25)),
                    }
                }
                Ok(estimate) => {
                    if estimate.prefers_lower {
                        self.order = self.order.saturating_sub(1).max(1);
                    }
                    (None, estimate.retry_factor(failures))
                }
                Err(e) => (Some(e), R::lit(0.25)),
            };
            self.counters.rejected += 1;
            let fatal = error.filter(|e| !recoverable(e));
            if fatal.is_some() || length <= shortest {
                let small = || Error::new(Status::StepTooSmall).of("time", self.time.to_f64());
                return Err(error.unwrap_or_else(small));
            }
            failures += 1;
            self.starting = false;
            if failures >= 3 {
                self.order = 1;
            }
            length = (step.abs() * shorter).max(shortest);
        }
    }

    /// Length of the first step: the one given, or that of Euler's step whose error, with the rate as the only scale known, is a
    /// sixteenth of the tolerance; at most a tenth of the way.
    fn first_step(&self, remaining: R, b: &Buffers<'_, R>) -> R {
        if self.first > R::zero() {
            return self.first.min(self.max_step);
        }
        let rate = b.rate.iter().zip(&*b.state).fold(R::zero(), |m, (f, y)| m.max(f.abs() / self.weight(*y)));
        // Without an end in sight a system at rest is looked at again after a second.
        let way = if remaining < R::MAX * R::HALF { remaining * R::lit(0.1) } else { R::one() };
        let length = way.min(self.max_step);
        let fastest = R::lit(4.0) * self.relative.sqrt() * rate;
        if length * fastest > R::one() { R::one() / fastest } else { length }
    }

    /// The error allowed in an unknown, from its value.
    fn weight(&self, y: R) -> R {
        (self.relative * y.abs()).max(self.absolute)
    }

    /// A step of about `length` towards the stop, `remaining` away, and whether it ends there. The last
    /// but one step is half the way, lest the last be very short.
    fn fit(&self, length: R, remaining: R) -> (R, bool) {
        let length = length.min(self.max_step);
        let room = remaining.abs();
        if room <= (R::lit(1.1) * length).min(self.max_step) {
            (remaining, true)
        } else if room < R::TWO * length {
            (remaining * R::HALF, false)
        } else {
            (if remaining < R::zero() { -length } else { length }, false)
        }
    }

    /// Predicts, evaluates, estimates the errors and corrects: the corrected state is in `trial`.
    fn attempt<S: System<R> + ?Sized>(
        &mut self,
        system: &mut S,
        formula: &Formula<R>,
        time: R,
        b: &mut Buffers<'_, R>,
    ) -> Result<Estimate<R>> {
        let h = formula.step;
        for ((p, column), (y, rest)) in b.trial.iter_mut().zip(columns(b.history)).zip(b.state.iter().zip(&*b.rest)) {
            *p = *y + (h * formula.predicted(column).slope + *rest);
        }
        all_finite(b.trial, Status::NonFiniteState, "state")?;
        evaluate(system, &mut self.counters, time, b.trial, b.trial_rate)?;

        // The largest weighted differences of orders k + 1, k, k − 1.
        let (mut this, mut lower, mut lowest) = (R::zero(), R::zero(), R::zero());
        let known = b.state.iter().zip(&*b.rest).zip(columns(b.history)).zip(&*b.trial_rate);
        let corrected = b.trial.iter_mut().zip(b.trial_rest.iter_mut()).zip(b.error.iter_mut());
        for ((((y, rest), column), f), ((new, new_rest), error)) in known.zip(corrected) {
            let predicted = formula.predicted(column);
            let jump = *f - predicted.rate;
            let scale = R::one() / self.weight(*y);
            this = this.max(jump.abs() * scale);
            lower = lower.max((predicted.last + jump).abs() * scale);
            lowest = lowest.max((predicted.before_last + jump).abs() * scale);
            let increment = h * (predicted.slope + formula.correct * jump) + *rest;
            *error = h * formula.error * jump;
            *new = *y + increment;
            *new_rest = increment - (*new - *y);
        }
        all_finite(b.trial, Status::NonFiniteState, "state")?;

        let mut estimate = Estimate::new(formula, this, lower, lowest);
        if self.doubtful > 0 {
            estimate.step = estimate.step.max(R::HALF * formula.step.abs() * this);
        }
        all_finite(&[estimate.step, estimate.this], Status::NonFiniteState, "error estimate")?;
        Ok(estimate)
    }

    /// Moves to the trial state, whose rate is in `trial_rate`, and chooses order and step of the next.
    /// `wanted`: a longer step that would have been tried if nothing had stopped it.
    fn accept(
        &mut self,
        formula: &Formula<R>,
        estimate: &Estimate<R>,
        time: R,
        last: bool,
        wanted: Option<R>,
        b: &mut Buffers<'_, R>,
    ) {
        let k = formula.order;
        // Equal steps count only as far as the differences of their order existed.
        let equal = if formula.step == self.last_step { self.equal_steps } else { 0 };
        self.equal_steps = if equal <= self.last_order { equal + 1 } else { equal };

        let mut higher = R::zero();
        for ((column, rate), y) in columns_mut(b.history).zip(&*b.trial_rate).zip(&*b.state) {
            higher = higher.max(formula.advance(column, *rate).abs() / self.weight(*y));
        }
        let higher = formula.step.abs() * higher * moulton(k + 1);
        copy(b.state, b.trial);
        copy(b.rest, b.trial_rest);
        copy(b.rate, b.trial_rate);
        let advance = self.time_rest + formula.step;
        self.time_rest = if last { R::zero() } else { advance - (time - self.time) };
        self.time = time;
        self.spans = formula.spans;
        (self.last_step, self.last_order) = (formula.step, k);
        self.longest = self.longest.max(formula.step.abs());
        self.counters.steps += 1;
        self.doubtful = self.doubtful.saturating_sub(1);

        self.starting &= !estimate.prefers_lower && k < MAX_ORDER;
        let factor = if self.starting {
            self.order = k + 1;
            R::TWO
        } else {
            let (order, error) = estimate.next_order((k < self.equal_steps).then_some(higher));
            self.order = order;
            step_factor(order, error)
        };
        self.proposed = factor * formula.step.abs();
        if let Some(wanted) = wanted {
            // It was not for its error that the step was short.
            self.proposed = self.proposed.max(wanted.min(R::lit(4.0) * formula.step.abs()));
        }
    }
}
