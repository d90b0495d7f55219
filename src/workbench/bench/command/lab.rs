//! What other tools want of the textile lab.

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
