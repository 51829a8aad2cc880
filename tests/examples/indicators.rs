//! Prints how errors compare with indicators over random scenes: `cargo run --release -p nekton-tests --example indicators >
//! docs/accuracy/indicators.csv`. Argument: number of evaluations.

fn main() {
    let evaluations = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(6000);
    print!("{}", nekton_tests::indicator_study::summary(evaluations).table);
}
