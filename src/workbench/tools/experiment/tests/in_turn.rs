//! Cloth in intervals: felt one after the other at one place, and answered once each was.

use super::presented::{arm, begun_on_array, present, rows, strongest_um};
use super::*;
use crate::tools::experiment::in_turn::Intervals;
use selvedge_experiment::Validity;

const DESIGN: &str = "roughness-intervals";

/// The corner of what lies there.
fn corner(window: &Headless) -> Point {
    session(window).layout.places[0].origin_mm
}

/// What the participant's screen says of the intervals.
fn intervals(window: &Headless) -> Intervals {
    session(window).intervals().unwrap()
}

#[test]
fn two_cloths_are_felt_in_turn_and_a_key_says_which() {
    let folder = Folder::new("in-turn");
    let mut window = begun_on_array(&folder, DESIGN);
    window.dispatch(DeviceCommand::ConnectEmulator);
    arm(&mut window);
    present(&mut window);
    let corner = corner(&window);
    // What is felt while each is lit, and between them.
    let mut felt: Vec<(Option<usize>, u32, u32)> = Vec::new();
    for n in 0..220 {
        stroke(&mut window, corner, n..n + 1);
        let played = intervals(&window).played;
        let is_felt = u32::from(strongest_um(&window) > 0.0);
        match felt.last_mut().filter(|last| last.0 == played) {
            Some((_, n_ticks, n_felt)) => {
                *n_ticks += 1;
                *n_felt += is_felt;
            }
            None => felt.push((played, 1, is_felt)),
        }
    }
    let lit: Vec<_> = felt.iter().map(|(played, ..)| *played).collect();
    assert_eq!(lit, [None, Some(0), None, Some(1), None], "{felt:?}");
    for (played, n_ticks, n_felt) in &felt {
        match played {
            None => assert_eq!(*n_felt, 0, "{felt:?}"),
            // It may turn at the ends of a stroke.
            Some(_) => assert!(*n_ticks == 80 && *n_felt > 70, "{felt:?}"),
        }
    }
    assert_eq!(felt[2].1, 12);
    assert_eq!(session(&window).missing(), None);
    window.press(Modifiers::NONE, Key::Num2);
    window.pass(4);
    assert_eq!(session(&window).progress.0, 1, "it is handed in at once");
    let [row] = &rows(&folder)[..] else {
        panic!("one row")
    };
    assert_eq!(row.presentation.validity(), Validity::Valid);
    assert_eq!(row.presentation.explored_s.len(), 2);
    let path = path_file(&session(&window).log, &row.trial, row.attempt);
    assert_eq!(path.is_file(), !row.presentation.path_sha256.is_empty());
    assert!(path.is_file(), "how it was explored is on disk");
}

#[test]
fn an_interval_in_which_the_finger_rested_is_presented_again_whatever_is_answered() {
    let folder = Folder::new("rested");
    let mut window = begun_on_array(&folder, DESIGN);
    window.dispatch(DeviceCommand::ConnectEmulator);
    arm(&mut window);
    present(&mut window);
    let at = corner(&window);
    // Through the silence and a little of the first, then it rests on the cloth.
    stroke(&mut window, at, 0..50);
    for _ in 0..90 {
        window.press(Modifiers::NONE, Key::Num1);
        if session(&window).attempt() > 1 {
            break;
        }
    }
    let [row] = &rows(&folder)[..] else {
        panic!("one row")
    };
    assert_eq!(row.presentation.validity(), Validity::Void);
    let void = &row.presentation.void;
    assert!(void.contains("interval 1 was felt in movement"), "{void}");
    assert_eq!(row.answer(), None);
    assert_eq!(session(&window).progress.0, 0);
    // It begins again by itself, and counts once each was felt.
    present(&mut window);
    feel(&mut window);
    window.press(Modifiers::NONE, Key::Num1);
    window.pass(4);
    let rows = rows(&folder);
    assert_eq!(rows.len(), 2);
    assert_eq!((rows[1].attempt, session(&window).progress.0), (2, 1));
    assert_eq!(rows[1].presentation.validity(), Validity::Valid);
}
