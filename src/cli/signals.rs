//! SIGINT and SIGTERM: the work is asked to end, and ends cleanly.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::CliError;

/// What a shell reports of a process that SIGINT ended.
const INTERRUPTED: i32 = 130;

/// A flag that SIGINT and SIGTERM raise. A second signal ends the process at once.
pub(super) fn stop_flag() -> Result<Arc<AtomicBool>, CliError> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        let hooked = flag::register_conditional_shutdown(signal, INTERRUPTED, Arc::clone(&stop))
            .and_then(|_| flag::register(signal, Arc::clone(&stop)));
        hooked.map_err(|error| {
            CliError::Failed(format!("cannot listen to signals: {error}; try again"))
        })?;
    }
    Ok(stop)
}
