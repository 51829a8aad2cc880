//! `nekton trade`: the trade between speed and accuracy, measured; and the choice of a setting for `nekton run --error`.

mod drives;
mod measure;
mod picture;
mod reference;
mod setting;
mod single;
mod study;
mod table;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use nekton::status::Error;

use crate::ending::{Ending, say};
use crate::scene_file::{Problem, SceneFile};
use crate::waiting::Waiting;
use measure::Bench;
use reference::{Reference, Refusal, second_opinion};
use setting::shown;
pub use setting::{Setting, Variant, counts, method, method_name, parameter, unit};
use study::{Measured, Status, Study, cheapest, front};
use table::{Table, beside, mark};

/// What the user asks of `nekton trade`.
pub struct Wish {
    /// Folder for the tables.
    pub out: Option<PathBuf>,
    /// Errors for which a setting is recommended.
    pub errors: Vec<f64>,
    /// Seconds for one run.
    pub limit: f64,
    /// Simulated time.
    pub until: Option<f64>,
    /// Only the usual force, quadrature and precision.
    pub quick: bool,
}

/// Measures a scene.
pub fn trade(path: &Path, wish: &Wish) -> Result<Ending, Problem> {
    let scene = SceneFile::open(path)?;
    let (duration, own) = (scene.run()?.duration, scene.run()?.integrator);
    let until = wish.until.unwrap_or(duration);
    scene.with_core(|core| {
        let table = Table::new(&wish.out.clone().unwrap_or_else(|| beside(path)), mark(core, own));
        table.check()?;
        let bar = progress();
        bar.set_message("setting up");
        // Where nobody sees the bar.
        let _told = bar.is_hidden().then(|| Waiting::new("measuring settings"));
        let bench = Bench::new(core, own).map_err(|e| scene.problem(&e))?;
        let known = table.rows()?;
        let limit = Duration::from_secs_f64(wish.limit);
        let stored = match wish.until {
            None => table.reference(None)?,
            wanted => table.reference(wanted)?,
        };
        let mut reference = match stored {
            Some(reference) => reference,
            None => {
                let found = reference::reference(&bench, until, limit, 0.0, |what| bar.set_message(what.to_owned()));
                found.map_err(|e| refused(&scene, e))?
            }
        };
        let smallest = wish.errors.iter().copied().fold(f64::INFINITY, f64::min);
        if !reference.opinion.certifies(smallest) {
            bar.set_message("reference: second opinion");
            reference.opinion = second_opinion(&bench, &reference, smallest, limit * reference::PATIENCE);
        }
        // What is certified for none of the errors is certified for nobody.
        let largest = wish.errors.iter().copied().fold(0.0, f64::max);
        if !reference.opinion.certifies(largest) {
            let (text, way) = reference.opinion.against(largest);
            return Err(Problem::file(path, text).hint(way));
        }
        let mut writer = table.open()?;
        table.keep_reference(&reference)?;
        let known: Vec<Measured> = known.into_iter().filter(|(u, _)| *u == reference.until).map(|(_, m)| m).collect();
        let before = known.len();
        let study = Study { bench: &bench, reference: &reference, limit, quick: wish.quick, known, enough: 0.0 };
        bar.set_length(study.groups());
        let mut fresh = 0;
        let rows = study.run(
            |what, done| {
                bar.set_message(what);
                bar.set_position(done);
            },
            |row| {
                fresh += 1;
                writer.add(reference.until, row)
            },
        )?;
        bar.finish_and_clear();
        let name = path.file_stem().map_or("scene".into(), |s| s.to_string_lossy().into_owned());
        let title = format!("{name}: error against time, to t = {} s", shown(reference.until));
        let picture = picture::draw(&title, &rows, &reference)
            .map_err(|e| Problem::file(path, format!("the plot could not be drawn: {e}")))?;
        table.write("trade.svg", picture.as_bytes())?;
        // Below its own error the reference cannot tell, nor below what another method says.
        let tells = |e: f64| e >= reference.error && reference.opinion.certifies(e);
        let chosen: Vec<(f64, Option<&Measured>)> =
            wish.errors.iter().map(|e| (*e, cheapest(&rows, *e).filter(|_| tells(*e)))).collect();
        table.write("recommended.csv", table::recommended(&reference, &chosen).as_bytes())?;
        report(&scene, duration, &reference, &rows, &chosen);
        say(&format!("{fresh} settings measured, {before} known from before"));
        Ok(Ending::Complete)
    })
}

fn refused(scene: &SceneFile, refusal: Refusal) -> Problem {
    match refusal {
        Refusal::Core(error) => scene.problem(&error),
        Refusal::TooSlow => Problem::file(scene.path(), "is too slow to be measured").hint("allow more with --limit"),
    }
}

fn progress() -> ProgressBar {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}   {elapsed}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Prints the front and the recommendations.
fn report(
    scene: &SceneFile,
    duration: f64,
    reference: &Reference,
    rows: &[Measured],
    chosen: &[(f64, Option<&Measured>)],
) {
    let count = |f: &dyn Fn(&Status) -> bool| rows.iter().filter(|m| f(&m.status)).count();
    say(&format!("scene      {}", scene.path().display()));
    say(&format!("horizon    {} s of {duration} s", shown(reference.until)));
    say(&format!(
        "reference  {} nodes on the largest link; its own error {:.1e}; errors relative to a travel of {:.3} m",
        reference.nodes, reference.error, reference.travel
    ));
    say(&format!("confirmed  by gauss6 on steps that resolve the drives to {:.1e}", reference.opinion.difference));
    say(&format!(
        "settings   {}: {} done, {} over the limit, {} failed\n",
        rows.len(),
        count(&|s| *s == Status::Done),
        count(&|s| *s == Status::Limit),
        count(&|s| matches!(s, Status::Failed(_)))
    ));
    say(
        "not beaten in both speed and accuracy by any other (nodes: of the largest link; s/s: seconds per simulated second):",
    );
    say("    error      s/s  evaluations/s  nodes  integrator      precision  force     quadrature");
    for m in front(rows, reference.error) {
        let [quadrature, force, precision, _] = m.setting.names();
        say(&format!(
            "  {:>7.1e}  {:>7.1e}  {:>13.0}  {:>5}  {:<14}  {precision:<9}  {force:<8}  {quadrature}",
            m.error,
            m.cost,
            m.evaluations,
            m.setting.nodes,
            method_text(&m.setting),
        ));
    }
    say("");
    for (error, row) in chosen {
        match row {
            Some(m) => say(&format!("for {error:e}: {}, {:.1e} s/s", m.setting.text(), m.cost)),
            None if *error < reference.error => {
                say(&format!("for {error:e}: the reference itself is only good to {:.0e}", reference.error));
            }
            None if !reference.opinion.certifies(*error) => {
                let (text, way) = reference.opinion.against(*error);
                say(&format!("for {error:e}: {text} ({way})"));
            }
            None => say(&format!("for {error:e}: no setting that was tried is exact enough")),
        }
    }
}

fn method_text(setting: &Setting) -> String {
    format!("{} {:.3e}", method_name(setting.integrator), parameter(setting.integrator))
}

impl Setting {
    /// In words, as scene files have it.
    pub fn text(&self) -> String {
        let [quadrature, force, precision, method] = self.names();
        let key = if method == "adams" { "tolerance" } else { "step" };
        let value = parameter(self.integrator);
        let value = if method == "adams" { format!("{value:e}") } else { format!("{value:.6}") };
        format!(
            "nodes {} on the largest link, {method} with {key} {value}, force {force}, quadrature {quadrature}, {precision}",
            self.nodes
        )
    }
}

/// A setting for a wanted error, and where it comes from.
pub struct Choice {
    /// The setting.
    pub setting: Setting,
    /// Factor of all node counts.
    pub scale: f64,
    /// What to tell the user.
    pub why: String,
}

/// The cheapest setting in double precision for a wanted error: from the scene's table if there is one, else measured quickly.
pub fn choose(path: &Path, scene: &SceneFile, error: f64) -> Result<Choice, Problem> {
    let (duration, own) = (scene.run()?.duration, scene.run()?.integrator);
    let wrong = |e: &Error| scene.problem(e);
    let _told = Waiting::new("measuring settings");
    scene.with_core(|core| {
        let bench = Bench::new(core, own).map_err(|e| wrong(&e))?;
        let table = Table::new(&beside(path), mark(core, own));
        let stored: Vec<(f64, Measured)> = table.rows()?.into_iter().filter(|(_, m)| !m.setting.single).collect();
        let longest = stored.iter().map(|(u, _)| *u).fold(0.0, f64::max);
        let rows: Vec<Measured> = stored.into_iter().filter(|(u, _)| *u == longest).map(|(_, m)| m).collect();
        let chosen = |m: &Measured, source: String, until: f64| Choice {
            setting: bench.limited(&m.setting),
            scale: m.setting.nodes as f64 / bench.nodes as f64,
            why: format!("{source}: {}; error {:.1e} over the first {} s", m.setting.text(), m.error, shown(until)),
        };
        let tells = |r: Reference| r.error <= error && r.opinion.certifies(error);
        let known = table.reference(Some(longest))?.is_some_and(tells);
        if let (Some(m), true) = (cheapest(&rows, error), known) {
            return Ok(chosen(m, format!("from {}", beside(path).join("trade.csv").display()), longest));
        }
        let clock = Instant::now();
        let limit = Duration::from_secs(1);
        let mut reference =
            reference::reference(&bench, duration, limit, error, |_| ()).map_err(|e| refused(scene, e))?;
        // Where the reference itself is not good enough, no setting will be. A tenth of the error may be the reference's own; what
        // is measured against it is then as good as asked.
        if reference.error <= error {
            reference.opinion = second_opinion(&bench, &reference, 0.1 * error, limit * reference::PATIENCE);
            if !reference.opinion.certifies(error) {
                let (text, way) = reference.opinion.against(error);
                return Err(Problem::file(path, text).hint(way));
            }
        }
        let study =
            Study { bench: &bench, reference: &reference, limit, quick: true, known: Vec::new(), enough: error };
        let rows = study.run(|_, _| (), |_| Ok::<(), Problem>(()))?;
        let source = format!("{} settings measured in {:.1} s", rows.len(), clock.elapsed().as_secs_f64());
        let best = rows.iter().map(|m| m.error).fold(f64::INFINITY, f64::min).max(reference.error);
        match cheapest(&rows, error) {
            Some(m) if reference.error <= error => Ok(chosen(m, source, reference.until)),
            _ => Err(Problem::file(
                path,
                format!("no setting with an error of {error:e} was found; the best has {best:.1e}"),
            )
            .hint("ask for less, or look at `nekton trade`")),
        }
    })
}
