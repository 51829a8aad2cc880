//! Errors on their way to C.

use crate::types::{
    NEKTON_PLACE_BODY, NEKTON_PLACE_LINK, NEKTON_PLACE_NONE, NEKTON_PLACE_OBSTACLE, NEKTON_PLACE_SCENE,
    NEKTON_PLACE_TANK, nekton_diag, nekton_place, nekton_status,
};
use core::ffi::c_char;
use nekton::{Error, Place, Status};

/// An error, the array item it is about, and the time that was reached.
#[derive(Clone, Copy)]
pub(crate) struct Fault {
    pub(crate) error: Error,
    pub(crate) item: i32,
    pub(crate) time: f64,
}

pub(crate) type Outcome<T = ()> = Result<T, Fault>;

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Fault { error, item: -1, time: f64::NAN }
    }
}

impl From<Status> for Fault {
    fn from(status: Status) -> Self {
        Error::new(status).into()
    }
}

impl Fault {
    /// A fault of a named argument.
    pub(crate) fn of(status: Status, what: &'static str, value: f64) -> Self {
        Error::new(status).of(what, value).into()
    }
    pub(crate) fn at(mut self, place: Place) -> Self {
        self.error.place = place;
        self
    }
}

fn index(i: usize) -> i32 {
    i32::try_from(i).unwrap_or(i32::MAX)
}

const NOWHERE: nekton_place = nekton_place { kind: NEKTON_PLACE_NONE, index: -1, link: -1 };

impl From<Place> for nekton_place {
    fn from(place: Place) -> Self {
        let (kind, index, link) = match place {
            Place::Scene => (NEKTON_PLACE_SCENE, -1, -1),
            Place::Tank => (NEKTON_PLACE_TANK, -1, -1),
            Place::Obstacle(i) => (NEKTON_PLACE_OBSTACLE, index(i), -1),
            Place::Body(b) => (NEKTON_PLACE_BODY, index(b), -1),
            Place::Link(b, l) => (NEKTON_PLACE_LINK, index(b), index(l)),
            _ => (NEKTON_PLACE_SCENE, -1, -1),
        };
        nekton_place { kind, index, link }
    }
}

/// A place that may be none.
pub(crate) fn place_or_none(place: Option<Place>) -> nekton_place {
    place.map_or(NOWHERE, nekton_place::from)
}

/// The place that C names, if there is such a kind.
pub(crate) fn place_of(place: &nekton_place) -> Option<Place> {
    let index = usize::try_from(place.index);
    match place.kind {
        NEKTON_PLACE_SCENE => Some(Place::Scene),
        NEKTON_PLACE_TANK => Some(Place::Tank),
        NEKTON_PLACE_OBSTACLE => Some(Place::Obstacle(index.ok()?)),
        NEKTON_PLACE_BODY => Some(Place::Body(index.ok()?)),
        NEKTON_PLACE_LINK => Some(Place::Link(index.ok()?, usize::try_from(place.link).ok()?)),
        _ => None,
    }
}

impl nekton_diag {
    const fn ok() -> Self {
        nekton_diag {
            status: 0,
            place: NOWHERE,
            other: NOWHERE,
            item: -1,
            value: f64::NAN,
            limit: f64::NAN,
            time: f64::NAN,
            what: [0; 32],
        }
    }
    fn of(fault: &Fault) -> Self {
        let mut diag = nekton_diag {
            status: fault.error.status.code(),
            place: fault.error.place.into(),
            other: place_or_none(fault.error.other),
            item: fault.item,
            value: fault.error.value,
            limit: fault.error.limit,
            time: fault.time,
            ..Self::ok()
        };
        // One byte stays 0.
        for (to, from) in diag.what.iter_mut().take(31).zip(fault.error.what.bytes()) {
            *to = from as c_char;
        }
        diag
    }
}

/// Reports an outcome: fills `diag` if there is one, and returns the number.
pub(crate) unsafe fn report(diag: *mut nekton_diag, outcome: Outcome<Status>) -> nekton_status {
    let diag_of = match &outcome {
        Ok(status) => nekton_diag { status: status.code(), ..nekton_diag::ok() },
        Err(fault) => nekton_diag::of(fault),
    };
    // SAFETY: the caller promises that `diag` is NULL or points to a nekton_diag.
    unsafe { note(diag, diag_of) }
}

/// The same for a call that may end with a notice.
pub(crate) unsafe fn report_notice(diag: *mut nekton_diag, outcome: Outcome<Option<Fault>>) -> nekton_status {
    let diag_of = match &outcome {
        Ok(None) => nekton_diag::ok(),
        Ok(Some(notice)) => nekton_diag::of(notice),
        Err(fault) => nekton_diag::of(fault),
    };
    // SAFETY: as above.
    unsafe { note(diag, diag_of) }
}

unsafe fn note(diag: *mut nekton_diag, content: nekton_diag) -> nekton_status {
    if !diag.is_null() && diag.is_aligned() {
        // SAFETY: checked, and the caller promises room.
        unsafe { diag.write(content) };
    }
    content.status
}

/// Text written byte by byte as far as there is room.
struct Text<'a> {
    rest: &'a mut [u8],
}

impl Text<'_> {
    fn byte(&mut self, b: u8) {
        if let Some((first, rest)) = core::mem::take(&mut self.rest).split_first_mut() {
            *first = b;
            self.rest = rest;
        }
    }
    fn text(&mut self, s: &str) {
        s.bytes().for_each(|b| self.byte(b));
    }
    fn integer(&mut self, mut n: u32) {
        let mut digits = [0; 10];
        let mut used = 0;
        for slot in digits.iter_mut().rev() {
            *slot = b'0' + (n % 10) as u8;
            n /= 10;
            used += 1;
            if n == 0 {
                break;
            }
        }
        digits.iter().skip(digits.len() - used).for_each(|b| self.byte(*b));
    }
    fn place(&mut self, place: &nekton_place) {
        let (name, numbers) = match place.kind {
            NEKTON_PLACE_TANK => ("tank", [-1, -1]),
            NEKTON_PLACE_OBSTACLE => ("obstacle ", [place.index, -1]),
            NEKTON_PLACE_BODY => ("body ", [place.index, -1]),
            NEKTON_PLACE_LINK => ("body ", [place.index, place.link]),
            _ => ("scene", [-1, -1]),
        };
        self.text(name);
        for (before, n) in ["", ", link "].into_iter().zip(numbers) {
            if let Ok(n) = u32::try_from(n) {
                self.text(before);
                self.integer(n);
            }
        }
    }
    /// Six digits: enough to recognize a value; the exact one is in the struct.
    fn number(&mut self, x: f64) {
        if x < 0.0 {
            self.byte(b'-');
        }
        let mut m = x.abs();
        if m == f64::INFINITY {
            return self.text("inf");
        }
        if m < 1e6 && m == (m as u32) as f64 {
            return self.integer(m as u32);
        }
        let mut exponent = 0;
        while m >= 9.999_995 && exponent < 400 {
            m /= 10.0;
            exponent += 1;
        }
        while m < 0.999_999_5 && exponent > -400 {
            m *= 10.0;
            exponent -= 1;
        }
        let digits = (m * 1e5 + 0.5) as u32;
        self.integer(digits / 100_000);
        self.byte(b'.');
        let mut unit = 10_000;
        while unit > 0 {
            self.byte(b'0' + (digits / unit % 10) as u8);
            unit /= 10;
        }
        if exponent != 0 {
            self.byte(b'e');
            if exponent < 0 {
                self.byte(b'-');
            }
            self.integer(i32::unsigned_abs(exponent));
        }
    }
}

/// "place: text (with other) (what[item] = value beside limit) at t = time" into `buffer`, always ended by 0.
pub(crate) fn describe(diag: &nekton_diag, buffer: &mut [u8]) {
    let Some((last, room)) = buffer.split_last_mut() else { return };
    *last = 0;
    let mut out = Text { rest: room };
    if diag.place.kind > NEKTON_PLACE_SCENE {
        out.place(&diag.place);
        out.text(": ");
    }
    out.text(Status::from_code(diag.status).map_or("unknown status", Status::text));
    if diag.other.kind > NEKTON_PLACE_SCENE {
        out.text(" (with ");
        out.place(&diag.other);
        out.text(")");
    }
    if diag.what[0] != 0 {
        out.text(" (");
        for b in diag.what.iter().take(31).take_while(|b| **b != 0) {
            out.byte(*b as u8);
        }
        if let Ok(item) = u32::try_from(diag.item) {
            out.text("[");
            out.integer(item);
            out.text("]");
        }
        if !diag.value.is_nan() {
            out.text(" = ");
            out.number(diag.value);
        }
        if !diag.limit.is_nan() {
            out.text(" beside ");
            out.number(diag.limit);
        }
        out.text(")");
    }
    if !diag.time.is_nan() {
        out.text(" at t = ");
        out.number(diag.time);
    }
    out.byte(0);
}
