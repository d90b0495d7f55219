//! Making a textile again of what its manifest says: the recipe, or the steps that its file of
//! heights went through.

use std::path::Path;

use super::heights::HeightImport;
use super::{picture, read_measurement};
use crate::build::{BuiltFile, PICTURE, build};
use crate::error::TextileError;
use crate::manifest::{MANIFEST, Manifest};
use crate::sources::Source;
use selvedge_foundation::files::{FileError, read_text};

/// The files of the textile in a folder, made again as its manifest says; the same bytes if nothing
/// was changed. `heights` is its file of heights where that is not in the folder.
///
/// # Errors
/// A manifest that is wrong; strokes that are the measurement itself; a file of heights that is
/// missing or another one.
pub fn rebuilt(folder: &Path, heights: Option<&Path>) -> Result<Vec<BuiltFile>, TextileError> {
    let path = folder.join(MANIFEST);
    let manifest = Manifest::from_toml(&read_text(&path)?, &path)?;
    let read = |name: &str| {
        let beside = folder.join(name);
        let file = heights.unwrap_or(&beside);
        if heights.is_none() && !file.is_file() {
            let what = format!("its file of heights, {name}, is not in the folder");
            return Err(FileError::whole(folder, what, "say where it is (--file)"));
        }
        Ok((read_measurement(file)?, file.to_owned()))
    };
    match &manifest.source {
        Source::Heightmap(keys) => {
            let (bytes, path) = read(&keys.file)?;
            HeightImport::again(&manifest, keys, (&bytes, &path))
        }
        Source::Picture(keys) => {
            let (bytes, path) = read(&keys.file)?;
            let image = std::fs::read(folder.join(PICTURE)).ok();
            picture::again(&manifest, keys, (bytes, &path), image)
        }
        Source::Profiles(_) => {
            let what = "its strokes are the measurement itself";
            Err(FileError::whole(&path, what, "import the tester's files again").into())
        }
        _ => build(&manifest, &path),
    }
}
