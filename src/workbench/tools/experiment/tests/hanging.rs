//! Sessions of cloths that hang: the pane hangs what the trial presents, and shows no more of it; a
//! trial counts only once its cloth was rubbed.

use super::presented::{arm, begun_on_array, present, rows};
use super::*;
use crate::tools::drape::Draping;
use eframe::egui::{Event, Id, Modifiers, PointerButton, Pos2, ViewportId, vec2};
use selvedge_experiment::Validity;

fn draping(window: &mut Headless) -> &mut Draping {
    window.workbench.tools.get_mut().unwrap()
}

fn key(window: &mut Headless) -> Option<String> {
    let chosen = &draping(window).chosen.cloths[0];
    chosen.textile.as_ref().map(|textile| textile.id.clone())
}

/// What hangs, where it is drawn.
fn cloth(window: &Headless) -> Pos2 {
    let shown = window.ctx.read_response(Id::unique("Hanging cloth"));
    shown.unwrap().rect.center()
}

fn button(window: &mut Headless, pos: Pos2, pressed: bool) {
    window.events.push(Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
    window.pass(1);
}

/// Pinches the cloth and moves the hand to and fro.
fn rub(window: &mut Headless, n_frames: u16) {
    let at = cloth(window);
    window.events.push(Event::PointerMoved(at));
    window.pass(20);
    button(window, at, true);
    window.pass(30);
    for nth in 0..n_frames {
        // About 100 mm/s: faster no bin sounds.
        let off = 40.0 * (0.05 * f32::from(nth)).sin();
        window.events.push(Event::PointerMoved(at + vec2(off, 0.0)));
        window.pass(1);
    }
    button(window, at, false);
}

#[test]
fn a_cloth_that_hangs_is_rated_once_it_was_rubbed_and_nothing_else_is_shown() {
    let folder = Folder::new("rating-hanging");
    let mut window = begun_on_array(&folder, "rating-hanging");
    window.pass(40);
    arm(&mut window);
    present(&mut window);
    let presented = session(&window).hanging_textile().unwrap().to_owned();
    assert_eq!(key(&mut window), Some(presented));
    window.pass(20);
    let missing = session(&window).missing().unwrap();
    assert!(missing.contains("not rubbed"), "{missing}");
    for scale in 0..4 {
        mark(&mut window, Mark::Rate(scale, 40.0));
    }
    answer(&mut window);
    window.pass(4);
    assert_eq!(session(&window).progress.0, 0, "nobody felt it");
    rub(&mut window, 160);
    assert_eq!(session(&window).missing(), None);
    answer(&mut window);
    window.pass(6);
    assert_eq!(session(&window).progress.0, 1);
    let presentation = rows(&folder)[0].presentation.clone();
    assert_eq!(presentation.validity(), Validity::Valid, "{presentation:?}");
    assert!(presentation.explored_s[0] >= 1.0, "{presentation:?}");
    end(&mut window);
    window.pass(4);
    assert_eq!(key(&mut window), None, "what hung before");
    assert!(!window.workbench.bench.live.is_cloth);
}

#[test]
fn a_cloth_hangs_in_the_participants_own_window_and_is_rubbed_there() {
    let folder = Folder::new("hanging-apart");
    let mut window = begun_on_array(&folder, "rating-hanging");
    window.pass(40);
    experiment_mut(&mut window).window.is_open = true;
    window.pass(2);
    arm(&mut window);
    present(&mut window);
    window.pass(20);
    // Without a display a second window is one within the first.
    let own = Id::unique(ViewportId::from_hash_of("participant"));
    let own = window.ctx.memory(|memory| memory.area_rect(own)).unwrap();
    let hung = window.ctx.read_response(Id::unique("Hanging cloth"));
    let hung = hung.unwrap().rect;
    assert!(own.contains_rect(hung), "{hung} in {own}");
    rub(&mut window, 160);
    let missing = session(&window).missing();
    assert!(missing.is_none_or(|line| !line.contains("not rubbed")));
}

#[test]
fn a_trial_waits_for_its_cloth_and_is_void_without_it() {
    let folder = Folder::new("no-cloth");
    let mut window = begun_on_array(&folder, "rating-hanging");
    window.pass(40);
    let now = ArrayNow {
        why_not: None,
        is_cloth: false,
        ..ArrayNow::of(&window.workbench.bench)
    };
    let waits = session(&window).waits_for(now);
    assert!(
        waits.is_some_and(|line| line.contains("is not felt")),
        "{waits:?}"
    );
    arm(&mut window);
    present(&mut window);
    window.pass(6);
    window.workbench.bench.feel_cloth(None);
    window.pass(4);
    let rows = rows(&folder);
    assert_eq!(rows.len(), 1);
    let void = &rows[0].presentation.void;
    assert!(void.contains("is not felt"), "{void}");
}
