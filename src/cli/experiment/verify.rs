//! `selvedge experiment verify`: whether logs are as they were written.

use std::path::PathBuf;

use clap::Args;

use super::super::output::{Cell, JsonArgs};
use super::super::terminal::with_meter;
use super::super::{CliError, output};
use selvedge_experiment::session::Verified;

/// Which logs to look at.
#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// Folder of the logs, each with its .json beside it
    logs: PathBuf,
    #[command(flatten)]
    how: JsonArgs,
}

/// Prints a line for everything that is not as it was written.
pub(super) fn run(args: &VerifyArgs) -> Result<(), CliError> {
    let verified = with_meter("verifying", |progress| {
        Verified::of_folder(&args.logs, progress)
    })??;
    let (n_logs, n_open, n_broken) = (verified.n_logs, verified.n_open, verified.n_broken);
    if n_logs == 0 {
        let what = format!("{} holds no session", args.logs.display());
        let mend = "name a folder with logs and the .json file beside each of them";
        return Err(CliError::Input(format!("{what}; {mend}")));
    }
    let open = match n_open {
        0 => String::new(),
        n => format!(", {n} not closed: trials are missing"),
    };
    let broken: Vec<String> = verified.breaks.iter().map(ToString::to_string).collect();
    let lines = broken.iter().map(|one| format!("{one}\n"));
    let words = lines.collect::<Vec<_>>().concat();
    let broken = broken
        .into_iter()
        .map(|one| ["break".to_owned(), one].map(Cell::text));
    let counts = [("logs", n_logs), ("broken", n_broken), ("open", n_open)];
    let counts = counts.map(|(what, n)| [Cell::text(what), Cell::count(n)]);
    let rows: Vec<_> = broken.chain(counts).collect();
    output::print_rows(&args.how, ["what", "value"], &rows, || {
        format!("{words}{n_logs} logs, {n_broken} broken{open}\n")
    })?;
    if n_broken == 0 {
        return Ok(());
    }
    let what = format!("{n_broken} of {n_logs} logs are not as they were written");
    Err(CliError::Failed(format!(
        "{what}; restore them from a copy, or leave them out"
    )))
}
