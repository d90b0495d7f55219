//! Where an engine lives: on a thread of its own, or in its owner's hands.

use std::thread::JoinHandle;
use std::time::Instant;

use crate::runner::Runner;

pub(super) enum Body {
    /// A thread that keeps the real time.
    Thread(Option<JoinHandle<()>>),
    /// Stepped by its owner.
    Still(Box<Runner>),
}

impl Body {
    /// What time an engine without a thread was told.
    pub(super) fn told(&self) -> Option<Instant> {
        match self {
            Self::Still(runner) => Some(runner.clock.now()),
            Self::Thread(_) => None,
        }
    }

    /// Whether the thread is still there; an engine without one always is.
    pub(super) fn is_running(&self) -> bool {
        match self {
            Self::Thread(joined) => joined.as_ref().is_some_and(|joined| !joined.is_finished()),
            Self::Still(_) => true,
        }
    }
}
