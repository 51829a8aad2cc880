//! Drives that outrun the steps, jump, or are set from outside: what an integrator has to know of them, and what is noticed.
//!
//! Tested by `tests/drives`, `tests/channels`.

use crate::base::scalar::Real;
use crate::model::Formulation;
use crate::model::signal::{Jump, Seen};
use crate::model::table::{channel_jump, channel_kink};
use crate::simulation::sim::Sim;
use crate::simulation::state::{Method, Missed, Watch};

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
        let h = if seen(Seen::Roughly) < room { seen(Seen::Well) } else { room };
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
            let (jump, by) = model.jump_at(t, channels);
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

    /// A channel was set anew: the integrator follows.
    pub(crate) fn follow_channel(&mut self, channel: usize, old: &[R], new: &[R]) {
        let t = self.progress.time;
        let Some((coordinate, motion)) = self.model.channel(channel) else { return };
        let jump = channel_jump(motion, t, old, new);
        if self.tears(jump) && self.progress.watch != Watch::Nothing {
            self.progress.torn = Some(coordinate);
        }
        if self.progress.runs() && self.progress.adams.time() > t {
            // It has looked ahead.
            self.restart();
        } else if jump != Jump::None {
            // What is found out now of the last step is not of the call that made it.
            self.begin_watch();
            self.progress.adams.jump();
            self.forget_rates();
        } else if channel_kink(motion, t, old, new) {
            self.progress.adams.kink();
        }
    }
}
