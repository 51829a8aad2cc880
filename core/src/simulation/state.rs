//! What a simulation remembers from one call to the next: method, clock, integrator, state shown.

use crate::base::memory::buffers;
use crate::base::scalar::Real;
use crate::dynamics::evaluation::Counters;
use crate::dynamics::indicators::Resolution;
use crate::integrate::{Abm4, Adams, Gauss6, Rk4};
use crate::model::ModelHead;
use crate::model::signal::CHANNEL_LEN;
use crate::simulation::time_error::{Rough, TimeError};

/// Integrator of a simulation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Method<R> {
    /// Classical Runge–Kutta of order 4, fixed step, 4 evaluations per step.
    Rk4 {
        /// Step, s.
        step: R,
    },
    /// Adams–Bashforth–Moulton of order 4 (PECE), fixed step, 2 evaluations per step.
    Abm4 {
        /// Step, s.
        step: R,
    },
    /// Adams–Bashforth–Moulton of variable order 1–12 and variable step, 2 evaluations per step: the method of
    /// Matlab's `ode113`, with its error control: |error| ≤ max(relative |y|, absolute) per step and component.
    Adams {
        /// Relative tolerance.
        relative: R,
        /// Absolute tolerance.
        absolute: R,
        /// Longest step, s; 0: none (no step is ever so long that a drive's motion within it would be missed).
        max_step: R,
        /// Length of the first step after a start, s; 0: chosen from the rates and the drives.
        first_step: R,
    },
    /// Implicit Gauss–Legendre of order 6, fixed step, 20 to 40 evaluations per step: for long runs, since the energy
    /// of a motion that could also run backwards does not drift (docs/design.md, section Integrators). Needs the feature
    /// `implicit`, which `std` includes.
    Gauss6 {
        /// Step, s.
        step: R,
    },
}

impl<R: Real> Method<R> {
    /// [`Method::Adams`] with these tolerances, which chooses all its steps by itself.
    pub fn adams(relative: R, absolute: R) -> Self {
        Method::Adams { relative, absolute, max_step: R::zero(), first_step: R::zero() }
    }
}

/// How far a simulation is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress<R> {
    pub(crate) method: Method<R>,
    /// Time of the state shown.
    pub(crate) time: R,
    pub(crate) clock: Clock<R>,
    pub(crate) adams: Adams<R>,
    pub(crate) rk4: Rk4<R>,
    pub(crate) abm4: Abm4<R>,
    pub(crate) gauss6: Gauss6<R>,
    pub(crate) step_limit: u64,
    pub(crate) time_error: TimeError<R>,
    pub(crate) impulse: [R; 3],
    pub(crate) counters: Counters,
    /// Largest error indicators over the steps of one call, and when the larger one was met.
    pub(crate) worst: Resolution<R>,
    pub(crate) worst_time: R,
    /// Largest estimated error of a step of that call (see [`TimeError::add`]), and when it was made.
    pub(crate) coarsest: R,
    pub(crate) coarsest_time: R,
    /// The same of a step before that call, which was estimated after its own.
    pub(crate) late: R,
    /// Upper estimates of the steps since a start, a jump or a shortened step.
    pub(crate) rough: Rough<R>,
    /// What `worst` belongs to.
    pub(crate) watch: Watch,
    /// The drive that the steps of that call missed most of.
    pub(crate) missed: Missed<R>,
    /// A channel was set to another position or speed than it had: its coordinate.
    pub(crate) torn: Option<usize>,
    /// A step has led to the state shown: what jumps there is shown as it was before.
    pub(crate) arrived: bool,
    /// When a channel was last set; NaN before. Pieces of channels that begin then did not hold still before.
    pub(crate) commanded: R,
    /// What the balance of energy is held against.
    pub(crate) balance: Balance<R>,
}

/// A drive that steps were too long for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Missed<R> {
    /// Its coordinate.
    pub(crate) coordinate: usize,
    /// The longest step that would have seen what it did, s; 0 if it jumped; `MAX` if nothing was missed.
    pub(crate) length: R,
    /// When the step began.
    pub(crate) time: R,
}

impl<R: Real> Missed<R> {
    pub(crate) fn nothing() -> Self {
        Missed { coordinate: 0, length: R::MAX, time: R::zero() }
    }
}

/// Energy at the first time it was asked for, and the largest kinetic energy met.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Balance<R> {
    /// Total − work; NaN before.
    pub(crate) first: R,
    /// Sum of the sizes of its parts: what rounding goes by.
    pub(crate) size: R,
    pub(crate) kinetic: R,
    /// Largest velocity of a link met, m/s or rad/s.
    pub(crate) speed: R,
    /// Total − work − `first`, and when that was.
    pub(crate) drift: R,
    pub(crate) time: R,
}

impl<R: Real> Balance<R> {
    pub(crate) fn unknown() -> Self {
        let zero = R::zero();
        Balance { first: R::NAN, size: zero, kinetic: zero, speed: zero, drift: zero, time: zero }
    }

    /// Adds energies of a state: total − work, and its parts, of which the first two are kinetic; and the links' velocities.
    pub(crate) fn add(&mut self, balance: R, parts: &[R; 6], velocities: &[R], time: R) {
        let [fluid, bodies, ..] = *parts;
        self.speed = velocities.iter().fold(self.speed, |m, v| m.max(v.abs()));
        self.kinetic = self.kinetic.max(fluid + bodies);
        self.size = self.size.max(parts.iter().fold(R::zero(), |s, x| s + x.abs()));
        if self.first.is_nan() {
            self.first = balance;
        }
        (self.drift, self.time) = (balance - self.first, time);
    }

    /// Largest drift that is not noticed: a thousandth of the kinetic energy, what a hundred times the tolerance of velocities that was
    /// asked for makes of it, and rounding.
    pub(crate) fn allowed(&self, tolerance: R) -> R {
        let error = if self.speed > R::zero() { R::lit(100.0) * tolerance / self.speed } else { R::zero() };
        let share = R::lit(1e-3) + error * (R::TWO + error);
        (share * self.kinetic).max(R::lit(256.0) * R::EPSILON * self.size)
    }
}

/// How the time shown came about.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Clock<R> {
    /// By so many full steps of a fixed-step method from `base`.
    Counted { base: R, steps: u64 },
    /// It was set: a variable-step method has still to begin there.
    Set,
    /// A variable-step method holds the state shown or a later one.
    Running,
}

impl<R: Real> Progress<R> {
    /// Largest drift of the energy that is not noticed.
    pub(crate) fn allowed_drift(&self) -> R {
        let tolerance = if let Method::Adams { absolute, .. } = self.method { absolute } else { R::zero() };
        self.balance.allowed(tolerance)
    }

    /// The next step starts anew from the time shown.
    pub(crate) fn set_clock(&mut self) {
        self.clock = match self.method {
            Method::Adams { .. } => Clock::Set,
            _ => Clock::Counted { base: self.time, steps: 0 },
        };
    }

    /// Whether a variable-step method has begun.
    pub(crate) fn runs(&self) -> bool {
        self.clock == Clock::Running
    }
}

/// What the largest indicators of a simulation belong to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Watch {
    /// No step since the state was set.
    Nothing,
    /// A call that is over: the next step starts anew.
    Past,
    /// The call that is under way.
    Present,
}

/// Numbers that the lengths of [`State`] follow from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateDims {
    state: usize,
    links: usize,
    boundaries: usize,
    channels: usize,
    coordinates: usize,
}

impl StateDims {
    pub(crate) fn of<R: Real>(head: &ModelHead<R>, coordinates: usize) -> StateDims {
        let p = &head.plan;
        StateDims {
            state: p.state_len,
            links: p.links,
            boundaries: p.links + p.walls,
            channels: head.channels,
            coordinates,
        }
    }
    fn integrator<R: Real>(&self) -> Option<usize> {
        let n = self.state;
        let lens =
            [Rk4::<R>::memory_len(n), Abm4::<R>::memory_len(n), Adams::<R>::memory_len(n), Gauss6::<R>::memory_len(n)];
        lens.into_iter().try_fold(0, |most, len| Some(most.max(len?)))
    }
}

buffers! {
    /// What a simulation remembers.
    pub(crate) struct State(d: StateDims) {
        /// The integrated state (see [`Sim::state`]) at the time shown.
        y: R = d.state,
        /// The state before the step under way.
        saved: R = d.state,
        /// Scratch of interpolation.
        rate: R = d.state,
        /// What is shown · 3n each.
        positions: R = 3 * d.links,
        velocities: R = 3 * d.links,
        /// Placements and headings at the last accepted state: no trial state may lie beyond another body · 4b + n.
        anchor: R = 4 * d.boundaries + d.links,
        /// u, u̇ of every coordinate shown, in pairs · 2c.
        joints: R = 2 * d.coordinates,
        /// Inputs of the channels · 8 each.
        commands: R = d.channels * CHANNEL_LEN,
        /// Memory of the integrator, which it lays out itself.
        integrator: R = d.integrator::<R>().unwrap_or(usize::MAX),
    }
}
