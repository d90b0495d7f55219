//! What is drawn over the cloth, the Response pane, and marks that all views share.

use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use selvedge_workbench::Workbench;

use super::*;

fn maps_computed(harness: &Harness<'_, Workbench>) -> u64 {
    harness.state().responses_computed()[0]
}

fn curves_computed(harness: &Harness<'_, Workbench>) -> u64 {
    harness.state().responses_computed()[1]
}

/// Lets tips and trails pass.
fn rest(harness: &mut Harness<'_, Workbench>) {
    harness.run_steps(60);
}

#[test]
fn overlays_are_switched_by_keys_and_a_still_window_stays_still() {
    let folder = Folder::new("overlays");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 20);
    rest(&mut harness);
    let bare = harness.render().unwrap();
    let keys = [
        (Modifiers::NONE, Key::G),
        (Modifiers::NONE, Key::C),
        (Modifiers::NONE, Key::V),
        (Modifiers::NONE, Key::K),
        (Modifiers::SHIFT, Key::K),
    ];
    for (modifiers, key) in keys {
        press(&mut harness, modifiers, key);
        rest(&mut harness);
        assert_eq!(repaint_delay(&harness), Duration::MAX, "{key:?}: still");
    }
    assert_eq!(maps_computed(&harness), 2, "one for each band");
    assert_ne!(harness.render().unwrap(), bare, "the map is seen");
    for (modifiers, key) in keys {
        // The map of 40 Hz comes back before that of 320 Hz takes its place again.
        press(&mut harness, modifiers, key);
    }
    press(&mut harness, Modifiers::SHIFT, Key::K);
    rest(&mut harness);
    assert!(harness.render().unwrap() == bare, "all of it is off again");
    let n_maps = maps_computed(&harness);
    stroke(&mut harness, 20);
    assert_eq!(
        maps_computed(&harness),
        n_maps,
        "nothing is computed while off"
    );
}

#[test]
fn overlays_are_switched_in_the_row_of_tools_and_the_menu_stays() {
    let folder = Folder::new("overlay-menu");
    let mut harness = window(&folder.scene());
    harness.run();
    harness.get_by_label("Overlay").click();
    harness.run_steps(2);
    for name in ["Map of 40 Hz", "Points, 1 mm apart"] {
        let entry = harness.get_by_role_and_label(Role::CheckBox, name);
        entry.click();
        harness.run_steps(2);
    }
    assert_eq!(maps_computed(&harness), 1);
    harness.get_by_label_contains("Come closer");
}

#[test]
fn the_response_pane_computes_when_it_is_seen_and_something_changed() {
    let folder = Folder::new("response");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 10);
    assert_eq!(curves_computed(&harness), 0, "hidden");
    harness.get_by_label("Response").click();
    harness.run_steps(2);
    let n_first = curves_computed(&harness);
    assert_eq!(n_first, 3, "over direction, over speed, and here");
    rest(&mut harness);
    assert_eq!(curves_computed(&harness), n_first, "nothing changed");
    assert_eq!(repaint_delay(&harness), Duration::MAX, "still");
    harness
        .get_by_role_and_label(Role::Slider, "Master")
        .set_value_accesskit(-12.0);
    harness.run_steps(3);
    assert_eq!(curves_computed(&harness), n_first, "gains compute nothing");
    harness
        .get_by_role_and_label(Role::Slider, "Speed of movement")
        .set_value_accesskit(30.0);
    harness.run_steps(3);
    assert_eq!(curves_computed(&harness), n_first + 2, "another speed");
    click_tab(&mut harness, "Spatial spectra");
    let n_hidden = curves_computed(&harness);
    stroke(&mut harness, 20);
    assert_eq!(curves_computed(&harness), n_hidden, "hidden again");
}

#[test]
fn the_chosen_velocity_drives_the_maps_and_can_follow_the_display() {
    let folder = Folder::new("probe");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::K);
    harness.get_by_label("Response").click();
    stroke(&mut harness, 10);
    let n_maps = maps_computed(&harness);
    harness
        .get_by_role_and_label(Role::Slider, "Direction of movement")
        .set_value_accesskit(90.0);
    harness.run_steps(3);
    assert_eq!(maps_computed(&harness), n_maps + 1, "another direction");
    stroke(&mut harness, 10);
    assert_eq!(maps_computed(&harness), n_maps + 1, "it stays as chosen");
    harness
        .get_by_label_contains("Ask at the display's own velocity")
        .click();
    harness.run_steps(2);
    stroke(&mut harness, 10);
    assert!(maps_computed(&harness) > n_maps + 1, "it follows");
    let dial = harness.get_by_role_and_label(Role::Slider, "Direction of movement");
    let shown = dial.accesskit_node().numeric_value().unwrap();
    assert_eq!(shown, 0.0, "to the right");
}

#[test]
fn what_is_pointed_at_or_chosen_in_one_view_is_marked_in_all() {
    let folder = Folder::new("linked");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 10);
    rest(&mut harness);
    assert_eq!(harness.state().hovered()[0], Some(0), "under the finger");
    let heatmaps = harness.get_by_label_contains("Heatmaps").rect();
    harness.hover_at(heatmaps.min + vec2(30.0, 40.0));
    harness.run_steps(2);
    let [cloth, contactor] = harness.state().hovered();
    assert!(cloth.is_none() && contactor.is_some(), "{contactor:?}");
    rest(&mut harness);
    assert_eq!(repaint_delay(&harness), Duration::MAX, "a resting pointer");
    let row = harness
        .get_by_role_and_label(Role::ListItem, "1 Ripple")
        .rect();
    harness.hover_at(row.center());
    harness.run_steps(2);
    assert_eq!(harness.state().hovered(), [Some(0), None]);
    harness
        .get_by_role_and_label(Role::ListItem, "1 Ripple")
        .click();
    harness.run_steps(2);
    assert_eq!(harness.state().chosen()[0], Some(0));
    let before = harness.state().chosen()[1].unwrap();
    harness.get_by_label("Why").click();
    harness.run_steps(4);
    harness
        .get_by_label_contains("Choose the next contactor")
        .click();
    harness.run_steps(2);
    assert_eq!(harness.state().chosen()[1], Some(before + 1));
}

#[test]
fn a_dot_of_the_compression_curve_marks_and_chooses_its_textile() {
    let folder = Folder::new("dots");
    let mut harness = window(&folder.scene());
    harness.run();
    let plot = harness.get_by_label("Compression curve").rect();
    let area = Rect::from_min_max(plot.min + vec2(30.0, 6.0), plot.max - vec2(6.0, 18.0));
    // The one textile's level is the reference: its dot lies on the diagonal.
    let is_on_dot = (0..=60_u8).any(|step| {
        let share = f32::from(step) / 60.0;
        harness.hover_at(area.left_bottom() + vec2(share, -share) * area.size());
        harness.run_steps(2);
        harness.state().hovered()[0] == Some(0)
    });
    assert!(is_on_dot, "its dot is somewhere on the diagonal");
    let at = harness
        .ctx
        .input(|input| input.pointer.hover_pos())
        .unwrap();
    harness.drag_at(at);
    harness.step();
    harness.drop_at(at);
    harness.run_steps(2);
    assert_eq!(harness.state().chosen()[0], Some(0));
}
