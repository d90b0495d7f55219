//! Building a library from its recipes, and the index of one.

use std::path::Path;

use super::Library;
use super::index::{INDEX, Index, IndexEntry};
use super::parallel::for_each;
use super::textile::{Textile, content_names, content_of, read_manifest};
use crate::build::{BuiltFile, build, write};
use crate::error::TextileError;
use crate::manifest::MANIFEST;
use crate::surface::Surface;
use crate::tactile::{Filters, Levels, Tuning};
use selvedge_foundation::files::{sha256_hex, write_atomic};
use selvedge_foundation::progress::Progress;

impl Index {
    /// Builds every textile of the library `from` into the folder `to`.
    ///
    /// Writes its index, with this default tuning. Manifests of recipes are enough; textiles that
    /// are no models are copied. The work is shared among `n_threads`, which changes no byte.
    pub fn build(
        from: &Library,
        to: &Path,
        tuning: Tuning,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, TextileError> {
        let build = |id: &str| {
            let recipe = from.manifest(id)?;
            let path = from.root().join(id).join(MANIFEST);
            let files = if recipe.source.is_recipe() {
                build(&recipe, &path)?
            } else {
                from.files_of(id)?
            };
            Ok(write(&files, &to.join(id))?)
        };
        for_each(from.ids(), n_threads, progress, build)?;
        let index = index_of(&Library::of_folder(to, from.ids()), tuning, n_threads)?;
        let path = to.join(INDEX);
        write_atomic(&path, index.to_toml(&path)?.as_bytes())?;
        progress.step(1.0, INDEX)?;
        Ok(index)
    }
}

/// The index of a library, from its profiles: levels with the default filters (to six digits), the
/// mean level, the hash of what they were made from.
pub(crate) fn index_of(
    library: &Library,
    tuning: Tuning,
    n_threads: usize,
) -> Result<Index, TextileError> {
    let measure = |id: &str| {
        let store = library.store_of(id)?;
        let textile = Textile::load(&store, id)?;
        Ok((entry_of(id, textile.surface()), content_of(&store, id)?))
    };
    let measured =
        Progress::unheard(|progress| for_each(library.ids(), n_threads, progress, measure));
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

/// What an index states of a textile: mean amplitudes of both bands to six digits, µm.
pub(crate) fn entry_of(id: &str, surface: &Surface) -> IndexEntry {
    let levels = Levels::of(surface, &Filters::default());
    let [a40_um, a320_um] = levels.mean_um.map(six_digits);
    IndexEntry {
        id: id.to_owned(),
        a40_um,
        a320_um,
    }
}

/// A number to six significant digits: what rounding hides cannot differ between machines.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

impl Library {
    /// The files of a textile of a library, as they are; recipes of a file are built.
    ///
    /// # Errors
    /// An unknown id; a file that is missing or wrong.
    pub fn files_of(&self, id: &str) -> Result<Vec<BuiltFile>, TextileError> {
        let store = self.store_of(id)?;
        let manifest = read_manifest(&store, id)?;
        let mut names = content_names(&manifest);
        names.extend(manifest.friction_file().map(ToOwned::to_owned));
        names.extend(manifest.appearance.as_ref().map(|keys| keys.image.clone()));
        names.push(MANIFEST.to_owned());
        if let Some(heights) = manifest.source.keys().heights_file() {
            let name = heights.name().to_owned();
            if !names.contains(&name) && store.read(id, &name).is_ok() {
                names.push(name);
            }
        }
        let copy = |name: String| {
            let bytes = store.read(id, &name)?;
            Ok(BuiltFile::new(name, bytes))
        };
        names.into_iter().map(copy).collect()
    }
}

/// The hash that the index of a library states: of what its figures are made from, in order.
pub(crate) fn hash_of(library: &Library) -> Result<String, TextileError> {
    let contents = library
        .ids()
        .iter()
        .map(|id| content_of(&library.store_of(id)?, id));
    let contents = contents.collect::<Result<Vec<_>, _>>()?;
    Ok(sha256_hex(contents.iter().flatten().map(Vec::as_slice)))
}
