//! What other tools want of the textile lab.

use crate::bench::command::Command;

/// What a recipe begins with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Beginning {
    /// The example of a kind of recipe.
    Example(&'static str),
    /// A copy of the recipe of a textile of the library.
    Copy(String),
    /// What repeats in the profiles of a textile of the library.
    Restore(String),
}

impl From<Beginning> for Command {
    fn from(beginning: Beginning) -> Self {
        Self::Lab(beginning)
    }
}
