//! A simulation: the state of a model's motion, its integrator, and the stepping. One simulation per thread; any
//! number share one model. Nothing is allocated.

use crate::contact::{first_misplaced, swept_contact};
use crate::dynamics::{Counters, Dims, Work};
use crate::integrate::{Abm4, Adams, Rk4, System};
use crate::model::{Control, Formulation, Model, ModelHead};
use crate::nystrom::Poses;
use crate::scalar::Real;
use crate::signal::CHANNEL_LEN;
use crate::status::{Error, Place, Result, Status};
use crate::workspace::{at, buffers, copy, part, put};

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
    },
}

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
        Some(SimRequirement { reals: state.checked_add(Work::<R>::len(&dims)?)? })
    }
}

/// Everything of a simulation that has a fixed size.
#[derive(Clone, Copy, Debug)]
pub struct SimHead<R> {
    method: Method<R>,
    /// Time of the state shown.
    pub(crate) time: R,
    /// Time of the last full step of a fixed-step method, and how many steps led there from `base`.
    base: R,
    step_count: u64,
    adams: Adams<R>,
    abm4: Abm4<R>,
    pub(crate) impulse: [R; 3],
    pub(crate) counters: Counters,
    /// The buffers hold an evaluation of the state shown.
    pub(crate) fresh: bool,
    /// A variable-step integrator holds the state shown or a later one.
    started: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct StateDims {
    state: usize,
    links: usize,
    boundaries: usize,
    channels: usize,
    coordinates: usize,
}

impl StateDims {
    fn of<R: Real>(head: &ModelHead<R>, coordinates: usize) -> StateDims {
        let p = &head.plan;
        StateDims {
            state: p.state_len,
            links: p.links,
            boundaries: p.links + p.walls,
            channels: head.channels,
            coordinates,
        }
    }
    fn work<R: Real>(&self) -> Option<usize> {
        let lens = [Rk4::work_len(self.state), Abm4::<R>::work_len(self.state), Adams::<R>::work_len(self.state)];
        lens.into_iter().try_fold(0, |most, len| Some(most.max(len?)))
    }
}

buffers! {
    /// What a simulation remembers.
    pub(crate) struct State(d: StateDims) {
        y: d.state,
        saved: d.state,
        rate: d.state,
        positions: 3 * d.links,
        velocities: 3 * d.links,
        anchor: 4 * d.boundaries,
        joints: 2 * d.coordinates,
        commands: d.channels * CHANNEL_LEN,
        integrator: d.work::<R>().unwrap_or(usize::MAX),
    }
}

/// A simulation in the caller's memory.
pub struct Sim<'a, R> {
    pub(crate) model: Model<'a, R>,
    pub(crate) head: &'a mut SimHead<R>,
    pub(crate) state: State<'a, R>,
    pub(crate) work: Work<'a, R>,
}

/// The equations of motion as an integrator sees them.
struct Motion<'s, 'a, R> {
    model: Model<'a, R>,
    work: &'s mut Work<'a, R>,
    impulse: [R; 3],
    /// Poses at the last accepted state: no trial state may lie beyond another body.
    anchor: &'s [R],
    counters: &'s mut Counters,
}

impl<R: Real> Motion<'_, '_, R> {
    /// Splits a state into free coordinates and their rates (none for a lone swimmer: they follow from the impulse).
    fn parts<'y>(&self, y: &'y [R]) -> (&'y [R], &'y [R]) {
        split_state(&self.model, y)
    }
}

pub(crate) fn split_state<'y, R: Real>(model: &Model<'_, R>, y: &'y [R]) -> (&'y [R], &'y [R]) {
    let n = model.head.plan.free_coordinates;
    let rates = if model.head.plan.formulation == Formulation::LockedMomentum { &[] } else { part(y, n, n) };
    (part(y, 0, n), rates)
}

impl<R: Real> System<R> for Motion<'_, '_, R> {
    fn dim(&self) -> usize {
        self.model.head.plan.state_len
    }

    fn rhs(&mut self, t: R, y: &[R], dydt: &mut [R]) -> Result<()> {
        let model = self.model;
        let (p, dp) = self.parts(y);
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let zero = [R::zero(); 3];
        let dp = if locked { &zero } else { dp };
        self.work.evaluate(&model, &self.impulse, t, p, dp, self.counters)?;
        if let Some((a, b)) = swept_contact(&model, Poses(self.anchor), Poses(self.work.poses)) {
            return Err(Error::new(Status::Contact).at(a).with(b));
        }
        let n = model.head.plan.free_coordinates;
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            put(dydt, c.free, at(self.work.ds, i));
            if !locked {
                put(dydt, n + c.free, at(self.work.dds, i));
            }
        }
        if model.head.tracks_work {
            let power = self.work.power(&model, t);
            if let Some(last) = dydt.last_mut() {
                *last = power;
            }
        }
        Ok(())
    }
}

/// Borrows a `Sim`'s parts as the equations of motion.
macro_rules! motion {
    ($sim:expr) => {
        Motion {
            model: $sim.model,
            work: &mut $sim.work,
            impulse: $sim.head.impulse,
            anchor: &*$sim.state.anchor,
            counters: &mut $sim.head.counters,
        }
    };
}

impl<'a, R: Real> Sim<'a, R> {
    /// Memory needed for a simulation of a model.
    ///
    /// # Errors
    /// `SizeOverflow`.
    pub fn requirement(model: &Model<'_, R>) -> Result<SimRequirement> {
        SimRequirement::of(model.head, model.coordinates.len()).ok_or(Status::SizeOverflow.into())
    }

    /// Checks a method; the head of a simulation that has not begun.
    ///
    /// # Errors
    /// `BadStep`, `BadTolerance`.
    pub fn head(method: Method<R>) -> Result<SimHead<R>> {
        let (relative, absolute) = match method {
            Method::Rk4 { step } | Method::Abm4 { step } => {
                if !(step.is_finite() && step > R::zero()) {
                    return Err(Error::new(Status::BadStep).of("step", step.to_f64()));
                }
                (R::lit(1e-3), R::lit(1e-3))
            }
            Method::Adams { relative, absolute } => (relative, absolute),
        };
        Ok(SimHead {
            method,
            time: R::zero(),
            base: R::zero(),
            step_count: 0,
            adams: Adams::new(relative, absolute, None)?,
            abm4: Abm4::new(),
            impulse: [R::zero(); 3],
            counters: Counters::default(),
            fresh: false,
            started: false,
        })
    }

    /// Starts a simulation in the caller's memory at time 0 and the scene's initial state.
    ///
    /// # Errors
    /// `MemoryTooSmall`, `Overlap`, `OutsideTank`, `Singular`.
    pub fn init(model: Model<'a, R>, head: &'a mut SimHead<R>, reals: &'a mut [R]) -> Result<Self> {
        reals.fill(R::zero());
        let mut sim = Sim::view(model, head, reals)?;
        sim.work.place_walls(&model);
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
        let placed = sim.work.place(&model, R::zero(), p, dp);
        if let Some((a, b)) = first_misplaced(&model, Poses(sim.work.poses)) {
            return Err(if b == Place::Tank {
                Error::new(Status::OutsideTank).at(a)
            } else {
                Error::new(Status::Overlap).at(a).with(b)
            });
        }
        placed.map_err(|e| if e.status == Status::Contact { Error { status: Status::Overlap, ..e } } else { e })?;
        if locked {
            sim.head.impulse = sim.work.impulse_of_motion(&model, p, &rates)?;
        }
        sim.show()?;
        Ok(sim)
    }

    /// The view of a simulation that [`Sim::init`] set up in this memory, for this model.
    ///
    /// # Errors
    /// `MemoryTooSmall`.
    pub fn view(model: Model<'a, R>, head: &'a mut SimHead<R>, reals: &'a mut [R]) -> Result<Self> {
        let need = Self::requirement(&model)?.reals;
        if reals.len() < need {
            return Err(Error::new(Status::MemoryTooSmall).of("length", reals.len() as f64));
        }
        let dims = StateDims::of(model.head, model.coordinates.len());
        let len = State::<R>::len(&dims).ok_or(Status::SizeOverflow)?;
        let (state, work) = reals.split_at_mut_checked(len).ok_or(Status::MemoryTooSmall)?;
        let work = Work::split(&Dims::of(model.head, model.coordinates.len()), work)?;
        Ok(Sim { model, head, state: State::split(&dims, state)?, work })
    }

    /// The model.
    pub fn model(&self) -> Model<'a, R> {
        self.model
    }
    /// Time of the state shown, s.
    pub fn time(&self) -> R {
        self.head.time
    }
    /// x, y, θ of every link's centre of mass (3 per link).
    pub fn positions(&self) -> &[R] {
        self.state.positions
    }
    /// ẋ, ẏ, θ̇ of every link (3 per link).
    pub fn velocities(&self) -> &[R] {
        self.state.velocities
    }
    /// Counts since the start.
    pub fn counters(&self) -> Counters {
        let mut c = self.head.counters;
        if let Method::Adams { .. } = self.head.method {
            let a = self.head.adams.counters();
            (c.steps, c.rejected) = (a.steps, a.rejected);
        }
        c
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
        let before = self.head.time;
        copy(self.state.y, y);
        self.head.time = t;
        if let Err(e) = self.show() {
            copy(self.state.y, self.state.saved);
            self.head.time = before;
            self.show()?;
            return Err(e);
        }
        self.restart();
        Ok(())
    }

    /// Sets a channel: (t, u, u̇, ü) at both ends of the coming step, quintic in between (constant outside). For a torque only
    /// u counts. The integrator starts anew if it could have looked past the present time.
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
        for (k, x) in from.into_iter().chain(to).enumerate() {
            put(self.state.commands, channel * CHANNEL_LEN + k, x);
        }
        copy(self.work.channels, self.state.commands);
        self.head.fresh = false;
        self.restart();
        Ok(())
    }

    /// The right-hand side of the state's equation, for the user's own integrator. `y` and `ydot` as [`Sim::state`]. The
    /// simulation's own state does not change.
    ///
    /// # Errors
    /// `Length`, `NonFiniteState`, `Contact`, `Singular`.
    pub fn rhs(&mut self, t: R, y: &[R], ydot: &mut [R]) -> Result<()> {
        let n = self.state.y.len();
        if y.len() != n || ydot.len() != n {
            return Err(Error::new(Status::Length).of("length", y.len() as f64));
        }
        self.head.fresh = false;
        // The user's integrator may jump: only contact at the state itself counts.
        let (p, _) = split_state(&self.model, y);
        let _ = p;
        copy(self.state.rate, y);
        let anchor_free = {
            let mut motion = Motion {
                model: self.model,
                work: &mut self.work,
                impulse: self.head.impulse,
                anchor: &[],
                counters: &mut self.head.counters,
            };
            motion.rhs(t, y, ydot)
        };
        if anchor_free.is_err() {
            ydot.fill(R::zero());
        }
        anchor_free
    }

    /// One step of the method (for `Adams` one step of its own choice).
    ///
    /// # Errors
    /// `Contact`, `Singular`, `NonFiniteState`, `StepTooSmall`; time and state are then as before.
    pub fn step(&mut self) -> Result<()> {
        match self.head.method {
            Method::Rk4 { step } | Method::Abm4 { step } => {
                self.fixed_step(step, true)?;
            }
            Method::Adams { .. } => {
                self.adams_step(R::MAX)?;
                self.show_adams(self.head.adams.time())?;
            }
        }
        Ok(())
    }

    /// Advances to exactly `t_end`; nothing is evaluated beyond it. A fixed-step method shortens its last step.
    ///
    /// # Errors
    /// As [`Sim::step`]; the state shown is then that of the last step that succeeded.
    pub fn advance(&mut self, t_end: R) -> Result<()> {
        self.advance_dense(t_end, t_end)
    }

    /// Shows the state at `t_out`; the integrator may run ahead, but not beyond `t_stop`. Cheaper than [`Sim::advance`] when
    /// output is wanted at many times: a variable-step method keeps its steps and interpolates.
    ///
    /// # Errors
    /// As [`Sim::advance`]; `BadStep` if `t_out` is before the time shown or after `t_stop`.
    pub fn advance_dense(&mut self, t_out: R, t_stop: R) -> Result<()> {
        if !(t_out.is_finite() && t_stop >= t_out && t_out >= self.head.time) {
            return Err(Error::new(Status::BadStep).of("t", t_out.to_f64()));
        }
        match self.head.method {
            Method::Adams { .. } => {
                while !self.head.started || self.head.adams.time() < t_out {
                    if let Err(e) = self.adams_step(t_stop) {
                        if self.head.started && self.head.adams.time() > self.head.time {
                            self.show_adams(self.head.adams.time())?;
                        }
                        return Err(e);
                    }
                    if t_out == self.head.time {
                        break;
                    }
                }
                self.show_adams(t_out)
            }
            Method::Rk4 { step } | Method::Abm4 { step } => {
                // Rounding of the time must not make a step of almost no length.
                let slack = step * R::lit(1e-6).max(R::lit(8.0) * R::EPSILON);
                while self.head.time + step <= t_out + slack {
                    self.fixed_step(step, true)?;
                }
                let rest = t_out - self.head.time;
                if rest > slack {
                    self.fixed_step(rest, false)?;
                }
                if rest.abs() <= slack || rest > slack {
                    self.head.time = t_out;
                }
                Ok(())
            }
        }
    }

    /// Forgets the integrator's past, as after a jump of the drives.
    pub fn restart(&mut self) {
        self.head.abm4.reset();
        self.head.started = false;
        self.head.base = self.head.time;
        self.head.step_count = 0;
    }

    /// One step of a fixed-step method; `regular` steps keep the multistep history.
    fn fixed_step(&mut self, h: R, regular: bool) -> Result<()> {
        copy(self.state.saved, self.state.y);
        let (t, abm4) = (self.head.time, self.head.abm4);
        let use_abm4 = regular && matches!(self.head.method, Method::Abm4 { .. });
        self.head.fresh = false;
        let mut motion = motion!(self);
        let stepped = if use_abm4 {
            self.head.abm4.step(&mut motion, t, h, self.state.y, self.state.integrator)
        } else {
            Rk4::new().step(&mut motion, t, h, self.state.y, self.state.integrator)
        };
        let next = if regular { self.head.base + R::count(self.head.step_count as usize + 1) * h } else { t + h };
        let arrived = stepped.and_then(|()| {
            self.head.time = next;
            self.show_checked()
        });
        if let Err(e) = arrived {
            copy(self.state.y, self.state.saved);
            self.head.time = t;
            self.head.abm4 = abm4;
            self.head.abm4.reset();
            self.head.counters.rejected += 1;
            self.show()?;
            return Err(e);
        }
        self.head.counters.steps += 1;
        if regular {
            self.head.step_count += 1;
        } else {
            self.head.abm4.reset();
            (self.head.base, self.head.step_count) = (self.head.time, 0);
        }
        Ok(())
    }

    /// One accepted step of the variable-step method.
    fn adams_step(&mut self, t_stop: R) -> Result<()> {
        self.head.fresh = false;
        let mut adams = self.head.adams;
        if !self.head.started {
            adams.start(self.head.time, self.state.y, self.state.integrator)?;
            self.head.started = true;
            // The poses of the state shown are the ones that trial states are measured from.
            copy(self.state.anchor, self.work.poses);
        }
        let outcome = adams.step(&mut motion!(self), t_stop, self.state.integrator);
        self.head.adams = adams;
        outcome?;
        let y = self.head.adams.state(self.state.integrator);
        let (p, _) = split_state(&self.model, y);
        place_only(&self.model, &mut self.work, self.head.adams.time(), p);
        copy(self.state.anchor, self.work.poses);
        Ok(())
    }

    /// Shows the variable-step solution at `t`, within the last step.
    fn show_adams(&mut self, t: R) -> Result<()> {
        let adams = self.head.adams;
        if t == adams.time() {
            copy(self.state.y, adams.state(self.state.integrator));
        } else {
            adams.interpolate(t, self.state.integrator, self.state.y, self.state.rate)?;
        }
        self.head.time = t;
        self.show()
    }

    /// Positions, velocities and joints of the state, after a check of where it leads.
    fn show_checked(&mut self) -> Result<()> {
        if !self.state.y.iter().all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        let (p, dp) = split_state(&self.model, self.state.y);
        self.work.place(&self.model, self.head.time, p, dp)?;
        if let Some((a, b)) = swept_contact(&self.model, Poses(self.state.anchor), Poses(self.work.poses)) {
            return Err(Error::new(Status::Contact).at(a).with(b));
        }
        self.show()
    }

    /// Positions, velocities and joints of the state.
    fn show(&mut self) -> Result<()> {
        self.head.fresh = false;
        let model = self.model;
        if model.head.plan.formulation == Formulation::LockedMomentum {
            // The rates follow from the impulse: one factorization.
            self.refresh()?;
        } else {
            let (p, dp) = split_state(&model, self.state.y);
            self.work.place(&model, self.head.time, p, dp)?;
        }
        copy(self.state.positions, self.work.q);
        copy(self.state.velocities, self.work.qd);
        for (k, (u, du)) in self.work.s.iter().zip(self.work.ds.iter()).enumerate() {
            put(self.state.joints, 2 * k, *u);
            put(self.state.joints, 2 * k + 1, *du);
        }
        if !self.head.started {
            copy(self.state.anchor, self.work.poses);
        }
        Ok(())
    }

    /// Makes the buffers hold an evaluation of the state shown, accelerations included.
    pub(crate) fn refresh(&mut self) -> Result<()> {
        if self.head.fresh {
            return Ok(());
        }
        let model = self.model;
        let (p, dp) = split_state(&model, self.state.y);
        let zero = [R::zero(); 3];
        let locked = model.head.plan.formulation == Formulation::LockedMomentum;
        let dp = if locked { &zero } else { dp };
        let mut counters = self.head.counters;
        self.work.evaluate(&model, &self.head.impulse, self.head.time, p, dp, &mut counters)?;
        if locked && !model.head.tracks_work {
            self.work.accelerate(&model, self.head.time)?;
        }
        self.head.fresh = true;
        Ok(())
    }

    /// u and u̇ of every joint, in the order of the links they move (`joint_count` each).
    pub fn joint_values(&self, u: &mut [R], du: &mut [R]) {
        let joints = self.model.coordinates.iter().enumerate().filter(|(_, c)| c.component == 3);
        for ((u, du), (k, _)) in u.iter_mut().zip(du.iter_mut()).zip(joints) {
            (*u, *du) = (at(self.state.joints, 2 * k), at(self.state.joints, 2 * k + 1));
        }
    }
}

/// Poses of a state without any check.
fn place_only<R: Real>(model: &Model<'_, R>, work: &mut Work<'_, R>, t: R, p: &[R]) {
    crate::articulation::set_coordinates(model, t, p, &[], work.channels, work.s, work.ds, work.dds);
    crate::articulation::place_links(model, work.s, work.q, work.poses);
}

impl<R: Real> Work<'_, R> {
    /// Total linear impulse and angular impulse about the origin of the motion (p, ṗ), from scratch.
    pub(crate) fn impulse_of_motion(&mut self, model: &Model<'_, R>, p: &[R], dp: &[R]) -> Result<[R; 3]> {
        let mut counters = Counters::default();
        self.place(model, R::zero(), p, dp)?;
        self.prepare_motion(model, &mut counters)?;
        Ok(self.total_impulse(model))
    }
}
