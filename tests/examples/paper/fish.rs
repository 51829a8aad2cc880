//! Figures 9 to 14: a fish alone and between two obstacles: velocities, torques, their difference, the ratio of the costs.

use super::{Outcome, write};
use nekton_cli::plots::{Series, colour, over_time};
use std::collections::HashMap;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// Columns of a table by name.
struct Table(HashMap<String, Vec<f64>>);

impl Table {
    fn open(path: &Path) -> Result<Self, Box<dyn Error>> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut lines = text.lines();
        let names: Vec<String> = lines.next().unwrap_or_default().split(',').map(str::to_owned).collect();
        let mut columns: HashMap<String, Vec<f64>> = names.iter().map(|n| (n.clone(), Vec::new())).collect();
        for line in lines {
            for (name, cell) in names.iter().zip(line.split(',')) {
                columns.entry(name.clone()).or_default().push(cell.parse()?);
            }
        }
        Ok(Table(columns))
    }

    fn column(&self, name: &str) -> Result<&[f64], Box<dyn Error>> {
        self.0.get(name).map(Vec::as_slice).ok_or_else(|| format!("no column {name}").into())
    }

    /// Torques of all joints, in the order of their names.
    fn torques(&self) -> Vec<(&str, &[f64])> {
        let mut all: Vec<(&str, &[f64])> =
            self.0.iter().filter_map(|(n, v)| Some((n.strip_suffix(".torque")?, v.as_slice()))).collect();
        all.sort_by_key(|(n, _)| *n);
        all
    }

    /// ∫ |ν|² dt up to each time, by the trapezoidal rule.
    fn cost(&self) -> Result<Vec<f64>, Box<dyn Error>> {
        let t = self.column("t")?;
        let torques = self.torques();
        let square = |k: usize| torques.iter().map(|(_, v)| v[k] * v[k]).sum::<f64>();
        let mut sum = 0.0;
        Ok((0..t.len())
            .map(|k| {
                if k > 0 {
                    sum += 0.5 * (square(k) + square(k - 1)) * (t[k] - t[k - 1]);
                }
                sum
            })
            .collect())
    }
}

fn series(name: &str, t: &[f64], values: &[f64], k: usize) -> Series {
    let points = t.iter().copied().zip(values.iter().copied()).collect();
    Series { name: name.to_owned(), points, colour: colour(k), thick: false }
}

/// Makes the figures from the results of `nekton run` of both scenes.
pub fn figures(alone: &Path, between: &Path, folder: &Path) -> Outcome {
    let (mut table, cases) =
        (String::from("case,quantity,value\n"), [("alone", alone), ("between obstacles", between)]);
    let mut torques = Vec::new();
    for (k, (case, results)) in cases.into_iter().enumerate() {
        let path = Table::open(&results.join("trajectory.csv"))?;
        let t = path.column("t")?;
        let lines = [("vx", "along x"), ("vy", "along y"), ("omega", "angular (rad/s)")];
        let mut velocities = Vec::new();
        for (c, (key, name)) in lines.into_iter().enumerate() {
            velocities.push(series(name, t, path.column(&format!("fish.head.{key}"))?, c));
        }
        let title = format!("Figure {}: velocity of the head, fish {case}", 9 + k);
        write(folder, &format!("figure{}.svg", 9 + k), &over_time(&title, "velocity", "m/s", &velocities)?)?;
        let last = |key: &str| path.column(&format!("fish.head.{key}")).map(|c| c.last().copied().unwrap_or(f64::NAN));
        writeln!(table, "{case},displacement along x (m),{:.6}", last("x")?)?;
        writeln!(table, "{case},speed at the end (m/s),{:.2e}", last("vx")?.hypot(last("vy")?))?;
        let torque = Table::open(&results.join("torque.csv"))?;
        let lines: Vec<Series> = torque
            .torques()
            .iter()
            .enumerate()
            .map(|(c, (n, v))| series(n, torque.column("t").unwrap_or(&[]), v, c))
            .collect();
        let title = format!("Figure {}: joint torques, fish {case}", 11 + k);
        write(folder, &format!("figure{}.svg", 11 + k), &over_time(&title, "torque", "N", &lines)?)?;
        torques.push(torque);
    }
    let [alone, between] = torques.as_slice() else { return Err("two results are needed".into()) };
    let (t, other) = (alone.column("t")?, between.column("t")?);
    let common = t.iter().zip(other).take_while(|(a, b)| (*a - *b).abs() < 1e-9).count();
    let mut differences = Vec::new();
    for (c, ((name, a), (_, b))) in alone.torques().iter().zip(between.torques()).enumerate() {
        let values: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - a).collect();
        differences.push(series(name, &t[..common], &values[..common], c));
    }
    let title = "Figure 13: torques between obstacles minus torques alone";
    write(folder, "figure13.svg", &over_time(title, "torque", "N", &differences)?)?;
    let (a, b) = (alone.cost()?, between.cost()?);
    let from = t.iter().position(|t| *t > 0.5).unwrap_or(0);
    let ratio: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b / a).collect();
    let line = series("between / alone", &t[from..common], &ratio[from..common], 0);
    let title = "Figure 14: ratio of the costs, integral of the squared torques up to time t";
    write(folder, "figure14.svg", &over_time(title, "ratio", "1", &[line])?)?;
    writeln!(table, "both,cost between obstacles / cost alone,{:.4}", ratio[common - 1])?;
    print!("{table}");
    write(folder, "swimming.csv", &table)
}
