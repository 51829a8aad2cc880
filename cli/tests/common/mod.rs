//! Runs the command in a folder of its own.
#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder with files, removed at the end.
pub struct Place {
    folder: tempfile::TempDir,
}

/// What the command did.
pub struct Done {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Place {
    pub fn new(scene: &str) -> Self {
        let place = Place { folder: tempfile::tempdir().unwrap() };
        place.put("scene.toml", scene);
        place
    }
    pub fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), text).unwrap();
    }
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }
    /// Names in the folder, hidden ones included.
    pub fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }
    pub fn nekton(&self, arguments: &[&str]) -> Done {
        nekton(self.folder.path(), arguments)
    }
    pub fn run(&self) -> Done {
        self.nekton(&["run", "scene.toml", "--out", "results"])
    }
}

pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub fn nekton(folder: &Path, arguments: &[&str]) -> Done {
    let output = Command::new(env!("CARGO_BIN_EXE_nekton")).current_dir(folder).args(arguments).output().unwrap();
    Done {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Two bodies, the first with a hinge, half a second.
pub const GOOD: &str = r#"[fluid]
density = 1.0

[[body]]
name = "fish"
position = [0.0, 0.0]
velocity = [0.1, 0.0]
[[body.link]]
name = "head"
shape = { ellipse = [1.0, 0.4] }
density = 1.0
nodes = 32
[[body.link]]
name = "tail"
shape = { ellipse = [0.8, 0.3] }
density = 1.0
nodes = 32
parent = "head"
hinge = { parent = [-1.2, 0.0], self = [1.0, 0.0] }
motion = { harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }

[[body]]
name = "stone"
position = [0.0, 3.0]
[[body.link]]
name = "stone"
shape = { rectangle = [1.0, 1.0], radius = 0.3 }
density = 2.0
nodes = 64

[run]
duration = 0.5
output_interval = 0.1
integrator = { method = "adams", tolerance = 1e-6 }
"#;

/// GOOD with one passage replaced.
pub fn changed(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replacen(from, to, 1)
}
