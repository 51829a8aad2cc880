//! What the C interface promises, whatever is asked of it.

use nekton_fuzz::{Random, Reached, run};

#[test]
fn every_call_returns_and_keeps_its_promises_for_random_scenes_and_calls() {
    let reached: Vec<Reached> = (1..=300).map(|seed| run(&Random::new(seed).script())).collect();
    // The test would be worth little if all scenes were refused.
    let moved = reached.iter().filter(|r| **r == Reached::Motion).count();
    println!("{moved} of {} moved", reached.len());
    assert!(moved > 20);
}

#[test]
fn what_fuzzing_found_stays_mended() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("findings");
    // No folder: nothing was found.
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry").path();
        println!("{}", path.display());
        run(&std::fs::read(&path).expect("a finding"));
    }
}

#[test]
fn no_bytes_at_all_are_a_script_too() {
    run(&[]);
    for byte in 0..=255 {
        run(&[byte]);
        run(&[byte; 200]);
    }
}
