//! Trials of a cloth that hangs: the session says what hangs, the tool of hanging cloths shows it
//! in the participant's view and lets it be felt.

use crate::bench::session::Hung;
use crate::tools::experiment::active_session::ActiveSession;
use selvedge_experiment::layout::Layout;

impl ActiveSession {
    /// The textile that hangs in this trial, if one does.
    pub(crate) fn hanging_textile(&self) -> Option<&str> {
        Layout::hanging(&self.design, &self.trial()?.task)
    }

    /// What hangs, as others need to know of it.
    pub(crate) fn hung(&self) -> Option<Hung> {
        self.hanging_textile().map(|id| Hung {
            id: id.to_owned(),
            library: self.materials.library(),
            is_felt: self.is_felt(),
        })
    }
}
