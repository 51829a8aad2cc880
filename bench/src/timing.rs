//! Ratios that a busy machine disturbs little: candidates take turns, their own processor time counts, and of the rounds
//! the median.
#![allow(unsafe_code)]

use std::time::Instant;

/// Median of some numbers.
pub fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    match x.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => x[n / 2],
        n => 0.5 * (x[n / 2 - 1] + x[n / 2]),
    }
}

/// Seconds that this thread has run.
pub fn thread_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is good; the clock exists on every Unix that Rust's std runs on.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Seconds since some moment.
fn wall_seconds() -> f64 {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// What came out.
pub struct Measured {
    /// Seconds.
    pub time: f64,
    /// Seconds that it is divided by; 1 if the time itself is meant.
    pub by: f64,
    /// The value that `must` and `aim` speak of: the median of the ratios, or the time itself.
    pub ratio: f64,
    /// What else is worth knowing.
    pub note: String,
}

impl Measured {
    /// A time that is not divided by another.
    pub fn seconds(time: f64, note: String) -> Self {
        Measured { time, by: 1.0, ratio: time, note }
    }
}

/// How many rounds, how long a round of one candidate is, by which clock.
#[derive(Clone, Copy)]
pub struct Turns {
    /// Rounds.
    pub rounds: usize,
    /// Seconds of a candidate per round.
    pub seconds: f64,
    /// Seconds since some moment.
    pub clock: fn() -> f64,
}

impl Turns {
    /// For work on one thread.
    pub const THREAD: Turns = Turns { rounds: 21, seconds: 4e-3, clock: thread_seconds };
    /// For work on several threads.
    pub const WALL: Turns = Turns { rounds: 21, seconds: 4e-3, clock: wall_seconds };

    /// Median seconds of one call of each candidate, and the medians of their ratios to the last one.
    pub fn run(self, candidates: &mut [&mut dyn FnMut()]) -> (Vec<f64>, Vec<f64>) {
        let mut calls = Vec::new();
        for candidate in candidates.iter_mut() {
            candidate();
            let start = (self.clock)();
            candidate();
            calls.push(((self.seconds / ((self.clock)() - start).max(1e-9)) as usize).clamp(1, 1_000_000));
        }
        let mut times = vec![Vec::new(); candidates.len()];
        for _ in 0..self.rounds {
            for ((candidate, calls), times) in candidates.iter_mut().zip(&calls).zip(&mut times) {
                let start = (self.clock)();
                for _ in 0..*calls {
                    candidate();
                }
                times.push(((self.clock)() - start) / *calls as f64);
            }
        }
        let last = times.last().cloned().unwrap_or_default();
        let ratios = times.iter().map(|t| median(t.iter().zip(&last).map(|(t, l)| t / l).collect())).collect();
        (times.into_iter().map(median).collect(), ratios)
    }
}
