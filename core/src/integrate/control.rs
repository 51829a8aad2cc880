//! Error estimates of a trial step, and the order and step they lead to (Shampine & Gordon 1975,
//! chapter 7).
//!
//! Tested by `integrate/tests/accuracy.rs:adams_errors_follow_the_tolerance_at_the_cost_of_the_published_method`,
//! `integrate/tests/robustness.rs`.

use super::formula::{Formula, MAX_ORDER, moulton};
use crate::base::scalar::Real;

/// Error estimates of a trial step, in units of the tolerance (1 is allowed).
pub(super) struct Estimate<R> {
    /// Order of the trial step.
    order: usize,
    /// Of the step itself.
    pub step: R,
    /// Of orders k and k − 1, had the steps been equal.
    pub this: R,
    lower: R,
    /// Is order k − 1 as good?
    pub prefers_lower: bool,
}

impl<R: Real> Estimate<R> {
    /// From the largest weighted differences of orders k + 1, k and k − 1 at the predicted state.
    pub(super) fn new(formula: &Formula<R>, this: R, lower: R, lowest: R) -> Self {
        let (k, h) = (formula.order, formula.step.abs());
        let step = h * this * formula.error;
        let this = h * this * formula.sigma[2] * moulton(k);
        let lower = h * lower * formula.sigma[1] * moulton(k.saturating_sub(1));
        let lowest = h * lowest * formula.sigma[0] * moulton(k.saturating_sub(2));
        let prefers_lower = match k {
            1 => false,
            2 => lower <= R::HALF * this,
            _ => lower.max(lowest) <= this,
        };
        Estimate { order: k, step, this, lower, prefers_lower }
    }

    /// Order of the next step and its error if the step stayed the same. `higher` is the estimate at order
    /// k + 1, which means something after equal steps only.
    pub(super) fn next_order(&self, higher: Option<R>) -> (usize, R) {
        let k = self.order;
        let below = (k.saturating_sub(1).max(1), self.lower);
        let stay = (k, self.this);
        if self.prefers_lower {
            return below;
        }
        match higher {
            Some(higher) if k > 1 && self.lower <= self.this.min(higher) => below,
            Some(higher) if k == 1 && higher < R::HALF * self.this => (k + 1, higher),
            Some(higher) if 1 < k && k < MAX_ORDER && higher < self.this => (k + 1, higher),
            _ => stay,
        }
    }

    /// Factor of the step after the failure number `failures` (from 0) of the error test.
    pub(super) fn retry_factor(&self, failures: usize) -> R {
        if failures < 3 {
            return R::HALF;
        }
        // The order is 1 by now: the error goes with the square of the step.
        (R::HALF / self.this).sqrt().max(R::lit(1e-3)).min(R::HALF)
    }
}

/// Factor of the next step, of order `order`, if it would have the error `error` at the same length: 2 if
/// half the tolerance allows that, else 1, else ½ … 0.9.
pub(super) fn step_factor<R: Real>(order: usize, error: R) -> R {
    let doubled = (0..=order).fold(error, |e, _| e * R::TWO);
    if doubled <= R::HALF {
        R::TWO
    } else if error <= R::HALF {
        R::one()
    } else {
        (R::HALF / error).powf(R::one() / R::count(order + 1)).min(R::lit(0.9)).max(R::HALF)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_change_as_published() {
        // Shampine & Gordon 1975, section 7.4: from order 1 upwards if that halves the error; from a higher one downwards if that is
        // no worse than both others, upwards if that is better than both others.
        let next = |order: usize, this: f64, lower: f64, higher: Option<f64>| {
            Estimate { order, step: this, this, lower, prefers_lower: false }.next_order(higher)
        };
        assert_eq!(next(1, 1.0, f64::NAN, Some(0.49)), (2, 0.49));
        assert_eq!(next(1, 1.0, f64::NAN, Some(0.51)), (1, 1.0));
        assert_eq!(next(1, 1.0, f64::NAN, None), (1, 1.0));
        for order in [2, 5, MAX_ORDER] {
            assert_eq!(next(order, 1.0, 0.6, Some(0.7)), (order - 1, 0.6));
            assert_eq!(next(order, 1.0, 2.0, Some(3.0)), (order, 1.0));
            assert_eq!(next(order, 1.0, 0.6, None), (order, 1.0));
            let up = if order < MAX_ORDER { (order + 1, 0.9) } else { (order, 1.0) };
            assert_eq!(next(order, 1.0, 2.0, Some(0.9)), up);
        }
        let down = Estimate { order: 3, step: 1.0, this: 1.0, lower: 0.4, prefers_lower: true };
        assert_eq!(down.next_order(Some(0.1)), (2, 0.4));
    }
}
