//! Logs that are damaged, empty or of a later version, data without order, and work that is
//! stopped.

use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::session::{Circumstances, Session};
use crate::simulate::simulated_subject;
use selvedge_foundation::progress::{CancelFlag, Progress};
use selvedge_scratch::ScratchFolder as Scratch;

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    title = \"Odd cloth\"\ntextiles = [\"a\", \"b\", \"c\", \"d\", \"e\"]\n[odd_one_out]\n";

/// Sessions of so many trials, on disk.
fn on_disk(folder: &Scratch, n_trials: &[usize]) -> Vec<PathBuf> {
    let design = Design::from_toml(CLOTH, Path::new("cloth.toml")).unwrap();
    let of = |(nth, n): (usize, &usize)| {
        let subject = simulated_subject(nth, 1);
        let mut session = Session::create(&folder.0, design.clone(), subject, "none").unwrap();
        for _ in 0..*n {
            let Step::Trial(trial) = session.step() else {
                panic!("a trial waits");
            };
            let answer = odd(&trial.task, trial.number % 3 > 0, Grade::Normal);
            let described = Circumstances {
                timing: Timing::between([std::time::UNIX_EPOCH; 2], [0, 5_000_000_000]),
                apparatus: Apparatus::default(),
                presentation: Presentation::confirmed(Proof::Array),
                note: "",
                path: None,
                samples: &[],
            };
            session.answer(&answer, &described).unwrap();
        }
        session.log().to_owned()
    };
    n_trials.iter().enumerate().map(of).collect()
}

fn of_folder(folder: &Scratch) -> Result<Analysis, ExperimentError> {
    Progress::unheard(|progress| Analysis::of_folder(&folder.0, &few(), progress))
}

fn made_newer(log: &Path) {
    let sidecar = log.with_extension("json");
    let text = fs::read_to_string(&sidecar).unwrap();
    let newer = text.replacen("\"schema_version\": 2", "\"schema_version\": 99", 1);
    assert_ne!(text, newer, "{text}");
    fs::write(sidecar, newer).unwrap();
}

#[test]
fn a_log_of_a_later_version_is_listed_and_the_others_are_analysed() {
    let folder = Scratch::new("newer");
    let logs = on_disk(&folder, &[10, 10, 10]);
    made_newer(&logs[1]);
    fs::write(&logs[2], "no,such,columns\n1,2,3\n").unwrap();
    let analysis = of_folder(&folder).unwrap();
    let left_out = table(&analysis, UNREAD, "logs");
    assert_eq!(left_out.rows.len(), 2, "{left_out:?}");
    let why = |row: usize| match left_out.cell(row, "why") {
        Some(Cell::Text(why)) => why.clone(),
        other => panic!("{other:?}"),
    };
    for described in [why(0), why(1)] {
        assert!(
            !described.contains('\n') && described.contains("cloth_odd_o0"),
            "{described}"
        );
    }
    assert!(
        why(0).contains("version 99") && why(0).contains("use a later one"),
        "{}",
        why(0)
    );
    let held = table(&analysis, "odd-sessions", "held");
    assert_eq!(held.rows.len(), 1, "{held:?}");
}

#[test]
fn a_folder_of_nothing_but_later_logs_is_refused_in_one_line() {
    let folder = Scratch::new("all-newer");
    let logs = on_disk(&folder, &[2, 2]);
    for log in &logs {
        made_newer(log);
    }
    let described = of_folder(&folder).unwrap_err().to_string();
    assert!(
        described.contains("version 99") && !described.contains('\n'),
        "{described}"
    );
}

#[test]
fn a_session_that_was_only_opened_has_its_row_and_no_numbers() {
    let folder = Scratch::new("opened");
    on_disk(&folder, &[0]);
    let analysis = of_folder(&folder).unwrap();
    let held = table(&analysis, "odd-sessions", "held");
    assert_eq!(value(held, 0, "trials"), 0.0);
    let last = analysis.sections.last().unwrap();
    assert!(
        last.notes.iter().any(|n| n.contains("No trial is left")),
        "{last:?}"
    );
    let with_another = Scratch::new("opened-beside");
    on_disk(&with_another, &[0, 10]);
    let analysis = of_folder(&with_another).unwrap();
    let subjects = table(&analysis, "odd-accuracy", "subjects");
    assert_eq!(subjects.rows.len(), 1, "only who answered: {subjects:?}");
}

#[test]
fn comparisons_that_nothing_joins_give_no_map_and_say_between_what() {
    let folder = Scratch::new("apart");
    on_disk(&folder, &[2]);
    let analysis = of_folder(&folder).unwrap();
    let map = analysis
        .sections
        .iter()
        .find(|s| s.key == "odd-map")
        .unwrap();
    let described = map.notes.iter().find(|n| n.contains("No map"));
    assert!(
        described.is_some_and(|n| n.contains("no chain of pairs joins")),
        "{:?}",
        map.notes
    );
}

#[test]
fn an_analysis_that_is_stopped_says_that_it_was_stopped() {
    let folder = Scratch::new("stopped");
    on_disk(&folder, &[10, 10]);
    let flag = CancelFlag::new();
    flag.cancel();
    let mut report = |_: f64, _: &str| {};
    let stopped = Analysis::of_folder(&folder.0, &few(), &mut Progress::new(&mut report, flag));
    assert!(
        matches!(stopped, Err(ExperimentError::Cancelled(_))),
        "{stopped:?}"
    );
}

#[test]
fn random_data_are_on_unless_refused_and_found_once_a_size() {
    assert!(Options::default().n_random_data >= 40);
    let design = Design::shipped("odd-one-out").unwrap();
    let by_place = |task: &Task, _: usize| {
        let apart = apart(task);
        odd(task, apart > 1, Grade::ALL[apart % 3])
    };
    let found: Vec<Found> = (0..2)
        .map(|nth| held(&design, (nth, 1), by_place))
        .collect();
    let options = Options {
        n_random_data: 10,
        ..few()
    };
    let analysed =
        || Progress::unheard(|progress| Analysis::of(&found, &options, progress)).unwrap();
    let first = analysed();
    let stress = table(&first, "odd-one-out-map", "stress");
    let (mean, five) = (
        value(stress, 1, "random_mean"),
        value(stress, 1, "random_5_percent"),
    );
    assert!(0.0 < five && five <= mean && mean < 0.3, "{stress:?}");
    assert!((1.0 / 11.0..=1.0).contains(&value(stress, 1, "random_p")));
    assert_eq!(options.random_data.n_kept(), 5, "one to five dimensions");
    assert_eq!(analysed(), first, "what is kept is what would be found");
    assert_eq!(options.random_data.n_kept(), 5);
}
