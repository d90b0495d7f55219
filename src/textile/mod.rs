//! Textiles: their manifests, the sources that surfaces come from, and libraries of them.
//!
//! A textile is a folder with a manifest; its source is measured profiles or a seeded model of a
//! woven or knitted cloth that a virtual probe was drawn over. Knows nothing of scenes or of
//! rendering.
//!
//! # Invariants
//! - loading is lazy: a library reads a textile's profiles only when it is asked for that textile
//! - a model is a function of its recipe: same recipe, same bytes
//! - every error is one line: what, where, how to mend it

mod build;
mod cache;
mod cloth;
mod index;
mod knit;
mod library;
mod loaded;
mod manifest;
mod model;
mod profile_file;
mod recipes;
mod selection;
mod shipped;
mod weave;
mod workers;

pub use build::{BuiltFile, build, build_library, make};
pub use cache::BuildCache;
pub use cloth::{Side, Yarn};
pub use index::{Index, IndexEntry};
pub use knit::{Knit, Structure};
pub use library::{Library, is_of_the_program};
pub use loaded::{Appearance, Textile};
pub use manifest::{AppearanceKeys, Construction, Manifest, ProfileFiles, Profiles, Source};
pub use recipes::SEVENTY_FOUR;
pub use selection::{kind_of, most_typical};
pub use weave::{Interlacing, NAMES as INTERLACINGS, Weave};
pub use workers::n_threads;

use std::path::PathBuf;

use crate::files::FileError;
use crate::progress::Cancelled;
use crate::surface::SurfaceError;

/// What can be wrong with a textile or a library.
#[derive(Debug, thiserror::Error)]
pub enum TextileError {
    /// A file cannot be read or written, or its content is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// Heights that are no surface.
    #[error("{}: {source}", path.display())]
    Surface {
        /// The file they come from.
        path: PathBuf,
        /// What is wrong.
        source: SurfaceError,
    },
    /// No such textile.
    #[error("no textile \"{id}\" in {library}; it has {known}")]
    Unknown {
        /// What was asked for.
        id: String,
        /// The library.
        library: String,
        /// What it has.
        known: String,
    },
    /// A textile that is no model has nothing to be built from.
    #[error(
        "{}: a source of kind \"{kind}\" is not a recipe; give kind = \"weave\" or \"knit\"",
        path.display()
    )]
    NoRecipe {
        /// The manifest.
        path: PathBuf,
        /// The kind it has.
        kind: &'static str,
    },
    /// Nothing was measured on the textiles of a library.
    #[error(
        "{}: no levels were measured; build it with \"selvedge textile build\", which writes a \
         library.toml",
        library.display()
    )]
    NoIndex {
        /// The library.
        library: PathBuf,
    },
    /// The work was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

#[cfg(test)]
mod tests;
