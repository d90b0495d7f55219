//! `selvedge friction`: friction from a picture, and how far a network gets.

mod data;
mod evaluate;
mod generate;
mod pages;
mod table;
mod train;

use std::path::Path;

use clap::Subcommand;

use super::CliError;
use super::terminal;
use selvedge_foundation::progress::{Progress, thread_cpu_seconds};
use selvedge_friction::{FrictionError, KeptRun, Run, Scores, Taken};

/// What is done.
#[derive(Debug, Subcommand)]
pub(super) enum FrictionCommand {
    /// The coefficient of friction along the middle of a picture
    Generate(generate::GenerateArgs),
    /// Train networks on procedural cloth; finished runs are kept, broken ones go on
    Train(train::TrainArgs),
    /// The table of all methods on all splits, from the runs of a folder
    Evaluate(evaluate::EvaluateArgs),
}

/// Runs one of them.
pub(super) fn run(command: &FrictionCommand) -> Result<(), CliError> {
    match command {
        FrictionCommand::Generate(args) => generate::run(args),
        FrictionCommand::Train(args) => train::run(args),
        FrictionCommand::Evaluate(args) => evaluate::run(args),
    }
}

/// The folder of runs, made where it is missing.
fn folder(out: &Path) -> Result<(), CliError> {
    super::output::make_folder(out, "name another with --out")
}

/// Runs it to its end and puts it into its folder's table, with what it cost unless it was broken
/// off before. All of it runs on this thread.
fn run_timed(
    run: &Run<'_>,
    taken: &Taken,
    progress: &mut Progress<'_>,
) -> Result<Scores, FrictionError> {
    let is_whole = !run.is_begun();
    let start_s = thread_cpu_seconds();
    let scores = run.run(taken, progress, &mut |said| terminal::line(said))?;
    let cpu_s = is_whole.then(|| ((thread_cpu_seconds() - start_s) * 1e3).round() / 1e3);
    KeptRun::of(run, &scores, cpu_s).keep(run.folder)?;
    Ok(scores)
}
