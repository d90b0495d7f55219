//! Every pane, empty, loaded and with a faulty device; and nothing computed for those in hiding.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use selvedge_workbench::{Screenshot, Theme, Workbench, screenshot};

use super::*;

fn drawn(harness: &Harness<'_, Workbench>, title: &str) -> u64 {
    let panes = harness.state().panes_drawn();
    panes.iter().find(|(name, _)| *name == title).unwrap().1
}

/// Shows every pane in turn and draws it.
fn look_at_every_pane(harness: &mut Harness<'_, Workbench>) {
    for (title, _) in harness.state().panes_drawn() {
        let before = drawn(harness, title);
        let front = match title {
            "Drive spectrum" => Some("Contact spectrum"),
            "Textile lab" | "Import" | "Picture" | "Friction" | "Drape" | "Collection"
            | "Participant" | "Study builder" | "Study board" | "Analysis" => Some("Workspace"),
            "Experimenter" => Some("Bridge"),
            "Recordings" => Some("Library"),
            "Levels" => Some("Tuning"),
            "Why" | "Response" | "Accuracy" | "Compare" | "Stylus" => Some("Spatial spectra"),
            _ => None,
        };
        if front.is_some() {
            click_tab(harness, title);
        }
        harness.run_steps(4);
        assert!(drawn(harness, title) > before, "{title} is not drawn");
        if let Some(front) = front {
            click_tab(harness, front);
        }
    }
    harness.render().unwrap();
}

#[test]
fn every_pane_is_drawn_empty_and_loaded() {
    let folder = Folder::new("panes");
    let mut harness = window(&folder.scene());
    harness.run();
    look_at_every_pane(&mut harness);
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(40);
    look_at_every_pane(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::N);
    harness.run_steps(5);
    assert_eq!(harness.state().scene_name(), "New scene");
    look_at_every_pane(&mut harness);
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(40);
    look_at_every_pane(&mut harness);
}

#[test]
fn every_pane_is_drawn_with_a_device_that_is_gone() {
    let folder = Folder::new("gone");
    let mut harness = window(&folder.scene());
    harness.run();
    connect_to(&mut harness, "/nowhere/port");
    wait(&mut harness, |bench| !bench.notices().is_empty());
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(40);
    look_at_every_pane(&mut harness);
    assert!(loudest_um(&harness) > 0.1, "the screen goes on without it");
}

#[test]
fn nothing_is_computed_for_a_view_that_is_not_shown() {
    let folder = Folder::new("hidden");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(40);
    let columns = |harness: &Harness<'_, Workbench>| harness.state().columns_computed();
    let [contact, drive] = columns(&harness);
    assert!(contact > 20, "{contact} columns of the contact spectrum");
    assert_eq!(drive, 0, "the drive spectrum is behind it");
    assert_eq!(drawn(&harness, "Drive spectrum"), 0);
    harness.get_by_label("Drive spectrum").click();
    harness.run_steps(20);
    let [hidden, shown] = columns(&harness);
    assert!(shown > 40, "what was missed is made up for: {shown}");
    harness.run_steps(20);
    assert_eq!(columns(&harness)[0], hidden, "now the other one is hidden");
    assert!(columns(&harness)[1] > shown, "and this one goes on");
}

#[test]
fn panes_are_hidden_shown_and_put_back_by_one_key() {
    let folder = Folder::new("arrangement");
    let mut harness = window(&folder.scene());
    harness.run();
    harness.get_by_label("View").click();
    harness.run_steps(2);
    harness.get_by_label("Panes").click();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::CheckBox, "Bridge")
        .click();
    harness.run_steps(3);
    let before = drawn(&harness, "Bridge");
    harness.run_steps(5);
    assert_eq!(drawn(&harness, "Bridge"), before, "hidden");
    press(&mut harness, Modifiers::NONE, Key::F9);
    harness.run_steps(3);
    assert!(drawn(&harness, "Bridge") > before, "back in its place");
}

#[test]
fn the_keys_are_listed() {
    let folder = Folder::new("keys");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::F1);
    harness.get_by_label_contains("Everything off");
    press(&mut harness, Modifiers::NONE, Key::F1);
    assert!(
        harness.query_by_label_contains("Everything off").is_none(),
        "put away"
    );
}

#[test]
fn the_window_is_drawn_at_every_size_and_scale() {
    for (width, height, pixels_per_point) in [(1280, 720, 1.0), (2800, 1800, 2.0), (1400, 900, 2.0)]
    {
        for theme in [Theme::Dark, Theme::Light] {
            let wanted = Screenshot {
                scene: None,
                width,
                height,
                pixels_per_point,
                theme,
                ..Screenshot::default()
            };
            let picture = screenshot(&wanted).unwrap();
            let first = &picture.rgba[..4];
            let is_plain = picture.rgba.chunks_exact(4).all(|pixel| pixel == first);
            assert!(!is_plain, "{width} × {height} at {pixels_per_point}");
        }
    }
}

#[test]
fn the_default_arrangement_follows_the_window_and_one_made_by_hand_stays() {
    let folder = Folder::new("room");
    let mut harness = window(&folder.scene());
    harness.run();
    assert!(harness.query_by_label("Wave").is_none(), "side by side");
    harness.set_size(vec2(700.0, 450.0));
    harness.run_steps(3);
    assert!(harness.query_by_label("Wave").is_some(), "in tabs");
    harness.set_size(vec2(1400.0, 900.0));
    harness.run_steps(3);
    assert!(harness.query_by_label("Wave").is_none(), "and back");
    harness.get_by_label("Drive spectrum").click();
    harness.run_steps(3);
    harness.set_size(vec2(700.0, 450.0));
    harness.run_steps(3);
    assert!(harness.query_by_label("Library").is_some(), "kept");
}
