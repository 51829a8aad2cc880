//! Ratios that a busy machine disturbs little: candidates take turns, and medians of the rounds count.

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

/// Runs candidates in turns, `rounds` times, each as often per round as `seconds` allow. Returns the median time of one
/// call of each.
pub fn in_turns(rounds: usize, seconds: f64, candidates: &mut [&mut dyn FnMut()]) -> Vec<f64> {
    let mut calls = Vec::new();
    for candidate in candidates.iter_mut() {
        candidate();
        let start = Instant::now();
        candidate();
        calls.push(((seconds / start.elapsed().as_secs_f64().max(1e-9)) as usize).clamp(1, 1_000_000));
    }
    let mut times = vec![Vec::new(); candidates.len()];
    for _ in 0..rounds {
        for ((candidate, calls), times) in candidates.iter_mut().zip(&calls).zip(&mut times) {
            let start = Instant::now();
            for _ in 0..*calls {
                candidate();
            }
            times.push(start.elapsed().as_secs_f64() / *calls as f64);
        }
    }
    times.into_iter().map(median).collect()
}
