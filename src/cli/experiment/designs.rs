//! `selvedge experiment designs`: what can be held without writing a file.

use std::path::Path;

use clap::Args;

use super::super::{CliError, output};
use selvedge_experiment::design::Design;

/// Which designs to show.
#[derive(Debug, Args)]
pub(crate) struct DesignsArgs {
    /// Print the file of this design, to begin one's own with
    #[arg(long, value_name = "NAME")]
    show: Option<String>,
}

/// Prints a line a design, or the file of one.
pub(super) fn run(args: &DesignsArgs) -> Result<(), CliError> {
    let Some(name) = &args.show else {
        return output::print(&table());
    };
    let text = Design::shipped_text(name).ok_or_else(|| {
        let known: Vec<&str> = Design::shipped_names().collect();
        let what = format!("no design is called {name:?}; give {}", known.join(", "));
        CliError::Input(what)
    })?;
    output::print(text)
}

fn table() -> String {
    let line = |name: &str| {
        let design = Design::shipped(name)?;
        let (medium, method) = (design.medium.name(), design.composition.kind().name());
        Some(format!(
            "{name:<24}{medium:<12}{method:<14}{}\n",
            design.title
        ))
    };
    Design::shipped_names().filter_map(line).collect()
}

/// The design of a file, or of the program where no file has that name.
pub(super) fn design(named: &Path) -> Result<Design, CliError> {
    if named.exists() {
        return Ok(Design::read(named)?);
    }
    named.to_str().and_then(Design::shipped).ok_or_else(|| {
        let names: Vec<&str> = Design::shipped_names().collect();
        CliError::Input(format!(
            "there is no design {}; give a file, or one of {}",
            named.display(),
            names.join(", ")
        ))
    })
}
