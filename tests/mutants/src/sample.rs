//! The changes of all files, in an order that depends on a seed and on the files alone.

use crate::find::{Mutant, mutants};
use std::path::{Path, PathBuf};

/// All changes, shuffled; their places are their numbers.
pub struct Order {
    pub mutants: Vec<Mutant>,
    /// Files of core with their text.
    pub files: Vec<(String, String)>,
    /// Of all of that text.
    pub hash: u64,
}

/// Files whose modules are compiled for benchmarks or tests only are left out.
pub fn order(root: &Path, seed: u64) -> Result<Order, String> {
    let source = root.join("core/src");
    let mut paths = Vec::new();
    walk(&source, &mut paths)?;
    paths.sort();
    let mut files = Vec::new();
    let (mut all, mut idle) = (Vec::new(), Vec::new());
    for path in paths {
        let text = read(&path)?;
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let (found, modules) = mutants(&name, &text)?;
        all.extend(found);
        // Where the module `name` of this file is looked for.
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut folder = path.parent().unwrap_or(root).to_path_buf();
        if !["lib", "mod"].contains(&stem.as_str()) {
            folder.push(stem);
        }
        idle.extend(modules.iter().flat_map(|m| [folder.join(format!("{m}.rs")), folder.join(m).join("mod.rs")]));
        files.push((name, text));
    }
    let idle: Vec<String> =
        idle.iter().map(|p| p.strip_prefix(root).unwrap_or(p).to_string_lossy().replace('\\', "/")).collect();
    all.retain(|m| !idle.contains(&m.file));
    shuffle(&mut all, seed);
    let hash = files.iter().fold(seed, |hash, (name, text)| fold(fold(hash, name.as_bytes()), text.as_bytes()));
    Ok(Order { mutants: all, files, hash })
}

/// Every Rust file below a folder.
pub fn walk(folder: &Path, out: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            walk(&path, out)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            out.push(path);
        }
    }
    Ok(())
}

/// The text of a file.
pub fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// A hash that goes on (FNV-1a).
pub fn fold(hash: u64, bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(hash ^ 0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}

fn shuffle<T>(items: &mut [T], seed: u64) {
    let mut state = seed;
    for k in (1..items.len()).rev() {
        // SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = state;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
        items.swap(k, (x % (k as u64 + 1)) as usize);
    }
}
