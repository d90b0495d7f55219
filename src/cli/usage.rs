//! What is answered when the command line cannot be parsed: help, the version, or one line that
//! says what is wrong.

use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;

use super::{output, terminal};

/// Reads one of some values by its name.
pub(super) fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [(&'static str, T); N],
) -> impl TypedValueParser<Value = T> {
    let parser = PossibleValuesParser::new(all.map(|(name, _)| name));
    parser.try_map(move |text: String| {
        let found = all.iter().find(|(name, _)| *name == text);
        found
            .map(|(_, value)| *value)
            .ok_or("this has no meaning here")
    })
}

/// Answers help and version on standard output, everything else with one line and exit code 2.
pub(super) fn answer(error: &clap::Error) -> ExitCode {
    let text = error.render().to_string();
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // There is nothing left to do if nobody reads it.
            drop(output::print(&text));
            ExitCode::SUCCESS
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
            terminal::notice(&format!("a command is missing; see {}", help_of(&text)));
            ExitCode::from(2)
        }
        _ => {
            terminal::notice(&format!("{}; see {}", complaint(&text), help_of(&text)));
            ExitCode::from(2)
        }
    }
}

/// The complaint without its heading, the usage and the hints, on one line.
fn complaint(text: &str) -> String {
    let text = text.strip_prefix("error: ").unwrap_or(text);
    let is_complaint = |line: &&str| {
        let line = line.trim_start();
        !line.starts_with("Usage:") && !line.starts_with("For more information")
    };
    let lines = text.lines().take_while(is_complaint).map(str::trim);
    let words = lines
        .filter(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(" ");
    words.replace(" tip: ", "; ")
}

/// The command whose help explains the usage that the text shows: `selvedge render --help`.
fn help_of(text: &str) -> String {
    let usage = text
        .lines()
        .find_map(|line| line.trim_start().strip_prefix("Usage: "));
    let is_word = |word: &&str| word.bytes().all(|b| b.is_ascii_lowercase());
    let words: Vec<&str> = usage
        .unwrap_or("selvedge")
        .split_whitespace()
        .take_while(is_word)
        .collect();
    format!("\"{} --help\"", words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "error: the following required arguments were not provided:\n  \
        --path <PATH>\n\nUsage: selvedge render --path <PATH> <SCENE>\n\nFor more information, \
        try '--help'.\n";

    #[test]
    fn a_complaint_becomes_one_line_that_names_the_help() {
        assert_eq!(
            complaint(TEXT),
            "the following required arguments were not provided: --path <PATH>"
        );
        assert_eq!(help_of(TEXT), "\"selvedge render --help\"");
        assert_eq!(help_of("Usage: selvedge [SCENE]"), "\"selvedge --help\"");
    }
}
