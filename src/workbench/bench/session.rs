//! What everything else needs to know of a session of an experiment: who takes part, where its log
//! lies, and what nobody may look at meanwhile.

use std::path::PathBuf;

use selvedge_experiment::design::Design;

/// An active session as far as others need to know of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SessionInSight {
    /// Who takes part.
    pub(crate) pseudonym: String,
    /// The log.
    pub(crate) log: PathBuf,
}

/// What people call a design.
pub(crate) fn title_of(design: &Design) -> String {
    if design.title.is_empty() {
        design.experiment.clone()
    } else {
        design.title.clone()
    }
}
