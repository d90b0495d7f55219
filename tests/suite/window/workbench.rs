//! What a researcher does at the workbench: arranges cloth, mutes, records, replays.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use selvedge_workbench::Workbench;

use super::*;

fn drag(harness: &mut Harness<'_, Workbench>, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for share in 1..=10_u8 {
        harness.hover_at(from + (to - from) * (f32::from(share) / 10.0));
        harness.step();
    }
    harness.drop_at(to);
    harness.run_steps(3);
}

fn origin_mm(harness: &Harness<'_, Workbench>, index: usize) -> [f64; 2] {
    let origin = harness.state().scene().textiles[index].origin_mm;
    [origin.x_mm, origin.y_mm]
}

#[test]
fn a_textile_is_dragged_in_one_step_of_undo_and_felt_at_its_new_place() {
    let folder = Folder::with_size("arrange", [60.0, 200.0]);
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::A);
    let workspace = harness.get_by_label("Workspace with 1 textiles").rect();
    // The cloth covers the left of the workspace; the workspace fills the height of its pane.
    let grip = harness.get_by_label("Textile 1 Ripple").rect().center();
    drag(&mut harness, grip, grip + vec2(80.0, 0.0));
    let [x_mm, y_mm] = origin_mm(&harness, 0);
    assert!(
        x_mm > 10.0 && y_mm.abs() < 3.0,
        "moved right: {x_mm}, {y_mm}"
    );
    assert!(workspace.width() > 100.0, "{workspace:?}");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(origin_mm(&harness, 0), [0.0, 0.0], "one drag is one step");
    assert!(!harness.state().is_edited(), "nothing is left of it");
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(origin_mm(&harness, 0), [x_mm, y_mm]);
    // Felt at its new place, by the stroke that goes through the middle of the workspace.
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(120);
    let touched = (0..120).any(|_| {
        harness.step();
        loudest_um(&harness) > 0.1
    });
    assert!(touched, "the moved cloth is felt");
}

#[test]
fn a_textile_is_added_from_the_library_and_removed_by_a_key() {
    let folder = Folder::new("add");
    let mut harness = window(&folder.scene());
    harness.run();
    let item = harness.get_by_label("Add Ripple").rect().center();
    for _ in 0..2 {
        harness.drag_at(item);
        harness.drop_at(item);
        harness.step();
    }
    harness.run_steps(3);
    assert_eq!(
        harness.state().scene().textiles.len(),
        2,
        "a double click adds"
    );
    assert_eq!(harness.state().scene().textiles[1].label, "2");
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(
        harness.state().scene().textiles.len(),
        1,
        "the new one was chosen"
    );
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(
        !harness.state().is_edited(),
        "adding and removing are undone"
    );
}

#[test]
fn a_textile_is_dropped_where_it_was_dragged_to() {
    let folder = Folder::new("drop");
    let mut harness = window(&folder.scene());
    harness.run();
    let from = harness.get_by_label("Add Ripple").rect().center();
    let workspace = harness.get_by_label("Workspace with 1 textiles").rect();
    drag(&mut harness, from, workspace.center());
    let textiles = &harness.state().scene().textiles;
    assert_eq!(textiles.len(), 2, "{textiles:?}");
}

#[test]
fn a_vanished_textile_is_refused_with_a_notice_and_the_last_state_stays() {
    let folder = Folder::new("vanished");
    let mut harness = window(&folder.scene());
    harness.run();
    let other = folder.path("library/other");
    fs::create_dir_all(&other).unwrap();
    fs::write(
        other.join("textile.toml"),
        MANIFEST.replace("Ripple", "Other"),
    )
    .unwrap();
    harness.state_mut().open_scene(folder.scene());
    harness.run();
    let item = harness.get_by_label("Add Other").rect().center();
    for _ in 0..2 {
        harness.drag_at(item);
        harness.drop_at(item);
        harness.step();
    }
    harness.run_steps(3);
    let notices = harness.state().notices();
    assert!(
        notices
            .iter()
            .any(|notice| notice.contains("warp_forward.csv")),
        "{notices:?}"
    );
    assert_eq!(harness.state().scene().textiles.len(), 1, "taken back");
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "the last scene is still felt");
}

#[test]
fn keys_turn_the_display() {
    let folder = Folder::new("turn");
    let mut harness = window(&folder.scene());
    harness.run();
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::Q);
    }
    press(&mut harness, Modifiers::NONE, Key::E);
    assert_eq!(harness.state().turn_deg(), 10.0);
    press(&mut harness, Modifiers::NONE, Key::Num0);
    assert_eq!(harness.state().turn_deg(), 0.0);
}

#[test]
fn mute_and_solo_silence_bands_textiles_and_contactors_and_are_no_edits() {
    let folder = Folder::new("mute");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(20);
    let strongest = |harness: &Harness<'_, Workbench>, band: usize| {
        let amplitudes = harness.state().amplitudes_um();
        amplitudes.iter().map(|um| um[band]).fold(0.0, f64::max)
    };
    harness.get_by_label("Mute 40 Hz").click();
    harness.run_steps(3);
    assert_eq!(strongest(&harness, 0), 0.0);
    assert!(strongest(&harness, 1) > 0.1, "the other band is felt");
    harness.get_by_label("Feel 40 Hz alone").click();
    harness.run_steps(3);
    assert_eq!(loudest_um(&harness), 0.0, "one muted, the other not solo");
    press(&mut harness, Modifiers::NONE, Key::H);
    assert!(strongest(&harness, 0) > 0.1, "everything is felt again");
    harness.get_by_label("Mute 1 Ripple").click();
    harness.run_steps(3);
    assert_eq!(loudest_um(&harness), 0.0);
    assert!(!harness.state().is_edited(), "muting is no edit");
    assert_eq!(harness.state().tuning().gain_40_db, 0.0);
}

#[test]
fn an_exploration_is_recorded_replayed_stepped_and_saved() {
    let folder = Folder::new("record");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::R);
    assert!(
        harness.state().is_recording(),
        "{:?}",
        harness.state().notices()
    );
    stroke(&mut harness, 30);
    press(&mut harness, Modifiers::NONE, Key::R);
    let n_ticks = harness.state().n_recorded_ticks().unwrap();
    assert!((30..45).contains(&n_ticks), "{n_ticks} ticks");
    harness
        .get_by_role_and_label(Role::RadioButton, "Recording")
        .click();
    harness.run_steps(3);
    assert_eq!(
        harness.state().replayed_tick(),
        Some(0),
        "held at its start"
    );
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(10);
    let tick = harness.state().replayed_tick().unwrap();
    assert!((10..=16).contains(&tick), "{tick}");
    assert!(loudest_um(&harness) > 0.1, "and felt");
    press(&mut harness, Modifiers::NONE, Key::Space);
    let held = harness.state().replayed_tick().unwrap();
    harness.run_steps(5);
    assert_eq!(harness.state().replayed_tick(), Some(held), "it is held");
    press(&mut harness, Modifiers::NONE, Key::Period);
    assert_eq!(harness.state().replayed_tick(), Some(held + 1), "one tick");
    press(&mut harness, Modifiers::COMMAND, Key::E);
    let path = folder.path("take.csv");
    type_path(&mut harness, path.to_str().unwrap());
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(
        text.lines().count() as u64,
        n_ticks + 1,
        "a header and every tick"
    );
    press(&mut harness, Modifiers::COMMAND, Key::R);
    type_path(&mut harness, path.to_str().unwrap());
    assert_eq!(harness.state().n_recorded_ticks(), Some(n_ticks));
    assert_eq!(
        harness.state().replayed_tick(),
        Some(0),
        "and replayed next"
    );
}

#[test]
fn a_recording_that_is_none_is_refused_with_its_line() {
    let folder = Folder::new("norecording");
    let path = folder.path("broken.csv");
    fs::write(&path, "t_s,x_mm,y_mm\n0,1,2\n0,three,4\n").unwrap();
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::COMMAND, Key::R);
    type_path(&mut harness, path.to_str().unwrap());
    let notices = harness.state().notices();
    assert!(
        notices.iter().any(|n| n.contains("broken.csv:3")),
        "{notices:?}"
    );
    assert_eq!(harness.state().n_recorded_ticks(), None);
}

#[test]
fn the_emulator_is_let_go_while_it_is_armed() {
    let folder = Folder::new("letgo");
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    harness
        .get_by_role_and_label(Role::Button, "Disconnect")
        .click();
    wait(&mut harness, |bench| !bench.is_armed() && !bench.is_ready());
    assert!(!harness.state().is_stopped(), "letting go is no stop");
}

#[test]
fn unsaved_changes_are_asked_about_before_another_scene_is_opened() {
    let folder = Folder::new("unsaved");
    let mut harness = window(&folder.scene());
    harness.run();
    let compress = |harness: &mut Harness<'_, Workbench>| {
        let slider = harness.get_by_role_and_label(Role::Slider, "Compression");
        slider.set_value_accesskit(40.0);
        harness.run();
    };
    compress(&mut harness);
    harness.state_mut().open_scene(folder.scene());
    harness.run();
    assert!(harness.state().is_edited(), "still the edited one");
    harness.get_by_label("Cancel").click();
    harness.run();
    assert!(harness.state().is_edited(), "nothing was lost");
    harness.state_mut().open_scene(folder.scene());
    harness.run();
    harness.get_by_label("Discard").click();
    harness.run();
    assert!(!harness.state().is_edited(), "opened anew");
    assert_eq!(harness.state().tuning().compression, 0.0);
    compress(&mut harness);
    harness.state_mut().open_scene(folder.scene());
    harness.run();
    harness.get_by_role_and_label(Role::Button, "Save").click();
    harness.run();
    assert_eq!(
        harness.state().tuning().compression,
        0.4,
        "saved, then opened"
    );
    assert!(!harness.state().is_edited(), "and as in its file");
}

#[test]
fn filters_are_chosen_and_felt() {
    let folder = Folder::new("filters");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(20);
    let before = harness.state().amplitudes_um();
    harness
        .get_by_role_and_label(Role::Slider, "Width")
        .set_value_accesskit(4.0);
    harness.run_steps(4);
    let wide = selvedge_textile::tactile::Filters::LogGaussian { octaves: 4.0 };
    assert_eq!(harness.state().scene().filters, wide);
    let after = harness.state().amplitudes_um();
    assert!(after[9][0] > before[9][0], "wider filters take in more");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(!harness.state().is_edited(), "undone");
}

#[test]
fn a_tap_that_comes_and_goes_within_a_frame_chooses_a_textile() {
    let folder = Folder::with_size("tap", [60.0, 200.0]);
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::A);
    let cloth = harness.get_by_label("Textile 1 Ripple").rect().center();
    harness.hover_at(cloth);
    harness.step();
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos: cloth,
            button: eframe::egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert!(
        harness.state().scene().textiles.is_empty(),
        "chosen, then removed"
    );
}
