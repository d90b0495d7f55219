//! What comes of a choice, and how a comparison begins, ends and goes stale.

use std::sync::Arc;

use super::*;
use crate::bench::command::ShowCommand;
use crate::bench::gain_set::GainSet;
use crate::bench::recording::tests::two_apart;
use crate::tools::compare::choice::TuningChoice;
use crate::tools::compare::export::over_time_chart;
use selvedge_foundation::geometry::Point;
use selvedge_render::array::Method;
use selvedge_render::scene::{ExplorationPath, PathRow, Scene, SlotLetter, Stroke};
use selvedge_scratch::ScratchFolder;
use selvedge_textile::tactile::Tuning;

fn tunings() -> [Tuning; 2] {
    let loud = Tuning {
        gain_db: 6.0,
        ..Tuning::default()
    };
    [loud, Tuning::default()]
}

/// Along the warp of the textile at this place of the shipped scene, for ever.
fn route(x_mm: f64, y_mm: f64, n_ticks: u64) -> Route {
    let stroke = Stroke::Line {
        start: Point::new(x_mm, y_mm),
        end: Point::new(x_mm + 60.0, y_mm),
        speed_mm_per_s: 80.0,
    };
    Route::Stroke(stroke, n_ticks)
}

fn asked(choice: &Choice, scene: &Scene, route: Route) -> Inputs {
    Inputs::of(choice, scene, tunings(), (route, 0)).unwrap()
}

fn threads() -> Executor {
    Executor::Threads(eframe::egui::Context::default())
}

fn ended(comparison: &mut Compare) {
    while comparison.running.is_some() {
        comparison.poll();
        std::thread::yield_now();
    }
}

#[test]
fn each_kind_of_choice_changes_that_and_nothing_else() {
    let loaded = LoadedScene::shipped().unwrap();
    let (scene, path) = (loaded.scene(), || route(160.0, 190.0, 40));
    let mut choice = Choice::default();
    let [a, b] = asked(&choice, scene, path()).sides;
    assert_eq!(a.scene.tuning, Some(Tuning::default()), "the library’s");
    assert_eq!(b.scene.tuning, Some(tunings()[0]), "the one in force");
    assert_eq!((a.method, b.method), (Method::Auto, Method::Auto));
    assert_eq!(a.scene.textiles, b.scene.textiles);

    choice.what = What::Methods;
    let [a, b] = asked(&choice, scene, path()).sides;
    assert_eq!((a.method, b.method), (Method::Reference, Method::Table));
    assert_eq!(a.scene, b.scene);

    choice.what = What::Textiles;
    choice.textiles[1] = Some("denim".to_owned());
    let [a, b] = asked(&choice, scene, path()).sides;
    assert_eq!(a.scene.textiles, scene.textiles);
    let ids: Vec<&str> = b
        .scene
        .textiles
        .iter()
        .map(|cloth| cloth.id.as_str())
        .collect();
    assert_eq!(ids[1], "denim", "the path is on the second: {ids:?}");
    assert_eq!(b.scene.textiles[0], a.scene.textiles[0]);
    choice.place = Some(3);
    let [_, b] = asked(&choice, scene, path()).sides;
    assert_eq!(b.scene.textiles[3].id, "denim", "as chosen");
}

#[test]
fn a_slot_is_compared_as_it_was_kept_and_an_empty_one_is_refused() {
    let loaded = LoadedScene::shipped().unwrap();
    let mut scene = loaded.scene().clone();
    scene.textiles[0].gain_db = -4.0;
    GainSet::of(&scene, tunings()[1]).keep_in(&mut scene, SlotLetter::D);
    scene.textiles[0].gain_db = 2.0;
    let choice = |letter| Choice {
        tunings: [TuningChoice::Slot(letter), TuningChoice::Live],
        ..Choice::default()
    };
    let path = route(40.0, 40.0, 40);
    let [a, b] = asked(&choice(SlotLetter::D), &scene, path.clone()).sides;
    assert_eq!(a.scene.textiles[0].gain_db, -4.0);
    assert_eq!(a.scene.tuning, Some(tunings()[1]));
    assert_eq!(b.scene.textiles[0].gain_db, 2.0);
    let none = Inputs::of(&choice(SlotLetter::E), &scene, tunings(), (path.clone(), 0));
    assert!(none.unwrap_err().contains("empty"));
    scene.textiles.clear();
    let none = Inputs::of(&choice(SlotLetter::D), &scene, tunings(), (path, 0));
    assert!(none.unwrap_err().contains("Place a textile"));
}

#[test]
fn a_comparison_is_fresh_until_something_changes() {
    let loaded = LoadedScene::shipped().unwrap();
    let mut comparison = Compare::default();
    let inputs = asked(&comparison.choice, loaded.scene(), route(40.0, 40.0, 40));
    assert_eq!(comparison.standing(&Ok(inputs.clone())), Standing::None);
    comparison.begin(inputs.clone(), &loaded, &threads());
    ended(&mut comparison);
    assert_eq!(comparison.standing(&Ok(inputs.clone())), Standing::Fresh);
    let found = comparison.found().unwrap();
    assert_eq!(found.n_ticks, 40);
    let mean_db = found.in_all[0].mean_db().unwrap();
    assert!((mean_db - 6.0).abs() < 1e-4, "{mean_db} dB of master gain");
    let chart = over_time_chart(found);
    assert_eq!(
        chart.series.len(),
        2,
        "an entry each: least and most are one line"
    );
    assert_eq!(chart.series[0].points.len(), 40);
    let mut other = inputs.clone();
    other.sides[1].method = Method::Banded;
    assert_eq!(comparison.standing(&Ok(other)), Standing::Stale);
    comparison.forget();
    assert!(comparison.found().is_none() && comparison.n_begun() == 1);
}

#[test]
fn a_long_comparison_is_stopped_and_does_not_begin_again_by_itself() {
    let loaded = LoadedScene::shipped().unwrap();
    let mut comparison = Compare::default();
    comparison.choice.what = What::Methods;
    let inputs = asked(
        &comparison.choice,
        loaded.scene(),
        route(40.0, 40.0, 1 << 40),
    );
    comparison.begin(inputs.clone(), &loaded, &threads());
    let standing = comparison.standing(&Ok(inputs.clone()));
    assert!(matches!(standing, Standing::Running(_)), "{standing:?}");
    comparison.cancel();
    ended(&mut comparison);
    assert_eq!(comparison.standing(&Ok(inputs)), Standing::Cancelled);
    assert!(comparison.found().is_none(), "half of it is nothing");
}

#[test]
fn a_textile_that_is_not_there_is_a_sentence() {
    let loaded = LoadedScene::shipped().unwrap();
    let mut comparison = Compare::default();
    comparison.choice.what = What::Textiles;
    comparison.choice.textiles[0] = Some("felt-hat".to_owned());
    let inputs = asked(&comparison.choice, loaded.scene(), route(40.0, 40.0, 40));
    comparison.begin(inputs.clone(), &loaded, &Executor::InLine);
    match comparison.standing(&Ok(inputs)) {
        Standing::Impossible(words) => assert!(words.contains("felt-hat"), "{words}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_textile_under_a_path_is_found_on_recordings_and_strokes() {
    let loaded = LoadedScene::shipped().unwrap();
    let scene = loaded.scene();
    assert_eq!(route(160.0, 190.0, 40).mostly_on(scene, 0), Some(1));
    assert_eq!(route(-900.0, 0.0, 40).mostly_on(scene, 0), None);
    let row = |t_s, x_mm| PathRow {
        t_s,
        position: Point::new(x_mm, 70.0),
        ..PathRow::default()
    };
    let rows = vec![row(0.0, 100.0), row(1.0, 110.0), row(5.0, 230.0)];
    let path = Arc::new(ExplorationPath::new(rows).unwrap());
    let take = Route::Recording(Arc::clone(&path));
    assert_eq!(take.mostly_on(scene, 0), Some(3), "lower right");
    assert_eq!(take, Route::Recording(path));
    assert_eq!(take.ticks().count() as u64, take.n_ticks());
    assert_eq!(
        Route::Recording(take_of(&take)).mostly_on(&Scene::default(), 0),
        None
    );
}

fn take_of(route: &Route) -> Arc<ExplorationPath> {
    match route {
        Route::Recording(path) => Arc::clone(path),
        Route::Stroke(..) | Route::Recorded(_) => panic!("it is a recording"),
    }
}

#[test]
fn the_display_that_is_shown_is_compared() {
    let folder = ScratchFolder::made("compare-two");
    let mut desk = two_apart(&folder, 0);
    let made = desk.workbench.bench.exploration.at_hand.clone().unwrap();
    let mut n_sounding = [0, 1].map(|display| {
        desk.dispatch(ShowCommand::SelectDisplay(display));
        desk.pass(1);
        let bench = &desk.workbench.bench;
        let scene = bench.document.scene();
        let um = |tick| made.display_um(tick, (scene, display)).unwrap();
        let sounding = |tick| um(tick).iter().filter(|um| um[0] >= 1e-3).count() as u64;
        let expected: u64 = (0..made.path().n_ticks()).map(sounding).sum();
        let mut compare = Compare::default();
        compare.choice.what = What::Methods;
        compare.choice.methods = [Method::Table; 2];
        compare.run(bench);
        compare.set_against([made.clone(), made.clone()].map(|one| one.renamed("same")));
        let rendered = compare.found().unwrap().clone();
        compare.run(bench);
        for found in [&rendered, compare.found().unwrap()] {
            assert_eq!(found.by_contactor.len(), 24);
            assert_eq!(found.in_all[0].n_both, expected, "display {display}");
            assert_eq!(found.in_all[0].largest.unwrap().difference_db, 0.0);
        }
        expected
    });
    n_sounding.sort_unstable();
    assert!(
        0 < n_sounding[0] && n_sounding[0] < n_sounding[1],
        "one was lifted"
    );
    let path = desk.workbench.bench.exploration.at_hand.clone().unwrap();
    let one = Recording::from_path("a.csv".into(), (**path.path()).clone());
    let mut compare = Compare::default();
    compare.set_against([one, made]);
    let asked = compare.inputs(&desk.workbench.bench);
    assert!(asked.unwrap_err().contains("no levels of this display"));
}
