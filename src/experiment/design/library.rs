//! The library that a design's textiles are in.

use std::path::Path;

use super::Design;
use selvedge_textile::{BuildCache, Library, TextileError, is_of_the_program};

impl Design {
    /// Opens the design's library: the one that it names, seen from the folder that the design's
    /// file lies in, or the shipped one. What is built from recipes is kept in `cache`.
    ///
    /// # Errors
    /// There is no such library, or it cannot be read.
    pub fn open_library(
        &self,
        folder: &Path,
        cache: Option<&BuildCache>,
    ) -> Result<Library, TextileError> {
        match &self.library {
            None => Library::shipped(),
            Some(name) if is_of_the_program(name) => Library::named(name, cache),
            Some(name) => Library::named(&folder.join(name), cache),
        }
    }
}
