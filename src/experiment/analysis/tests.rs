//! Analyses of answers whose numbers are known beforehand.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::experiment::design::{Design, Levels, Source, Subject, Track};
use crate::experiment::{
    Answer, Apparatus, Course, Grade, Outcome, Record, Step, Task, Timing, Trial,
};
use crate::numerics::Random;
use crate::progress::unheard;
use crate::quantity::factor_of_gain;
use crate::statistics::adaptive::{Procedure as _, Staircase};

/// Few of everything: these tests are of numbers that do not hang on it.
fn few() -> Options {
    Options {
        n_resamples: 100,
        n_permutations: 99,
        n_maps: 3,
        n_starts: 2,
        n_starts_on_a_line: 4,
        ..Options::default()
    }
}

fn analysed(found: &[Found]) -> Analysis {
    unheard(|progress| analyse(found, &few(), progress)).unwrap()
}

fn record(trial: Trial, answer: Answer, response_s: u64) -> Record {
    let is_correct = trial.task.verdict(&answer).unwrap();
    let start_ns = trial.number as u64 * 100_000_000_000;
    Record {
        trial,
        attempt: 1,
        outcome: Outcome::Answered(answer),
        is_correct,
        timing: Timing {
            start_utc: "2026-01-01T00:00:00Z".to_owned(),
            response_utc: "2026-01-01T00:00:05Z".to_owned(),
            start_ns,
            response_ns: start_ns + response_s * 1_000_000_000,
        },
        apparatus: Apparatus::default(),
        note: String::new(),
    }
}

/// A whole session, answered by a function of task and number.
fn held(
    design: &Design,
    (nth, session): (usize, u32),
    mut answer: impl FnMut(&Task, usize) -> Answer,
) -> Found {
    let subject = Subject {
        pseudonym: format!("p{:02}", nth + 1),
        nth,
        session,
    };
    let mut course = Course::begin(design, &subject).unwrap();
    let mut records = Vec::new();
    loop {
        match course.step() {
            Step::Finished => break,
            Step::Trial(trial) => {
                let trial = trial.clone();
                let said = answer(&trial.task, trial.number);
                course.answer(&said).unwrap();
                records.push(record(trial, said, 5));
            }
            _ => course.pass(),
        }
    }
    let log = format!("{}_{}_{session}.csv", design.experiment, subject.pseudonym);
    Found {
        log: PathBuf::from("nowhere").join(log),
        subject,
        design: design.clone(),
        records,
        has_torn_row: false,
    }
}

fn table<'a>(analysis: &'a Analysis, section: &str, key: &str) -> &'a Table {
    let found = analysis.sections.iter().find(|s| s.key == section);
    let keys: Vec<&str> = analysis.sections.iter().map(|s| s.key.as_str()).collect();
    let section = found.unwrap_or_else(|| panic!("no {section} among {keys:?}"));
    let table = section.tables.iter().find(|t| t.key == key);
    table.unwrap_or_else(|| panic!("no table {key} in {}", section.key))
}

fn value(table: &Table, row: usize, column: &str) -> f64 {
    match table.cell(row, column) {
        Some(Cell::Number(value)) => *value,
        other => panic!("{} {row} {column}: {other:?}", table.key),
    }
}

/// The target first in so many trials, second in the others; others by how near they stand in the
/// design.
fn ranked(n_first: usize) -> impl FnMut(&Task, usize) -> Answer {
    move |task, number| {
        let Task::Rank {
            target,
            alternatives,
        } = task
        else {
            panic!("no ranking");
        };
        let mut order: Vec<usize> = (0..4).filter(|at| alternatives[*at] != *target).collect();
        order.sort_by_key(|at| alternatives[*at].abs_diff(*target));
        let own = alternatives.iter().position(|a| a == target).unwrap();
        order.insert(usize::from(number >= n_first), own);
        let mut ranks = [0; 4];
        for (place, rank) in order.iter().zip(1..) {
            ranks[*place] = rank;
        }
        Answer::Ranks(ranks)
    }
}

fn rankings(design: &str, n_first: [usize; 8]) -> Vec<Found> {
    let design = Design::shipped(design).unwrap();
    let all = n_first.into_iter().enumerate();
    all.map(|(nth, n)| held(&design, (nth, 1), ranked(n)))
        .collect()
}

/// Eight subjects of 80 trials whose mean and standard error are the printed ones, 41.3 ± 1.6 %
/// and 64.1 ± 5.5 %.
fn both_experiments() -> Vec<Found> {
    let mut all = rankings("ranking-real-target", [28, 29, 31, 32, 34, 35, 37, 38]);
    all.extend(rankings(
        "ranking-virtual-target",
        [34, 38, 43, 48, 56, 60, 63, 68],
    ));
    all
}

#[test]
fn printed_scores_of_both_ranking_experiments_give_their_printed_tests() {
    let analysis = analysed(&both_experiments());
    let group = table(&analysis, "ranking-real-target-identification", "group");
    assert!((value(group, 0, "mean") - 41.25).abs() < 1e-9, "{group:?}");
    // Deviations 5, 4, 2, 1 either way of 80 trials: sd = √(92/7)/0.8.
    let se = (92.0_f64 / 7.0).sqrt() / 0.8 / 8.0_f64.sqrt();
    assert!((value(group, 0, "se") - se).abs() < 1e-9, "{group:?}");
    let tests = table(&analysis, "ranking-real-target-identification", "tests");
    assert!(
        (value(tests, 0, "value") - 16.25 / se).abs() < 1e-9,
        "{tests:?}"
    );
    assert!((value(tests, 0, "value") - 10.2).abs() < 0.1, "as printed");
    assert_eq!(value(tests, 0, "df"), 7.0);
    assert!(
        (value(tests, 0, "p") / 1.9e-5 - 1.0).abs() < 0.1,
        "as printed"
    );
    let tests = table(&analysis, "ranking-virtual-target-identification", "tests");
    assert!((value(tests, 0, "value") - 7.11).abs() < 0.1, "as printed");
    let both = table(&analysis, "comparison", "tests");
    assert!(
        (value(both, 0, "value").abs() - 3.98).abs() < 0.05,
        "{both:?}"
    );
    assert!((value(both, 0, "df") - 8.2).abs() < 0.1, "Welch: {both:?}");
    assert!(
        (value(both, 0, "p") - 0.0039).abs() < 0.0003,
        "Welch: {both:?}"
    );
    assert_eq!(value(both, 1, "df"), 14.0);
    assert!(
        (value(both, 1, "p") - 0.0014).abs() < 0.0002,
        "Student: {both:?}"
    );
}

#[test]
fn ranks_become_the_matrices_that_they_were_given_by() {
    let found = rankings("ranking-virtual-target", [80; 8]);
    let analysis = analysed(&found);
    let subjects = table(
        &analysis,
        "ranking-virtual-target-identification",
        "subjects",
    );
    assert_eq!(value(subjects, 0, "percent"), 100.0);
    assert_eq!(value(subjects, 0, "mean_rank"), 1.0);
    let means = table(&analysis, "ranking-virtual-target-confusions", "mean-ranks");
    let diagonal = (0..16).map(|i| means.rows[i][i + 1].number());
    assert!(diagonal.clone().all(|rank| rank == Some(1.0)), "{means:?}");
    let targets = table(&analysis, "ranking-virtual-target-confusions", "targets");
    assert_eq!(value(targets, 3, "trials"), 40.0);
    // No spread between subjects: no t, and a reason instead.
    let tests = table(&analysis, "ranking-virtual-target-identification", "tests");
    let t = tests.cell(0, "value");
    assert!(
        matches!(t, Some(Cell::Undefined(why)) if why.contains("spread")),
        "{t:?}"
    );
    let stress = table(&analysis, "ranking-virtual-target-map", "stress");
    assert_eq!(stress.rows.len(), 5);
    assert!(
        value(stress, 1, "sstress") <= value(stress, 0, "sstress") + 1e-9,
        "{stress:?}"
    );
    let turns = table(&analysis, "ranking-virtual-target-map", "turns");
    assert!(value(turns, 0, "p_sum") > 0.0, "{turns:?}");
}

#[test]
fn what_the_rules_leave_out_is_listed_and_not_counted() {
    let mut found = rankings("ranking-virtual-target", [60; 8]);
    let fast = &mut found[0].records[4 + 9];
    fast.timing.response_ns = fast.timing.start_ns + 1_999_000_000;
    found[1].records.truncate(4 + 79);
    found[1].has_torn_row = true;
    let analysis = analysed(&found);
    let out = table(&analysis, "ranking-virtual-target-sessions", "left-out");
    let told = |row: usize, column: &str| out.cell(row, column).cloned();
    assert_eq!(out.rows.len(), 2);
    assert_eq!(told(0, "trials"), Some(Cell::Text("10".to_owned())));
    assert_eq!(told(1, "trials"), Some(Cell::Text("1–79".to_owned())));
    let why = told(1, "why");
    assert_eq!(why, Some(Cell::Text("79 trials, fewer than 80".to_owned())));
    let sessions = table(&analysis, "ranking-virtual-target-sessions", "held");
    let state = sessions.cell(1, "state");
    assert!(
        matches!(state, Some(Cell::Text(t)) if t.contains("torn")),
        "{state:?}"
    );
    let subjects = table(
        &analysis,
        "ranking-virtual-target-identification",
        "subjects",
    );
    assert_eq!(subjects.rows.len(), 7);
    assert_eq!(value(subjects, 0, "trials"), 79.0);
}

fn odd(task: &Task, is_right: bool, grade: Grade) -> Answer {
    let Task::OddOne { odd, .. } = task else {
        panic!("no triad");
    };
    let position = if is_right { *odd } else { (odd + 1) % 3 };
    Answer::Odd { position, grade }
}

#[test]
fn triads_that_are_always_easy_are_all_at_the_ceiling_and_give_no_map() {
    let design = Design::shipped("odd-one-out").unwrap();
    let found: Vec<Found> = (0..4)
        .flat_map(|nth| (1..=3).map(move |session| (nth, session)))
        .map(|who| held(&design, who, |task, _| odd(task, true, Grade::Easy)))
        .collect();
    let analysis = analysed(&found);
    let distances = table(&analysis, "odd-one-out-distances", "distances");
    assert_eq!(
        value(distances, 0, "polyamide_rib"),
        12.0,
        "four subjects, three sessions"
    );
    let map = analysis
        .sections
        .iter()
        .find(|s| s.key == "odd-one-out-map")
        .unwrap();
    assert!(
        map.notes.iter().any(|n| n.contains("No map")),
        "{:?}",
        map.notes
    );
}

#[test]
fn errors_and_weights_of_triads_are_those_by_hand() {
    let design = Design::shipped("odd-one-out").unwrap();
    // Whatever holds the first fabric is missed; the others are normal.
    let answer = |task: &Task, _: usize| {
        let Task::OddOne { items, .. } = task else {
            panic!("no triad");
        };
        odd(task, !items.contains(&0), Grade::Normal)
    };
    let found: Vec<Found> = (0..4).map(|nth| held(&design, (nth, 1), answer)).collect();
    let analysis = analysed(&found);
    let subjects = table(&analysis, "odd-one-out-accuracy", "subjects");
    assert_eq!(
        value(subjects, 0, "right"),
        15.0,
        "21 pairs, 6 with the first"
    );
    let errors = table(&analysis, "odd-one-out-distances", "errors");
    assert_eq!(value(errors, 0, "percent"), 100.0);
    assert!(
        (value(errors, 1, "percent") - 100.0 / 6.0).abs() < 1e-9,
        "one pair of six"
    );
    let distances = table(&analysis, "odd-one-out-distances", "distances");
    let names: Vec<&str> = distances.columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        (value(distances, 0, names[2]), value(distances, 1, names[3])),
        (0.0, 2.0)
    );
    let grades = table(&analysis, "odd-one-out-grades", "grades");
    assert_eq!(value(grades, 1, "count"), 60.0, "right and normal");
    assert_eq!(value(grades, 4, "count"), 24.0, "wrong and normal");
}

fn judged(task: &Task, said: bool, confidence: u8) -> Answer {
    match task {
        Task::Judge { .. } => Answer::Judged {
            is_real: said,
            confidence: Some(confidence),
        },
        Task::JudgePair { real, .. } => Answer::Chosen {
            position: if said { *real } else { 1 - real },
            confidence: None,
        },
        _ => panic!("no judgement"),
    }
}

#[test]
fn sensitivity_of_judgements_is_that_of_their_counts() {
    let design = Design::shipped("real-or-generated").unwrap();
    // Real ones are called real in the first block, generated ones never; the confidence varies.
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, number| {
                let Task::Judge { is_real, .. } = task else {
                    panic!("no judgement");
                };
                let confidence = if number % 2 == 0 { 1 } else { 3 };
                judged(task, *is_real && number < 16, confidence)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let subjects = table(&analysis, "single-judgements-sensitivity", "subjects");
    assert_eq!(
        (value(subjects, 0, "hits"), value(subjects, 0, "n_real")),
        (8.0, 16.0)
    );
    assert_eq!(value(subjects, 0, "false_alarms"), 0.0);
    let rates = [
        value(subjects, 0, "hit_rate"),
        value(subjects, 0, "false_alarm_rate"),
    ];
    assert_eq!(rates, [8.5 / 17.0, 0.5 / 17.0]);
    let d_prime = -crate::statistics::normal_quantile(0.5 / 17.0).unwrap();
    assert!(
        (value(subjects, 0, "d_prime") - d_prime).abs() < 1e-12,
        "{subjects:?}"
    );
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    assert_eq!(anova.rows.len(), 3);
    let cells = table(&analysis, "single-judgements-called-real", "cells");
    let all = cells
        .rows
        .iter()
        .find(|r| r[0] == Cell::Text("all materials, measured, %".to_owned()));
    assert_eq!(all.and_then(|row| row[2].number()), Some(50.0));
}

#[test]
fn complementary_percentages_of_pairs_leave_no_effect_of_material() {
    let text = Design::shipped_text("real-or-generated").unwrap();
    let text = text
        .replace("\"single\"", "\"pair\"")
        .replace("least_trials = 32", "least_trials = 1");
    let design = Design::from_toml(&text, Path::new("pair.toml")).unwrap();
    let mut random = Random::new(3);
    let found: Vec<Found> = (0..5)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                judged(task, random.index(3) > 0, 1)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    assert!(
        matches!(anova.cell(0, "f"), Some(Cell::Undefined(_))),
        "{anova:?}"
    );
    assert!(value(anova, 1, "f") > 0.0, "{anova:?}");
    // With two conditions that add up to 100, t² against 50 is F.
    let tests = table(&analysis, "single-judgements-sensitivity", "tests");
    let (t, f) = (value(tests, 0, "value"), value(anova, 1, "f"));
    assert!((t * t / f - 1.0).abs() < 1e-9, "{t}² and {f}");
}

#[test]
fn missing_cells_of_an_analysis_of_variance_are_refused_with_their_list() {
    let design = Design::shipped("real-or-generated").unwrap();
    let mut found: Vec<Found> = (0..3)
        .map(|nth| held(&design, (nth, 1), |task, n| judged(task, n % 3 == 0, 1)))
        .collect();
    for one in &mut found {
        one.design.rules.least_trials = 0;
    }
    let jute = design
        .stimuli
        .iter()
        .position(|s| s.id == "jute-plain-measured");
    found[1]
        .records
        .retain(|r| !matches!(r.trial.task, Task::Judge { item, .. } if Some(item) == jute));
    let analysis = analysed(&found);
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    let why = anova.cell(0, "remarks");
    let is_listed =
        |t: &str| t.contains("p02") && t.contains("jute-plain") && t.contains("measured");
    assert!(
        matches!(why, Some(Cell::Text(t)) if is_listed(t)),
        "{why:?}"
    );
}

#[test]
fn matched_gains_on_a_line_are_a_compression() {
    let design = Design::shipped("gain-matching").unwrap();
    let library = crate::textile::Library::shipped().unwrap();
    let level = |id: &str| {
        let textile = library.load(id).unwrap();
        let filters = crate::tactile::Filters::default();
        crate::tactile::Levels::of(textile.surface(), &filters)
            .level_db()
            .unwrap()
    };
    let levels: Vec<f64> = design.stimuli.iter().map(|s| level(&s.id)).collect();
    // Alternately 1 dB off either way, subject by subject.
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let Task::Adjust { item, .. } = task else {
                    panic!("no adjustment");
                };
                let off = if nth % 2 == 0 { 1.0 } else { -1.0 };
                Answer::Adjusted {
                    values: vec![3.0 + off - 0.4 * levels[*item]],
                    steps: Vec::new(),
                }
            })
        })
        .collect();
    let analysis = analysed(&found);
    let kappa = table(&analysis, "gain-matching-compression", "kappa");
    for row in 0..5 {
        assert!((value(kappa, row, "kappa") - 0.4).abs() < 1e-9, "{kappa:?}");
    }
    assert!(
        (value(kappa, 4, "gain_at_0_db") - 3.0).abs() < 1e-9,
        "{kappa:?}"
    );
    let stimuli = table(&analysis, "gain-matching-gain-db", "stimuli");
    assert_eq!(value(stimuli, 0, "n"), 8.0);
    assert!(
        (value(stimuli, 0, "mean") - (3.0 - 0.4 * levels[0])).abs() < 1e-9,
        "{stimuli:?}"
    );
    assert!(
        (value(stimuli, 0, "sd") - (8.0_f64 / 7.0).sqrt()).abs() < 1e-9,
        "{stimuli:?}"
    );
}

#[test]
fn numbers_that_follow_a_power_law_give_its_exponent() {
    let design = Design::shipped("magnitude").unwrap();
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let Task::Estimate { item } = task else {
                    panic!("no estimate");
                };
                let Source::Vibration { level_db, .. } = design.stimuli[*item].source else {
                    panic!("no vibration");
                };
                Answer::Magnitude((nth as f64 + 1.0) * factor_of_gain(level_db).powf(0.6))
            })
        })
        .collect();
    let analysis = analysed(&found);
    let exponents = table(&analysis, "magnitude-exponents", "exponents");
    assert_eq!(
        exponents.rows.len(),
        8,
        "three subjects and the group, two bands"
    );
    for row in 0..8 {
        assert!(
            (value(exponents, row, "exponent") - 0.6).abs() < 1e-9,
            "{exponents:?}"
        );
    }
}

/// Trials of a staircase whose observer is right from 5 dB on and wrong below.
fn staircase_session(design: &Design, nth: usize) -> Found {
    let Method::Levels(levels) = &design.method else {
        panic!("no levels");
    };
    let Track::Staircase(track) = &levels.track else {
        panic!("no staircase");
    };
    let mut records = Vec::new();
    for series in 0..track.starts_db.len() {
        let mut staircase: Staircase = levels_of(levels, series);
        for _ in 0..40 {
            let level_db = staircase.stimulus().unwrap();
            let is_right = level_db >= 5.0 - nth as f64;
            staircase.answer(level_db, is_right).unwrap();
            let task = Task::Interval {
                track: series,
                level_db,
                signal: 0,
            };
            let answer = Answer::Chosen {
                position: usize::from(!is_right),
                confidence: None,
            };
            let number = records.len();
            let trial = Trial {
                block: 0,
                number,
                is_practice: false,
                task,
            };
            records.push(record(trial, answer, 5));
        }
    }
    Found {
        log: PathBuf::from(format!("nowhere/{nth}.csv")),
        subject: Subject {
            pseudonym: format!("p{nth}"),
            nth,
            session: 1,
        },
        design: design.clone(),
        records,
        has_torn_row: false,
    }
}

fn levels_of(levels: &Levels, series: usize) -> Staircase {
    let Track::Staircase(track) = &levels.track else {
        panic!("no staircase");
    };
    super::levels::run_again(levels, track, series, &[]).unwrap()
}

#[test]
fn staircases_and_fits_find_the_level_from_which_answers_are_right() {
    let design = Design::shipped("threshold-40").unwrap();
    let found: Vec<Found> = (0..3).map(|nth| staircase_session(&design, nth)).collect();
    let analysis = analysed(&found);
    let fits = table(&analysis, "threshold-40-thresholds", "fits");
    let means = table(&analysis, "threshold-40-staircases", "reversals");
    for nth in 0..3 {
        let edge = 4.5 - nth as f64;
        assert!(
            (value(fits, nth, "threshold_db") - edge).abs() < 1.0,
            "{fits:?}"
        );
        assert!(
            (value(means, 2 * nth, "threshold_db") - edge).abs() < 1.0,
            "{means:?}"
        );
    }
}

#[test]
fn designs_of_one_name_and_two_texts_are_analysed_apart() {
    let mut found = rankings("ranking-virtual-target", [60; 8]);
    let text = Design::shipped_text("ranking-virtual-target").unwrap();
    let other = text.replace("least_trials = 80", "least_trials = 70");
    let other = Design::from_toml(&other, Path::new("other.toml")).unwrap();
    for one in &mut found[4..] {
        one.design = other.clone();
    }
    let analysis = analysed(&found);
    let keys: BTreeMap<&str, usize> = analysis
        .sections
        .iter()
        .map(|s| (s.key.as_str(), 1))
        .collect();
    assert_eq!(keys.len(), analysis.sections.len(), "no two share a key");
    for n in [1, 2] {
        let key = format!("ranking-virtual-target-design-{n}-identification");
        assert_eq!(table(&analysis, &key, "subjects").rows.len(), 4);
    }
}

#[test]
fn a_folder_without_sessions_is_refused_in_one_line() {
    let folder = Scratch::new("empty");
    fs::create_dir_all(&folder.0).unwrap();
    let error = unheard(|progress| analyse_folder(&folder.0, &few(), progress)).unwrap_err();
    let told = error.to_string();
    assert!(
        told.contains("holds no session") && !told.contains('\n'),
        "{told}"
    );
}

struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("selvedge-analysis-{name}-{}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

fn files_of(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap();
    let of = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().unwrap();
        (name, fs::read(entry.path()).unwrap())
    };
    entries.map(|entry| of(entry.unwrap())).collect()
}

/// Whatever may be answered.
fn any_answer(design: &Design, task: &Task, random: &mut Random) -> Answer {
    match task {
        Task::Rank { .. } => {
            let mut ranks = [1, 2, 3, 4];
            random.shuffle(&mut ranks);
            Answer::Ranks(ranks)
        }
        Task::OddOne { .. } => odd(task, random.index(3) == 0, Grade::ALL[random.index(3)]),
        Task::Adjust { starts, .. } => Answer::Adjusted {
            values: starts.clone(),
            steps: Vec::new(),
        },
        Task::Judge { .. } | Task::JudgePair { .. } => judged(task, random.index(2) == 0, 2),
        Task::Interval { .. } => Answer::Chosen {
            position: random.index(2),
            confidence: None,
        },
        Task::Estimate { .. } => Answer::Magnitude(1.0 + random.uniform()),
        Task::Rate { .. } => {
            let Method::Rating(rating) = &design.method else {
                panic!("no rating");
            };
            Answer::Ratings(
                rating
                    .scales
                    .iter()
                    .map(|_| 100.0 * random.uniform())
                    .collect(),
            )
        }
    }
}

fn check_files(found: &[Found], name: &str) {
    let folder = Scratch::new(name);
    analysed(found).write(&folder.0).unwrap();
    let files = files_of(&folder.0);
    assert!(files.contains_key("index.md"), "{name}");
    for (file, bytes) in files.iter().filter(|(file, _)| !file.ends_with(".png")) {
        let text = String::from_utf8_lossy(bytes);
        for never in ["NaN", "nan,", ",inf", "∞"] {
            assert!(!text.contains(never), "{name}: {never} in {file}");
        }
    }
}

#[test]
fn the_same_logs_give_the_same_bytes() {
    let design = Design::shipped("odd-one-out").unwrap();
    let answered = |seed: u64| {
        let mut random = Random::new(seed);
        move |task: &Task, _: usize| odd(task, random.index(3) > 0, Grade::ALL[random.index(3)])
    };
    let all = (0..3).map(|nth| held(&design, (nth, 1), answered(nth as u64)));
    let found: Vec<Found> = all.collect();
    let folders = ["first", "second"].map(Scratch::new);
    for folder in &folders {
        analysed(&found).write(&folder.0).unwrap();
    }
    let [first, second] = folders.each_ref().map(|folder| files_of(&folder.0));
    assert!(first.len() > 30, "{:?}", first.keys());
    assert!(first == second, "other bytes");
}

#[test]
fn one_subject_answering_by_chance_gives_reasons_and_never_nan() {
    for name in Design::shipped_names() {
        let mut design = Design::shipped(name).unwrap();
        // Building the large library is not what is asked here.
        design.library = None;
        let mut random = Random::new(5);
        let own = design.clone();
        let one = held(&design, (0, 1), |task, _| {
            any_answer(&own, task, &mut random)
        });
        check_files(&[one], name);
    }
}

#[test]
fn subjects_who_always_answer_the_same_give_reasons_and_never_nan() {
    for name in [
        "ranking-virtual-target",
        "odd-one-out",
        "real-or-generated",
        "rating",
        "magnitude",
    ] {
        let mut design = Design::shipped(name).unwrap();
        design.library = None;
        let same = |task: &Task, _: usize| match task {
            Task::Rank { .. } => Answer::Ranks([1, 2, 3, 4]),
            Task::OddOne { .. } => Answer::Odd {
                position: 0,
                grade: Grade::Hard,
            },
            Task::Estimate { .. } => Answer::Magnitude(1.0),
            Task::Rate { .. } => Answer::Ratings(vec![50.0; 4]),
            other => judged(other, true, 1),
        };
        let found: Vec<Found> = (0..2).map(|nth| held(&design, (nth, 1), same)).collect();
        check_files(&found, &format!("same-{name}"));
    }
}
