//! Status codes and errors. One list makes the enum, its numbers and its texts.

use core::fmt;

macro_rules! statuses {
    ($( $(#[$doc:meta])* $name:ident = $code:literal, $text:literal; )*) => {
        /// Outcome of an operation. 0 is success, positive a notice, negative an error.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
        #[repr(i32)]
        #[non_exhaustive]
        pub enum Status { $( $(#[$doc])* #[doc = $text] $name = $code, )* }
        impl Status {
            /// Every status, in the order of the list.
            pub const ALL: &'static [Status] = &[$(Status::$name),*];
            /// The number used across the C interface.
            pub const fn code(self) -> i32 { self as i32 }
            /// One line of text, without place or value.
            pub const fn text(self) -> &'static str { match self { $(Status::$name => $text,)* } }
            /// The text followed by a zero byte, as C wants it.
            #[doc(hidden)]
            pub const fn text_with_nul(self) -> &'static str {
                match self { $(Status::$name => concat!($text, "\0"),)* }
            }
            /// The name followed by a zero byte, as C wants it.
            #[doc(hidden)]
            pub const fn name_with_nul(self) -> &'static str {
                match self { $(Status::$name => concat!(stringify!($name), "\0"),)* }
            }
            /// The status of this number.
            pub fn from_code(code: i32) -> Option<Status> {
                Status::ALL.iter().copied().find(|s| s.code() == code)
            }
            /// The name as written in the list.
            pub const fn name(self) -> &'static str { match self { $(Status::$name => stringify!($name),)* } }
        }
    };
}

statuses! {
    Ok = 0, "ok";
    OutlineReversed = 1, "the outline runs clockwise and was turned round";
    Unresolved = 2, "the error in space may exceed the tolerance asked for, or a thousandth";
    StepTooLong = 3, "the step is too long for the motion: its error is a tenth of a body or more";
    DriveUnresolved = 4, "the step is too long for what a drive does within it";
    EnergyDrift = 5, "energy and the work of the drives do not balance";
    PointRepeated = 6, "the first point is repeated at the end and was dropped";
    CornersFound = 7, "kinks of the points were taken as corners";
    OutlineUncertain = 8, "the points leave the outline uncertain: give more where it bends, or name its corners";
    MemoryTooSmall = -1, "the memory given is smaller than required";
    NotFinite = -2, "a value is not finite";
    OutOfRange = -3, "a value is out of its range";
    EmptyScene = -4, "the scene has no body";
    NodeCount = -5, "a node count must be even, at least 8 and at most 65536, or 0 for automatic";
    BadShape = -6, "the shape's measures do not describe an outline";
    SelfIntersection = -7, "the outline crosses itself";
    BadParent = -8, "a link's parent must be an earlier link of the same body";
    Overlap = -9, "two boundaries touch or overlap";
    OutsideTank = -10, "a body or obstacle is not inside the tank";
    Massless = -11, "a body without mass cannot be accelerated in a fluid without density";
    BadTable = -12, "a table's times must increase";
    SizeOverflow = -13, "the scene is too large to be addressed";
    Contact = -14, "two bodies came into contact";
    Singular = -15, "a matrix is singular to working precision";
    NonFiniteState = -16, "the motion became infinite or undefined";
    StepTooSmall = -17, "the step is too small for the tolerance asked for or for the digits of the time";
    TooManySteps = -18, "more steps are needed than one call may make: lengthen the step, loosen the tolerance or raise the step limit";
    BadStep = -19, "the step must be positive and finite";
    BadTolerance = -20, "a tolerance must be positive and not below rounding";
    Length = -21, "a buffer has the wrong length";
    Unsupported = -22, "not available for this scene or this build";
    Internal = -23, "an internal consistency check failed (please report it)";
    NullPointer = -24, "a pointer that must not be NULL is NULL";
    Misaligned = -25, "memory is not aligned as required";
    AbiVersion = -26, "not initialized, or compiled for another version of the interface";
    BadHandle = -27, "this is no object of this library: not initialized, freed, or its model was replaced";
    OutOfMemory = -28, "no memory could be had";
    UnknownKind = -29, "a kind or flag has no such value";
    Aliasing = -30, "two buffers overlap that must not";
    NoConvergence = -31, "the equations of an implicit step were not solved: the step is too long";
    Busy = -32, "another thread uses this simulation";
    BadSave = -33, "these bytes are no state that was saved of this model by this version";
    PastTime = -34, "the time asked for lies before the present time";
    BoundExceeded = -35, "the error in space may be as large as the result: more nodes are needed";
}

/// Where in the scene something is wrong. Indices count from 0; walls and bodies are counted apart.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Place {
    /// The scene as a whole.
    #[default]
    Scene,
    /// The tank.
    Tank,
    /// An obstacle.
    Obstacle(usize),
    /// A body.
    Body(usize),
    /// A link of a body: (body, link within the body).
    Link(usize, usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Scene => f.write_str("scene"),
            Place::Tank => f.write_str("tank"),
            Place::Obstacle(i) => write!(f, "obstacle {i}"),
            Place::Body(b) => write!(f, "body {b}"),
            Place::Link(b, l) => write!(f, "body {b}, link {l}"),
        }
    }
}

/// What went wrong, where, and the value that shows it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Error {
    /// What went wrong.
    pub status: Status,
    /// Where.
    pub place: Place,
    /// The other party of a contact or overlap.
    pub other: Option<Place>,
    /// The offending quantity's name, as the scene spells it ("" when there is none).
    pub what: &'static str,
    /// The offending value (NaN when there is none).
    pub value: f64,
    /// What it had to keep to (NaN when that is no single number).
    pub limit: f64,
}

/// Result of every fallible operation.
pub type Result<T, E = Error> = core::result::Result<T, E>;

impl Error {
    /// An error without place or value.
    pub const fn new(status: Status) -> Self {
        Error { status, place: Place::Scene, other: None, what: "", value: f64::NAN, limit: f64::NAN }
    }
    /// The same error at a place.
    pub const fn at(mut self, place: Place) -> Self {
        self.place = place;
        self
    }
    /// The same error naming a second place.
    pub const fn with(mut self, other: Place) -> Self {
        self.other = Some(other);
        self
    }
    /// The same error naming the quantity and its value.
    pub const fn of(mut self, what: &'static str, value: f64) -> Self {
        self.what = what;
        self.value = value;
        self
    }
    /// The same error naming what the value had to keep to.
    pub const fn beside(mut self, limit: f64) -> Self {
        self.limit = limit;
        self
    }
}

impl From<Status> for Error {
    fn from(status: Status) -> Self {
        Error::new(status)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.status.text())?;
        if let Some(other) = self.other {
            write!(f, " (with {other})")?;
        }
        if !self.what.is_empty() {
            write!(f, " ({} = {}", self.what, self.value)?;
            if !self.limit.is_nan() {
                write!(f, " beside {}", self.limit)?;
            }
            f.write_str(")")?;
        }
        Ok(())
    }
}

impl core::error::Error for Error {}
