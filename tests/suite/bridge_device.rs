//! An emulated device in a process of its own, behind a pseudo-terminal.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::bridge_end_to_end::undisturbed;
use crate::program::{Lab, Outcome, Rows};

/// An emulated device that runs until it is told to end.
pub(crate) struct Device(Child);

impl Device {
    /// One whose port is `array` in the lab and whose log is `device.csv`, with these faults or
    /// other options.
    pub(crate) fn start(lab: &Lab, options: &[&str]) -> Self {
        let mut command = lab.command(&["bridge", "emulate", "--link", "array"]);
        Self::run(command.args(["--log", "device.csv"]).args(options))
    }

    /// One whose port is `link`, in place of what is there.
    pub(crate) fn behind(link: &Path) -> Self {
        drop(std::fs::remove_file(link));
        let mut command = Command::new(env!("CARGO_BIN_EXE_selvedge"));
        let command = command.args(["bridge", "emulate", "--link"]).arg(link);
        Self::run(command.stdin(Stdio::null()))
    }

    /// Starts it and waits until there is a port.
    fn run(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let out = child.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        assert!(line.contains(" -> /dev/"), "{line}");
        Self(child)
    }

    /// Its process.
    pub(crate) fn id(&self) -> u32 {
        self.0.id()
    }

    /// As when the cable is pulled.
    pub(crate) fn vanish(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }

    /// SIGTERM: it must end cleanly and take its link away. Gives its log.
    pub(crate) fn end(mut self, lab: &Lab) -> Rows {
        signal("TERM", &self.0);
        assert_eq!(self.0.wait().unwrap().code(), Some(0), "a clean end");
        assert!(!lab.path("array").is_symlink(), "the link is gone");
        Rows::read(&lab.path("device.csv"))
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Sends a signal to a process.
pub(crate) fn signal(name: &str, child: &Child) {
    let sent = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success(), "kill -{name}");
}

/// Waits until the device's log satisfies `is_so`.
pub(crate) fn wait_for_log(lab: &Lab, is_so: impl Fn(&str) -> bool) {
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

/// SIGKILL, so that nothing of the host runs any more: the device comes to rest by itself, no later
/// than 100 ms after the host's last word, and has no amplitude then. Gives its log.
pub(crate) fn rest_without_its_host(lab: &Lab, device: Device, mut host: Child) -> Rows {
    host.kill().unwrap();
    host.wait().unwrap();
    // The last state of all, since no host is left to arm again.
    wait_for_log(lab, |log| {
        let mut states = log.lines().filter(|line| line.contains(",state,"));
        let last = states.next_back().unwrap_or_default();
        last.contains(",state,READY,") || last.contains(",state,IDLE,")
    });
    let rows = device.end(lab);
    let ages_ms = at_each_rest(&rows, "age_ms");
    assert!(
        !ages_ms.is_empty() && ages_ms.iter().all(|ms| *ms <= 100.0),
        "{ages_ms:?}"
    );
    let sums = at_each_rest(&rows, "amp_sum");
    assert!(sums.iter().all(|sum| *sum == 0.0), "{sums:?}");
    rows
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

const PLAY: &str = "play a.scene.toml --path a.csv --port array --loop --session-log link.csv";
const IDENTIFY: &str = "bridge identify --port array --out rig.toml";

fn n_frames(log: &str) -> usize {
    log.lines().filter(|line| line.contains(",frame,")).count()
}

/// Whether the device has played for a while, or has come to rest by itself.
fn has_played(log: &str) -> bool {
    let rested = log.find(",state,RUN,");
    n_frames(log) >= 20 || rested.is_some_and(|at| log[at..].contains(",state,READY,"))
}

fn is_armed(log: &str) -> bool {
    log.contains(",state,ARMED,")
}

/// A program that hears SIGHUP, also where whoever runs the tests does not.
fn hearing_hangups(program: &str) -> Command {
    let mut command = Command::new("env");
    command.args(["--default-signal=HUP", program]);
    command
}

/// The program, to be run in the lab.
fn host(lab: &Lab, line: &str) -> Child {
    hearing_hangups(env!("CARGO_BIN_EXE_selvedge"))
        .args(line.split(' '))
        .current_dir(lab.path(""))
        .env("XDG_CACHE_HOME", lab.path("cache"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Runs the program in a terminal of its own, which closes when `is_so` by the device's log; gives
/// the exit code.
fn in_a_terminal_that_closes(lab: &Lab, line: &str, is_so: impl Fn(&str) -> bool) -> i32 {
    let code = lab.path("code.txt");
    drop(std::fs::remove_file(&code));
    let program = env!("CARGO_BIN_EXE_selvedge");
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
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_log(lab, is_so);
    terminal.kill().unwrap();
    terminal.wait().unwrap();
    let deadline = Instant::now() + Duration::from_secs(30);
    while !code.exists() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
    }
    lab.read("code.txt").trim().parse().unwrap()
}

/// STOP was acknowledged: the device was told to rest, and did not have to help itself.
fn check_stopped(lab: &Lab, rows: &Rows) {
    let link = lab.read("link.csv");
    let last = link.rfind(",stop,").expect("a STOP");
    assert!(link[last..].contains(",stopped,"), "{link}");
    check_rest(rows);
}

/// The last that the device's log says: no output, and nothing that could begin it.
fn check_rest(rows: &Rows) {
    let last = rows.len() - 1;
    let (state, sum) = (rows.text("state")[last], rows.text("amp_sum")[last]);
    // Without its host it would be IDLE.
    assert_eq!((state, sum), ("READY", "0"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_a_path_with_an_acknowledged_stop() {
    let lab = Lab::with_scene();
    for name in ["INT", "TERM", "HUP"] {
        let (outcome, rows) = undisturbed(|| {
            drop(std::fs::remove_file(lab.path("link.csv")));
            let device = Device::start(&lab, &[]);
            let host = host(&lab, PLAY);
            wait_for_log(&lab, has_played);
            signal(name, &host);
            let outcome = Outcome::of(&host.wait_with_output().unwrap());
            let rows = device.end(&lab);
            let disturbances = ["no frame reached it", "fell silent"];
            let is_disturbed = disturbances.iter().any(|what| outcome.err.contains(what));
            (!is_disturbed).then_some((outcome, rows))
        });
        assert_eq!(
            (outcome.code, outcome.err.as_str()),
            (0, ""),
            "{name}: {outcome:?}"
        );
        assert!(outcome.out.contains(" frames in "), "{outcome:?}");
        check_stopped(&lab, &rows);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_a_walk_over_the_channels_at_rest_and_nothing_is_written() {
    let lab = Lab::with_scene();
    // Long enough that the walk lasts until the signal comes.
    lab.write("answers.txt", "a\n".repeat(1000));
    for name in ["INT", "TERM", "HUP"] {
        let device = Device::start(&lab, &[]);
        let line = format!("{IDENTIFY} --answers answers.txt");
        let host = host(&lab, &line);
        wait_for_log(&lab, is_armed);
        signal(name, &host);
        let outcome = Outcome::of(&host.wait_with_output().unwrap());
        assert_eq!(outcome.code, 0, "{name}: {outcome:?}");
        assert_eq!(outcome.one_line(), "stopped; nothing was written");
        check_rest(&device.end(&lab));
        assert!(!lab.path("rig.toml").exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_closes_ends_path_and_walk_with_the_device_at_rest() {
    let lab = Lab::with_scene();
    let (code, rows) = undisturbed(|| {
        drop(std::fs::remove_file(lab.path("link.csv")));
        let device = Device::start(&lab, &[]);
        let code = in_a_terminal_that_closes(&lab, PLAY, has_played);
        let rows = device.end(&lab);
        let is_disturbed = lab.read("link.csv").contains(",disarmed-itself,");
        (!is_disturbed).then_some((code, rows))
    });
    assert_eq!(code, 0);
    check_stopped(&lab, &rows);

    let device = Device::start(&lab, &[]);
    assert_eq!(in_a_terminal_that_closes(&lab, IDENTIFY, is_armed), 0);
    check_rest(&device.end(&lab));
    assert!(!lab.path("rig.toml").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_is_to_outlive_its_terminal_does() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let line = format!("exec nohup {} {PLAY}", env!("CARGO_BIN_EXE_selvedge"));
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
    wait_for_log(&lab, |log| n_frames(log) > before + 10);
    signal("TERM", &host);
    drop(host.wait_with_output().unwrap());
    drop(device);
}
