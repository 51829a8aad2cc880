//! Circles of files that use each other.

use super::imports::Sources;
use std::collections::{BTreeSet, VecDeque};

/// For each file the files that it uses itself; what is only passed on does not count.
fn used(sources: &Sources) -> Vec<BTreeSet<usize>> {
    let mut used = vec![BTreeSet::new(); sources.files.len()];
    for import in sources.imports.iter().filter(|import| !import.passed_on) {
        used[import.from].insert(import.to);
    }
    used
}

/// Files reached from one, each with the file from which it was reached first.
fn reached(used: &[BTreeSet<usize>], from: usize) -> Vec<Option<usize>> {
    let mut by = vec![None; used.len()];
    let mut queue = VecDeque::from([from]);
    while let Some(file) = queue.pop_front() {
        for &next in &used[file] {
            if by[next].is_none() {
                by[next] = Some(file);
                queue.push_back(next);
            }
        }
    }
    by
}

/// Files that reach each other.
pub struct Knot {
    pub files: Vec<usize>,
    /// A shortest circle among them.
    pub circle: Vec<usize>,
}

/// All sets of two or more files that reach each other.
pub fn knots(sources: &Sources) -> Vec<Knot> {
    let used = used(sources);
    let reach: Vec<_> = (0..used.len()).map(|file| reached(&used, file)).collect();
    let mut knots = Vec::new();
    let mut done: BTreeSet<usize> = BTreeSet::new();
    for file in 0..used.len() {
        if reach[file][file].is_none() || done.contains(&file) {
            continue;
        }
        let files: Vec<usize> =
            (0..used.len()).filter(|&other| reach[file][other].is_some() && reach[other][file].is_some()).collect();
        done.extend(&files);
        let back = |start: usize| {
            let mut circle = vec![start];
            let mut at = reach[start][start];
            while let Some(file) = at.filter(|&file| file != start) {
                circle.push(file);
                at = reach[start][file];
            }
            circle[1..].reverse();
            circle
        };
        let circle = files.iter().map(|&start| back(start)).min_by_key(Vec::len).unwrap_or_default();
        knots.push(Knot { files, circle });
    }
    knots
}

fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// What is wrong with the circles of a crate, where circles of at most so many files may stand inside one folder.
pub fn faults(name: &str, sources: &Sources, most: usize) -> Vec<String> {
    let mut faults = Vec::new();
    for Knot { files, circle } in knots(sources) {
        let apart = files.iter().any(|&file| folder(&sources.files[file]) != folder(&sources.files[files[0]]));
        if !apart && files.len() <= most {
            continue;
        }
        let steps: Vec<String> = circle
            .iter()
            .zip(circle.iter().cycle().skip(1))
            .filter_map(|(&from, &to)| {
                let mut all = sources.imports.iter();
                let import = all.find(|import| (import.from, import.to) == (from, to) && !import.passed_on)?;
                Some(format!("    {name}/{}:{} uses {}", sources.files[from], import.line, import.path))
            })
            .collect();
        let names: Vec<&str> = files.iter().map(|&file| sources.files[file].as_str()).collect();
        let why = if apart { " of different folders" } else { "" };
        faults.push(format!(
            "{name}: {} files{why} use each other in a circle: {}. Move what one of them needs of the next to a file of its \
             own, or hand it over as an argument. A shortest circle:\n{}",
            names.len(),
            names.join(", "),
            steps.join("\n")
        ));
    }
    faults
}
