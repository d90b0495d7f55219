//! The rules of the house that a compiler does not check: which floor may use which, which file a
//! third-party crate lives in, and how a source file opens and how long it may grow.
//!
//! Reads sources as text and uses nothing of the library.
#![expect(
    clippy::panic,
    clippy::expect_used,
    reason = "a test that fails says so by panicking"
)]

use std::fs;
use std::path::{Path, PathBuf};

/// The floors of `src/`, lowest first. A module uses floors below its own: none above, none beside.
const FLOORS: &[&[&str]] = &[
    &["geometry", "quantity", "progress"],
    &["numerics", "figure", "files"],
    &["statistics"],
    &["surface"],
    &["tactile"],
    &["textile"],
    &["friction"],
    &["scene"],
    &["render"],
    &["bridge"],
    &["engine"],
    &["experiment"],
    &["report"],
    &["app"],
    &["cli"],
];

/// Pairs that the floors would allow and the design does not: the bridge knows nothing of cloth.
const FORBIDDEN_EDGES: &[(&str, &str)] = &[
    ("bridge", "textile"),
    ("bridge", "scene"),
    ("bridge", "render"),
    ("engine", "friction"),
];

/// Where each third-party crate lives: a floor, or one file; some have two homes.
const HOMES: &[(&str, &str)] = &[
    ("clap", "src/cli/"),
    ("cpal", "src/engine/audio/device.rs"),
    ("crc32fast", "src/bridge/"),
    ("csv", "src/files/"),
    ("directories", "src/app/settings/"),
    ("egui_tiles", "src/app/"),
    ("eframe", "src/app/"),
    ("egui", "src/app/"),
    ("epaint_default_fonts", "src/figure/pixels.rs"),
    ("flate2", "src/files/"),
    ("image", "src/files/"),
    ("md5", "src/files/hash.rs"),
    ("png", "src/files/"),
    ("quick_xml", "src/files/xml.rs"),
    ("rand", "src/numerics/random.rs"),
    ("rand_distr", "src/numerics/random.rs"),
    ("rand_pcg", "src/numerics/random.rs"),
    ("realfft", "src/numerics/fft.rs"),
    ("resvg", "src/figure/pixels.rs"),
    ("input_linux", "src/engine/input/evdev/"),
    ("rustix", "src/engine/input/evdev/"),
    ("rustix", "src/progress/"),
    ("rfd", "src/app/dialogs.rs"),
    ("serde_json", "src/files/"),
    ("serialport", "src/bridge/"),
    ("sha2", "src/files/"),
    ("signal_hook", "src/cli/"),
    ("statrs", "src/statistics/"),
    ("tiff", "src/files/"),
    ("toml", "src/files/"),
    ("winit", "src/app/"),
    ("x11rb", "src/app/"),
    ("zip", "src/files/archive.rs"),
];

/// Crates that are vocabulary and may appear anywhere.
const VOCABULARY: &[&str] = &["nalgebra", "rtrb", "serde", "thiserror", "triple_buffer"];

/// Names that say nothing about what lives there.
const EMPTY_NAMES: &[&str] = &["utils", "util", "helpers", "common", "misc", "types"];

const MAX_LINES: usize = 500;
const MAX_LINES_WITHOUT_TESTS: usize = 400;

struct Source {
    path: String,
    text: String,
}

impl Source {
    /// The floor it stands on; `None` for `lib.rs` and `main.rs`.
    fn floor(&self) -> Option<&str> {
        let within = self.path.strip_prefix("src/")?;
        within.split_once('/').map(|(floor, _)| floor)
    }

    /// Lines of code with their numbers from 1; comments are left out.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let is_code = |(_, line): &(usize, &str)| !line.trim_start().starts_with("//");
        self.text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line))
            .filter(is_code)
    }
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn collect(folder: &Path, sources: &mut Vec<Source>) {
    let entries = fs::read_dir(folder).expect("the source folder can be read");
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let relative = path.strip_prefix(root()).expect("it lies in the package");
            let text = fs::read_to_string(&path).expect("sources are text");
            sources.push(Source {
                path: relative.display().to_string(),
                text,
            });
        }
    }
}

fn sources(folders: &[&str]) -> Vec<Source> {
    let mut sources = Vec::new();
    for folder in folders {
        collect(&root().join(folder), &mut sources);
    }
    assert!(!sources.is_empty(), "no sources below {folders:?}");
    sources
}

fn report(what: &str, faults: &[String]) {
    assert!(faults.is_empty(), "{what}:\n{}", faults.join("\n"));
}

fn height_of(floor: &str) -> usize {
    let found = FLOORS.iter().position(|names| names.contains(&floor));
    found.unwrap_or_else(|| panic!("src/{floor} is on no floor: add it to FLOORS"))
}

/// The names that follow `crate::` in a line, braces included: `crate::{files, surface::X}`.
fn crate_paths(line: &str) -> Vec<String> {
    let mut names = Vec::new();
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    for (index, _) in line.match_indices("crate::") {
        let before = line[..index].chars().next_back();
        if before.is_some_and(|c| is_name(c) || c == '$') {
            continue;
        }
        let rest = &line[index + "crate::".len()..];
        let inside = rest.strip_prefix('{');
        let parts: Vec<&str> = inside.map_or_else(|| vec![rest], |list| list.split(',').collect());
        for part in parts {
            let name: String = part.trim().chars().take_while(|&c| is_name(c)).collect();
            names.push(name);
        }
    }
    names
}

#[test]
fn floors_use_only_floors_below_them() {
    let mut faults = Vec::new();
    for source in sources(&["src"]) {
        let Some(floor) = source.floor() else {
            continue;
        };
        for (number, line) in source.code() {
            for used in crate_paths(line) {
                let is_floor = FLOORS.iter().any(|names| names.contains(&used.as_str()));
                if !is_floor || used == floor {
                    continue;
                }
                let is_above = height_of(&used) >= height_of(floor);
                if is_above || FORBIDDEN_EDGES.contains(&(floor, used.as_str())) {
                    faults.push(format!("{}:{number}: {floor} uses {used}", source.path));
                }
            }
        }
    }
    report("a floor uses one that is not below it", &faults);
}

#[test]
fn every_folder_of_the_sources_is_a_floor() {
    for source in sources(&["src"]) {
        if let Some(floor) = source.floor() {
            height_of(floor);
        }
    }
}

#[test]
fn every_third_party_crate_stays_at_home() {
    let mut faults = Vec::new();
    for source in sources(&["src"]) {
        for (number, line) in source.code() {
            for (name, home) in HOMES {
                let path = format!("{name}::");
                let is_used = line.match_indices(&path).any(|(index, _)| {
                    let before = line[..index].chars().next_back();
                    // `crate::app::…::image::` and `self.image` are ours.
                    !before.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_' || c == ':')
                });
                let is_home =
                    |(known, home): &&(&str, &str)| known == name && source.path.starts_with(home);
                if is_used && !HOMES.iter().any(|entry| is_home(&entry)) {
                    faults.push(format!("{}:{number}: {name} lives in {home}", source.path));
                }
            }
        }
    }
    report("a crate is used away from its home", &faults);
}

#[test]
fn every_dependency_has_a_home() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("Cargo.toml is there");
    let mut faults = Vec::new();
    let mut is_listed = false;
    for (index, line) in manifest.lines().enumerate() {
        if line.starts_with('[') {
            is_listed = line == "[dependencies]" || line.ends_with(".dependencies]");
        } else if let (true, Some((name, _))) = (is_listed, line.split_once(" = ")) {
            let name = name.replace('-', "_");
            let is_homed = HOMES.iter().any(|(known, _)| *known == name);
            if !is_homed && !VOCABULARY.contains(&name.as_str()) {
                faults.push(format!("Cargo.toml:{}: {name} has no home", index + 1));
            }
        }
    }
    report("a dependency without a home", &faults);
}

#[test]
fn every_file_says_what_it_is_and_stays_short() {
    let mut faults = Vec::new();
    for source in sources(&["src", "tests"]) {
        if !source.text.starts_with("//! ") {
            faults.push(format!("{}:1: does not open with //!", source.path));
        }
        let n_lines = source.text.lines().count();
        let without_tests = source
            .text
            .split("#[cfg(test)]\nmod ")
            .next()
            .unwrap_or_default();
        let n_without = without_tests.lines().count();
        let is_test = source.path.starts_with("tests/") || source.path.ends_with("tests.rs");
        if n_lines > MAX_LINES || (!is_test && n_without > MAX_LINES_WITHOUT_TESTS) {
            faults.push(format!(
                "{}: {n_lines} lines, {n_without} without tests",
                source.path
            ));
        }
        for (number, line) in source.text.lines().enumerate() {
            if line.chars().count() > 100 {
                faults.push(format!("{}:{}: over 100 columns", source.path, number + 1));
            }
        }
    }
    report(
        "a file that does not say what it is, or is too long",
        &faults,
    );
}

#[test]
fn every_floor_lists_its_invariants() {
    let is_floor = |source: &&Source| {
        source.path.ends_with("/mod.rs") && source.path.matches('/').count() == 2
    };
    let faults: Vec<String> = sources(&["src"])
        .iter()
        .filter(is_floor)
        .filter(|source| !source.text.contains("//! # Invariants"))
        .map(|source| format!("{}: no list of invariants", source.path))
        .collect();
    report("a floor that does not say what it leaves out", &faults);
}

#[test]
fn modules_have_names_that_say_something() {
    let faults: Vec<String> = sources(&["src", "tests"])
        .into_iter()
        .filter(|source| {
            let mut names = source
                .path
                .split('/')
                .map(|name| name.trim_end_matches(".rs"));
            names.any(|name| EMPTY_NAMES.contains(&name))
        })
        .map(|source| source.path)
        .collect();
    report("a module whose name says nothing", &faults);
}
