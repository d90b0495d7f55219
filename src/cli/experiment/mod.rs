//! `selvedge experiment`: studies on people.

mod simulate;

use clap::Subcommand;

use super::CliError;

/// What is done with experiments.
#[derive(Debug, Subcommand)]
pub(super) enum ExperimentCommand {
    /// Sessions of simulated observers, written as those of people are
    Simulate(simulate::SimulateArgs),
}

pub(super) fn run(command: &ExperimentCommand) -> Result<(), CliError> {
    match command {
        ExperimentCommand::Simulate(args) => simulate::run(args),
    }
}
