//! Functions of time as written in a scene file.

use std::path::Path;

use nekton::scene::{Harmonic, Signal, Window};

use super::reader::{Item, Outcome, Problem, Section};
use super::table::{self, Slopes, Table, Wanted};

/// A function of time with its own terms and rows.
#[derive(Clone, Debug, PartialEq)]
pub enum SignalDef {
    /// A number.
    Constant(f64),
    /// `{ harmonic = [{ … }, …], window = { … } }`
    Harmonic(Vec<Harmonic<f64>>, Option<Window<f64>>),
    /// `{ table = "file.csv", slopes = "…" }`
    Table(Table),
    /// `{ channel = "name", value = …, slopes = "…" }`
    Channel(Channel),
}

/// A function of time that is given when the scene is run.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// Line on which it stands.
    pub line: usize,
    /// What it is until something else is given.
    pub value: f64,
    /// What is asked of a table given for it.
    pub wanted: Wanted,
    /// Line of `slopes`.
    pub slopes_line: usize,
    /// The table given for it: what it is called, and its rows.
    pub feed: Option<(String, Table)>,
}

/// What a function of time is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Purpose {
    /// A motion, which cannot jump.
    Motion,
    /// A torque, which can.
    Torque,
}

/// The keys of a function of time.
pub const KEYS: &[&str] = &["harmonic", "window", "table", "slopes", "channel", "value"];

impl SignalDef {
    /// Reads a number or a table of one of the three kinds.
    pub fn read(item: &Item<'_>, purpose: Purpose) -> Outcome<Self> {
        if item.is_number() {
            return item.number().map(SignalDef::Constant);
        }
        let title = format!("`{}`", item.key);
        SignalDef::from_section(&item.section(&title, KEYS)?, purpose)
    }

    /// Reads from a table that may hold other keys too.
    pub fn from_section(section: &Section<'_>, purpose: Purpose) -> Outcome<Self> {
        let (kind, value) = section.one_of(&["harmonic", "table", "channel"])?;
        for (key, kinds, text) in [
            ("window", &["harmonic"][..], "goes with `harmonic` only"),
            ("slopes", &["table", "channel"], "goes with `table` and `channel` only"),
            ("value", &["channel"], "goes with `channel` only"),
        ] {
            if let (Some(item), false) = (section.get(key), kinds.contains(&kind)) {
                return Err(item.problem(text));
            }
        }
        let slopes = section.get("slopes");
        let wanted =
            Wanted { slopes: slopes.as_ref().map(Slopes::read).transpose()?, jumps: purpose == Purpose::Torque };
        match kind {
            "table" => table::motion(&value, wanted, slopes.as_ref()).map(SignalDef::Table),
            "channel" => Ok(SignalDef::Channel(Channel {
                name: channel_name(&value)?,
                line: value.line,
                value: section.or("value", 0.0, Item::number)?,
                wanted,
                slopes_line: slopes.map_or(value.line, |s| s.line),
                feed: None,
            })),
            _ => {
                let terms = value.list()?;
                if terms.is_empty() {
                    return Err(value.problem("needs at least one term"));
                }
                let terms = terms.iter().map(term).collect::<Outcome<_>>()?;
                let window = section.get("window");
                Ok(SignalDef::Harmonic(terms, window.as_ref().map(read_window).transpose()?))
            }
        }
    }

    /// The core's description of it. A channel is known from the start to the end of a run, so it is what stands for it.
    pub fn core(&self) -> Signal<'_, f64> {
        match self {
            SignalDef::Constant(x) => Signal::Constant(*x),
            SignalDef::Harmonic(terms, window) => Signal::Harmonic { terms, window: *window },
            SignalDef::Table(table) => Signal::Table(&table.rows),
            SignalDef::Channel(Channel { feed: Some((_, table)), .. }) => Signal::Table(&table.rows),
            SignalDef::Channel(channel) => Signal::Constant(channel.value),
        }
    }

    /// What the user should know of it.
    pub fn notices(&self) -> Vec<String> {
        match self {
            SignalDef::Table(table) => table.notices.clone(),
            SignalDef::Channel(Channel { feed: Some((_, table)), .. }) => table.notices.clone(),
            SignalDef::Channel(c) => {
                vec![format!(
                    "channel `{0}` stays at {1}: no table is given (nekton run --channel {0}=FILE)",
                    c.name, c.value
                )]
            }
            _ => Vec::new(),
        }
    }
}

impl Channel {
    /// Reads the table that is to stand for the channel. `scene` is the scene's path.
    pub fn read_table(&mut self, scene: &Path, file: &Path) -> Outcome<()> {
        let bytes = super::file::read(file, super::file::TABLE)
            .map_err(|e| Problem::file(file, format!("cannot be read for channel `{}`: {e}", self.name)))?;
        let refuse = |text: &str| Problem::line(scene, self.slopes_line, format!("`slopes` {text}"));
        let table = table::rows(file, &bytes, self.wanted, refuse)?;
        self.feed = Some((file.display().to_string(), table));
        Ok(())
    }
}

/// A name that can stand before `=` in an argument.
fn channel_name(item: &Item<'_>) -> Outcome<String> {
    let text = item.text()?;
    if text.trim() != text || text.is_empty() || text.chars().any(|c| c.is_control() || "=,\"".contains(c)) {
        let hint = "no equals sign, comma or quote, and no blank at its ends";
        return Err(item.problem(format!("cannot be `{}`", text.escape_debug())).hint(hint));
    }
    item.no_formula()?;
    Ok(text.to_owned())
}

fn term(item: &Item<'_>) -> Outcome<Harmonic<f64>> {
    let section = item.section("a harmonic term", &["amplitude", "frequency", "phase", "offset"])?;
    let get = |key| section.or(key, 0.0, Item::number);
    if section.get("amplitude").is_some() {
        section.need("frequency")?;
    }
    Ok(Harmonic {
        amplitude: get("amplitude")?,
        frequency: get("frequency")?,
        phase: get("phase")?,
        offset: get("offset")?,
    })
}

fn read_window(item: &Item<'_>) -> Outcome<Window<f64>> {
    let section = item.section("a window", &["from", "to", "ramp"])?;
    let (from, to) = (section.need("from")?.number()?, section.need("to")?);
    let end = to.number()?;
    if end <= from {
        return Err(to.problem(format!("must be later than `from` = {from}, but is {end}")));
    }
    let ramp = section.need("ramp")?;
    let length = ramp.positive()?;
    // A ramp of exactly half the support must survive decimal rounding of all three numbers.
    if 2.0 * length > (end - from) * (1.0 + 1e-12) {
        let message = format!("must be at most half of the window, but is {length} of {}", end - from);
        return Err(ramp.problem(message));
    }
    Ok(Window { from, to: end, ramp: length.min(0.5 * (end - from)) })
}
