//! Refuses a command line that names one file twice: two results in one place, or a result in place
//! of what it is made from.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command};

use super::CliError;
use super::output::{InFile, OutFile, OutPage, named_file};

/// A path of the command line, and what it is called there.
type Named = (String, PathBuf);

/// Refuses what is named twice by the innermost command that was given.
pub(super) fn check(command: &Command, matches: &ArgMatches) -> Result<(), CliError> {
    if let Some((name, inner)) = matches.subcommand()
        && let Some(command) = command.find_subcommand(name)
    {
        return check(command, inner);
    }
    let (mut results, mut sources): (Vec<Named>, Vec<Named>) = (Vec::new(), Vec::new());
    for arg in command.get_arguments() {
        let id = arg.get_id().as_str();
        let called = || {
            arg.get_long()
                .map_or_else(|| id.to_uppercase(), |long| format!("--{long}"))
        };
        let named = |path: &Path| (called(), path.to_owned());
        if let Ok(Some(files)) = matches.try_get_many::<OutFile>(id) {
            results.extend(files.map(|file| named(file)));
        } else if let Ok(Some(pages)) = matches.try_get_many::<OutPage>(id) {
            results.extend(pages.flat_map(OutPage::files).map(|file| named(&file)));
        } else if let Ok(Some(files)) = matches.try_get_many::<InFile>(id) {
            sources.extend(files.map(|file| named(file.place())));
        } else if let Ok(Some(paths)) = matches.try_get_many::<PathBuf>(id) {
            sources.extend(paths.map(|path| named(path)));
        } else if is_perhaps_a_file(arg)
            && let Ok(Some(words)) = matches.try_get_many::<String>(id)
        {
            sources.extend(words.map(|word| named(Path::new(word))));
        }
    }
    twice(&results, &sources).map_or(Ok(()), |line| Err(CliError::Input(line)))
}

/// Whether a word may be a file's name, or that of something else.
fn is_perhaps_a_file(arg: &Arg) -> bool {
    let names = arg.get_value_names().unwrap_or_default();
    names.iter().any(|name| name.contains("FILE"))
}

/// What is wrong with the files named, one line.
fn twice(results: &[Named], sources: &[Named]) -> Option<String> {
    for (nth, (called, path)) in results.iter().enumerate() {
        let is_same = |(_, other): &&Named| is_one_file(path, other);
        if let Some((other, _)) = results[..nth].iter().find(is_same) {
            let what = place(path, "standard output");
            return Some(format!(
                "{other} and {called} are both {what}; name two files"
            ));
        }
        let is_source = |named: &&Named| path.is_file() && is_same(named);
        if let Some((other, _)) = sources.iter().find(is_source) {
            let what = path.display();
            return Some(format!(
                "{called} would overwrite {what}, which {other} reads; name another file"
            ));
        }
    }
    let mut streams = sources
        .iter()
        .filter(|(_, path)| named_file(Some(path)).is_none());
    let ((first, _), (second, _)) = (streams.next()?, streams.next()?);
    Some(format!(
        "{first} and {second} are both standard input; name a file for one"
    ))
}

/// How messages call a path, where `-` is a stream.
fn place(path: &Path, stream: &str) -> String {
    named_file(Some(path)).map_or_else(|| stream.to_owned(), |path| path.display().to_string())
}

/// Whether two paths lead to one file that holds what is written to it, whether it is there yet or
/// not.
fn is_one_file(a: &Path, b: &Path) -> bool {
    let is_device = fs::metadata(a).is_ok_and(|found| !found.is_file() && !found.is_dir());
    !is_device && real(a) == real(b)
}

/// A path without links and detours, as far as it is there.
fn real(path: &Path) -> PathBuf {
    let beside = || {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = fs::canonicalize(folder.unwrap_or_else(|| Path::new("."))).ok()?;
        Some(folder.join(path.file_name()?))
    };
    let found = fs::canonicalize(path).ok().or_else(beside);
    found.unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn named(called: &str, path: impl Into<PathBuf>) -> Named {
        (called.to_owned(), path.into())
    }

    #[test]
    fn a_file_that_is_named_twice_is_refused_by_whatever_path() {
        let folder = ScratchFolder::made("twice");
        fs::write(folder.join("a.csv"), "t_s").unwrap();
        let [there, dotted] = ["a.csv", "./a.csv"].map(|name| folder.join(name));
        let (new, detour) = (
            folder.join("new"),
            folder.join("../").join(folder.file_name().unwrap()),
        );
        let said =
            |results: &[Named], sources: &[Named]| twice(results, sources).unwrap_or_default();
        let line = said(
            &[named("--out", &new), named("--wav", detour.join("new"))],
            &[],
        );
        assert!(line.starts_with("--out and --wav are both "), "{line}");
        let line = said(&[named("--out", dotted)], &[named("--path", &there)]);
        assert!(
            line.contains("would overwrite") && line.contains("--path"),
            "{line}"
        );
        assert_eq!(
            said(&[named("--out", &new)], &[named("--path", &there)]),
            ""
        );
        assert_eq!(
            said(&[named("--out", &*folder)], &[named("LOGS", &*folder)]),
            ""
        );
    }

    /// What is refused of a line, as the program parses it.
    fn refused(line: &str) -> Option<String> {
        let command = crate::command();
        let matches = command.clone().try_get_matches_from(line.split(' '));
        check(&command, &matches.unwrap())
            .err()
            .map(|error| error.to_string())
    }

    #[test]
    fn results_are_known_by_what_they_are_declared_as() {
        let folder = ScratchFolder::made("declared");
        for name in ["p.csv", "page.txt", "heights.csv"] {
            fs::write(folder.join(name), "").unwrap();
        }
        let at = folder.display();
        for (line, what) in [
            (
                "selvedge render a.toml --path AT/p.csv --band AT/p.csv,AT/h.csv",
                "--band would",
            ),
            (
                "selvedge render a.toml --path AT/p.csv --band AT/x,AT/x",
                "--band and --band are",
            ),
            (
                "selvedge figure a.toml --path AT/page.txt --out AT/page",
                "--out would overwrite",
            ),
            (
                "selvedge probe --surface AT/heights.csv --drop 1 --out AT/heights.csv",
                "which --surface reads",
            ),
            (
                "selvedge textile convert AT/p.csv --out AT/p.csv",
                "--out would overwrite",
            ),
        ] {
            let said = refused(&line.replace("AT", &at.to_string())).unwrap_or_default();
            assert!(said.contains(what), "{line}: {said}");
        }
        // The log of the stage is read, whatever it is called.
        let line = format!("selvedge stage export --out {at} --log {at}");
        assert_eq!(refused(&line), None);
    }

    #[test]
    fn a_stream_serves_one() {
        let said =
            |results: &[Named], sources: &[Named]| twice(results, sources).unwrap_or_default();
        let line = said(&[named("--out", "-"), named("--stats", "-")], &[]);
        assert_eq!(
            line,
            "--out and --stats are both standard output; name two files"
        );
        let line = said(&[], &[named("SCENE", "-"), named("--path", "-")]);
        assert_eq!(
            line,
            "SCENE and --path are both standard input; name a file for one"
        );
        assert_eq!(said(&[named("--out", "-")], &[named("--path", "-")]), "");
        if cfg!(unix) {
            let null = "/dev/null";
            assert_eq!(said(&[named("--out", null), named("--wav", null)], &[]), "");
        }
    }
}
