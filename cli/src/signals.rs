//! Signals that ask a run to end: it ends at the next row of its tables. The second one ends the process at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// What was asked so far.
pub struct Asked([(&'static str, Arc<AtomicBool>); 2]);

impl Asked {
    /// The signal that came.
    pub fn signal(&self) -> Option<&'static str> {
        self.0.iter().find(|(_, came)| came.load(Ordering::Relaxed)).map(|(name, _)| *name)
    }
}

/// From now on signals are noted. Where that cannot be had, they end the process as before.
pub fn listen() -> Asked {
    Asked([("SIGINT", SIGINT), ("SIGTERM", SIGTERM)].map(|(name, signal)| {
        let came = Arc::new(AtomicBool::new(false));
        // In this order: a second signal finds that the first has come.
        let _ =
            flag::register_conditional_default(signal, came.clone()).and_then(|_| flag::register(signal, came.clone()));
        (name, came)
    }))
}
