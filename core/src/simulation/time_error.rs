//! What the integrators' estimates of their local errors come to, in the units of the coordinates.

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
    /// Sum over all steps that could be estimated, m.
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
        let (nan, zero) = (R::NAN, R::zero());
        TimeError {
            length: nan,
            angle: nan,
            speed: nan,
            spin: nan,
            length_sum: zero,
            angle_sum: zero,
            speed_sum: zero,
            spin_sum: zero,
            unknown: 0,
        }
    }
}

impl<R: Real> TimeError<R> {
    /// Adds a step of length `h` whose state has the free coordinates of a model, then (if it has) their rates. Returns the largest
    /// error of a coordinate, with that of its rate over another step, in reaches of the link that it moves or in radians; 0 if the
    /// step could not be estimated.
    pub(crate) fn add(&mut self, error: Option<&[R]>, h: R, model: &Model<'_, R>) -> R {
        let Some(error) = error else {
            self.unknown += 1;
            return R::zero();
        };
        let n = model.head.plan.free_coordinates;
        let rates = model.head.plan.formulation != Formulation::LockedMomentum;
        let zero = R::zero();
        let mut relative = zero;
        (self.length, self.angle, self.speed, self.spin) = (zero, zero, zero, zero);
        for c in model.coordinates.iter().filter(|c| c.control != Control::Prescribed) {
            let own = at(error, c.free).abs();
            let rate = if rates { at(error, n + c.free).abs() } else { zero };
            if model.is_angle(c) {
                (self.angle, self.spin) = (self.angle.max(own), self.spin.max(rate));
                relative = relative.max(own + rate * h.abs());
            } else {
                (self.length, self.speed) = (self.length.max(own), self.speed.max(rate));
                relative = relative.max((own + rate * h.abs()) / model.reach_of(c));
            }
        }
        self.length_sum += self.length;
        self.angle_sum += self.angle;
        self.speed_sum += self.speed;
        self.spin_sum += self.spin;
        relative
    }
}
