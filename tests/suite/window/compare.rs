//! Compare, and the model of what is felt, under the hands of a simulated user.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use selvedge_workbench::Workbench;

use super::*;

/// What a toggle of the compared kind is called.
const METHODS: &str = "Compare how amplitudes are computed";

fn compare(harness: &mut Harness<'_, Workbench>) {
    harness.get_by_label("Compare").click();
    harness.run_steps(6);
}

fn check(harness: &mut Harness<'_, Workbench>, name: &str) {
    harness.get_by_role_and_label(Role::CheckBox, name).click();
    harness.run_steps(6);
}

fn heatmaps(harness: &Harness<'_, Workbench>) -> String {
    let maps = harness.get_by_label_contains("Heatmaps of both bands");
    maps.accesskit_node().label().unwrap_or_default()
}

/// Records so many ticks of the circle through the middle of the workspace.
fn record(harness: &mut Harness<'_, Workbench>, n_ticks: usize) {
    press(harness, Modifiers::NONE, Key::Space);
    harness.run_steps(10);
    press(harness, Modifiers::NONE, Key::R);
    harness.run_steps(n_ticks);
    press(harness, Modifiers::NONE, Key::R);
    harness.run_steps(4);
    assert!(harness.state().n_recorded_ticks().is_some(), "recorded");
}

#[test]
fn nothing_is_compared_while_the_pane_is_hidden() {
    let folder = Folder::new("compare-hidden");
    let mut harness = window(&folder.scene());
    harness.run_steps(20);
    assert_eq!(harness.state().n_comparisons(), 0, "behind others");
    compare(&mut harness);
    assert_eq!(harness.state().n_comparisons(), 1, "in sight");
    harness.run_steps(20);
    assert_eq!(harness.state().n_comparisons(), 1, "nothing has changed");
    harness.get_by_label("Spatial spectra").click();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::Slider, "Master")
        .set_value_accesskit(4.0);
    harness.run_steps(20);
    assert_eq!(harness.state().n_comparisons(), 1, "hidden again");
    compare(&mut harness);
    assert_eq!(harness.state().n_comparisons(), 2, "and made up for");
}

#[test]
fn a_kept_tuning_and_six_decibels_more_differ_by_six_decibels() {
    let folder = Folder::new("compare-tunings");
    let mut harness = window(&folder.scene());
    harness.run();
    compare(&mut harness);
    harness
        .get_by_role_and_label(Role::Button, "Slot A, empty")
        .click();
    harness.run_steps(6);
    harness.get_by_label("A of the comparison").click();
    harness.run_steps(4);
    harness.get_by_label("slot A").click();
    harness.run_steps(6);
    let still = harness.state().comparison().unwrap();
    assert_eq!(still.in_all[0].mean_db(), Some(0.0), "nothing was turned");
    let now = harness.state().tuning().gain_db;
    harness
        .get_by_role_and_label(Role::Slider, "Master")
        .set_value_accesskit(now + 6.0);
    harness.run_steps(6);
    let found = harness.state().comparison().unwrap();
    assert_eq!(found.by_contactor.len(), 24);
    for tally in found.by_contactor.iter().flatten() {
        let largest_db = tally.largest.unwrap().difference_db;
        assert!((largest_db - 6.0).abs() < 1e-4, "{tally:?}");
    }
    let said = harness.get_all_by_label_contains("mean 6.00 dB, largest 6.00 dB");
    assert_eq!(said.count(), 2, "one line a band");
    harness.get_by_label_contains("no recording: on a circle");
    harness
        .get_by_label_contains("Mean level differences, B less A, up to 10 dB. 40 Hz: 24 in both");
}

#[test]
fn methods_are_compared_on_the_recording_and_its_ticks_are_found_by_a_click() {
    let folder = Folder::new("compare-methods");
    let mut harness = window(&folder.scene());
    harness.run();
    record(&mut harness, 80);
    compare(&mut harness);
    check(&mut harness, METHODS);
    let n_ticks = harness.state().n_recorded_ticks().unwrap();
    let found = harness.state().comparison().unwrap();
    assert_eq!(found.n_ticks, n_ticks);
    for tally in found.in_all {
        let largest_db = tally.largest.unwrap().difference_db.abs();
        assert!(largest_db > 0.0 && largest_db < 0.05, "{largest_db} dB");
    }
    harness.get_by_label_contains("on Recording 1");
    let curve = harness.get_by_label_contains("Level difference over time");
    // Its numbers take 34 points on the left and 8 on the right.
    let middle = curve.rect().center() + vec2(13.0, 0.0);
    harness.hover_at(middle);
    harness.step();
    harness.drag_at(middle);
    harness.drop_at(middle);
    harness.run_steps(4);
    let tick = harness.state().replayed_tick().unwrap();
    assert!(tick.abs_diff(n_ticks / 2) <= 2, "tick {tick} of {n_ticks}");
    let maps = harness
        .get_by_label_contains("Mean level differences")
        .rect();
    let place = maps.left_top() + vec2(0.12 * maps.width(), 0.25 * maps.height());
    harness.hover_at(place);
    harness.step();
    harness.drag_at(place);
    harness.drop_at(place);
    harness.run_steps(3);
    let chosen = harness.get_all_by_label_contains("contactor ");
    assert!(
        chosen
            .into_iter()
            .all(|node| node.accesskit_node().label().as_deref() != Some("contactor 9")),
        "another contactor was chosen"
    );
}

#[test]
fn a_scene_without_textiles_says_what_to_do() {
    let folder = Folder::new("compare-empty");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::COMMAND, Key::N);
    harness.run_steps(4);
    compare(&mut harness);
    harness.get_by_label_contains("Place a textile first");
    assert_eq!(harness.state().n_comparisons(), 0);
}

#[test]
fn what_is_below_threshold_is_said_until_it_is_switched_off() {
    let folder = Folder::new("threshold");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 20);
    let loud = heatmaps(&harness);
    assert!(loud.ends_with("below threshold, by a model"), "{loud}");
    assert!(loud.contains("of 24 on cloth 0 at 40 Hz"), "{loud}");
    harness
        .get_by_role_and_label(Role::Slider, "Master")
        .set_value_accesskit(-30.0);
    stroke(&mut harness, 20);
    let quiet = heatmaps(&harness);
    assert!(
        quiet.contains("of 24 on cloth 24 at 40 Hz and 24 at 320 Hz"),
        "{quiet}"
    );
    let amplitudes_um = harness.state().amplitudes_um();
    check(
        &mut harness,
        "Hollow and grey what is below the threshold of detection, by a model",
    );
    assert!(!heatmaps(&harness).contains("model"), "switched off");
    assert!(
        amplitudes_um.iter().all(|um| um[0] > 0.0),
        "it is still rendered"
    );
}

#[test]
fn gains_are_marked_with_what_is_just_noticed() {
    let folder = Folder::new("noticed");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 20);
    let described = |harness: &Harness<'_, Workbench>| {
        let slider = harness.get_by_role_and_label(Role::Slider, "Master");
        slider.accesskit_node().description().unwrap_or_default()
    };
    let resting = described(&harness);
    assert!(
        resting.starts_with("Just noticeable difference 2."),
        "{resting}"
    );
    assert!(resting.ends_with("dB, by a model"), "{resting}");
    let slider = harness.get_by_role_and_label(Role::Slider, "Master").rect();
    harness.hover_at(slider.center());
    harness.run_steps(2);
    let began = described(&harness);
    assert!(began.contains(", marked around "), "{began}");
    harness.drag_at(slider.center());
    harness.step();
    harness.hover_at(slider.center() + vec2(30.0, 0.0));
    harness.run_steps(3);
    assert_eq!(
        described(&harness),
        began,
        "marks stay where the gesture began"
    );
    harness.drop_at(slider.center() + vec2(30.0, 0.0));
    harness.run_steps(3);
    assert_ne!(described(&harness), began, "and move on when it ends");
}
