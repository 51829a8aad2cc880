//! What takes long and makes no steps says so.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::ending::warn;

/// Silence before the first line, and between two lines.
const PATIENCE: Duration = Duration::from_secs(2);
const PAUSE: Duration = Duration::from_secs(10);

/// While it lives, a line on standard error tells from time to time what is being done and since when; nothing in the first two seconds.
pub struct Waiting(Option<(Sender<()>, JoinHandle<()>)>);

impl Waiting {
    pub fn new(what: &'static str) -> Self {
        let (end, ended) = channel();
        let clock = Instant::now();
        let tell = move || {
            let mut wait = PATIENCE;
            while ended.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                warn(&format!("{what}: {:.0} s", clock.elapsed().as_secs_f64()));
                wait = PAUSE;
            }
        };
        // Where no thread can be had, nothing is told.
        Waiting(std::thread::Builder::new().spawn(tell).ok().map(|thread| (end, thread)))
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.0.take() {
            drop(end);
            // No line after the end.
            let _ = thread.join();
        }
    }
}
