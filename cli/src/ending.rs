//! How commands end, and how they speak.

use std::io::{Error, ErrorKind, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::scene_file::Problem;

/// How a command ended that did not fail.
pub enum Ending {
    /// As asked.
    Complete,
    /// With results, but before the end.
    Stopped,
}

/// Why standard output failed, if it did: the first time counts.
static FAILED: Mutex<Option<Error>> = Mutex::new(None);

/// Prints to standard output; a reader that has gone away (`nekton … | head`) is no error, all else is kept for [`spoken`]: a run
/// writes its results all the same.
pub fn say(text: &str) {
    let mut out = std::io::stdout();
    if let Err(e) = writeln!(out, "{text}").and_then(|()| out.flush())
        && e.kind() != ErrorKind::BrokenPipe
    {
        FAILED.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(e);
    }
}

/// Prints to standard error; if that cannot be written, nobody can be told.
pub fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Whether everything that was said could be written.
pub fn spoken() -> Result<(), Problem> {
    let failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner).take();
    failed.map_or(Ok(()), |e| Err(Problem::file(Path::new("standard output"), format!("cannot be written: {e}"))))
}
