//! Observers: those that cannot tell guess, those that can tell are right, and what they are told
//! is what comes out.

use std::collections::BTreeMap;
use std::path::Path;

use super::*;
use crate::design::{Design, Source, Stimulus};
use crate::{AnswerValue, Record, Simulation, simulated_subject};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::{factor_of_gain, level_db};
use selvedge_statistics::{mean, spearman};
use selvedge_textile::tactile::{Band, Levels, Tuning};

/// Levels of the sixteen on a grid of 4 by 4, 6 dB apart; of others by their names.
fn levels_of(ids: &[String], id: &str) -> Levels {
    let nth = ids.iter().position(|known| known == id).unwrap_or(0);
    let db = |n: usize| 10.0 + 6.0 * n as f64;
    let mean_um = [factor_of_gain(db(nth % 4)), factor_of_gain(db(nth / 4))];
    let turn = 1.0 + 0.3 * (nth % 3) as f64;
    let [warp, weft] = [turn, 1.0].map(|by| mean_um.map(|um| um * by));
    Levels {
        mean_um,
        cv: [0.1 * (nth % 5) as f64, 0.2],
        anisotropy_db: [0.0; 2],
        direction_mean_um: [warp, warp, weft, weft],
    }
}

/// What the stimuli are made of; those that are made of nothing by their own names.
fn ids(design: &Design) -> Vec<String> {
    let of = |stimulus: &Stimulus| match &stimulus.source {
        Source::Textile { id, .. } | Source::RealCloth(id) => id.clone(),
        Source::Vibration { .. } => stimulus.id.clone(),
    };
    design.stimuli.iter().map(of).collect()
}

pub(crate) fn stimuli(design: &Design) -> Stimuli {
    let known = ids(design);
    let of = |id: &str| Some((levels_of(&known, id), 0.0));
    Stimuli::from_levels(design, Tuning::default(), of).unwrap()
}

fn records_of(design: &Design, stimuli: &Stimuli, observer: &Observer, n: usize) -> Vec<Record> {
    let simulation = Simulation {
        design,
        stimuli,
        observer,
        seed: 7,
    };
    let of = |nth: usize| simulation.records(&simulated_subject(nth, 1)).unwrap();
    let all = (0..n).flat_map(of);
    all.filter(|record| !record.trial.is_practice).collect()
}

fn records(design: &Design, observer: &Observer, n: usize) -> Vec<Record> {
    records_of(design, &stimuli(design), observer, n)
}

/// The share of right answers, and how many trials there were.
fn share(records: &[Record]) -> (f64, f64) {
    let right = records.iter().filter(|r| r.is_correct == Some(true));
    let n = records.len() as f64;
    (right.count() as f64 / n, n)
}

/// Four standard errors of a share.
fn bound(share: f64, n: f64) -> f64 {
    4.0 * (share * (1.0 - share) / n).sqrt()
}

fn shipped(name: &str) -> Design {
    Design::shipped(name).unwrap()
}

fn fixed(jnd_db: f64) -> Observer {
    Observer {
        jnd: Jnd::Fixed([jnd_db; 2]),
        ..Observer::default()
    }
}

#[test]
fn without_anything_to_go_by_a_quarter_of_rankings_and_a_third_of_triads_are_right() {
    let guesser = Observer {
        strategy: Strategy::None,
        ..Observer::default()
    };
    for observer in [guesser, fixed(1e6)] {
        for (name, n, chance) in [
            ("ranking-virtual-target", 40, 0.25),
            ("ranking-real-target", 40, 0.25),
            ("odd-one-out", 100, 1.0 / 3.0),
            ("real-or-generated", 60, 0.5),
        ] {
            let (found, n) = share(&records(&shipped(name), &observer, n));
            let within = bound(chance, n);
            assert!((found - chance).abs() < within, "{name}: {found}");
        }
    }
}

#[test]
fn without_noise_all_is_right() {
    for strategy in [Strategy::LevelOnly, Strategy::All] {
        let observer = Observer {
            strategy,
            ..fixed(1e-3)
        };
        for name in [
            "ranking-virtual-target",
            "ranking-real-target",
            "odd-one-out",
        ] {
            let (found, _) = share(&records(&shipped(name), &observer, 2));
            assert_eq!(found, 1.0, "{name}");
        }
    }
}

#[test]
fn the_smaller_the_difference_that_is_noticed_the_more_is_recognised() {
    let design = shipped("ranking-virtual-target");
    let found = [30.0, 8.0, 3.0, 1.0].map(|jnd| share(&records(&design, &fixed(jnd), 8)).0);
    assert!(found.windows(2).all(|p| p[0] + 0.05 < p[1]), "{found:?}");
}

#[test]
fn more_looks_are_less_noise_but_not_in_intervals() {
    let design = shipped("ranking-virtual-target");
    let looking = |looks: u32| Observer {
        looks,
        ..fixed(6.0)
    };
    let found = [1, 4, 16].map(|looks| share(&records(&design, &looking(looks), 8)).0);
    assert!(found.windows(2).all(|p| p[0] + 0.05 < p[1]), "{found:?}");
    // Half the difference is noticed with four looks.
    let (halved, n) = share(&records(&design, &fixed(3.0), 8));
    assert!(
        (found[1] - halved).abs() < bound(halved, n),
        "{found:?} {halved}"
    );
    let threshold = constant("intervals = 2", -20.0, 8.0);
    let answers = |looks: u32| -> Vec<_> {
        let records = records(&threshold, &looking(looks), 1);
        records.into_iter().map(|record| record.outcome).collect()
    };
    assert_eq!(answers(1), answers(16));
}

#[test]
fn more_noise_of_any_kind_is_fewer_right() {
    let design = shipped("ranking-virtual-target");
    let plain = fixed(3.0);
    let (best, _) = share(&records(&design, &plain, 10));
    for observer in [
        Observer {
            rank_noise_jnd: 4.0,
            ..plain
        },
        Observer {
            memory_noise_jnd: 4.0,
            ..plain
        },
        Observer {
            lapse: 0.3,
            ..plain
        },
    ] {
        let (found, _) = share(&records(&design, &observer, 10));
        assert!(found + 0.05 < best, "{observer:?}: {found} of {best}");
    }
    let real = shipped("ranking-real-target");
    let (best, _) = share(&records(&real, &plain, 10));
    let wrong = Observer {
        real_error_db: 8.0,
        ..plain
    };
    let (found, _) = share(&records(&real, &wrong, 10));
    assert!(found + 0.05 < best, "a bad model: {found} of {best}");
    // Virtual targets know of no real cloth.
    assert_eq!(records(&design, &wrong, 1), records(&design, &plain, 1));
}

#[test]
fn lapses_cost_three_quarters_of_their_share() {
    let observer = Observer {
        lapse: 0.2,
        ..fixed(1e-3)
    };
    let (found, n) = share(&records(&shipped("ranking-virtual-target"), &observer, 40));
    assert!((found - 0.85).abs() < bound(0.85, n), "{found}");
}

#[test]
fn ranks_recover_how_far_apart_levels_are() {
    let design = shipped("ranking-virtual-target");
    let stimuli = stimuli(&design);
    let observer = fixed(3.0);
    let mut ranks: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    for record in records_of(&design, &stimuli, &observer, 40) {
        let (Some(target), Some(AnswerValue::Ranks(given))) =
            (record.trial.task.reference, record.value())
        else {
            panic!("{record:?} is no ranking");
        };
        for (&item, &rank) in record.trial.task.items.iter().zip(given) {
            if item != target {
                let pair = (item.min(target), item.max(target));
                ranks.entry(pair).or_default().push(f64::from(rank));
            }
        }
    }
    assert_eq!(ranks.len(), 120);
    let away = |&(a, b): &(usize, usize)| {
        let db = |item: usize| stimuli.felt_um(item).map(level_db);
        let ([a40, a320], [b40, b320]) = (db(a), db(b));
        (a40 - b40).hypot(a320 - b320)
    };
    let distances: Vec<f64> = ranks.keys().map(away).collect();
    let means: Vec<f64> = ranks.values().map(|r| mean(r).unwrap()).collect();
    let outcome = spearman(&distances, &means).unwrap();
    let r = outcome.effect.as_ref().map_or(0.0, |effect| effect.value);
    assert!(r > 0.85, "{outcome:?}");
}

/// A design of one level at 40 Hz above a pedestal or silence.
fn constant(reference: &str, least_db: f64, level_db: f64) -> Design {
    let text = format!(
        "study = \"s\"\nexperiment = \"e\"\nmedium = \"array\"\nseed = 1\n[levels]\nband_hz = 40\n\
         {reference}\nrange_db = [{least_db:?}, 60.0]\n[levels.constant]\n\
         levels_db = [{level_db:?}]\nrepeats = 1000\n"
    );
    Design::from_toml(&text, Path::new("constant.toml")).unwrap()
}

#[test]
fn at_threshold_and_one_difference_above_a_pedestal_three_of_four_are_right() {
    let threshold_db = Band::Low.detection_threshold_db(24);
    let pedestal_db = threshold_db + 30.0;
    for observer in [Observer::default(), fixed(1.5)] {
        let jnd_db = observer.jnd.at_db(Band::Low, 30.0);
        let reference = format!("intervals = 2\nreference_db = {pedestal_db:?}");
        for design in [
            constant("intervals = 2", -20.0, threshold_db),
            constant(&reference, pedestal_db, pedestal_db + jnd_db),
        ] {
            let (found, n) = share(&records(&design, &observer, 5));
            // The published difference falls a little on the way up.
            assert!((found - 0.75).abs() < bound(0.75, n) + 0.005, "{found}");
        }
    }
    let silent = constant("intervals = 3", -20.0, threshold_db - 20.0);
    let (found, n) = share(&records(&silent, &Observer::default(), 3));
    assert!((found - 1.0 / 3.0).abs() < bound(1.0 / 3.0, n), "{found}");
}

#[test]
fn gains_are_turned_to_what_the_library_s_tuning_gives() {
    let design = shipped("gain-matching");
    let known = ids(&design);
    let of = |id: &str| Some((levels_of(&known, id), 0.0));
    let tuning = Tuning {
        gain_db: 2.0,
        compression: 0.5,
        compression_reference_db: Some(19.0),
        ..Tuning::default()
    };
    let stimuli = Stimuli::from_levels(&design, tuning, of).unwrap();
    for record in records_of(&design, &stimuli, &fixed(0.01), 2) {
        let (Some(item), Some(AnswerValue::Adjusted { values, steps })) =
            (record.trial.task.item(), record.value())
        else {
            panic!("{record:?} is no adjustment");
        };
        let level = levels_of(&known, &known[item]).level_db().unwrap();
        let expected = 2.0 - 0.5 * (level - 19.0);
        assert!(
            (values[0] - expected).abs() <= 0.5 + 1e-9,
            "{values:?} for {expected}"
        );
        assert!(
            steps.windows(2).all(|p| p[0].at_ms <= p[1].at_ms),
            "{steps:?}"
        );
        assert!(
            steps.last().is_none_or(|step| step.value == values[0]),
            "the last stays"
        );
        let response_ms = record.timing.response_ms();
        assert!(
            steps.iter().all(|step| step.at_ms < response_ms),
            "{steps:?}"
        );
    }
}

#[test]
fn where_turning_begins_shows_in_where_it_ends() {
    let design = shipped("gain-matching");
    let mut ends = [Vec::new(), Vec::new()];
    for record in records(&design, &Observer::default(), 20) {
        if let Some(AnswerValue::Adjusted { values, .. }) = record.value() {
            ends[usize::from(record.trial.task.starts[0] > 0.0)].push(values[0]);
        }
    }
    let [low, high] = ends.map(|values| mean(&values).unwrap());
    assert!(low + 0.5 < high, "{low} from below, {high} from above");
}

#[test]
fn numbers_for_strengths_rise_by_the_exponents_of_the_model() {
    let design = shipped("magnitude");
    let observer = Observer {
        habits: Habits {
            exponent_spread: 0.0,
            modulus_spread: 0.0,
            magnitude_noise: 1e-9,
            ..Habits::default()
        },
        ..Observer::default()
    };
    let mut given = BTreeMap::new();
    for record in records(&design, &observer, 1) {
        if let (Some(item), Some(AnswerValue::Number(value))) =
            (record.trial.task.item(), record.value())
        {
            given.insert(design.stimuli[item].id.as_str(), *value);
        }
    }
    // Six decibels each, well above threshold.
    let slope = |low: &str, high: &str, db: f64| (given[high] / given[low]).log10() * 20.0 / db;
    let (low, high) = (
        slope("40-hz-12-db", "40-hz-30-db", 18.0),
        slope("320-hz-0-db", "320-hz-18-db", 18.0),
    );
    assert!(
        (low - 0.95).abs() < 1e-6 && (high - 0.58).abs() < 1e-6,
        "{low}, {high}"
    );
}

#[test]
fn ratings_stay_on_their_scales_and_follow_the_stimuli() {
    let design = shipped("rating");
    let mut by_item = vec![Vec::new(); design.stimuli.len()];
    for record in records(&design, &fixed(1.0), 8) {
        if let (Some(item), Some(AnswerValue::Ratings(values))) =
            (record.trial.task.item(), record.value())
        {
            assert!(
                values.iter().all(|v| (0.0..=100.0).contains(v)),
                "{values:?}"
            );
            by_item[item].push(values[0]);
        }
    }
    let means: Vec<f64> = by_item.iter().map(|values| mean(values).unwrap()).collect();
    let range =
        means.iter().copied().fold(0.0, f64::max) - means.iter().copied().fold(100.0, f64::min);
    assert!(range > 20.0, "{means:?}");
}

#[test]
fn an_answer_does_not_depend_on_what_came_before() {
    let design = shipped("ranking-virtual-target");
    let (stimuli, observer) = (stimuli(&design), Observer::default());
    let subject = simulated_subject(3, 1);
    let participant = Participant::new((&design, &stimuli), &observer, 5, &subject);
    let simulation = Simulation {
        design: &design,
        stimuli: &stimuli,
        observer: &observer,
        seed: 5,
    };
    let records = simulation.records(&subject).unwrap();
    for record in records.iter().rev() {
        let reply = participant.answer(&record.trial, 1);
        assert_eq!(Some(&reply.answer), record.answer());
    }
    let again = participant.answer(&records[0].trial, 2);
    assert_ne!(
        again.response_s,
        participant.answer(&records[0].trial, 1).response_s
    );
}

#[test]
fn what_no_observer_can_have_is_refused() {
    let plain = Observer::default();
    for wrong in [
        Observer {
            lapse: 1.5,
            ..plain
        },
        Observer {
            lapse: f64::NAN,
            ..plain
        },
        Observer {
            rank_noise_jnd: -1.0,
            ..plain
        },
        Observer {
            real_error_db: f64::INFINITY,
            ..plain
        },
        Observer { looks: 0, ..plain },
        fixed(0.0),
        fixed(f64::NAN),
    ] {
        assert!(wrong.check().is_err(), "{wrong:?}");
    }
    assert!(plain.check().is_ok(), "the default is fine");
}

#[test]
fn under_a_stylus_force_alone_is_silent_and_vibration_is_felt_within_the_arrays_limits() {
    let design = shipped("force-or-vibration");
    let library = design.open_library(Path::new(""), None).unwrap();
    let stimuli = Progress::unheard(|progress| Stimuli::of(&design, &library, progress)).unwrap();
    let felt_um: Vec<[f64; 2]> = (0..6).map(|item| stimuli.felt_um(item)).collect();
    for (nth, um) in felt_um.iter().enumerate() {
        let is_force = nth % 2 == 1;
        let is_felt = um[0] > 0.2 && um.iter().all(|um| *um < 20.0);
        assert!(
            if is_force { *um == [0.0; 2] } else { is_felt },
            "{felt_um:?}"
        );
    }
    // The rougher of them vibrates more: sandpaper of 59 µm, cardboard of 11 µm.
    assert!(felt_um[2][1] > 2.0 * felt_um[4][1], "{felt_um:?}");
    let (right, n) = share(&records_of(&design, &stimuli, &Observer::default(), 4));
    assert!(
        n == 72.0 && right > 0.7,
        "{right}: what is felt is told from silence"
    );
}
