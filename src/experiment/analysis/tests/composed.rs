//! Designs that nothing but their text composes: held by simulated observers, written, read back
//! and analysed.

use super::*;
use crate::observer::{Jnd, Observer, tests::stimuli};
use crate::session::Found;
use crate::simulate::Simulation;
use selvedge_scratch::ScratchFolder as Scratch;

/// A design, trials of a session that count, and a table that its analysis has to have.
struct Composed {
    name: &'static str,
    text: &'static str,
    n_trials: usize,
    /// Section, table and rows of it.
    found: (&'static str, &'static str, usize),
}

macro_rules! composed {
    ($($name:literal: $n:literal => $section:literal, $table:literal, $rows:literal;)*) => {
        [$(Composed {
            name: $name,
            text: include_str!(concat!("designs/", $name, ".toml")),
            n_trials: $n,
            found: ($section, $table, $rows),
        },)*]
    };
}

const N_OBSERVERS: usize = 6;

/// Rows of subjects: all of them.
const COMPOSED: [Composed; 21] = composed! {
    "roughness-2afc": 42 => "choices", "subjects", 6;
    "abx": 84 => "choices", "subjects", 6;
    "triangle": 42 => "choices", "subjects", 6;
    "best-worst": 20 => "scores", "scores", 16;
    "dissimilarity": 46 => "unlike", "pairs", 21;
    "free-sorting": 1 => "piles", "together", 16;
    "magnitude-standard": 15 => "exponents", "exponents", 7;
    "magnitude-textiles": 8 => "exponents", "means", 4;
    "equality-constant": 84 => "thresholds", "fits", 6;
    "compression-staircase": 0 => "thresholds", "fits", 6;
    "same-different": 84 => "choices", "subjects", 6;
    "gain-yes-no": 60 => "thresholds", "fits", 6;
    "preference": 42 => "scales", "stimuli-scales", 7;
    "ranked-threes": 14 => "scores", "scores", 7;
    "roughness-intervals": 42 => "choices", "subjects", 6;
    "triangle-intervals": 42 => "choices", "subjects", 6;
    "gain-intervals": 0 => "thresholds", "fits", 6;
    "masked-threshold": 40 => "thresholds", "fits", 6;
    "gain-320-quest-plus": 60 => "thresholds", "fits", 6;
    "rotation-staircase": 120 => "thresholds", "fits", 6;
    "duration-constant": 90 => "thresholds", "fits", 6;
};

fn design(one: &Composed) -> Design {
    Design::from_toml(one.text, Path::new(one.name)).unwrap()
}

#[test]
fn every_composition_is_held_read_back_and_analysed() {
    for one in &COMPOSED {
        let design = design(one);
        let folder = Scratch::new(one.name);
        let observer = Observer::default();
        let stimuli = stimuli(&design);
        let simulation = Simulation {
            design: &design,
            stimuli: &stimuli,
            observer: &observer,
            seed: 3,
        };
        Progress::unheard(|progress| simulation.write(&folder.0, (N_OBSERVERS, 1), progress))
            .unwrap();
        let (found, unread) = Found::in_folder(&folder.0).unwrap();
        assert!(unread.is_empty(), "{}: {unread:?}", one.name);
        for session in &found {
            let held = simulation.records(&session.subject).unwrap();
            assert_eq!(session.records, held, "{}: as it was answered", one.name);
            if one.n_trials > 0 {
                assert_eq!(held.len(), one.n_trials, "{}", one.name);
            }
        }
        let analysis = analysed(&found);
        let (section, key, n_rows) = one.found;
        let section = format!("{}-{section}", design.experiment);
        assert_eq!(
            table(&analysis, &section, key).rows.len(),
            n_rows,
            "{}",
            one.name
        );
    }
}

/// What observers answer in a design of these, analysed.
fn analysed_of(name: &str) -> (Design, Analysis) {
    answered_by(&Observer::default(), N_OBSERVERS, name)
}

fn answered_by(observer: &Observer, n_observers: usize, name: &str) -> (Design, Analysis) {
    let one = COMPOSED.iter().find(|one| one.name == name).unwrap();
    let design = design(one);
    let stimuli = stimuli(&design);
    let simulation = Simulation {
        design: &design,
        stimuli: &stimuli,
        observer,
        seed: 3,
    };
    let held = |nth| {
        let subject = crate::simulated_subject(nth, 1);
        let records = simulation.records(&subject).unwrap();
        let log = PathBuf::from(format!("nowhere/{nth}.csv"));
        Found::of_records(log, (&design, subject), records)
    };
    let found: Vec<Found> = (0..n_observers).map(held).collect();
    let analysis = analysed(&found);
    (design, analysis)
}

#[test]
fn answers_say_what_observers_feel() {
    // Equality lies at the reference, 24 dB: at a difference of nothing.
    let (_, analysis) = analysed_of("equality-constant");
    let group = table(&analysis, "equality-constant-thresholds", "group");
    let pse = value(group, 0, "mean");
    assert!(pse.abs() < 0.8, "{pse}");
    // Two that are the same are less unlike than any two others, and apart in no pile.
    for (name, section, percent) in [
        ("abx", "abx-choices", 50.0),
        ("triangle", "triangle-choices", 100.0 / 3.0),
        ("same-different", "same-different-choices", 50.0),
        ("roughness-2afc", "roughness-2afc-choices", 50.0),
        ("roughness-intervals", "roughness-intervals-choices", 50.0),
        (
            "triangle-intervals",
            "triangle-intervals-choices",
            100.0 / 3.0,
        ),
    ] {
        let (_, analysis) = analysed_of(name);
        let group = table(&analysis, section, "group");
        let (right, d_prime) = (value(group, 0, "mean"), value(group, 1, "mean"));
        assert!(
            right > percent + 10.0 && d_prime > 0.5,
            "{name}: {right} %, d′ {d_prime}"
        );
    }
    // The design lists what is asked from the least to the most, as the observers have it.
    let (design, analysis) = analysed_of("best-worst");
    let scores = table(&analysis, "best-worst-scores", "scores");
    let last = design.stimuli.len() - 1;
    assert!(
        value(scores, last, "mean") > value(scores, 0, "mean"),
        "{scores:?}"
    );
}

#[test]
fn what_observers_just_notice_of_any_parameter_is_found_in_its_unit() {
    let observer = Observer {
        jnd: Jnd::Fixed([2.0; 2]),
        ..Observer::default()
    };
    // One of two coordinates is moved; two turns 10° apart are told apart three times in four, and
    // so are 300 ms and a fifth more.
    for (name, jnd, key, what) in [
        (
            "gain-320-quest-plus",
            8.0_f64.sqrt(),
            "threshold_db",
            "just noticeable difference (75 % right), dB",
        ),
        (
            "rotation-staircase",
            10.0,
            "threshold_deg",
            "just noticeable difference (75 % right), °",
        ),
        (
            "duration-constant",
            60.0,
            "threshold_ms",
            "just noticeable difference (75 % right), ms",
        ),
    ] {
        let (design, analysis) = answered_by(&observer, 40, name);
        let section = format!("{name}-thresholds");
        let found = value(table(&analysis, &section, "group"), 0, "mean");
        assert!(
            (found / jnd - 1.0).abs() < 0.1,
            "{name}: {found}, not {jnd}"
        );
        let fits = table(&analysis, &section, "fits");
        assert!(
            value(fits, 0, key) > 0.0 && fits.title.starts_with(what),
            "{}",
            fits.title
        );
        let unit = design.composition.adaptation.unwrap().parameter.unit();
        let page = analysis.page();
        assert!(page.contains(unit), "{page}");
    }
}

#[test]
fn a_catch_trial_shows_the_same_twice_and_does_not_count() {
    let one = COMPOSED
        .iter()
        .find(|one| one.name == "dissimilarity")
        .unwrap();
    let design = design(one);
    let found = held(&design, (0, 1), |task, _| {
        let is_same = task.items[0] == task.items[1];
        assert_eq!(task.is_catch, is_same);
        AnswerValue::Ratings(vec![if is_same { 1.0 } else { 50.0 }]).into()
    });
    let n_catch = found
        .records
        .iter()
        .filter(|r| r.trial.task.is_catch)
        .count();
    assert_eq!(n_catch, 4, "two in each of two blocks");
    let pairs = analysed(&[found]);
    let pairs = table(&pairs, "dissimilarity-unlike", "pairs");
    assert!(
        (0..21).all(|row| value(pairs, row, "mean") == 1.0),
        "all as unlike: {pairs:?}"
    );
}

#[test]
fn who_misses_more_catch_trials_than_the_rules_allow_is_left_out() {
    let one = COMPOSED.iter().find(|one| one.name == "dissimilarity");
    let scaled = format!("{}\n[rules]\nleast_share_caught = 0.5\n", one.unwrap().text);
    let response = scaled.find("[response]").unwrap()..scaled.find("[order]").unwrap();
    let mut numbered = scaled.clone();
    numbered.replace_range(response, "[response]\nkind = \"number\"\n\n");
    let rating = |unlike: f64| AnswerValue::Ratings(vec![unlike]).into();
    let number = |unlike: f64| AnswerValue::Number(unlike).into();
    let answers = [(scaled, rating as fn(f64) -> Answer), (numbered, number)];
    for (text, answer) in answers {
        let design = Design::from_toml(&text, Path::new("caught.toml")).unwrap();
        // Of four catch trials the first answers two rightly, the second one.
        let of_subject = |nth: usize| {
            let mut n_caught = 0;
            held(&design, (nth, 1), |task, number| {
                if !task.is_catch {
                    return answer(40.0 + number as f64);
                }
                n_caught += 1;
                answer(if n_caught > 2 - nth { 90.0 } else { 1.0 })
            })
        };
        let found: Vec<Found> = (0..2).map(of_subject).collect();
        let analysis = analysed(&found);
        let left_out = table(&analysis, "dissimilarity-sessions", "left-out");
        assert_eq!(left_out.rows.len(), 1, "{left_out:?}");
        let why = "1 of 4 catch trials right, less than 50 %";
        assert_eq!(left_out.cell(0, "subject"), Some(&"p02".into()));
        assert_eq!(left_out.cell(0, "why"), Some(&why.into()));
        let page = analysis.page();
        let rule = "a subject with less than 50 % of the catch trials right is left out";
        assert!(page.contains(rule), "{page}");
    }
}
