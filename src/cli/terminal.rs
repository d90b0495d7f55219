//! The terminal: notices and progress on stderr.
//!
//! Nothing here writes results. Errors of stderr are dropped: there is nowhere left to tell them.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::repeats::Repeats;
use super::{CliError, signals};
use selvedge_foundation::progress::{CancelFlag, Progress};

/// Work that is shorter than this says nothing.
const QUIET: Duration = Duration::from_secs(1);
/// How often a terminal's line is renewed.
const REFRESH: Duration = Duration::from_millis(100);
/// How often a log gets a line.
const LOG_EVERY: Duration = Duration::from_secs(5);

/// Whether notices and progress are left out.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves notices and progress out from now on: errors alone are told.
pub(super) fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

/// What was said lately, by every thread.
static REPEATS: Mutex<Option<Repeats>> = Mutex::new(None);

/// One line on stderr; one that repeats is told once a second at most, with a count.
pub(super) fn notice(text: &str) {
    tell(|repeats, now| repeats.say(now, text));
}

/// The same for the words of a device, of which too many are left out.
pub(super) fn heard(text: &str) {
    tell(|repeats, now| repeats.hear(now, text));
}

/// Tells what was held back: the program ends.
pub(super) fn end() {
    tell(Repeats::end);
}

fn tell(said: impl FnOnce(&mut Repeats, Instant) -> Vec<String>) {
    if IS_QUIET.load(Ordering::Relaxed) {
        return;
    }
    // A panic elsewhere leaves texts and counts, which cannot be wrong.
    let mut repeats = REPEATS.lock().unwrap_or_else(PoisonError::into_inner);
    let lines = said(repeats.get_or_insert_default(), Instant::now());
    for text in &lines {
        line(text);
    }
}

/// One line on stderr, whatever was said before.
pub(super) fn line(text: &str) {
    drop(writeln!(io::stderr(), "selvedge: {text}"));
}

/// Progress of long work: one line that is renewed on a terminal, now and then a line in a log.
#[derive(Debug)]
pub(super) struct Meter {
    doing: &'static str,
    started: Instant,
    due: Instant,
    is_terminal: bool,
    is_shown: bool,
}

impl Meter {
    /// A meter of work that begins now.
    pub(super) fn new(doing: &'static str) -> Self {
        let started = Instant::now();
        let is_terminal = io::stderr().is_terminal();
        Self {
            doing,
            started,
            due: started + QUIET,
            is_terminal,
            is_shown: false,
        }
    }

    /// The share done, 0…1, and what is being done to what.
    pub(super) fn show(&mut self, share: f64, what: &str) {
        let now = Instant::now();
        if now < self.due || IS_QUIET.load(Ordering::Relaxed) {
            return;
        }
        self.due = now + if self.is_terminal { REFRESH } else { LOG_EVERY };
        self.is_shown = true;
        let spent = now.duration_since(self.started);
        let percent = (share * 100.0).floor();
        let text = format!("{} {percent} %, {} {what}", self.doing, times(share, spent));
        if self.is_terminal {
            drop(write!(io::stderr(), "\r\x1b[2K{text}"));
            drop(io::stderr().flush());
        } else {
            line(text.trim_end());
        }
    }
}

/// Does work that shows its progress, until it is done or a signal stops it.
pub(super) fn with_meter<T>(
    doing: &'static str,
    work: impl FnOnce(&mut Progress<'_>) -> T,
) -> Result<T, CliError> {
    let stop = signals::stop_flag()?;
    Ok(with_meter_until(doing, &stop, work))
}

/// The same, until a flag is set.
pub(super) fn with_meter_until<T>(
    doing: &'static str,
    stop: &Arc<AtomicBool>,
    work: impl FnOnce(&mut Progress<'_>) -> T,
) -> T {
    let mut meter = Meter::new(doing);
    let mut report = |share: f64, what: &str| meter.show(share, what);
    let cancel = CancelFlag::shared(Arc::clone(stop));
    work(&mut Progress::new(&mut report, cancel))
}

/// Time spent, and the time left if the rest goes as fast; at first nobody knows.
fn times(share: f64, spent: Duration) -> String {
    let seconds = spent.as_secs();
    if share < 0.02 {
        return format!("{seconds} s");
    }
    let left = (spent.as_secs_f64() * (1.0 / share - 1.0)).ceil().max(0.0);
    format!("{seconds} s, about {left} s left,")
}

impl Drop for Meter {
    fn drop(&mut self) {
        if self.is_shown && self.is_terminal {
            drop(write!(io::stderr(), "\r\x1b[2K"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_the_share_done() {
        let spent = Duration::from_secs(3);
        assert_eq!(times(0.0, spent), "3 s");
        assert_eq!(times(0.25, spent), "3 s, about 9 s left,");
        assert_eq!(times(1.0, spent), "3 s, about 0 s left,");
    }
}
