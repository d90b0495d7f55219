//! A textile made in the window that is to be kept in a library.

use std::sync::Arc;

use super::window::Workbench;
use crate::textile::{BuiltFile, write};

/// A new textile: what it is called and all its files, its manifest among them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NewTextile {
    /// Its id: the name of its folder.
    pub(crate) id: String,
    /// What people call it.
    pub(crate) name: String,
    /// Its files, the manifest last.
    pub(crate) files: Vec<BuiltFile>,
}

/// What is to be done with a new textile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Keep {
    /// Keep it in the library of the scene.
    Save(Arc<NewTextile>),
    /// The same, and lay it under the display.
    Feel(Arc<NewTextile>),
}

impl Workbench {
    /// Writes a new textile into the folder of the scene's library.
    pub(crate) fn keep(&mut self, keep: &Keep) {
        let (Keep::Save(textile) | Keep::Feel(textile)) = keep;
        let root = self.loaded.library().root();
        let words = if root.is_dir() {
            match write(&textile.files, &root.join(&textile.id)) {
                Ok(()) => format!("Kept “{}” as {} in {}", textile.name, textile.id, root.display()),
                Err(error) => error.to_string(),
            }
        } else {
            "The scene's library is part of the program: open a scene with a folder of textiles"
                .to_owned()
        };
        self.transient.notices.give(words);
    }
}
