//! What trials present: where it lies, what is told of it, and what is played.

use super::*;
use crate::Procedure;
use crate::design::{Medium, Subject};
use crate::trial::Adapted;
use selvedge_engine::{Played, SequenceStep};
use selvedge_render::RenderScene;
use selvedge_render::scene::LoadedScene;
use selvedge_textile::Library;
use std::path::Path;
use std::sync::Arc;

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
    let laid = Layout::on_the_table(&design, &task);
    assert_eq!(laid, [(None, design.stimuli[target].material.clone())]);
    let matching = Design::shipped("gain-matching").unwrap();
    assert_eq!(
        Layout::on_the_table(&matching, &first_task(&matching)).len(),
        1
    );
    let virtual_target = Design::shipped("ranking-virtual-target").unwrap();
    assert!(Layout::on_the_table(&virtual_target, &task).is_empty());
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
    Design::from_toml(text, Path::new("a.toml")).unwrap()
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

/// A design in which one number of one stimulus is adapted, and a trial of it: the second is at
/// `value`.
fn adapted(lines: [&str; 3], value: f64) -> (Design, Task) {
    let [stimulus, presentation, adaptation] = lines;
    let text = format!(
        "study = \"s\"\nexperiment = \"e\"\nmedium = \"array\"\nseed = 1\n[[stimulus]]\n\
         id = \"jute-plain\"\n{stimulus}\n[presentation]\nkind = \"{presentation}\"\n\
         [response]\nkind = \"choice\"\n[adaptation]\n{adaptation}\n[adaptation.constant]\n\
         values = [{value:?}]\nrepeats = 2\n"
    );
    let design = Design::from_toml(&text, Path::new("a.toml")).unwrap();
    let task = Task {
        items: vec![0, 0],
        right: Some(1),
        adapted: Some(Adapted { track: 0, value }),
        ..Task::default()
    };
    (design, task)
}

fn scene_of(design: &Design, task: &Task) -> Scene {
    let tuning = Tuning {
        gain_320_db: -1.0,
        ..Tuning::default()
    };
    let layout = Layout::of(design, task);
    let scene = layout.scene(design, (&Display::default(), tuning), |_| None);
    scene.check().unwrap();
    scene
}

#[test]
fn the_gain_of_a_band_is_each_places_own() {
    let adaptation = "parameter = \"gain_320_db\"\nreference = 0.5\nrange = [1.0, 9.0]";
    let (design, task) = adapted(
        ["gain_db = 2.0\ngain_40_db = -3.0", "pair", adaptation],
        4.0,
    );
    let scene = scene_of(&design, &task);
    let own = |textile: &PlacedTextile| [textile.gain_db, textile.gain_40_db, textile.gain_320_db];
    let gains_db: Vec<[f64; 3]> = scene.textiles.iter().map(own).collect();
    assert_eq!(gains_db, [[2.0, -3.0, 0.5], [2.0, -3.0, 4.0]]);
    let text = scene.to_toml().unwrap();
    assert_eq!(Scene::from_toml(&text, Path::new("a")).unwrap(), scene);
    let library = Arc::new(Library::shipped().unwrap());
    let rendered = RenderScene::of(&LoadedScene::load(scene, library).unwrap());
    let bands_db = rendered.textiles.iter().map(|one| one.scene_band_gains_db);
    assert_eq!(bands_db.collect::<Vec<_>>(), [[-3.0, 0.5], [-3.0, 4.0]]);
    assert_eq!(rendered.tuning.gain_320_db, -1.0, "that of all stays");
}

#[test]
fn a_turned_textile_fills_its_place_and_no_more() {
    let adaptation = "parameter = \"rotation_deg\"\nreference = 0.0\nrange = [1.0, 180.0]";
    for turn_deg in [1.0, 30.0, 45.0, 90.0, 137.0, 180.0] {
        let (design, task) = adapted(["", "pair", adaptation], turn_deg);
        let scene = scene_of(&design, &task);
        let [flat, turned] = &scene.textiles[..] else {
            panic!("two")
        };
        assert_eq!((flat.rotation_deg, flat.within_mm), (0.0, None));
        assert_eq!(turned.rotation_deg, turn_deg);
        let corner = Layout::of(&design, &task).places[1].origin_mm;
        let middle = corner + Displacement::new(50.0, 50.0);
        let own = turned.workspace_from_textile().into_point(middle);
        let half_mm = 0.5 * turned.size_mm[0];
        let off = own - Point::new(half_mm, half_mm);
        assert!(
            off.length_mm() < 1e-9,
            "it is turned about its middle: {off:?}"
        );
        for step in 0..=50 {
            let along = f64::from(step) * 2.0;
            let edges = [(along, 0.0), (0.0, along), (along, 99.999), (99.999, along)];
            for (x_mm, y_mm) in edges {
                let at = corner + Displacement::new(x_mm.min(99.999), y_mm.min(99.999));
                assert_eq!(scene.textile_at(at), Some(1), "{turn_deg}°: {at:?}");
                let from_middle = at - middle;
                let [x_mm, y_mm] = [from_middle.x_mm, from_middle.y_mm].map(|mm| 1.001 * mm);
                let outside = middle + Displacement::new(x_mm, y_mm);
                assert_eq!(scene.textile_at(outside), None, "{turn_deg}°: {outside:?}");
            }
        }
    }
    let (alone, task) = adapted(["rotation_deg = 10.0", "pair", adaptation], 30.0);
    let turns = scene_of(&alone, &task).textiles.into_iter();
    let turns: Vec<f64> = turns.map(|one| one.rotation_deg).collect();
    assert_eq!(turns, [10.0, 40.0], "on top of its own");
}

#[test]
fn an_adapted_length_is_that_of_its_interval() {
    let adaptation = "parameter = \"duration_ms\"\nreference = 200.0\nrange = [225.0, 900.0]";
    let stimulus = "band_hz = 320\nlevel_db = 0.0";
    let (design, task) = adapted([stimulus, "intervals", adaptation], 425.0);
    let steps = sequence(&design, &task);
    let n_ticks: Vec<u32> = steps.iter().map(|step| step.n_ticks).collect();
    assert_eq!(n_ticks, [8, 12, 17]);
    let um = steps.iter().map(|step| step.played);
    let played = [[0.0, 1.0], [0.0; 2], [0.0, 1.0]].map(Played::Vibration);
    assert_eq!(um.collect::<Vec<_>>(), played);
}
