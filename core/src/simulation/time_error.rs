//! What the integrators' estimates of their local errors come to, in the units of the coordinates.
//!
//! Tested by `tests/integrators.rs:estimated_time_errors_tell_lengths_and_angles_within_a_known_factor`.

use crate::base::fields::Fields;
use crate::base::memory::at;
use crate::base::scalar::Real;
use crate::model::{Control, Formulation, Model};

/// Estimated local errors of time integration (see [`crate::Sim::time_error`]): each the largest over the free coordinates of its
/// kind, 0 if there are none. Lengths are the x and y of bodies and what sliders slide, angles the headings of bodies and hinges.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TimeError<R> {
    /// Of lengths in the last step that could be estimated, m; NaN if there was none.
    pub length: R,
    /// Of angles, rad; NaN as above.
    pub angle: R,
    /// Of the rates of lengths, m/s; NaN as above; 0 for a lone swimmer, whose rates are not integrated.
    pub speed: R,
    /// Of the rates of angles, rad/s; NaN and 0 as above.
    pub spin: R,
    /// Sum over all steps that could be estimated, m; NaN if there was none.
    pub length_sum: R,
    /// The same of angles, rad.
    pub angle_sum: R,
    /// Of the rates of lengths, m/s.
    pub speed_sum: R,
    /// Of the rates of angles, rad/s.
    pub spin_sum: R,
    /// Number of steps that could not be estimated, and are missing in the sums.
    pub unknown: u64,
}

impl<R: Real> Default for TimeError<R> {
    fn default() -> Self {
        let nan = R::NAN;
        TimeError {
            length: nan,
            angle: nan,
            speed: nan,
            spin: nan,
            length_sum: nan,
            angle_sum: nan,
            speed_sum: nan,
            spin_sum: nan,
            unknown: 0,
        }
    }
}

/// Errors of one step, or their sums: of lengths, angles, their rates; and the largest error of a coordinate, with that of its rate over
/// another step, in reaches of the link that it moves or in radians.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct StepError<R> {
    kinds: [R; 4],
    pub(crate) relative: R,
}

impl<R: Real> StepError<R> {
    pub(crate) fn zero() -> Self {
        StepError { kinds: [R::zero(); 4], relative: R::zero() }
    }

    /// Of a step of length `h` whose state has the free coordinates of a model, then (if it has) their rates.
    pub(crate) fn of(error: &[R], h: R, model: &Model<'_, R>) -> Self {
        let n = model.head.plan.free_coordinates;
        let rates = model.head.plan.formulation != Formulation::LockedMomentum;
        let zero = R::zero();
        let ([mut length, mut angle, mut speed, mut spin], mut relative) = ([zero; 4], zero);
        for c in model.coordinates.iter().filter(|c| c.control != Control::Prescribed) {
            let own = at(error, c.free).abs();
            let rate = if rates { at(error, n + c.free).abs() } else { zero };
            if model.is_angle(c) {
                (angle, spin) = (angle.max(own), spin.max(rate));
                relative = relative.max(own + rate * h.abs());
            } else {
                (length, speed) = (length.max(own), speed.max(rate));
                relative = relative.max((own + rate * h.abs()) / model.reach_of(c));
            }
        }
        StepError { kinds: [length, angle, speed, spin], relative }
    }
}

/// Upper estimates of the steps since the integrator knew nothing of the past: they count where no better ones come.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Rough<R> {
    pub(crate) last: StepError<R>,
    pub(crate) sum: StepError<R>,
    pub(crate) steps: u64,
    /// Better ones have come.
    pub(crate) better: bool,
}

impl<R: Real> StepError<R> {
    fn each(&mut self, io: &mut impl Fields<R>) {
        let StepError { kinds, relative } = self;
        kinds.iter_mut().chain([relative]).for_each(|x| io.real("step_error", x));
    }
}

impl<R: Real> Rough<R> {
    /// Every field, in order.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>) {
        let Rough { last, sum, steps, better } = self;
        last.each(io);
        sum.each(io);
        io.total("rough_steps", steps);
        io.flag("better", better);
    }

    pub(crate) fn nothing() -> Self {
        Rough { last: StepError::zero(), sum: StepError::zero(), steps: 0, better: false }
    }

    pub(crate) fn add(&mut self, error: StepError<R>) {
        (self.last, self.steps) = (error, self.steps + 1);
        for (sum, x) in self.sum.kinds.iter_mut().zip(error.kinds) {
            *sum += x;
        }
        self.sum.relative = self.sum.relative.max(error.relative);
    }
}

impl<R: Real> TimeError<R> {
    /// Every field, in order.
    pub(crate) fn each(&mut self, io: &mut impl Fields<R>) {
        let TimeError { length, angle, speed, spin, length_sum, angle_sum, speed_sum, spin_sum, unknown } = self;
        for x in [length, angle, speed, spin, length_sum, angle_sum, speed_sum, spin_sum] {
            io.real("time_error", x);
        }
        io.total("unknown", unknown);
    }

    /// Adds a step.
    pub(crate) fn add(&mut self, error: &StepError<R>) {
        self.add_sum(error, error);
    }

    /// Adds steps that had been counted as unknown.
    pub(crate) fn add_rough(&mut self, rough: &Rough<R>) {
        self.unknown = self.unknown.saturating_sub(rough.steps);
        self.add_sum(&rough.last, &rough.sum);
    }

    fn add_sum(&mut self, last: &StepError<R>, sum: &StepError<R>) {
        [self.length, self.angle, self.speed, self.spin] = last.kinds;
        let sums = [&mut self.length_sum, &mut self.angle_sum, &mut self.speed_sum, &mut self.spin_sum];
        for (total, x) in sums.into_iter().zip(sum.kinds) {
            *total = if total.is_nan() { x } else { *total + x };
        }
    }
}
