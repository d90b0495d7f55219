//! Rows, tallies, a log that is full, totals.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::*;
use selvedge_scratch::ScratchFolder;

fn noon() -> SystemTime {
    UNIX_EPOCH + Duration::from_secs(1_772_366_706)
}

fn guess(truth: &str, choice: &str) -> Guess {
    Guess {
        truth: truth.to_owned(),
        choice: choice.to_owned(),
        order: "3142".to_owned(),
        is_heard: true,
        ms: 4200,
    }
}

fn visit(guesses: Vec<Guess>) -> Visit {
    Visit {
        duration_s: 61.4,
        input: "touch",
        was_armed: false,
        sound: "middle",
        cloth_s: [12.0, 3.6, 0.0, 1.0],
        n_strokes: 9,
        guesses,
        comment: Comment::default(),
        end: VisitEnd::Idle,
    }
}

#[test]
fn a_visit_is_a_row_without_a_moment_a_path_or_a_name() {
    let folder = ScratchFolder::made("visits-row");
    let mut log = VisitLog::in_folder(&folder).unwrap();
    let mut said = visit(vec![guess("silk", "silk"), guess("jute", "wool")]);
    said.comment = Comment {
        face: "glad",
        words: vec!["soft", "fun"],
        text: "like, \"hair\"\nreally".to_owned(),
    };
    log.write(&said, noon());
    log.write(&visit(Vec::new()), noon());
    assert_eq!(log.unwritten(), None);
    let read = |name| fs::read_to_string(folder.join(name)).unwrap();
    let rows = read(VISITS);
    let rows: Vec<&str> = rows.lines().skip(1).collect();
    assert_eq!(
        rows,
        [
            "1,2026-03-01,12,61,touch,off,middle,12,4,0,1,9,2,1,idle",
            "2,2026-03-01,12,61,touch,off,middle,12,4,0,1,9,0,0,idle"
        ]
    );
    assert!(read(GUESSES).ends_with("1,silk,silk,3142,on,4200\n1,jute,wool,3142,on,4200\n"));
    assert!(read(COMMENTS).ends_with("1,glad,soft fun,\"like, \"\"hair\"\" really\"\n"));
}

#[test]
fn numbers_and_tallies_go_on_after_a_restart_in_the_middle_of_a_row() {
    let folder = ScratchFolder::made("visits-torn");
    let mut log = VisitLog::in_folder(&folder).unwrap();
    let three = vec![guess("a", "a"), guess("b", "b"), guess("c", "a")];
    log.write(&visit(three), noon());
    drop(log);
    let mut file = OpenOptions::new();
    let mut file = file.append(true).open(folder.join(VISITS)).unwrap();
    file.write_all(b"2,2026-03-0").unwrap();
    drop(file);
    assert_eq!(Totals::of_folder(&folder).unwrap().n_visits(), 1);
    let mut log = VisitLog::in_folder(&folder).unwrap();
    let tally = Tally {
        n_visits: 1,
        n_guessed: 1,
        n_right: 2,
    };
    assert_eq!(log.tally(), tally);
    log.write(&visit(Vec::new()), noon());
    let rows = fs::read_to_string(folder.join(VISITS)).unwrap();
    assert!(rows.lines().last().unwrap().starts_with("2,2026-03-01,12,"));
    let busy = VisitLog::in_folder(&folder).unwrap_err().to_string();
    assert!(busy.contains("another"), "{busy}");
}

#[test]
fn a_log_that_is_full_is_counted_and_the_visits_go_on() {
    let folder = ScratchFolder::made("visits-full");
    let mut log = VisitLog::in_folder(&folder).unwrap();
    let mut long = visit(Vec::new());
    long.guesses = vec![guess(&"x".repeat(1_000_000), "y")];
    for _ in 0..12 {
        log.write(&long, noon());
    }
    let (n, why) = log.unwritten().unwrap();
    assert!(n == 3 && why.contains("full"), "{n} {why}");
    assert_eq!(log.tally().n_visits, 12, "counted all the same");
    log.write(&visit(Vec::new()), noon() + Duration::from_hours(24));
    assert_eq!(log.unwritten().unwrap().0, 3, "another day");
}

#[test]
fn totals_stand_beside_chance_with_their_intervals() {
    let folder = ScratchFolder::made("visits-totals");
    let mut log = VisitLog::in_folder(&folder).unwrap();
    for nth in 0..20 {
        let right = |truth| guess(truth, if nth % 2 == 0 { truth } else { "wool" });
        let mut said = visit(vec![right("silk"), right("jute"), right("jersey")]);
        said.comment.face = "glad";
        log.write(&said, noon());
    }
    let out = folder.join("out");
    Totals::of_folder(&folder).unwrap().write(&out).unwrap();
    let totals = fs::read_to_string(out.join("totals.csv")).unwrap();
    let row = |what: &str| {
        let begins = format!("{what},");
        let found = totals.lines().find(|line| line.starts_with(&begins));
        found.unwrap_or_else(|| panic!("{what} in {totals}"))
    };
    assert_eq!(row("visits"), "visits,20,,,,,,");
    let cells: Vec<&str> = row("right guesses").split(',').collect();
    assert_eq!(cells[1..4], ["30", "60", "0.5"]);
    let [low, high, chance, p]: [f64; 4] = [4, 5, 6, 7].map(|i| cells[i].parse().unwrap());
    // Wilson (1927) for 30 of 60.
    assert!((low - 0.377).abs() < 1e-3 && (high - 0.623).abs() < 1e-3);
    assert!(chance == 0.25 && p < 1e-4, "{chance} {p}");
    assert_eq!(row("face glad").split(',').nth(3), Some("1"));
    assert!(out.join(VISITS).exists() && out.join(GUESSES).exists());
}
