//! What a visit in the window is counted by, and what is said and read out of it.

use eframe::egui::{TouchPhase, vec2};

use super::window::{FULL_HD, finger, opened, square, stage, stroke, with_pin};
use crate::shell::headless::Headless;
use crate::tools::stage::act::Act;
use crate::tools::stage::machine::Phase;

#[test]
fn a_sleeve_that_trembles_keeps_no_visit_open_and_a_hand_that_strokes_does() {
    for (reach, stays) in [(1.0_f32, false), (8.0, true)] {
        let mut window = opened(with_pin(), FULL_HD, 1.0);
        let at = square(&mut window).center();
        window.events.push(finger(1, TouchPhase::Start, at));
        window.pass(1);
        // 41 s, to and fro by a quarter of a millimetre or by two.
        for n in 0..410_u16 {
            let off = vec2(if n % 2 == 0 { reach } else { 0.0 }, 0.0);
            window.events.push(finger(1, TouchPhase::Move, at + off));
            window.pass_ticks(4);
        }
        let phase = stage(&mut window).machine.phase();
        assert_eq!(matches!(phase, Phase::Touching), stays, "by {reach} px");
    }
}

#[test]
fn words_that_stand_by_themselves_are_read_out_once() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    window.ctx.enable_accesskit();
    window.pass(2);
    let update = window.run().platform_output.accesskit_update.unwrap();
    let words = update
        .nodes
        .iter()
        .filter_map(|(_, node)| node.value().or_else(|| node.label()));
    let mut words: Vec<&str> = words.collect();
    words.sort_unstable();
    for once in [
        "Stroke the cloth.",
        "Shown 160× slower.",
        "Larger letters, more contrast",
    ] {
        let n = words.iter().filter(|word| **word == once).count();
        assert_eq!(n, 1, "{once} in {words:?}");
    }
    assert!(!words.contains(&"Aa"), "{words:?}");
}

#[test]
fn sound_that_is_off_is_not_said_to_be_heard() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    let at = square(&mut window).center();
    stroke(&mut window, at, 12, false);
    let words = |window: &mut Headless| {
        let lines = stage(window).drawn.lines.iter();
        lines.map(|(line, _)| line.clone()).collect::<Vec<_>>()
    };
    let mut said = Vec::new();
    for _ in 0..4 {
        let input = stage(&mut window).senses.input();
        stage(&mut window).machine.act(Act::Sound, input);
        window.pass(2);
        said.extend(
            words(&mut window)
                .into_iter()
                .filter(|line| line.contains("heard") || line.contains("off")),
        );
    }
    said.dedup();
    assert_eq!(
        said.iter().filter(|line| *line == "Sound is off.").count(),
        1,
        "{said:?}"
    );
    assert!(
        said.iter().any(|line| line == "40 Hz, heard by overtones."),
        "{said:?}"
    );
}
