//! The whole window in every perspective, theme, size and scale; and what lies over it.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Rect, Theme, pos2};
use egui_kittest::kittest::Queryable as _;
use selvedge_workbench::Workbench;

use super::compare::Golden;
use super::stage::Stage;
use crate::program::Lab;

/// The size of the window in pixels in which every perspective is looked at in both themes.
const SIZE: [u16; 2] = [1400, 900];
/// A smaller one: what is arranged otherwise is so in either theme.
const SMALLER: [u16; 2] = [1280, 720];
/// Pixels per point of a fine screen: letters and lines of one perspective tell of all.
const FINE: f32 = 1.5;
/// A stroke has gone round by then.
const ROUND: u32 = 430;

/// Compares the whole window at a tick, by the name of the picture.
type Look = fn(&mut Golden, &mut Stage, &str, u32);

/// Compares the whole window.
fn dark(golden: &mut Golden, stage: &mut Stage, name: &str, tick: u32) {
    stage.until(tick);
    let dark = stage.window();
    golden.picture(&format!("{name}-dark"), &dark);
}

/// Compares the whole window in both themes.
fn both(golden: &mut Golden, stage: &mut Stage, name: &str, tick: u32) {
    dark(golden, stage, name, tick);
    stage.theme(Theme::Light);
    let light = stage.window();
    golden.picture(&format!("{name}-light"), &light);
    stage.theme(Theme::Dark);
}

#[test]
fn golden_perspectives() {
    let mut golden = Golden::of("pictures/perspectives");
    let looks: [([u16; 2], Look); 2] = [(SIZE, both), (SMALLER, dark)];
    for (size @ [width, height], compare) in looks {
        let name = |perspective: &str| format!("{perspective}-{width}x{height}");
        let mut stage = Stage::new(None, size, 1.0);
        stage.press(Modifiers::NONE, Key::Space);
        compare(&mut golden, &mut stage, &name("explore"), ROUND);
        stage.press(Modifiers::COMMAND, Key::Num2);
        compare(&mut golden, &mut stage, &name("cloth"), ROUND + 60);
        stage.press(Modifiers::COMMAND, Key::Num3);
        compare(&mut golden, &mut stage, &name("experiment"), ROUND + 120);
    }
    let mut stage = Stage::new(None, SIZE, FINE);
    stage.press(Modifiers::NONE, Key::Space);
    dark(&mut golden, &mut stage, "explore-1400x900-at-150", ROUND);
    golden.finish();
}

#[test]
fn golden_screenshot() {
    let mut golden = Golden::of("pictures/screenshot");
    let lab = Lab::named("screenshot");
    lab.print(&["screenshot", "--out", "window.png"]);
    let picture = image::open(lab.path("window.png")).unwrap().into_rgba8();
    // The rest looks as in the window; here the emulator is ready.
    let right = image::imageops::crop_imm(&picture, 1072, 0, 328, 900).to_image();
    golden.picture("with-the-emulator-ready", &right);
    golden.finish();
}

#[test]
fn golden_stage() {
    let mut golden = Golden::of("pictures/stage");
    let lab = Lab::named("stage");
    let states = [
        "watching",
        "touching",
        "offered",
        "armed",
        "guessing",
        "told",
        "still-here",
        "ended",
        "pin",
    ];
    let small = states.map(|state| (state, ["1280", "720", "1"]));
    let others = [("guessing", ["1080", "1920", "1"])];
    for (state, [width, height, scale]) in small.into_iter().chain(others) {
        let size = ["--width", width, "--height", height, "--scale", scale];
        let words = ["screenshot", "--stage", state, "--out", "stage.png"];
        lab.print(&[&words[..], &size].concat());
        let picture = image::open(lab.path("stage.png")).unwrap().into_rgba8();
        golden.picture(&format!("{state}-{width}x{height}"), &picture);
    }
    golden.finish();
}

#[test]
fn golden_armed() {
    let mut golden = Golden::of("pictures/armed");
    let mut stage = Stage::new(None, [1400, 900], 1.0);
    stage.harness.state_mut().connect_emulator();
    stage.wait(Workbench::is_ready);
    stage.click(Role::Button, "Arm");
    stage.wait_to_see(Workbench::is_armed);
    // The device lives in real time, and so do its state and its counters beside these.
    golden.picture("header", &stage.part(place([1190.0, 0.0, 1400.0, 44.0])));
    golden.picture("disarm", &stage.part(place([1072.0, 474.0, 1400.0, 516.0])));
    golden.finish();
}

fn place([left, top, right, bottom]: [f32; 4]) -> Rect {
    Rect::from_min_max(pos2(left, top), pos2(right, bottom))
}

/// A part of the window as a picture of its own, points.
fn over(golden: &mut Golden, stage: &mut Stage, name: &str, corners: [f32; 4]) {
    stage.harness.run_steps(20);
    golden.picture(name, &stage.part(place(corners)));
}

#[test]
fn golden_overlays() {
    let mut golden = Golden::of("pictures/overlays");
    let mut stage = Stage::new(None, [1400, 900], 1.0);
    stage.press(Modifiers::NONE, Key::F1);
    over(
        &mut golden,
        &mut stage,
        "keys",
        [300.0, 40.0, 1100.0, 860.0],
    );
    stage.press(Modifiers::NONE, Key::F1);
    let corner = [90.0, 0.0, 500.0, 460.0];
    for (menu, name) in [("Scene", "scene-menu"), ("View", "view-menu")] {
        stage.click_named(menu);
        over(&mut golden, &mut stage, name, corner);
        stage.click_named(menu);
    }
    let slider = stage
        .harness
        .get_by_role_and_label(Role::Slider, "Compression");
    slider.set_value_accesskit(40.0);
    stage.harness.run_steps(3);
    stage.press(Modifiers::COMMAND, Key::N);
    let top = [300.0, 40.0, 1100.0, 160.0];
    over(&mut golden, &mut stage, "question", top);
    stage.click_named("Discard");
    let whole = [0.0, 0.0, 1400.0, 900.0];
    over(&mut golden, &mut stage, "new-scene", whole);
    golden.finish();
}
