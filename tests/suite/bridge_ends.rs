//! Whatever ends a session, at every command that has one, as programs over a real terminal: STOP
//! first, or silence by the device's own clock where nobody is left to say it.
#![cfg(target_os = "linux")]

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::bridge_device::{Device, signal, wait_for_log};
use crate::bridge_end_to_end::undisturbed;
use crate::program::{Lab, Outcome, Rows};

/// A command with a session on the lab's device, and its record in `link.csv`.
struct Session {
    line: &'static str,
    /// What only somebody without a terminal must say.
    unattended: &'static str,
    /// By the device's log.
    is_under_way: fn(&str) -> bool,
    /// What it says of an end that was asked for: a path that ends so has done what it should, a
    /// trial has not passed.
    code_when_asked: i32,
}

const PLAY: Session = Session {
    line: "play a.scene.toml --path a.csv --port array --loop --session-log link.csv",
    unattended: "",
    is_under_way: has_played,
    code_when_asked: 0,
};
const IDENTIFY: Session = Session {
    line: "bridge identify --port array --out rig.toml --session-log link.csv",
    unattended: " --answers answers.txt",
    is_under_way: is_armed,
    code_when_asked: 0,
};
const TEST: Session = Session {
    line: "bridge test --port array --session-log link.csv",
    unattended: "",
    is_under_way: is_armed,
    code_when_asked: 1,
};
const CERTIFY: Session = Session {
    line: "bridge certify --port array --out reports --session-log link.csv",
    unattended: "",
    is_under_way: is_armed,
    code_when_asked: 1,
};

fn n_frames(log: &str) -> usize {
    log.lines().filter(|line| line.contains(",frame,")).count()
}

/// Whether the device has played for a while, or has come to rest by itself.
fn has_played(log: &str) -> bool {
    n_frames(log) >= 20 || has_rested(log)
}

/// Whether the device has come to rest after it played.
fn has_rested(log: &str) -> bool {
    let ran = log.find(",state,RUN,");
    ran.is_some_and(|at| log[at..].contains(",state,READY,") || log[at..].contains(",state,IDLE,"))
}

fn is_armed(log: &str) -> bool {
    log.contains(",state,ARMED,")
}

/// What comes from outside and ends a session.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Signal(&'static str),
    TerminalCloses,
    Killed,
    Suspended,
    CablePulled,
}

const ENDS: [End; 7] = [
    End::Signal("INT"),
    End::Signal("TERM"),
    End::Signal("HUP"),
    End::TerminalCloses,
    End::Killed,
    End::Suspended,
    End::CablePulled,
];

#[test]
fn whatever_ends_a_path_the_device_is_at_rest() {
    check(&PLAY);
}

#[test]
fn whatever_ends_a_walk_over_the_channels_the_device_is_at_rest_and_nothing_is_written() {
    check(&IDENTIFY);
}

#[test]
fn whatever_ends_a_test_the_device_is_at_rest() {
    check(&TEST);
}

#[test]
fn whatever_ends_a_certification_the_device_is_at_rest() {
    check(&CERTIFY);
}

fn check(session: &Session) {
    for end in ENDS {
        check_end(session, end);
    }
}

fn check_end(session: &Session, end: End) {
    let lab = Lab::with_scene();
    // Long enough that a walk lasts until it is ended.
    lab.write("answers.txt", "a\n".repeat(1000));
    // A machine so busy that the program sleeps for a tenth of a second lets the device disarm
    // itself, as it should: then it is tried again.
    undisturbed(|| {
        drop(std::fs::remove_file(lab.path("link.csv")));
        let device = Device::start(&lab, &[]);
        match end {
            End::Signal(name) => ended_by_signal(&lab, session, name, device),
            End::TerminalCloses => ended_with_its_terminal(&lab, session, device),
            End::Killed => {
                ended_without_a_word(&lab, session, device);
                Some(())
            }
            End::Suspended => {
                suspended(&lab, session, device);
                Some(())
            }
            End::CablePulled => ended_by_the_cable(&lab, session, device),
        }
    });
    assert!(!lab.path("rig.toml").exists(), "no wiring was found");
}

fn ended_by_signal(lab: &Lab, session: &Session, name: &str, device: Device) -> Option<()> {
    let host = host(lab, session);
    wait_for_log(lab, session.is_under_way);
    signal(name, &host);
    let outcome = Outcome::of(&host.wait_with_output().unwrap());
    let rows = device.end(lab);
    if disarmed_itself(lab) {
        return None;
    }
    assert_eq!(outcome.code, session.code_when_asked, "{name}: {outcome:?}");
    check_stopped(lab, &rows);
    Some(())
}

fn ended_with_its_terminal(lab: &Lab, session: &Session, device: Device) -> Option<()> {
    let code = in_a_terminal_that_closes(lab, session);
    let rows = device.end(lab);
    if disarmed_itself(lab) {
        return None;
    }
    assert_eq!(code, session.code_when_asked, "its terminal closed");
    check_stopped(lab, &rows);
    Some(())
}

fn ended_without_a_word(lab: &Lab, session: &Session, device: Device) {
    let mut host = host(lab, session);
    wait_for_log(lab, session.is_under_way);
    host.kill().unwrap();
    host.wait().unwrap();
    wait_for_rest(lab);
    let rows = device.end(lab);
    check_silence(&rows);
    check_record(lab, &rows);
}

/// As when the machine sleeps: what is armed again afterwards, somebody must have asked for.
fn suspended(lab: &Lab, session: &Session, device: Device) {
    let mut host = host(lab, session);
    wait_for_log(lab, session.is_under_way);
    signal("STOP", &host);
    wait_for_rest(lab);
    let before = lab.read("device.csv");
    if session.code_when_asked == 0 {
        signal("CONT", &host);
        let outcome = Outcome::of(&host.wait_with_output().unwrap());
        assert_eq!(outcome.code, 1, "{outcome:?}");
        let last = outcome.err.lines().next_back().unwrap_or_default();
        assert!(last.starts_with("selvedge: array: "), "{outcome:?}");
        let n_armed = |log: &str| log.matches(",state,ARMED,").count();
        let after = lab.read("device.csv");
        assert_eq!(n_armed(&after), n_armed(&before), "armed again");
    } else {
        // A trial that was held up goes on with the check that it missed.
        host.kill().unwrap();
        host.wait().unwrap();
    }
    check_silence(&device.end(lab));
}

fn ended_by_the_cable(lab: &Lab, session: &Session, mut device: Device) -> Option<()> {
    let host = host(lab, session);
    wait_for_log(lab, session.is_under_way);
    device.vanish();
    let outcome = Outcome::of(&host.wait_with_output().unwrap());
    if disarmed_itself(lab) {
        return None;
    }
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let last = outcome.err.lines().next_back().unwrap_or_default();
    assert!(last.starts_with("selvedge: array: "), "{outcome:?}");
    assert!(lab.read("link.csv").contains(",lost,"), "the record has it");
    Some(())
}

/// A program that hears SIGHUP, also where whoever runs the tests does not.
fn hearing_hangups(program: &str) -> Command {
    let mut command = Command::new("env");
    command.args(["--default-signal=HUP", program]);
    command
}

/// The program, to be run in the lab without a terminal.
fn host(lab: &Lab, session: &Session) -> Child {
    let line = format!("{}{}", session.line, session.unattended);
    hearing_hangups(env!("CARGO_BIN_EXE_selvedge"))
        .args(line.split(' '))
        .current_dir(lab.path(""))
        .env("XDG_CACHE_HOME", lab.path("cache"))
        .env("XDG_DATA_HOME", lab.path("data"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Runs the program in a terminal of its own, which closes once it is under way; gives the exit
/// code.
fn in_a_terminal_that_closes(lab: &Lab, session: &Session) -> i32 {
    let code = lab.path("code.txt");
    drop(std::fs::remove_file(&code));
    let (program, line) = (env!("CARGO_BIN_EXE_selvedge"), session.line);
    // The shell hands the hangup on, as one does, and outlives it to tell the code.
    let script = format!(
        "exec 3<&0; trap 'kill -HUP $pid' HUP; {program} {line} <&3 & pid=$!; wait $pid; \
         wait $pid; echo $? > code.new; mv code.new code.txt"
    );
    let mut terminal = hearing_hangups("script")
        .args(["--quiet", "--command", &script, "/dev/null"])
        .current_dir(lab.path(""))
        .env("SHELL", "/bin/sh")
        .env("XDG_CACHE_HOME", lab.path("cache"))
        .env("XDG_DATA_HOME", lab.path("data"))
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_log(lab, session.is_under_way);
    terminal.kill().unwrap();
    terminal.wait().unwrap();
    let deadline = Instant::now() + Duration::from_secs(30);
    while !code.exists() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
    }
    lab.read("code.txt").trim().parse().unwrap()
}

/// Whether the device came to rest before anything came from outside.
fn disarmed_itself(lab: &Lab) -> bool {
    lab.read("link.csv").contains(",disarmed-itself,")
}

/// Since no host is left to arm again, the last state of all.
fn wait_for_rest(lab: &Lab) {
    wait_for_log(lab, |log| {
        let mut states = log.lines().filter(|line| line.contains(",state,"));
        let last = states.next_back().unwrap_or_default();
        last.contains(",state,READY,") || last.contains(",state,IDLE,")
    });
}

/// STOP was written and acknowledged, nothing that could begin output followed it, and the device
/// is at rest.
fn check_stopped(lab: &Lab, rows: &Rows) {
    let link = lab.read("link.csv");
    let lines: Vec<&str> = link.lines().collect();
    // A host that waits for an answer keeps its lease.
    let is_ping = |line: &&&str| line.contains(",out,PING ");
    let written = |line: &&&str| (line.contains(",out,") || line.contains(",f,")) && !is_ping(line);
    let is_stop = |line: &&&str| line.contains(",out,STOP ");
    // One that is late to be answered is said again.
    let n_stops = lines
        .iter()
        .rev()
        .filter(written)
        .take_while(is_stop)
        .count();
    let stops = (0..lines.len()).rev().filter(|at| is_stop(&&lines[*at]));
    let first = stops.take(n_stops).last();
    let first = first.unwrap_or_else(|| panic!("the last word is no STOP: {link}"));
    // Written is noted once the port has taken it: the answer may stand a few lines before.
    let since = &lines[first.saturating_sub(8)..];
    let is_answered = |line: &str| {
        let stop = line.split_once(",out,STOP ");
        let seq = stop.and_then(|(_, words)| words.split(' ').next()?.parse::<u16>().ok());
        let answer = seq.map(|seq| format!(" 0500{:04x}", seq.swap_bytes()));
        answer.is_some_and(|answer| since.iter().any(|line| line.ends_with(&answer)))
    };
    assert!(
        lines[first..].iter().any(|line| is_answered(line)),
        "{link}"
    );
    let after = lines[first..].join("\n");
    for begins in [",f,", ",out,FRAME ", ",out,ARM ", ",out,IDENT "] {
        assert!(!after.contains(begins), "{begins} after the STOP: {link}");
    }
    check_rest(rows);
}

fn check_rest(rows: &Rows) {
    let last = rows.len() - 1;
    let (state, sum) = (rows.text("state")[last], rows.text("amp_sum")[last]);
    assert!(
        ["READY", "IDLE"].contains(&state) && sum == "0",
        "{state} with {sum}"
    );
}

/// The record of a host that was killed is readable up to its last second.
fn check_record(lab: &Lab, device: &Rows) {
    // Its first second may be on its way to the disk still.
    if !lab.read("link.csv").contains(",link,") {
        return;
    }
    let replayed = lab.run(&["bridge", "replay", "link.csv", "--out", "felt.csv"]);
    assert!([0, 1].contains(&replayed.code), "{replayed:?}");
    let felt = Rows::read(&lab.path("felt.csv")).numbers("tick");
    let events = device.text("event");
    let Some(last) = events.iter().rposition(|event| *event == "frame") else {
        return;
    };
    let (last, known) = (device.numbers("tick")[last], felt[felt.len() - 1]);
    assert!(known + 40.0 >= last, "up to tick {known} of {last}");
}

/// The device came to rest by itself no later than 100 ms after the last frame that took effect, by
/// its own clock.
fn check_silence(rows: &Rows) {
    check_rest(rows);
    let (events, states) = (rows.text("event"), rows.text("state"));
    let us = rows.numbers("dev_us");
    let is_live = |row: &usize| ["ARMED", "RUN", "HOLD", "RAMP"].contains(&states[*row]);
    let Some(last) = events.iter().rposition(|event| *event == "frame") else {
        return;
    };
    let rest = (last..rows.len()).find(|row| !is_live(row)).unwrap();
    let silent_ms = (us[rest] - us[last]) / 1000.0;
    assert!(silent_ms <= 100.0, "{silent_ms} ms");
}

#[test]
fn a_program_that_is_to_outlive_its_terminal_does() {
    let lab = Lab::with_scene();
    undisturbed(|| {
        let device = Device::start(&lab, &[]);
        let line = format!(
            "exec nohup {} {}",
            env!("CARGO_BIN_EXE_selvedge"),
            PLAY.line
        );
        let host = Command::new("sh")
            .args(["-c", &line])
            .current_dir(lab.path(""))
            .env("XDG_CACHE_HOME", lab.path("cache"))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_log(&lab, |log| n_frames(log) >= 1);
        signal("HUP", &host);
        let before = n_frames(&lab.read("device.csv"));
        let goes_on = |log: &str| n_frames(log) > before + 10;
        // What a busy machine ends, ends by the device's rest and not by the hangup.
        wait_for_log(&lab, |log| goes_on(log) || has_rested(log));
        let has_gone_on = goes_on(&lab.read("device.csv"));
        signal("TERM", &host);
        let outcome = Outcome::of(&host.wait_with_output().unwrap());
        drop(device);
        assert!(has_gone_on || disarmed_itself(&lab), "{outcome:?}");
        has_gone_on.then_some(())
    });
}
