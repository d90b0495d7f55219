//! Around the workspace: the wheel, true size, and a recording that goes round while gains change.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use selvedge_workbench::Workbench;

use super::{Folder, loudest_um, on_cloth, press, stroke, window};

/// What the workspace says of its magnification, pixels per millimetre.
fn magnification(harness: &Harness<'_, Workbench>) -> f64 {
    let label = harness.get_by(|node| {
        let text = node.label().or_else(|| node.value());
        text.is_some_and(|text| text.ends_with("px/mm"))
    });
    let node = label.accesskit_node();
    let text = node.label().or_else(|| node.value()).unwrap();
    text.split_whitespace().next().unwrap().parse().unwrap()
}

/// Turns the wheel over the cloth: up is positive.
fn turn_wheel(harness: &mut Harness<'_, Workbench>, points: f32) {
    let at = on_cloth(harness);
    harness.hover_at(at);
    harness.step();
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, points),
        source: MouseWheelSource::Unknown,
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
}

#[test]
fn the_wheel_zooms_about_the_pointer_and_fit_shows_all_again() {
    let folder = Folder::new("wheel");
    let mut harness = window(&folder.scene());
    harness.run();
    let fit = magnification(&harness);
    turn_wheel(&mut harness, 200.0);
    let near = magnification(&harness);
    assert!(near > 1.2 * fit, "{fit} → {near} px/mm");
    turn_wheel(&mut harness, -200.0);
    let far = magnification(&harness);
    assert!((far - fit).abs() < 0.11, "{fit} → {far} px/mm");
    turn_wheel(&mut harness, 300.0);
    harness.get_by_role_and_label(Role::Button, "Fit").click();
    harness.run_steps(3);
    assert_eq!(magnification(&harness).to_bits(), fit.to_bits());
}

#[test]
fn a_screen_is_measured_once_and_then_shows_true_size() {
    let folder = Folder::new("truesize");
    let mut harness = window(&folder.scene());
    harness.run();
    harness.get_by_role_and_label(Role::Button, "1:1").click();
    harness.run_steps(3);
    let crosses = ["First cross", "Second cross"];
    let [first, second] = crosses.map(|name| harness.get_by_label(name).rect().center());
    let pixels = f64::from(second.x - first.x);
    // A ruler that says there are four pixels in a millimetre.
    harness.event(Event::Text("nonsense".to_owned()));
    harness.run_steps(2);
    harness.get_by_label("Use").click();
    harness.run_steps(2);
    assert!(
        harness
            .query_by_label_contains("Type the distance")
            .is_some(),
        "it says what it wants"
    );
    let is_field = |label: &str| label.starts_with("Measure the distance");
    let field = harness.get_by(|node| {
        node.role() == Role::TextInput && node.label().is_some_and(|label| is_field(&label))
    });
    field.focus();
    harness.run_steps(1);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(format!("{}", pixels / 4.0)));
    harness.run_steps(2);
    harness.get_by_label("Use").click();
    harness.run_steps(5);
    assert!(
        harness.query_by_label("First cross").is_none(),
        "it is over"
    );
    harness.get_by_role_and_label(Role::Button, "1:1").click();
    harness.run_steps(5);
    assert!(
        harness.query_by_label("First cross").is_none(),
        "it is known"
    );
    let workspace = harness.get_by_label("Workspace with 1 textiles").rect();
    assert!(workspace.is_positive());
    assert_eq!(
        harness.get_all_by_label("1:1").count(),
        2,
        "button and state"
    );
}

#[test]
fn a_recording_goes_round_while_a_gain_is_changed() {
    let folder = Folder::new("loop");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::R);
    stroke(&mut harness, 24);
    press(&mut harness, Modifiers::NONE, Key::R);
    let n_ticks = harness.state().n_recorded_ticks().unwrap();
    harness
        .get_by_role_and_label(Role::RadioButton, "Recording")
        .click();
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::L);
    press(&mut harness, Modifiers::NONE, Key::Space);
    let loudest = |harness: &mut Harness<'_, Workbench>| {
        let mut most = 0.0_f64;
        let mut ticks = Vec::new();
        for _ in 0..n_ticks {
            harness.step();
            most = most.max(loudest_um(harness));
            ticks.extend(harness.state().replayed_tick());
        }
        assert!(ticks.windows(2).any(|pair| pair[1] < pair[0]), "{ticks:?}");
        most
    };
    let before = loudest(&mut harness);
    let master = harness.get_by_role_and_label(Role::Slider, "Master");
    let gain_db = harness.state().tuning().gain_db;
    master.set_value_accesskit(gain_db - 6.0);
    harness.run_steps(2);
    let after = loudest(&mut harness);
    let change_db = 20.0 * (after / before).log10();
    assert!((change_db + 6.0).abs() < 0.1, "{change_db} dB");
}

/// What the Why pane begins with.
fn explained_tick(harness: &Harness<'_, Workbench>) -> u64 {
    let head = harness.get_by(|node| {
        let text = node.label().or_else(|| node.value());
        text.is_some_and(|text| text.starts_with("Contactor ") && text.contains("   tick "))
    });
    let node = head.accesskit_node();
    let text = node.label().or_else(|| node.value()).unwrap();
    text.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
fn the_explanation_steps_through_a_recording_tick_by_tick_unless_it_is_held() {
    let folder = Folder::new("whystep");
    let mut harness = window(&folder.scene());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::R);
    stroke(&mut harness, 24);
    press(&mut harness, Modifiers::NONE, Key::R);
    harness
        .get_by_role_and_label(Role::RadioButton, "Recording")
        .click();
    harness.run_steps(2);
    harness.get_by_label("Why").click();
    harness.run_steps(3);
    let place = |harness: &Harness<'_, Workbench>| {
        let is_place = |text: &str| text.ends_with(" mm") && text.contains(" / ");
        let nodes = harness.query_all_by(|node| {
            let text = node.label().or_else(|| node.value());
            text.is_some_and(|text| is_place(&text))
        });
        let texts = nodes.filter_map(|node| {
            let node = node.accesskit_node();
            node.label().or_else(|| node.value())
        });
        texts.collect::<Vec<_>>()
    };
    let mut places = vec![place(&harness)];
    let mut ticks = vec![explained_tick(&harness)];
    for _ in 0..12 {
        press(&mut harness, Modifiers::NONE, Key::Period);
        ticks.push(explained_tick(&harness));
        places.push(place(&harness));
    }
    assert!(ticks.windows(2).all(|pair| pair[0] < pair[1]), "{ticks:?}");
    assert_ne!(
        places[0], places[12],
        "the stroke begins within twelve ticks"
    );
    harness
        .get_by_label_contains("Hold the explanation")
        .click();
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Period);
    assert_eq!(explained_tick(&harness), ticks[12], "it is held");
}
