//! The changes of all files, in an order that depends on a seed and on what each of them changes: where core is written
//! anew, the rest of a sample stays as it was.

use crate::find::{Mutant, mutants, without_tests};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// All changes, shuffled; their places are their numbers.
pub struct Order {
    pub mutants: Vec<Mutant>,
    /// Those in files that only tests are made of: drawn with the others, but not tried.
    pub idle: BTreeSet<usize>,
    /// Files of core with their text.
    pub files: Vec<(String, String)>,
    /// Of all of that text but the tests: another test leaves what is known as it is.
    pub hash: u64,
}

/// Modules that are compiled for benchmarks or tests only are left out, with the modules below them.
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
        idle.extend(modules.iter().map(|module| folder_of(&name, module)));
        files.push((name, text));
    }
    all.retain(|m| !idle.iter().any(|module| is_file_of(&m.file, module)));
    shuffle(&mut all, seed);
    let below = |file: &str| idle.iter().any(|module| is_file_of(file, module) || file.starts_with(module));
    let idle = (0..all.len()).filter(|&id| below(&all[id].file)).collect();
    let mut hash = seed;
    for (name, text) in files.iter().filter(|(name, _)| !below(name)) {
        hash = fold(fold(hash, name.as_bytes()), without_tests(text)?.as_bytes());
    }
    Ok(Order { mutants: all, idle, files, hash })
}

/// Where the modules below `module` of a file are looked for, with the last slash.
fn folder_of(file: &str, module: &str) -> String {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let folder = stem.strip_suffix("/mod").or_else(|| stem.strip_suffix("/lib")).unwrap_or(stem);
    format!("{folder}/{module}/")
}

/// Whether a file is the module whose folder is given.
fn is_file_of(file: &str, module: &str) -> bool {
    let folder = module.trim_end_matches('/');
    file.strip_prefix(folder).is_some_and(|rest| rest == ".rs" || rest == "/mod.rs")
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

/// Sorts by a hash of what is changed into what; equal changes of equal lines stay in their order.
fn shuffle(all: &mut [Mutant], seed: u64) {
    all.sort_by_cached_key(|m| {
        let parts = [m.file.as_str(), &m.function, &m.code, &m.column.to_string(), &m.change()].join("\n");
        mixed(fold(seed, parts.as_bytes()))
    });
}

/// SplitMix64's last steps: every bit depends on every bit.
fn mixed(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod test {
    use super::{folder_of, is_file_of, shuffle};
    use crate::find::mutants;

    #[test]
    fn a_sample_keeps_what_is_not_written_anew() {
        let order = |text: &str| {
            let (mut all, _) = mutants("core/src/a.rs", text).unwrap();
            shuffle(&mut all, 1);
            all.iter().map(|m| format!("{} {}", m.function, m.change())).collect::<Vec<String>>()
        };
        let before = order("fn f(x: f64) -> f64 {\n    g(x);\n    -x * 2.0 + x\n}\n");
        let mut after =
            order("fn h(y: f64) -> f64 {\n    y - 3.0\n}\nfn f(x: f64) -> f64 {\n    g(x);\n    -x * 2.0 + x\n}\n");
        after.retain(|words| !words.starts_with('h'));
        assert!(before.len() > 5 && before == after, "{before:?} {after:?}");
    }

    #[test]
    fn modules_are_files_or_folders_beside_the_one_that_declares_them() {
        let tests = folder_of("core/src/integrate/mod.rs", "tests");
        assert_eq!(tests, "core/src/integrate/tests/");
        assert_eq!(folder_of("core/src/lib.rs", "base"), "core/src/base/");
        let of_a_file = folder_of("core/src/base/once.rs", "tests");
        assert!(
            is_file_of("core/src/integrate/tests/mod.rs", &tests)
                && is_file_of("core/src/base/once/tests.rs", &of_a_file)
        );
        assert!(!is_file_of("core/src/integrate/tests/accuracy.rs", &tests));
    }
}
