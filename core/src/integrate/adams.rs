//! Adams–Bashforth–Moulton of variable step and order, by differences (Shampine & Gordon 1975).
//!
//! Tested by `integrate/tests/accuracy.rs`, `integrate/tests/robustness.rs`, `tests/integrators`.

mod trial;

use super::formula::{COLUMNS, MAX_ORDER, dense};
use super::system::{Counters, System, all_finite, evaluate, finite, same_length};
use crate::base::fields::Fields;
use crate::base::memory::{buffers, copy, part};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};

/// Predicts at order k, evaluates, corrects at order k + 1, evaluates (PECE), k = 1 … 12: the method of
/// Matlab's `ode113`. Step and order follow the estimated error of each step,
/// `|eᵢ| ≤ max(relative |yᵢ|, absolute)` for every unknown i.
///
/// Time and state are summed with compensation, so that many short steps do not add up their rounding.
/// The cost of a step, besides its two evaluations, is about 15 k operations for each unknown and 2 k² for
/// the coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Adams<R> {
    relative: R,
    absolute: R,
    max_step: R,
    /// Length of the first step after a start; 0: chosen from the rates.
    first: R,
    dim: usize,
    time: R,
    /// The part of the time that `time` cannot hold.
    time_rest: R,
    /// Is the rate at the state known?
    prepared: bool,
    /// Has it jumped since it was evaluated?
    jumped: bool,
    /// Steps to come whose past reaches beyond a jump or a kink, or to steps that were much longer.
    doubtful: usize,
    /// Length proposed for the next step; 0 if it is to be estimated.
    proposed: R,
    /// Order of the next step.
    order: usize,
    /// Start-up: order and step grow with every step until an error estimate objects.
    starting: bool,
    /// The last step, signed; 0 after a start.
    last_step: R,
    /// The longest step since the start.
    longest: R,
    /// Order of the last step; 0 after a start.
    last_order: usize,
    /// Number of last steps that had the same length.
    equal_steps: usize,
    /// ψᵢ: lengths of the last i steps together.
    spans: [R; MAX_ORDER],
    counters: Counters,
}

buffers! {
    struct Buffers(dim: usize) {
        state: R = *dim,
        rate: R = *dim,
        /// The differences φ₁ … φₖ₊₂, unknown by unknown.
        history: R = dim.saturating_mul(COLUMNS),
        /// The part of the state that `state` cannot hold.
        rest: R = *dim,
        trial: R = *dim, trial_rest: R = *dim, trial_rate: R = *dim,
        /// Estimated error of the last trial step.
        error: R = *dim,
    }
}

impl<R: Real> Adams<R> {
    /// An integrator with the tolerances of each step's error: `relative` and `absolute`, in the units of
    /// the state, and optionally a longest step (a system at rest that is driven later could otherwise be
    /// stepped over).
    ///
    /// # Errors
    /// `BadTolerance` unless `relative ≥ 4 EPSILON` and `absolute > 0`, both finite; `BadStep`.
    pub fn new(relative: R, absolute: R, max_step: Option<R>) -> Result<Self> {
        let floor = R::lit(4.0) * R::EPSILON;
        if !relative.is_finite() || relative < floor {
            return Err(Error::new(Status::BadTolerance).of("relative", relative.to_f64()));
        }
        if !absolute.is_finite() || absolute < R::TINY {
            return Err(Error::new(Status::BadTolerance).of("absolute", absolute.to_f64()));
        }
        let max_step = max_step.unwrap_or(R::MAX);
        if !max_step.is_finite() || max_step < R::TINY {
            return Err(Error::new(Status::BadStep).of("max_step", max_step.to_f64()));
        }
        Ok(Adams {
            relative,
            absolute,
            max_step,
            first: R::zero(),
            dim: 0,
            time: R::zero(),
            time_rest: R::zero(),
            prepared: false,
            jumped: false,
            doubtful: 0,
            proposed: R::zero(),
            order: 1,
            starting: true,
            last_step: R::zero(),
            longest: R::zero(),
            last_order: 0,
            equal_steps: 0,
            spans: [R::zero(); MAX_ORDER],
            counters: Counters::default(),
        })
    }

    /// The same with a length of the first step after every start (`None`: chosen from the rates).
    ///
    /// # Errors
    /// `BadStep` unless it is positive and finite.
    pub fn with_first_step(mut self, first: Option<R>) -> Result<Self> {
        self.first = first.unwrap_or(R::zero());
        if first.is_some_and(|h| !h.is_finite() || h < R::TINY) {
            return Err(Error::new(Status::BadStep).of("first_step", self.first.to_f64()));
        }
        Ok(self)
    }

    /// Every field, in order, of an integrator for `unknowns` unknowns that may not have begun.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>, unknowns: usize) {
        let Adams {
            relative,
            absolute,
            max_step,
            first,
            dim,
            time,
            time_rest,
            prepared,
            jumped,
            doubtful,
            proposed,
            order,
            starting,
            last_step,
            longest,
            last_order,
            equal_steps,
            spans,
            counters,
        } = self;
        io.finite("relative", relative);
        io.finite("absolute", absolute);
        io.finite("max_step", max_step);
        io.at_least_zero("first", first);
        let settings = Adams::new(*relative, *absolute, Some(*max_step));
        io.require("tolerance", settings.is_ok() && first.is_finite());
        io.count("dim", dim, unknowns);
        io.require("dim", *dim == 0 || *dim == unknowns);
        io.finite("time", time);
        io.finite("time_rest", time_rest);
        io.flag("prepared", prepared);
        io.flag("jumped", jumped);
        io.count("doubtful", doubtful, MAX_ORDER + 1);
        io.at_least_zero("proposed", proposed);
        io.count("order", order, MAX_ORDER);
        io.require("order", *order > 0);
        io.flag("starting", starting);
        io.finite("last_step", last_step);
        io.at_least_zero("longest", longest);
        io.count("last_order", last_order, MAX_ORDER);
        io.count("equal_steps", equal_steps, COLUMNS);
        spans.iter_mut().for_each(|span| io.real("spans", span));
        counters.each(io);
    }

    /// Numbers of memory for `dim` unknowns; `None` if that cannot be addressed.
    pub fn memory_len(dim: usize) -> Option<usize> {
        Buffers::<R>::len(&dim)
    }

    /// Starts at the state `y` at time `t`, without evaluating anything yet. The counters go on.
    ///
    /// # Errors
    /// `NotFinite`, `MemoryTooSmall`; the integrator is then as it was.
    pub fn start(&mut self, t: R, y: &[R], memory: &mut [R]) -> Result<()> {
        finite(t, "time")?;
        all_finite(y, Status::NotFinite, "state")?;
        let b = Buffers::take(&y.len(), &mut { memory })?;
        copy(b.state, y);
        b.rest.fill(R::zero());
        b.rate.fill(R::NAN);
        (self.dim, self.time, self.time_rest, self.longest) = (y.len(), t, R::zero(), R::zero());
        self.restart();
        Ok(())
    }

    /// Starts anew at the present state: to be called when the right-hand side has jumped.
    pub fn restart(&mut self) {
        (self.prepared, self.jumped, self.doubtful) = (false, false, 0);
        self.forget();
    }

    /// The right-hand side has jumped at the present time, by much the same at all states near by, as when another force begins to act:
    /// the next step evaluates it once more, and takes the differences of the past as they were. If they mislead, the error
    /// estimate sees it, and order and step follow.
    pub fn jump(&mut self) {
        self.jumped = self.prepared;
        self.kink();
    }

    /// The rate's derivative has jumped at the present time. Formulas of high order that look across a kink make errors of up to a
    /// hundred times their estimates: until they no longer do, a step is judged as Euler's would be. The order grows by equal steps
    /// alone, since one that grew with every step would always look back so far.
    pub fn kink(&mut self) {
        self.doubtful = self.order + 1;
        self.starting = false;
    }

    /// Back to order 1 and a step to be estimated.
    fn forget(&mut self) {
        (self.proposed, self.order, self.starting) = (R::zero(), 1, true);
        (self.last_step, self.last_order, self.equal_steps) = (R::zero(), 0, 0);
    }

    /// Makes the rate at the present state known after a start; a step does it by itself. One evaluation,
    /// or none.
    ///
    /// # Errors
    /// Those of the right-hand side, `NonFiniteState`, `Length`, `MemoryTooSmall`; nothing is changed.
    pub fn prepare<S: System<R> + ?Sized>(&mut self, system: &mut S, memory: &mut [R]) -> Result<()> {
        same_length(self.dim, system.dim())?;
        let b = Buffers::take(&self.dim, &mut { memory })?;
        if self.prepared && !self.jumped {
            return Ok(());
        }
        evaluate(system, &mut self.counters, self.time, b.state, b.trial_rate)?;
        copy(b.rate, b.trial_rate);
        for (column, rate) in columns_mut(b.history).zip(&*b.rate) {
            if !self.prepared {
                *column = [R::zero(); COLUMNS];
            }
            column[0] = *rate;
        }
        (self.prepared, self.jumped) = (true, false);
        Ok(())
    }

    /// Time of the present state, rounded: a sum with compensation lies behind it, so that steps may be shorter than its
    /// last digit. A stop is met exactly, or if steps are that short to half of the digit.
    pub fn time(&self) -> R {
        self.time
    }

    /// The state at [`time`](Self::time).
    pub fn state<'m>(&self, memory: &'m [R]) -> &'m [R] {
        part(memory, 0, self.dim)
    }

    /// The rate at [`time`](Self::time); NaN between a start and the first step (see
    /// [`prepare`](Self::prepare)).
    pub fn rate<'m>(&self, memory: &'m [R]) -> &'m [R] {
        part(memory, self.dim, self.dim)
    }

    /// Number of unknowns since the last start; 0 before the first.
    pub(crate) fn state_len(&self) -> usize {
        self.dim
    }

    /// Length of the last step, signed; 0 after a start. The dense output is good from
    /// `time() - last_step()` to `time()`.
    pub fn last_step(&self) -> R {
        self.last_step
    }

    /// Order k of the last step's predictor (its result is of order k + 1); 0 after a start.
    pub fn last_order(&self) -> usize {
        self.last_order
    }

    /// Estimated local error of the last step, unknown by unknown: that of order k, though the result is of
    /// order k + 1. `None` after a start; meaningless after a step that failed.
    pub fn error<'m>(&self, memory: &'m [R]) -> Option<&'m [R]> {
        let before = self.dim.saturating_mul(COLUMNS + 6);
        (self.last_order > 0).then(|| part(memory, before, self.dim))
    }

    /// What has been done since the integrator was made.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Makes one step towards `t_stop`, never beyond it, with as many trials as it takes; a step that
    /// reaches `t_stop` ends there exactly. Does nothing at `t_stop`. `t_stop` may lie before the present
    /// time; turning round starts anew.
    ///
    /// A trial at which the right-hand side fails with `Contact`, `Singular` or `NonFiniteState`, or gives
    /// rates that are not finite, is repeated with a quarter of the step.
    ///
    /// # Errors
    /// `StepTooSmall` if the tolerance cannot be met or `t` has no digits for the step, else the error of the last trial; `NotFinite`,
    /// `Length`, `MemoryTooSmall`. The integrator is then as it was after its last step (but for the
    /// counters), and may go on.
    pub fn step<S: System<R> + ?Sized>(&mut self, system: &mut S, t_stop: R, memory: &mut [R]) -> Result<()> {
        finite(t_stop, "t_stop")?;
        if t_stop == self.time {
            return Ok(());
        }
        self.prepare(system, memory)?;
        let mut b = Buffers::take(&self.dim, &mut { memory })?;
        let mut next = *self;
        let outcome = next.search(system, t_stop, &mut b);
        match outcome {
            Ok(()) => *self = next,
            Err(_) => self.counters = next.counters,
        }
        outcome
    }

    /// The state and its rate at `t_out`, between the last two states (or slightly outside), to the order
    /// of the method. After a start, before any step: along the tangent.
    ///
    /// # Errors
    /// `NotFinite`, `Length`, `MemoryTooSmall`; nothing is written.
    pub fn interpolate(&self, t_out: R, memory: &[R], y_out: &mut [R], dydt_out: &mut [R]) -> Result<()> {
        finite(t_out, "t_out")?;
        same_length(self.dim, y_out.len())?;
        same_length(self.dim, dydt_out.len())?;
        if Self::memory_len(self.dim).is_none_or(|need| memory.len() < need) {
            return Err(Status::MemoryTooSmall.into());
        }
        let s = (t_out - self.time) - self.time_rest;
        if t_out == self.time || self.last_order == 0 {
            for ((y, f), (y0, f0)) in
                y_out.iter_mut().zip(dydt_out).zip(self.state(memory).iter().zip(self.rate(memory)))
            {
                (*y, *f) = (if t_out == self.time { *y0 } else { *y0 + s * *f0 }, *f0);
            }
            return Ok(());
        }
        let (w, r) = dense(s, &self.spans, self.last_order);
        let history = part(memory, 2 * self.dim, self.dim.saturating_mul(COLUMNS)).as_chunks::<COLUMNS>().0;
        for ((y, f), (column, y0)) in y_out.iter_mut().zip(dydt_out).zip(history.iter().zip(self.state(memory))) {
            let (mut slope, mut rate) = (R::zero(), R::zero());
            for ((phi, w), r) in column.iter().zip(&w).zip(&r).take(self.last_order + 1).rev() {
                slope += *w * *phi;
                rate += *r * *phi;
            }
            (*y, *f) = (*y0 + s * slope, rate);
        }
        Ok(())
    }
}

fn columns<R>(history: &[R]) -> core::slice::Iter<'_, [R; COLUMNS]> {
    history.as_chunks().0.iter()
}

fn columns_mut<R>(history: &mut [R]) -> core::slice::IterMut<'_, [R; COLUMNS]> {
    history.as_chunks_mut().0.iter_mut()
}
