//! What a run has to say so far as words and texts: one walk over every field writes and reads. Every record is taken apart without
//! `..`, so that a new field cannot be forgotten.

use nekton::status::{Error, Place, Status};
use nekton::{Resolution, TimeError};

use crate::record::{Energies, Nearest, Record, Row};
use crate::watch::{Episode, Watch};

/// Fields on their way out or in, one after the other.
pub enum Io<'b> {
    /// Bytes so far.
    Out(Vec<u8>),
    /// Bytes left; and whether all were there until now.
    In(&'b [u8], bool),
}

impl Io<'_> {
    /// A whole number.
    pub fn word(&mut self, x: &mut u64) {
        match self {
            Io::Out(bytes) => bytes.extend(x.to_le_bytes()),
            Io::In(bytes, whole) => match bytes.split_first_chunk() {
                Some((word, rest)) => (*x, *bytes) = (u64::from_le_bytes(*word), rest),
                None => (*x, *whole) = (0, false),
            },
        }
    }

    /// A number, bit for bit.
    pub fn real(&mut self, x: &mut f64) {
        let mut word = x.to_bits();
        self.word(&mut word);
        *x = f64::from_bits(word);
    }

    fn reals(&mut self, all: &mut [f64]) {
        all.iter_mut().for_each(|x| self.real(x));
    }

    /// Bytes with their number.
    pub fn bytes(&mut self, x: &mut Vec<u8>) {
        let mut count = x.len() as u64;
        self.word(&mut count);
        match self {
            Io::Out(bytes) => bytes.extend(&*x),
            Io::In(bytes, whole) => match usize::try_from(count).ok().and_then(|n| bytes.split_at_checked(n)) {
                Some((own, rest)) => (*x, *bytes) = (own.to_vec(), rest),
                None => *whole = false,
            },
        }
    }

    /// A text.
    pub fn text(&mut self, x: &mut String) {
        let mut bytes = x.as_bytes().to_vec();
        self.bytes(&mut bytes);
        if let Io::In(_, whole) = self {
            match String::from_utf8(bytes) {
                Ok(text) => *x = text,
                Err(_) => *whole = false,
            }
        }
    }

    /// A list.
    pub fn list<T: Default>(&mut self, list: &mut Vec<T>, mut each: impl FnMut(&mut Self, &mut T)) {
        let mut count = list.len() as u64;
        self.word(&mut count);
        if let Io::In(bytes, whole) = self {
            // Every item takes a byte at least.
            *whole &= count <= bytes.len() as u64;
            let count = if *whole { count as usize } else { 0 };
            list.clear();
            list.resize_with(count, T::default);
        }
        list.iter_mut().for_each(|item| each(self, item));
    }

    fn optional<T>(&mut self, value: &mut Option<T>, new: impl FnOnce() -> T, each: impl FnOnce(&mut Self, &mut T)) {
        let mut there = u64::from(value.is_some());
        self.word(&mut there);
        if there == 0 {
            *value = None;
        } else {
            each(self, value.get_or_insert_with(new));
        }
    }
}

/// What a run has written so far: rows and remarks. The rest of a record is known before the first step or at the end.
pub fn record(io: &mut Io<'_>, record: &mut Record) {
    let Record {
        rows,
        smallest,
        notices,
        drifts,
        links: _,
        joints: _,
        outlines: _,
        obstacles: _,
        tank: _,
        terms: _,
        tolerance: _,
        stopped: _,
        plan: _,
        settings: _,
        figures: _,
    } = record;
    io.list(rows, row);
    let nearest = || Nearest { distance: 0.0, time: 0.0, between: String::new() };
    io.optional(smallest, nearest, |io, Nearest { distance, time, between }| {
        io.real(distance);
        io.real(time);
        io.text(between);
    });
    io.list(notices, |io, text| io.text(text));
    io.list(drifts, |io, (size, text)| {
        io.real(size);
        io.text(text);
    });
}

fn row(io: &mut Io<'_>, row: &mut Row) {
    let Row { t, pose, velocity, energy, impulse, gap, resolution, time_error, torque } = row;
    io.real(t);
    io.list(pose, |io, x| io.reals(x));
    io.list(velocity, |io, x| io.reals(x));
    let Energies { kinetic_fluid, kinetic_bodies, buoyancy, repulsion, circulation, total, work } = energy;
    for x in [kinetic_fluid, kinetic_bodies, buoyancy, repulsion, circulation, total, work] {
        io.real(x);
    }
    io.reals(impulse);
    io.real(gap);
    let Resolution { mass, force, quadrature, repulsion } = resolution;
    for x in [mass, force, quadrature, repulsion] {
        io.real(x);
    }
    let TimeError { length, angle, speed, spin, length_sum, angle_sum, speed_sum, spin_sum, unknown } = time_error;
    for x in [length, angle, speed, spin, length_sum, angle_sum, speed_sum, spin_sum] {
        io.real(x);
    }
    io.word(unknown);
    io.list(torque, |io, x| io.reals(x));
}

/// What is being noticed.
pub fn watch(io: &mut Io<'_>, watch: &mut Watch) {
    let Watch { episodes } = watch;
    for episode in episodes {
        let new = || Episode { from: 0.0, worst: (0.0, Error::new(Status::Ok)), gap: 0.0 };
        io.optional(episode, new, |io, Episode { from, worst: (time, worst), gap }| {
            io.real(from);
            io.real(time);
            error(io, worst);
            io.real(gap);
        });
    }
}

fn error(io: &mut Io<'_>, error: &mut Error) {
    let Error { status, place: first, other, what, value, limit } = error;
    let mut code = i64::from(status.code()) as u64;
    io.word(&mut code);
    *status = i32::try_from(code as i64).ok().and_then(Status::from_code).unwrap_or(Status::Internal);
    place(io, first);
    io.optional(other, Place::default, place);
    let mut name = (*what).to_owned();
    io.text(&mut name);
    if name != *what {
        // A name of the core, of which there are a few; it is kept until the process ends.
        *what = Box::leak(name.into_boxed_str());
    }
    io.real(value);
    io.real(limit);
}

fn place(io: &mut Io<'_>, place: &mut Place) {
    let (mut kind, mut a, mut b) = match *place {
        Place::Tank => (1, 0, 0),
        Place::Obstacle(i) => (2, i as u64, 0),
        Place::Body(b) => (3, b as u64, 0),
        Place::Link(b, l) => (4, b as u64, l as u64),
        _ => (0, 0, 0),
    };
    [&mut kind, &mut a, &mut b].into_iter().for_each(|x| io.word(x));
    let (i, l) = (a as usize, b as usize);
    *place = match kind {
        1 => Place::Tank,
        2 => Place::Obstacle(i),
        3 => Place::Body(i),
        4 => Place::Link(i, l),
        _ => Place::Scene,
    };
}
