//! Coefficients of the Adams formulas of variable step (Shampine & Gordon 1975, chapter 5; Krogh's
//! modified divided differences).
//!
//! Let h be the step from tₙ to tₙ₊₁, ψᵢ(n+1) the length of the i steps that end at tₙ₊₁, and φᵢ(n) the
//! modified divided difference of order i − 1 of the rates up to tₙ (φ₁ = f, and for a constant step the
//! backward differences ∇ⁱ⁻¹f). Then with αᵢ = h / ψᵢ(n+1) and βᵢ = Π_{j<i} ψⱼ(n+1) / ψⱼ(n)
//!
//! - predictor of order k: `p = y + h Σ_{i≤k} gᵢ βᵢ φᵢ`,
//! - predicted difference: `φᵉᵢ = Σ_{i≤j≤k} βⱼ φⱼ`,
//! - corrector of order k + 1: `y = p + h gₖ₊₁ (f(p) − φᵉ₁)`,
//! - new differences: `φᵢ = φᵉᵢ + (f − φᵉ₁)`.

use crate::base::memory::at;
use crate::base::scalar::Real;

/// Highest order of the predictor.
pub const MAX_ORDER: usize = 12;
/// Differences kept for each unknown: φ₁ … φₖ₊₂.
pub(super) const COLUMNS: usize = MAX_ORDER + 2;

/// |γ*ₖ|: the constants of the Adams–Moulton formulas of constant step, k = 0 … 13.
const MOULTON: [f64; COLUMNS] = [
    1.0,
    1.0 / 2.0,
    1.0 / 12.0,
    1.0 / 24.0,
    19.0 / 720.0,
    3.0 / 160.0,
    863.0 / 60480.0,
    275.0 / 24192.0,
    33953.0 / 3628800.0,
    8183.0 / 1036800.0,
    3250433.0 / 479001600.0,
    4671.0 / 788480.0,
    13695779093.0 / 2615348736000.0,
    2224234463.0 / 475517952000.0,
];

/// |γ*ₖ|; NaN beyond the table.
pub(super) fn moulton<R: Real>(k: usize) -> R {
    R::lit(at(&MOULTON, k))
}

/// The coefficients of one trial step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Formula<R> {
    /// Order k of the predictor, 1 … [`MAX_ORDER`].
    pub order: usize,
    /// h, signed.
    pub step: R,
    /// ψᵢ(n+1), i ≤ k.
    pub spans: [R; MAX_ORDER],
    /// βᵢ, i ≤ k.
    pub scale: [R; MAX_ORDER],
    /// gᵢ βᵢ, i ≤ k.
    pub predict: [R; MAX_ORDER],
    /// gₖ₊₁.
    pub correct: R,
    /// gₖ − gₖ₊₁: local error of order k, as a multiple of h (f(p) − φᵉ₁).
    pub error: R,
    /// σₖ₋₁, σₖ, σₖ₊₁ (σᵢ₊₁ = i αᵢ σᵢ): what the differences lose by the change of step.
    pub sigma: [R; 3],
}

impl<R: Real> Formula<R> {
    /// The formula of order `order` for a step `step`; `past` are the spans of the last step.
    pub(super) fn new(order: usize, step: R, past: &[R; MAX_ORDER]) -> Self {
        let one = R::one();
        let mut spans = [R::zero(); MAX_ORDER];
        let mut scale = [one; MAX_ORDER];
        let mut alpha = [one; MAX_ORDER];
        let (mut span, mut beta) = (step, one);
        let mut sigma = [one; 3];
        let outputs = spans.iter_mut().zip(&mut scale).zip(&mut alpha);
        for (i, (((s, b), a), old)) in outputs.zip(past).enumerate().take(order) {
            (*s, *b, *a) = (span, beta, step / span);
            sigma = [sigma[1], sigma[2], R::count(i + 1) * *a * sigma[2]];
            // Equal steps give ratios of exactly 1.
            beta *= span / *old;
            span = *old + step;
        }

        // gᵢ = c(i, 1), c(2, q) = 1 / (q (q + 1)), c(i, q) = c(i−1, q) − αᵢ₋₁ c(i−1, q+1).
        let mut c = [R::zero(); MAX_ORDER];
        for (q, c) in (1..).zip(&mut c) {
            *c = R::one() / (R::count(q) * R::count(q + 1));
        }
        let mut g = [one; MAX_ORDER + 1];
        g[1] = R::HALF;
        let mut valid = order;
        for (g, a) in g.iter_mut().skip(2).zip(alpha.iter().skip(1)).take(order.saturating_sub(1)) {
            eliminate(&mut c, valid, one, *a);
            valid = valid.saturating_sub(1);
            *g = c[0];
        }

        let mut predict = [R::zero(); MAX_ORDER];
        for ((p, g), b) in predict.iter_mut().zip(&g).zip(&scale) {
            *p = *g * *b;
        }
        let correct = at(&g, order);
        let error = at(&g, order.wrapping_sub(1)) - correct;
        Formula { order, step, spans, scale, predict, correct, error, sigma }
    }

    /// From the differences of one unknown: `(Σ gᵢ βᵢ φᵢ, φᵉ₁, φᵉₖ₋₁, φᵉₖ)`, the smallest terms first.
    /// φᵉₖ₋₁ is φᵉₖ for k = 1.
    pub(super) fn predicted(&self, column: &[R; COLUMNS]) -> Predicted<R> {
        let mut p = Predicted { slope: R::zero(), rate: R::zero(), before_last: R::zero(), last: R::zero() };
        let terms = column.iter().zip(&self.scale).zip(&self.predict).take(self.order);
        for (i, ((phi, beta), weight)) in terms.rev().enumerate() {
            p.slope += *weight * *phi;
            p.rate += *beta * *phi;
            if i == 0 {
                p.last = p.rate;
            }
            if i <= 1 {
                p.before_last = p.rate;
            }
        }
        p
    }

    /// Moves the differences of one unknown to tₙ₊₁, where its rate is `rate`; returns φₖ₊₂.
    pub(super) fn advance(&self, column: &mut [R; COLUMNS], rate: R) -> R {
        let jump = rate - self.predicted(column).rate;
        let mut sum = R::zero();
        for (phi, beta) in column.iter_mut().zip(&self.scale).take(self.order).rev() {
            sum += *beta * *phi;
            *phi = sum + jump;
        }
        column[0] = rate;
        let mut high = R::zero();
        if let Some([next, beyond]) = column.get_mut(self.order..self.order + 2) {
            high = jump - *next;
            (*next, *beyond) = (jump, high);
        }
        high
    }
}

/// See [`Formula::predicted`].
pub(super) struct Predicted<R> {
    /// `(p − y) / h`.
    pub slope: R,
    /// φᵉ₁.
    pub rate: R,
    /// φᵉₖ₋₁.
    pub before_last: R,
    /// φᵉₖ.
    pub last: R,
}

/// `c(q) ← a c(q) − b c(q+1)` for the first `valid` elements, of which one fewer is valid afterwards.
fn eliminate<R: Real>(c: &mut [R], valid: usize, a: R, b: R) {
    let mut above = R::zero();
    for c in c.iter_mut().take(valid).rev() {
        let old = *c;
        *c = a * old - b * above;
        above = old;
    }
}

/// Weights of the differences in the dense output at `t + s`, where `spans` are those of the last step,
/// of order `last_order`: `y(t + s) = y + s Σ wᵢ φᵢ`, `y'(t + s) = Σ rᵢ φᵢ`; returns `(w, r)`, zero
/// beyond the differences in use.
pub(super) fn dense<R: Real>(s: R, spans: &[R; MAX_ORDER], last_order: usize) -> ([R; COLUMNS], [R; COLUMNS]) {
    let mut w = [R::zero(); COLUMNS];
    let mut r = [R::zero(); COLUMNS];
    (w[0], r[0]) = (R::one(), R::one());
    let mut c = [R::zero(); COLUMNS];
    for (q, c) in (1..).zip(&mut c) {
        *c = R::one() / R::count(q);
    }
    let (mut shorter, mut product) = (R::zero(), R::one());
    let mut valid = last_order + 1;
    for ((w, r), span) in w.iter_mut().zip(&mut r).skip(1).zip(spans).take(last_order) {
        let a = (s + shorter) / *span;
        eliminate(&mut c, valid, a, s / *span);
        valid = valid.saturating_sub(1);
        product *= a;
        (*w, *r) = (c[0], product);
        shorter = *span;
    }
    (w, r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moulton_constants_satisfy_their_generating_recurrence() {
        // Σ_{i ≤ m} γ*ₘ₋ᵢ / (i + 1) = 0, γ*₀ = 1, all later ones negative.
        let gamma = |m: usize| if m == 0 { 1.0 } else { -MOULTON[m] };
        for m in 1..COLUMNS {
            let sum: f64 = (0..=m).map(|i| gamma(m - i) / (i + 1) as f64).sum();
            assert!(sum.abs() < 1e-15, "{m} {sum}");
        }
    }

    #[test]
    fn constant_steps_give_the_bashforth_constants() {
        let past: [f64; MAX_ORDER] = core::array::from_fn(|i| 0.25 * (i + 1) as f64);
        let f = Formula::new(5, 0.25, &past);
        let bashforth = [1.0, 1.0 / 2.0, 5.0 / 12.0, 3.0 / 8.0, 251.0 / 720.0];
        for (got, want) in f.predict.iter().zip(bashforth) {
            assert!((got - want).abs() < 1e-15);
        }
        assert!((f.correct - 95.0 / 288.0).abs() < 1e-15);
        assert!((f.error - moulton::<f64>(5)).abs() < 1e-15);
        assert_eq!(f.scale, [1.0; MAX_ORDER]);
        assert!(f.sigma.iter().all(|s: &f64| (s - 1.0).abs() < 1e-15));
    }
}
