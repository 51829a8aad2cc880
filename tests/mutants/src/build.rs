//! Which changes compile: what does not is replaced by the next of the order.

use crate::Folders;
use crate::copy::{Written, write};
use crate::sample::Order;
use std::collections::BTreeSet;
use std::process::Command;

/// Cargo in the copy.
pub fn cargo(folders: &Folders, arguments: &[&str]) -> Command {
    let mut command = Command::new("nice");
    command.arg("cargo").args(arguments).current_dir(folders.copy());
    // Set by the cargo that runs this program.
    command.env_remove("CARGO").env_remove("CARGO_MANIFEST_DIR");
    // What core stands on is compiled already.
    command.env("CARGO_TARGET_DIR", folders.root.join("target"));
    command
}

/// The first `count` changes that compile together. The copy is left with these.
pub fn compiled(folders: &Folders, order: &Order, count: usize) -> Result<Vec<usize>, String> {
    let memory = folders.work.join(format!("refused-{:016x}.txt", order.hash));
    let mut refused: BTreeSet<usize> = std::fs::read_to_string(&memory)
        .unwrap_or_default()
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    for _ in 0..40 {
        let out = |id: &usize| refused.contains(id) || order.idle.contains(id);
        let chosen: Vec<usize> = (0..order.mutants.len()).filter(|id| !out(id)).take(count).collect();
        let written = write(folders, order, &chosen)?;
        let output = cargo(folders, &["check", "--package", "nekton", "--message-format=short"])
            .output()
            .map_err(|error| format!("cargo: {error}"))?;
        if output.status.success() {
            println!("{} changes compile, {} of those before them do not", chosen.len(), refused.len());
            return Ok(chosen);
        }
        let text = String::from_utf8_lossy(&output.stderr);
        let before = refused.len();
        refused.extend(text.lines().filter_map(|line| blamed(line, &written)));
        if refused.len() == before {
            return Err(format!("no change is to blame:\n{text}"));
        }
        println!("{} do not compile", refused.len());
        let words: Vec<String> = refused.iter().map(usize::to_string).collect();
        std::fs::write(&memory, words.join(" ")).map_err(|error| format!("{}: {error}", memory.display()))?;
    }
    Err("changes that compile were not found".into())
}

/// The change that an error message is about: `path:line:column: error…`.
fn blamed(line: &str, written: &[Written]) -> Option<usize> {
    let mut parts = line.splitn(4, ':');
    let (path, row, column) =
        (parts.next()?, parts.next()?.parse::<usize>().ok()?, parts.next()?.parse::<usize>().ok()?);
    if !parts.next()?.trim_start().starts_with("error") {
        return None;
    }
    let file = written.iter().find(|file| file.file == path)?;
    let begin: usize = file.text.split_inclusive('\n').take(row - 1).map(str::len).sum();
    let text = file.text.get(begin..)?.lines().next()?;
    let at = begin + text.chars().take(column - 1).map(char::len_utf8).sum::<usize>();
    let within = file.switches.iter().filter(|(range, _)| range.contains(&at));
    if let Some((_, id)) = within.min_by_key(|(range, _)| range.len()) {
        return Some(*id);
    }
    // An expression of which a switch is a part.
    let line = begin..begin + text.len();
    let beside = file.switches.iter().filter(|(range, _)| range.start < line.end && line.start < range.end);
    beside.min_by_key(|(range, _)| range.start.abs_diff(at)).map(|(_, id)| *id)
}
