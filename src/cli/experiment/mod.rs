//! `selvedge experiment`: experiments on people without a window.

mod analyse;
mod designs;
mod desk;
mod noise;
mod plan;
mod preview;
mod replicate;
mod run;
mod simulate;
mod verify;

use clap::Subcommand;

use super::CliError;

/// What to do with experiments.
#[derive(Debug, Subcommand)]
pub(super) enum ExperimentCommand {
    /// Hold a session: what is to be laid is said, answers are typed
    Run(Box<run::RunArgs>),
    /// Tables, tests and figures from the logs in a folder
    Analyse(analyse::AnalyseArgs),
    /// Whether the logs in a folder are as they were written
    Verify(verify::VerifyArgs),
    /// A plan to freeze before the first subject: hypotheses, tests, number, exclusions
    Plan(plan::PlanArgs),
    /// What a design comes to: trials, duration, balance, power
    Preview(preview::PreviewArgs),
    /// The designs that are part of the program
    Designs(designs::DesignsArgs),
    /// A noise that covers what an array can be heard by, as a sound file
    Noise(noise::NoiseArgs),
    /// Sessions of simulated observers, written as those of people are
    Simulate(simulate::SimulateArgs),
    /// The papers' experiments by simulated observers: printed beside obtained
    Replicate(replicate::ReplicateArgs),
}

/// Does it.
pub(super) fn run(command: &ExperimentCommand) -> Result<(), CliError> {
    match command {
        ExperimentCommand::Run(args) => run::run(args),
        ExperimentCommand::Analyse(args) => analyse::run(args),
        ExperimentCommand::Verify(args) => verify::run(args),
        ExperimentCommand::Plan(args) => plan::run(args),
        ExperimentCommand::Preview(args) => preview::run(args),
        ExperimentCommand::Designs(args) => designs::run(args),
        ExperimentCommand::Noise(args) => noise::run(args),
        ExperimentCommand::Simulate(args) => simulate::run(args),
        ExperimentCommand::Replicate(args) => replicate::run(args),
    }
}
