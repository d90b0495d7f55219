//! The log that an engine's links are written to.

use super::Engine;
use crate::bridge::{Bridge, SessionLog};

impl Engine {
    /// Writes what happens on every link that is opened from now on to a log.
    pub fn log_links_to(&mut self, log: SessionLog) {
        self.session_log = Some(log);
    }

    /// The log that links are written to.
    pub fn session_log(&self) -> Option<&SessionLog> {
        self.session_log.as_ref()
    }

    /// Lets a link be logged, if there is a log.
    pub(super) fn log(&self, bridge: &mut Bridge) {
        if let Some(log) = &self.session_log {
            let feed = log.feed(bridge.target());
            bridge.log_to(feed);
        }
    }
}
