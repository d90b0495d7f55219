//! The textiles of the library that are selected, in every view of it.

use std::collections::BTreeSet;
use std::sync::Arc;

/// How a textile joins what is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Joining {
    /// In the place of what was selected.
    Alone,
    /// Beside it, or taken away from it if it was.
    Toggled,
    /// Beside it.
    Also,
}

/// The ids of the textiles that are selected.
#[derive(Debug, Clone, Default)]
pub(crate) struct LibrarySelection(pub(crate) Arc<BTreeSet<String>>);

impl LibrarySelection {
    /// Selects textiles.
    pub(crate) fn select(&mut self, ids: Vec<String>, joining: Joining) {
        let selected = Arc::make_mut(&mut self.0);
        match joining {
            Joining::Alone => *selected = ids.into_iter().collect(),
            Joining::Also => selected.extend(ids),
            Joining::Toggled => {
                for id in ids {
                    if !selected.remove(&id) {
                        selected.insert(id);
                    }
                }
            }
        }
    }
}
