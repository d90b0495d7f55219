//! What everything else needs to know of a session of an experiment: who takes part, where its log
//! lies, and what nobody may look at meanwhile.

use std::path::PathBuf;

use crate::bench::Bench;
use crate::bench::pane::Pane;
use selvedge_experiment::design::Design;

/// An active session as far as others need to know of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SessionInSight {
    /// Who takes part.
    pub(crate) pseudonym: String,
    /// The log.
    pub(crate) log: PathBuf,
}

impl Bench {
    /// Whether a session of an experiment is under way.
    pub(crate) fn has_session(&self) -> bool {
        self.session.is_some()
    }

    /// Whether a pane would tell what a session must not.
    pub(crate) fn is_veiled(&self, pane: Pane) -> bool {
        // The analysis has a cover of its own.
        let is_open = matches!(
            pane,
            Pane::Participant | Pane::Experimenter | Pane::Bridge | Pane::Analysis
        );
        self.has_session() && !is_open
    }
}

/// What people call a design.
pub(crate) fn title_of(design: &Design) -> String {
    if design.title.is_empty() {
        design.experiment.clone()
    } else {
        design.title.clone()
    }
}
