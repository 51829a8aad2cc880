//! The figures of the paper's section 9, computed anew.
//!
//! `paper passing [--quick] FOLDER`, `paper fish ALONE BETWEEN FOLDER` (the first two are results of `nekton run`).

mod fish;
mod panels;
mod passing;

use std::error::Error;
use std::path::Path;

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["passing", "--quick", folder] => passing::figures(Path::new(folder), true),
        ["passing", folder] => passing::figures(Path::new(folder), false),
        ["fish", alone, between, folder] => fish::figures(Path::new(alone), Path::new(between), Path::new(folder)),
        _ => Err("usage: paper passing [--quick] FOLDER | paper fish ALONE BETWEEN FOLDER".into()),
    }
}

fn write(folder: &Path, name: &str, text: &str) -> Outcome {
    std::fs::create_dir_all(folder)?;
    Ok(std::fs::write(folder.join(name), text)?)
}

/// A number as tables have it.
fn decimals(x: f64) -> String {
    format!("{x:.3e}")
}
