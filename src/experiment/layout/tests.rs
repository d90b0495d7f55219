//! What trials present: where it lies, what is told of it, and what is played.

use super::*;
use crate::Adapted;
use crate::Procedure;
use crate::design::{Medium, Subject};

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
        let is_played = !vibrations(&design, &task).is_empty();
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
    let steps = vibrations(&design, &task);
    assert_eq!(steps.len(), 2 * presentation.n - 1);
    for (nth, step) in steps.iter().enumerate() {
        let um = f64::from(step.amplitude_um[0]);
        assert_eq!(step.amplitude_um[1].to_bits(), 0);
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
