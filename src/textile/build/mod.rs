//! Building a textile from its recipe, in memory or into a folder.
//!
//! Same recipe, same bytes: nothing here looks at a clock, a thread count or the order of a
//! folder.

mod preview;

pub use preview::RecipePreview;

use std::path::Path;

use crate::error::TextileError;
use crate::manifest::{AppearanceKeys, MANIFEST, Manifest};
use crate::recipe::{ProfileFiles, profiles_of_files};
use crate::surface::Direction;
use selvedge_foundation::files::{FileError, read_text, write_folder};

/// The name of the picture.
pub(crate) const PICTURE: &str = "appearance.png";

/// A file of a built textile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuiltFile {
    /// Its name in the textile's folder.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl BuiltFile {
    pub(crate) fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            bytes: bytes.into(),
        }
    }
}

/// Builds a textile from its recipe: four profiles, the picture and the complete manifest. `path`
/// only names the recipe in errors.
///
/// # Errors
/// A source that is no recipe.
pub fn build(recipe: &Manifest, path: &Path) -> Result<Vec<BuiltFile>, TextileError> {
    let model = recipe.source.model(path)?;
    let texts = model.profile_files()?;
    let smd_um: f64 = profiles_of_files(&texts)?
        .iter()
        .flatten()
        .map(|profile| 0.25 * profile.smd_um())
        .sum();
    let file = |(direction, text)| BuiltFile::new(ProfileFiles::name(direction), text);
    let mut files: Vec<_> = Direction::ALL.into_iter().zip(texts).map(file).collect();
    let (picture, px_per_mm) = model.picture();
    let bytes = picture.to_small_png(Path::new(PICTURE))?;
    files.push(BuiltFile::new(PICTURE, bytes));
    let mut manifest = complete(recipe, px_per_mm, path)?;
    let found = [("smd_um", smd_um, 100.0)].into_iter();
    let found = found.chain(
        model
            .measured()
            .iter()
            .map(|&(key, value)| (key, value, 1e4)),
    );
    for (key, value, digits) in found {
        let rounded = (value * digits).round() / digits;
        manifest.measured.insert(key.to_owned(), rounded);
    }
    files.push(BuiltFile::new(MANIFEST, manifest.to_toml(path)?));
    Ok(files)
}

/// The manifest of a built textile: its recipe and the files made from it.
fn complete(recipe: &Manifest, px_per_mm: f64, path: &Path) -> Result<Manifest, TextileError> {
    let mut manifest = recipe.clone();
    let hash = Some(recipe.source.recipe_hash(path)?);
    manifest.source.set_files(ProfileFiles::all(), hash);
    manifest.appearance = Some(AppearanceKeys {
        image: PICTURE.to_owned(),
        px_per_mm,
    });
    Ok(manifest)
}

/// Builds the textile of a recipe (TOML) into a folder, the manifest last: a folder with a
/// manifest is whole.
pub fn make(recipe: &str, path: &Path, folder: &Path) -> Result<Manifest, TextileError> {
    let recipe = Manifest::from_toml(recipe, path)?;
    let files = build(&recipe, path)?;
    write(&files, folder)?;
    let manifest = folder.join(MANIFEST);
    Manifest::from_toml(&read_text(&manifest)?, &manifest)
}

/// Writes the files of a textile into a folder, in their order, all or none.
pub fn write(files: &[BuiltFile], folder: &Path) -> Result<(), FileError> {
    let named = files.iter().map(|file| (&*file.name, &*file.bytes));
    write_folder(folder, &named.collect::<Vec<_>>())
}
