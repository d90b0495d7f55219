//! A device that fails and a host that is killed, as two programs over a real terminal.
//!
//! What is compared is the device's log, by the device's own clock, and the words that people read.
#![cfg(unix)]

use std::process::{Child, Stdio};

use crate::bridge_device::{Device, wait_for_log};
use crate::program::Lab;

const PLAY: [&str; 7] = [
    "play",
    "a.scene.toml",
    "--path",
    "a.csv",
    "--port",
    "array",
    "--loop",
];

fn play(lab: &Lab) -> Child {
    lab.command(&PLAY)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

#[test]
fn a_device_that_reboots_while_it_plays_is_lost_and_stays_silent() {
    let lab = Lab::with_scene();
    // Often, since a busy machine may not play yet when it first happens.
    let times: Vec<String> = (1..40).map(|nth| format!("{}s+200ms", 2 * nth)).collect();
    let device = Device::start(&lab, &["--reboot-at", &times.join(",")]);
    let host = play(&lab);
    let outcome = crate::program::Outcome::of(&host.wait_with_output().unwrap());
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let last = outcome.err.lines().next_back().unwrap_or_default();
    assert!(last.starts_with("selvedge: array: "), "{outcome:?}");
    let before = std::fs::read_to_string(lab.path("device.csv")).unwrap();
    let n_ends = |log: &str| log.matches("fault reboot ends").count();
    wait_for_log(&lab, |log| n_ends(log) > n_ends(&before));
    let rows = device.end(&lab);
    let (events, states) = (rows.text("event"), rows.text("state"));
    let last = events
        .iter()
        .rposition(|event| *event == "frame")
        .unwrap_or(0);
    let n_armed = states.iter().filter(|state| **state == "ARMED").count();
    assert!(n_armed <= 1, "armed once, by the host that was told to");
    let begins = |event: &&str| event.starts_with("fault reboot begins");
    let rebooted = last + events[last..].iter().position(begins).unwrap();
    assert!(!states[rebooted + 1..].contains(&"RUN"));
    assert_eq!(states[rows.len() - 1], "IDLE");
}

#[test]
fn a_device_that_lies_fails_its_test_with_the_reason() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &["--firmware-lie", "caps.rows=5"]);
    let outcome = lab.run(&["bridge", "test", "--port", "array"]);
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(
        outcome.out.contains("rows · cols is not n_ch"),
        "{outcome:?}"
    );
    drop(device.end(&lab));
}

#[test]
fn faults_that_cannot_be_are_refused_before_anything_starts() {
    let lab = Lab::with_scene();
    for (fault, words) in [
        (["--dead", "24"], "channels 0 to 23"),
        (["--drop", "1.5"], "0 to 1"),
        (["--reboot-at", "later"], "300ms"),
        (["--firmware-lie", "caps.colour=3"], "caps.max-body"),
        (["--tick-jitter", "1s"], "10 ms"),
    ] {
        let args = [&["bridge", "emulate", "--link", "array"], &fault[..]].concat();
        let outcome = lab.run(&args);
        assert_eq!(outcome.code, 2, "{outcome:?}");
        assert!(outcome.one_line().contains(words), "{outcome:?}");
        assert!(!lab.path("array").is_symlink(), "nothing was made");
    }
}

#[test]
fn a_second_emulator_does_not_take_the_link_of_a_running_one() {
    let lab = Lab::with_scene();
    let first = Device::start(&lab, &[]);
    let terminal = std::fs::read_link(lab.path("array")).unwrap();
    let outcome = lab.run(&["bridge", "emulate", "--link", "array"]);
    assert_eq!(outcome.code, 2, "{outcome:?}");
    let held = format!("held by another emulator, process {}", first.id());
    assert!(outcome.one_line().contains(&held), "{outcome:?}");
    assert_eq!(std::fs::read_link(lab.path("array")).unwrap(), terminal);
    let outcome = lab.run(&["bridge", "test", "--port", "array"]);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    drop(first.end(&lab));
    assert!(!lab.path("array.lock").exists(), "nothing is left");
}

#[test]
fn the_link_of_a_killed_emulator_is_taken_over() {
    let lab = Lab::with_scene();
    let mut killed = Device::start(&lab, &[]);
    killed.vanish();
    assert!(lab.path("array").is_symlink(), "it could not clean up");
    let device = Device::start(&lab, &[]);
    let outcome = lab.run(&["bridge", "test", "--port", "array"]);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    drop(device.end(&lab));
    assert!(!lab.path("array.lock").exists(), "nothing is left");
}

#[test]
fn the_udev_rule_is_printed_as_it_is_shipped() {
    let lab = Lab::with_scene();
    let printed = lab.print(&["bridge", "list", "--udev-rule"]);
    let shipped = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/assets/bridge/99-selvedge.rules"
    );
    assert_eq!(printed, std::fs::read_to_string(shipped).unwrap());
    assert!(printed.contains("ID_MM_DEVICE_IGNORE"));
}
