//! `cargo xtask trade`: measures speed against accuracy of every scene, computes the paper's figures anew, and fills the tables
//! of docs/accuracy.md.

use crate::page::{Csv, between};
use nekton_steps::{Outcome, ask, cargo, execute, read, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

type Result<T> = std::result::Result<T, String>;

/// Seconds for one run of a setting, and for the scenes of more unknowns.
const LIMIT: f64 = 0.4;
const LIMITS: [(&str, f64); 5] = [
    ("bird", 0.8),
    ("fish_between_obstacles", 1.2),
    ("six_ellipses", 0.6),
    ("torque_driven_fish", 0.6),
    ("two_stars", 0.6),
];

/// One scene, into docs/accuracy; runs that an earlier call finished are not repeated.
pub fn one(wanted: &str) -> ExitCode {
    let measured = (|| {
        let chosen: Vec<PathBuf> = scenes()?.into_iter().filter(|s| name(s) == wanted).collect();
        if chosen.is_empty() {
            return Err(format!("there is no scenes/{wanted}.toml"));
        }
        done(&mut cargo(&["build", "--release", "--package", "nekton-cli"]))?;
        let folder = root().join("docs/accuracy");
        trade(&chosen, &work(), &folder, &[])?;
        tables(&folder)
    })();
    ended(measured)
}

/// The whole, into docs/accuracy; with `resume` runs that an earlier call finished are not repeated.
pub fn run(resume: bool) -> ExitCode {
    let measured = (|| {
        if !resume {
            let _ = fs::remove_dir_all(work());
        }
        let folder = root().join("docs/accuracy");
        measure(&scenes()?, &work(), &folder, &[])?;
        tables(&folder)
    })();
    ended(measured)
}

fn ended(measured: Result<()>) -> ExitCode {
    match measured {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Brings the tables and pictures of all scenes that are measured into a folder.
fn collect(work: &Path, folder: &Path) -> Result<()> {
    let put = |file: &str, text: &str| {
        fs::write(folder.join(file), text).map_err(|e| format!("{}: {e}", folder.join(file).display()))
    };
    let mut summary = String::new();
    for scene in scenes()? {
        let (name, out) = (name(&scene), work.join(name(&scene)));
        if !out.join("recommended.csv").is_file() {
            continue;
        }
        // The mark of the scene serves the command only.
        let reference = Csv::parse(&read(&out.join("reference.csv"))?);
        let (mark, until) = (reference.cell(0, "scene")?, reference.cell(0, "until")?);
        let table: String = read(&out.join("trade.csv"))?
            .lines()
            .filter(|l| l.starts_with("scene,") || l.starts_with(&format!("{mark},{until},")))
            .filter_map(|l| Some(format!("{}\n", l.split_once(',')?.1)))
            .collect();
        put(&format!("{name}.csv"), &table)?;
        fs::copy(out.join("trade.svg"), folder.join(format!("{name}.svg"))).map_err(|e| e.to_string())?;
        let recommended = read(&out.join("recommended.csv"))?;
        for (k, line) in recommended.lines().enumerate().skip(usize::from(!summary.is_empty())) {
            summary += &format!("{},{line}\n", if k == 0 { "scene" } else { &name });
        }
    }
    // Nothing measured here: what is committed stays.
    if summary.is_empty() { Ok(()) } else { put("recommended.csv", &summary) }
}

/// Fills the page from what is in its folder.
fn tables(folder: &Path) -> Result<()> {
    let page = root().join("docs/accuracy.md");
    fs::write(&page, fill(&read(&page)?, folder)?).map_err(|e| format!("{}: {e}", page.display()))
}

/// The tables and pictures of what is measured already.
pub fn collected() -> Outcome {
    let folder = root().join("docs/accuracy");
    match collect(&work(), &folder).and_then(|()| tables(&folder)) {
        Ok(()) => Outcome::Passed,
        Err(why) => Outcome::Failed(why),
    }
}

/// A minute's worth of it into target/accuracy, for the tests.
pub fn quick() -> Outcome {
    let tried = (|| {
        let folder = root().join("target/accuracy");
        let _ = fs::remove_dir_all(&folder);
        let work = root().join("target/trade-quick");
        let _ = fs::remove_dir_all(&work);
        let chosen = scenes()?.into_iter().filter(|s| name(s) == "two_eggs").collect::<Vec<_>>();
        measure(&chosen, &work, &folder, &["--quick", "--until", "2"])?;
        let page = fill(&read(&root().join("docs/accuracy.md"))?, &folder)?;
        fs::write(folder.join("accuracy.md"), page).map_err(|e| e.to_string())
    })();
    match tried {
        Ok(()) => Outcome::Passed,
        Err(why) => Outcome::Failed(why),
    }
}

/// Where a full run keeps what it has measured.
fn work() -> PathBuf {
    root().join("target/trade")
}

fn scenes() -> Result<Vec<PathBuf>> {
    let folder = root().join("scenes");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    Ok(files)
}

fn name(scene: &Path) -> String {
    scene.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn done(command: &mut Command) -> Result<()> {
    match execute(command) {
        Outcome::Passed => Ok(()),
        Outcome::Failed(why) | Outcome::Skipped(why) => Err(why),
    }
}

/// Everything that docs/accuracy holds, from runs of the command and of the example `paper`.
fn measure(traded: &[PathBuf], work: &Path, folder: &Path, few: &[&str]) -> Result<()> {
    let quick = !few.is_empty();
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let put = |file: &str, text: &str| {
        fs::write(folder.join(file), text).map_err(|e| format!("{}: {e}", folder.join(file).display()))
    };
    done(&mut cargo(&["build", "--release", "--package", "nekton-cli"]))?;
    done(&mut cargo(&["build", "--release", "--package", "nekton-tests", "--example", "paper"]))?;
    let nekton = || Command::new(root().join("target/release/nekton"));
    let paper = || Command::new(root().join("target/release/examples/paper"));

    let mut ingredients = String::new();
    for scene in scenes()? {
        let table = ask(nekton().arg("plan").arg(&scene).args(["--ingredients", "--csv"]))?;
        let rows = if ingredients.is_empty() { table.as_str() } else { table.split_once('\n').unwrap_or_default().1 };
        ingredients += rows;
    }
    put("ingredients.csv", &ingredients)?;

    let mut passing = paper();
    passing.arg("passing").args(quick.then_some("--quick")).arg(folder);
    done(&mut passing)?;
    if !quick {
        let results = ["fish", "fish_between_obstacles"].map(|s| (s, work.join("run").join(s)));
        for (scene, out) in &results {
            let _ = fs::remove_dir_all(out);
            fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
            // Pictures need five digits, not ten.
            let text = read(&root().join(format!("scenes/{scene}.toml")))?;
            let few = text
                .replace("nodes = 96", "nodes = 40")
                .replace("nodes = 80", "nodes = 40")
                .replace("nodes = 160", "nodes = 96");
            let file = out.with_extension("toml");
            fs::write(&file, few).map_err(|e| format!("{}: {e}", file.display()))?;
            done(nekton().arg("run").arg(&file).arg("--out").arg(out))?;
        }
        done(paper().arg("fish").args(results.map(|(_, out)| out)).arg(folder))?;
    }

    trade(traded, work, folder, few)
}

/// Speed against accuracy of some scenes; says how long each took, since the whole should take no more than 25 minutes.
fn trade(traded: &[PathBuf], work: &Path, folder: &Path, few: &[&str]) -> Result<()> {
    for scene in traded {
        let (out, clock) = (work.join(name(scene)), Instant::now());
        let own = LIMITS.iter().find(|(known, _)| *known == name(scene));
        let limit = own.map_or(LIMIT, |(_, limit)| *limit).to_string();
        let mut command = Command::new(root().join("target/release/nekton"));
        done(command.arg("trade").arg(scene).arg("--out").arg(&out).args(["--limit", &limit]).args(few))?;
        println!("{}: {:.0} s", name(scene), clock.elapsed().as_secs_f64());
        // What is measured is kept, also if the rest is cut off.
        collect(work, folder)?;
    }
    Ok(())
}

/// Puts the tables of a folder between the page's markers. A table without data, or a marker without its end, is an error.
fn fill(page: &str, folder: &Path) -> Result<String> {
    let csv = |file: &str| read(&folder.join(file)).map(|text| Csv::parse(&text));
    let mut page = page.to_owned();
    for (marker, table) in [
        ("recommended", recommended_table(&csv("recommended.csv")?)?),
        ("passing", passing_table(&csv("passing.csv")?)?),
        ("ingredients", ingredients_table(&csv("ingredients.csv")?)?),
    ] {
        page = between(&page, marker, &table)?;
    }
    // What other commands measure lies in the repository.
    for marker in ["near", "extremes"] {
        let file = root().join(format!("docs/accuracy/{marker}.md"));
        if file.is_file() {
            // A fragment's links are relative to its own folder.
            let text = read(&file)?.replace(&format!("]({marker}"), &format!("](accuracy/{marker}"));
            page = between(&page, marker, &text)?;
        }
    }
    Ok(page)
}

/// A number with two digits, as people write it.
fn short(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(0.0) => "0".into(),
        Ok(x) if (0.01..1000.0).contains(&x.abs()) => {
            format!("{}", format!("{x:.1e}").parse::<f64>().unwrap_or(x))
        }
        Ok(x) => format!("{x:.0e}"),
        Err(_) => "–".into(),
    }
}

fn recommended_table(table: &Csv) -> Result<String> {
    let mut text = String::from(
        "| scene | to t = | error 1e-3 | s/s | error 1e-6 | s/s | error 1e-9 | s/s |\n|---|---|---|---|---|---|---|---|\n",
    );
    let mut scenes: Vec<&str> = table.column("scene").collect();
    scenes.dedup();
    for scene in scenes {
        let rows: Vec<usize> = (0..table.rows.len()).filter(|r| table.cell(*r, "scene") == Ok(scene)).collect();
        let mut line = format!("| [{scene}](accuracy/{scene}.svg) | {} |", short(table.cell(rows[0], "until")?));
        for row in rows {
            let get = |name: &str| table.cell(row, name);
            if get("nodes")?.is_empty() {
                line += " – | – |";
                continue;
            }
            let mut setting = format!("{}, {} {}", get("nodes")?, get("integrator")?, short(get("step_or_tolerance")?));
            for (name, usual) in [("precision", "f64"), ("force", "exact"), ("quadrature", "graded")] {
                if get(name)? != usual {
                    setting = format!("{setting}, {}", get(name)?);
                }
            }
            line += &format!(" {setting} | {} |", short(get("seconds_per_second")?));
        }
        text += &format!("{line}\n");
    }
    Ok(text)
}

fn passing_table(table: &Csv) -> Result<String> {
    let mut counts: Vec<&str> = Vec::new();
    for n in table.column("nodes") {
        if !counts.contains(&n) {
            counts.push(n);
        }
    }
    counts.sort_by_key(|n| n.parse::<usize>().unwrap_or(0));
    let schemes = [("panels", "constant panels"), ("paper", "the paper's scheme"), ("nekton", "nekton")];
    let mut text = String::from("| nodes per body |");
    for (_, title) in schemes {
        text += &format!(" {title}: position (m), angle (rad) | time (s) |");
    }
    text += "\n|---|---|---|---|---|---|---|\n";
    for n in counts {
        let mut line = format!("| {n} |");
        for (scheme, _) in schemes {
            let row = (0..table.rows.len())
                .find(|r| table.cell(*r, "scheme") == Ok(scheme) && table.cell(*r, "nodes") == Ok(n));
            line += &match row {
                Some(row) => format!(
                    " {}, {} | {} |",
                    short(table.cell(row, "position")?),
                    short(table.cell(row, "angle")?),
                    short(table.cell(row, "seconds")?)
                ),
                None => " – | – |".into(),
            };
        }
        text += &format!("{line}\n");
    }
    Ok(text)
}

fn ingredients_table(table: &Csv) -> Result<String> {
    let mut text = String::from(
        "| scene | ingredient | unknowns | right-hand sides | bytes of the model | of a simulation | operations |\n\
        |---|---|---|---|---|---|---|\n",
    );
    for row in 0..table.rows.len() {
        let get = |name: &str| table.cell(row, name);
        if get("present")? == "yes" {
            text += &format!(
                "| {} | {} | {} | {} | {} | {} | {} |\n",
                get("scene")?,
                get("ingredient")?,
                get("unknowns")?,
                get("right_hand_sides")?,
                get("model_bytes")?,
                get("simulation_bytes")?,
                short(get("operations")?)
            );
        }
    }
    Ok(text)
}
