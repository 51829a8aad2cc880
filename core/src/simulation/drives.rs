//! Drives that outrun the steps, jump, or are set from outside: what an integrator has to know of them, and what is noticed.
//!
//! Tested by `tests/drives`, `tests/channels`.

use core::ops::Range;

use crate::base::scalar::Real;
use crate::model::Formulation;
use crate::model::signal::{Jump, Seen};
use crate::model::table::{channel_jump, channel_kink};
use crate::simulation::sim::Sim;
use crate::simulation::state::{Balance, Method, Missed, Watch};

impl<R: Real> Sim<'_, R> {
    /// A step of at most `wish` that `Gauss6` may make: no longer than to the next jump, and such that the drives are resolved where a
    /// longer one would miss what they do. The other methods of fixed step keep to it, and tell.
    pub(crate) fn resolving(&self, wish: R) -> R {
        let Method::Gauss6 { .. } = self.progress.method else { return wish };
        let (t, channels) = (self.progress.time, &*self.evaluation.coordinates.channels);
        let end = self.model.next_jump(t, t + wish, channels).map_or(t + wish, |(jump, _)| jump);
        let kink = self.model.next_kink(t, end, channels);
        let room = if kink < t + wish { kink - t } else { wish };
        let seen = |share| self.model.seen(share, t, room, channels).length;
        let h = if seen(Seen::RampsWell) < room { seen(Seen::Well) } else { room };
        h.max(R::lit(16.0) * R::EPSILON * t.abs()).min(wish)
    }

    /// Keeps what a step from `t` missed of the drives. `moved`: it was not the first one since the state was set.
    pub(crate) fn note_drives(&mut self, t: R, h: R, moved: bool) {
        let (model, channels) = (self.model, &*self.evaluation.coordinates.channels);
        if !model.clocked() {
            return;
        }
        let mut missed = self.progress.missed;
        let mut note = |length: R, coordinate: Option<usize>| {
            if let Some(coordinate) = coordinate.filter(|_| length < missed.length) {
                missed = Missed { coordinate, length, time: t };
            }
        };
        if let Method::Rk4 { .. } | Method::Abm4 { .. } = self.progress.method {
            let limit = model.seen(Seen::Roughly, t, h, channels);
            note(limit.length, limit.by);
            if let Some((jump, by)) = model.next_jump(t, t + h, channels) {
                note(jump - t, Some(by));
            }
        }
        if moved {
            let (jump, by) = model.jump_at(t);
            note(R::zero(), by.filter(|_| self.tears(jump)));
        }
        note(R::zero(), self.progress.torn.take());
        self.progress.missed = missed;
    }

    /// Whether it would take an impulse: a lone swimmer's rates follow from its impulse by themselves.
    fn tears(&self, jump: Jump) -> bool {
        let locked = self.model.head.plan.formulation == Formulation::LockedMomentum;
        jump == Jump::Value || (jump == Jump::Rate && !locked)
    }

    /// A step begins at `t`: pieces of channels that end there, or begin there and were given before, may jump.
    pub(crate) fn meet_channels(&mut self, t: R) {
        if self.model.head.channels > 0 {
            // The integrator's time and the one shown may differ by rounding.
            let now = (self.progress.commanded - t).abs() <= R::lit(4.0) * R::EPSILON * t.abs();
            let rows = if now { 1..2 } else { 0..2 };
            self.meet_pieces(t, &rows);
        }
    }

    /// A channel is about to be set at the present time: from now on a piece that begins there counts as set there.
    pub(crate) fn before_command(&mut self) {
        let t = self.progress.time;
        if self.progress.commanded != t {
            self.meet_pieces(t, &(0..1));
            self.progress.commanded = t;
        }
    }

    fn meet_pieces(&mut self, t: R, rows: &Range<usize>) {
        match self.model.piece_at(t, rows, self.evaluation.coordinates.channels) {
            Some((Jump::None, _)) => self.progress.adams.kink(),
            Some((jump, coordinate)) => self.meet_jump(jump, coordinate),
            None => {}
        }
    }

    fn meet_jump(&mut self, jump: Jump, coordinate: usize) {
        if self.tears(jump) && self.progress.watch != Watch::Nothing {
            self.progress.torn = Some(coordinate);
        }
        self.progress.adams.jump();
        self.forget_rates();
    }

    /// A channel was set anew: the integrator follows.
    pub(crate) fn follow_channel(&mut self, channel: usize, old: &[R], new: &[R]) {
        let t = self.progress.time;
        let Some((coordinate, motion)) = self.model.channel(channel) else { return };
        let jump = channel_jump(motion, t, old, new);
        if self.tears(jump) && self.progress.watch == Watch::Nothing {
            // Not torn, but begun: what the energy was before does not bind it.
            self.progress.balance = Balance::unknown();
        }
        // What is found out now of the last step is not of the call that made it.
        if jump != Jump::None {
            self.begin_watch();
            self.meet_jump(jump, coordinate);
        } else if channel_kink(motion, t, old, new) {
            self.progress.adams.kink();
        }
        if self.progress.runs() && self.progress.adams.time() > t {
            // It has looked ahead.
            self.restart();
        }
    }
}
