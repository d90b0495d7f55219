//! The line of time in the real window: wheel, drag, two clicks and the cursor.

use std::fs;

use eframe::egui::{Event, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, TouchPhase, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use selvedge_workbench::Workbench;

use super::{Folder, window};

/// A window that replays a hundred seconds of to and fro.
fn replaying(folder: &Folder) -> Harness<'static, Workbench> {
    let path = folder.path("slow.csv");
    fs::write(&path, "t_s,x_mm,y_mm\n0,10,90\n50,190,90\n100,10,90\n").unwrap();
    let mut harness = window(&folder.scene());
    harness.run();
    harness.state_mut().open_recording(path);
    harness.run_steps(4);
    let tick = harness.state().replayed_tick();
    assert_eq!(tick, Some(0), "it waits at its first");
    harness
}

/// A place in the lanes, at a share of the width.
fn place(harness: &Harness<'_, Workbench>, share: f32) -> Pos2 {
    let rect = harness.get_by_label_contains("Timeline of").rect();
    rect.lerp_inside(vec2(share, 0.6))
}

/// Clicks there; the tick that the recording goes to.
fn tick_at(harness: &mut Harness<'_, Workbench>, share: f32) -> u64 {
    let at = place(harness, share);
    // Longer than two clicks may take.
    harness.run_steps(20);
    harness.hover_at(at);
    harness.step();
    harness.drag_at(at);
    harness.step();
    harness.drop_at(at);
    harness.run_steps(4);
    harness.state().replayed_tick().unwrap()
}

fn turn_wheel(harness: &mut Harness<'_, Workbench>, share: f32, points: f32) {
    let at = place(harness, share);
    harness.hover_at(at);
    harness.step();
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, points),
        source: MouseWheelSource::Unknown,
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(20);
}

#[test]
fn the_wheel_zooms_a_drag_moves_and_two_clicks_show_all_again() {
    let folder = Folder::new("time");
    let mut harness = replaying(&folder);
    let [left, right] = [0.3, 0.8].map(|share| tick_at(&mut harness, share));
    assert!(left + 1_500 < right && right < 4_000, "{left} {right}");
    turn_wheel(&mut harness, 0.3, 400.0);
    let [near, nearer] = [0.3, 0.8].map(|share| tick_at(&mut harness, share));
    assert!(near.abs_diff(left) < 30, "held under the pointer: {near}");
    assert!(nearer - near < (right - left) / 3, "{near} {nearer}");
    let (from, to) = (place(&harness, 0.7), place(&harness, 0.4));
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    for share in [0.3, 0.6, 1.0] {
        harness.hover_at(from.lerp(to, share));
        harness.step();
    }
    harness.drop_at(to);
    harness.run_steps(4);
    assert_eq!(
        harness.state().replayed_tick(),
        Some(nearer),
        "it moves no cursor"
    );
    let moved = tick_at(&mut harness, 0.3);
    assert!(moved > near + 50, "{moved} after {near}");
    harness.run_steps(20);
    let at = place(&harness, 0.5);
    for _ in 0..2 {
        harness.drag_at(at);
        harness.step();
        harness.drop_at(at);
        harness.step();
    }
    harness.run_steps(4);
    assert_eq!(tick_at(&mut harness, 0.3), left, "all of it again");
}
