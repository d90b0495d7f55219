//! `selvedge --stage`: the public face; and `selvedge stage`: what visitors did.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Subcommand;

use super::output::OutFile;
use super::{CliError, signals, terminal, workbench};

use selvedge_experiment::visits::Totals;
use selvedge_workbench::StageOptions;

/// What can be done with the log of a stage.
#[derive(Debug, Subcommand)]
pub(super) enum StageCommand {
    /// Its rows, and totals with intervals beside chance
    Export {
        /// The folder to write into
        #[arg(long, value_name = "DIR")]
        out: OutFile,
        /// The folder of the log (the one that the operator's file names)
        #[arg(long, value_name = "DIR")]
        log: Option<PathBuf>,
        /// The operator's file (stage.toml among the settings)
        #[arg(long, value_name = "TOML")]
        operator: Option<PathBuf>,
    },
}

/// Opens the stage over the whole screen.
///
/// # Errors
/// A scene or an operator's file that is wrong, before a window is tried; no display.
pub(super) fn open(scene: Option<&Path>, operator: Option<&Path>) -> Result<(), CliError> {
    workbench::check(scene)?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let mut options = StageOptions::read(operator)?;
    options.scene = scene.map(Path::to_owned);
    // Another order every time; which it was is in the log.
    options.seed = now.map_or(1, |since| since.as_secs());
    let listen = |end: selvedge_workbench::EndSwitch| signals::on_signal(move || end.press());
    Ok(selvedge_workbench::run_stage(options, listen)?)
}

/// Does something with the log.
///
/// # Errors
/// There is none, or it cannot be read or written.
pub(super) fn run(command: &StageCommand) -> Result<(), CliError> {
    let StageCommand::Export { out, log, operator } = command;
    let log = match log {
        Some(log) => Some(log.clone()),
        None => StageOptions::read(operator.as_deref())?.log,
    };
    let Some(log) = log else {
        let words = "there is no folder for the log here; name it with --log DIR";
        return Err(CliError::Input(words.to_owned()));
    };
    let totals = Totals::of_folder(&log)?;
    totals.write(out)?;
    let words = format!("{} visits, totals in {}", totals.n_visits(), out.display());
    terminal::notice(&words);
    Ok(())
}
