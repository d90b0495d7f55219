//! Textiles that the window makes and the user keeps.

use std::sync::Arc;

use super::command::Command;
use crate::textile::BuiltFile;

/// A textile that is not in any library yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NewTextile {
    /// The name of its folder.
    pub(crate) id: String,
    /// What people call it.
    pub(crate) name: String,
    /// Its files, the manifest among them.
    pub(crate) files: Vec<BuiltFile>,
}

/// What is done with a new textile.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Keep {
    /// Into the scene's library.
    Save(Arc<NewTextile>),
    /// The same, and it is placed under the display.
    Feel(Arc<NewTextile>),
}

impl From<Keep> for Command {
    fn from(keep: Keep) -> Self {
        Self::Keep(keep)
    }
}
