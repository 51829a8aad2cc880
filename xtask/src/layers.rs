//! `cargo xtask layers`: the order of the layers of core, held against what its files import, and the picture of them. Also:
//! no circles between the files of the other crates.

mod circles;
mod imports;
mod list;
mod picture;
#[cfg(test)]
mod tests;

use imports::Sources;
use list::{LAYERS, layer_of};
use nekton_steps::{Outcome, read, root};
use std::path::Path;
use std::process::ExitCode;

const PICTURE: &str = "docs/layers.svg";
/// Pages that show the list.
const PAGES: [&str; 2] = ["docs/architecture.md", "CONTRIBUTING.md"];
/// Circles of more files than these are forbidden inside one folder of core; a mod.rs and files that use what it defines
/// may make a small one.
const MOST_IN_CIRCLE: usize = 3;
/// The other crates, in which no file is in a circle.
const OTHERS: [&str; 4] = ["ffi/src", "cli/src", "bench/src", "xtask/src"];

/// The imports of a crate.
fn sources(root: &Path, folder: &str) -> Result<Sources, String> {
    let place = root.join(folder);
    imports::read(&|path| std::fs::read_to_string(place.join(path)).ok()).map_err(|why| format!("{folder}: {why}"))
}

/// Imports of core against the order.
fn upward(sources: &Sources) -> Vec<String> {
    let mut faults = Vec::new();
    for file in &sources.files {
        if layer_of(file).is_none() {
            faults.push(format!(
                "core/src/{file} belongs to no layer: move it into the folder of one, or name it in xtask/src/layers/list.rs"
            ));
        }
    }
    for import in &sources.imports {
        let (from, to) = (&sources.files[import.from], &sources.files[import.to]);
        let (Some(here), Some(there)) = (layer_of(from), layer_of(to)) else { continue };
        let (here, there) = (&LAYERS[here], &LAYERS[there]);
        if here.name == there.name || here.level > there.level {
            continue;
        }
        let why = if here.level == there.level { "is on the same level" } else { "comes later" };
        faults.push(format!(
            "core/src/{from}:{}: {} uses {} of core/src/{to}, but {} {why}. Move what both need down, hand it over as an \
             argument, or move what needs both up (CONTRIBUTING.md, Layers of core)",
            import.line, here.name, import.path, there.name
        ));
    }
    faults
}

/// Whether some paragraph, list or table of a page names the layers in their order.
fn lists_layers(page: &str) -> bool {
    let word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    page.split("\n\n").any(|block| {
        let mut words = block.split(|c: char| !word(c)).map(|word| word.trim_end_matches('.'));
        LAYERS.iter().all(|layer| {
            words.any(|word| word.strip_suffix(".rs").unwrap_or(word) == layer.name.trim_end_matches(".rs"))
        })
    })
}

/// Everything that is wrong in a checkout.
fn faults(root: &Path) -> Result<Vec<String>, String> {
    let core = sources(root, "core/src")?;
    let mut faults = upward(&core);
    faults.extend(circles::faults("core/src", &core, MOST_IN_CIRCLE));
    for folder in OTHERS {
        faults.extend(circles::faults(folder, &sources(root, folder)?, 1));
    }
    for page in PAGES {
        let names: Vec<&str> = LAYERS.iter().map(|layer| layer.name).collect();
        match read(&root.join(page)) {
            Ok(text) if !lists_layers(&text) => {
                faults.push(format!("{page} does not show the layers in their order: {}", names.join(", ")));
            }
            _ => {}
        }
    }
    if read(&root.join(PICTURE)).ok() != Some(picture::draw(&core)) {
        faults.push(format!("{PICTURE} is not what the imports give: cargo xtask layers --picture"));
    }
    Ok(faults)
}

/// A step of the whole test run.
pub fn step() -> Outcome {
    checked(&root()).into()
}

fn checked(root: &Path) -> Result<(), String> {
    let faults = faults(root)?;
    faults.iter().for_each(|fault| println!("{fault}"));
    match faults.len() {
        0 => Ok(()),
        n => Err(format!("{n} faults, the first one: {}", faults[0].lines().next().unwrap_or(""))),
    }
}

/// `cargo xtask layers [FOLDER]`: checks this checkout or another one.
pub fn run(folder: Option<&str>) -> ExitCode {
    let root = folder.map_or_else(root, Into::into);
    match checked(&root) {
        Ok(()) => {
            println!("every import of core/src runs down, and there are no circles");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// `cargo xtask layers --picture [FOLDER]`.
pub fn write_picture(folder: Option<&str>) -> ExitCode {
    let root = folder.map_or_else(root, Into::into);
    let written = sources(&root, "core/src").and_then(|core| {
        std::fs::write(root.join(PICTURE), picture::draw(&core)).map_err(|error| format!("{PICTURE}: {error}"))
    });
    crate::archive::finish(written, PICTURE)
}
