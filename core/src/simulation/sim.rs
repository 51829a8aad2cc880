//! A simulation: the state of a model's motion, its integrator, and the stepping. One simulation per thread; any
//! number share one model. Nothing is allocated.
//!
//! Tested by `tests/driving`, `tests/channels`, `tests/allocation`.

use crate::base::memory::{at, copy, copy_some, part, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::dynamics::evaluation::{Counters, Dims, Evaluation, Kept};
use crate::dynamics::indicators::Resolution;
use crate::fluid::contact::first_misplaced;
use crate::geometry::pose::Poses;
use crate::integrate::{Abm4, Adams, Gauss6, Rk4, System};
use crate::linear::lu::Factorization;
use crate::model::signal::CHANNEL_LEN;
use crate::model::{Control, Formulation, Model, ModelHead};
use crate::simulation::right_hand_side::{RightHandSide, split_state};
use crate::simulation::state::{Balance, Clock, Method, Missed, Progress, State, StateDims, Watch};
use crate::simulation::time_error::{Rough, TimeError};

/// Steps that one call of [`Sim::advance`] may make, unless [`Sim::set_step_limit`] says otherwise.
pub const STEP_LIMIT: u64 = 1_000_000;

/// Length of a simulation's memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct SimRequirement {
    /// Number of reals.
    pub reals: usize,
}

impl SimRequirement {
    /// For any method.
    pub(crate) fn of<R: Real>(head: &ModelHead<R>, coordinates: usize) -> Option<SimRequirement> {
        let dims = Dims::of(head, coordinates);
        let state = State::<R>::len(&StateDims::of(head, coordinates))?;
        // The matrix is the largest buffer: its size decides whether the sum can be addressed.
        dims.ld.checked_mul(dims.unknowns.checked_add(dims.columns)?)?.checked_mul(4)?;
        Some(SimRequirement { reals: state.checked_add(Evaluation::<R>::len(&dims)?)? })
    }
}

/// Everything of a simulation that has a fixed size.
#[derive(Clone, Copy, Debug)]
pub struct SimHead<R> {
    /// How far it is: what it remembers.
    pub(crate) progress: Progress<R>,
    /// Fingerprint of its model; 0 before [`Sim::init`].
    model: u64,
    /// What its scratch holds.
    pub(crate) kept: Kept<R>,
}

impl<R: Real> SimHead<R> {
    /// Makes what a simulation remembers that of another one of its model, or of itself at an earlier time; the reals of
    /// [`Sim::remembered`] have to be copied with it. The scratch stays its own.
    pub fn put_back(&mut self, other: &SimHead<R>) {
        self.progress = other.progress;
        (self.kept.shown, self.kept.before) = (false, other.progress.arrived);
    }
}

/// A simulation in the caller's memory.
pub struct Sim<'a, R: Real> {
    pub(crate) model: Model<'a, R>,
    pub(crate) progress: &'a mut Progress<R>,
    pub(crate) state: State<'a, R>,
    pub(crate) evaluation: Evaluation<'a, R>,
}

impl<'a, R: Real> Sim<'a, R> {
    /// Memory needed for a simulation of a model.
    ///
    /// # Errors
    /// `SizeOverflow`.
    pub fn requirement(model: &Model<'_, R>) -> Result<SimRequirement> {
        SimRequirement::of(model.head, model.coordinates.len()).ok_or(Status::SizeOverflow.into())
    }

    /// How many of the reals, from the first on, a simulation remembers from one call to the next (the rest is scratch): with a
    /// copy of these and of the head, a simulation is put back to what it was, or made equal to another one of its model.
    ///
    /// # Errors
    /// `SizeOverflow`.
    pub fn remembered(model: &Model<'_, R>) -> Result<usize> {
        State::<R>::len(&StateDims::of(model.head, model.coordinates.len())).ok_or(Status::SizeOverflow.into())
    }

    /// Checks a method; the head of a simulation that has not begun.
    ///
    /// # Errors
    /// `BadStep`, `BadTolerance`; `Unsupported` for `Gauss6` without the feature `implicit`.
    pub fn head(method: Method<R>) -> Result<SimHead<R>> {
        if cfg!(not(feature = "implicit")) && matches!(method, Method::Gauss6 { .. }) {
            return Err(Error::new(Status::Unsupported).of("method", f64::NAN));
        }
        let adams = match method {
            Method::Rk4 { step } | Method::Abm4 { step } | Method::Gauss6 { step } => {
                if !(step.is_finite() && step > R::zero()) {
                    return Err(Error::new(Status::BadStep).of("step", step.to_f64()));
                }
                Adams::new(R::lit(1e-3), R::lit(1e-3), None)?
            }
            Method::Adams { relative, absolute, max_step, first_step } => {
                let given = |x: R| (x != R::zero()).then_some(x);
                Adams::new(relative, absolute, given(max_step))?.with_first_step(given(first_step))?
            }
        };
        let mut progress = Progress {
            method,
            time: R::zero(),
            clock: Clock::Set,
            adams,
            rk4: Rk4::new(),
            abm4: Abm4::new(),
            gauss6: Gauss6::new(),
            step_limit: STEP_LIMIT,
            time_error: TimeError::default(),
            impulse: [R::zero(); 3],
            counters: Counters::default(),
            worst: Resolution::default(),
            worst_time: R::zero(),
            coarsest: R::zero(),
            coarsest_time: R::zero(),
            late: R::zero(),
            rough: Rough::nothing(),
            watch: Watch::Nothing,
            missed: Missed::nothing(),
            torn: None,
            arrived: false,
            commanded: R::NAN,
            balance: Balance::unknown(),
        };
        progress.set_clock();
        Ok(SimHead { progress, model: 0, kept: Kept::default() })
    }

    /// Starts a simulation in the caller's memory at time 0 and the scene's initial state. O(N²) in pairs of boundaries that are close;
    /// one evaluation for a lone swimmer.
    ///
    /// # Errors
    /// `MemoryTooSmall`, `Overlap`, `OutsideTank`, `Singular`.
    pub fn init(model: Model<'a, R>, head: &'a mut SimHead<R>, reals: &'a mut [R]) -> Result<Self> {
        let need = Self::requirement(&model)?.reals;
        if reals.len() < need {
            return Err(Error::new(Status::MemoryTooSmall).of("length", reals.len() as f64));
        }
        reals.fill(R::zero());
        head.kept = Kept::default();
        head.model = model.fingerprint();
        let mut sim = Sim::view(model, head, reals)?;
        sim.evaluation.place_walls(&model);
        let n = model.head.plan.free_coordinates;
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let mut rates = [R::zero(); 3];
        for c in model.coordinates.iter().filter(|c| c.control != Control::Prescribed) {
            put(sim.state.y, c.free, c.start[0]);
            if locked {
                if let Some(r) = rates.get_mut(c.free) {
                    *r = c.start[1];
                }
            } else {
                put(sim.state.y, n + c.free, c.start[1]);
            }
        }
        // Misplacement first: it names what is wrong better than a contact does.
        let (p, dp) = split_state(&model, sim.state.y);
        let dp = if locked { &rates } else { dp };
        let placed = sim.evaluation.place(&model, R::zero(), p, dp);
        if let Some((a, b)) = first_misplaced(&model, Poses(sim.evaluation.placement.poses)) {
            return Err(if b == Place::Tank {
                Error::new(Status::OutsideTank).at(a)
            } else {
                Error::new(Status::Overlap).at(a).with(b)
            });
        }
        placed.map_err(|e| if e.status == Status::Contact { Error { status: Status::Overlap, ..e } } else { e })?;
        if locked {
            sim.progress.impulse = sim.evaluation.impulse_of_motion(&model, p, &rates)?;
        }
        sim.show()?;
        Ok(sim)
    }

    /// The view of a simulation that [`Sim::init`] set up in this memory, for this model. O(1).
    ///
    /// # Errors
    /// `BadHandle` if the simulation was set up for a model that differs in any value, or not at all; `MemoryTooSmall`.
    pub fn view(model: Model<'a, R>, head: &'a mut SimHead<R>, reals: &'a mut [R]) -> Result<Self> {
        let given = reals.len() as f64;
        let named = |e: Error| if e.status == Status::MemoryTooSmall { e.of("length", given) } else { e };
        let coordinates = model.coordinates.len();
        let SimHead { progress, model: own, kept } = head;
        if *own != model.fingerprint() {
            return Err(Error::new(Status::BadHandle).of("model", f64::NAN));
        }
        let rest = &mut { reals };
        let state = State::take(&StateDims::of(model.head, coordinates), rest).map_err(named)?;
        let evaluation = Evaluation::take(&Dims::of(model.head, coordinates), kept, rest).map_err(named)?;
        // What is remembered may have been put back (see `remembered`).
        copy(evaluation.coordinates.channels, state.commands);
        Ok(Sim { model, progress, state, evaluation })
    }

    /// The model.
    pub fn model(&self) -> Model<'a, R> {
        self.model
    }
    /// Time of the state shown, s.
    pub fn time(&self) -> R {
        self.progress.time
    }
    /// x, y, m, of every link's centre of mass and its heading θ, rad (3 per link).
    pub fn positions(&self) -> &[R] {
        self.state.positions
    }
    /// ẋ, ẏ, m/s, and θ̇, rad/s, of every link (3 per link).
    pub fn velocities(&self) -> &[R] {
        self.state.velocities
    }
    /// Counts since the start, of what stepping and [`Sim::rhs`] did (diagnostics are not counted).
    pub fn counters(&self) -> Counters {
        let mut c = self.progress.counters;
        if let Method::Adams { .. } = self.progress.method {
            let a = self.progress.adams.counters();
            (c.steps, c.rejected) = (a.steps, a.rejected);
        }
        c
    }
    /// Estimated errors of the steps made since the start or the last [`Sim::set_state`]: local errors, that is of each
    /// step by itself. What they grow to depends on the motion. Where it neither amplifies nor forgets errors, the sums over the
    /// coordinates plus those over the rates times the time that is left bound the error of the coordinates: measured, they are 2
    /// to 8 times (`Rk4`), 2 to 22 times (`Abm4`) and 3 to 400 times (`Adams`) as large, since errors of steps cancel in part.
    ///
    /// - `Adams`: of the formula below the one that is used.
    /// - `Abm4`: Milne's estimate, from the difference of predictor and corrector; not in the first three steps after a start,
    ///   which are Runge–Kutta.
    /// - `Rk4`: by comparison with a formula of order 7 through the rates known (see [`Rk4`]); lags one step behind, and
    ///   begins after seven equal steps.
    /// - Both, where a jump of the drives or a shortened step comes before that: by an embedded formula of order 2, which gives more
    ///   than the error.
    /// - `Gauss6`: none. Compare with half the step, or watch [`Sim::energy_drift`].
    ///
    /// No estimate takes an evaluation. None sees the error of space, for which there is [`Sim::resolution`].
    pub fn time_error(&self) -> TimeError<R> {
        self.progress.time_error
    }

    /// How many steps one call of [`Sim::advance`] or [`Sim::advance_dense`] may make; at first [`STEP_LIMIT`].
    ///
    /// # Errors
    /// `OutOfRange` for 0.
    pub fn set_step_limit(&mut self, steps: u64) -> Result<()> {
        if steps == 0 {
            return Err(Error::new(Status::OutOfRange).of("step_limit", 0.0));
        }
        self.progress.step_limit = steps;
        Ok(())
    }

    /// Who factorizes the boundary system from now on, for scenes of many bodies; at first, and after [`Sim::init`],
    /// [`Factorization::Own`]. The results differ by rounding. What faer takes: the rows and columns that are factorized anew with every
    /// evaluation (all but the fixed walls'), from 512 on; assembly, right-hand sides and all solves stay on the caller's thread
    /// (docs/design.md, section Several threads: on two threads it pays from about 2000 unknowns on). With faer an evaluation allocates and may panic, and it may fail
    /// with `OutOfMemory`. The C interface and the command do not offer it.
    ///
    /// # Errors
    /// `Unsupported` for faer without the feature `faer`; `OutOfRange` for no thread. The choice is then as it was.
    pub fn set_factorization(&mut self, by: Factorization) -> Result<()> {
        let by = by.checked()?;
        #[cfg(feature = "faer")]
        {
            self.evaluation.kept.factorization = by;
        }
        #[cfg(not(feature = "faer"))]
        let _ = by;
        Ok(())
    }

    /// Who factorizes the boundary system.
    pub fn factorization(&self) -> Factorization {
        self.evaluation.kept.factorization()
    }

    /// The integrated state: free coordinates, their rates (not for a lone swimmer, whose rates follow from its
    /// impulse), and last the work of the drives if anything is driven.
    pub fn state(&self) -> &[R] {
        self.state.y
    }

    /// Sets time and state (as [`Sim::state`] gives them) and forgets the integrator's past.
    ///
    /// # Errors
    /// `Length`, `NotFinite`, `Contact`; the simulation is then as it was.
    pub fn set_state(&mut self, t: R, y: &[R]) -> Result<()> {
        if y.len() != self.state.y.len() {
            return Err(Error::new(Status::Length).of("length", y.len() as f64));
        }
        if !t.is_finite() || !y.iter().all(|x| x.is_finite()) {
            return Err(Status::NotFinite.into());
        }
        copy(self.state.saved, self.state.y);
        let (before, arrived) = (self.progress.time, self.progress.arrived);
        self.progress.arrived = false;
        copy(self.state.y, y);
        self.progress.time = t;
        let mut shown = self.show();
        if shown.is_ok()
            && let Some((a, b)) = first_misplaced(&self.model, Poses(self.evaluation.placement.poses))
        {
            shown = Err(Error::new(Status::Contact).at(a).with(b));
        }
        if let Err(e) = shown {
            copy(self.state.y, self.state.saved);
            (self.progress.time, self.progress.arrived) = (before, arrived);
            self.show()?;
            return Err(e);
        }
        self.progress.watch = Watch::Nothing;
        self.progress.commanded = R::NAN;
        (self.progress.missed, self.progress.torn, self.progress.balance) =
            (Missed::nothing(), None, Balance::unknown());
        self.restart();
        (self.progress.time_error, self.progress.late) = (TimeError::default(), R::zero());
        Ok(())
    }

    /// Sets a channel: (t, u, u̇, ü) at both ends of the coming step, quintic in between (constant outside). For a torque these
    /// are ν, ν̇ and ν̈. What continues the piece before (u, u̇, ü of a motion, ν of a torque, within rounding) does not disturb the
    /// integrator, nor does the same piece again. Where ü or ν jumps, the fixed-step methods forget the past rates, and
    /// [`Method::Adams`] keeps step and order unless its error estimate objects. A motion whose u or u̇ jumps once it has begun is
    /// noticed as `DriveUnresolved`: it would take an impulse, which is not made. Only [`Sim::advance_dense`] may have looked past the
    /// present time; then the integrator starts anew.
    ///
    /// # Errors
    /// `Unsupported` if there is no such channel, `NotFinite`, `BadTable` if the times do not increase.
    pub fn set_channel(&mut self, channel: usize, from: [R; 4], to: [R; 4]) -> Result<()> {
        if !from.iter().chain(&to).all(|x| x.is_finite()) {
            return Err(Status::NotFinite.into());
        }
        if from[0] >= to[0] {
            return Err(Error::new(Status::BadTable).of("t", to[0].to_f64()));
        }
        if channel >= self.model.head.channels {
            return Err(Error::new(Status::Unsupported).of("channel", channel as f64));
        }
        let (mut old, mut new) = ([R::zero(); CHANNEL_LEN], [R::zero(); CHANNEL_LEN]);
        copy(&mut old, part(self.state.commands, channel * CHANNEL_LEN, CHANNEL_LEN));
        copy_some(&mut new, &from);
        copy_some(part_mut(&mut new, 4, 4), &to);
        if old == new {
            return Ok(());
        }
        self.before_command();
        copy(part_mut(self.state.commands, channel * CHANNEL_LEN, CHANNEL_LEN), &new);
        copy(self.evaluation.coordinates.channels, self.state.commands);
        (self.evaluation.kept.shown, self.progress.arrived) = (false, false);
        self.follow_channel(channel, &old, &new);
        Ok(())
    }

    /// The right-hand side of the state's equation, for the user's own integrator: one evaluation. `y` and `ydot` as [`Sim::state`]. The
    /// simulation's own state does not change.
    ///
    /// # Errors
    /// `Length`, `NonFiniteState`, `Contact`, `Singular`.
    pub fn rhs(&mut self, t: R, y: &[R], ydot: &mut [R]) -> Result<()> {
        let n = self.state.y.len();
        for given in [y.len(), ydot.len()] {
            if given != n {
                return Err(Error::new(Status::Length).of("length", given as f64));
            }
        }
        // The user's integrator may jump: no state is asked where it came from.
        let mut system = RightHandSide {
            model: self.model,
            evaluation: &mut self.evaluation,
            impulse: self.progress.impulse,
            anchor: None,
            counters: &mut self.progress.counters,
            start: t,
        };
        let result = system.rhs(t, y, ydot);
        if result.is_err() {
            ydot.fill(R::zero());
        }
        result
    }

    /// u and u̇ of every joint, in the order of the links they move (`joint_count` each).
    pub fn joint_values(&self, u: &mut [R], du: &mut [R]) {
        let joints = self.model.coordinates.iter().enumerate().filter(|(_, c)| c.component == 3);
        for ((u, du), (k, _)) in u.iter_mut().zip(du.iter_mut()).zip(joints) {
            (*u, *du) = (at(self.state.joints, 2 * k), at(self.state.joints, 2 * k + 1));
        }
    }
}
