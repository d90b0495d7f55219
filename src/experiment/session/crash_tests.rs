//! What interrupts a session costs at most the trial that waits.

use super::tests::{Folder, circumstances, files_text, go_on, subject};
use super::*;
use crate::Trial;
use selvedge_foundation::numerics::Random;
use selvedge_render::scene::PathRow;
use std::fs;
use std::path::PathBuf;

/// Twenty-one triads of cloth on the table.
const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    textiles = [\"a\", \"b\", \"c\", \"d\"]\n[odd_one_out]\n[course]\npractice_trials = 2\n";

fn cloth() -> Design {
    Design::from_toml(CLOTH, Path::new("cloth.toml")).unwrap()
}

/// A session of several trials that was closed: its log and the bytes of it.
fn held(folder: &Folder) -> (PathBuf, Vec<u8>) {
    let mut session = Session::create(&folder.0, cloth(), subject(), "none").unwrap();
    go_on(&mut session, usize::MAX, &mut Random::new(4));
    assert_eq!(session.step(), Step::Finished);
    let log = session.log().to_owned();
    drop(session);
    let bytes = fs::read(&log).unwrap();
    (log, bytes)
}

/// Where rows end, the header first.
fn ends(bytes: &[u8]) -> Vec<usize> {
    let breaks = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
    breaks.map(|(at, _)| at + 1).collect()
}

#[test]
fn killed_at_any_byte_a_session_goes_on_with_the_trial_that_was_not_on_disk() {
    let folder = Folder::new("bytes");
    let (log, bytes) = held(&folder);
    let sidecar = fs::read(log.with_extension("json")).unwrap();
    let ends = ends(&bytes);
    let trials: Vec<(Trial, u32)> = Found::read(&log)
        .unwrap()
        .records
        .iter()
        .map(|record| (record.trial.clone(), record.attempt))
        .collect();
    let tail = ends[ends.len() - 4];
    let sampled = (ends[0]..tail).step_by(37);
    for cut in sampled.chain(tail..=bytes.len()) {
        fs::write(&log, &bytes[..cut]).unwrap();
        fs::write(log.with_extension("json"), &sidecar).unwrap();
        let n_lines = ends.iter().filter(|end| **end <= cut).count();
        // Neither the header, nor the opening, nor the closing.
        let n_rows = n_lines.saturating_sub(2).min(trials.len());
        let mut session = Session::resume(&log, "none").unwrap();
        assert_eq!(session.n_rows(), n_rows, "cut at {cut}");
        let whole = &bytes[..ends[n_lines - 1]];
        let kept = fs::read(&log).unwrap();
        assert!(kept.starts_with(whole), "earlier rows are untouched");
        assert_eq!(Found::read(&log).unwrap().breaks, [], "cut at {cut}");
        let aside = session
            .openings()
            .last()
            .and_then(|last| last.set_aside.clone());
        match aside {
            None => assert_eq!(cut, ends[n_lines - 1], "nothing was torn"),
            Some(aside) => {
                assert_eq!(fs::read(&aside).unwrap(), &bytes[ends[n_lines - 1]..cut]);
                fs::remove_file(aside).unwrap();
            }
        }
        while !matches!(session.step(), Step::Trial(_) | Step::Finished) {
            session.pass();
        }
        let attempt = session.course.attempt();
        let next = match session.step() {
            Step::Trial(trial) => Some((trial.clone(), attempt)),
            _ => None,
        };
        assert_eq!(next.as_ref(), trials.get(n_rows), "cut at {cut}");
    }
}

#[test]
fn a_session_that_was_killed_is_finished_with_the_rows_of_one_that_was_not() {
    let folder = Folder::new("finish");
    let (log, bytes) = held(&folder);
    let ends = ends(&bytes);
    let all = Found::read(&log).unwrap().records;
    for cut in [ends[1], ends[3] + 5, bytes.len() - 1] {
        fs::write(&log, &bytes[..cut]).unwrap();
        let kept = Found::read(&log).unwrap().records;
        let mut session = Session::resume(&log, "none").unwrap();
        for record in &all[kept.len()..] {
            while !matches!(session.step(), Step::Trial(_)) {
                session.pass();
            }
            let about = Circumstances {
                timing: record.timing.clone(),
                apparatus: record.apparatus.clone(),
                presentation: record.presentation.clone(),
                note: &record.note,
                path: None,
                samples: &[],
            };
            match &record.outcome {
                Outcome::Aborted => session.abort(&about).unwrap(),
                Outcome::Answered(answer) => {
                    let is_correct = session.answer(answer, &about).unwrap();
                    assert_eq!(is_correct, record.is_correct);
                }
            }
        }
        assert_eq!(session.step(), Step::Finished);
        let found = Found::read(&log).unwrap();
        assert_eq!(
            (found.records, found.breaks),
            (all.clone(), Vec::new()),
            "cut at {cut}"
        );
        assert!(found.is_closed);
    }
}

#[test]
fn killed_between_log_and_sidecar_the_session_begins_as_if_it_never_had() {
    let folder = Folder::new("between");
    let session = Session::create(&folder.0, cloth(), subject(), "none").unwrap();
    let log = session.log().to_owned();
    drop(session);
    fs::remove_file(log.with_extension("json")).unwrap();
    let mut session = Session::create(&folder.0, cloth(), subject(), "none").unwrap();
    go_on(&mut session, 1, &mut Random::new(1));
    drop(session);
    assert_eq!(Found::read(&log).unwrap().records.len(), 1);
    fs::remove_file(log.with_extension("json")).unwrap();
    let again = Session::create(&folder.0, cloth(), subject(), "none").unwrap_err();
    assert!(again.to_string().contains("not overwritten"), "{again}");
    assert_eq!(fs::read_to_string(&log).unwrap().lines().count(), 3);
}

#[test]
fn a_sidecar_that_is_missing_or_garbled_is_named_and_the_log_stays() {
    let folder = Folder::new("sidecar");
    let (log, bytes) = held(&folder);
    let path = log.with_extension("json");
    let text = files_text(&path);
    let resumed = || Session::resume(&log, "none").unwrap_err().to_string();
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    let described = resumed();
    assert!(described.contains("cloth_odd_p01_1.json:"), "{described}");
    assert!(!described.contains('\n'), "{described}");
    fs::write(&path, text.replace("\\\"a\\\"", "\\\"z\\\"")).unwrap();
    let described = resumed();
    assert!(described.contains("its design was changed"), "{described}");
    fs::remove_file(&path).unwrap();
    let described = resumed();
    assert!(
        described.contains("is missing; restore it from a copy"),
        "{described}"
    );
    assert_eq!(fs::read(&log).unwrap(), bytes);
    fs::write(&path, text).unwrap();
    assert!(Session::resume(&log, "none").is_ok());
}

#[test]
fn a_row_of_a_later_version_or_of_another_schedule_is_refused_with_its_line() {
    let folder = Folder::new("rows");
    let (log, bytes) = held(&folder);
    let text = String::from_utf8(bytes).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let later = lines[2].replacen("2,trial", "3,trial", 1);
    lines[2] = &later;
    fs::write(&log, lines.join("\n") + "\n").unwrap();
    let described = Session::resume(&log, "none").unwrap_err().to_string();
    assert!(described.contains("cloth_odd_p01_1.csv:3"), "{described}");
    assert!(described.contains("knows up to 2"), "{described}");
    let mut lines: Vec<&str> = text.lines().collect();
    lines.remove(3);
    fs::write(&log, lines.join("\n") + "\n").unwrap();
    let described = Session::resume(&log, "none").unwrap_err().to_string();
    assert!(
        described.contains("row 2 of the log is not of this design"),
        "{described}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_first_trial() {
    let folder = Folder::new("closed");
    fs::create_dir_all(&folder.0).unwrap();
    let file = folder.0.join("a.csv");
    fs::write(&file, "").unwrap();
    let error = Session::create(&file, cloth(), subject(), "none").unwrap_err();
    let described = error.to_string();
    assert!(described.starts_with("cannot write "), "{described}");
    assert_eq!(fs::read(&file).unwrap(), b"");
}

#[test]
fn the_path_of_a_trial_is_a_path_and_is_there_before_its_row() {
    let folder = Folder::new("paths");
    let mut session = Session::create(&folder.0, cloth(), subject(), "none").unwrap();
    let row = |t_s: f64| PathRow {
        t_s,
        position: selvedge_foundation::geometry::Point::new(100.0 * t_s, 5.0),
        ..PathRow::default()
    };
    let explored = ExplorationPath::new(vec![row(0.0), row(0.5)]).unwrap();
    let about = Circumstances {
        path: Some(&explored),
        ..circumstances(1)
    };
    let Step::Trial(trial) = session.step() else {
        panic!("a trial waits");
    };
    let file = path_file(session.log(), trial, 1);
    let answer = Answer::chosen(0, Some(3));
    session.answer(&answer, &about).unwrap();
    assert_eq!(ExplorationPath::read(&file).unwrap(), explored);
    // A path that cannot be written keeps its row out of the log.
    let paths = file.parent().unwrap().to_owned();
    fs::remove_dir_all(&paths).unwrap();
    fs::write(&paths, "in the way").unwrap();
    let described = session.answer(&answer, &about).unwrap_err().to_string();
    assert!(described.contains("cannot write"), "{described}");
    assert_eq!(session.n_rows(), 1);
    fs::remove_file(&paths).unwrap();
    session.answer(&answer, &about).unwrap();
    assert_eq!(Found::read(session.log()).unwrap().records.len(), 2);
}

#[test]
fn killed_before_the_end_of_its_header_a_session_is_begun_again() {
    let folder = Folder::new("torn-header");
    let (log, bytes) = held(&folder);
    let found = Found::read(&log).unwrap();
    for cut in [0, 1, ends(&bytes)[0] - 1] {
        fs::write(&log, &bytes[..cut]).unwrap();
        let (design, subject) = (found.design.clone(), found.subject.clone());
        let session = Session::create(&folder.0, design, subject, "none").unwrap();
        assert_eq!(session.n_rows(), 0, "cut at {cut}");
        drop(session);
        let begun = fs::read(&log).unwrap();
        assert!(begun.starts_with(&bytes[..ends(&bytes)[0]]), "cut at {cut}");
    }
}
