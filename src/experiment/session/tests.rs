//! Sessions: what is answered is on disk, and what is on disk can be continued.

use std::fs;
use std::time::UNIX_EPOCH;

use super::*;
use crate::Trial;
use crate::design::Form;
use crate::{AnswerValue, Proof, Task};
use selvedge_foundation::numerics::Random;
pub(crate) use selvedge_scratch::ScratchFolder as Folder;

pub(super) fn subject() -> Subject {
    Subject {
        pseudonym: "p01".to_owned(),
        nth: 0,
        session: 1,
    }
}

/// Some answer to a task.
pub(crate) fn any_answer(design: &Design, task: &Task, random: &mut Random) -> Answer {
    let composition = &design.composition;
    match &composition.response.form {
        Form::Rank => {
            let mut order = [0, 1, 2, 3];
            random.shuffle(&mut order);
            Answer::in_order(&order)
        }
        Form::Adjustment(_) => {
            let values = task.starts.iter().map(|start| start / 3.0).collect();
            let steps = vec![crate::Adjustment {
                at_ms: 0.1,
                parameter: 0,
                value: task.starts[0] / 3.0,
            }];
            AnswerValue::Adjusted { values, steps }.into()
        }
        Form::Number { .. } => AnswerValue::Number(0.1 + random.uniform()).into(),
        Form::Scales(scales) => {
            let anywhere = scales.iter().map(|_| 100.0 * random.uniform());
            AnswerValue::Ratings(anywhere.collect()).into()
        }
        _ => {
            let n_grades = composition.response.confidence.n_grades();
            let confidence = Some(n_grades.min(2)).filter(|grade| *grade > 0);
            Answer::chosen(random.index(composition.n_choices()), confidence)
        }
    }
}

pub(super) fn circumstances(nth: u64) -> Circumstances<'static> {
    let ns = nth * 1_000_000_007;
    Circumstances {
        timing: Timing::between([UNIX_EPOCH, UNIX_EPOCH], [ns, ns + 1_234_567]),
        apparatus: Apparatus {
            device: "none, \"in a test\"".to_owned(),
            ..Apparatus::default()
        },
        presentation: Presentation::confirmed(Proof::RealCloth),
        note: "a note, with a comma\nand two lines",
        path: None,
        samples: &[],
    }
}

/// Answers up to so many trials; gives every seventh up first.
pub(super) fn go_on(session: &mut Session, most: usize, random: &mut Random) {
    for nth in 0..most {
        while !matches!(session.step(), Step::Trial(_) | Step::Finished) {
            session.pass();
        }
        let Step::Trial(trial) = session.step() else {
            return;
        };
        let answer = any_answer(session.design(), &trial.task, random);
        if nth % 7 == 6 {
            session.abort(&circumstances(nth as u64)).unwrap();
        }
        session.answer(&answer, &circumstances(nth as u64)).unwrap();
    }
}

#[test]
fn every_shipped_design_can_be_held_to_its_end_and_read_back() {
    for name in Design::shipped_names() {
        let folder = Folder::new(name);
        let design = Design::shipped(name).unwrap();
        let mut session = Session::create(&folder.0, design, subject(), "none").unwrap();
        go_on(&mut session, 2000, &mut Random::new(1));
        assert_eq!(session.step(), Step::Finished, "{name}");
        assert!(session.progress().0 > 10, "{name}");
        let found = Found::in_folder(&folder.0).unwrap().0;
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].records.len(), session.n_rows(), "{name}");
        assert_eq!(
            found[0].breaks,
            [],
            "{name}: rows change when read and written"
        );
        assert!(found[0].is_closed, "{name}");
    }
}

pub(super) fn files_text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_session_goes_on_as_if_it_had_never_stopped() {
    let design = Design::shipped("ranking-virtual-target").unwrap();
    let whole = Folder::new("whole");
    let mut session = Session::create(&whole.0, design.clone(), subject(), "none").unwrap();
    go_on(&mut session, 84, &mut Random::new(2));
    let trials = |folder: &Folder| -> Vec<Trial> {
        let found = Found::in_folder(&folder.0).unwrap().0;
        found[0]
            .records
            .iter()
            .map(|record| record.trial.clone())
            .collect()
    };
    let parts = Folder::new("parts");
    let mut random = Random::new(2);
    let mut session = Session::create(&parts.0, design, subject(), "none").unwrap();
    let log = session.log().to_owned();
    for _ in 0..6 {
        go_on(&mut session, 14, &mut random);
        drop(session);
        session = Session::resume(&log, "none").unwrap();
    }
    assert_eq!(session.progress(), (84, 84));
    assert_eq!(
        session.openings().len(),
        6,
        "a log that is closed is not opened again"
    );
    assert_eq!(trials(&whole), trials(&parts));
}

#[test]
fn two_sessions_cannot_write_one_log() {
    let folder = Folder::new("twice");
    let design = Design::shipped("rating").unwrap();
    let session = Session::create(&folder.0, design.clone(), subject(), "none").unwrap();
    let again = Session::create(&folder.0, design, subject(), "none").unwrap_err();
    assert!(again.to_string().contains("another session"), "{again}");
    let beside = Session::resume(session.log(), "none").unwrap_err();
    assert!(beside.to_string().contains("another session"), "{beside}");
}

#[test]
fn a_log_of_a_later_version_is_refused_with_what_is_known() {
    let folder = Folder::new("later");
    let design = Design::shipped("rating").unwrap();
    let session = Session::create(&folder.0, design, subject(), "none").unwrap();
    let log = session.log().to_owned();
    drop(session);
    let path = log.with_extension("json");
    let text = files_text(&path).replace("\"schema_version\": 2", "\"schema_version\": 3");
    fs::write(&path, text).unwrap();
    let error = Session::resume(&log, "none").unwrap_err().to_string();
    assert!(error.contains("knows up to 2"), "{error}");
}

#[test]
fn a_real_name_with_a_space_is_no_pseudonym() {
    let folder = Folder::new("name");
    let design = Design::shipped("rating").unwrap();
    let subject = Subject {
        pseudonym: "Ada Lovelace".to_owned(),
        ..subject()
    };
    let error = Session::create(&folder.0, design, subject, "none").unwrap_err();
    assert!(error.to_string().contains("no real name"), "{error}");
}
