//! Ways to spoil the files of a session: each is named, and what it spoils is not counted.

use std::fs;

use super::tests::{Folder, any_answer, circumstances};
use super::*;
use crate::StimulusHashes;
use crate::analysis::{Analysis, Options};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::Progress;
use selvedge_render::scene::PathRow;

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    textiles = [\"a\", \"b\", \"c\", \"d\"]\n[odd_one_out]\n[course]\npractice_trials = 1\n";

/// What is spoilt.
enum Spoil {
    /// The log's text.
    Log(fn(&str) -> String),
    /// The sidecar's text.
    Sidecar(fn(&str) -> String),
    /// Anything, by the log's path.
    Files(fn(&Path)),
}

/// The n-th line of a log, from 0, becomes another.
fn line(text: &str, n: usize, edit: impl FnOnce(&str) -> String) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[n] = edit(&lines[n]);
    lines.join("\n") + "\n"
}

/// A cell of a line becomes another.
fn cell(text: &str, n: usize, column: &str, edit: impl FnOnce(&str) -> String) -> String {
    let at = text
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == column)
        .unwrap();
    line(text, n, |row| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        cells[at] = edit(&cells[at]);
        cells.join(",")
    })
}

fn other(cell: &str) -> String {
    match cell {
        "1" => "2".to_owned(),
        _ => "1".to_owned(),
    }
}

fn without(text: &str, n: usize) -> String {
    let mut kept: Vec<&str> = text.lines().collect();
    kept.remove(n);
    kept.join("\n") + "\n"
}

fn swapped(text: &str, a: usize, b: usize) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(a, b);
    lines.join("\n") + "\n"
}

fn doubled(text: &str, n: usize) -> String {
    line(text, n, |row| format!("{row}\n{row}"))
}

fn paths(log: &Path) -> std::path::PathBuf {
    let stem = log.file_stem().unwrap().to_string_lossy();
    log.with_file_name(format!("{stem}-paths"))
}

const WAYS: &[(&str, Spoil)] = &[
    (
        "no sidecar",
        Spoil::Files(|log| fs::remove_file(log.with_extension("json")).unwrap()),
    ),
    (
        "half a sidecar",
        Spoil::Sidecar(|text| text[..text.len() / 2].to_owned()),
    ),
    ("an empty sidecar", Spoil::Sidecar(|_| String::new())),
    (
        "a sidecar of something else",
        Spoil::Sidecar(|_| "[1, 2]".to_owned()),
    ),
    (
        "another subject",
        Spoil::Sidecar(|text| text.replace("\"subject\": \"p01\"", "\"subject\": \"p09\"")),
    ),
    (
        "another number",
        Spoil::Sidecar(|text| text.replace("\"nth_subject\": 0", "\"nth_subject\": 5")),
    ),
    (
        "another session",
        Spoil::Sidecar(|text| text.replace("\"session\": 1", "\"session\": 2")),
    ),
    (
        "another title",
        Spoil::Sidecar(|text| text.replace("\"title\": \"\"", "\"title\": \"x\"")),
    ),
    (
        "another design",
        Spoil::Sidecar(|text| text.replace("seed = 3", "seed = 4")),
    ),
    (
        "another hash of the design",
        Spoil::Sidecar(|text| text.replace("\"design_sha256\": \"", "\"design_sha256\": \"0")),
    ),
    (
        "another schedule",
        Spoil::Sidecar(|text| text.replacen("position_odd=1", "position_odd=2", 1)),
    ),
    (
        "a shorter schedule",
        Spoil::Sidecar(|text| {
            text.replacen("\"practice=1", "\"", 1)
                .replacen("block=1", "block=2", 1)
        }),
    ),
    (
        "another generator",
        Spoil::Sidecar(|text| text.replace("PCG", "LCG")),
    ),
    (
        "an older version",
        Spoil::Sidecar(|text| text.replace("\"schema_version\": 2", "\"schema_version\": 1")),
    ),
    (
        "a later version",
        Spoil::Sidecar(|text| text.replace("\"schema_version\": 2", "\"schema_version\": 3")),
    ),
    ("no first row", Spoil::Log(|text| without(text, 1))),
    ("no first trial", Spoil::Log(|text| without(text, 2))),
    (
        "no trial in the middle",
        Spoil::Log(|text| without(text, 4)),
    ),
    (
        "no last trial",
        Spoil::Log(|text| without(text, text.lines().count() - 2)),
    ),
    ("two rows swapped", Spoil::Log(|text| swapped(text, 3, 4))),
    ("a row twice", Spoil::Log(|text| doubled(text, 4))),
    (
        "the closing twice",
        Spoil::Log(|text| doubled(text, text.lines().count() - 1)),
    ),
    (
        "a trial behind the closing",
        Spoil::Log(|text| format!("{text}{}\n", text.lines().nth(4).unwrap())),
    ),
    (
        "another answer",
        Spoil::Log(|text| cell(text, 4, "response", other)),
    ),
    (
        "another verdict",
        Spoil::Log(|text| cell(text, 4, "correct", other)),
    ),
    (
        "another position of the odd one",
        Spoil::Log(|text| cell(text, 4, "position_odd", other)),
    ),
    (
        "another grade",
        Spoil::Log(|text| {
            cell(text, 4, "grade", |grade| {
                if grade == "easy" { "hard" } else { "easy" }.to_owned()
            })
        }),
    ),
    (
        "another item",
        Spoil::Log(|text| {
            cell(text, 4, "item1", |id| {
                if id == "a" { "b" } else { "a" }.to_owned()
            })
        }),
    ),
    (
        "an item that is none",
        Spoil::Log(|text| cell(text, 4, "item1", |_| "z".to_owned())),
    ),
    (
        "another subject in a row",
        Spoil::Log(|text| cell(text, 4, "subject", |_| "p02".to_owned())),
    ),
    (
        "another study in a row",
        Spoil::Log(|text| cell(text, 4, "study", |_| "wool".to_owned())),
    ),
    (
        "another session in a row",
        Spoil::Log(|text| cell(text, 4, "session", |_| "7".to_owned())),
    ),
    (
        "another trial",
        Spoil::Log(|text| cell(text, 4, "trial", |_| "9".to_owned())),
    ),
    (
        "another attempt",
        Spoil::Log(|text| cell(text, 4, "attempt", |_| "2".to_owned())),
    ),
    (
        "practice that was none",
        Spoil::Log(|text| cell(text, 4, "practice", other)),
    ),
    (
        "a time to answer",
        Spoil::Log(|text| cell(text, 4, "rt_ms", |_| "1".to_owned())),
    ),
    (
        "a moment",
        Spoil::Log(|text| cell(text, 4, "t_response_ns", |_| "1".to_owned())),
    ),
    (
        "another seed",
        Spoil::Log(|text| cell(text, 4, "seed", |_| "4".to_owned())),
    ),
    (
        "another device",
        Spoil::Log(|text| cell(text, 4, "device", |_| "array".to_owned())),
    ),
    (
        "a note",
        Spoil::Log(|text| cell(text, 4, "note", |_| "better".to_owned())),
    ),
    (
        "given up that was not",
        Spoil::Log(|text| cell(text, 4, "aborted", other)),
    ),
    (
        "void that is valid",
        Spoil::Log(|text| cell(text, 4, "valid", other)),
    ),
    (
        "a reason to void",
        Spoil::Log(|text| cell(text, 4, "void", |_| "late".to_owned())),
    ),
    (
        "another proof",
        Spoil::Log(|text| cell(text, 4, "proof", |_| "array".to_owned())),
    ),
    (
        "another hash of a row",
        Spoil::Log(|text| {
            cell(text, 4, "before_sha256", |hash| {
                hash.replace(|c: char| c.is_ascii_digit(), "f")
            })
        }),
    ),
    (
        "another count",
        Spoil::Log(|text| cell(text, text.lines().count() - 1, "rows", |_| "5".to_owned())),
    ),
    (
        "another kind of row",
        Spoil::Log(|text| cell(text, 4, "kind", |_| "remark".to_owned())),
    ),
    (
        "a column by another name",
        Spoil::Log(|text| line(text, 0, |header| header.replace("grade", "ease"))),
    ),
    (
        "line ends of another system",
        Spoil::Log(|text| text.replace('\n', "\r\n")),
    ),
    ("an empty log", Spoil::Log(|_| String::new())),
    (
        "no path",
        Spoil::Files(|log| fs::remove_file(paths(log).join("trial-003.csv")).unwrap()),
    ),
    (
        "another path",
        Spoil::Files(|log| {
            fs::copy(
                paths(log).join("trial-002.csv"),
                paths(log).join("trial-003.csv"),
            )
            .unwrap();
        }),
    ),
    (
        "an edited path",
        Spoil::Files(|log| {
            let file = paths(log).join("trial-003.csv");
            let text = fs::read_to_string(&file).unwrap();
            fs::write(file, text.replace('5', "6")).unwrap();
        }),
    ),
];

/// Three sessions with a path to every trial.
fn held(folder: &Folder) -> Vec<std::path::PathBuf> {
    let design = Design::from_toml(CLOTH, Path::new("cloth.toml")).unwrap();
    let session = |nth: usize| {
        let subject = Subject {
            pseudonym: format!("p{:02}", nth + 1),
            nth,
            session: 1,
        };
        let mut session = Session::create(&folder.0, design.clone(), subject, "none").unwrap();
        let mut random = Random::new(nth as u64);
        let mut n: u32 = 0;
        while let Step::Trial(trial) = session.step().clone() {
            let answer = any_answer(session.design(), &trial.task, &mut random);
            n += 1;
            let row = |t_s: f64| PathRow {
                t_s,
                position: selvedge_foundation::geometry::Point::new(f64::from(n) * t_s, 5.0),
                ..PathRow::default()
            };
            let path = ExplorationPath::new(vec![row(0.0), row(0.5)]).unwrap();
            let about = Circumstances {
                path: Some(&path),
                note: "",
                apparatus: Apparatus::default(),
                ..circumstances(u64::from(n))
            };
            session.answer(&answer, &about).unwrap();
        }
        session.log().to_owned()
    };
    (0..3).map(session).collect()
}

#[test]
fn every_way_to_spoil_a_session_is_named_and_left_out() {
    assert!(WAYS.len() >= 40, "{}", WAYS.len());
    let few = Options {
        n_maps: 0,
        n_random_data: 0,
        n_permutations: 99,
        n_resamples: 100,
        ..Options::default()
    };
    for (name, spoil) in WAYS {
        let folder = Folder::new("spoilt");
        let logs = held(&folder);
        let whole = Progress::unheard(|progress| Verified::of_folder(&folder.0, progress)).unwrap();
        assert_eq!(
            (whole.breaks, whole.n_broken, whole.n_open),
            (Vec::new(), 0, 0)
        );
        let edit = |file: &Path, edit: &fn(&str) -> String| {
            let text = fs::read_to_string(file).unwrap();
            let spoilt = edit(&text);
            assert_ne!(text, spoilt, "{name}: nothing is spoilt");
            fs::write(file, spoilt).unwrap();
        };
        match spoil {
            Spoil::Log(how) => edit(&logs[0], how),
            Spoil::Sidecar(how) => edit(&logs[0].with_extension("json"), how),
            Spoil::Files(how) => how(&logs[0]),
        }
        let found = Progress::unheard(|progress| Verified::of_folder(&folder.0, progress)).unwrap();
        assert_eq!(
            (found.n_logs, found.n_broken),
            (3, 1),
            "{name}: {:?}",
            found.breaks
        );
        assert!(found.breaks.iter().all(|one| one.log == logs[0]), "{name}");
        let analysis =
            Progress::unheard(|progress| Analysis::of_folder(&folder.0, &few, progress)).unwrap();
        let page = analysis.page();
        let counted = page.lines().filter(|line| line.starts_with("| p01 | 1 |"));
        let is_counted = counted.clone().any(|line| line.contains("complete"));
        let is_left_out = page.contains("not as it was written") || page.contains("left out of");
        assert!(is_left_out, "{name}: {page}");
        assert!(
            !is_counted || page.contains("not as it was written"),
            "{name}: {page}"
        );
    }
}

#[test]
fn a_session_with_other_textiles_than_those_at_hand_is_named_wherever_sessions_are_read() {
    let folder = Folder::new("textiles");
    let design = Design::shipped("odd-one-out").unwrap();
    let library = design.open_library(Path::new(""), None).unwrap();
    let hashes =
        Progress::unheard(|progress| StimulusHashes::of_library(&design, &library, progress));
    let held_with = |nth: usize, library: String| {
        let subject = Subject {
            pseudonym: format!("p{nth:02}"),
            nth,
            session: 1,
        };
        let origin = Origin::from("none").with("library", library);
        Session::create(&folder.0, design.clone(), subject, origin).unwrap();
    };
    held_with(1, hashes.unwrap().all());
    held_with(2, "0".repeat(64));
    let (found, _) =
        Progress::unheard(|progress| crate::analysis::sessions(&folder.0, progress)).unwrap();
    assert_eq!(found[0].breaks, []);
    let [one] = &found[1].breaks[..] else {
        panic!("{:?}", found[1].breaks);
    };
    assert!(one.what.contains("textiles are not those"), "{one}");
}
