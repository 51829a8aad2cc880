//! The command `nekton`: scene files in; tables, plots and an animated report out.

mod evaluate;
mod output;
mod plan;
mod plots;
mod record;
mod report;
mod run;
mod scene_file;
mod setup;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  2  bad input: one line on standard error names file, line and a way out; nothing was written
  3  the run stopped before its end (contact, a singular matrix, a tolerance that cannot be met); the results up to
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
    },
}

/// How a command ended that did not fail.
pub enum Ending {
    /// As asked.
    Complete,
    /// With results, but before the end.
    Stopped,
}

fn main() -> ExitCode {
    let ending = match Arguments::parse().command {
        Command::Run { scene, out } => run::run(&scene, &out),
        Command::Evaluate { scene, json } => evaluate::evaluate(&scene, json),
        Command::Plan { scene } => plan::plan(&scene),
    };
    match ending {
        Ok(Ending::Complete) => ExitCode::SUCCESS,
        Ok(Ending::Stopped) => ExitCode::from(3),
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(2)
        }
    }
}

/// Prints to standard output; a reader that has gone away (`nekton … | head`) is no error.
pub fn say(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stdout(), "{text}");
}
