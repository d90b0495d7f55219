//! What trials present: where it lies, what is told of it, and what is played.

use super::*;
use crate::Adapted;
use crate::Procedure;
use crate::design::{Medium, Subject};
use selvedge_engine::{Played, SequenceStep};

fn subject() -> Subject {
    Subject {
        pseudonym: "p01".to_owned(),
        nth: 0,
        session: 1,
    }
}

fn first_task(design: &Design) -> Task {
    let procedure = Procedure::of(design, &subject()).unwrap();
    procedure.trial().unwrap().task.clone()
}

fn is_of_levels(design: &Design) -> bool {
    design.composition.adaptation.is_some()
}

#[test]
fn a_virtual_target_lies_in_the_middle_of_four_and_touches_none() {
    let design = Design::shipped("ranking-virtual-target").unwrap();
    let task = Task {
        items: vec![5, 3, 9, 0],
        reference: Some(3),
        right: Some(1),
        ..Task::default()
    };
    let layout = Layout::of(&design, &task);
    assert_eq!(layout.size_mm, [340.0; 2]);
    let order: Vec<_> = layout
        .places
        .iter()
        .map(|p| (p.stimulus, p.number))
        .collect();
    let expected = [
        (5, Some(1)),
        (3, Some(2)),
        (9, Some(3)),
        (0, Some(4)),
        (3, None),
    ];
    assert_eq!(order, expected);
    let middle = layout.places[4].origin_mm;
    assert_eq!(middle, Point::new(120.0, 120.0));
    for place in &layout.places[..4] {
        let off = place.origin_mm - middle;
        assert!(
            off.x_mm.abs() >= 110.0 && off.y_mm.abs() >= 110.0,
            "{off:?}"
        );
    }
    // 1 is above and left of all others.
    assert_eq!(layout.places[0].origin_mm, Point::new(10.0, 230.0));
}

#[test]
fn scenes_of_trials_make_sense_and_differ_in_what_lies_where_alone() {
    for name in Design::shipped_names() {
        let design = Design::shipped(name).unwrap();
        if is_of_levels(&design) {
            continue;
        }
        let task = first_task(&design);
        let layout = Layout::of(&design, &task);
        let scene = layout.scene(&design, (&Display::default(), Tuning::default()), |_| None);
        scene.check().unwrap();
        let is_played = !sequence(&design, &task).is_empty();
        let is_on_the_table = design.medium == Medium::RealCloth;
        let has_none = is_played || is_on_the_table;
        assert_eq!(scene.textiles.is_empty(), has_none, "{name}");
        for textile in &scene.textiles {
            assert!(textile.label.len() <= 1, "{name}: {:?}", textile.label);
        }
    }
}

#[test]
fn the_experimenter_lays_the_real_target_and_no_number_with_it() {
    let design = Design::shipped("ranking-real-target").unwrap();
    let task = first_task(&design);
    let target = task.reference.unwrap();
    let layout = Layout::of(&design, &task);
    assert_eq!((layout.places.len(), layout.size_mm), (4, [240.0; 2]));
    let laid = on_the_table(&design, &task);
    assert_eq!(laid, [(None, design.stimuli[target].material.clone())]);
    let matching = Design::shipped("gain-matching").unwrap();
    assert_eq!(on_the_table(&matching, &first_task(&matching)).len(), 1);
    let virtual_target = Design::shipped("ranking-virtual-target").unwrap();
    assert!(on_the_table(&virtual_target, &task).is_empty());
}

#[test]
fn intervals_last_as_long_as_the_design_says_and_one_holds_the_signal() {
    let design = Design::shipped("jnd-40").unwrap();
    let presentation = &design.composition.presentation;
    let (track, value) = (0, 30.0);
    let task = Task {
        right: Some(1),
        adapted: Some(Adapted { track, value }),
        ..Task::default()
    };
    let steps = sequence(&design, &task);
    assert_eq!(steps.len(), 2 * presentation.n - 1);
    for (nth, step) in steps.iter().enumerate() {
        let Played::Vibration(amplitude_um) = step.played else {
            panic!("{step:?}")
        };
        let um = f64::from(amplitude_um[0]);
        assert_eq!(amplitude_um[1].to_bits(), 0);
        match nth {
            2 => assert!((um - 31.6228).abs() < 1e-3, "{um}"),
            nth if nth % 2 == 1 => assert!(um.abs() < 1e-9 && step.n_ticks == 12),
            _ => assert!((um - 11.2202).abs() < 1e-3, "{um}"),
        }
        if nth % 2 == 0 {
            assert_eq!(step.n_ticks * 25, presentation.interval_ms);
        }
    }
}

fn written(text: &str) -> Design {
    Design::from_toml(text, std::path::Path::new("a.toml")).unwrap()
}

/// The gains of a task's scene, and what is played in it.
fn in_turn(design: &Design, task: &Task) -> (Vec<f64>, Vec<SequenceStep>) {
    let layout = Layout::of(design, task);
    assert!(layout.is_stacked());
    assert_eq!(layout.size_mm, Layout::empty().size_mm);
    let scene = layout.scene(design, (&Display::default(), Tuning::default()), |_| None);
    scene.check().unwrap();
    let gains_db = scene.textiles.iter().map(|placed| placed.gain_db);
    (gains_db.collect(), sequence(design, task))
}

fn uncovering(textiles: &[usize], n_ticks: u32) -> Vec<SequenceStep> {
    let step = |textile: &usize| SequenceStep {
        played: Played::Textile(*textile),
        n_ticks,
    };
    let steps: Vec<Vec<SequenceStep>> = textiles.iter().map(|one| vec![step(one)]).collect();
    steps.join(&SequenceStep::silence(12))
}

#[test]
fn cloths_in_intervals_lie_upon_each_other_and_are_uncovered_in_turn() {
    let design = written(include_str!(
        "../analysis/tests/designs/roughness-intervals.toml"
    ));
    let task = Task {
        items: vec![3, 0],
        right: Some(0),
        ..Task::default()
    };
    let (gains_db, steps) = in_turn(&design, &task);
    assert_eq!(gains_db.len(), 2);
    assert_eq!(steps, uncovering(&[0, 1], 80));
    let numbers = Layout::of(&design, &task).places;
    let numbers: Vec<_> = numbers.iter().map(|p| (p.stimulus, p.number)).collect();
    assert_eq!(numbers, [(3, Some(1)), (0, Some(2))]);
}

#[test]
fn what_is_adapted_in_intervals_is_adapted_in_one_of_them() {
    let design = written(include_str!(
        "../analysis/tests/designs/gain-intervals.toml"
    ));
    let (track, value) = (0, 7.5);
    let task = Task {
        items: vec![0; 2],
        right: Some(1),
        adapted: Some(Adapted { track, value }),
        ..Task::default()
    };
    let (gains_db, steps) = in_turn(&design, &task);
    assert_eq!(gains_db, [0.0, 7.5]);
    assert_eq!(steps, uncovering(&[0, 1], 120));
}

#[test]
fn what_intervals_are_compared_with_is_uncovered_first() {
    let text = include_str!("../analysis/tests/designs/abx.toml");
    let design = written(&text.replace("\"places\"", "\"intervals\""));
    let task = first_task(&design);
    let (gains_db, steps) = in_turn(&design, &task);
    assert_eq!(gains_db.len(), 3);
    assert_eq!(steps, uncovering(&[2, 0, 1], 120));
    let places = Layout::of(&design, &task).places;
    assert_eq!(places[2].stimulus, task.reference.unwrap());
    assert_eq!(places[2].number, None);
}
