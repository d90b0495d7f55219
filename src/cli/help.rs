//! `selvedge help`: the guide, page by page.

use super::{CliError, output};
use clap::Args;
use selvedge_workbench::guide_pages;

/// Which page is printed.
#[derive(Debug, Args)]
pub(super) struct HelpArgs {
    /// Page of the guide; without one, the pages are listed
    page: Option<String>,
}

/// Prints a page of the guide, or the list of them.
///
/// # Errors
/// There is no such page.
pub(super) fn run(args: &HelpArgs) -> Result<(), CliError> {
    let Some(name) = &args.page else {
        let pages = guide_pages().iter();
        let lines = pages.map(|page| format!("  {:<12} {}\n", page.name, page.about));
        let list: String = lines.collect();
        return output::print(&format!(
            "Pages of the guide, printed by selvedge help PAGE; selvedge COMMAND --help explains a \
             command:\n{list}"
        ));
    };
    if let Some(page) = guide_pages().iter().find(|page| page.name == *name) {
        return output::print(page.text);
    }
    let names: Vec<&str> = guide_pages().iter().map(|page| page.name).collect();
    Err(CliError::Input(format!(
        "the guide has no page {name:?}; it has {}; a command is explained by selvedge COMMAND \
         --help",
        names.join(", ")
    )))
}
