//! What is chosen and typed in the Library pane.

use std::sync::Arc;

/// Which libraries are listed.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) enum Shown {
    /// The scene's and the user's own.
    #[default]
    Near,
    /// All.
    All,
    /// The one with this title.
    One(Arc<str>),
}

/// The libraries, to take textiles from.
#[derive(Debug, Default)]
pub(crate) struct Library {
    /// What is typed in the field that searches them.
    pub(crate) search: String,
    /// Which libraries are listed.
    pub(crate) shown: Shown,
    /// The textile that gets another name, and that name as it is typed.
    pub(crate) renaming: Option<(String, String)>,
}
