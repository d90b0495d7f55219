//! `selvedge help`: the guide, page by page, and what each command takes.

use super::{CliError, command, output, usage};
use clap::Args;
use selvedge_workbench::guide_pages;

/// What is printed.
#[derive(Debug, Args)]
pub(super) struct HelpArgs {
    /// A page of the guide, or a command with the commands below it; without one, the pages are
    /// listed
    #[arg(value_name = "PAGE|COMMAND")]
    words: Vec<String>,
}

/// Prints a page of the guide, what a command takes, or the list of pages.
///
/// # Errors
/// There is no such page and no such command.
pub(super) fn run(args: &HelpArgs) -> Result<(), CliError> {
    let pages = guide_pages();
    let Some(first) = args.words.first() else {
        let lines = pages.iter();
        let lines = lines.map(|page| format!("  {:<12} {}\n", page.name, page.about));
        let list: String = lines.collect();
        return output::print(&format!(
            "Pages of the guide, printed by selvedge help PAGE; selvedge help COMMAND explains a \
             command:\n{list}"
        ));
    };
    if let [name] = &args.words[..]
        && let Some(page) = pages.iter().find(|page| page.name == *name)
    {
        return output::print(page.text);
    }
    let mut whole = command();
    whole.build();
    let mut found = &mut whole;
    for word in &args.words {
        let above = found.get_bin_name().unwrap_or("selvedge").to_owned();
        let names: Vec<String> = found
            .get_subcommands()
            .map(|c| c.get_name().to_owned())
            .collect();
        found = found.find_subcommand_mut(word).ok_or_else(|| {
            let pages = pages.iter().map(|page| page.name).filter(|_| word == first);
            let known = names.iter().map(String::as_str).chain(pages);
            let like = usage::like(word, known);
            let meant = like.map_or_else(
                || "selvedge help lists the pages".to_owned(),
                |like| format!("did you mean {like}?"),
            );
            let what = if word == first {
                "is neither a page of the guide nor a command"
            } else {
                "is no command"
            };
            CliError::Input(format!("{word:?} {what} of {above}; {meant}"))
        })?;
    }
    output::print(&found.render_long_help().to_string())
}
