//! The accuracy pane: empty, at work, and another budget by its slider.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use super::*;

/// A window with the pane in front.
fn in_front(folder: &Folder) -> Harness<'static, Workbench> {
    let mut harness = window(&folder.scene());
    harness.run();
    harness.get_by_label("Accuracy").click();
    harness.run_steps(3);
    harness
}

#[test]
fn the_pane_says_what_to_do_and_then_shows_errors_within_the_bound() {
    let folder = Folder::new("accuracy");
    let mut harness = in_front(&folder);
    harness.render().unwrap();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(60);
    let [n_checked, n_left_out] = harness.state().ticks_checked();
    assert!(
        n_checked > 50 && n_left_out <= 2,
        "{n_checked} {n_left_out}"
    );
    harness.render().unwrap();
    harness.get_by_label("Spatial spectra").click();
    harness.run_steps(3);
    let before = harness.state().ticks_checked();
    harness.run_steps(40);
    assert_eq!(harness.state().ticks_checked(), before, "nobody looks");
}

#[test]
fn the_budget_slider_switches_what_auto_chooses() {
    let folder = Folder::new("budget");
    let mut harness = in_front(&folder);
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(5);
    assert_eq!(harness.state().rendered_by(), "table");
    let slider = harness.get_by_role_and_label(Role::Slider, "Error budget");
    let rail = slider.rect();
    let mut budget_at = |share: f32| {
        let at = rail.left_center() + vec2(share * rail.width(), 0.0);
        harness.drag_at(at);
        harness.drop_at(at);
        harness.run_steps(4);
        (
            harness.state().rendered_by(),
            harness.state().error_budget_db(),
        )
    };
    assert_eq!(budget_at(0.0), ("reference", 0.0));
    let (method, budget_db) = budget_at(0.8);
    assert!(
        method == "table" && (0.01..1.0).contains(&budget_db),
        "{method} {budget_db}"
    );
}

#[test]
fn every_method_is_measured_and_a_point_is_told_in_words() {
    let folder = Folder::new("measure");
    let mut harness = in_front(&folder);
    harness.get_by_label("Every method on this scene").click();
    harness.run_steps(3);
    harness.get_by_label("Error against time of every method on this scene");
    harness.get_by_label("Measure this scene").click();
    harness.run_steps(2);
    wait(&mut harness, |bench| bench.n_methods_measured() > 0);
    harness.run_steps(3);
    let n_methods = harness.state().n_methods_measured();
    assert!(n_methods >= 10, "{n_methods}");
    harness
        .get_by_role_and_label(Role::RadioButton, "reference")
        .click();
    harness.run_steps(3);
    harness.get_by_label_contains("reference: nothing beats it");
    harness.render().unwrap();
}
