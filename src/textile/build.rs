//! Building textiles from recipes, and a library from its recipes.
//!
//! Same recipe, same bytes: nothing here looks at a clock, a thread count or the order of a
//! folder.

use std::fs;
use std::path::Path;

use super::index::{Index, IndexEntry};
use super::library::{INDEX, Library, Store};
use super::loaded::{MANIFEST, Textile, read_manifest};
use super::manifest::{AppearanceKeys, Manifest, ProfileFiles, Source};
use super::model::{Model, profiles_of_files};
use super::{TextileError, workers};
use crate::surface::{Direction, Representation, Surface};
use crate::tactile::{Filters, Levels, Tuning};
use selvedge_foundation::files::{
    FileError, encode_png_small, read_text, sha256_hex, write_atomic,
};
use selvedge_foundation::progress::{Progress, unheard};

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

/// Builds a textile from its recipe: four profiles, the picture and the complete manifest. `path`
/// only names the recipe in errors.
///
/// # Errors
/// A source that is no recipe.
pub fn build(recipe: &Manifest, path: &Path) -> Result<Vec<BuiltFile>, TextileError> {
    let model = Model::of(&recipe.source)?.ok_or_else(|| TextileError::NoRecipe {
        path: path.to_owned(),
        kind: recipe.source.kind(),
    })?;
    let texts = model.profile_files()?;
    let smd_um: f64 = profiles_of_files(&texts)?
        .iter()
        .flatten()
        .map(|profile| 0.25 * profile.smd_um())
        .sum();
    let file = |(direction, text): (Direction, String)| BuiltFile {
        name: format!("{}.csv", direction.key()),
        bytes: text.into_bytes(),
    };
    let mut files: Vec<_> = Direction::ALL.into_iter().zip(texts).map(file).collect();
    let (picture, px_per_mm) = model.picture();
    let bytes = encode_png_small(&picture, Path::new(PICTURE))?;
    files.push(BuiltFile {
        name: PICTURE.to_owned(),
        bytes,
    });
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
    let bytes = manifest.to_toml(path)?.into_bytes();
    files.push(BuiltFile {
        name: MANIFEST.to_owned(),
        bytes,
    });
    Ok(files)
}

/// The manifest of a built textile: its recipe and the files made from it.
fn complete(recipe: &Manifest, px_per_mm: f64, path: &Path) -> Result<Manifest, TextileError> {
    let mut manifest = recipe.clone();
    let hash = Some(recipe.source.recipe_hash(path)?);
    let files =
        ProfileFiles(Direction::ALL.map(|direction| Some(format!("{}.csv", direction.key()))));
    manifest.source.set_files(files, hash);
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

/// Writes the files of a textile into a folder, in their order.
pub fn write(files: &[BuiltFile], folder: &Path) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(|source| FileError::Write {
        path: folder.to_owned(),
        source,
    })?;
    files
        .iter()
        .try_for_each(|file| write_atomic(&folder.join(&file.name), &file.bytes))
}

/// Builds every textile of the library `from` into the folder `to`.
///
/// Writes its index, with this default tuning. Manifests of recipes are enough; textiles that are
/// no models are copied. The work is shared among `n_threads`, which changes no byte.
pub fn build_library(
    from: &Library,
    to: &Path,
    tuning: Tuning,
    n_threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Index, TextileError> {
    let build = |id: &str| {
        let recipe = from.manifest(id)?;
        let path = from.root().join(id).join(MANIFEST);
        let files = match recipe.source {
            Source::Profiles(_) | Source::Heightmap(_) | Source::Picture(_) => files_of(from, id)?,
            _ => build(&recipe, &path)?,
        };
        Ok(write(&files, &to.join(id))?)
    };
    workers::for_each(from.ids(), n_threads, progress, build)?;
    let index = index_of(&Library::of_folder(to, from.ids()), tuning, n_threads)?;
    let path = to.join(INDEX);
    write_atomic(&path, index.to_toml(&path)?.as_bytes())?;
    progress.step(1.0, INDEX)?;
    Ok(index)
}

/// The files of a textile of a library, as they are; recipes of a file are built.
pub(crate) fn files_of(from: &Library, id: &str) -> Result<Vec<BuiltFile>, TextileError> {
    let store = from.files_of(id)?;
    let manifest = read_manifest(&store, id)?;
    let mut names = content_names(&manifest);
    names.extend(manifest.source.friction().map(ToOwned::to_owned));
    names.extend(manifest.appearance.as_ref().map(|keys| keys.image.clone()));
    names.push(MANIFEST.to_owned());
    if let Some(keys) = manifest.source.kept_map()
        && !names.contains(&keys.file)
        && store.read(id, &keys.file).is_ok()
    {
        names.push(keys.file.clone());
    }
    let copy = |name: String| {
        let bytes = store.read(id, &name)?.into_owned();
        Ok(BuiltFile { name, bytes })
    };
    names.into_iter().map(copy).collect()
}

/// The files that a textile's surface is made from, besides its manifest.
fn content_names(manifest: &Manifest) -> Vec<String> {
    let mut names: Vec<String> = manifest.source.files().0.into_iter().flatten().collect();
    let is_areal = manifest.source.representation() == Representation::Areal;
    if let Some(keys) = manifest.source.kept_map()
        && (names.is_empty() || is_areal)
    {
        names.push(keys.file.clone());
    }
    names
}

/// What the figures of an index are made from: id, manifest and surface.
pub(crate) fn content_of(store: &Store, id: &str) -> Result<Vec<Vec<u8>>, TextileError> {
    let manifest = read_manifest(store, id)?;
    let mut content = vec![
        id.as_bytes().to_vec(),
        store.read(id, MANIFEST)?.into_owned(),
    ];
    for name in content_names(&manifest) {
        content.push(store.read(id, &name)?.into_owned());
    }
    Ok(content)
}

/// The index of a library, from its profiles: levels with the default filters (to six digits), the
/// mean level, the hash of what they were made from.
pub(crate) fn index_of(
    library: &Library,
    tuning: Tuning,
    n_threads: usize,
) -> Result<Index, TextileError> {
    let measure = |id: &str| {
        let store = library.files_of(id)?;
        let textile = Textile::load(&store, id)?;
        let [a40_um, a320_um] = means_um(textile.surface());
        let id = id.to_owned();
        let content = content_of(&store, &id)?;
        let entry = IndexEntry {
            id,
            a40_um,
            a320_um,
        };
        Ok((entry, content))
    };
    let measured =
        unheard(|progress| workers::for_each(library.ids(), n_threads, progress, measure));
    let (textiles, content): (Vec<IndexEntry>, Vec<_>) = measured?.into_iter().unzip();
    let levels: Vec<f64> = textiles.iter().filter_map(IndexEntry::level_db).collect();
    let mean = levels.iter().sum::<f64>() / levels.len().max(1) as f64;
    Ok(Index {
        content_hash: sha256_hex(content.iter().flatten().map(Vec::as_slice)),
        compression_reference_db: (mean * 1e4).round() / 1e4,
        tuning,
        textiles,
    })
}

/// The hash that the index of a library states: of what its figures are made from, in order.
pub(crate) fn hash_of(library: &Library) -> Result<String, TextileError> {
    let contents = library
        .ids()
        .iter()
        .map(|id| content_of(&library.files_of(id)?, id));
    let contents = contents.collect::<Result<Vec<_>, _>>()?;
    Ok(sha256_hex(contents.iter().flatten().map(Vec::as_slice)))
}

/// Mean amplitude of both bands as an index states it, to six digits, µm.
pub(crate) fn means_um(surface: &Surface) -> [f64; 2] {
    let levels = Levels::of(surface, &Filters::default());
    levels.mean_um.map(six_digits)
}

/// A number to six significant digits: what rounding hides cannot differ between machines.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
