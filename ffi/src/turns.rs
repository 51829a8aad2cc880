//! Who uses a simulation just now: one call that may write, or any number that only read. Nobody waits; who comes in between is
//! refused. Without atomic operations (as on a Cortex-M0) nothing is noticed, and the rule is the caller's duty alone.

use crate::diag::Outcome;

#[cfg(target_has_atomic = "ptr")]
use {
    crate::diag::Fault,
    core::sync::atomic::{AtomicUsize, Ordering},
    nekton::Status,
};

/// The number of readers, or [`WRITER`].
pub(crate) struct Turns {
    #[cfg(target_has_atomic = "ptr")]
    users: AtomicUsize,
}

#[cfg(target_has_atomic = "ptr")]
const WRITER: usize = usize::MAX;

/// A turn, which ends when this is dropped.
pub(crate) struct Turn<'a> {
    turns: &'a Turns,
}

#[cfg(target_has_atomic = "ptr")]
fn busy<T>() -> Outcome<T> {
    Err(Fault::of(Status::Busy, "sim", f64::NAN))
}

#[cfg(target_has_atomic = "ptr")]
impl Turns {
    pub(crate) const fn new() -> Self {
        Turns { users: AtomicUsize::new(0) }
    }

    /// The turn of one that may write: nobody else has one.
    pub(crate) fn write(&self) -> Outcome<Turn<'_>> {
        match self.users.compare_exchange(0, WRITER, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => Ok(Turn { turns: self }),
            Err(_) => busy(),
        }
    }

    /// The turn of one that only reads: nobody writes.
    pub(crate) fn read(&self) -> Outcome<Turn<'_>> {
        let one_more = |users: usize| users.checked_add(1).filter(|n| *n != WRITER);
        match self.users.fetch_update(Ordering::Acquire, Ordering::Relaxed, one_more) {
            Ok(_) => Ok(Turn { turns: self }),
            Err(_) => busy(),
        }
    }

    fn end(&self) {
        // A writer is alone, and then nobody else changes the number.
        if self.users.compare_exchange(WRITER, 0, Ordering::Release, Ordering::Relaxed).is_err() {
            self.users.fetch_sub(1, Ordering::Release);
        }
    }
}

#[cfg(not(target_has_atomic = "ptr"))]
impl Turns {
    pub(crate) const fn new() -> Self {
        Turns {}
    }
    pub(crate) fn write(&self) -> Outcome<Turn<'_>> {
        Ok(Turn { turns: self })
    }
    pub(crate) fn read(&self) -> Outcome<Turn<'_>> {
        Ok(Turn { turns: self })
    }
    fn end(&self) {}
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.turns.end();
    }
}
