//! What is built for some systems only has its other half: a file that has an item for one system
//! has one for the others too.

use super::{Source, report, sources};

/// Items that need no other half: what uses them is for the same systems, in these files.
const ALONE: &[(&str, &str)] = &[
    (
        "src/device/emulator/mod.rs",
        "a pseudo-terminal: the command line says that there is none",
    ),
    ("src/device/lib.rs", "its export"),
    (
        "src/workbench/shell/mod.rs",
        "the thread that hears X11, whose other half is in native.rs",
    ),
];

/// What a line's `#[cfg(…)]` asks of the system, without what else it asks.
fn condition(line: &str) -> Option<&str> {
    let asked = line.trim().strip_prefix("#[cfg(")?.strip_suffix(")]")?;
    let is_of_system = ["unix", "windows", "target_os"]
        .iter()
        .any(|word| asked.contains(word));
    (is_of_system && !asked.contains("test")).then_some(asked)
}

/// Conditions of a file that hold on some systems and have no `not(…)` of theirs. What stands
/// within a function, or in a module of tests, is left out: its other half is to do nothing.
fn without_other_half(source: &Source) -> Vec<(usize, String)> {
    let product = source
        .text
        .split("#[cfg(test)]\nmod ")
        .next()
        .unwrap_or_default();
    let of_items = || {
        let lines = product
            .lines()
            .enumerate()
            .filter(|(_, line)| line.starts_with("#[cfg("));
        lines.filter_map(|(index, line)| Some((index + 1, condition(line)?)))
    };
    // "not(any(a, b, c))" is the other half of each of them, and of "any(a, b)".
    let negated: Vec<&str> = of_items()
        .filter_map(|(_, asked)| asked.strip_prefix("not("))
        .collect();
    let has_half = |asked: &str| {
        let any = asked
            .strip_prefix("any(")
            .and_then(|any| any.strip_suffix(')'));
        let holds = |not: &&str| match any {
            Some(any) => any.split(", ").all(|one| not.contains(one)),
            None => not.contains(asked),
        };
        negated.iter().any(holds)
    };
    of_items()
        .filter(|(_, asked)| !asked.starts_with("not(") && !has_half(asked))
        .map(|(number, asked)| (number, asked.to_owned()))
        .collect()
}

#[test]
fn what_is_for_some_systems_has_its_other_half() {
    let mut faults = Vec::new();
    let mut alone: Vec<&str> = Vec::new();
    for source in sources(&["src"]) {
        let is_test = source.path.contains("/tests/") || source.path.ends_with("tests.rs");
        let found = without_other_half(&source);
        if is_test || found.is_empty() {
            continue;
        }
        match ALONE.iter().find(|(path, _)| *path == source.path) {
            Some((path, _)) => alone.push(path),
            None => faults.extend(found.into_iter().map(|(number, asked)| {
                format!("{}:{number}: {asked} has no not({asked})", source.path)
            })),
        }
    }
    let is_idle = |(path, _): &&(&str, &str)| !alone.contains(path);
    let idle = ALONE.iter().filter(is_idle);
    faults.extend(idle.map(|(path, _)| format!("{path}: take it out of ALONE, it needs no place")));
    report("an item for some systems without its other half", &faults);
}

#[test]
fn a_missing_half_is_found_and_a_shared_one_counts_for_both() {
    let of = |text: &str| {
        let source = Source {
            path: String::new(),
            text: text.to_owned(),
        };
        without_other_half(&source).len()
    };
    assert_eq!(of("#[cfg(unix)]\nfn a() {}\n"), 1, "no half");
    assert_eq!(
        of("#[cfg(unix)]\nfn a() {}\n#[cfg(not(unix))]\nfn a() {}\n"),
        0,
        "both"
    );
    let three = "#[cfg(any(windows, target_os = \"macos\"))]\nmod a;\n\
                 #[cfg(target_os = \"linux\")]\nmod a;\n\
                 #[cfg(not(any(windows, target_os = \"linux\", target_os = \"macos\")))]\nmod a;\n";
    assert_eq!(of(three), 0, "one half for all");
    assert_eq!(
        of("#[cfg(all(test, unix))]\nmod tests {}\n"),
        0,
        "tests need none"
    );
    assert_eq!(
        of("fn a() {\n    #[cfg(unix)]\n    b();\n}\n"),
        0,
        "nor what is within"
    );
}
