//! `selvedge experiment analyse`: tables, tests and figures from the logs in a folder.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::output::OutFile;
use super::super::terminal::{self, with_meter};
use super::super::{CliError, output};

use selvedge_experiment::analysis::{self, Analysis, Cell, Options, UNREAD};
use selvedge_experiment::{ExperimentError, Participants, write_bids};

/// Logs, and how they are analysed.
#[derive(Debug, Args)]
pub(crate) struct AnalyseArgs {
    /// Folder of the logs, each with its .json beside it
    logs: PathBuf,
    /// Folder for index.md, tables and figures; it is made where it is missing
    #[arg(long, value_name = "OUT")]
    out: OutFile,
    /// What chance begins with: starts of maps, permutations, draws of subjects
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Maps of subjects drawn anew, from which the ellipses follow; 0 for none
    #[arg(long, value_name = "N", default_value_t = 100)]
    maps: u16,
    /// Permutations for p values
    #[arg(long, value_name = "N", default_value_t = 4999,
        value_parser = clap::value_parser!(u32).range(99..=1_000_000))]
    permutations: u32,
    /// Sets of random ranks to compare the stress of maps with; 0 for none
    #[arg(long, value_name = "N", default_value_t = 40)]
    random_data: u16,
    /// New folder for the trials as a data set after BIDS, with scripts in R and Python that make
    /// its main table once more
    #[arg(long, value_name = "DIR")]
    bids: Option<OutFile>,
}

/// Analyses the logs, and writes what was found.
pub(super) fn run(args: &AnalyseArgs) -> Result<(), CliError> {
    let same = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if same(&args.out) == same(&args.logs) {
        return Err(CliError::Input(format!(
            "tables beside the logs in {} would be taken for logs; give another folder, such as {}",
            args.logs.display(),
            args.logs.join("analysis").display()
        )));
    }
    let options = Options {
        seed: args.seed,
        n_permutations: usize::try_from(args.permutations).unwrap_or(usize::MAX),
        n_maps: usize::from(args.maps),
        n_random_data: usize::from(args.random_data),
        cache: selvedge_workbench::build_cache(),
        ..Options::default()
    };
    let analysed = with_meter("analysing", |progress| {
        let (found, unread) = analysis::sessions(&args.logs, progress)?;
        let analysis = Analysis::with_unread(&found, &unread, &options, progress)?;
        Ok((analysis, found))
    })?;
    let (analysis, found) = analysed.map_err(|error: ExperimentError| match error {
        ExperimentError::Cancelled(stopped) => CliError::from(stopped),
        other => other.into(),
    })?;
    for (log, why) in left_out(&analysis) {
        terminal::notice(&format!("{log} is left out: {why}"));
    }
    analysis.write(&args.out)?;
    if let Some(out) = &args.bids {
        write_bids(&found, &Participants::read(&args.logs)?, out)?;
    }
    output::print(&summary(&analysis, args))
}

/// Logs that could not be read, and why.
fn left_out(analysis: &Analysis) -> impl Iterator<Item = (&str, &str)> {
    let section = analysis.sections.iter().find(|s| s.key == UNREAD);
    let rows = section
        .into_iter()
        .flat_map(|s| &s.tables)
        .flat_map(|t| &t.rows);
    rows.filter_map(|row| match row.as_slice() {
        [Cell::Text(log), Cell::Text(why)] => Some((log.as_str(), why.as_str())),
        _ => None,
    })
}

fn summary(analysis: &Analysis, args: &AnalyseArgs) -> String {
    let n_tables: usize = analysis.sections.iter().map(|s| s.tables.len()).sum();
    let n_figures: usize = analysis.sections.iter().map(|s| s.figures.len()).sum();
    format!(
        "{}\n{n_tables} tables and {n_figures} figures; begin with {}\n",
        analysis.title,
        args.out.join("index.md").display()
    )
}
