//! A device that fails and a host that is killed, as two programs over a real terminal.
//!
//! What is compared is the device's log, by the device's own clock, and the words that people read.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::{Lab, Rows};

/// An emulated device with faults.
struct Device(Child);

impl Device {
    fn start(lab: &Lab, faults: &[&str]) -> Self {
        let args = [
            "bridge",
            "emulate",
            "--link",
            "array",
            "--log",
            "device.csv",
        ];
        let args = [&args[..], faults].concat();
        let mut child = lab.command(&args).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let out = child.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        assert!(line.starts_with("array -> /dev/"), "{line}");
        Self(child)
    }

    fn end(mut self, lab: &Lab) -> Rows {
        let id = self.0.id().to_string();
        let told = Command::new("kill").args(["-TERM", &id]).status();
        assert!(told.unwrap().success(), "kill -TERM");
        assert_eq!(self.0.wait().unwrap().code(), Some(0), "a clean end");
        Rows::read(&lab.path("device.csv"))
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Waits until the device's log satisfies `is_so`.
fn wait_for_log(lab: &Lab, is_so: impl Fn(&str) -> bool) {
    let deadline = Instant::now() + Duration::from_secs(30);
    while Instant::now() < deadline {
        let log = std::fs::read_to_string(lab.path("device.csv")).unwrap_or_default();
        if is_so(&log) {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("the device's log never said so");
}

fn n_frames(log: &str) -> usize {
    log.lines().filter(|line| line.contains(",frame,")).count()
}

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

/// Ends of output in the log: rows of `column` at each change from output to rest.
fn at_each_rest(rows: &Rows, column: &str) -> Vec<f64> {
    let (events, states) = (rows.text("event"), rows.text("state"));
    let numbers = rows.numbers(column);
    let mut was_live = false;
    let mut found = Vec::new();
    for row in 0..rows.len() {
        let is_live = ["ARMED", "RUN", "HOLD", "RAMP"].contains(&states[row]);
        if was_live && !is_live && events[row] == "state" {
            found.push(numbers[row]);
        }
        was_live = is_live;
    }
    found
}

#[test]
fn when_the_host_is_killed_the_device_is_at_zero_within_100_ms_of_the_last_frame() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let mut host = play(&lab);
    wait_for_log(&lab, |log| n_frames(log) >= 60);
    // SIGKILL: nothing of the host runs after this.
    host.kill().unwrap();
    host.wait().unwrap();
    // The last row of all, since no host is left to arm again.
    wait_for_log(&lab, |log| {
        let last = log.lines().next_back().unwrap_or_default();
        last.contains(",state,READY,") || last.contains(",state,IDLE,")
    });
    let rows = device.end(&lab);
    let ages_ms = at_each_rest(&rows, "age_ms");
    assert!(
        !ages_ms.is_empty() && ages_ms.iter().all(|ms| *ms <= 100.0),
        "{ages_ms:?}"
    );
    let sums = at_each_rest(&rows, "amp_sum");
    assert!(sums.iter().all(|sum| *sum == 0.0), "{sums:?}");
    // By the device's clock too: from the last frame that took effect to rest.
    let (events, us) = (rows.text("event"), rows.numbers("dev_us"));
    let last = (0..rows.len())
        .rev()
        .find(|&row| events[row] == "frame")
        .unwrap();
    let rest = (last..rows.len()).find(|&row| rows.text("state")[row] == "READY");
    let silent_us = us[rest.unwrap()] - us[last];
    assert!(silent_us <= 100_000.0, "{silent_us} µs");
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
    let device = Device::start(&lab, &["--lie", "rows=5"]);
    let outcome = lab.run(&["bridge", "test", "--port", "array"]);
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(outcome.out.contains("5 rows"), "{outcome:?}");
    drop(device.end(&lab));
}

#[test]
fn faults_that_cannot_be_are_refused_before_anything_starts() {
    let lab = Lab::with_scene();
    for (fault, words) in [
        (["--dead", "24"], "channels 0 to 23"),
        (["--drop", "1.5"], "0 to 1"),
        (["--reboot-at", "later"], "300ms"),
        (["--lie", "colour=3"], "max-body"),
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
