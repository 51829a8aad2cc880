//! `nekton run`: simulate, show progress, write everything.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use nekton::status::{Error, Place, Status};

use crate::checkpoint::{Checkpoint, Wish};
use crate::ending::{Ending, say, warn};
use crate::output::{Earlier, Target, beside, tables};
use crate::plots;
use crate::record::{Energies, Nearest, Record, Row, Terms};
use crate::report;
use crate::scene_file::{Integrator, Problem, RunDef, SceneFile};
use crate::setup::Setup;
use crate::signals;
use crate::trade;
use crate::watch::Watch;
use nekton::{Model, Resolution, Sim};

/// Points with which an outline is drawn.
const OUTLINE_POINTS: usize = 240;
/// Length of the progress bar in its own units.
const PROGRESS: u64 = 1000;

/// Runs a scene and writes its results.
pub fn run(
    path: &Path,
    folder: &Path,
    error: Option<f64>,
    channels: &[(String, PathBuf)],
    wish: &Wish,
) -> Result<Ending, Problem> {
    let mut scene = SceneFile::open(path)?;
    scene.feed(channels)?;
    let mut plan = scene.run()?.clone();
    let target = Target::check(folder)?;
    let earlier = Earlier::find(folder).filter(|_| !wish.force);
    if let Some(earlier) = &earlier {
        earlier.allows(folder, plan.duration)?;
        // Where results may go that are not to replace these.
        Target::check(&beside(folder))?;
    }
    let mut setup = Setup::of(scene)?;
    let asked = signals::listen();
    let choice = error.map(|error| trade::choose(path, &setup.scene, error)).transpose()?;
    if let Some(choice) = &choice {
        setup.remake(choice)?;
        plan.integrator = choice.setting.integrator;
        say(&choice.why);
    }
    let mut sim = setup.simulate(plan.integrator)?;
    let mut view = sim.view();
    let clock = Instant::now();
    let mut record = describe(&setup, &plan);
    let mut checkpoint = Checkpoint::open(wish, setup.model.view().fingerprint(), &record)?;
    let stopped = integrate(&setup, &plan, &mut view, &mut record, checkpoint.as_mut(), &asked)?;
    figures(&view, &mut record);
    let time = clock.elapsed();
    record.stopped = stopped.as_ref().map(|(t, why)| match why {
        Stop::Asked(signal) => {
            let advice = if checkpoint.is_some() { "; --resume goes on from there" } else { "" };
            format!("t = {t:.6} s: interrupted by {signal}{advice}")
        }
        Stop::Failed(e) => {
            let advice = match e.status {
                Status::TooManySteps => format!("; {}", plan.integrator.way_to_fewer_steps()),
                _ => String::new(),
            };
            format!("t = {t:.6} s: {}{advice}", setup.scene.describe(e))
        }
    });

    let title = path.file_stem().map_or("scene".into(), |s| s.to_string_lossy());
    let failed = |e: Box<dyn std::error::Error>| Problem::file(folder, format!("the plots could not be drawn: {e}"));
    let plots = plots::all(&record).map_err(failed)?;
    let page = report::page(&title, &record, &plots, setup.scene.text());
    let mut files = tables(&record);
    files.extend(plots.into_iter().map(|(name, svg)| (name, svg.into_bytes())));
    files.push(("report.html", page.into_bytes()));
    let reached = view.time();
    let (target, folder) = match earlier.filter(|e| record.stopped.is_some() && e.reached > reached) {
        None => (target, folder.to_owned()),
        Some(earlier) => {
            let aside = beside(folder);
            warn(&format!(
                "{} holds the results of a complete run to t = {} s, which are kept; this one's are in {} (--force replaces)",
                folder.display(),
                earlier.reached,
                aside.display()
            ));
            (Target::check(&aside)?, aside)
        }
    };
    target.write(&files)?;
    if let (Some(checkpoint), None | Some((_, Stop::Failed(_)))) = (&checkpoint, &stopped) {
        // There is nothing to go on with.
        checkpoint.done();
    }
    summary(&setup, &record, &folder, time);
    Ok(if record.stopped.is_some() { Ending::Stopped } else { Ending::Complete })
}

/// Why a run ended before its end.
enum Stop {
    /// By a signal of this name.
    Asked(&'static str),
    Failed(Error),
}

/// What is known before the first step.
fn describe(setup: &Setup, run: &RunDef) -> Record {
    let model = setup.model.view();
    let plan = model.plan();
    let labels = setup.scene.labels();
    let outline = |place| outline(&model, place);
    let places = setup.links.iter().filter_map(|core| model.link(*core)).map(|l| l.place);
    let method = match run.integrator {
        Integrator::Rk4 { step } => format!("rk4, step {step} s"),
        Integrator::Abm4 { step } => format!("abm4, step {step} s"),
        Integrator::Gauss6 { step } => format!("gauss6, step {step} s"),
        Integrator::Adams { tolerance, max_step, first_step } => {
            let given = |name: &str, step: f64| if step > 0.0 { format!(", {name} {step} s") } else { String::new() };
            let limits = given("longest step", max_step) + &given("first step", first_step);
            format!("adams, relative and absolute tolerance {tolerance:e}{limits}")
        }
    };
    let mut settings = vec![
        ("scene file".into(), setup.scene.path().display().to_string()),
        ("duration".into(), format!("{} s", run.duration)),
        ("output interval".into(), format!("{} s", run.output_interval)),
        ("integrator".into(), method),
        ("nodes".into(), setup.nodes().join(", ")),
    ];
    settings.extend(setup.outlines().into_iter().map(|(whose, what)| (format!("outline of {whose}"), what)));
    settings.extend(setup.scene.channels());
    Record {
        joints: setup.joints.iter().filter_map(|(_, user)| labels.get(*user).cloned()).collect(),
        links: labels,
        outlines: places.map(outline).collect(),
        obstacles: (0..setup.scene.obstacles.len()).map(|k| outline(Place::Obstacle(k))).collect(),
        tank: setup.scene.tank.as_ref().map(|_| outline(Place::Tank)),
        terms: Terms {
            fluid: plan.fluid,
            gravity: plan.gravity,
            repulsion: plan.repulsion,
            circulation: plan.circulation,
            slider: setup.scene.has_slider(),
        },
        notices: setup.notices(),
        plan: plan.to_string(),
        tolerance: plan.tolerance,
        settings,
        ..Record::default()
    }
}

fn outline(model: &Model<'_, f64>, place: Place) -> Vec<[f64; 2]> {
    let parameter = |k: usize| std::f64::consts::TAU * k as f64 / OUTLINE_POINTS as f64;
    (0..OUTLINE_POINTS).filter_map(|k| model.outline_point(place, parameter(k))).collect()
}

/// Steps from output time to output time. An error at the very start is a bad scene; later it ends the run.
fn integrate(
    setup: &Setup,
    run: &RunDef,
    sim: &mut Sim<'_, f64>,
    record: &mut Record,
    mut checkpoint: Option<&mut Checkpoint>,
    asked: &signals::Asked,
) -> Result<Option<(f64, Stop)>, Problem> {
    let mut watch = Watch::default();
    let first = match checkpoint.as_mut() {
        Some(checkpoint) if checkpoint.resumes() => checkpoint.resume(sim, record, &mut watch)?,
        _ => None,
    };
    let bar = progress(run.duration);
    if first.is_none() {
        let row = sample(setup, sim).map_err(|e| setup.problem(&e))?;
        keep(record, row);
        watch.look(setup, sim, record);
    }
    let mut stopped = None;
    // The tolerance keeps a last row that would follow the one before by rounding only from being written.
    let rows = (run.duration / run.output_interval - 1e-9).ceil().max(1.0) as usize;
    for k in first.unwrap_or(1)..=rows {
        let t = if k == rows { run.duration } else { k as f64 * run.output_interval };
        let step = match run.integrator {
            Integrator::Adams { .. } => sim.advance_dense(t, run.duration),
            _ => sim.advance(t),
        };
        match step.and_then(|()| sample(setup, sim)) {
            Ok(row) => {
                show(&bar, run.duration, &row.0);
                keep(record, row);
                watch.look(setup, sim, record);
            }
            Err(e) => {
                stopped = Some((sim.time(), Stop::Failed(e)));
                break;
            }
        }
        let signal = asked.signal().filter(|_| k < rows);
        if let Some(checkpoint) = checkpoint.as_mut().filter(|_| k < rows) {
            checkpoint.keep(signal.is_some(), k + 1, sim, record, &mut watch);
        }
        if let Some(signal) = signal {
            stopped = Some((sim.time(), Stop::Asked(signal)));
            break;
        }
    }
    if stopped.is_some() {
        // The last good state may lie between two output times.
        let later = record.rows.last().is_some_and(|r| sim.time() > r.t);
        if let (true, Ok(row)) = (later, sample(setup, sim)) {
            keep(record, row);
            watch.look(setup, sim, record);
        }
        bar.abandon();
    } else {
        bar.finish_and_clear();
    }
    watch.end(setup, sim.time(), record);
    let explained = explained(record, run.integrator);
    let drifts = std::mem::take(&mut record.drifts);
    record.notices.extend(drifts.into_iter().filter(|(size, _)| *size > explained).map(|(_, text)| text));
    Ok(stopped)
}

/// On standard error, and only if that is a terminal.
fn progress(duration: f64) -> ProgressBar {
    let bar = ProgressBar::new(PROGRESS);
    // How long it takes is known from the first row on.
    set_style(&bar, "{bar:30} {msg}   {elapsed}");
    bar.set_message(format!("t = 0 of {duration} s"));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn set_style(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}

fn show(bar: &ProgressBar, duration: f64, row: &Row) {
    let gap = if row.gap.is_finite() { format!(", gap {:.3} m", row.gap) } else { String::new() };
    bar.set_message(format!("t = {:.3} of {duration} s{gap}", row.t));
    let position = (PROGRESS as f64 * row.t / duration) as u64;
    if bar.position() == 0 && position > 0 {
        set_style(bar, "{bar:30} {msg}   {elapsed}, {eta} to go");
    }
    bar.set_position(position);
}

/// The present state and what follows from it, in the user's order; between what the smallest gap is.
fn sample(setup: &Setup, sim: &mut Sim<'_, f64>) -> Result<(Row, String), Error> {
    let triple = |values: &[f64], core: usize| -> [f64; 3] {
        let mut out = [f64::NAN; 3];
        out.iter_mut().zip(values.iter().skip(3 * core)).for_each(|(o, v)| *o = *v);
        out
    };
    let energy = sim.energy()?;
    let impulse = sim.impulse()?;
    let mut torque = vec![0.0; setup.joints.len()];
    let mut power = torque.clone();
    if !torque.is_empty() {
        sim.joint_torques(&mut torque, &mut power)?;
    }
    let gap = sim.gap();
    let name = |place| setup.scene.name_of(place);
    let between = gap.between.map_or(String::new(), |(a, b)| format!("{} and {}", name(a), name(b)));
    let pick = |core: &usize| [torque.get(*core), power.get(*core)].map(|x| x.copied().unwrap_or(f64::NAN));
    let row = Row {
        t: sim.time(),
        pose: setup.links.iter().map(|core| triple(sim.positions(), *core)).collect(),
        velocity: setup.links.iter().map(|core| triple(sim.velocities(), *core)).collect(),
        energy: Energies {
            kinetic_fluid: energy.kinetic_fluid,
            kinetic_bodies: energy.kinetic_bodies,
            buoyancy: energy.buoyancy,
            repulsion: energy.repulsion,
            circulation: energy.circulation,
            total: energy.total,
            work: energy.work,
        },
        impulse,
        gap: gap.distance,
        resolution: sim.indicators()?,
        time_error: sim.time_error(),
        torque: setup.joints.iter().map(|(core, _)| pick(core)).collect(),
    };
    Ok((row, between))
}

/// Adds a row.
fn keep(record: &mut Record, (row, between): (Row, String)) {
    if row.gap.is_finite() && record.smallest.as_ref().is_none_or(|s| row.gap < s.distance) {
        record.smallest = Some(Nearest { distance: row.gap, time: row.t, between });
    }
    record.rows.push(row);
}

/// While something slowly comes off from rest, what the tolerance allows may be all its energy: a drift below this many tolerances
/// of the largest kinetic energy of the whole run is told to nobody.
const TOLERATED: f64 = 10.0;
/// The tolerance of methods that have none.
const TOLERANCE: f64 = 1e-9;

/// The drift of the energy that a run's tolerance explains.
fn explained(record: &Record, integrator: Integrator) -> f64 {
    let tolerance = match integrator {
        Integrator::Adams { tolerance, .. } => tolerance,
        _ => TOLERANCE,
    };
    record.energy_drift().map_or(0.0, |(_, kinetic)| (TOLERATED * tolerance).min(1e-3) * kinetic)
}

/// Error indicators and counters at the end.
fn figures(sim: &Sim<'_, f64>, record: &mut Record) {
    let mut add = |name: &str, value: String| record.figures.push((name.to_owned(), value));
    if let Some(s) = &record.smallest {
        let between = if s.between.is_empty() { String::new() } else { format!(", between {}", s.between) };
        add("smallest gap at an output time", format!("{:.4} m at t = {:.4} s{between}", s.distance, s.time));
    }
    let worst = |part: fn(&Resolution<f64>) -> f64| record.rows.iter().map(|r| part(&r.resolution)).fold(0.0, f64::max);
    let parts = [worst(|r| r.mass), worst(|r| r.force), worst(|r| r.quadrature)];
    let repulsion =
        if record.terms.repulsion { format!(", repulsion {:.1e}", worst(|r| r.repulsion)) } else { String::new() };
    let bound = format!(
        "{:.1e} (indicators: mass {:.1e}, force {:.1e}, quadrature {:.1e}{repulsion})",
        worst(Resolution::bound),
        parts[0],
        parts[1],
        parts[2]
    );
    add("bound of the relative error in space", bound);
    if let Some(row) = record.rows.last() {
        let text = match (row.time_errors(), row.time_error.unknown) {
            ([length, ..], _) if length.is_nan() => {
                "none: this integrator has no estimate, or the run was too short".into()
            }
            ([length, angle, speed, spin], unknown) => format!(
                "{length:.1e} m, {angle:.1e} rad, {speed:.1e} m/s, {spin:.1e} rad/s ({unknown} steps without estimate)"
            ),
        };
        add("sum of the estimated local errors of time integration", text);
    }
    let c = sim.counters();
    add("steps (rejected)", format!("{} ({})", c.steps, c.rejected));
    add("evaluations", c.evaluations.to_string());
    add("factorizations", c.factorizations.to_string());
    if let Some((drift, scale)) = record.energy_drift() {
        let text = format!("{drift:.1e} J/m (largest kinetic energy {scale:.3e} J/m)");
        record.figures.insert(0, ("largest drift of total energy minus work".into(), text));
    }
}

/// A few lines on standard output.
fn summary(setup: &Setup, record: &Record, folder: &Path, time: Duration) {
    let reached = record.rows.last().map_or(0.0, |r| r.t);
    say(&format!("t = {reached:.6} s reached in {:.2} s; {} rows", time.as_secs_f64(), record.rows.len()));
    for (whose, what) in setup.outlines() {
        say(&format!("  outline of {whose}: {what}"));
    }
    for (name, value) in &record.figures {
        say(&format!("  {name}: {value}"));
    }
    for notice in &record.notices {
        say(&format!("  notice: {notice}"));
    }
    if let Some(why) = &record.stopped {
        warn(&format!("stopped at {why}; the results up to then are in {}", folder.display()));
    }
    say(&format!("results: {}", folder.join("report.html").display()));
}
