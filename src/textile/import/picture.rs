//! A textile of a shape that was found on a picture: the map of one repeat, four strokes of the
//! virtual tester over it, a picture, and a manifest that says how it was found.

use std::cell::OnceCell;
use std::path::Path;

use super::description::manifest_file;
use super::height_scale::{HeightScale, ScaledRelief, no_surface};
use super::profile_files::{coloured, profile_files, shaded};
use crate::build::{BuiltFile, PICTURE};
use crate::error::TextileError;
use crate::manifest::{AppearanceKeys, Construction, MANIFEST, Manifest, Provenance, Uncertainty};
use crate::metrology::{self, Measured};
use crate::picture::brightness::Brightness;
use crate::picture::shading::{ShadingError, Shape};
use crate::picture::{PictureScale, Tile, TurnedPicture};
use crate::recipe::{ProfileFiles, SourceKeys as _, source};
use crate::sources::Source;
use crate::sources::picture::{PictureSource, Synthesis};
use crate::surface::{Direction, HeightMap, Probe, ProfileSet, Representation, Surface};
use crate::tactile::{Filters, Levels};
use crate::yarns::PX_PER_MM;
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_foundation::quantity::level_db;

/// The name of the map in the textile's folder.
const MAP: &str = "heights.png";
/// Where levels of a relief are taken, shares of its size.
const PLACES: [f64; 3] = [0.2, 0.5, 0.8];

/// What a textile of a picture is called and was made of.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PictureTextile {
    /// What people call it.
    pub name: String,
    /// How the textile is made.
    pub construction: Construction,
    /// The picture's scale, 2 to 2000.
    pub px_per_mm: f64,
    /// How that is known.
    pub px_scale: Option<PictureScale>,
    /// Extent of the tile, px of the picture, where a sample of the shape is not quite a pixel.
    pub size_px: Option<[f64; 2]>,
    /// What is known of its height.
    pub scale: HeightScale,
    /// File name and SHA-256 of the picture.
    pub picture: Option<[String; 2]>,
    /// Further pictures of the cloth, turned.
    pub turned: Vec<TurnedPicture>,
    /// Red, green and blue of what was cut from the picture, 0…1, row 0 the lowest y: what the
    /// textile looks like; `None`: its relief, lit.
    pub colours: Option<[Grid<f64>; 3]>,
    /// The vectors by which its pattern repeats, px, x to the right and y up.
    pub lattice_px: Option<[[f64; 2]; 2]>,
    /// The extent of cloth that is synthesized of the shape and felt in its place, mm; `None`: the
    /// shape over and over.
    pub extent_mm: Option<f64>,
    /// Whether the light was estimated.
    pub light_is_estimated: bool,
    /// How far levels may be off: see [`Uncertainty::levels`].
    pub levels: Vec<[f64; 4]>,
    /// Whether it is felt along four strokes or at every point.
    pub representation: Representation,
}

impl PictureTextile {
    /// How much cloth is synthesized unless stated, mm each way.
    pub const EXTENT_MM: f64 = 60.0;

    /// The distance of a shape's samples, mm.
    pub(super) fn step_mm(&self, n: [usize; 2]) -> [f64; 2] {
        let n = n.map(|n| n as f64);
        let size_px = self.size_px.unwrap_or(n);
        [0, 1].map(|axis| size_px[axis] / n[axis] / self.px_per_mm)
    }
}

/// A textile of a picture before it is written.
#[derive(Debug, Clone)]
pub struct MadeOfPicture {
    /// Its files, the manifest last: `heights.png`, four profiles, the picture.
    pub files: Vec<BuiltFile>,
    /// What is felt: the map over and over, or cloth that is synthesized of it.
    pub map: HeightMap,
    /// From the lowest to the highest height of the map, µm.
    pub relief_um: f64,
    /// What the tester records, by [`Direction::index`].
    pub profiles: ProfileSet,
}

/// The textile of a shape: x becomes u (the warp), y becomes w (the weft).
///
/// # Errors
/// Heights without a scale; a flat shape; less than 2 × 2 px; a scale out of range; an SMD that
/// the tester never reads on it.
pub(crate) fn to_textile(
    shape: &Shape,
    about: &PictureTextile,
    synthesis: Option<Synthesis>,
) -> Result<MadeOfPicture, TextileError> {
    let path = Path::new(MAP);
    let mut keys = keys(shape, about);
    keys.synthesis = synthesis;
    let scaled = heights(shape, about, &keys)?;
    (keys.relief_um, keys.smd_um) = (rounded(scaled.relief_um), scaled.smd_um);
    let bytes = metrology::write(&measured(&scaled.map, &about.name), path)?;
    keys.sha256 = Some(sha256_hex([bytes.as_slice()]));
    let size_mm = scaled.map.size_mm();
    let image = about.colours.as_ref().map(|all| coloured(all, size_mm));
    let image = image.map(|image| image.to_small_png(Path::new(PICTURE)));
    drawn((bytes, image.transpose()?), keys, path, |keys| {
        manifest(about, keys)
    })
}

/// The files of a textile made again of its map, as its manifest says; it looks as it did.
pub(super) fn again(
    manifest: &Manifest,
    keys: &PictureSource,
    (bytes, path): (Vec<u8>, &Path),
    image: Option<Vec<u8>>,
) -> Result<Vec<BuiltFile>, TextileError> {
    let made = drawn((bytes, image), keys.clone(), path, |keys| Manifest {
        source: Source::Picture(Box::new(keys)),
        ..manifest.clone()
    })?;
    Ok(made.files)
}

/// Map, strokes over the map as the file has it, and picture, with their manifest.
fn drawn(
    (bytes, image): (Vec<u8>, Option<Vec<u8>>),
    mut keys: PictureSource,
    path: &Path,
    manifest: impl FnOnce(PictureSource) -> Manifest,
) -> Result<MadeOfPicture, TextileError> {
    let kept = keys.open(&bytes, path)?;
    let map = keys.map().level(&kept, path)?;
    let profiles = keys.map().strokes(&kept, path)?;
    let mut files = vec![BuiltFile::new(&keys.file, bytes)];
    files.extend(profile_files(&profiles)?);
    let image = if let Some(image) = image {
        image
    } else {
        let relief = shaded(&kept).map_err(no_surface)?;
        relief.to_small_png(Path::new(PICTURE))?
    };
    files.push(BuiltFile::new(PICTURE, image));
    let hash = Source::Picture(Box::new(keys.clone())).recipe_hash(path)?;
    keys.set_files(ProfileFiles::all(), Some(hash));
    let relief_um = keys.relief_um;
    files.push(manifest_file(&manifest(keys), Path::new(MANIFEST))?);
    Ok(MadeOfPicture {
        files,
        map,
        relief_um,
        profiles,
    })
}

impl PictureTextile {
    /// The textile of that shape; size and lattice are taken from what it was cut from.
    ///
    /// # Errors
    /// See [`to_textile`].
    pub fn files_of(
        shape: &Shape,
        brightness: &Brightness,
        tile: Option<&Tile>,
        about: &Self,
    ) -> Result<MadeOfPicture, TextileError> {
        let y_up = |[x, y]: [f64; 2]| [x, -y];
        let about = Self {
            size_px: Some(brightness.size_px),
            lattice_px: tile.map(|tile| [tile.p1_px, tile.p2_px].map(y_up)),
            ..about.clone()
        };
        // On the map: along its rows, which are turned in the picture, and up.
        let (s, c) = brightness.angle_rad.sin_cos();
        let on_map =
            |[x, y]: [f64; 2]| [x * c + y * s, x * s - y * c].map(|px| px / about.px_per_mm);
        let synthesis = about.extent_mm.map(|mm| Synthesis {
            size_mm: [mm; 2],
            cell_mm: tile.map(|tile| [tile.p1_px, tile.p2_px].map(on_map)),
            seed: 1,
        });
        to_textile(shape, &about, synthesis)
    }

    /// From the lowest to the highest height of the textile that would be made, µm.
    ///
    /// # Errors
    /// See [`to_textile`].
    pub fn relief_um_of(shape: &Shape, about: &Self) -> Result<f64, TextileError> {
        Ok(heights(shape, about, &keys(shape, about))?.relief_um)
    }
}

impl PictureTextile {
    /// What is felt of a shape as a textile: levels of warp and weft by band, dB re 1 µm, under a
    /// wire as wide as a contactor at a few places.
    pub(crate) fn levels_db(&self, shape: &Shape) -> Result<[[f64; 2]; 2], TextileError> {
        let map = heights(shape, self, &keys(shape, self))?.map;
        let mut means_um = [[0.0; 2]; 2];
        for place in PLACES {
            let middle_mm = map.size_mm().map(|mm| place * mm);
            let profiles = map.strokes(&Probe::contactor(), middle_mm, &Random::new(0));
            let surface = profiles.and_then(|mut profiles| {
                for [_, reverse] in Direction::BY_AXIS {
                    profiles[reverse.index()] = None;
                }
                Surface::from_profiles(profiles, 0.0)
            });
            let surface = surface.map_err(|(_, source)| no_surface(source))?;
            let by_direction = Levels::of(&surface, &Filters::default()).direction_mean_um;
            for (means, [forward, _]) in means_um.iter_mut().zip(Direction::BY_AXIS) {
                for (mean, um) in means.iter_mut().zip(by_direction[forward.index()]) {
                    *mean += um / PLACES.len() as f64;
                }
            }
        }
        Ok(means_um.map(|of_bands| of_bands.map(level_db)))
    }
}

/// The shape in µm, by what the tester reads on what is felt of it.
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
    // What is synthesized of a map is as high as the map: it is drawn once.
    let extended = OnceCell::<(f64, Measured)>::new();
    let drawn = |map: &HeightMap, relief_um: f64| {
        let mut drawn = measured(map, &about.name);
        if let Some(synthesis) = keys.synthesis {
            if extended.get().is_none() {
                synthesis.extend(&mut drawn, Path::new(MAP))?;
            }
            let (first_um, first) = extended.get_or_init(|| (relief_um, drawn.clone()));
            let factor = relief_um / first_um;
            drawn.heights_um = first.heights_um.map(|um| um * factor);
        }
        keys.map().strokes(&drawn, Path::new(MAP))
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
        scale: about.px_scale,
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
        synthesis: None,
        turned: about.turned.clone(),
    })
}

/// Only an SMD that was given was measured on the cloth; what the relief reads is not.
fn manifest(about: &PictureTextile, keys: PictureSource) -> Manifest {
    let appearance = AppearanceKeys {
        image: PICTURE.to_owned(),
        px_per_mm: PX_PER_MM,
    };
    let measured = keys.smd_um.map(|um| ("smd_um".to_owned(), um));
    let uncertainty = Uncertainty {
        levels: about.levels.clone(),
        ..Uncertainty::default()
    };
    Manifest {
        construction: about.construction,
        notes: format!("heights from a picture ({})", keys.method.label()),
        appearance: Some(appearance),
        measured: measured.into_iter().collect(),
        uncertainty: Some(uncertainty).filter(|all| !all.levels.is_empty()),
        provenance: Some(Provenance::of(Vec::new())),
        ..Manifest::new(&about.name, Source::Picture(Box::new(keys)))
    }
}
