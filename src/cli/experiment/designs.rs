//! `selvedge experiment designs`: what can be held without writing a file.

use std::path::Path;

use clap::Args;

use super::super::output::{Cell, JsonArgs};
use super::super::{CliError, output, usage};
use selvedge_experiment::design::Design;

/// Which designs to show.
#[derive(Debug, Args)]
pub(crate) struct DesignsArgs {
    /// Print the file of this design, to begin one's own with
    #[arg(long, value_name = "NAME", conflicts_with = "json")]
    show: Option<String>,
    #[command(flatten)]
    how: JsonArgs,
}

/// Prints a line a design, or the file of one.
pub(super) fn run(args: &DesignsArgs) -> Result<(), CliError> {
    let Some(name) = &args.show else {
        return list(&args.how);
    };
    let text = Design::shipped_text(name).ok_or_else(|| {
        let mend = mend(name);
        CliError::Input(format!("no design is called {name:?}; {mend}"))
    })?;
    output::print(text)
}

fn list(how: &JsonArgs) -> Result<(), CliError> {
    let row = |name: &str| {
        let design = Design::shipped(name)?;
        let (medium, method) = (design.medium.name(), design.composition.kind().name());
        Some([name, medium, method, &design.title].map(Cell::text))
    };
    let rows: Vec<_> = Design::shipped_names().filter_map(row).collect();
    let columns = ["name", "medium", "method", "title"];
    let line = |[name, medium, method, title]: &[Cell; 4]| {
        format!("{name:<24}{medium:<12}{method:<14}{title}\n")
    };
    output::print_rows(how, columns, &rows, || rows.iter().map(line).collect())
}

/// What to give in place of a name that is not known.
fn mend(name: &str) -> String {
    usage::mend(name, &Design::shipped_names().collect::<Vec<_>>())
}

/// The design of a file, or of the program where no file has that name.
pub(super) fn design(named: &Path) -> Result<Design, CliError> {
    if named.exists() {
        return Ok(Design::read(named)?);
    }
    named.to_str().and_then(Design::shipped).ok_or_else(|| {
        let name = named.display().to_string();
        let mend = mend(&name);
        CliError::Input(format!(
            "there is no design {name}, neither a file nor a name; {mend}"
        ))
    })
}
