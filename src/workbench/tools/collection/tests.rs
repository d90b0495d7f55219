//! What the collection shows, selects and measures, in a window without a display.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use super::*;
use crate::bench::command::ShowCommand;
use crate::bench::command::edit::Edit;
use crate::bench::library_selection::Joining;
use crate::shell::headless::Headless;
use crate::tools::collection::listing::SortBy;
use crate::tools::collection::listing::{Only, Sort};
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{Choice, Entry};
use selvedge_foundation::quantity::level_db;
use selvedge_textile::tactile::{Band, Filters, Levels};

/// A window with the pane in front.
fn in_front() -> Headless {
    let mut window = Headless::shipped();
    window.pass(1);
    window.dispatch(ShowCommand::Pane(Pane::Collection));
    window
}

/// Frames until so many textiles were measured.
fn measure(window: &mut Headless, n_measured: u64) {
    for _ in 0..6000 {
        window.pass(1);
        if window.workbench.n_textiles_measured() >= n_measured {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!("never measured: {}", window.workbench.n_textiles_measured());
}

/// What the pane shows, by a function of its entries in order.
fn shown<T>(window: &mut Headless, of: impl Fn(&Entry<'_>) -> T) -> Vec<T> {
    let scene = window.workbench.bench.scene_view();
    let items = window.workbench.bench.library.view.shared_items();
    let selection = &window.workbench.bench.library.selection;
    let collection: &Collection = window.workbench.tools.get().unwrap();
    let view = collection.view(&items, &scene, selection);
    view.entries.iter().map(of).collect()
}

fn collection(window: &mut Headless) -> &mut Collection {
    window.workbench.tools.get_mut().unwrap()
}

fn choose(window: &mut Headless, change: impl FnOnce(&mut Choice)) {
    change(&mut collection(window).choice);
}

#[test]
fn raw_figures_are_the_levels_of_the_surface_at_the_chosen_speed() {
    let mut window = in_front();
    measure(&mut window, 16);
    choose(&mut window, |choice| choice.speed_mm_per_s = 20.0);
    measure(&mut window, 32);
    let library = Arc::clone(window.workbench.bench.library.view.library());
    for speed_mm_per_s in [20.0, 100.0] {
        choose(&mut window, |choice| choice.speed_mm_per_s = speed_mm_per_s);
        window.pass(2);
        let found = shown(&mut window, |one| {
            (one.item.id.clone(), one.figures.cloned())
        });
        for (id, figures) in found {
            let surface = Arc::clone(library.load(&id).unwrap().surface());
            let levels = Levels::at(speed_mm_per_s, &surface, &Filters::default());
            assert_eq!(figures.map(|figures| figures.levels), Some(levels), "{id}");
        }
    }
    assert_eq!(
        window.workbench.n_textiles_measured(),
        32,
        "100 mm/s was kept"
    );
}

#[test]
fn tuned_levels_are_what_gains_and_compression_make_of_them() {
    let mut window = in_front();
    measure(&mut window, 16);
    window.dispatch(Edit::Compression(1.0));
    window.dispatch(Edit::MasterGain(-6.0));
    window.pass(2);
    let n_measured = window.workbench.n_textiles_measured();
    let reference_db = window.workbench.bench.live.reference_db.unwrap();
    let levels = shown(&mut window, |one| one.value(&Measure::Level, true).unwrap());
    let manifests = shown(&mut window, |one| one.item.gain_db);
    for (level_db, manifest_db) in levels.iter().zip(manifests) {
        let expected_db = reference_db - 6.0 + manifest_db;
        assert!((level_db - expected_db).abs() < 1e-9, "{level_db}");
    }
    let [raw, tuned] =
        [false, true].map(|is_tuned| shown(&mut window, |one| one.mean_um(is_tuned).unwrap()[1]));
    let gains = shown(&mut window, |one| one.gains_db[1]);
    for ((raw, tuned), gain_db) in raw.iter().zip(tuned).zip(gains) {
        assert!(
            (level_db(tuned / raw) - gain_db).abs() < 1e-9,
            "{gain_db} dB"
        );
    }
    assert_eq!(
        window.workbench.n_textiles_measured(),
        n_measured,
        "no slider measures"
    );
}

#[test]
fn nothing_is_measured_behind_other_panes_and_work_ends_when_nobody_looks() {
    let mut window = Headless::shipped();
    window.pass(40);
    assert_eq!(window.workbench.n_textiles_measured(), 0, "hidden");
    window.dispatch(ShowCommand::Pane(Pane::Collection));
    measure(&mut window, 2);
    window.dispatch(ShowCommand::Pane(Pane::Workspace));
    window.pass(2);
    let n_measured = window.workbench.n_textiles_measured();
    thread::sleep(Duration::from_millis(100));
    window.pass(10);
    assert_eq!(
        window.workbench.n_textiles_measured(),
        n_measured,
        "hidden again"
    );
    window.dispatch(ShowCommand::Pane(Pane::Collection));
    measure(&mut window, 16);
    assert_eq!(window.workbench.n_textiles_measured(), 16, "each once");
}

#[test]
fn measuring_stops_when_told_and_goes_on_when_told() {
    let mut window = in_front();
    measure(&mut window, 1);
    collection(&mut window).measurements.halt();
    window.pass(2);
    let n_measured = window.workbench.n_textiles_measured();
    assert!(n_measured < 16, "{n_measured}: stopped in time");
    thread::sleep(Duration::from_millis(100));
    window.pass(5);
    assert_eq!(window.workbench.n_textiles_measured(), n_measured);
    collection(&mut window).measurements.go_on();
    measure(&mut window, 16);
}

#[test]
fn search_kind_and_order_work_together() {
    let mut window = in_front();
    measure(&mut window, 16);
    collection(&mut window).search = "polyester".to_owned();
    choose(&mut window, |choice| {
        choice.only = Only::Construction("knitted");
        choice.sort = Sort {
            by: SortBy::Amplitude(Band::Low),
            is_falling: true,
        };
    });
    let a40_um = shown(&mut window, |one| one.mean_um(true).unwrap()[0]);
    assert!(
        a40_um.len() > 1 && a40_um.is_sorted_by(|a, b| a >= b),
        "{a40_um:?}"
    );
    let kinds = shown(&mut window, |one| one.item.kind.clone());
    assert!(
        kinds.iter().all(|kind| kind == "knitted · polyester"),
        "{kinds:?}"
    );
    choose(&mut window, |choice| {
        choice.sort = choice.sort.after(SortBy::Name);
    });
    let names = shown(&mut window, |one| one.item.name.to_lowercase());
    assert!(names.is_sorted(), "{names:?}");
}

#[test]
fn a_figure_that_was_not_measured_has_no_value_and_gains_change_amplitudes_alone() {
    let mut window = in_front();
    measure(&mut window, 16);
    let miu = Measure::Figure("MIU".to_owned());
    let values = shown(&mut window, |one| one.value(&miu, true));
    let stated = shown(&mut window, |one| {
        one.item.measured.iter().any(|f| f.name == "MIU")
    });
    for (value, is_stated) in values.iter().zip(stated) {
        assert_eq!(value.is_some(), is_stated);
    }
    for measure in [
        Measure::Variation(Band::Low),
        Measure::Anisotropy(Band::High),
    ] {
        let of =
            |window: &mut Headless, is_tuned| shown(window, |one| one.value(&measure, is_tuned));
        assert_eq!(of(&mut window, true), of(&mut window, false), "{measure:?}");
    }
}

#[test]
fn what_is_selected_joins_toggles_and_is_marked_in_the_library() {
    let mut window = in_front();
    let ids = |names: &[&str]| {
        names
            .iter()
            .map(|name| (*name).to_owned())
            .collect::<Vec<_>>()
    };
    for (chosen, joining, expected) in [
        (ids(&["denim"]), Joining::Alone, ids(&["denim"])),
        (
            ids(&["silk-crepe"]),
            Joining::Also,
            ids(&["denim", "silk-crepe"]),
        ),
        (
            ids(&["denim", "wool-rib"]),
            Joining::Toggled,
            ids(&["silk-crepe", "wool-rib"]),
        ),
        (ids(&["denim"]), Joining::Alone, ids(&["denim"])),
    ] {
        let selection = &mut window.workbench.bench.library.selection;
        selection.select(chosen, joining);
        assert_eq!(
            window.workbench.selected_textiles(),
            expected,
            "{joining:?}"
        );
    }
    let scene = window.workbench.bench.scene_view();
    assert!(scene.is_marked_id("denim") && !scene.is_marked_id("wool-rib"));
}

#[test]
fn a_speed_that_makes_no_sense_is_kept_within_what_can_be_chosen() {
    let mut collection = Collection::default();
    for (asked, chosen) in [(0.0, 1.0), (1e9, 1000.0), (f64::NAN, 1000.0), (63.0, 63.0)] {
        let choice = Choice {
            speed_mm_per_s: asked,
            ..collection.choice.clone()
        };
        collection.choice.take(choice);
        assert_eq!(collection.choice.speed_mm_per_s, chosen, "{asked}");
    }
}
