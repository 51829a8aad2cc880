//! Prints how far random drives are from a run cut where they change: `cargo run --release -p nekton-tests --example drives >
//! docs/accuracy/drives.csv`. Argument: number of scenes (500).

use nekton_tests::drive_study::{HEADER, judge};

fn main() {
    let scenes: u64 = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(500);
    print!("{HEADER}");
    let mut silent = 0;
    for k in 0..scenes {
        match judge(k) {
            Ok(all) => {
                for judged in all {
                    silent += usize::from(judged.error > 100.0 && !judged.noticed);
                    print!("{}", judged.row);
                }
            }
            Err(error) => println!("{k},refused: {error}"),
        }
        if k % 20 == 19 {
            eprintln!("{} of {scenes} scenes, {silent} silently wrong", k + 1);
        }
    }
    assert_eq!(silent, 0, "errors above a hundred tolerances without a notice");
}
