//! Files that a scene names: regular ones, of bounded size.

use std::fs::{File, FileType};
use std::io::Read;
use std::path::Path;

/// Bytes of a table, at most: some millions of rows.
pub const TABLE: u64 = 256 << 20;
/// Bytes of an outline, at most.
pub const OUTLINE: u64 = 16 << 20;
/// Bytes of a scene, at most.
pub const SCENE: u64 = 64 << 20;

/// Reads a regular file of at most `most` bytes; what else there may be has no end, or waits for a writer. The error completes
/// "cannot be read: ".
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let told = |e: std::io::Error| e.to_string();
    // Before it is opened: opening a pipe would wait.
    let kind = std::fs::metadata(path).map_err(told)?.file_type();
    if !kind.is_file() {
        return Err(format!("it is {}, not a regular file", name(kind)));
    }
    bounded(File::open(path).map_err(told)?, most)
}

/// Everything that a reader gives, if that is not too much.
pub fn bounded(from: impl Read, most: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    from.take(most + 1).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    if bytes.len() as u64 > most {
        return Err(format!("it has more than the {} MiB that are read of such a file", most >> 20));
    }
    Ok(bytes)
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_dir() {
        "a folder"
    } else if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn name(kind: FileType) -> &'static str {
    if kind.is_dir() { "a folder" } else { "a device" }
}
