//! Tables, and files that appear whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::record::Record;
use crate::scene_file::Problem;

/// A file to be written: name and content.
pub type File = (&'static str, Vec<u8>);

/// Every name that a run may write. Those of an earlier run that this one does not write are removed.
const NAMES: &[&str] = &[
    "trajectory.csv",
    "energy.csv",
    "torque.csv",
    "resolution.csv",
    "trajectories.svg",
    "energy.svg",
    "momentum.svg",
    "torque.svg",
    "resolution.svg",
    "report.html",
];

/// The four tables. Numbers have 17 significant digits, so that reading them gives the same bits back.
pub fn tables(record: &Record) -> Vec<File> {
    let mut trajectory = vec!["t".to_owned()];
    for link in &record.links {
        trajectory.extend(["x", "y", "theta", "vx", "vy", "omega"].map(|c| format!("{link}.{c}")));
    }
    let energy = ["t", "kinetic_fluid", "kinetic_bodies", "buoyancy", "repulsion", "circulation", "total", "work"];
    let mut torque = vec!["t".to_owned()];
    torque.extend(record.joints.iter().flat_map(|j| [format!("{j}.torque"), format!("{j}.power")]));
    let trajectories = record.rows.iter().map(|r| {
        let links = r.pose.iter().zip(&r.velocity).flat_map(|(p, v)| p.iter().chain(v));
        std::iter::once(&r.t).chain(links).copied().collect()
    });
    let energies = record.rows.iter().map(|r| {
        let e = &r.energy;
        vec![r.t, e.kinetic_fluid, e.kinetic_bodies, e.buoyancy, e.repulsion, e.circulation, e.total, e.work]
    });
    let torques = record.rows.iter().map(|r| std::iter::once(&r.t).chain(r.torque.iter().flatten()).copied().collect());
    let resolution = [
        "t",
        "mass",
        "force",
        "quadrature",
        "repulsion",
        "bound",
        "time_length",
        "time_angle",
        "time_speed",
        "time_spin",
    ];
    let resolutions = record.rows.iter().map(|r| {
        let i = &r.resolution;
        let [length, angle, speed, spin] = r.time_errors();
        vec![r.t, i.mass, i.force, i.quadrature, i.repulsion, i.bound(), length, angle, speed, spin]
    });
    vec![
        ("trajectory.csv", table(&trajectory, trajectories)),
        ("energy.csv", table(&energy.map(str::to_owned), energies)),
        ("torque.csv", table(&torque, torques)),
        ("resolution.csv", table(&resolution.map(str::to_owned), resolutions)),
    ]
}

fn table(header: &[String], rows: impl Iterator<Item = Vec<f64>>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory cannot fail, and all rows have the header's length.
    let _ = writer.write_record(header);
    for row in rows {
        let _ = writer.write_record(row.iter().map(|x| format!("{x:.16e}")));
    }
    writer.into_inner().unwrap_or_default()
}

/// A folder that results will go to.
pub struct Target {
    folder: PathBuf,
}

impl Target {
    /// Checks before a long computation that the folder can be written, without leaving a trace.
    pub fn check(folder: &Path) -> Result<Self, Problem> {
        check(folder, NAMES)?;
        Ok(Target { folder: folder.to_owned() })
    }

    fn refused(&self, error: &io::Error) -> Problem {
        Problem::file(&self.folder, format!("cannot be written: {error}")).hint("name another folder with --out")
    }

    /// Writes all files into a temporary folder beside their place, then moves them there.
    pub fn write(&self, files: &[File]) -> Result<(), Problem> {
        self.try_write(files).map_err(|e| self.refused(&e))
    }

    fn try_write(&self, files: &[File]) -> io::Result<()> {
        let fresh = !self.folder.exists();
        let home = if fresh { parent(&self.folder) } else { &self.folder };
        fs::create_dir_all(home)?;
        let temporary = temporary(home)?;
        for (name, content) in files {
            fs::write(temporary.path().join(name), content)?;
        }
        if fresh {
            let path = temporary.keep();
            readable(&path)?;
            return fs::rename(&path, &self.folder).inspect_err(|_| {
                let _ = fs::remove_dir_all(&path);
            });
        }
        for (name, _) in files {
            fs::rename(temporary.path().join(name), self.folder.join(name))?;
        }
        for name in NAMES.iter().filter(|n| !files.iter().any(|(f, _)| f == *n)) {
            let stale = self.folder.join(name);
            if stale.is_file() {
                fs::remove_file(stale)?;
            }
        }
        Ok(())
    }
}

/// Checks that a folder can be written, and made if it is not there, and that no folder is where one of the files is to be. Leaves
/// no trace.
pub fn check(folder: &Path, names: &[&str]) -> Result<(), Problem> {
    let wrong = |text: String| Err(Problem::file(folder, text).hint("name another folder with --out"));
    let target = |p: &Path| fs::read_link(p).map(|t| t.display().to_string()).unwrap_or_default();
    if let Some(link) = folder.ancestors().find(|p| p.is_symlink() && !p.exists()) {
        return wrong(format!(
            "cannot be written: {} is a link to {}, which is not there",
            link.display(),
            target(link)
        ));
    }
    if folder.exists() && !folder.is_dir() {
        return wrong("is not a folder".to_owned());
    }
    if let Some(name) = names.iter().find(|n| folder.join(n).is_dir()) {
        return Err(Problem::file(&folder.join(name), "is a folder where a file is to be written"));
    }
    if folder.file_name().is_none() && !folder.exists() {
        return wrong("is no name for a new folder".to_owned());
    }
    // What is made here goes at once; only making it shows what stands against it.
    let absent = |p: &&Path| matches!(p.symlink_metadata(), Err(e) if e.kind() == io::ErrorKind::NotFound);
    let made: Vec<&Path> = folder.ancestors().take_while(|p| !p.as_os_str().is_empty()).take_while(absent).collect();
    let done = fs::create_dir_all(folder).and_then(|()| temporary(folder).map(drop));
    made.iter().for_each(|p| drop(fs::remove_dir(p)));
    done.or_else(|e| wrong(format!("cannot be written: {e}")))
}

/// The results of a complete run that a folder holds.
pub struct Earlier {
    /// The time that they reach.
    pub reached: f64,
}

impl Earlier {
    /// Looks for them; results of a run that stopped early are none.
    pub fn find(folder: &Path) -> Option<Self> {
        let report = fs::read_to_string(folder.join("report.html")).ok()?;
        let table = fs::read_to_string(folder.join("trajectory.csv")).ok()?;
        let time = table.lines().skip(1).last()?.split(',').next()?.parse().ok()?;
        report.contains(crate::report::COMPLETE).then_some(Earlier { reached: time })
    }

    /// Refuses a run that will not come as far.
    pub fn allows(&self, folder: &Path, duration: f64) -> Result<(), Problem> {
        if duration >= self.reached {
            return Ok(());
        }
        let text =
            format!("holds the results of a complete run to t = {} s, and this one ends at {duration} s", self.reached);
        Err(Problem::file(folder, text).hint("name another folder with --out, or replace them with --force"))
    }
}

/// The folder beside a folder for results that are not to replace its own.
pub fn beside(folder: &Path) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_owned();
    name.push("-stopped");
    folder.with_file_name(name)
}

fn parent(folder: &Path) -> &Path {
    match folder.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    }
}

fn temporary(home: &Path) -> io::Result<tempfile::TempDir> {
    tempfile::Builder::new().prefix(".nekton-").tempdir_in(home)
}

/// Temporary folders are for their owner only; results are as readable as any new folder.
fn readable(path: &Path) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The permissions that the process gives to a new folder, found by making one.
        let probe = path.join(".new");
        fs::create_dir(&probe)?;
        let mode = fs::metadata(&probe)?.permissions().mode();
        fs::remove_dir(&probe)?;
        fs::set_permissions(path, fs::Permissions::from_mode(mode))?;
    }
    #[cfg(not(unix))]
    let _ = path;
    Ok(())
}
