//! The command `nekton`: scene files in; tables, plots and an animated report out. A library only so that the developers'
//! commands draw with the same [`plots`].

mod checkpoint;
mod ending;
mod evaluate;
mod ingredients;
mod output;
mod plan;
pub mod plots;
mod record;
mod report;
mod run;
mod scene_file;
mod setup;
mod signals;
mod trade;
mod waiting;
mod watch;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::{Parser, Subcommand};
use ending::{Ending, say, spoken, warn};

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  2  bad input: one line on standard error names file, line and a way out; nothing was written. Or standard output could not be
     written (a reader that has gone away is no error); results of a run are there then
  3  the run stopped before its end (contact, a singular matrix, a tolerance that cannot be met, SIGINT, SIGTERM); the results up to
     then were written, and report.html says why it stopped";

/// Rigid and articulated bodies in a two-dimensional ideal fluid.
#[derive(Parser)]
#[command(name = "nekton", version, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate a scene and write tables, plots and a report
    #[command(after_help = EXIT_CODES)]
    Run {
        /// Scene file (TOML)
        scene: PathBuf,
        /// Folder for trajectory.csv, energy.csv, torque.csv, report.html and the plots as SVG
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Choose nodes, integrator and step for this relative error, by SCENE's table of `nekton trade` or by measuring a few
        #[arg(long, value_name = "E", value_parser = positive)]
        error: Option<f64>,
        /// Let a channel of the scene follow a table (t,u[,du[,ddu]]); once for each channel
        #[arg(long = "channel", value_name = "NAME=FILE", value_parser = channel)]
        channels: Vec<(String, PathBuf)>,
        /// Keep in this folder what it takes to go on after the process has ended, however it ended
        #[arg(long, value_name = "DIR", conflicts_with = "error")]
        checkpoint: Option<PathBuf>,
        /// Time of the wall clock between two checkpoints (90, 90s, 5m, 1h), which are written after a row of the tables
        #[arg(long, value_name = "TIME", value_parser = span, default_value = "60s", requires = "checkpoint")]
        every: Duration,
        /// Go on from the checkpoint, if there is one; the files will be those of a run without interruption
        #[arg(long, requires = "checkpoint")]
        resume: bool,
        /// Replace complete results by shorter ones, and a checkpoint by a run that begins anew
        #[arg(long, conflicts_with = "resume")]
        force: bool,
    },
    /// Measure the trade between speed and accuracy: many settings against a converged reference
    #[command(after_help = EXIT_CODES)]
    Trade {
        /// Scene file (TOML)
        scene: PathBuf,
        /// Folder for trade.csv, trade.svg, recommended.csv and reference.csv [default: SCENE with the ending .trade]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Relative errors for which a setting is recommended, one or more: --error 1e-3 1e-6
        #[arg(long, value_name = "E …", value_parser = positive, value_delimiter = ',', default_values = ["1e-3", "1e-6", "1e-9"])]
        error: Vec<f64>,
        /// Seconds after which a run is given up and noted as "over the limit"
        #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 5.0)]
        limit: f64,
        /// Simulated time, if not all that can be compared
        #[arg(long, value_name = "T", value_parser = positive)]
        until: Option<f64>,
        /// Only the usual force, quadrature and precision
        #[arg(long)]
        quick: bool,
    },
    /// Evaluate matrices, forces and energies once, at the initial state
    #[command(after_help = EXIT_CODES)]
    Evaluate {
        /// Scene file (TOML)
        scene: PathBuf,
        /// Print one JSON object instead of a table
        #[arg(long)]
        json: bool,
    },
    /// Show what will be computed and what it costs
    #[command(after_help = EXIT_CODES)]
    Plan {
        /// Scene file (TOML)
        scene: PathBuf,
        /// Show what each ingredient of the scene adds, by counts
        #[arg(long)]
        ingredients: bool,
        /// With --ingredients: as CSV
        #[arg(long, requires = "ingredients")]
        csv: bool,
    },
}

/// A number greater than 0.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("must be a number greater than 0".into()),
    }
}

/// Arguments in which every number after `--error` has an `--error` of its own: a list that took all that follows would swallow the
/// scene.
fn spread(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut spread: Vec<OsString> = Vec::new();
    let mut listing = false;
    for argument in arguments {
        let number = argument.to_str().is_some_and(|a| a.split(',').all(|a| a.parse::<f64>().is_ok()));
        if listing && number && spread.last().is_some_and(|last| last != "--error") {
            spread.push("--error".into());
        }
        listing = argument == "--error" || (listing && number);
        spread.push(argument);
    }
    spread
}

/// A time with its unit.
fn span(text: &str) -> Result<Duration, String> {
    let unit = text.find(|c: char| c.is_ascii_alphabetic() && c != 'e').unwrap_or(text.len());
    let (number, unit) = text.split_at(unit);
    let factor = match unit {
        "" | "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => f64::NAN,
    };
    number
        .parse()
        .ok()
        .and_then(|x: f64| Duration::try_from_secs_f64(x * factor).ok())
        .ok_or_else(|| "must be a time such as 90, 90s, 5m or 1h".into())
}

/// A channel's name and the path of a table.
fn channel(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => Ok((name.to_owned(), file.into())),
        _ => Err("must be the name of a channel, an equals sign and the path of a table".into()),
    }
}

/// Does what the arguments of the process say.
pub fn command() -> ExitCode {
    let ending = match Arguments::try_parse_from(spread(std::env::args_os())).map(|a| a.command) {
        Err(wrong) if wrong.use_stderr() => {
            warn(wrong.to_string().trim_end());
            return ExitCode::from(2);
        }
        // Help or version was asked for.
        Err(asked) => {
            say(asked.to_string().trim_end());
            Ok(Ending::Complete)
        }
        Ok(Command::Run { scene, out, error, channels, checkpoint, every, resume, force }) => {
            let wish = checkpoint::Wish { folder: checkpoint, every, resume, force };
            run::run(&scene, &out, error, &channels, &wish)
        }
        Ok(Command::Trade { scene, out, error, limit, until, quick }) => {
            trade::trade(&scene, &trade::Wish { out, errors: error, limit, until, quick })
        }
        Ok(Command::Evaluate { scene, json }) => evaluate::evaluate(&scene, json),
        Ok(Command::Plan { scene, ingredients: false, .. }) => plan::plan(&scene),
        Ok(Command::Plan { scene, csv, .. }) => ingredients::print(&scene, csv),
    };
    match ending.and_then(|ending| spoken().map(|()| ending)) {
        Ok(Ending::Complete) => ExitCode::SUCCESS,
        Ok(Ending::Stopped) => ExitCode::from(3),
        Err(problem) => {
            warn(&problem.to_string());
            ExitCode::from(2)
        }
    }
}
