//! `selvedge textile catalogue`: a sheet for every textile of a library.

use std::path::PathBuf;

use clap::Args;

use super::terminal::Meter;
use super::{CliError, output, signals};
use selvedge_foundation::progress::{CancelFlag, Progress};
use selvedge_textile::Library;

/// Where the catalogue goes.
#[derive(Debug, Args)]
pub(super) struct CatalogueArgs {
    /// The folder of the sheets and their index.md
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Writes it.
pub(super) fn run(library: &Library, args: &CatalogueArgs) -> Result<(), CliError> {
    let cancel = CancelFlag::shared(signals::stop_flag()?);
    let mut meter = Meter::new("drawing");
    let mut report = |share: f64, doing: &str| meter.show(share, doing);
    let mut progress = Progress::new(&mut report, cancel);
    let n_textiles = selvedge_textile::write_catalogue(library, &args.out, &mut progress)?;
    let index = args.out.join("index.md");
    output::print(&format!("{}: {n_textiles} textiles\n", index.display()))
}
