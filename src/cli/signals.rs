//! SIGINT and SIGTERM: the work is asked to end, and ends cleanly.
//!
//! Every signal asks for the same, so that one that is sent twice does not cut a clean end short.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::CliError;

/// A flag that SIGINT and SIGTERM raise.
pub(super) fn stop_flag() -> Result<Arc<AtomicBool>, CliError> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register(signal, Arc::clone(&stop)).map_err(|error| {
            CliError::Failed(format!("cannot listen to signals: {error}; try again"))
        })?;
    }
    Ok(stop)
}
