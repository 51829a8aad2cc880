//! `nekton run --checkpoint`: what a run needs to go on after its process has ended, in one file that is replaced as a whole.

mod walk;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::ending::{say, warn};
use crate::record::Record;
use crate::scene_file::Problem;
use crate::watch::Watch;
use nekton::Sim;
use walk::Io;

/// "nekton C", and the number of the format.
const MARK: u64 = u64::from_le_bytes(*b"nekton C");
const VERSION: u64 = 1;
const FILE: &str = "checkpoint.nekton";

/// What is asked for.
pub struct Wish {
    /// The folder of the checkpoint.
    pub folder: Option<PathBuf>,
    /// Time between two of them, of the wall clock.
    pub every: Duration,
    /// Go on from the one that is there.
    pub resume: bool,
    /// Replace what is there.
    pub force: bool,
}

/// A run that can be gone on with.
pub struct Checkpoint {
    file: PathBuf,
    every: Duration,
    /// What must be equal for a run to be the same one, by name.
    identity: Vec<(String, String)>,
    last: Instant,
    resume: bool,
    complained: bool,
}

/// How far a run had come.
#[derive(Default)]
struct Saved {
    identity: Vec<(String, String)>,
    next: u64,
    sim: Vec<u8>,
    record: Record,
    watch: Watch,
}

/// The walk over all of it, out or in.
fn walk_all(
    io: &mut Io<'_>,
    identity: &mut Vec<(String, String)>,
    next: &mut u64,
    sim: &mut Vec<u8>,
    record: &mut Record,
    watch: &mut Watch,
) {
    io.list(identity, |io, (name, value)| {
        io.text(name);
        io.text(value);
    });
    io.word(next);
    io.bytes(sim);
    walk::record(io, record);
    walk::watch(io, watch);
}

/// A digest (FNV-1a) that changes with every byte.
fn digest(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |d, b| (d ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3))
}

impl Saved {
    /// What a file holds; none if it is another one or was damaged.
    fn read(file: &[u8]) -> Option<Saved> {
        let mut io = Io::In(file, true);
        let (mut mark, mut version, mut sum) = (0, 0, 0);
        [&mut mark, &mut version, &mut sum].into_iter().for_each(|x| io.word(x));
        let mut saved = Saved::default();
        let known = matches!(&io, Io::In(rest, true) if mark == MARK && version == VERSION && digest(rest) == sum);
        if !known {
            return None;
        }
        let Saved { identity, next, sim, record, watch } = &mut saved;
        walk_all(&mut io, identity, next, sim, record, watch);
        matches!(io, Io::In([], true)).then_some(saved)
    }
}

impl Checkpoint {
    /// Looks at the folder, before anything is computed. `record` is what is known before the first step.
    pub fn open(wish: &Wish, fingerprint: u64, record: &Record) -> Result<Option<Self>, Problem> {
        let Some(folder) = &wish.folder else { return Ok(None) };
        let file = folder.join(FILE);
        if folder.exists() && !folder.is_dir() {
            return Err(Problem::file(folder, "is not a folder").hint("name another folder with --checkpoint"));
        }
        if file.exists() && !wish.resume && !wish.force {
            return Err(Problem::file(folder, "holds the checkpoint of a run that has not come to its end")
                .hint("add --resume to go on with it, or --force to begin anew"));
        }
        let refused =
            |e| Problem::file(folder, format!("cannot be written: {e}")).hint("name another folder with --checkpoint");
        fs::create_dir_all(folder).map_err(refused)?;
        tempfile::NamedTempFile::new_in(folder).map_err(refused)?;
        let mut identity = vec![
            ("scene".to_owned(), format!("{fingerprint:016x}")),
            ("links".to_owned(), record.links.join(", ")),
            ("version of nekton".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ];
        // Where the scene file is, is of no importance.
        identity.extend(record.settings.iter().filter(|(name, _)| name != "scene file").cloned());
        Ok(Some(Checkpoint {
            file,
            every: wish.every,
            identity,
            last: Instant::now(),
            resume: wish.resume,
            complained: false,
        }))
    }

    /// Whether it is to be gone on from.
    pub fn resumes(&self) -> bool {
        self.resume
    }

    /// Goes on from the checkpoint: the number of the next row, or none if there is no checkpoint yet.
    pub fn resume(
        &mut self,
        sim: &mut Sim<'_, f64>,
        record: &mut Record,
        watch: &mut Watch,
    ) -> Result<Option<usize>, Problem> {
        let bytes = match fs::read(&self.file) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                say(&format!("{}: there is no checkpoint yet; the run begins at its start", self.file.display()));
                return Ok(None);
            }
            Err(e) => return Err(Problem::file(&self.file, format!("cannot be read: {e}"))),
        };
        let anew = "--force instead of --resume begins anew";
        let Some(saved) = Saved::read(&bytes) else {
            return Err(
                Problem::file(&self.file, "is no checkpoint of this version of nekton, or was damaged").hint(anew)
            );
        };
        if let Some(text) = self.difference(&saved.identity) {
            return Err(Problem::file(&self.file, format!("is the checkpoint of another run: {text}"))
                .hint(format!("run what it was made from, or name another folder with --checkpoint; {anew}")));
        }
        sim.load(&saved.sim)
            .map_err(|e| Problem::file(&self.file, format!("cannot be gone on from: {e}")).hint(anew))?;
        let known = std::mem::replace(record, saved.record);
        let Record { rows, smallest, notices, drifts, .. } = std::mem::take(record);
        *record = Record { rows, smallest, notices, drifts, ..known };
        *watch = saved.watch;
        say(&format!("the run goes on at t = {:.6} s", sim.time()));
        Ok(Some(saved.next as usize))
    }

    /// The first thing in which a run differs from this one.
    fn difference(&self, other: &[(String, String)]) -> Option<String> {
        for (name, now) in &self.identity {
            let was = other.iter().find(|(n, _)| n == name).map_or("nothing", |(_, was)| was);
            if was != now {
                // The digits of a fingerprint tell nobody anything.
                let text = format!("{name} was {was}, now it is {now}");
                return Some(if name == "scene" { "the scene is not the same in every value".into() } else { text });
            }
        }
        let gone = other.iter().find(|(n, _)| !self.identity.iter().any(|(name, _)| n == name));
        gone.map(|(name, was)| format!("{name} was {was}"))
    }

    /// After a row: writes if it is time to, or at once. A disc that is full ends no run, but is told once.
    pub fn keep(&mut self, now: bool, next: usize, sim: &Sim<'_, f64>, record: &mut Record, watch: &mut Watch) {
        if !now && self.last.elapsed() < self.every {
            return;
        }
        let written = self.bytes(next, sim, record, watch).and_then(|bytes| self.replace(&bytes));
        if let Err(why) = written
            && !self.complained
        {
            warn(&format!("{}: the checkpoint cannot be written: {why}; the run goes on", self.file.display()));
            self.complained = true;
        }
        self.last = Instant::now();
    }

    /// What the file is to hold.
    fn bytes(
        &mut self,
        next: usize,
        sim: &Sim<'_, f64>,
        record: &mut Record,
        watch: &mut Watch,
    ) -> Result<Vec<u8>, String> {
        let mut bytes = vec![0; sim.save_len()];
        sim.save(&mut bytes).map_err(|e| e.to_string())?;
        let mut io = Io::Out(Vec::new());
        walk_all(&mut io, &mut self.identity, &mut (next as u64), &mut bytes, record, watch);
        let Io::Out(body) = io else { return Err("nothing was written".into()) };
        let head = [MARK, VERSION, digest(&body)].map(u64::to_le_bytes);
        Ok([head.as_flattened(), &body].concat())
    }

    /// The file appears whole or not at all, whenever the process ends.
    fn replace(&self, bytes: &[u8]) -> Result<(), String> {
        let folder = self.file.parent().unwrap_or(Path::new("."));
        let mut file = tempfile::NamedTempFile::new_in(folder).map_err(|e| e.to_string())?;
        file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(|e| e.to_string())?;
        file.persist(&self.file).map_err(|e| e.to_string())?;
        Ok(())
    }

    /// The run has come to its end: there is nothing to go on with.
    pub fn done(&self) {
        let _ = fs::remove_file(&self.file);
    }
}
