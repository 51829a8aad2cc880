//! Functions of time as written in a scene file.

use nekton::scene::{Harmonic, Signal, Window};

use super::reader::{Item, Outcome, Section};
use super::table;

/// A function of time with its own terms and rows.
#[derive(Clone, Debug, PartialEq)]
pub enum SignalDef {
    /// A number.
    Constant(f64),
    /// `{ harmonic = [{ … }, …], window = { … } }`
    Harmonic(Vec<Harmonic<f64>>, Option<Window<f64>>),
    /// `{ table = "file.csv" }`
    Table(Vec<[f64; 4]>),
}

impl SignalDef {
    /// Reads a number or a table of one of the two kinds.
    pub fn read(item: &Item<'_>) -> Outcome<Self> {
        if item.is_number() {
            return item.number().map(SignalDef::Constant);
        }
        let title = format!("`{}`", item.key);
        SignalDef::from_section(&item.section(&title, &["harmonic", "window", "table"])?)
    }

    /// Reads from a table that may hold other keys too.
    pub fn from_section(section: &Section<'_>) -> Outcome<Self> {
        let (kind, value) = section.one_of(&["harmonic", "table"])?;
        let window = section.get("window");
        if kind == "table" {
            if let Some(w) = window {
                return Err(w.problem("goes with `harmonic` only"));
            }
            return table::motion(&value).map(SignalDef::Table);
        }
        let terms = value.list()?;
        if terms.is_empty() {
            return Err(value.problem("needs at least one term"));
        }
        let terms = terms.iter().map(term).collect::<Outcome<_>>()?;
        Ok(SignalDef::Harmonic(terms, window.as_ref().map(read_window).transpose()?))
    }

    /// The core's description of it.
    pub fn core(&self) -> Signal<'_, f64> {
        match self {
            SignalDef::Constant(x) => Signal::Constant(*x),
            SignalDef::Harmonic(terms, window) => Signal::Harmonic { terms, window: *window },
            SignalDef::Table(rows) => Signal::Table(rows),
        }
    }
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
