//! The participant's window: the view goes there and comes back, and the session goes on.

use super::*;
use crate::bench::pane::Pane;
use crate::kit::view_transform::Pointed;

fn window_act(window: &mut Headless, act: WindowAct) {
    window.dispatch(ExperimentCommand::Window(act));
    window.pass(2);
}

#[test]
fn a_view_that_went_to_its_own_window_is_felt_there_and_comes_back() {
    let folder = Folder::new("apart");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let before = window.workbench.bench.transient.ground;
    assert!(before.is_some());
    window_act(&mut window, WindowAct::Open);
    assert_eq!(
        window.workbench.bench.transient.ground, None,
        "the workbench shows one line in its place"
    );
    // Without a display a second window is one within the first.
    let at = window
        .ctx
        .memory(|memory| {
            memory.area_rect(eframe::egui::Id::unique(
                eframe::egui::ViewportId::from_hash_of("participant"),
            ))
        })
        .unwrap();
    for n in 0..30_u8 {
        let stamp = window.workbench.bench.stamp();
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
    window_act(&mut window, WindowAct::Close);
    assert_eq!(window.workbench.bench.transient.ground, before);
    assert!(held(&window).trial().is_some(), "the session goes on");
    assert!(matches!(
        held(&window).draft,
        Draft::Odd {
            position: Some(1),
            ..
        }
    ));
}

#[test]
fn a_session_that_begins_while_the_window_is_open_brings_no_second_view() {
    let folder = Folder::new("apart-first");
    let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
    window.pass(2);
    window_act(&mut window, WindowAct::Open);
    let form = &mut window.workbench.bench.transient.experiment.form;
    form.choose(small(&folder, "odd-one-out"));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    window.dispatch(ExperimentCommand::Begin);
    window.pass(3);
    assert!(window.workbench.bench.transient.experiment.is_held());
    assert_eq!(window.workbench.bench.transient.ground, None);
    window.dispatch(ExperimentCommand::End);
    window.pass(3);
    assert!(window.workbench.bench.transient.experiment.window.is_open);
    assert!(arrangement_shows(&window, Pane::Experimenter));
}

fn arrangement_shows(window: &Headless, pane: Pane) -> bool {
    crate::shell::arrangement::is_shown(&window.workbench.shell.tree, pane)
}

#[test]
fn the_keyboard_is_lost_only_when_neither_window_has_it_for_a_while() {
    let mut window = ParticipantsWindow::default();
    window.act(WindowAct::Open);
    assert_eq!(window.left_alone_s(1.0, true), None);
    let wait_s = window.left_alone_s(1.1, false).unwrap();
    assert!((wait_s - 0.25).abs() < 1e-12);
    assert_eq!(window.left_alone_s(1.2, true), None, "it went to the other");
    assert!(window.left_alone_s(2.0, false).unwrap() > 0.0);
    assert_eq!(window.left_alone_s(2.3, false), Some(0.0));
    window.act(WindowAct::FillScreen(true));
    assert!(window.fills_screen);
    window.act(WindowAct::Close);
    assert_eq!(window, ParticipantsWindow::default());
    window.act(WindowAct::FillScreen(true));
    assert!(!window.fills_screen, "there is no window to fill it");
}

#[test]
fn a_movement_over_the_other_window_is_not_felt() {
    let folder = Folder::new("apart-pointer");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    explore(&mut window, 4);
    let mut moved_to = |over, pixel| {
        let stamp = window.workbench.bench.stamp();
        let mut tap = window.workbench.shell.tap.lock().unwrap();
        tap.moved_to_pixel(stamp, over, pixel);
        drop(tap);
        window.pass(2);
        window.workbench.bench.transient.live.centre
    };
    let before = moved_to(Pointed::Workbench, [320.0, 300.0]);
    assert!(before.is_some());
    assert_eq!(moved_to(Pointed::Participant, [420.0, 340.0]), before);
    assert_ne!(moved_to(Pointed::Workbench, [420.0, 340.0]), before);
}
