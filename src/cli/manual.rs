//! `selvedge completions` and `selvedge man`: what shells and manuals know of the commands, made
//! from the very declaration that parses them.

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;

use super::output::OutFile;
use super::{CliError, command, output, terminal};

/// Which shell.
#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell to complete commands in
    shell: Shell,
}

/// Where to.
#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// The folder to write into, made where it is missing
    #[arg(value_name = "DIR")]
    out: OutFile,
}

/// Prints the completions of a shell.
pub(super) fn print_completions(args: &CompletionsArgs) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "selvedge", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

/// Writes a manual page for every command.
pub(super) fn write_pages(args: &ManArgs) -> Result<(), CliError> {
    output::make_folder(&args.out, "name a folder that can be written")?;
    let mut whole = command();
    whole.build();
    let mut pages = Vec::new();
    render(&whole, &mut pages)?;
    let named: Vec<(&str, &[u8])> = pages
        .iter()
        .map(|(name, page)| (&**name, &**page))
        .collect();
    output::write_folder(&args.out, &named)?;
    let (n_pages, out) = (pages.len(), args.out.display());
    terminal::notice(&format!(
        "{n_pages} pages are in {out}; read one by man -l {out}/selvedge.1"
    ));
    Ok(())
}

/// The page of a command and those of all below it, with the names of their files.
fn render(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), CliError> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page)?;
    pages.push((man.get_filename(), page));
    let inner = command
        .get_subcommands()
        .filter(|inner| !inner.is_hide_set());
    inner.into_iter().try_for_each(|inner| render(inner, pages))
}
