//! Completing a path as it is typed: what every file that fits begins with.
//!
//! The folder is listed on a thread of its own, when it is asked for: it may lie on the other side
//! of a network.

use std::fs;
use std::path::{MAIN_SEPARATOR, Path};

use crate::bench::background::{Executor, Task};

/// Most entries of a folder that are looked at.
const MAX_ENTRIES: usize = 10_000;

/// Begins to complete `typed` to a folder or a file with this ending. It gives what was typed and
/// the path then: longer, or the same.
pub(crate) fn complete(
    typed: &str,
    ending: &'static str,
    executor: &Executor,
) -> Task<[String; 2]> {
    let typed = typed.to_owned();
    executor.start("selvedge-complete", move |_| {
        let names = names_in(Path::new(split(&typed).0), ending);
        let path = completed(&typed, &names).unwrap_or_else(|| typed.clone());
        Ok([typed, path])
    })
}

/// The folder of a path, with its separator, and what was typed of the name.
fn split(typed: &str) -> (&str, &str) {
    let end = typed.rfind(std::path::is_separator).map_or(0, |at| at + 1);
    typed.split_at(end)
}

/// Names in a folder: folders, with a separator behind, and files with this ending.
fn names_in(folder: &Path, ending: &str) -> Vec<String> {
    let here = folder.as_os_str().is_empty();
    let Ok(entries) = fs::read_dir(if here { Path::new(".") } else { folder }) else {
        return Vec::new();
    };
    let name = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().ok()?;
        if entry.path().is_dir() {
            return Some(format!("{name}{MAIN_SEPARATOR}"));
        }
        name.ends_with(ending).then_some(name)
    };
    let entries = entries.take(MAX_ENTRIES).flatten();
    entries.filter_map(name).collect()
}

/// `typed` with as much more as all of `names` that fit have in common; `None` when that is
/// nothing. Hidden names fit only when their dot was typed.
fn completed(typed: &str, names: &[String]) -> Option<String> {
    let (folder, begun) = split(typed);
    let is_hidden = |name: &&String| name.starts_with('.') && begun.is_empty();
    let fits = |name: &&String| name.starts_with(begun) && !is_hidden(name);
    let mut fitting = names.iter().filter(fits);
    let mut common = fitting.next()?.as_str();
    for name in fitting {
        let n_same = common
            .char_indices()
            .zip(name.chars())
            .find(|((_, a), b)| a != b)
            .map_or_else(|| common.len().min(name.len()), |((at, _), _)| at);
        common = &common[..n_same];
    }
    (common.len() > begun.len()).then(|| format!("{folder}{common}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn complete(typed: &str, names: &[&str]) -> Option<String> {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        completed(typed, &names)
    }

    #[test]
    fn a_path_grows_to_what_all_that_fit_have_in_common() {
        let names = [
            "silk.toml",
            "silk two.toml",
            "wool.toml",
            "süd/",
            "südwind/",
        ];
        let grown = |typed| complete(typed, &names);
        assert_eq!(grown("/a/si").as_deref(), Some("/a/silk"));
        assert_eq!(grown("/a/w").as_deref(), Some("/a/wool.toml"));
        assert_eq!(grown("sü").as_deref(), Some("süd"));
        assert_eq!(grown("/a/silk"), None, "they part here");
        assert_eq!(grown("/a/jute"), None, "nothing fits");
        assert_eq!(grown("/a/"), None, "they have nothing in common");
        assert_eq!(complete("", &[]), None);
    }

    #[test]
    fn a_name_that_others_begin_with_is_where_it_stops() {
        assert_eq!(complete("a", &["ab", "abc"]).as_deref(), Some("ab"));
        assert_eq!(complete("a", &["abc", "ab"]).as_deref(), Some("ab"));
    }

    #[test]
    fn hidden_names_wait_for_their_dot() {
        let names = [".git/", "silk.toml"];
        assert_eq!(complete("/a/", &names).as_deref(), Some("/a/silk.toml"));
        assert_eq!(complete("/a/.", &names).as_deref(), Some("/a/.git/"));
    }

    #[test]
    fn a_folder_lists_folders_and_files_with_the_ending() {
        let root = ScratchFolder::new("complete");
        fs::create_dir_all(root.join("inner")).unwrap();
        fs::write(root.join("a.toml"), "").unwrap();
        fs::write(root.join("b.csv"), "").unwrap();
        let mut names = names_in(&root, ".toml");
        names.sort();
        assert_eq!(names, ["a.toml", &format!("inner{MAIN_SEPARATOR}")]);
        assert!(names_in(&root.join("none"), ".toml").is_empty());
    }
}
