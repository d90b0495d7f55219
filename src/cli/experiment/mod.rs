//! `selvedge experiment`: experiments on people without a window.

mod analyse;
mod designs;
mod desk;
mod run;

use std::path::Path;

use clap::Subcommand;

use super::CliError;
use crate::experiment::design::Design;

/// What to do with experiments.
#[derive(Debug, Subcommand)]
pub(super) enum ExperimentCommand {
    /// Hold a session: what is to be laid is said, answers are typed
    Run(Box<run::RunArgs>),
    /// Tables, tests and figures from the logs in a folder
    Analyse(analyse::AnalyseArgs),
    /// The designs that are part of the program
    Designs(designs::DesignsArgs),
}

/// Does it.
pub(super) fn run(command: &ExperimentCommand) -> Result<(), CliError> {
    match command {
        ExperimentCommand::Run(args) => run::run(args),
        ExperimentCommand::Analyse(args) => analyse::run(args),
        ExperimentCommand::Designs(args) => designs::run(args),
    }
}

/// The design of a file, or of the program where no file has that name.
fn design(named: &Path) -> Result<Design, CliError> {
    let shipped = named.to_str().and_then(Design::shipped);
    match shipped {
        Some(design) if !named.exists() => Ok(design),
        _ if named.exists() => Ok(Design::read(named)?),
        _ => {
            let name = named.display();
            let what = format!(
                "{name} is neither a file nor a design of the program; \
                 see \"selvedge experiment designs\""
            );
            Err(CliError::Input(what))
        }
    }
}
