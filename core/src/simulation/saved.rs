//! A simulation as bytes: what it remembers, so that another one of an equal model goes on from there bit for bit, in another
//! process, on another machine.
//!
//! All of it is words of 64 bits, the lowest byte first: the head of [`HEAD`] words, the fields of [`Progress`], the reals of
//! [`State`], the digest of all that. Whatever is read is checked before anything is changed; bytes that were damaged are refused,
//! and bytes that somebody made up can be wrong, but do no harm.
//!
//! Tested by `tests/saving`, and by the tests at its end.

use crate::base::digest::Digest;
use crate::base::fields::Fields;
use crate::base::memory::copy;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::evaluation::Counters;
use crate::dynamics::indicators::Resolution;
use crate::model::signal::CHANNEL_LEN;
use crate::simulation::sim::Sim;
use crate::simulation::state::{Balance, Clock, Method, Missed, Progress, State, Watch};

/// "nekton S", read with the lowest byte first.
const MARK: u64 = u64::from_le_bytes(*b"nekton S");
/// To be raised when a field changes its meaning but not its name; names, their number and their order tell by themselves.
const VERSION: u64 = 1;
/// Words before the fields: mark, version, digest of the fields' names, bytes of a real, the model's fingerprint, bytes in all.
const HEAD: usize = 6;
const WORD: usize = size_of::<u64>();

/// What reals may be.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    /// Anything: scratch, or what the integrator answers for.
    Any,
    Finite,
    /// Commands of channels: finite, at increasing times, or all 0.
    Commands,
}

/// The arrays of a state, each with its rule, from `&State` or `&mut State`.
macro_rules! arrays {
    ($state:expr, $(($reference:tt))? $($mutable:ident)?) => {{
        let State { y, saved, rate, positions, velocities, anchor, joints, commands, integrator } = $state;
        [
            (Rule::Finite, "state", & $($mutable)? **y),
            (Rule::Any, "saved", & $($mutable)? **saved),
            (Rule::Any, "rate", & $($mutable)? **rate),
            (Rule::Finite, "positions", & $($mutable)? **positions),
            (Rule::Finite, "velocities", & $($mutable)? **velocities),
            (Rule::Finite, "anchor", & $($mutable)? **anchor),
            (Rule::Finite, "joints", & $($mutable)? **joints),
            (Rule::Commands, "commands", & $($mutable)? **commands),
            (Rule::Any, "integrator", & $($mutable)? **integrator),
        ]
    }};
}

fn bad(what: &'static str) -> Error {
    Error::new(Status::BadSave).of(what, f64::NAN)
}

/// Counts the words of fields, digests their names, and looks whether they are in their ranges.
struct Survey {
    words: usize,
    names: Digest,
    refused: Option<&'static str>,
}

impl Survey {
    /// Of a record's fields, by its walk.
    fn of(walk: impl FnOnce(&mut Survey)) -> Survey {
        let mut survey = Survey { words: 0, names: Digest::new(), refused: None };
        walk(&mut survey);
        survey
    }
}

impl<R: Real> Fields<R> for Survey {
    fn word(&mut self, name: &'static str, _: &mut u64) {
        self.words += 1;
        self.names.text(name);
    }
    fn refuse(&mut self, name: &'static str) {
        self.refused.get_or_insert(name);
    }
}

/// Writes words, as far as there is room, and digests them.
struct Writer<'o> {
    room: core::slice::IterMut<'o, [u8; WORD]>,
    digest: Digest,
}

impl Writer<'_> {
    fn put(&mut self, word: u64) {
        self.digest.word(word);
        if let Some(to) = self.room.next() {
            *to = word.to_le_bytes();
        }
    }
}

impl<R: Real> Fields<R> for Writer<'_> {
    fn word(&mut self, _: &'static str, x: &mut u64) {
        self.put(*x);
    }
    fn refuse(&mut self, _: &'static str) {}
}

/// Reads words, 0 when there are no more.
struct Reader<'b> {
    words: core::slice::Iter<'b, [u8; WORD]>,
    refused: Option<&'static str>,
}

impl Reader<'_> {
    fn get(&mut self) -> u64 {
        self.words.next().map_or(0, |word| u64::from_le_bytes(*word))
    }
}

impl<R: Real> Fields<R> for Reader<'_> {
    fn word(&mut self, _: &'static str, x: &mut u64) {
        *x = self.get();
    }
    fn refuse(&mut self, name: &'static str) {
        self.refused.get_or_insert(name);
    }
}

impl<R: Real> Progress<R> {
    /// Every field, in order, of a simulation with so many unknowns and coordinates.
    fn each(&mut self, io: &mut impl Fields<R>, (unknowns, coordinates): (usize, usize)) {
        let Progress {
            method,
            time,
            clock,
            adams,
            rk4,
            abm4,
            gauss6,
            step_limit,
            time_error,
            impulse,
            counters,
            worst,
            worst_time,
            coarsest,
            coarsest_time,
            late,
            rough,
            watch,
            missed,
            torn,
            balance,
            arrived,
            commanded,
        } = self;
        each_of_method(method, io);
        io.finite("time", time);
        each_of_clock(clock, io);
        adams.each(io, unknowns);
        // The state shown is the integrator's, or one before it.
        io.require("clock", *clock != Clock::Running || adams.state_len() == unknowns);
        rk4.each(io);
        abm4.each(io);
        gauss6.each(io);
        io.word("step_limit", step_limit);
        io.require("step_limit", *step_limit > 0);
        time_error.each(io);
        rough.each(io);
        impulse.iter_mut().for_each(|x| io.finite("impulse", x));
        let Counters { evaluations, factorizations, steps, rejected } = counters;
        for count in [evaluations, factorizations, steps, rejected] {
            io.total("counters", count);
        }
        let Resolution { mass, force, quadrature, repulsion } = worst;
        for x in [mass, force, quadrature, repulsion, worst_time, coarsest, coarsest_time, late] {
            io.real("worst", x);
        }
        each_of_missed(missed, io, coordinates);
        let (mut torn_any, mut torn_which) = (torn.is_some(), torn.unwrap_or(0));
        io.flag("torn", &mut torn_any);
        io.count("torn", &mut torn_which, coordinates.saturating_sub(1));
        *torn = torn_any.then_some(torn_which);
        each_of_balance(balance, io);
        io.flag("arrived", arrived);
        io.real("commanded", commanded);
        let mut which = match watch {
            Watch::Nothing => 0,
            Watch::Past => 1,
            Watch::Present => 2,
        };
        io.word("watch", &mut which);
        *watch = match which {
            0 => Watch::Nothing,
            1 => Watch::Past,
            2 => Watch::Present,
            _ => return io.refuse("watch"),
        };
    }
}

fn each_of_method<R: Real>(method: &mut Method<R>, io: &mut impl Fields<R>) {
    let zero = R::zero();
    let (mut which, mut numbers) = match *method {
        Method::Rk4 { step } => (0, [step, zero, zero, zero]),
        Method::Abm4 { step } => (1, [step, zero, zero, zero]),
        Method::Adams { relative, absolute, max_step, first_step } => (2, [relative, absolute, max_step, first_step]),
        Method::Gauss6 { step } => (3, [step, zero, zero, zero]),
    };
    io.word("method", &mut which);
    numbers.iter_mut().for_each(|x| io.finite("method", x));
    let [step, ..] = numbers;
    *method = match (which, numbers) {
        (0, _) => Method::Rk4 { step },
        (1, _) => Method::Abm4 { step },
        (2, [relative, absolute, max_step, first_step]) => Method::Adams { relative, absolute, max_step, first_step },
        (3, _) => Method::Gauss6 { step },
        _ => return io.refuse("method"),
    };
    io.require("method", Sim::head(*method).is_ok());
}

fn each_of_clock<R: Real>(clock: &mut Clock<R>, io: &mut impl Fields<R>) {
    let (mut which, mut base, mut steps) = match *clock {
        Clock::Counted { base, steps } => (0, base, steps),
        Clock::Set => (1, R::zero(), 0),
        Clock::Running => (2, R::zero(), 0),
    };
    io.word("clock", &mut which);
    io.finite("base", &mut base);
    io.total("counted", &mut steps);
    *clock = match which {
        0 => Clock::Counted { base, steps },
        1 => Clock::Set,
        2 => Clock::Running,
        _ => return io.refuse("clock"),
    };
}

fn each_of_missed<R: Real>(missed: &mut Missed<R>, io: &mut impl Fields<R>, coordinates: usize) {
    let Missed { coordinate, length, time } = missed;
    io.count("missed", coordinate, coordinates.saturating_sub(1));
    io.real("missed", length);
    io.real("missed", time);
}

fn each_of_balance<R: Real>(balance: &mut Balance<R>, io: &mut impl Fields<R>) {
    let Balance { first, size, kinetic, speed, drift, time } = balance;
    for x in [first, size, kinetic, speed, drift, time] {
        io.real("balance", x);
    }
}

/// Looks whether the numbers of one array may be what they are.
fn obeys<R: Real>(rule: Rule, values: impl Iterator<Item = R>) -> bool {
    let mut from = R::zero();
    let mut zero = true;
    values.enumerate().all(|(i, x)| {
        if rule != Rule::Commands {
            return rule == Rule::Any || x.is_finite();
        }
        // (t, u, u̇, ü) twice.
        let k = i % CHANNEL_LEN;
        zero = x == R::zero() && (zero || k == 0);
        if k == 0 {
            from = x;
        }
        let ends = k == CHANNEL_LEN / 2;
        x.is_finite() && (!ends || zero || x > from)
    })
}

impl<R: Real> Sim<'_, R> {
    /// Bytes that [`Sim::save`] writes. O(1).
    pub fn save_len(&self) -> usize {
        let reals: usize = arrays!(&self.state,).iter().map(|(_, _, array)| array.len()).sum();
        (HEAD + self.survey().words + reals + 1) * WORD
    }

    /// Unknowns and coordinates.
    fn sizes(&self) -> (usize, usize) {
        (self.state.y.len(), self.model.coordinates.len())
    }

    fn survey(&self) -> Survey {
        let mut progress = *self.progress;
        Survey::of(|survey| progress.each(survey, self.sizes()))
    }

    /// Writes all that the simulation remembers: state, method, clock, the integrator's past, channels, counters, estimates, the limit
    /// of steps. Loaded into any simulation of an equal model, in any process, it goes on from there bit for bit. (Who factorizes
    /// large systems, see [`Sim::set_factorization`], is not part of it.) Returns the bytes written: [`Sim::save_len`]. About 30 words of
    /// 8 bytes per unknown of the state.
    ///
    /// # Errors
    /// `MemoryTooSmall`; `BadSave` if a number has left the range of what can be loaded, such as a position that is not finite.
    /// `out` is then not written.
    pub fn save(&self, out: &mut [u8]) -> Result<usize> {
        let (len, survey, given) = (self.save_len(), self.survey(), out.len());
        let small = || Error::new(Status::MemoryTooSmall).of("length", given as f64);
        let out = out.get_mut(..len).ok_or_else(small)?;
        let arrays = arrays!(&self.state,);
        let broken = arrays.iter().find(|(rule, _, array)| !obeys(*rule, array.iter().copied()));
        if let Some(what) = survey.refused.or(broken.map(|(_, name, _)| *name)) {
            return Err(bad(what));
        }
        let mut writer = Writer { room: out.as_chunks_mut().0.iter_mut(), digest: Digest::new() };
        let names = survey.names.value();
        for word in [MARK, VERSION, names, size_of::<R>() as u64, self.model.fingerprint(), len as u64] {
            writer.put(word);
        }
        let mut progress = *self.progress;
        progress.each(&mut writer, self.sizes());
        for x in arrays.iter().flat_map(|(_, _, array)| array.iter()) {
            writer.put(x.to_word());
        }
        let digest = writer.digest.value();
        writer.put(digest);
        Ok(len)
    }

    /// Makes the simulation what was saved, by itself or by another one of an equal model; the method is the saved one, too. What is
    /// asked next costs one evaluation.
    ///
    /// # Errors
    /// `BadSave`, which names what is wrong with the bytes: `mark` (they are something else), `version` (of another version of this
    /// library), `precision`, `model`, `length`, `checksum` (they were damaged), or a value that no simulation could have. The
    /// simulation is then as it was.
    pub fn load(&mut self, bytes: &[u8]) -> Result<()> {
        let named = |what, value: u64| Err(Error::new(Status::BadSave).of(what, value as f64));
        let given = bytes.len() as u64;
        let (words, rest) = bytes.as_chunks::<WORD>();
        let mut reader = Reader { words: words.iter(), refused: None };
        let [mark, version, names, precision, model, len] = [(); HEAD].map(|()| reader.get());
        if words.len() <= HEAD {
            return named("length", given);
        }
        if mark != MARK {
            return Err(bad("mark"));
        }
        let own = self.survey();
        if version != VERSION || names != own.names.value() {
            return named("version", version);
        }
        if precision != size_of::<R>() as u64 {
            return named("precision", precision);
        }
        if model != self.model.fingerprint() {
            return Err(bad("model"));
        }
        if !rest.is_empty() || len != given || given != self.save_len() as u64 {
            return named("length", given);
        }
        let mut digest = Digest::new();
        let (last, before) = words.split_last().ok_or(bad("length"))?;
        before.iter().for_each(|word| digest.word(u64::from_le_bytes(*word)));
        if u64::from_le_bytes(*last) != digest.value() {
            return Err(bad("checksum"));
        }

        let mut progress = *self.progress;
        progress.each(&mut reader, self.sizes());
        let mut reals = reader.words.clone().map(|word| R::from_word(u64::from_le_bytes(*word)));
        for (rule, name, array) in arrays!(&self.state,) {
            let mut fits = true;
            let values = reader.words.by_ref().take(array.len()).map(|word| {
                let word = u64::from_le_bytes(*word);
                let x = R::from_word(word);
                fits &= x.to_word() == word;
                x
            });
            if !obeys(rule, values) || !fits {
                reader.refused.get_or_insert(name);
                break;
            }
        }
        if let Some(what) = reader.refused {
            return Err(bad(what));
        }

        *self.progress = progress;
        for (_, _, array) in arrays!(&mut self.state, mut) {
            array.iter_mut().zip(&mut reals).for_each(|(x, new)| *x = new);
        }
        copy(self.evaluation.coordinates.channels, self.state.commands);
        (self.evaluation.kept.shown, self.evaluation.kept.before) = (false, self.progress.arrived);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_that_was_missed_is_saved_if_its_coordinate_is_one_of_the_model() {
        for coordinates in 1..5 {
            for coordinate in 0..6 {
                let mut missed = Missed { coordinate, length: 0.1, time: 2.0 };
                let survey = Survey::of(|survey| each_of_missed(&mut missed, survey, coordinates));
                assert_eq!(survey.refused.is_none(), coordinate < coordinates, "{coordinate} of {coordinates}");
            }
        }
    }
}
