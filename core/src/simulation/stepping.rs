//! Stepping: fixed steps, variable steps, dense output, and what is shown after each. A step that fails leaves time and
//! state as they were.
//!
//! Tested by `tests/integrators`, `tests/driving`.

use crate::base::memory::{copy, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::indicators::Resolution;
use crate::fluid::contact::{set_anchor, smallest_gap, swept_contact};
use crate::geometry::pose::Poses;
use crate::model::Formulation;
use crate::model::signal::Jump;
use crate::simulation::right_hand_side::{RightHandSide, split_state};
use crate::simulation::sim::Sim;
use crate::simulation::state::{Clock, Method, Missed, Watch};

impl<R: Real> Sim<'_, R> {
    /// One step of the method (for `Adams` one step of its own choice): as many evaluations as [`Method`] says, each O(N³) in the
    /// unknowns of the boundary system ([`crate::Plan::unknowns`]).
    ///
    /// # Errors
    /// `Contact`, `Singular`, `NonFiniteState`, `StepTooSmall`, `NoConvergence`; time and state are then as before.
    pub fn step(&mut self) -> Result<()> {
        self.begin_watch();
        match self.progress.method {
            Method::Rk4 { step } | Method::Abm4 { step } | Method::Gauss6 { step } => {
                let h = self.resolving(step);
                self.fixed_step(h, h == step)?;
            }
            Method::Adams { .. } => {
                self.adams_step(R::MAX)?;
                self.show_adams(self.progress.adams.time())?;
            }
        }
        Ok(())
    }

    /// Advances to exactly `t_end`; nothing is evaluated beyond it. A fixed-step method shortens its last step.
    ///
    /// # Errors
    /// As [`Sim::step`], and `TooManySteps` (see [`Sim::set_step_limit`]); the state shown is then that of the last step
    /// that succeeded, and the simulation may go on.
    pub fn advance(&mut self, t_end: R) -> Result<()> {
        self.advance_dense(t_end, t_end)
    }

    /// Shows the state at `t_out`; the integrator may run ahead, but not beyond `t_stop`. Cheaper than [`Sim::advance`] when
    /// output is wanted at many times: a variable-step method keeps its steps and interpolates. A fixed-step method ends
    /// with a shortened Runge–Kutta step, so output times should be multiples of its step.
    ///
    /// # Errors
    /// As [`Sim::advance`]; `PastTime` if `t_out` is before the time shown or after `t_stop`; `NotFinite`.
    pub fn advance_dense(&mut self, t_out: R, t_stop: R) -> Result<()> {
        for (what, t) in [("t", t_out), ("t_stop", t_stop)] {
            if !t.is_finite() {
                return Err(Error::new(Status::NotFinite).of(what, t.to_f64()));
            }
        }
        for (what, t, before) in [("t", t_out, self.progress.time), ("t_stop", t_stop, t_out)] {
            if t < before {
                return Err(Error::new(Status::PastTime).of(what, t.to_f64()).beside(before.to_f64()));
            }
        }
        if t_out == self.progress.time {
            return Ok(());
        }
        self.begin_watch();
        let mut left = self.progress.step_limit;
        match self.progress.method {
            Method::Adams { .. } => {
                // Where it is the same time but for rounding, no step is made: drives that end there would be held.
                let near = t_out - R::lit(4.0) * R::EPSILON * t_out.abs();
                while !self.progress.runs() || self.progress.adams.time() < near {
                    if let Err(e) = self.spend(&mut left).and_then(|()| self.adams_step(t_stop)) {
                        if self.progress.runs() && self.progress.adams.time() > self.progress.time {
                            self.show_adams(self.progress.adams.time())?;
                        }
                        return Err(e);
                    }
                }
                self.show_adams(t_out)
            }
            Method::Rk4 { step } | Method::Abm4 { step } | Method::Gauss6 { step } => {
                // Rounding of the time must not make a step of almost no length.
                let slack = step * R::lit(1e-6).max(R::lit(8.0) * R::EPSILON);
                let needed = -(-((t_out - self.progress.time - slack) / step)).floor().to_f64();
                if needed > left as f64 {
                    return Err(Error::new(Status::TooManySteps).of("steps", needed).beside(left as f64));
                }
                loop {
                    let rest = t_out - self.progress.time;
                    if rest <= slack {
                        break;
                    }
                    self.spend(&mut left)?;
                    let (wish, regular) = if rest + slack >= step { (step, true) } else { (rest, false) };
                    let h = self.resolving(wish);
                    self.fixed_step(h, regular && h == wish)?;
                    if !regular && h == wish {
                        break;
                    }
                }
                self.progress.time = t_out;
                Ok(())
            }
        }
    }

    /// Takes one step of those that are left.
    fn spend(&self, left: &mut u64) -> Result<()> {
        *left = left
            .checked_sub(1)
            .ok_or_else(|| Error::new(Status::TooManySteps).of("step_limit", self.progress.step_limit as f64))?;
        Ok(())
    }

    /// Forgets the integrator's past, as after a jump of the drives.
    pub fn restart(&mut self) {
        self.begin_watch();
        self.end_stretch();
        self.forget_steps();
        self.progress.set_clock();
    }

    /// A call begins: its first step forgets the indicators of the call before.
    pub(crate) fn begin_watch(&mut self) {
        if self.progress.watch == Watch::Present {
            self.progress.watch = Watch::Past;
        }
    }

    /// Keeps the indicators of a step's last evaluation if they are the largest of this call.
    fn watch(&mut self, t: R, here: Resolution<R>) {
        if self.progress.watch != Watch::Present {
            (self.progress.worst, self.progress.worst_time) = (Resolution::default(), t);
            self.progress.missed = Missed::nothing();
            (self.progress.coarsest, self.progress.coarsest_time) = (self.progress.late, self.progress.time);
            self.progress.late = R::zero();
            self.progress.watch = Watch::Present;
        }
        let worst = self.progress.worst;
        if here.bound() > worst.bound() {
            self.progress.worst_time = t;
        }
        self.progress.worst = worst.max(&here);
    }

    /// One step of a fixed-step method; `regular` steps keep the multistep history.
    fn fixed_step(&mut self, h: R, regular: bool) -> Result<()> {
        copy(self.state.saved, self.state.y);
        let (t, moved) = (self.progress.time, self.progress.watch != Watch::Nothing);
        self.meet_channels(t);
        if !regular {
            self.forget_rates();
        }
        let mut system = RightHandSide {
            model: self.model,
            evaluation: &mut self.evaluation,
            impulse: self.progress.impulse,
            anchor: Some(self.state.anchor),
            counters: &mut self.progress.counters,
            start: t,
        };
        let (y, memory) = (&mut *self.state.y, &mut *self.state.integrator);
        let stepped = match self.progress.method {
            Method::Abm4 { .. } if regular => self.progress.abm4.step(&mut system, t, h, y, memory),
            Method::Gauss6 { .. } if cfg!(feature = "implicit") => {
                self.progress.gauss6.step(&mut system, t, h, y, memory)
            }
            _ => self.progress.rk4.step(&mut system, t, h, y, memory),
        };
        let next = match self.progress.clock {
            // Counted, not summed: the rounding of h does not pile up.
            Clock::Counted { base, steps } if regular => base + R::lit((steps + 1) as f64) * h,
            _ => t + h,
        };
        let made = stepped.is_ok();
        let before = self.progress.arrived;
        let arrived = stepped.and_then(|()| {
            (self.progress.time, self.progress.arrived) = (next, true);
            self.show_checked()?;
            self.bounded()
        });
        let here = match arrived {
            Ok(here) => here,
            Err(e) => {
                copy(self.state.y, self.state.saved);
                (self.progress.time, self.progress.arrived) = (t, before);
                if made {
                    self.forget_steps();
                }
                self.progress.counters.rejected += 1;
                self.show()?;
                return Err(e);
            }
        };
        self.watch(next, here);
        self.note_drives(t, h, moved);
        self.progress.counters.steps += 1;
        self.note_error(regular, next, h);
        match &mut self.progress.clock {
            Clock::Counted { steps, .. } if regular => *steps += 1,
            _ => {
                self.forget_rates();
                self.progress.set_clock();
            }
        }
        if self.model.jump_at(next).0 != Jump::None {
            self.forget_rates();
        }
        Ok(())
    }

    /// Forgets what the fixed-step methods remember of earlier rates: they have jumped.
    pub(crate) fn forget_rates(&mut self) {
        self.end_stretch();
        self.progress.rk4.jump();
        self.progress.abm4.jump();
        self.progress.gauss6.jump();
    }

    /// Forgets what the fixed-step methods remember of earlier steps.
    fn forget_steps(&mut self) {
        self.progress.rk4.reset();
        self.progress.abm4.reset();
        self.progress.gauss6.reset();
    }

    /// One accepted step of the variable-step method.
    fn adams_step(&mut self, t_stop: R) -> Result<()> {
        let moved = self.progress.watch != Watch::Nothing;
        if self.progress.runs() {
            self.meet_channels(self.progress.adams.time());
        }
        let mut adams = self.progress.adams;
        if !self.progress.runs() {
            adams.start(self.progress.time, self.state.y, self.state.integrator)?;
            self.progress.clock = Clock::Running;
            // Trial states are measured from the placements of the state shown; the buffers may hold others.
            let (p, _) = split_state(&self.model, self.state.y);
            self.evaluation.place_only(&self.model, self.progress.time, p, &[]);
            set_anchor(self.state.anchor, self.evaluation.placement.poses, self.evaluation.placement.q);
        }
        let mut system = RightHandSide {
            model: self.model,
            evaluation: &mut self.evaluation,
            impulse: self.progress.impulse,
            anchor: Some(self.state.anchor),
            counters: &mut self.progress.counters,
            start: adams.time(),
        };
        let outcome = adams.step(&mut system, t_stop, self.state.integrator);
        self.progress.adams = adams;
        outcome.map_err(|e| self.contact_before(e))?;
        match self.bounded() {
            Ok(here) => self.watch(adams.time(), here),
            Err(e) => {
                // Back to where the step began, unless less than that is shown.
                let before = adams.time() - adams.last_step();
                if before > self.progress.time {
                    self.show_adams(before)?;
                }
                self.restart();
                return Err(e);
            }
        }
        self.note_drives(adams.time() - adams.last_step(), adams.last_step(), moved);
        self.note_error(true, adams.time(), adams.last_step());
        let y = self.progress.adams.state(self.state.integrator);
        let (p, _) = split_state(&self.model, y);
        self.evaluation.place_only(&self.model, self.progress.adams.time(), p, &[]);
        set_anchor(self.state.anchor, self.evaluation.placement.poses, self.evaluation.placement.q);
        Ok(())
    }

    /// A step that can be no shorter although boundaries all but touch is a contact.
    fn contact_before(&mut self, error: Error) -> Error {
        if error.status != Status::StepTooSmall {
            return error;
        }
        let (p, _) = split_state(&self.model, self.progress.adams.state(self.state.integrator));
        self.evaluation.place_only(&self.model, self.progress.adams.time(), p, &[]);
        let gap = smallest_gap(&self.model, Poses(self.evaluation.placement.poses));
        let least = self.model.boundaries.iter().fold(R::MAX, |m, b| m.min(b.reach));
        match gap.between {
            Some((a, b)) if gap.distance < R::lit(1e-5) * least => {
                Error::new(Status::Contact).at(a).with(b).of("gap", gap.distance.to_f64())
            }
            _ => error,
        }
    }

    /// Shows the variable-step solution at `t`, within the last step.
    fn show_adams(&mut self, t: R) -> Result<()> {
        let adams = self.progress.adams;
        if t == adams.time() {
            copy(self.state.y, adams.state(self.state.integrator));
        } else {
            adams.interpolate(t, self.state.integrator, self.state.y, self.state.rate)?;
        }
        (self.progress.time, self.progress.arrived) = (t, true);
        self.show()
    }

    /// Positions, velocities and joints of the state, after a check of where it leads.
    fn show_checked(&mut self) -> Result<()> {
        if !self.state.y.iter().all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        self.evaluation.kept.before = self.progress.arrived;
        let (p, dp) = split_state(&self.model, self.state.y);
        let zero = [R::zero(); 3];
        // A lone swimmer's rates come later, from its impulse.
        let dp = if self.model.head.plan.formulation == Formulation::LockedMomentum { &zero } else { dp };
        self.evaluation.place(&self.model, self.progress.time, p, dp)?;
        if let Some((a, b)) = swept_contact(
            &self.model,
            self.state.anchor,
            Poses(self.evaluation.placement.poses),
            self.evaluation.placement.q,
        ) {
            return Err(Error::new(Status::Contact).at(a).with(b));
        }
        if self.model.head.plan.formulation == Formulation::LockedMomentum {
            return self.show();
        }
        self.show_placed();
        Ok(())
    }

    /// Positions, velocities and joints of the state.
    pub(crate) fn show(&mut self) -> Result<()> {
        // The arrays belong to another state.
        (self.evaluation.kept.shown, self.evaluation.kept.before) = (false, self.progress.arrived);
        let model = self.model;
        if model.head.plan.formulation == Formulation::LockedMomentum {
            // The rates follow from the impulse: one factorization.
            self.refresh()?;
        } else {
            let (p, dp) = split_state(&model, self.state.y);
            self.evaluation.place(&model, self.progress.time, p, dp)?;
        }
        self.show_placed();
        Ok(())
    }

    /// The same, of what was placed last.
    fn show_placed(&mut self) {
        copy(self.state.positions, self.evaluation.placement.q);
        copy(self.state.velocities, self.evaluation.velocity.qd);
        for (k, (u, du)) in self.evaluation.coordinates.s.iter().zip(self.evaluation.coordinates.ds.iter()).enumerate()
        {
            put(self.state.joints, 2 * k, *u);
            put(self.state.joints, 2 * k + 1, *du);
        }
        if !self.progress.runs() {
            set_anchor(self.state.anchor, self.evaluation.placement.poses, self.evaluation.placement.q);
        }
    }

    /// Makes the buffers hold an evaluation of the state shown, accelerations included.
    pub(crate) fn refresh(&mut self) -> Result<()> {
        if self.evaluation.kept.shown {
            return Ok(());
        }
        self.evaluation.kept.before = self.progress.arrived;
        let model = self.model;
        let (p, dp) = split_state(&model, self.state.y);
        let zero = [R::zero(); 3];
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let dp = if locked { &zero } else { dp };
        let mut counters = self.progress.counters;
        self.evaluation.evaluate(&model, &self.progress.impulse, self.progress.time, p, dp, &mut counters)?;
        if locked && !model.head.tracks_work {
            self.evaluation.accelerate(&model, self.progress.time)?;
        }
        self.evaluation.kept.shown = true;
        Ok(())
    }
}
