//! Processes whose memory is watched while they run, and tests that have one to themselves.

use std::env;
use std::fs;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::program::Lab;

/// What goes on for so long has hung.
const PATIENCE: Duration = Duration::from_mins(5);
/// Tells a test that it has a process to itself.
const ALONE: &str = "SELVEDGE_TEST_ALONE";

/// The memory of a process by this name of the system's: `VmHWM` is the most, `VmRSS` what it holds
/// now. 0 when it has ended.
pub(crate) fn memory_bytes(id: u32, name: &str) -> u64 {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let of_name = |line: &str| {
        line.strip_prefix(name)?
            .strip_prefix(':')
            .map(str::to_owned)
    };
    let value = status.lines().find_map(of_name).unwrap_or_default();
    let kib = value.trim().strip_suffix(" kB").unwrap_or("0");
    1024 * kib.parse::<u64>().unwrap()
}

/// Waits for the end of a process and gives the most memory that it held. One that takes more than
/// `max_bytes` is ended.
pub(crate) fn watch(child: &mut Child, max_bytes: u64, what: &str) -> u64 {
    let (began, mut peak_bytes) = (Instant::now(), 0);
    while child.try_wait().unwrap().is_none() {
        peak_bytes = peak_bytes.max(memory_bytes(child.id(), "VmHWM"));
        if peak_bytes > max_bytes || began.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!(
                "{what}: ended after {:?} with {peak_bytes} bytes of memory",
                began.elapsed()
            );
        }
        thread::sleep(Duration::from_millis(1));
    }
    peak_bytes
}

/// Runs the test of this name in a process of its own, with a user and a folder that go with it;
/// whether this is that process.
pub(crate) fn is_alone(test: &str) -> bool {
    if env::var_os(ALONE).is_some() {
        return true;
    }
    let lab = Lab::named("alone");
    let mut command = Command::new(env::current_exe().unwrap());
    command
        .args([test, "--exact", "--nocapture"])
        .current_dir(lab.path(""))
        .env(ALONE, "1")
        .stdin(Stdio::null());
    for variable in [
        "HOME",
        "XDG_CONFIG_HOME",
        "XDG_CACHE_HOME",
        "XDG_DATA_HOME",
        "XDG_STATE_HOME",
    ] {
        command.env(variable, lab.path("home"));
    }
    let output = command.output().unwrap();
    let told = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (told(&output.stdout), told(&output.stderr));
    assert!(output.status.success(), "{out}{err}");
    assert!(out.contains("1 passed"), "{test} is no test: {out}");
    false
}
