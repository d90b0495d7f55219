//! Making a textile folder of measured heights: strokes as profile files, a shaded picture, and a
//! manifest that says what they came from.

use std::path::Path;

use super::made::{profile_files, shaded, smd_um};
use super::source::Heightmap;
use super::{Asked, Measured};
use crate::files::{encode_png_small, sha256_hex};
use crate::surface::Direction;
use crate::textile::TextileError;
use crate::textile::build::{BuiltFile, PICTURE, write};
use crate::textile::cloth::PX_PER_MM;
use crate::textile::loaded::MANIFEST;
use crate::textile::manifest::{AppearanceKeys, Construction, Manifest, ProfileFiles, Source};

/// How measured heights become a textile.
#[derive(Debug, Clone, Default)]
pub struct ImportOptions {
    /// What the file leaves open.
    pub asked: Asked,
    /// Where the strokes cross, mm from the lower left corner; the middle if not stated.
    pub place_mm: Option<[f64; 2]>,
    /// Whether the map is one repeat of the cloth.
    pub is_periodic: bool,
    /// What people call it; the file's title or name if not stated.
    pub name: Option<String>,
}

/// A textile that was made of measured heights.
#[derive(Debug)]
pub struct Imported {
    /// Its manifest.
    pub manifest: Manifest,
    /// The heights, with what is missing.
    pub measured: Measured,
    /// What is odd about the file and what was done, one line each.
    pub notes: Vec<String>,
}

/// Makes a textile of a file's bytes in a folder, the manifest last. `path` names the file.
///
/// # Errors
/// As [`super::open`]; a map or profile shorter than one window; a folder that cannot be written.
pub fn import(
    bytes: &[u8],
    path: &Path,
    options: &ImportOptions,
    folder: &Path,
) -> Result<Imported, TextileError> {
    let file = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let mut keys = Heightmap::new(file, &options.asked);
    keys.sha256 = Some(sha256_hex([bytes]));
    keys.place_mm = options.place_mm;
    keys.periodic = options.is_periodic;
    let measured = keys.open(bytes, path)?;
    if measured.about.format == "X3P" {
        "x3p".clone_into(&mut keys.kind);
    }
    let (profiles, notes) = keys.strokes(&measured, path)?;
    let mut files = profile_files(&profiles)?;
    let picture = (!measured.is_profile())
        .then(|| shaded(&measured))
        .transpose();
    if let Some(picture) = picture.map_err(|source| TextileError::Surface {
        path: path.to_owned(),
        source,
    })? {
        let bytes = encode_png_small(&picture, Path::new(PICTURE))?;
        files.push(BuiltFile {
            name: PICTURE.to_owned(),
            bytes,
        });
    }
    let named = Direction::ALL.map(|direction| {
        let is_there = profiles[direction.index()].is_some();
        is_there.then(|| format!("{}.csv", direction.key()))
    });
    let hash = Source::Heightmap(Box::new(keys.clone())).recipe_hash(path)?;
    keys.set_files(ProfileFiles(named), Some(hash));
    let smd_um = smd_um(&profiles);
    let manifest = manifest(&measured, keys, (&notes, smd_um), options);
    let text = manifest.to_toml(&folder.join(MANIFEST))?;
    files.push(BuiltFile {
        name: MANIFEST.to_owned(),
        bytes: text.into_bytes(),
    });
    write(&files, folder)?;
    Ok(Imported {
        manifest,
        measured,
        notes,
    })
}

fn manifest(
    measured: &Measured,
    keys: Heightmap,
    (notes, smd_um): (&[String], f64),
    options: &ImportOptions,
) -> Manifest {
    let about = &measured.about;
    let stem = Path::new(&keys.file).file_stem().unwrap_or_default();
    let names = [
        options.name.as_deref().unwrap_or_default(),
        about.title.as_str(),
    ];
    let name = names
        .iter()
        .map(|name| name.trim())
        .find(|name| !name.is_empty());
    let name = name.map_or_else(|| stem.to_string_lossy().into_owned(), ToOwned::to_owned);
    let parts = [
        format!("measured heights from {} ({})", keys.file, about.format),
        about.instrument.clone(),
        about.date.clone(),
        about.comment.clone(),
    ];
    let parts = parts.into_iter().chain(notes.iter().cloned());
    let parts = parts.map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
    let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
    let round = |um: f64| (um * 1e3).round() / 1e3;
    let figures = [
        ("smd_um", round(smd_um)),
        ("sq_um", round(measured.sq_um())),
        ("n_missing", measured.n_missing() as f64),
    ];
    let picture = AppearanceKeys {
        image: PICTURE.to_owned(),
        px_per_mm: PX_PER_MM,
    };
    Manifest {
        name,
        construction: Construction::Other,
        fibre: String::new(),
        gain_db: 0.0,
        noise_floor_um2_mm: None,
        licence: String::new(),
        notes: parts.join("; "),
        source: Source::Heightmap(Box::new(keys)),
        appearance: (!measured.is_profile()).then_some(picture),
        measured: figures
            .map(|(key, um)| (key.to_owned(), um))
            .into_iter()
            .collect(),
    }
}
