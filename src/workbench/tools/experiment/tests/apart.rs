//! The participant's window: the view goes there and comes back, and the session goes on.

use eframe::egui::{Event, Modifiers, PointerButton, Shape};

use super::*;
use crate::bench::command::ShowCommand;
use crate::kit::view_transform::Pointed;

fn open(window: &mut Headless, is_open: bool) {
    experiment_mut(window).window.is_open = is_open;
    window.pass(2);
}

#[test]
fn a_view_that_went_to_its_own_window_is_felt_there_and_comes_back() {
    let folder = Folder::new("apart");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let before = window.workbench.bench.pointer.ground;
    assert!(before.is_some());
    open(&mut window, true);
    assert_eq!(
        window.workbench.bench.pointer.ground, None,
        "the workbench shows one line in its place"
    );
    // Without a display a second window is one within the first.
    let at = window
        .ctx
        .memory(|memory| {
            memory.area_rect(eframe::egui::Id::unique(ViewportId::from_hash_of(
                "participant",
            )))
        })
        .unwrap();
    for n in 0..30_u8 {
        let stamp = window.workbench.bench.clock.stamp();
        let to = at.center() + vec2(-90.0 + 6.0 * f32::from(n), -60.0);
        window
            .workbench
            .shell
            .tap
            .lock()
            .unwrap()
            .moved_to(stamp, to);
        window.pass(1);
    }
    let amplitudes_um = window.workbench.amplitudes_um();
    assert!(amplitudes_um.iter().flatten().any(|um| *um > 0.0));
    mark(&mut window, Mark::Place(1));
    open(&mut window, false);
    assert_eq!(window.workbench.bench.pointer.ground, before);
    assert!(session(&window).trial().is_some(), "the session goes on");
    assert!(matches!(
        session(&window).draft,
        Draft::Choose {
            position: Some(1),
            ..
        }
    ));
}

#[test]
fn a_session_that_begins_while_the_window_is_open_brings_no_second_view() {
    let folder = Folder::new("apart-first");
    let mut window = Headless::shipped();
    window.pass(2);
    open(&mut window, true);
    let form = &mut experiment_mut(&mut window).form;
    form.choose(small(&folder, "odd-one-out"));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    begin(&mut window);
    window.pass(3);
    assert!(experiment(&window).session.is_some());
    assert_eq!(window.workbench.bench.pointer.ground, None);
    end(&mut window);
    window.pass(3);
    assert!(experiment(&window).window.is_open);
    assert!(arrangement_shows(&window, Pane::Experimenter));
}

fn arrangement_shows(window: &Headless, pane: Pane) -> bool {
    crate::shell::arrangement::is_shown(&window.workbench.shell.tree, pane)
}

#[test]
fn a_movement_over_the_other_window_is_not_felt() {
    let folder = Folder::new("apart-pointer");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    explore(&mut window, 4);
    let mut moved_to = |over, pixel| {
        let stamp = window.workbench.bench.clock.stamp();
        let mut tap = window.workbench.shell.tap.lock().unwrap();
        tap.moved_to_pixel(stamp, over, (0, pixel));
        drop(tap);
        window.pass(2);
        window.workbench.bench.live.centre
    };
    let before = moved_to(Pointed::Workbench, [320.0, 300.0]);
    assert!(before.is_some());
    assert_eq!(moved_to(Pointed::Participant, [420.0, 340.0]), before);
    assert_ne!(moved_to(Pointed::Workbench, [420.0, 340.0]), before);
}

#[test]
fn a_corner_of_a_covered_pane_changes_nothing_and_says_why() {
    let folder = Folder::new("corner");
    let mut window = begun(&folder, "odd-one-out", "p01");
    window.dispatch(ShowCommand::Reveal(Pane::Heatmaps));
    window.pass(2);
    let mut output = window.run();
    output.textures_delta.clear();
    let numbers = output
        .shapes
        .iter()
        .find_map(|clipped| match &clipped.shape {
            Shape::Text(text) if text.galley.text() == "123" => Some(text.visual_bounding_rect()),
            _ => None,
        });
    let at = numbers.expect("the corner is drawn").center();
    assert!(window.workbench.notices().is_empty());
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for event in [Event::PointerMoved(at), press(true), press(false)] {
        window.events.push(event);
        window.pass(1);
    }
    let preferences = &window.workbench.bench.settings.preferences;
    assert!(!preferences.has_numbers);
    let notices = window.workbench.notices();
    assert!(notices[0].contains("A session is held"), "{notices:?}");
}
