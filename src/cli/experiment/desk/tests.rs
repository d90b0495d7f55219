//! Sessions held from lines, without a terminal and with a clock that stands where it is put.

use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

use super::*;
use selvedge_experiment::Outcome;
use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::session::Found;
use selvedge_scratch::ScratchFolder as Folder;

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    textiles = [\"a\", \"b\", \"c\"]\n[odd_one_out]\n[course]\npractice_trials = 1\n\
    instructions = \"Find the odd one.\"\n\
    [[course.familiarisation]]\nmovement = \"linear\"\nfor_s = 30.0\nspeed_mm_per_s = 100.0\n";

/// A clock that goes on by a second whenever it is looked at.
#[derive(Default)]
struct Still {
    seconds: u64,
    counted_s: Vec<f64>,
}

impl Bench for &mut Still {
    fn now(&mut self) -> Moment {
        self.seconds += 1;
        Moment {
            utc: UNIX_EPOCH + Duration::from_secs(self.seconds),
            since_ns: self.seconds * 1_000_000_000,
        }
    }

    fn count_down(&mut self, seconds: f64) -> io::Result<()> {
        self.counted_s.push(seconds);
        Ok(())
    }
}

/// Holds a session from lines: how it ended, what was said, which countdowns there were.
fn held(session: &mut Session, lines: &str) -> (Ended, String, Vec<f64>) {
    let mut bench = Still::default();
    let mut out = Vec::new();
    let mut desk = Desk {
        session,
        typed: lines.as_bytes(),
        out: &mut out,
        bench: &mut bench,
        apparatus: Apparatus::default(),
        proof: Proof::RealCloth,
        notes: Vec::new(),
    };
    let ended = desk.hold().unwrap();
    (ended, String::from_utf8(out).unwrap(), bench.counted_s)
}

fn session(folder: &Folder, text: &str) -> Session {
    let design = Design::from_toml(text, Path::new("a.toml")).unwrap();
    let subject = Subject {
        pseudonym: "p01".to_owned(),
        nth: 0,
        session: 1,
    };
    Session::create(&folder.0, design, subject, "none").unwrap()
}

fn records(session: &Session) -> Vec<selvedge_experiment::Record> {
    Found::read(session.log()).unwrap().records
}

#[test]
fn a_session_goes_from_instructions_to_its_end() {
    let folder = Folder::new("whole");
    let mut session = session(&folder, CLOTH);
    let lines = format!("\n\n{}", "\n2 easy\n".repeat(4));
    let (ended, said, counted_s) = held(&mut session, &lines);
    assert_eq!(ended, Ended::Finished, "{said}");
    assert_eq!(counted_s, [30.0]);
    assert!(said.contains("read out:\n  Find the odd one."), "{said}");
    assert!(said.contains("practice 1, block 1: 0 of 4 done"), "{said}");
    assert!(said.contains("trial 3, block 1: 3 of 4 done"), "{said}");
    assert!(said.contains("  position 1      "), "{said}");
    let records = records(&session);
    assert_eq!(records.len(), 4);
    let answer = Answer::chosen(1, Some(1));
    assert!(records.iter().all(|row| row.answer() == Some(&answer)));
    assert!(records.iter().all(|row| row.timing.response_ms() == 1000.0));
}

#[test]
fn the_right_answer_is_never_marked() {
    let folder = Folder::new("blind");
    let mut session = session(&folder, CLOTH);
    let (_, said, _) = held(&mut session, &format!("\n\n{}", "\n1 hard\n".repeat(4)));
    for word in ["correct", "right", "wrong", "odd position is", "target"] {
        assert!(!said.to_lowercase().contains(word), "{word}: {said}");
    }
}

#[test]
fn nonsense_is_asked_again_in_one_line_and_costs_nothing() {
    let folder = Folder::new("nonsense");
    let mut session = session(&folder, CLOTH);
    let (ended, said, _) = held(&mut session, "x\n\n\n7\n\n9 easy\nhello\n\n3 normal\n");
    assert_eq!(ended, Ended::Silent);
    assert!(said.contains("press Enter to go on"), "{said}");
    assert!(said.contains("the trial has not begun"), "{said}");
    for wrong in ["\"9 easy\" is no answer", "\"hello\" is no answer"] {
        let line = said.lines().find(|line| line.contains(wrong)).unwrap();
        assert!(line.contains("2 easy, 2 normal or 2 hard"), "{line}");
        assert!(line.contains("abort, note TEXT, break or quit"), "{line}");
    }
    assert_eq!(records(&session).len(), 1);
}

#[test]
fn an_aborted_trial_comes_again_and_notes_stay_with_their_trial() {
    let folder = Folder::new("abort");
    let mut session = session(&folder, CLOTH);
    let lines = "\n\n\nnote cloth slipped\nnote, twice\nabort\n\nnote\nbreak\n\n\n1 easy\nquit\n";
    let (ended, said, _) = held(&mut session, lines);
    assert_eq!(ended, Ended::Quit);
    assert!(
        said.contains("practice 1, block 1, attempt 2: 0 of 4 done"),
        "{said}"
    );
    assert!(said.contains("type note and what is to be noted"), "{said}");
    let records = records(&session);
    assert_eq!(records.len(), 2);
    assert_eq!(records[0].outcome, Outcome::Aborted);
    assert_eq!(records[0].note, "cloth slipped");
    assert_eq!(records[1].trial, records[0].trial);
    assert_eq!(
        (records[1].attempt, records[1].note.as_str()),
        (2, "break of 1 s before this")
    );
    assert_eq!(
        records[1].timing.response_ms(),
        1000.0,
        "the break does not count"
    );
}

#[test]
fn a_note_of_a_trial_that_is_left_is_kept_and_a_line_cut_off_is_no_answer() {
    let folder = Folder::new("left");
    let mut session = session(&folder, CLOTH);
    let (ended, _, _) = held(&mut session, "\n\n\nnote fire alarm\nquit\n");
    assert_eq!(ended, Ended::Quit);
    let kept = records(&session);
    assert_eq!(kept.len(), 1);
    assert_eq!(
        (&kept[0].outcome, kept[0].note.as_str()),
        (&Outcome::Aborted, "fire alarm")
    );
    let log = session.log().to_owned();
    drop(session);
    let mut session = Session::resume(&log, "none").unwrap();
    let (ended, said, _) = held(&mut session, "\n\n\n2 easy");
    assert_eq!(ended, Ended::Silent);
    assert!(said.contains("read out"), "instructions come again: {said}");
    assert_eq!(records(&session).len(), 1);
}
