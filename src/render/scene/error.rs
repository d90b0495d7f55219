//! What can be wrong with a scene or a path: one line each.

use selvedge_foundation::files::FileError;
use selvedge_textile::TextileError;

/// What can be wrong with a scene, a path or a stroke.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file: what, where and how to mend it.
    #[error(transparent)]
    File(#[from] FileError),
    /// A textile that the scene places.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// A value that did not come from a file.
    #[error("{what}; {mend}")]
    Value {
        /// What is wrong.
        what: String,
        /// What to do about it.
        mend: String,
    },
}
