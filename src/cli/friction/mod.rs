//! `selvedge friction`: friction from a picture, and how far a network gets.

mod data;
mod evaluate;
mod generate;
mod pages;
mod train;

use std::path::Path;

use clap::Subcommand;

use super::CliError;

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
