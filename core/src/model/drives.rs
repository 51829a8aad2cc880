//! What all drives of a model do in a step: where one jumps, and how long the step may be lest something be missed.
//!
//! Tested by `tests/drives`.

use core::ops::Range;

use crate::base::scalar::Real;
use crate::base::status::Place;
use crate::model::signal::{Jump, Seen};
use crate::model::{Control, CoordinateRecord, Model};

/// How long a step may be, and the coordinate whose drive says so.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct StepLimit<R> {
    pub length: R,
    /// `None`: no drive shortens the step.
    pub by: Option<usize>,
}

impl<'a, R: Real> Model<'a, R> {
    /// The drives that move, and whether each is a motion.
    fn moving(&self) -> impl Iterator<Item = (usize, &'a CoordinateRecord<R>, bool)> + use<'a, R> {
        let driven = |c: &CoordinateRecord<R>| c.control != Control::Free && !c.constant;
        self.coordinates
            .iter()
            .enumerate()
            .filter(move |(_, c)| driven(c))
            .map(|(i, c)| (i, c, c.control == Control::Prescribed))
    }

    /// Whether the rates depend on time otherwise than by the state.
    pub(crate) fn clocked(&self) -> bool {
        self.moving().next().is_some()
    }

    /// The longest step from `t`, at most `h`, whose ends tell what the drives do within (see
    /// [`crate::model::signal::SignalRecord::seen`]).
    pub(crate) fn seen(&self, share: Seen, t: R, h: R, channels: &[R]) -> StepLimit<R> {
        self.moving().fold(StepLimit { length: h, by: None }, |limit, (i, c, motion)| {
            let length = c.signal.seen(motion, share, t, limit.length, self.store, channels);
            if length < limit.length { StepLimit { length, by: Some(i) } } else { limit }
        })
    }

    /// First time strictly within (t, end) at which a drive jumps.
    pub(crate) fn next_jump(&self, t: R, end: R, channels: &[R]) -> Option<(R, usize)> {
        self.moving().fold(None, |first, (i, c, motion)| {
            let end = first.map_or(end, |(t, _)| t);
            c.signal.next_jump(motion, t, end, self.store, channels).map(|t| (t, i)).or(first)
        })
    }

    /// First time strictly within (t, end) at which a drive is less smooth than in between.
    pub(crate) fn next_kink(&self, t: R, end: R, channels: &[R]) -> R {
        self.moving()
            .fold(end, |end, (_, c, motion)| c.signal.next_kink(motion, t, end, self.store, channels).unwrap_or(end))
    }

    /// Whether a drive is less smooth at `t`, by so much that it matters to a step of length `h`.
    pub(crate) fn kinks_at(&self, t: R, h: R) -> bool {
        self.moving().any(|(_, c, motion)| c.signal.kinks_at(motion, t, h, self.store))
    }

    /// The worst that a drive does at a time, but for the ends of channels' pieces.
    pub(crate) fn jump_at(&self, t: R) -> (Jump, Option<usize>) {
        let jumps = self.moving().map(|(i, c, motion)| (c.signal.jump_at(motion, t, self.store), Some(i)));
        jumps.fold((Jump::None, None), |worst, next| if next.0 > worst.0 { next } else { worst })
    }

    /// The worst that a channel does whose piece begins (row 0) or ends (row 1) at a time, and the coordinate; `None` if none does.
    pub(crate) fn piece_at(&self, t: R, rows: Range<usize>, channels: &[R]) -> Option<(Jump, usize)> {
        self.moving()
            .filter_map(|(i, c, motion)| Some((c.signal.piece_at(motion, t, rows.clone(), channels)?, i)))
            .max_by_key(|(jump, _)| *jump)
    }

    /// The coordinate that a channel moves, and whether it is a motion.
    pub(crate) fn channel(&self, channel: usize) -> Option<(usize, bool)> {
        self.moving().find(|(_, c, _)| c.signal.channel() == Some(channel)).map(|(i, _, motion)| (i, motion))
    }

    /// The scene's name for what a coordinate moves.
    pub(crate) fn place_of(&self, coordinate: usize) -> Place {
        let Some((c, l)) = self.coordinates.get(coordinate).and_then(|c| Some((c, self.links.get(c.link)?))) else {
            return Place::Scene;
        };
        if c.component < 3 { Place::Body(l.place.0) } else { Place::Link(l.place.0, l.place.1) }
    }
}
