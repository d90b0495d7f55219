//! Simulated sessions: to the end of every design, and the same bytes for the same seed.

use std::fs;

use super::*;
use crate::observer::{Strategy, Weighting, tests::stimuli};
use crate::session::{Circumstances, Found, Session, tests::Folder};
use selvedge_foundation::progress::Progress;
use selvedge_textile::Library;

fn simulation<'a>(
    design: &'a Design,
    stimuli: &'a Stimuli,
    observer: &'a Observer,
) -> Simulation<'a> {
    Simulation {
        design,
        stimuli,
        observer,
        seed: 1,
    }
}

#[test]
fn every_shipped_design_is_simulated_to_its_end_and_read_back() {
    let folder = Folder::new("simulated");
    for name in Design::shipped_names() {
        let design = Design::shipped(name).unwrap();
        let stimuli = stimuli(&design);
        let observer = Observer {
            strategy: Strategy::All,
            lapse: 0.1,
            ..Observer::default()
        };
        let place = folder.0.join(name);
        let simulation = simulation(&design, &stimuli, &observer);
        let logs =
            Progress::unheard(|progress| simulation.write(&place, (2, 2), progress)).unwrap();
        assert_eq!(logs.len(), 4, "{name}");
        for found in Found::in_folder(&place).unwrap().0 {
            let records = simulation.records(&found.subject).unwrap();
            assert_eq!(
                found.records, records,
                "{name}: what is read is what was answered"
            );
        }
        let mut again = Session::resume(&logs[0], "none").unwrap();
        while !matches!(again.step(), Step::Trial(_) | Step::Finished) {
            again.pass();
        }
        assert_eq!(again.step(), Step::Finished, "{name}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_gives_others() {
    let design = Design::shipped("ranking-virtual-target").unwrap();
    let stimuli = stimuli(&design);
    let observer = Observer::default();
    let text = |seed: u64, name: &str| {
        let folder = Folder::new(name);
        let simulation = Simulation {
            seed,
            ..simulation(&design, &stimuli, &observer)
        };
        let logs =
            Progress::unheard(|progress| simulation.write(&folder.0, (2, 1), progress)).unwrap();
        let files = logs
            .iter()
            .flat_map(|log| [log.clone(), log.with_extension("json")]);
        files
            .map(|file| fs::read(file).unwrap())
            .collect::<Vec<_>>()
    };
    let (first, second) = (text(1, "bytes-1"), text(1, "bytes-2"));
    assert_eq!(first, second);
    assert_ne!(first, text(2, "bytes-3"));
}

#[test]
fn rows_are_those_of_a_session_that_is_held_trial_by_trial() {
    let design = Design::shipped("odd-one-out").unwrap();
    let (stimuli, observer) = (stimuli(&design), Observer::default());
    let simulation = simulation(&design, &stimuli, &observer);
    let (whole, held) = (Folder::new("whole-rows"), Folder::new("held-rows"));
    let logs = Progress::unheard(|progress| simulation.write(&whole.0, (1, 1), progress)).unwrap();
    let subject = simulated_subject(0, 1);
    let mut session = Session::create(&held.0, design.clone(), subject.clone(), "none").unwrap();
    for record in simulation.records(&subject).unwrap() {
        while !matches!(session.step(), Step::Trial(_)) {
            session.pass();
        }
        let circumstances = Circumstances {
            timing: record.timing.clone(),
            apparatus: record.apparatus.clone(),
            presentation: record.presentation.clone(),
            note: "",
            path: None,
            samples: &[],
        };
        let is_correct = session
            .answer(record.answer().unwrap(), &circumstances)
            .unwrap();
        assert_eq!(is_correct, record.is_correct);
    }
    let rows = |log: &Path| {
        let text = fs::read_to_string(log).unwrap();
        // All but what opened and closed it, when, and what binds the rows to that.
        let trials = text.lines().filter(|line| line.contains(",trial,"));
        let unbound = trials.map(|line| line.rsplit_once(',').unwrap().0.to_owned());
        unbound.collect::<Vec<String>>()
    };
    assert_eq!(rows(&logs[0]), rows(session.log()));
}

#[test]
fn a_log_that_is_there_is_never_overwritten_and_nothing_beside_it_is_begun() {
    let design = Design::shipped("rating").unwrap();
    let (stimuli, observer) = (stimuli(&design), Observer::default());
    let simulation = simulation(&design, &stimuli, &observer);
    let folder = Folder::new("there");
    let write =
        |n: usize| Progress::unheard(|progress| simulation.write(&folder.0, (n, 1), progress));
    let logs = write(1).unwrap();
    let before = fs::read(&logs[0]).unwrap();
    let error = write(3).unwrap_err().to_string();
    assert!(error.contains("hand_rating_o01_1.csv"), "{error}");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 2);
    assert_eq!(fs::read(&logs[0]).unwrap(), before);
}

#[test]
fn a_textile_that_is_not_in_the_library_is_named_in_one_line() {
    let text = Design::shipped_text("odd-one-out").unwrap();
    let text = text.replace("polyamide-taffeta", "felt-hat");
    let design = Design::from_toml(&text, Path::new("a.toml")).unwrap();
    let library = Library::shipped().unwrap();
    let error = Progress::unheard(|progress| Stimuli::of(&design, &library, progress)).unwrap_err();
    let described = error.to_string();
    assert!(described.contains("no textile \"felt-hat\""), "{described}");
    assert_eq!(described.lines().count(), 1, "{described}");
}

/// Prints what the shipped ranking gives; nothing is tuned to it.
#[test]
#[ignore = "loads the shipped library, and prints for people to read"]
fn what_the_shipped_ranking_gives() {
    let library = Library::shipped().unwrap();
    let design = Design::shipped("ranking-virtual-target").unwrap();
    let stimuli = Progress::unheard(|progress| Stimuli::of(&design, &library, progress)).unwrap();
    for weighting in [Weighting::Equal, Weighting::Learnt] {
        for looks in [1, 2, 4, 8, 16] {
            for strategy in Strategy::ALL {
                let observer = Observer {
                    strategy,
                    weighting,
                    looks,
                    ..Observer::default()
                };
                let simulation = simulation(&design, &stimuli, &observer);
                let share = |nth: usize| {
                    let records = simulation.records(&simulated_subject(nth, 1)).unwrap();
                    let counted = records.iter().filter(|record| !record.trial.is_practice);
                    let right = counted.filter(|record| record.is_correct == Some(true));
                    100.0 * right.count() as f64 / 80.0
                };
                let shares: Vec<f64> = (0..8).map(share).collect();
                let summary = selvedge_statistics::Summary::of(&shares).unwrap();
                let se = summary.sd / 8.0_f64.sqrt();
                println!(
                    "{:.1} % ± {se:.1} SE: {}",
                    summary.mean,
                    observer.describe()
                );
            }
        }
    }
}
