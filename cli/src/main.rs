//! nekton
mod scene_file;
fn main() {
    for a in std::env::args().skip(1) {
        match scene_file::SceneFile::open(a.as_ref()) { Ok(s) => println!("{:?}", s.labels()), Err(e) => println!("{e}") }
    }
}
