//! An emulated device in a process of its own, behind a pseudo-terminal.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::{Lab, Rows};

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
