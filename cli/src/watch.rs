//! What a run notices, from when to when.

use nekton::Sim;
use nekton::status::{Error, Status};

use crate::record::Record;
use crate::setup::Setup;

/// A time during which something is to be noticed.
pub struct Episode {
    /// Since when.
    pub from: f64,
    /// When it was worst, and what was told then.
    pub worst: (f64, Error),
    /// The smallest gap then.
    pub gap: f64,
}

/// Follows what a simulation has to say about its errors: one notice for each episode of each kind.
#[derive(Default)]
pub struct Watch {
    /// One for each kind.
    pub episodes: [Option<Episode>; 4],
}

/// The larger, the worse.
fn severity(notice: &Error) -> f64 {
    match notice.status {
        // The step that would have seen the drive.
        Status::DriveUnresolved => -notice.value,
        _ => notice.value.abs(),
    }
}

impl Watch {
    /// After a row.
    pub fn look(&mut self, setup: &Setup, sim: &mut Sim<'_, f64>, record: &mut Record) {
        let notices = sim.notices();
        let gap = if notices.iter().any(Option::is_some) { sim.gap().distance } else { f64::INFINITY };
        for (episode, notice) in self.episodes.iter_mut().zip(notices) {
            let Some((time, notice)) = notice else {
                tell(episode, setup, sim.time(), record);
                continue;
            };
            let episode = episode.get_or_insert(Episode { from: time, worst: (time, notice), gap });
            if severity(&notice) > severity(&episode.worst.1) {
                (episode.worst, episode.gap) = ((time, notice), gap);
            }
        }
    }

    /// The episodes, if there are any, are over.
    pub fn end(&mut self, setup: &Setup, to: f64, record: &mut Record) {
        self.episodes.iter_mut().for_each(|episode| tell(episode, setup, to, record));
    }
}

/// An episode, if there is one, is over.
fn tell(episode: &mut Option<Episode>, setup: &Setup, to: f64, record: &mut Record) {
    let Some(Episode { from, worst: (time, notice), gap }) = episode.take() else { return };
    let gap = if gap.is_finite() { format!(", gap then {gap:.3e} m") } else { String::new() };
    let text = setup.scene.describe(&notice);
    let more = match notice.status {
        Status::Unresolved => format!(", asked {:.1e}", record.tolerance),
        Status::EnergyDrift => format!(" J/m, the largest kinetic energy up to then {:.3e} J/m", notice.limit),
        _ => String::new(),
    };
    let text = format!("t = {from:.6} to {to:.6} s: {text}{more}; worst at t = {time:.6} s{gap}");
    match notice.status {
        Status::EnergyDrift => record.drifts.push((notice.value.abs(), text)),
        _ => record.notices.push(text),
    }
}
