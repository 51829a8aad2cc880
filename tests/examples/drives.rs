//! Prints how far random drives are from a run cut where they change: `cargo run --release -p nekton-tests --example drives >
//! docs/accuracy/drives.csv`. Arguments: number of scenes (500), the first one (0).

use nekton_tests::drive_study::{HEADER, judge};

fn main() {
    let number = |at: usize, usual: u64| std::env::args().nth(at).and_then(|n| n.parse().ok()).unwrap_or(usual);
    let (scenes, first) = (number(1, 500), number(2, 0));
    print!("{HEADER}");
    let mut silent = 0;
    for k in first..first + scenes {
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
            eprintln!("scene {} of {}, {silent} silently wrong", k + 1, first + scenes);
        }
    }
    assert_eq!(silent, 0, "errors above a hundred tolerances without a notice");
}
