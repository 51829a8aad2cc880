//! Pseudo-random scripts for some seconds: `random SECONDS [SEED]`. Stops at the first claim that fails, with its seed.

use nekton_fuzz::{Random, Reached};
use std::time::{Duration, Instant};

fn main() {
    let mut words = std::env::args().skip(1);
    let mut number = |default: u64| words.next().map_or(default, |w| w.parse().expect("a number"));
    let (seconds, first) = (number(10), number(1));
    let (start, mut counts) = (Instant::now(), [0_u64; 4]);
    let mut slowest = (Duration::ZERO, 0);
    let mut seed = first;
    while start.elapsed() < Duration::from_secs(seconds) {
        let script = Random::new(seed).script();
        let begin = Instant::now();
        match std::panic::catch_unwind(|| nekton_fuzz::run(&script)) {
            Ok(reached) => counts[reached as usize] += 1,
            Err(_) => {
                eprintln!("seed {seed}");
                std::process::exit(1);
            }
        }
        slowest = slowest.max((begin.elapsed(), seed));
        seed += 1;
    }
    println!("{} scripts from seed {first} on; slowest {:.1?} (seed {})", seed - first, slowest.0, slowest.1);
    for reached in [Reached::Scene, Reached::Model, Reached::Simulation, Reached::Motion] {
        println!("ended at {reached:?}: {}", counts[reached as usize]);
    }
}
