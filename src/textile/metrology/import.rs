//! Making a textile folder of measured heights: strokes as profile files, a shaded picture, and a
//! manifest that says what they came from.

use std::path::Path;

use super::source::Heightmap;
use super::{Asked, Measured};
use crate::files::{Rgb8Image, encode_png_small, sha256_hex};
use crate::numerics::Grid;
use crate::surface::{Direction, HeightMap, Profile, ProfileSet, SurfaceError};
use crate::textile::build::{BuiltFile, PICTURE, write};
use crate::textile::cloth::PX_PER_MM;
use crate::textile::loaded::MANIFEST;
use crate::textile::manifest::{AppearanceKeys, Construction, Manifest, ProfileFiles, Source};
use crate::textile::{TextileError, profile_file};

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

fn profile_files(profiles: &ProfileSet) -> Result<Vec<BuiltFile>, TextileError> {
    let mut files = Vec::new();
    for direction in Direction::ALL {
        if let Some(profile) = &profiles[direction.index()] {
            let name = format!("{}.csv", direction.key());
            let (heights_um, step_mm) = (profile.heights_um(), profile.step_mm());
            let text = profile_file::write(heights_um, step_mm, Path::new(&name))?;
            let bytes = text.into_bytes();
            files.push(BuiltFile { name, bytes });
        }
    }
    Ok(files)
}

fn smd_um(profiles: &ProfileSet) -> f64 {
    let smd_um: Vec<f64> = profiles.iter().flatten().map(Profile::smd_um).collect();
    smd_um.iter().sum::<f64>() / smd_um.len().max(1) as f64
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
        provenance: None,
    }
}

/// Grey of what lies level, and how much a slope of one rms is lighter or darker.
const LEVEL_GREY: f64 = 150.0;
const SLOPE_GREY: f64 = 45.0;
/// Grey of what is missing.
const MISSING_GREY: u8 = 40;
/// Longest side of a picture, pixels.
const MOST_PIXELS: f64 = 2000.0;

/// The map lit from the upper left, from the top row on; what is mostly missing is plain and dark.
fn shaded(measured: &Measured) -> Result<Rgb8Image, SurfaceError> {
    let map = HeightMap::new(measured.heights_um.clone(), measured.step_mm)?;
    let holes = map.heights_um().values().iter();
    let holes = holes.map(|height| f64::from(u8::from(height.is_nan())));
    let holes = Grid::from_rows(map.heights_um().width(), holes.collect());
    let holes = holes.ok_or(SurfaceError::AllMissing)?;
    let missing = pooled(&holes, map.size_mm());
    let pixels = pooled(map.filled().heights_um(), map.size_mm());
    let (width, height) = (pixels.width(), pixels.height());
    let slope = |row: usize, column: usize| {
        let at = |row: usize, column: usize| pixels.row(row.min(height - 1))[column.min(width - 1)];
        at(row, column + 1) - at(row, column.saturating_sub(1)) + at(row.saturating_sub(1), column)
            - at(row + 1, column)
    };
    let places = (0..height).rev();
    let places = places.flat_map(|row| (0..width).map(move |column| (row, column)));
    let lit: Vec<Option<f64>> = places
        .map(|(row, column)| (missing.row(row)[column] < 0.5).then(|| slope(row, column)))
        .collect();
    let n_lit = lit.iter().flatten().count().max(1) as f64;
    let rms = (lit.iter().flatten().map(|s| s * s).sum::<f64>() / n_lit).sqrt();
    Ok(Rgb8Image {
        width,
        height,
        pixels: lit.into_iter().map(|slope| grey(slope, rms)).collect(),
    })
}

/// The grey of a slope; `None`: missing.
fn grey(slope: Option<f64>, rms: f64) -> [u8; 3] {
    let Some(slope) = slope else {
        return [MISSING_GREY; 3];
    };
    let lit = if rms > 0.0 { slope / rms } else { 0.0 };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within a byte"
    )]
    let grey = (LEVEL_GREY + SLOPE_GREY * lit).clamp(0.0, 255.0) as u8;
    [grey; 3]
}

/// Means over the pixels of a picture with 10 pixels a mm.
fn pooled(values: &Grid<f64>, size_mm: [f64; 2]) -> Grid<f64> {
    let n_points = [values.width(), values.height()];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "1 to 2000"
    )]
    let n_pixels = size_mm.map(|mm| (mm * PX_PER_MM).round().clamp(1.0, MOST_PIXELS) as usize);
    let [width, height] = n_pixels;
    let span = |pixel: usize, axis: usize| {
        let first = pixel * n_points[axis] / n_pixels[axis];
        let end = (pixel + 1) * n_points[axis] / n_pixels[axis];
        first..end.max(first + 1)
    };
    let mut pixels = Grid::filled(width, height, 0.0);
    for row in 0..height {
        for column in 0..width {
            let rows = span(row, 1);
            let n = (rows.len() * span(column, 0).len()) as f64;
            let sums = rows.map(|r| values.row(r)[span(column, 0)].iter().sum::<f64>());
            pixels.row_mut(row)[column] = sums.sum::<f64>() / n;
        }
    }
    pixels
}
