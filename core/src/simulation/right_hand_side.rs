//! The equations of motion as an integrator sees them: ẏ = f(t, y), and what no trial state may do.
//!
//! Tested by `tests/driving`, `tests/conservation`.

use crate::base::memory::{at, copy, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::evaluation::{Counters, Evaluation};
use crate::fluid::contact::{first_misplaced, swept_contact};
use crate::geometry::pose::Poses;
use crate::integrate::System;
use crate::model::signal::{Jump, Seen};
use crate::model::{Control, CoordinateRecord, Formulation, Model};

/// The equations of motion as an integrator sees them.
pub(crate) struct RightHandSide<'s, 'a, R: Real> {
    pub(crate) model: Model<'a, R>,
    pub(crate) evaluation: &'s mut Evaluation<'a, R>,
    pub(crate) impulse: [R; 3],
    /// Placements at the last accepted state: no trial state may lie beyond another body. `None` if there is no such state;
    /// then no body may lie inside another.
    pub(crate) anchor: Option<&'s [R]>,
    pub(crate) counters: &'s mut Counters,
    /// Beginning of the step: what jumps there is taken as it is after it, and at any later time as before.
    pub(crate) start: R,
}

impl<R: Real> RightHandSide<'_, '_, R> {
    /// Splits a state into free coordinates and their rates (none for a lone swimmer: they follow from the impulse).
    fn parts<'y>(&self, y: &'y [R]) -> (&'y [R], &'y [R]) {
        split_state(&self.model, y)
    }

    fn rates(&mut self, t: R, y: &[R], dydt: &mut [R]) -> Result<()> {
        let model = self.model;
        let (p, dp) = self.parts(y);
        let n = model.head.plan.free_coordinates;
        if model.head.plan.formulation == Formulation::Kirchhoff {
            // Nothing to meet, no drive.
            let accelerations = self.evaluation.evaluate_lone(&model, p, dp, self.counters)?;
            copy(part_mut(dydt, 0, n), dp);
            copy(part_mut(dydt, n, n), &accelerations);
            return Ok(());
        }
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let zero = [R::zero(); 3];
        let dp = if locked { &zero } else { dp };
        self.evaluation.evaluate(&model, &self.impulse, t, p, dp, self.counters)?;
        let poses = Poses(self.evaluation.placement.poses);
        let contact = match self.anchor {
            Some(anchor) => swept_contact(&model, anchor, poses, self.evaluation.placement.q),
            None => first_misplaced(&model, poses),
        };
        if let Some((a, b)) = contact {
            return Err(Error::new(Status::Contact).at(a).with(b));
        }
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            put(dydt, c.free, at(self.evaluation.coordinates.ds, i));
            if !locked {
                put(dydt, n + c.free, at(self.evaluation.coordinates.dds, i));
            }
        }
        if model.head.tracks_work {
            let power = self.evaluation.power(&model, t);
            if let Some(last) = dydt.last_mut() {
                *last = power;
            }
        }
        Ok(())
    }
}

pub(crate) fn split_state<'y, R: Real>(model: &Model<'_, R>, y: &'y [R]) -> (&'y [R], &'y [R]) {
    let n = model.head.plan.free_coordinates;
    let rates = if model.head.plan.formulation == Formulation::LockedMomentum { &[] } else { part(y, n, n) };
    (part(y, 0, n), rates)
}

impl<R: Real> System<R> for RightHandSide<'_, '_, R> {
    fn dim(&self) -> usize {
        self.model.head.plan.state_len
    }

    fn rhs(&mut self, t: R, y: &[R], dydt: &mut [R]) -> Result<()> {
        self.evaluation.kept.before = t > self.start;
        let outcome = self.rates(t, y, dydt);
        self.evaluation.kept.before = false;
        outcome
    }

    fn clocked(&self) -> bool {
        self.model.clocked()
    }

    fn seen(&self, t: R, h: R) -> R {
        self.model.seen(Seen::Roughly, t, h, self.evaluation.coordinates.channels).length
    }

    fn next_jump(&self, t: R, end: R) -> Option<R> {
        self.model.next_jump(t, end, self.evaluation.coordinates.channels).map(|(t, _)| t)
    }

    fn kinks_at(&self, t: R, h: R) -> bool {
        self.model.kinks_at(t, h)
    }

    fn jumps_at(&self, t: R) -> bool {
        self.model.jump_at(t).0 != Jump::None
    }

    /// The reach of the link that a coordinate moves, or a radian; for a rate that it covers within the step.
    fn scale(&self, unknown: usize, h: R) -> Option<R> {
        let (n, model) = (self.model.head.plan.free_coordinates, &self.model);
        let rates = model.head.plan.formulation != Formulation::LockedMomentum;
        let (free, time) = match unknown.checked_sub(n) {
            Some(rate) if rates => (rate, h.abs()),
            _ => (unknown, R::one()),
        };
        let own = |c: &&CoordinateRecord<R>| c.control != Control::Prescribed && c.free == free;
        // The work of the drives acts on nothing.
        let Some(c) = model.coordinates.iter().find(own) else { return Some(R::MAX) };
        Some(if model.is_angle(c) { R::one() } else { model.reach_of(c) } / time)
    }
}
