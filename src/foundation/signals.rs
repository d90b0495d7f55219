//! SIGINT, SIGTERM and SIGHUP: the work is asked to end, and ends cleanly.
//!
//! A program that was started to outlive its terminal (`nohup`) goes on when that closes.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The system does not let the program listen to signals.
#[derive(Debug, thiserror::Error)]
#[error("cannot listen to signals: {0}; try again")]
pub struct SignalError(#[from] io::Error);

/// Whether a part of the program ends its work itself when a signal comes.
static IS_HEARD: AtomicBool = AtomicBool::new(false);

/// A flag that SIGINT, SIGTERM and SIGHUP raise, however often they come: what is under way ends
/// cleanly, and a device gets its STOP.
///
/// # Errors
/// The system does not let the program listen.
pub fn stop_flag() -> Result<Arc<AtomicBool>, SignalError> {
    IS_HEARD.store(true, Ordering::Relaxed);
    let stop = Arc::new(AtomicBool::new(false));
    for signal in ends() {
        flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// Does `act` whenever SIGINT, SIGTERM or SIGHUP arrives, on a thread of its own that ends with the
/// process.
///
/// Where signals cannot be listened to they end the program as they always did, and the
/// device falls silent by its own rule.
#[cfg(unix)]
pub fn on_signal(act: impl Fn() + Send + 'static) {
    IS_HEARD.store(true, Ordering::Relaxed);
    listen(move |_signal| act());
}

/// Lets SIGINT, SIGTERM and SIGHUP end the program as they always did, but for what is half
/// written, which goes first. Where a part of the program listens itself, it ends as that wishes.
#[cfg(unix)]
pub fn leave_nothing_behind() {
    listen(|signal| {
        if !IS_HEARD.load(Ordering::Relaxed) {
            let end = || drop(signal_hook::low_level::emulate_default_handler(signal));
            crate::files::abandon_unfinished(end);
        }
    });
}

/// This system has no such signals.
#[cfg(not(unix))]
pub fn leave_nothing_behind() {}

/// Hears signals on a thread of its own that ends with the process.
#[cfg(unix)]
fn listen(act: impl Fn(i32) + Send + 'static) {
    let Ok(mut signals) = signal_hook::iterator::Signals::new(ends()) else {
        return;
    };
    let hear = move || signals.forever().for_each(&act);
    let listener = std::thread::Builder::new().name("signals".to_owned());
    // A system that has no thread left to give cannot run the engine either.
    drop(listener.spawn(hear));
}

/// This system has no such signals.
#[cfg(not(unix))]
pub fn on_signal(_act: impl Fn() + Send + 'static) {}

/// The signals that ask for the end.
fn ends() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if !ignores_hangup() {
        signals.push(signal_hook::consts::SIGHUP);
    }
    signals
}

/// Whether whoever started the program wants it to outlive its terminal; asked before a signal is
/// listened to, since that changes the answer.
#[cfg(unix)]
fn ignores_hangup() -> bool {
    static IGNORES: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    *IGNORES.get_or_init(|| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        ignored_signals(&status) & 1 << (signal_hook::consts::SIGHUP - 1) != 0
    })
}

/// The set of ignored signals in a Linux process's status; empty where there is none.
#[cfg(unix)]
fn ignored_signals(status: &str) -> u64 {
    let mut sets = status
        .lines()
        .filter_map(|line| line.strip_prefix("SigIgn:"));
    let set = sets.next().unwrap_or_default();
    u64::from_str_radix(set.trim(), 16).unwrap_or(0)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_ignored_signals_are_read_from_the_status() {
        let status = "Name:\tselvedge\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000001001\n";
        assert_eq!(ignored_signals(status), 0x1001);
        assert_eq!(ignored_signals("Name:\tselvedge\n"), 0);
        assert_eq!(ignored_signals("SigIgn: many\n"), 0);
    }
}
