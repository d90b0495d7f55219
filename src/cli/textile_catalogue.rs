//! `selvedge textile catalogue`: a sheet for every textile of a library.

use clap::Args;

use super::output::OutFile;
use super::terminal::with_meter;
use super::{CliError, output};
use selvedge_foundation::progress::Progress;
use selvedge_textile::{Library, write_catalogue};

/// Where the catalogue goes.
#[derive(Debug, Args)]
pub(super) struct CatalogueArgs {
    /// The folder of the sheets and their index.md
    #[arg(long, value_name = "DIR")]
    out: OutFile,
}

/// Writes it.
pub(super) fn run(library: &Library, args: &CatalogueArgs) -> Result<(), CliError> {
    let write = |progress: &mut Progress<'_>| write_catalogue(library, &args.out, progress);
    let n_textiles = with_meter("drawing", write)??;
    let index = args.out.join("index.md");
    output::print(&format!("{}: {n_textiles} textiles\n", index.display()))
}
