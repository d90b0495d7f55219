//! What the machine gives: cores, a clock, places for files, ports.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::{Finding, State};
use selvedge_device::{BridgeError, PortEntry, ProfileFolder};
use selvedge_engine::TICK;
use selvedge_foundation::files::free_bytes;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_workbench::{StageOptions, own_arrays, own_files, stage_file};

/// Ticks that are waited for: a second.
const N_TICKS: u32 = 40;
/// A tick that comes later than this is noticed: the engine waits 12 ms for a device that is late.
const LATE: Duration = Duration::from_millis(5);
/// Room that an hour of sessions and recordings takes many times over, bytes.
const ROOM: u64 = 1 << 30;
/// Where the rule for arrays may lie.
const RULES: [&str; 3] = [
    "/etc/udev/rules.d/99-selvedge.rules",
    "/usr/lib/udev/rules.d/99-selvedge.rules",
    "/lib/udev/rules.d/99-selvedge.rules",
];

pub(super) fn cores() -> Vec<Finding> {
    let n = thread::available_parallelism().map_or(1, usize::from);
    let finding = if n > 1 {
        Finding::new("cores", State::Ok, n.to_string())
    } else {
        let what = "1: a window drawn without a graphics card may make ticks late; give a second";
        Finding::new("cores", State::Note, what)
    };
    vec![finding]
}

pub(super) fn clock() -> Vec<Finding> {
    vec![punctuality(resolution(), &mut lateness())]
}

/// The smallest step of the clock that was seen.
fn resolution() -> Duration {
    let step = || {
        let before = Instant::now();
        loop {
            let step = before.elapsed();
            if !step.is_zero() {
                return step;
            }
        }
    };
    (0..100).map(|_| step()).min().unwrap_or_default()
}

/// How late a thread is that sleeps until every tick.
fn lateness() -> Vec<Duration> {
    let begin = Instant::now();
    let late = |tick: u32| {
        let due = begin + TICK * tick;
        thread::sleep(due.saturating_duration_since(Instant::now()));
        due.elapsed()
    };
    (1..=N_TICKS).map(late).collect()
}

pub(super) fn punctuality(resolution: Duration, late: &mut [Duration]) -> Finding {
    late.sort_unstable();
    let ms = |time: Duration| fixed(time.as_secs_f64() * 1e3, 2);
    let median = late.get(late.len() / 2).copied().unwrap_or_default();
    let worst = late.last().copied().unwrap_or_default();
    let what = format!(
        "steps of {} ns; {} ticks late by {} ms in the middle, {} ms at most",
        resolution.as_nanos(),
        late.len(),
        ms(median),
        ms(worst)
    );
    if worst <= LATE {
        return Finding::new("clock", State::Ok, what);
    }
    let what = format!("{what}: end other programs, or let the system run at full speed");
    Finding::new("clock", State::Note, what)
}

pub(super) fn own_places() -> Vec<Finding> {
    let Some(own) = own_files() else {
        let what = "the system names no folder for them, so nothing is kept; set HOME";
        return vec![Finding::new("settings", State::Wrong, what)];
    };
    let settings = match own.flaw {
        Some(flaw) => {
            let what = format!("{flaw}; mend it or remove the file: settings are as at first");
            Finding::new("settings", State::Wrong, what)
        }
        None => place("settings", &own.settings),
    };
    let mut findings = vec![settings];
    findings.push(place("sessions", &own.sessions));
    findings.push(place("recordings", &own.recordings));
    findings
}

/// Whether every array profile of the user can be read.
pub(super) fn arrays() -> Vec<Finding> {
    own_arrays().map_or_else(Vec::new, |folder| arrays_in(&folder))
}

pub(super) fn arrays_in(folder: &Path) -> Vec<Finding> {
    let (mut good, mut findings) = (Vec::new(), Vec::new());
    for read in ProfileFolder::new(folder).read() {
        match read {
            Ok((_, profile)) => good.push(profile.name),
            Err(error) => findings.push(Finding::new("arrays", State::Wrong, error.to_string())),
        }
    }
    let folder = folder.display();
    let what = match good.as_slice() {
        [] if findings.is_empty() => format!("{folder}: no profile of your own"),
        [] => return findings,
        names => format!("{folder}: {}", names.join(", ")),
    };
    findings.insert(0, Finding::new("arrays", State::Ok, what));
    findings
}

/// Whether the stage would begin as its operator wrote down.
pub(super) fn stage() -> Vec<Finding> {
    stage_file().map_or_else(Vec::new, |file| vec![stage_by(&file)])
}

pub(super) fn stage_by(file: &Path) -> Finding {
    if !file.exists() {
        let what = format!("{}: not there; the stage never arms", file.display());
        return Finding::new("stage", State::Ok, what);
    }
    let outcome = StageOptions::read(Some(file)).map(|options| {
        let pin = if options.has_pin() {
            "a PIN"
        } else {
            "no PIN, so it never arms"
        };
        let percent = with_unit(100.0 * options.ceiling(), 0, "%");
        format!("{}: {pin}, at most {percent} of full scale", file.display())
    });
    Finding::of("stage", outcome)
}

/// Whether files can be written at a place, or where it will be made, and whether there is room.
pub(super) fn place(name: &'static str, path: &Path) -> Finding {
    let folder = path.ancestors().find(|path| path.is_dir());
    // A relative path that is not there yet begins in this folder.
    let folder = folder.unwrap_or_else(|| Path::new("."));
    let trial = folder.join(format!(".selvedge-doctor-{}", std::process::id()));
    let written = fs::write(&trial, b"").and_then(|()| fs::remove_file(&trial));
    if let Err(error) = written {
        let what = format!(
            "{}: {} cannot be written ({error}); change its owner or choose another place",
            path.display(),
            folder.display()
        );
        return Finding::new(name, State::Wrong, what);
    }
    let Some(free) = free_bytes(folder) else {
        return Finding::new(name, State::Ok, path.display().to_string());
    };
    let what = format!(
        "{}, {} GB free",
        path.display(),
        fixed(free as f64 / 1e9, 1)
    );
    if free >= ROOM {
        return Finding::new(name, State::Ok, what);
    }
    Finding::new(
        name,
        State::Note,
        format!("{what}: make room before a session"),
    )
}

pub(super) fn ports() -> Vec<Finding> {
    ports_of(PortEntry::list(), PortEntry::check_permission)
}

pub(super) fn ports_of(
    listed: Result<Vec<PortEntry>, BridgeError>,
    permission: impl Fn(&str) -> Result<(), BridgeError>,
) -> Vec<Finding> {
    let ports = match listed {
        Ok(ports) => ports,
        Err(error) => return vec![Finding::new("port", State::Wrong, error.to_string())],
    };
    if ports.is_empty() {
        let what = "none: connect an array, or go on with the emulator, which needs none";
        return vec![Finding::new("port", State::Note, what)];
    }
    let finding = |port: &PortEntry| {
        let usable = permission(&port.path);
        Finding::of(
            "port",
            usable.map(|()| format!("{}, {}", port.path, port.description)),
        )
    };
    ports.iter().map(finding).collect()
}

/// Whether the rule is there that gives access to arrays: on Linux only, which alone has one.
pub(super) fn access_rule() -> Vec<Finding> {
    if !cfg!(target_os = "linux") {
        return Vec::new();
    }
    rule_among(&RULES.map(Path::new))
}

pub(super) fn rule_among(places: &[&Path]) -> Vec<Finding> {
    let finding = match places.iter().find(|place| place.is_file()) {
        Some(place) => Finding::new("udev rule", State::Ok, place.display().to_string()),
        None => Finding::new(
            "udev rule",
            State::Note,
            "not installed: \"selvedge bridge list --udev-rule\" prints it and says where it goes",
        ),
    };
    vec![finding]
}
