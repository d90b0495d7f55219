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
    /// What hangs as a cloth in the trial that is at hand.
    pub(crate) hung: Option<Hung>,
}

/// A textile that a session hangs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Hung {
    /// What its library calls it.
    pub(crate) id: String,
    /// Where that is; `None` is the program's.
    pub(crate) library: Option<PathBuf>,
    /// Whether its trial has begun: before that nothing is felt of it.
    pub(crate) is_felt: bool,
}

/// What people call a design.
pub(crate) fn title_of(design: &Design) -> String {
    if design.title.is_empty() {
        design.experiment.clone()
    } else {
        design.title.clone()
    }
}
