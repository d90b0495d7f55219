//! The window checking its own engine: what is sampled, what is left out, what the budget does.

use super::*;
use crate::bench::Drive;
use crate::bench::background::Executor;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, Part, PlayCommand, ShowCommand};
use crate::bench::rendering::Rendering;
use crate::shell::window::Workbench;
use crate::tools::accuracy::checker::ROUNDING_DB;

use eframe::egui;

/// A window whose display explores by itself.
fn exploring() -> (Accuracy, Workbench) {
    let ctx = egui::Context::default();
    let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
    window.dispatch(PlayCommand::Toggle.into());
    window.bench.engine.advance_ticks(2).unwrap();
    (Accuracy::default(), window)
}

/// Lets ticks go by while the pane is looked at.
fn watch(accuracy: &mut Accuracy, window: &mut Workbench, n_ticks: u64) {
    for _ in 0..n_ticks {
        window.bench.engine.advance_ticks(1).unwrap();
        accuracy.watch(&mut window.bench);
    }
    accuracy.take_found();
}

fn largest_db(accuracy: &Accuracy) -> f64 {
    let bands = accuracy.found().bands;
    bands.iter().map(|band| band.max_db).fold(0.0, f64::max)
}

fn rendering(method: Method, budget_db: f64) -> Command {
    Command::Render(Rendering { method, budget_db })
}

#[test]
fn the_running_table_is_within_its_bound_and_the_reference_within_rounding() {
    let (mut accuracy, mut window) = exploring();
    watch(&mut accuracy, &mut window, 100);
    assert_eq!(accuracy.method(), Some(Method::Table));
    let bound_db = accuracy.bound_db;
    assert!(bound_db > 1e-3 && bound_db <= 0.05, "{bound_db}");
    let table_db = largest_db(&accuracy);
    assert!(
        (10.0 * ROUNDING_DB..=bound_db).contains(&table_db),
        "{table_db}"
    );
    assert_eq!(accuracy.tally.sampled, 100);
    window.dispatch(rendering(Method::Reference, 0.05));
    watch(&mut accuracy, &mut window, 100);
    assert_eq!(accuracy.method(), Some(Method::Reference));
    assert!(largest_db(&accuracy) <= ROUNDING_DB);
    let n_ticks = accuracy.found().n_ticks;
    assert!(
        (90..=100).contains(&n_ticks),
        "a method begins anew: {n_ticks}"
    );
}

#[test]
fn gains_masks_and_edits_on_their_way_are_left_out_and_never_errors() {
    let (mut accuracy, mut window) = exploring();
    window.dispatch(rendering(Method::Reference, 0.05));
    watch(&mut accuracy, &mut window, 10);
    let acts = [
        Edit::MasterGain(-20.0).into(),
        Edit::TextileGain(0, 9.0).into(),
        Edit::MoveCloth(0, selvedge_foundation::geometry::Point::new(3.0, 4.0)).into(),
        ShowCommand::Mute(Part::Contactor(3)).into(),
        ShowCommand::Solo(Part::Cloth(1)).into(),
        ShowCommand::HearAll.into(),
        Command::Undo,
    ];
    for act in acts {
        let before = accuracy.tally;
        window.dispatch(act);
        // The engine has not heard of it yet; its last tick shows what was before.
        accuracy.last = None;
        accuracy.watch(&mut window.bench);
        assert_eq!(accuracy.tally.changed, before.changed + 1);
        assert_eq!(accuracy.tally.sampled, before.sampled);
        watch(&mut accuracy, &mut window, 30);
        assert_eq!(accuracy.tally.sampled, before.sampled + 30);
    }
    assert!(
        largest_db(&accuracy) <= ROUNDING_DB,
        "{:?}",
        accuracy.found()
    );
}

#[test]
fn a_window_that_believes_the_wrong_gain_would_see_it() {
    let (mut accuracy, mut window) = exploring();
    watch(&mut accuracy, &mut window, 10);
    // What nobody told the window: a deliberate fault.
    window
        .bench
        .inspection
        .scene
        .textiles
        .iter_mut()
        .for_each(|placed| placed.scene_gain_db += 0.5);
    watch(&mut accuracy, &mut window, 60);
    assert!((largest_db(&accuracy) - 0.5).abs() < 0.05);
}

#[test]
fn nothing_is_sampled_at_rest_or_twice_and_a_reset_forgets() {
    let (mut accuracy, mut window) = exploring();
    watch(&mut accuracy, &mut window, 20);
    window.bench.send(selvedge_engine::Command::Pause);
    watch(&mut accuracy, &mut window, 20);
    assert!(
        accuracy.tally.sampled <= 21,
        "a held tick once: {:?}",
        accuracy.tally
    );
    window.dispatch(PlayCommand::Source(crate::bench::command::PlaySource::Pointer).into());
    watch(&mut accuracy, &mut window, 20);
    assert!(accuracy.tally.sampled <= 21, "nothing moves");
    accuracy.reset();
    accuracy.take_found();
    assert_eq!(accuracy.tally, Tally::default());
    assert_eq!(*accuracy.found(), ErrorView::default());
}

#[test]
fn the_budget_chooses_by_bounds_and_is_kept_with_the_settings() {
    let (_, mut window) = exploring();
    let mut chosen = |budget_db: f64| {
        window.dispatch(rendering(Method::Auto, budget_db));
        window.bench.engine.advance_ticks(1).unwrap();
        let snapshot = window.bench.engine.snapshot();
        assert!(
            snapshot.rendering.bound.level_db <= budget_db,
            "{budget_db} dB"
        );
        assert_eq!(
            window.bench.settings.preferences.rendering.budget_db,
            budget_db
        );
        let snapshot = window.bench.engine.snapshot();
        (snapshot.rendering.method, snapshot.rendering.bound.level_db)
    };
    assert_eq!(chosen(0.0), (Method::Reference, 0.0));
    assert_eq!(chosen(1e-6).0, Method::Reference);
    assert_eq!(chosen(1e-4).0, Method::Banded);
    let bounds_db = [0.001, 0.01, 0.05, 1.0].map(|budget_db| {
        let (method, bound_db) = chosen(budget_db);
        assert_eq!(method, Method::Table, "{budget_db}");
        bound_db
    });
    assert!(bounds_db.is_sorted(), "{bounds_db:?}");
    assert!(bounds_db[0] < bounds_db[3], "coarser where more is allowed");
    assert_eq!(chosen(0.05), (Method::Table, bounds_db[2]), "as before");
    assert!(
        !window.bench.document.is_edited(),
        "it is no part of the scene"
    );
}

#[test]
fn another_budget_leaves_source_recording_and_scene_as_they_are() {
    let (_, mut window) = exploring();
    let _recording = window.bench.engine.record().unwrap();
    window.bench.engine.advance_ticks(10).unwrap();
    let before = window.bench.engine.snapshot().pose;
    window.dispatch(rendering(Method::Auto, 0.3));
    window.bench.engine.advance_ticks(1).unwrap();
    let snapshot = window.bench.engine.snapshot();
    assert!(snapshot.recording.is_recording, "it goes on");
    let moved_mm = (snapshot.pose.position - before.position).length_mm();
    assert!(
        (2.0..4.0).contains(&moved_mm),
        "and so does the stroke: {moved_mm} mm"
    );
}

#[test]
fn a_budget_that_is_none_is_brought_within_bounds() {
    let (_, mut window) = exploring();
    for (asked, kept) in [(7.0, 1.0), (-3.0, 0.0), (f64::NAN, 0.05)] {
        window.dispatch(rendering(Method::Auto, asked));
        assert_eq!(
            window.bench.settings.preferences.rendering.budget_db, kept,
            "{asked}"
        );
    }
}

#[test]
fn the_scene_is_measured_along_the_last_recording_and_the_running_method_is_told() {
    let (mut accuracy, mut window) = exploring();
    window.bench.toggle_recording();
    window.bench.engine.advance_ticks(50).unwrap();
    window
        .bench
        .engine
        .send(selvedge_engine::Command::StopRecording)
        .unwrap();
    window.bench.engine.advance_ticks(1).unwrap();
    window.bench.poll_recordings();
    accuracy.measure(&window.bench);
    while accuracy.measuring.is_some() {
        accuracy.poll_measuring(&mut window.bench);
        std::thread::yield_now();
    }
    let measured = accuracy.measured.as_ref().unwrap();
    assert!(measured.note.starts_with("50 ticks"), "{}", measured.note);
    let running = accuracy.chosen.unwrap();
    assert_eq!(measured.rows[running].setting, "within 0.05 dB");
    assert!(
        measured.front.iter().any(|front| *front),
        "{:?}",
        measured.front
    );
    let n_edits = window.bench.inspection.n_edits;
    assert_eq!(measured.n_edits, n_edits, "nothing changed since");
    window.dispatch(Edit::RemoveCloth(0).into());
    assert_ne!(
        measured.n_edits, window.bench.inspection.n_edits,
        "one is gone"
    );
}

#[test]
fn a_measurement_that_is_stopped_leaves_the_last_one() {
    let (mut accuracy, mut window) = exploring();
    window.bench.executor = Executor::Threads(window.bench.ctx.clone());
    accuracy.measure(&window.bench);
    accuracy.measuring.as_ref().unwrap().stop();
    while accuracy.measuring.is_some() {
        accuracy.poll_measuring(&mut window.bench);
        std::thread::yield_now();
    }
    assert!(window.bench.notices.shown().is_empty(), "no word of it");
}
