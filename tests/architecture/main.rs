//! The rules of the house that a compiler does not check: which file a third-party crate lives in,
//! how a source file opens and how long it may grow, and that no files use each other in a circle.
//!
//! Reads sources as text and links nothing of the program. Which crate may use which the compiler
//! keeps by the manifests; here it is kept that the manifests stay as designed.
#![expect(clippy::expect_used, reason = "a test that fails says so by panicking")]

mod modules;
mod platforms;
mod shape;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use modules::{ModulePath, Modules, circles};

/// The crates, low to high, each with the crates of this house that it may use.
const CRATES: &[(&str, &[&str])] = &[
    ("foundation", &[]),
    ("chart", &["foundation"]),
    ("statistics", &["foundation"]),
    ("textile", &["foundation", "chart"]),
    ("friction", &["foundation"]),
    ("render", &["foundation", "textile"]),
    ("drape", &["foundation", "textile", "render"]),
    ("device", &["foundation"]),
    ("engine", &["foundation", "textile", "render", "device"]),
    (
        "experiment",
        &[
            "foundation",
            "chart",
            "statistics",
            "textile",
            "render",
            "engine",
        ],
    ),
    (
        "studies",
        &[
            "foundation",
            "chart",
            "statistics",
            "textile",
            "friction",
            "render",
            "drape",
            "device",
            "engine",
            "experiment",
        ],
    ),
    (
        "workbench",
        &[
            "foundation",
            "chart",
            "statistics",
            "textile",
            "friction",
            "render",
            "drape",
            "device",
            "engine",
            "experiment",
            "studies",
        ],
    ),
    (
        "cli",
        &[
            "foundation",
            "chart",
            "statistics",
            "textile",
            "friction",
            "render",
            "drape",
            "device",
            "engine",
            "experiment",
            "studies",
            "workbench",
        ],
    ),
];

/// Files of one crate that use each other in a circle: no circle is larger than this.
const LARGEST_CIRCLE: usize = 3;

/// Items (types, functions, constants) that crates show to others, all together.
const MAX_VISIBLE_ITEMS: usize = 900;

/// Where each third-party crate lives: a crate of this house, a folder or one file; some have two.
const HOMES: &[(&str, &str)] = &[
    ("burn", "src/friction/network/"),
    ("clap", "src/cli/"),
    ("clap", "src/workbench/"),
    ("clap_complete", "src/cli/manual.rs"),
    ("clap_mangen", "src/cli/manual.rs"),
    ("cpal", "src/engine/audio/device.rs"),
    ("cpal", "src/engine/sound/system.rs"),
    ("crc32fast", "src/device/"),
    ("csv", "src/foundation/files/"),
    ("directories", "src/workbench/bench/settings/"),
    ("egui_plot", "src/workbench/kit/plot/"),
    ("egui_tiles", "src/workbench/"),
    ("eframe", "src/workbench/"),
    ("egui", "src/workbench/"),
    ("epaint_default_fonts", "src/chart/pixels.rs"),
    ("flate2", "src/foundation/files/"),
    ("image", "src/foundation/files/"),
    ("md5", "src/foundation/files/hash.rs"),
    ("png", "src/foundation/files/"),
    ("pulseaudio", "src/engine/sound/"),
    ("quick_xml", "src/foundation/files/xml.rs"),
    ("rand", "src/foundation/numerics/random.rs"),
    ("rand_distr", "src/foundation/numerics/random.rs"),
    ("rand_pcg", "src/foundation/numerics/random.rs"),
    ("rustfft", "src/foundation/numerics/fft.rs"),
    ("resvg", "src/chart/pixels.rs"),
    ("input_linux", "src/engine/input/evdev/"),
    ("rustix", "src/engine/input/evdev/"),
    ("rustix", "src/engine/sound/aplay.rs"),
    ("rustix", "src/foundation/files/place.rs"),
    ("rustix", "src/foundation/progress.rs"),
    ("rfd", "src/workbench/shell/dialogs.rs"),
    ("serde_json", "src/foundation/files/"),
    ("serialport", "src/device/"),
    ("sha2", "src/foundation/files/"),
    ("signal_hook", "src/foundation/signals.rs"),
    ("libm", "src/statistics/distribution.rs"),
    ("statrs", "src/statistics/"),
    ("tiff", "src/foundation/files/"),
    ("toml", "src/foundation/files/"),
    ("toml_edit", "src/foundation/files/edited_keys.rs"),
    ("winit", "src/workbench/"),
    ("x11rb", "src/workbench/"),
    ("zip", "src/foundation/files/archive.rs"),
    ("tempfile", "src/studies/"),
];

/// Crates that are vocabulary and may appear anywhere.
const VOCABULARY: &[&str] = &["nalgebra", "rtrb", "serde", "thiserror", "triple_buffer"];

/// Crates that only tests use.
const FOR_TESTS: &[&str] = &[
    "assert_no_alloc",
    "cobs",
    "crc",
    "egui_kittest",
    "hound",
    "proptest",
];

/// Names that say nothing about what lives there.
const EMPTY_NAMES: &[&str] = &["utils", "util", "helpers", "common", "misc", "types"];

const MAX_LINES: usize = 500;
const MAX_LINES_WITHOUT_TESTS: usize = 400;

struct Source {
    path: String,
    text: String,
}

impl Source {
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
            is_listed = line == "[workspace.dependencies]";
        } else if let (true, Some((name, _))) = (is_listed, line.split_once(" = ")) {
            let name = name.replace('-', "_");
            let is_elsewhere = name.starts_with("selvedge_") || FOR_TESTS.contains(&name.as_str());
            if is_elsewhere {
                continue;
            }
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
        let is_test = source.path.starts_with("tests/")
            || source.path.contains("/tests/")
            || source.path.ends_with("tests.rs");
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

/// The folder of a crate.
fn folder_of(name: &str) -> PathBuf {
    root().join("src").join(name)
}

#[test]
fn crates_use_only_what_the_design_lets_them() {
    let mut faults = Vec::new();
    for (name, allowed) in CRATES {
        let path = folder_of(name).join("Cargo.toml");
        let manifest = fs::read_to_string(path).expect("every crate has a manifest");
        let product = manifest.split("[dev-dependencies]").next();
        for line in product.unwrap_or_default().lines() {
            let used = line
                .strip_prefix("selvedge-")
                .and_then(|l| l.split_once('.'));
            if let Some((used, _)) = used.filter(|(used, _)| !allowed.contains(used)) {
                faults.push(format!("src/{name}/Cargo.toml: {name} uses {used}"));
            }
        }
    }
    report("a crate that uses another beside or above it", &faults);
}

#[test]
fn every_folder_of_the_sources_is_a_crate_that_lists_its_invariants() {
    let entries = fs::read_dir(root().join("src")).expect("the sources are there");
    let folders = entries.flatten().filter(|entry| entry.path().is_dir());
    for folder in folders {
        let name = folder.file_name().to_string_lossy().into_owned();
        let is_known = CRATES.iter().any(|(known, _)| *known == name);
        assert!(
            is_known,
            "src/{name} is no crate of the design: add it to CRATES"
        );
        let text = fs::read_to_string(folder.path().join("lib.rs")).unwrap_or_default();
        assert!(
            text.contains("//! # Invariants"),
            "src/{name}/lib.rs does not say what the crate leaves out"
        );
    }
}

/// What one file of a circle uses of the others: the edges of which one has to be cut.
fn edges(
    modules: &Modules,
    uses: &modules::Uses,
    circle: &BTreeSet<ModulePath>,
    name: &str,
) -> Vec<String> {
    let place = |path: &ModulePath| {
        let file = modules.file(path);
        let within = file.strip_prefix(folder_of(name));
        within.unwrap_or(file).display().to_string()
    };
    let mut lines = Vec::new();
    for from in circle {
        for (to, by) in &uses[from] {
            if circle.contains(to) {
                lines.push(format!("  {} uses {} ({by})", place(from), place(to)));
            }
        }
    }
    lines
}

#[test]
fn no_circle_of_files_is_larger_than_it_may_be() {
    let mut faults = Vec::new();
    for (name, _) in CRATES {
        let modules = Modules::of_crate(&folder_of(name));
        let uses = modules.uses();
        let found = circles(&uses);
        let largest = found.iter().max_by_key(|circle| circle.len());
        let n_files = largest.map_or(1, BTreeSet::len);
        if n_files > LARGEST_CIRCLE {
            faults.push(format!(
                "src/{name}: {n_files} files in a circle, {LARGEST_CIRCLE} may be; cut one of"
            ));
            faults.extend(
                largest
                    .iter()
                    .flat_map(|circle| edges(&modules, &uses, circle, name)),
            );
        }
    }
    report("files that use each other in a circle", &faults);
}

/// Types, functions and constants at the left margin of product code that other crates may name.
fn visible_items(source: &Source) -> usize {
    let kinds = ["fn", "struct", "enum", "trait", "const", "type", "static"];
    let is_item = |line: &&str| {
        let rest = line
            .strip_prefix("pub ")
            .and_then(|rest| rest.split(' ').next());
        rest.is_some_and(|kind| kinds.contains(&kind))
    };
    source.text.lines().filter(is_item).count()
}

#[test]
fn crates_show_few_items_to_each_other() {
    let all = sources(&["src"]);
    let mut lines = Vec::new();
    let mut n_all = 0;
    for (name, _) in CRATES {
        let folder = format!("src/{name}/");
        let own = all.iter().filter(|source| source.path.starts_with(&folder));
        let n_items: usize = own.map(visible_items).sum();
        lines.push(format!("  {name}: {n_items}"));
        n_all += n_items;
    }
    assert!(
        n_all <= MAX_VISIBLE_ITEMS,
        "{n_all} items are visible outside their crate, {MAX_VISIBLE_ITEMS} may be:\n{}",
        lines.join("\n")
    );
}

#[test]
fn a_circle_is_found_and_a_facade_is_none() {
    let scratch = std::env::temp_dir().join(format!("selvedge-circles-{}", std::process::id()));
    fs::create_dir_all(&scratch).expect("a folder can be made");
    let write = |name: &str, text: &str| {
        fs::write(scratch.join(name), text).expect("a file can be written");
    };
    write(
        "lib.rs",
        "mod a;\nmod b;\nmod c;\npub use a::A;\npub use b::B;\n",
    );
    write("a.rs", "use crate::B;\npub struct A(B);\n");
    write(
        "b.rs",
        "use crate::c::{self, C};\npub struct B(C);\n// use super::A;\n",
    );
    write(
        "c.rs",
        "pub struct C;\n#[cfg(test)]\nmod tests {\n    use crate::A;\n}\n",
    );
    let before = circles(&Modules::of_crate(&scratch).uses());
    write("c.rs", "pub struct C(Option<Box<super::A>>);\n");
    let after = circles(&Modules::of_crate(&scratch).uses());
    fs::remove_dir_all(&scratch).expect("it was just made");
    assert_eq!(
        before,
        Vec::new(),
        "re-exports, comments and tests are no uses"
    );
    let names = |circle: &BTreeSet<ModulePath>| circle.iter().map(|p| p.join("::")).collect();
    let found: Vec<Vec<String>> = after.iter().map(names).collect();
    assert_eq!(
        found,
        [["a", "b", "c"].map(str::to_owned)],
        "by way of the root"
    );
}
