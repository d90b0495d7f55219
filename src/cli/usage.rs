//! What is answered when the command line cannot be parsed: help, the version, or one line that
//! says what is wrong.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::Command;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;

use super::{CliError, output, terminal};
use selvedge_textile::Library;

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

/// Puts a `--quiet` that comes before the command behind it, where it may stand: what comes first
/// is otherwise a scene.
pub(super) fn switch_behind_command(args: &mut [OsString]) {
    if let [_, switch, command, ..] = args
        && (switch == "--quiet" || switch == "-q")
    {
        std::mem::swap(switch, command);
    }
}

/// Answers help and version on standard output, everything else with one line and exit code 2.
pub(super) fn answer(error: &clap::Error, args: &[OsString], command: &Command) -> ExitCode {
    let text = error.render().to_string();
    let help = help_of(args, command);
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // There is nothing left to do if nobody reads it.
            drop(output::print(&text));
            ExitCode::SUCCESS
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
            terminal::notice(&format!("a command is missing; see {help}"));
            ExitCode::from(2)
        }
        _ => {
            terminal::notice(&format!("{}; see {help}", complaint(&text)));
            ExitCode::from(2)
        }
    }
}

/// The line about a first word that is neither a command nor a file, where it is much like a
/// command or more follows: clap takes it for a scene.
pub(super) fn unknown_command(args: &[OsString], command: &Command) -> Option<String> {
    let [word, more @ ..] = args else {
        return None;
    };
    let word = word.to_str().filter(|word| !word.starts_with('-'))?;
    let is_file = Path::new(word).exists() || word.contains(['/', '\\', '.']);
    if is_file || command.find_subcommand(word).is_some() {
        return None;
    }
    let known = command.get_subcommands().map(Command::get_name);
    let meant = match like(word, known) {
        Some(like) => format!("did you mean {like}?"),
        None if more.is_empty() => return None,
        None => "see \"selvedge --help\"".to_owned(),
    };
    Some(format!(
        "{word} is neither a command nor a scene file; {meant}"
    ))
}

/// The name that a word is most like, if it is but for a letter in three.
pub(super) fn like<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let apart = names.map(|name| (n_edits(word, name), name));
    let (n_edits, name) = apart.min_by_key(|(n_edits, _)| *n_edits)?;
    (3 * n_edits <= word.len().max(name.len())).then_some(name)
}

/// What to do about a name that is not among those known: what was perhaps meant, or all there is.
pub(super) fn mend(name: &str, known: &[&str]) -> String {
    match like(name, known.iter().copied()) {
        Some(meant) => format!("did you mean {meant}?"),
        None => format!("give one of {}", known.join(", ")),
    }
}

/// Refuses a textile that a library does not have, where it is like one that it has.
///
/// # Errors
/// The id is such a one.
pub(super) fn check_id(library: &Library, id: &str) -> Result<(), CliError> {
    let ids = || library.ids().iter().map(String::as_str);
    match like(id, ids()) {
        Some(meant) if !ids().any(|known| known == id) => Err(CliError::Input(format!(
            "no textile \"{id}\"; did you mean {meant}?"
        ))),
        _ => Ok(()),
    }
}

/// Letters to be left out, put in or exchanged to make one word of another (Levenshtein 1966), two
/// neighbours that changed places counting once (Damerau 1964).
fn n_edits(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|word| word.chars().collect::<Vec<char>>());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let before = &rows[i - 1];
            let exchanged = before[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut n = exchanged.min(before[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                n = n.min(rows[i - 2][j - 2] + 1);
            }
            row.push(n);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
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

/// The help of the command that the words begin with: `"selvedge textile show --help"`.
fn help_of(words: &[OsString], command: &Command) -> String {
    let (mut help, mut command) = ("\"selvedge".to_owned(), command);
    for word in words {
        let Some(sub) = command.find_subcommand(word) else {
            break;
        };
        help = format!("{help} {}", sub.get_name());
        command = sub;
    }
    help + " --help\""
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
        let command = crate::command();
        for (words, expected) in [
            ("probe --delay nan", "\"selvedge probe --help\""),
            ("textile show", "\"selvedge textile show --help\""),
            ("silk.toml --x", "\"selvedge --help\""),
        ] {
            let words: Vec<OsString> = words.split(' ').map(OsString::from).collect();
            assert_eq!(help_of(&words, &command), expected);
        }
    }

    #[test]
    fn a_word_is_like_the_name_that_few_letters_part_it_from() {
        let names = ["render", "report", "bridge", "mds"];
        for (word, expected) in [
            ("rendr", Some("render")),
            ("redner", Some("render")),
            ("brigde", Some("bridge")),
            ("mdss", Some("mds")),
            ("replay", None),
            ("", None),
        ] {
            assert_eq!(like(word, names.into_iter()), expected, "{word}");
        }
        assert_eq!(n_edits("abc", "abc"), 0);
        assert_eq!(n_edits("kitten", "sitting"), 3);
    }

    #[test]
    fn a_misspelt_command_is_told_as_one_and_a_scene_is_not() {
        let command = crate::command();
        let told = |words: &[&str]| {
            let words: Vec<OsString> = words.iter().map(OsString::from).collect();
            unknown_command(&words, &command)
        };
        let line = told(&["rendr", "a.toml", "--path", "b.csv"]).unwrap();
        assert!(line.ends_with("did you mean render?"), "{line}");
        assert!(told(&["rendr"]).is_some() && told(&["silk", "x"]).is_some());
        for scene in [
            &["silk"][..],
            &["a.scene.toml", "x"],
            &["--stage"],
            &["render"],
            &[],
        ] {
            assert_eq!(told(scene), None, "{scene:?}");
        }
    }
}
