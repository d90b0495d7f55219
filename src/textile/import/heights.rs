//! Making textiles of measured heights: read once, looked at, and kept place by place.
//!
//! A [`HeightImport`] is what a window shows before anything is written: the heights, level unless
//! they repeat, and at any place of them the four strokes of the virtual tester. Every place that
//! is kept is a textile: strokes as profile files, a shaded picture, and a manifest that says what
//! they came from.

use std::path::{Path, PathBuf};

use super::description::{Description, manifest_file};
use super::profile_files::{profile_files, shaded};
use crate::build::{BuiltFile, PICTURE};
use crate::error::TextileError;
use crate::manifest::{AppearanceKeys, MANIFEST, Manifest};
use crate::metrology::{HeightOptions, Measured};
use crate::recipe::{ProfileFiles, SourceKeys as _};
use crate::sources::Source;
use crate::sources::heightmap::{Heightmap, Laid};
use crate::surface::{Direction, HeightMap, Preparation, ProfileSet, Representation, smd_um};
use crate::yarns::PX_PER_MM;
use selvedge_foundation::files::sha256_hex;

/// How measured heights are read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ImportOptions {
    /// What the file leaves open.
    pub asked: HeightOptions,
    /// What is done to the heights.
    pub preparation: Preparation,
    /// Whether the map is one repeat of the textile.
    pub is_periodic: bool,
    /// Whether textiles are felt along four strokes, or at every point of the map.
    pub representation: Representation,
}

/// Measured heights on the way to textiles.
#[derive(Debug, Clone)]
pub struct HeightImport {
    path: PathBuf,
    keys: Heightmap,
    measured: Measured,
    laid: Laid,
}

/// One place of an import: the strokes that cross there.
#[derive(Debug, Clone)]
pub struct HeightPlace {
    /// The place as it was said, mm from the lower left corner; `None`: the middle.
    pub place_mm: Option<[f64; 2]>,
    /// What the tester records, by [`Direction::index`].
    pub profiles: ProfileSet,
}

impl HeightImport {
    /// Reads a file's bytes. `path` names it in errors and, by its last part, in the textile.
    ///
    /// # Errors
    /// As where the file is opened; a map or profile shorter than one window; a profile that is
    /// to be felt at every point.
    pub fn of(bytes: &[u8], path: &Path, options: &ImportOptions) -> Result<Self, TextileError> {
        let file = path.file_name().unwrap_or_default();
        let mut keys = Heightmap::new(file.to_string_lossy().into_owned(), &options.asked);
        keys.sha256 = Some(sha256_hex([bytes]));
        keys.set_preparation(options.preparation);
        keys.periodic = options.is_periodic;
        keys.representation = options.representation;
        let mut import = Self::by_keys(keys, bytes, path)?;
        if import.measured.about.format == "X3P" {
            "x3p".clone_into(&mut import.keys.kind);
        }
        Ok(import)
    }

    /// The files of a textile made again of its file of heights, as its manifest says.
    pub(super) fn again(
        manifest: &Manifest,
        keys: &Heightmap,
        (bytes, path): (&[u8], &Path),
    ) -> Result<Vec<BuiltFile>, TextileError> {
        let import = Self::by_keys(keys.clone(), bytes, path)?;
        let place = import.place(keys.place_mm)?;
        let is_changed = |source: &Source| {
            let recipe_hash = source.keys().recipe_hash();
            recipe_hash != manifest.source.keys().recipe_hash()
        };
        import.files_with(&place, bytes, |source| {
            let mut again = manifest.clone();
            if is_changed(&source) {
                again.measured.extend(import.figures(&place));
            }
            again.source = source;
            again
        })
    }

    fn by_keys(keys: Heightmap, bytes: &[u8], path: &Path) -> Result<Self, TextileError> {
        let measured = keys.open(bytes, path)?;
        let laid = keys.laid(&measured, path)?;
        Ok(Self {
            path: path.to_owned(),
            keys,
            measured,
            laid,
        })
    }

    /// What the file holds, with what is missing.
    pub fn measured(&self) -> &Measured {
        &self.measured
    }

    /// The heights as the tester goes over them: tilt taken off once unless they repeat, missing
    /// points still missing.
    pub fn map(&self) -> &HeightMap {
        &self.laid.map
    }

    /// SHA-256 of the file.
    pub fn sha256(&self) -> &str {
        self.keys.sha256.as_deref().unwrap_or_default()
    }

    /// What is odd about the file and what was done, one line each.
    pub fn notes(&self) -> &[String] {
        &self.laid.notes
    }

    /// The textile's name where none is said: the title of the data, else the file's name.
    pub fn own_name(&self) -> String {
        let title = self.measured.about.title.trim();
        if title.is_empty() {
            let stem = Path::new(&self.keys.file).file_stem().unwrap_or_default();
            return stem.to_string_lossy().into_owned();
        }
        title.to_owned()
    }

    /// The strokes that cross at a place, mm from the lower left corner; in the middle if none is
    /// said.
    ///
    /// # Errors
    /// A place that is not on the map.
    pub fn place(&self, place_mm: Option<[f64; 2]>) -> Result<HeightPlace, TextileError> {
        let profiles = self.keys.strokes_at(&self.laid, place_mm, &self.path)?;
        Ok(HeightPlace { place_mm, profiles })
    }

    /// The files of the textile of a place, the manifest last. `bytes` are those of the file: they
    /// become a part of a textile that is felt at every point.
    ///
    /// # Errors
    /// A description that no manifest takes.
    pub fn files(
        &self,
        place: &HeightPlace,
        description: &Description,
        bytes: &[u8],
    ) -> Result<Vec<BuiltFile>, TextileError> {
        self.files_with(place, bytes, |source| {
            self.manifest(source, place, description)
        })
    }

    fn files_with(
        &self,
        place: &HeightPlace,
        bytes: &[u8],
        manifest: impl FnOnce(Source) -> Manifest,
    ) -> Result<Vec<BuiltFile>, TextileError> {
        let mut keys = self.keys.clone();
        keys.place_mm = place.place_mm;
        let mut files = Vec::new();
        if keys.representation == Representation::Areal {
            files.push(BuiltFile::new(&keys.file, bytes));
        } else {
            files = profile_files(&place.profiles)?;
            let named = Direction::ALL.map(|direction| {
                let is_there = place.profiles[direction.index()].is_some();
                is_there.then(|| ProfileFiles::name(direction))
            });
            let source = Source::Heightmap(Box::new(keys.clone()));
            let hash = source.recipe_hash(&self.path)?;
            keys.set_files(ProfileFiles(named), Some(hash));
        }
        if !self.measured.is_profile() {
            let picture = shaded(&self.measured).map_err(TextileError::surface(&self.path))?;
            let bytes = picture.to_small_png(Path::new(PICTURE))?;
            files.push(BuiltFile::new(PICTURE, bytes));
        }
        let manifest = manifest(Source::Heightmap(Box::new(keys)));
        files.push(manifest_file(&manifest, Path::new(MANIFEST))?);
        Ok(files)
    }

    fn manifest(&self, source: Source, place: &HeightPlace, description: &Description) -> Manifest {
        let name = description.name.trim();
        let name = if name.is_empty() {
            self.own_name()
        } else {
            name.to_owned()
        };
        let about = &self.measured.about;
        let parts = [
            description.notes.clone(),
            format!(
                "measured heights from {} ({})",
                self.keys.file, about.format
            ),
            about.instrument.clone(),
            about.date.clone(),
            about.comment.clone(),
        ];
        let parts = parts.into_iter().chain(self.notes().iter().cloned());
        let parts = parts.map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
        let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
        let picture = AppearanceKeys {
            image: PICTURE.to_owned(),
            px_per_mm: PX_PER_MM,
        };
        Manifest {
            name,
            notes: parts.join("; "),
            appearance: (!self.measured.is_profile()).then_some(picture),
            ..description.manifest(source, self.figures(place).into_iter().collect())
        }
    }

    fn figures(&self, place: &HeightPlace) -> [(String, f64); 3] {
        let round = |um: f64| (um * 1e3).round() / 1e3;
        let figures = [
            ("smd_um", round(place.smd_um())),
            ("sq_um", round(self.measured.sq_um())),
            ("n_missing", self.measured.n_missing() as f64),
        ];
        figures.map(|(key, value)| (key.to_owned(), value))
    }
}

impl HeightPlace {
    /// SMD of the strokes, mean, µm.
    pub fn smd_um(&self) -> f64 {
        smd_um(&self.profiles)
    }
}
