//! SIGINT and SIGTERM: the work is asked to end, and ends cleanly.
//!
//! Every signal asks for the same, so that one that is sent twice does not cut a clean end short.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The system does not let the program listen to signals.
#[derive(Debug, thiserror::Error)]
#[error("cannot listen to signals: {0}; try again")]
pub struct SignalError(#[from] io::Error);

/// A flag that SIGINT and SIGTERM raise.
///
/// # Errors
/// The system does not let the program listen.
pub fn stop_flag() -> Result<Arc<AtomicBool>, SignalError> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// Does `act` whenever SIGINT or SIGTERM arrives, on a thread of its own that ends with the
/// process.
///
/// Where signals cannot be listened to they end the program as they always did, and the
/// device falls silent by its own rule.
#[cfg(unix)]
pub fn on_signal(act: impl Fn() + Send + 'static) {
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]) else {
        return;
    };
    let listen = move || signals.forever().for_each(|_signal| act());
    let listener = std::thread::Builder::new().name("signals".to_owned());
    // A system that has no thread left to give cannot run the engine either.
    drop(listener.spawn(listen));
}

/// This system has no such signals.
#[cfg(not(unix))]
pub fn on_signal(_act: impl Fn() + Send + 'static) {}
