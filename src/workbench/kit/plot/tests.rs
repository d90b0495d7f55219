//! A chart under the hands of a simulated user.

use eframe::egui::{
    Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase, Vec2, vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::kit::theme;
use selvedge_chart::{Axis, Series, Style};

fn chart() -> Chart {
    Chart {
        x: Axis::log("speed, mm/s").within([1.0, 1000.0]),
        y: Axis::linear("level, dB").within([-40.0, 20.0]),
        series: vec![Series {
            name: "40 Hz".to_owned(),
            points: vec![[1.0, -30.0], [10.0, 0.0], [f64::NAN, 0.0], [1000.0, 10.0]],
            style: Style::LineAndDots,
            marked: vec![1],
            ..Series::default()
        }],
        ..Chart::default()
    }
}

/// Two linked charts; the state is the ends of the first one's horizontal axis and of the second's.
fn window<'a>(size: Vec2) -> Harness<'a, [[f64; 2]; 2]> {
    let mut is_styled = false;
    Harness::builder()
        .with_size(size)
        .with_step_dt(0.05)
        .with_max_steps(200)
        .build_ui_state(
            move |ui, ends: &mut [[f64; 2]; 2]| {
                if !is_styled {
                    theme::install(ui.ctx());
                    is_styled = true;
                }
                let (upper, lower) = ui.max_rect().split_top_bottom_at_fraction(0.5);
                for (nth, (rect, name)) in
                    [(upper, "Upper"), (lower, "Lower")].into_iter().enumerate()
                {
                    let setting = Setting {
                        name,
                        link: Some("speed"),
                        ..Setting::default()
                    };
                    if let Some(shown) = show(ui, rect, &chart(), &setting) {
                        let area = shown.area();
                        let corners = [area.left_bottom(), area.right_bottom()];
                        ends[nth] = corners.map(|at| shown.values_at(at)[0]);
                        let [x, y] = shown.values_at(shown.at([87.0, -12.5]));
                        let undone = [x / 87.0 - 1.0, y / -12.5 - 1.0];
                        assert!(undone.iter().all(|off| off.abs() < 1e-3), "{x} {y}");
                    }
                }
            },
            [[0.0; 2]; 2],
        )
}

fn close(found: [f64; 2], wanted: [f64; 2]) -> bool {
    found
        .iter()
        .zip(wanted)
        .all(|(found, wanted)| (found / wanted - 1.0).abs() < 0.02)
}

#[test]
fn the_wheel_zooms_linked_charts_and_a_double_click_shows_everything_again() {
    let mut harness = window(vec2(400.0, 400.0));
    harness.run();
    assert!(
        close(harness.state()[0], [1.0, 1000.0]),
        "{:?}",
        harness.state()
    );
    let middle = harness.get_by_label("Upper").rect().center();
    harness.hover_at(middle);
    harness.run();
    for _ in 0..3 {
        harness.event(eframe::egui::Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, 100.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        harness.run();
    }
    let [upper, lower] = *harness.state();
    assert!(upper[0] > 2.0 && upper[1] < 500.0, "{upper:?}");
    assert!(close(upper, lower), "{upper:?} {lower:?}");
    harness.drag_at(middle);
    harness.hover_at(middle + vec2(50.0, 0.0));
    harness.drop_at(middle + vec2(50.0, 0.0));
    harness.run();
    assert!(
        harness.state()[0][0] < 0.95 * upper[0],
        "{:?}",
        harness.state()
    );
    for pressed in [true, false, true, false] {
        harness.event(eframe::egui::Event::PointerButton {
            pos: middle,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.step();
    }
    harness.run();
    assert!(
        close(harness.state()[1], [1.0, 1000.0]),
        "{:?}",
        harness.state()
    );
}

#[test]
fn keys_zoom_and_move_what_has_the_focus() {
    use eframe::egui::Key;
    let mut harness = window(vec2(400.0, 400.0));
    harness.run();
    harness.get_by_label("Lower").focus();
    harness.run();
    harness.key_press(Key::Plus);
    harness.key_press(Key::Plus);
    harness.run();
    let zoomed = harness.state()[1];
    assert!(zoomed[0] > 1.5 && zoomed[1] < 700.0, "{zoomed:?}");
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert!(
        harness.state()[1][0] > 1.1 * zoomed[0],
        "{:?}",
        harness.state()
    );
    harness.key_press(Key::Backspace);
    harness.run();
    assert!(
        close(harness.state()[1], [1.0, 1000.0]),
        "{:?}",
        harness.state()
    );
}

#[test]
fn no_room_and_no_values_are_harmless() {
    for size in [vec2(1.0, 1.0), vec2(60.0, 900.0), vec2(900.0, 40.0)] {
        let mut harness = window(size);
        harness.run();
    }
}
