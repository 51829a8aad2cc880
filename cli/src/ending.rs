//! How commands end, and how they speak.

use std::io::Write;

/// How a command ended that did not fail.
pub enum Ending {
    /// As asked.
    Complete,
    /// With results, but before the end.
    Stopped,
}

/// Prints to standard output; a reader that has gone away (`nekton … | head`) is no error.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
