//! Prints how errors compare with indicators over random scenes: `cargo run --release -p nekton-tests --example indicators >
//! docs/accuracy/indicators.csv`. Argument: number of evaluations. In parts: `scenes FROM TO` prints the evaluations of these scenes,
//! one a line, and `table FILE…` the table of all that such files hold; `scene NUMBER` tells what a scene is.

use nekton_tests::indicator_study::{Summary, lines, summary, summary_of, told};
use std::io::Write;

fn print(summary: &Summary) {
    print!("{}", summary.table);
    let [scenes, unknown, refused] = summary.counts;
    eprintln!(
        "{scenes} scenes, {refused} evaluations refused; left out {unknown} scenes whose reference does not converge"
    );
}

fn main() -> std::io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let number = |word: &str| word.parse().unwrap_or(0);
    match words[..] {
        ["scenes", from, to] => {
            let mut out = std::io::stdout();
            for index in number(from)..number(to) {
                if index % 10 == 0 {
                    eprintln!("scene {index} of {from} to {to}");
                }
                let mut text = String::new();
                lines(index, index + 1, |line| text = format!("{text}{line}\n"));
                out.write_all(text.as_bytes())?;
                out.flush()?;
            }
        }
        ["scene", index] => print!("{}", told(number(index))),
        ["table", ref files @ ..] => {
            let texts: std::io::Result<Vec<String>> = files.iter().map(std::fs::read_to_string).collect();
            print(&summary_of(&texts?.concat()));
        }
        [] => print(&summary(6000)),
        [count, ..] => print(&summary(number(count) as usize)),
    }
    Ok(())
}
