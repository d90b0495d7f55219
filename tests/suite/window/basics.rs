//! The window as a whole: it feels, tunes, undoes, stops, opens, saves, and stands still.

use std::fs;
use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use selvedge_workbench::{Picture, Screenshot, Theme, Workbench, screenshot};

use super::*;

#[test]
fn moving_the_pointer_over_a_textile_lights_the_heatmaps() {
    let folder = Folder::new("move");
    let mut harness = window(&folder.scene());
    harness.run();
    assert_eq!(loudest_um(&harness), 0.0, "nothing moved yet");
    let heatmaps = harness.get_by_label_contains("Heatmaps").rect();
    let dark = harness.render().unwrap();
    stroke(&mut harness, 30);
    let amplitudes = harness.state().amplitudes_um();
    assert_eq!(amplitudes.len(), 24);
    assert!(
        amplitudes
            .iter()
            .all(|[low, high]| *low > 0.1 && *high > 0.1),
        "{amplitudes:?}"
    );
    let lit = harness.render().unwrap();
    let cell = heatmaps.min + vec2(12.0, 34.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a pixel"
    )]
    let pixel = |picture: &image::RgbaImage| picture.get_pixel(cell.x as u32, cell.y as u32).0;
    assert_ne!(pixel(&dark), pixel(&lit), "the first cell of the 40 Hz map");
}

#[test]
fn one_drag_of_a_slider_is_one_step_of_undo() {
    let folder = Folder::new("drag");
    let mut harness = window(&folder.scene());
    harness.run();
    let slider = harness.get_by_role_and_label(Role::Slider, "Master").rect();
    harness.drag_at(slider.center());
    harness.step();
    for x in 1..=12_u8 {
        harness.hover_at(slider.center() + vec2(-3.0 * f32::from(x), 0.0));
        harness.step();
    }
    harness.drop_at(slider.center() + vec2(-36.0, 0.0));
    harness.run();
    let dragged = harness.state().tuning().gain_db;
    assert!(dragged < -5.0, "dragged to {dragged} dB");
    assert!(harness.state().is_edited(), "the scene is edited");
    let shown = |name: &str| {
        let slider = harness.get_by_role_and_label(Role::Slider, name);
        slider.accesskit_node().numeric_value().unwrap()
    };
    assert_eq!(
        (shown("40 Hz"), shown("320 Hz")),
        (0.0, 0.0),
        "bands keep theirs"
    );
    assert_eq!(shown("Master"), dragged);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.state().tuning().gain_db, 0.0);
    assert!(
        !harness.state().is_edited(),
        "one step took everything back"
    );
    press(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(harness.state().tuning().gain_db, dragged);
}

#[test]
fn a_gain_is_felt_and_its_undo_too() {
    let folder = Folder::new("gain");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 20);
    let before_um = loudest_um(&harness);
    harness
        .get_by_role_and_label(Role::Slider, "Master")
        .set_value_accesskit(-20.0);
    stroke(&mut harness, 20);
    let ratio = loudest_um(&harness) / before_um;
    assert!((ratio - 0.1).abs() < 0.02, "−20 dB is a tenth, got {ratio}");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    stroke(&mut harness, 20);
    assert!(
        (loudest_um(&harness) / before_um - 1.0).abs() < 0.2,
        "undone"
    );
}

#[test]
fn values_can_be_typed_with_their_unit() {
    let folder = Folder::new("type");
    let mut harness = window(&folder.scene());
    harness.run();
    harness
        .get_by_role_and_label(Role::Button, "40 Hz value")
        .click();
    harness.run();
    let field = harness.get_by_role_and_label(Role::TextInput, "40 Hz value");
    field.type_text("x");
    harness.run();
    assert_eq!(
        harness.state().tuning().gain_40_db,
        0.0,
        "letters are no gain"
    );
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text("−6,5 dB".to_owned()));
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().tuning().gain_40_db, -6.5);
}

#[test]
fn escape_silences_from_anywhere_also_while_typing() {
    let folder = Folder::new("escape");
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "felt before");
    harness
        .get_by_role_and_label(Role::Button, "Master value")
        .click();
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    wait(&mut harness, |bench| {
        bench.is_stopped() && !bench.is_armed()
    });
    stroke(&mut harness, 20);
    assert_eq!(
        loudest_um(&harness),
        0.0,
        "and silent though the pointer moves"
    );
    harness.get_by_label("ALL OFF");
    harness.get_by_label("Go on").click();
    harness.run_steps(2);
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "shown again");
    assert!(!harness.state().is_armed(), "and not armed");
    assert!(harness.query_by_label("ALL OFF").is_none());
}

#[test]
fn with_nothing_armed_escape_ends_typing_and_closes_menus_and_nothing_else() {
    let folder = Folder::new("escape-unarmed");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(10);
    harness.get_by_label("Port").click();
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    harness.get_by_label("View").click();
    harness.run_steps(3);
    assert!(
        harness
            .query_by_label_contains("Default arrangement")
            .is_some()
    );
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(
        harness
            .query_by_label_contains("Default arrangement")
            .is_none()
    );
    assert!(!harness.state().is_silent(), "it still moves");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.state().is_silent() && !harness.state().is_stopped());
    assert!(loudest_um(&harness) > 0.1, "what it felt last is shown");
}

#[test]
fn titles_of_panes_stand_still_whichever_is_in_front() {
    let folder = Folder::new("titles");
    let mut harness = window(&folder.scene());
    harness.run();
    let titles = ["Why", "Response", "Accuracy", "Compare"];
    let places =
        |harness: &Harness<'_, Workbench>| titles.map(|title| harness.get_by_label(title).rect());
    let before = places(&harness);
    for title in titles {
        click_tab(&mut harness, title);
        assert_eq!(places(&harness), before, "{title} is in front");
    }
}

#[test]
fn the_emulator_is_armed_by_a_button_and_disarmed_by_escape() {
    let folder = Folder::new("arm");
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    harness.key_press(Key::Escape);
    wait(&mut harness, |bench| {
        bench.is_stopped() && !bench.is_armed()
    });
    wait(&mut harness, Workbench::is_ready);
}

#[test]
fn a_scene_that_does_not_parse_leaves_a_notice_and_the_last_one_in_place() {
    let folder = Folder::new("broken");
    let broken = folder.path("broken.scene.toml");
    fs::write(&broken, SCENE.replace("origin_mm", "orogin_mm")).unwrap();
    let mut harness = window(&folder.scene());
    harness.run();
    for path in [broken, folder.path("nowhere.scene.toml")] {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        harness.state_mut().open_scene(path);
        harness.run();
        let notices = harness.state().notices();
        assert!(
            notices.iter().any(|notice| notice.contains(&name)),
            "{notices:?}"
        );
        assert_eq!(harness.state().scene_name(), "Test");
    }
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "the last scene is still felt");
    for _ in 0..2 {
        harness
            .get_all_by_label("Close the notice")
            .next()
            .unwrap()
            .click();
        harness.run();
    }
    assert!(harness.state().notices().is_empty(), "put away");
}

#[test]
fn a_port_that_is_missing_is_named_in_a_notice() {
    let folder = Folder::new("port");
    let mut harness = window(&folder.scene());
    harness.run();
    connect_to(&mut harness, "/nowhere/port");
    wait(&mut harness, |bench| {
        bench.notices().iter().any(|n| n.contains("/nowhere/port"))
    });
    assert!(!harness.state().is_armed(), "nothing to arm");
}

#[test]
fn a_scene_is_saved_and_opened_by_its_path() {
    let folder = Folder::new("save");
    let mut harness = window(&folder.scene());
    harness.run();
    harness
        .get_by_role_and_label(Role::Slider, "Compression")
        .set_value_accesskit(40.0);
    harness.run();
    press(&mut harness, Modifiers::COMMAND, Key::S);
    assert!(
        !harness.state().is_edited(),
        "saved: {:?}",
        harness.state().notices()
    );
    let text = fs::read_to_string(folder.scene()).unwrap();
    assert!(text.contains("compression = 0.4"), "{text}");
    press(&mut harness, Modifiers::COMMAND, Key::O);
    let field = harness.get_by_role_and_label(Role::TextInput, "Open scene");
    assert_eq!(field.value().as_deref(), folder.scene().to_str());
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.run();
    assert_eq!(harness.state().tuning().compression, 0.4);
}

#[test]
fn a_still_scene_is_not_drawn_again_and_a_moving_one_thirty_times_a_second() {
    let folder = Folder::new("still");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(10);
    let moving = repaint_delay(&harness);
    assert!(
        moving > Duration::from_millis(20) && moving < Duration::from_millis(40),
        "{moving:?}"
    );
    press(&mut harness, Modifiers::NONE, Key::Space);
    // The trail fades in 0.8 s; the tip of a hovered control has long been asked for.
    harness.run_steps(60);
    assert_eq!(repaint_delay(&harness), Duration::MAX, "still");
    assert!(harness.state().is_silent(), "what is held is silent");
}

#[test]
fn the_display_explores_by_itself_while_sliders_move() {
    let folder = Folder::new("stroke");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(20);
    assert!(loudest_um(&harness) > 0.1, "it moves and is felt");
    harness
        .get_by_role_and_label(Role::Slider, "320 Hz")
        .set_value_accesskit(-30.0);
    harness.run_steps(5);
    assert_eq!(harness.state().tuning().gain_320_db, -30.0);
    press(&mut harness, Modifiers::NONE, Key::Space);
    harness.run_steps(60);
    assert!(harness.state().is_silent(), "it rests");
}

#[test]
fn a_screenshot_is_the_same_every_time_and_shows_what_is_felt() {
    let folder = Folder::new("screenshot");
    let wanted = |theme, width, height, pixels_per_point| Screenshot {
        scene: Some(folder.scene()),
        width,
        height,
        pixels_per_point,
        theme,
        ..Screenshot::default()
    };
    let dark = screenshot(&wanted(Theme::Dark, 1280, 720, 1.0)).unwrap();
    assert_eq!(
        dark,
        screenshot(&wanted(Theme::Dark, 1280, 720, 1.0)).unwrap()
    );
    assert_eq!(
        (dark.width, dark.height, dark.rgba.len()),
        (1280, 720, 4 * 1280 * 720)
    );
    assert!(has_green(&dark), "the contactors are lit");
    let light = screenshot(&wanted(Theme::Light, 1280, 720, 2.0)).unwrap();
    let mean =
        |p: &Picture| p.rgba.iter().map(|&c| u64::from(c)).sum::<u64>() / p.rgba.len() as u64;
    assert!(
        mean(&light) > mean(&dark) + 60,
        "light is lighter than dark"
    );
}

/// Whether many pixels are of the contactors' green.
fn has_green(picture: &Picture) -> bool {
    let is_green = |p: &&[u8]| p[1] > 200 && p[0] < 120 && p[2] < 180;
    picture.rgba.chunks_exact(4).filter(is_green).count() > 500
}

#[test]
fn a_screenshot_of_nothing_or_of_a_broken_scene_is_refused_in_one_line() {
    let folder = Folder::new("refused");
    let tiny = Screenshot {
        width: 8,
        ..Screenshot::default()
    };
    let missing = Screenshot {
        scene: Some(folder.path("no.scene.toml")),
        ..Screenshot::default()
    };
    for wanted in [tiny, missing] {
        let error = screenshot(&wanted).unwrap_err().to_string();
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}
