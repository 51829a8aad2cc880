//! The channels of a scene: which there are, and what is given for them.

use std::path::{Path, PathBuf};

use super::body::BodyDef;
use super::reader::{Outcome, Problem, Source, suggest};
use super::signal::{Channel, SignalDef};

/// Every channel of the bodies.
pub fn channels(bodies: &[BodyDef]) -> impl Iterator<Item = &Channel> {
    bodies.iter().flat_map(BodyDef::signals).filter_map(|s| match s {
        SignalDef::Channel(channel) => Some(channel),
        _ => None,
    })
}

/// Refuses two channels of one name.
pub fn refuse_duplicates(source: &Source, bodies: &[BodyDef]) -> Outcome<()> {
    let mut all: Vec<&Channel> = channels(bodies).collect();
    all.sort_by_key(|c| c.line);
    for (k, channel) in all.iter().enumerate() {
        if let Some(first) = all.iter().take(k).find(|c| c.name == channel.name) {
            let message = format!("two channels are called `{}`", channel.name);
            let hint = format!("the other is on line {}; names must differ", first.line);
            return Err(source.problem(channel.line, message).hint(hint));
        }
    }
    Ok(())
}

/// Puts tables in place of channels.
pub fn feed(scene: &Path, bodies: &mut [BodyDef], feeds: &[(String, PathBuf)]) -> Outcome<()> {
    for (name, file) in feeds {
        let known: Vec<String> = channels(bodies).map(|c| c.name.clone()).collect();
        let found = bodies.iter_mut().flat_map(BodyDef::signals_mut).find_map(|s| match s {
            SignalDef::Channel(channel) if channel.name == *name => Some(channel),
            _ => None,
        });
        let Some(channel) = found else {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let hint = if known.is_empty() { Some("it has none".to_owned()) } else { suggest(name, &known) };
            return Err(Problem::file(scene, format!("the scene has no channel `{name}`")).maybe_hint(hint));
        };
        if let Some((other, _)) = &channel.feed {
            let message = format!("channel `{name}` is given twice: by {other} and by {}", file.display());
            return Err(Problem::file(scene, message).hint("leave one of them out"));
        }
        channel.read_table(scene, file)?;
    }
    Ok(())
}
