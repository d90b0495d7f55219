//! `selvedge help`: the guide, page by page, and what each command takes.

use super::{CliError, command, output, usage};
use clap::{Args, Command};
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
    let whole = command();
    let mut found = &whole;
    for word in &args.words {
        let inner = found.find_subcommand(word);
        let pages = pages.iter().map(|page| page.name).filter(|_| word == first);
        found = inner.ok_or_else(|| unknown(word, found, pages))?;
    }
    // The very text of the option, which is long or short as the command has it.
    let words = ["selvedge"]
        .into_iter()
        .chain(args.words.iter().map(String::as_str));
    let parsed = whole.clone().try_get_matches_from(words.chain(["--help"]));
    output::print(&parsed.map_or_else(|help| help.render().to_string(), |_| String::new()))
}

/// What to say of a word that is no command of this one, nor one of these pages.
fn unknown<'a>(word: &str, of: &Command, pages: impl Iterator<Item = &'a str>) -> CliError {
    let pages: Vec<&str> = pages.collect();
    let names = of.get_subcommands().map(Command::get_name);
    let like = usage::like(word, names.chain(pages.iter().copied()));
    let meant = like.map_or_else(
        || "selvedge help lists the pages, selvedge --help the commands".to_owned(),
        |like| format!("did you mean {like}?"),
    );
    let what = if pages.is_empty() {
        format!("no command of {}", of.get_name())
    } else {
        "neither a page of the guide nor a command".to_owned()
    };
    CliError::Input(format!("{word:?} is {what}; {meant}"))
}
