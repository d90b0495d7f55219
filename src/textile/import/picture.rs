//! A textile of a shape that was found on a picture: the map of one repeat, four strokes of the
//! virtual tester over it, a picture, and a manifest that says how it was found.

use std::path::Path;

use super::description::manifest_file;
use super::height_scale::{HeightScale, ScaledRelief, no_surface};
use super::profile_files::{profile_files, shaded};
use crate::build::{BuiltFile, PICTURE};
use crate::error::TextileError;
use crate::manifest::{AppearanceKeys, Construction, MANIFEST, Manifest, Provenance};
use crate::metrology::{self, HeightOptions, Measured};
use crate::picture::Tile;
use crate::picture::brightness::Brightness;
use crate::picture::shading::{ShadingError, Shape};
use crate::recipe::{ProfileFiles, SourceKeys as _, source};
use crate::sources::Source;
use crate::sources::picture::PictureSource;
use crate::surface::{HeightMap, Probe, Representation, smd_um};
use crate::yarns::PX_PER_MM;
use selvedge_foundation::files::sha256_hex;

/// The name of the map in the textile's folder.
const MAP: &str = "heights.png";

/// What a textile of a picture is called and was made of.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PictureTextile {
    /// What people call it.
    pub name: String,
    /// How the textile is made.
    pub construction: Construction,
    /// The picture's scale, 2 to 2000.
    pub px_per_mm: f64,
    /// Extent of the tile, px of the picture, where a sample of the shape is not quite a pixel.
    pub size_px: Option<[f64; 2]>,
    /// What is known of its height.
    pub scale: HeightScale,
    /// File name and SHA-256 of the picture.
    pub picture: Option<[String; 2]>,
    /// The vectors by which its pattern repeats, px, x to the right and y up.
    pub lattice_px: Option<[[f64; 2]; 2]>,
    /// Whether the light was estimated.
    pub light_is_estimated: bool,
    /// Whether it is felt along four strokes or at every point.
    pub representation: Representation,
}

impl PictureTextile {
    /// The distance of a shape's samples, mm.
    fn step_mm(&self, n: [usize; 2]) -> [f64; 2] {
        let n = n.map(|n| n as f64);
        let size_px = self.size_px.unwrap_or(n);
        [0, 1].map(|axis| size_px[axis] / n[axis] / self.px_per_mm)
    }
}

/// The files of a textile, its manifest last: `heights.png`, four profiles, the picture. x of the
/// shape becomes u (the warp), y becomes w (the weft).
///
/// # Errors
/// Heights without a scale; a flat shape; less than 2 × 2 px; a scale out of range; an SMD that
/// the tester never reads on it.
pub(crate) fn to_textile(
    shape: &Shape,
    about: &PictureTextile,
) -> Result<Vec<BuiltFile>, TextileError> {
    let path = Path::new(MAP);
    let mut keys = keys(shape, about);
    let scaled = heights(shape, about, &keys)?;
    (keys.relief_um, keys.smd_um) = (rounded(scaled.relief_um), scaled.smd_um);
    let bytes = metrology::write(&measured(&scaled.map, &about.name), path)?;
    keys.sha256 = Some(sha256_hex([bytes.as_slice()]));
    // Strokes are drawn over the map as the file has it.
    let kept = Measured::open(&bytes, path, &HeightOptions::default())?;
    let profiles = keys.map().strokes(&kept, path)?;
    let mut files = vec![BuiltFile::new(MAP, bytes)];
    files.extend(profile_files(&profiles)?);
    let image = shaded(&kept).map_err(no_surface)?;
    let bytes = image.to_small_png(Path::new(PICTURE))?;
    files.push(BuiltFile::new(PICTURE, bytes));
    let hash = Source::Picture(Box::new(keys.clone())).recipe_hash(path)?;
    keys.set_files(ProfileFiles::all(), Some(hash));
    let figures = [("smd_um", smd_um(&profiles)), ("sq_um", kept.sq_um())];
    let manifest = manifest(about, keys, figures);
    files.push(manifest_file(&manifest, Path::new(MANIFEST))?);
    Ok(files)
}

impl PictureTextile {
    /// The files of a textile of that shape; size and lattice are taken from what it was cut from.
    ///
    /// # Errors
    /// See [`to_textile`].
    pub fn files_of(
        shape: &Shape,
        brightness: &Brightness,
        tile: &Tile,
        about: &Self,
    ) -> Result<Vec<BuiltFile>, TextileError> {
        let y_up = |[x, y]: [f64; 2]| [x, -y];
        let about = Self {
            size_px: Some(brightness.size_px),
            lattice_px: Some([y_up(tile.p1_px), y_up(tile.p2_px)]),
            ..about.clone()
        };
        to_textile(shape, &about)
    }

    /// From the lowest to the highest height of the textile that would be made, µm.
    ///
    /// # Errors
    /// See [`to_textile`].
    pub fn relief_um_of(shape: &Shape, about: &Self) -> Result<f64, TextileError> {
        Ok(heights(shape, about, &keys(shape, about))?.relief_um)
    }
}

/// The shape in µm.
fn heights(
    shape: &Shape,
    about: &PictureTextile,
    keys: &PictureSource,
) -> Result<ScaledRelief, TextileError> {
    let (width, height) = (shape.height_px.width(), shape.height_px.height());
    if width < 2 || height < 2 {
        return Err(ShadingError::TooSmall { width, height }.into());
    }
    if !(2.0..=2000.0).contains(&about.px_per_mm) {
        return Err(ShadingError::Option {
            key: "the picture's scale",
            value: about.px_per_mm,
            range: "2 to 2000 px/mm (51 to 50800 dpi)",
        }
        .into());
    }
    let drawn = |map: &HeightMap| {
        let measured = measured(map, &about.name);
        keys.map().strokes(&measured, Path::new(MAP))
    };
    let step_mm = about.step_mm([width, height]);
    ScaledRelief::of(shape, step_mm, about.scale, &drawn)
}

fn rounded(um: f64) -> f64 {
    (um * 1e3).round() / 1e3
}

fn measured(map: &HeightMap, title: &str) -> Measured {
    Measured {
        heights_um: map.heights_um().clone(),
        step_mm: map.step_mm(),
        about: metrology::About {
            title: title.to_owned(),
            ..metrology::About::default()
        },
        warnings: Vec::new(),
        layers: Vec::new(),
    }
}

fn keys(shape: &Shape, about: &PictureTextile) -> PictureSource {
    let [picture, picture_sha256] = match &about.picture {
        Some([name, sha256]) => [Some(name.clone()), Some(sha256.clone())],
        None => [None, None],
    };
    source!(PictureSource = "picture" {
        representation: about.representation,
        file: MAP.to_owned(),
        sha256: None,
        picture,
        picture_sha256,
        px_per_mm: about.px_per_mm,
        lattice_px: about.lattice_px,
        method: shape.method,
        iterations: u32::try_from(shape.n_iterations()).unwrap_or(u32::MAX),
        slant_deg: shape.light.slant_deg,
        tilt_deg: shape.light.tilt_deg,
        light_is_estimated: about.light_is_estimated,
        relief_um: 0.0,
        smd_um: None,
        place_mm: None,
        noise_um: Probe::default().noise_um,
        seed: 1,
    })
}

fn manifest(about: &PictureTextile, keys: PictureSource, figures: [(&str, f64); 2]) -> Manifest {
    let appearance = AppearanceKeys {
        image: PICTURE.to_owned(),
        px_per_mm: PX_PER_MM,
    };
    let figures = figures.map(|(key, um)| (key.to_owned(), rounded(um)));
    Manifest {
        construction: about.construction,
        notes: format!("heights from a picture ({})", keys.method.label()),
        appearance: Some(appearance),
        measured: figures.into_iter().collect(),
        provenance: Some(Provenance::of(Vec::new())),
        ..Manifest::new(&about.name, Source::Picture(Box::new(keys)))
    }
}
