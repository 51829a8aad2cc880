//! `trade.csv`, one row per run, and `reference.csv`: what was measured is never measured again.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use nekton::scene::{ForceFormula, Quadrature, Scene};

use super::reference::{Opinion, Reference};
use super::setting::{Setting, integrator, parameter};
use super::study::{Measured, Status};
use crate::scene_file::{Integrator, Problem};

const TRADE: &str = "scene,until,quadrature,force,precision,integrator,step_or_tolerance,nodes,unknowns,status,error,\
    seconds_per_second,evaluations_per_second";
const REFERENCE: &str = "scene,until,nodes,error,difference,own,travel,t,positions";
/// Of a time when there was no second opinion: such a reference is made anew.
const WITHOUT_OPINION: &str = "scene,until,nodes,error,travel,t,positions";

/// A mark of everything that a scene says about the motion (FNV-1a of its compiled description), of the limits of its steps, and
/// of this version.
pub fn mark(scene: &Scene<'_, f64>, own: Integrator) -> String {
    let mut text = format!("{scene:?}{}", env!("CARGO_PKG_VERSION"));
    if let Integrator::Adams { max_step, first_step, .. } = own
        && max_step + first_step > 0.0
    {
        text += &format!("{max_step:e},{first_step:e}");
    }
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
    format!("{hash:016x}")
}

/// The folder of a scene's tables, if nobody names another.
pub fn beside(scene: &Path) -> PathBuf {
    scene.with_extension("trade")
}

/// A folder with the tables of one scene.
pub struct Table {
    folder: PathBuf,
    mark: String,
}

impl Table {
    /// The tables of a scene in a folder, which need not exist.
    pub fn new(folder: &Path, mark: String) -> Self {
        Table { folder: folder.to_owned(), mark }
    }

    /// Refuses a folder that cannot be written, before anything is measured.
    pub fn check(&self) -> Result<(), Problem> {
        crate::output::check(&self.folder, &["trade.csv", "trade.svg", "recommended.csv", "reference.csv"])
    }

    fn path(&self) -> PathBuf {
        self.folder.join("trade.csv")
    }

    /// The rows of this scene, with their horizons. A last line that was cut off is no row.
    pub fn rows(&self) -> Result<Vec<(f64, Measured)>, Problem> {
        let Some(lines) = lines(&self.path(), TRADE)? else { return Ok(Vec::new()) };
        let mut rows = Vec::new();
        for (number, line) in lines.iter().enumerate().filter(|(_, l)| l.starts_with(&self.mark)) {
            let row =
                parse(line).ok_or_else(|| Problem::line(&self.path(), number + 2, "is not a row of this table"))?;
            rows.push(row);
        }
        Ok(rows)
    }

    /// Opens the table to add rows; makes folder and header where missing, and takes away a line that was cut off.
    pub fn open(&self) -> Result<Writer, Problem> {
        let path = self.path();
        let refused = |e: std::io::Error| {
            Problem::file(&path, format!("cannot be written: {e}")).hint("name another folder with --out")
        };
        std::fs::create_dir_all(&self.folder).map_err(refused)?;
        let kept = lines(&path, TRADE)?;
        let mut file = OpenOptions::new().create(true).append(true).open(&path).map_err(refused)?;
        match kept {
            None => file.write_all(format!("{TRADE}\n").as_bytes()).map_err(refused)?,
            Some(lines) => {
                let whole = TRADE.len() + 1 + lines.iter().map(|l| l.len() + 1).sum::<usize>();
                file.set_len(whole as u64).map_err(refused)?;
            }
        }
        Ok(Writer { file, path, mark: self.mark.clone() })
    }

    /// The reference of this scene to a given time, or to any if `None`.
    pub fn reference(&self, until: Option<f64>) -> Result<Option<Reference>, Problem> {
        let path = self.folder.join("reference.csv");
        if lines(&path, WITHOUT_OPINION).is_ok() {
            return Ok(None);
        }
        let Some(lines) = lines(&path, REFERENCE)? else { return Ok(None) };
        let mut found: Option<Reference> = None;
        for (number, line) in lines.iter().enumerate().filter(|(_, l)| l.starts_with(&self.mark)) {
            let bad = || Problem::line(&path, number + 2, "is not a row of this table");
            let cells: Vec<f64> =
                line.split(',').skip(1).map(str::parse).collect::<Result<_, _>>().map_err(|_| bad())?;
            let [end, nodes, error, difference, own, travel, _t, positions @ ..] = cells.as_slice() else {
                return Err(bad());
            };
            if until.is_some_and(|u| u != *end) {
                continue;
            }
            let reference = found.get_or_insert_with(|| Reference {
                until: *end,
                nodes: *nodes as usize,
                error: *error,
                opinion: Opinion { difference: *difference, own: *own },
                travel: *travel,
                path: Vec::new(),
            });
            if reference.until == *end {
                reference.path.push(positions.to_vec());
            }
        }
        Ok(found.filter(|r| r.path.len() == super::drives::OUTPUTS + 1))
    }

    /// Writes the reference, in place of any other.
    pub fn keep_reference(&self, reference: &Reference) -> Result<(), Problem> {
        let steps = (reference.path.len() - 1).max(1) as f64;
        let mut text = format!("{REFERENCE}\n");
        for (k, row) in reference.path.iter().enumerate() {
            let Reference { until, nodes, error, travel, opinion: Opinion { difference, own }, .. } = reference;
            let t = until * k as f64 / steps;
            text += &format!("{},{until:e},{nodes},{error:e},{difference:e},{own:e},{travel:e},{t:e}", self.mark);
            row.iter().for_each(|x| text += &format!(",{x:.16e}"));
            text.push('\n');
        }
        self.write("reference.csv", text.as_bytes())
    }

    /// Writes a file of the folder, whole or not at all.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), Problem> {
        let path = self.folder.join(name);
        let write = || -> std::io::Result<()> {
            std::fs::create_dir_all(&self.folder)?;
            let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
            file.write_all(content)?;
            file.persist(&path)?;
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o644))?;
            }
            Ok(())
        };
        write().map_err(|e| Problem::file(&path, format!("cannot be written: {e}")))
    }
}

/// A table that rows are added to.
pub struct Writer {
    file: File,
    path: PathBuf,
    mark: String,
}

impl Writer {
    /// Adds a row at once, so that a run that is cut off leaves whole rows.
    pub fn add(&mut self, until: f64, m: &Measured) -> Result<(), Problem> {
        let line = format!("{},{}\n", self.mark, cells(until, m).join(","));
        self.file.write_all(line.as_bytes()).map_err(|e| Problem::file(&self.path, format!("cannot be written: {e}")))
    }
}

/// The recommendations as a table: the row of the setting for each wanted error, without a setting where none is exact enough.
pub fn recommended(reference: &Reference, chosen: &[(f64, Option<&Measured>)]) -> String {
    let columns = TRADE.split_once(',').map_or("", |(_, rest)| rest);
    let mut text = format!("wanted,reference_error,{columns}\n");
    for (wanted, row) in chosen {
        let cells = match row {
            Some(row) => cells(reference.until, row),
            None => {
                let mut empty = vec![String::new(); columns.split(',').count()];
                empty[0] = format!("{:e}", reference.until);
                empty
            }
        };
        text += &format!("{wanted:e},{:.1e},{}\n", reference.error, cells.join(","));
    }
    text
}

fn number(x: f64) -> String {
    if x.is_finite() { format!("{x:.3e}") } else { String::new() }
}

fn cells(until: f64, m: &Measured) -> Vec<String> {
    let mut cells = vec![format!("{until:e}")];
    cells.extend(m.setting.names().map(str::to_owned));
    cells.push(format!("{:e}", parameter(m.setting.integrator)));
    cells.extend([m.setting.nodes.to_string(), m.unknowns.to_string()]);
    cells.push(match &m.status {
        Status::Done => "done".to_owned(),
        Status::Limit => "over the limit".to_owned(),
        Status::Failed(why) => why.replace(',', ";"),
    });
    cells.extend([m.error, m.cost, m.evaluations].map(number));
    cells
}

fn parse(line: &str) -> Option<(f64, Measured)> {
    let cells: Vec<&str> = line.split(',').collect();
    let [_, until, quadrature, force, precision, method, value, nodes, unknowns, status, error, cost, evaluations] =
        cells.as_slice()
    else {
        return None;
    };
    let number = |text: &str| if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() };
    let setting = Setting {
        quadrature: match *quadrature {
            "graded" => Quadrature::Graded,
            "plain" => Quadrature::Plain,
            _ => return None,
        },
        force: match *force {
            "exact" => ForceFormula::ExactGradient,
            "boundary" => ForceFormula::Boundary,
            _ => return None,
        },
        single: match *precision {
            "f64" => false,
            "f32" => true,
            _ => return None,
        },
        integrator: integrator(method, value.parse().ok()?)?,
        nodes: nodes.parse().ok()?,
    };
    let status = match *status {
        "done" => Status::Done,
        "over the limit" => Status::Limit,
        why => Status::Failed(why.to_owned()),
    };
    let [error, cost, evaluations] = [number(error)?, number(cost)?, number(evaluations)?];
    Some((
        until.parse().ok()?,
        Measured { setting, unknowns: unknowns.parse().ok()?, status, error, cost, evaluations },
    ))
}

/// The whole lines of a table after its header; `None` if there is no file.
fn lines(path: &Path, header: &str) -> Result<Option<Vec<String>>, Problem> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(Problem::file(path, format!("cannot be read: {e}"))),
    };
    let mut lines = text.split_inclusive('\n').filter_map(|l| l.strip_suffix('\n'));
    if lines.next() != Some(header) {
        return Err(
            Problem::line(path, 1, "is not a table of this command").hint("name another folder, or move it away")
        );
    }
    Ok(Some(lines.map(str::to_owned).collect()))
}
