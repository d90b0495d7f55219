//! The kind `picture`: heights that were found on a picture, kept as a map of one repeat beside
//! the manifest, with what they were found by.

use serde::{Deserialize, Serialize};

use super::{Light, Method};
use crate::TextileError;
use crate::manifest::{Checker, ProfileFiles, profile_file_keys};
use crate::metrology::{Asked, Heightmap};
use crate::surface::{Probe, Representation};

/// Heights found on a picture (`kind = "picture"`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureSource {
    /// Always `picture`.
    pub kind: String,
    /// Hash of the recipe that the profiles came from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recipe_hash: Option<String>,
    /// See [`crate::ProfileFiles`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warp_forward: Option<String>,
    /// See [`crate::ProfileFiles`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warp_reverse: Option<String>,
    /// See [`crate::ProfileFiles`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weft_forward: Option<String>,
    /// See [`crate::ProfileFiles`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weft_reverse: Option<String>,
    /// Whether it is felt along four strokes or at every point of its relief.
    #[serde(default, skip_serializing_if = "Representation::is_default")]
    pub representation: Representation,
    /// The map of one repeat: a file of heights that states its scale, a 16-bit PNG as this
    /// program writes it. It lies beside the manifest unless the profile files are named and felt.
    pub file: String,
    /// SHA-256 of the map; another file is refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// The picture that the heights were found on; it need not be there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
    /// SHA-256 of that picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture_sha256: Option<String>,
    /// The picture's scale.
    pub px_per_mm: f64,
    /// The two vectors by which the pattern repeats, px, x to the right and y up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lattice_px: Option<[[f64; 2]; 2]>,
    /// How the heights were found.
    pub method: Method,
    /// Iterations of that method.
    pub iterations: u32,
    /// Where the light came from: see [`Light`].
    pub slant_deg: f64,
    /// See [`Light`].
    pub tilt_deg: f64,
    /// Whether the light was estimated from the picture.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub light_is_estimated: bool,
    /// From the lowest to the highest height, µm.
    pub relief_um: f64,
    /// The roughness SMD that the heights were scaled to, µm; the relief was given if not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smd_um: Option<f64>,
    /// Where the strokes cross, mm from the lower left corner; the middle if not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place_mm: Option<[f64; 2]>,
    /// Noise of the virtual tester, µm rms.
    #[serde(default = "default_noise")]
    pub noise_um: f64,
    /// Chooses that noise.
    #[serde(default = "default_seed")]
    pub seed: u32,
}

fn default_noise() -> f64 {
    Probe::default().noise_um
}

fn default_seed() -> u32 {
    1
}

profile_file_keys!(PictureSource);

impl PictureSource {
    /// Refuses values out of range.
    pub fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let within = |key, value, range| checker.within("source", key, value, range);
        within("px_per_mm", self.px_per_mm, 2.0..=2000.0)?;
        within("relief_um", self.relief_um, 1e-6..=1e5)?;
        within("noise_um", self.noise_um, 0.0..=10.0)?;
        within("slant_deg", self.slant_deg, 0.0..=85.0)?;
        within("tilt_deg", self.tilt_deg, -360.0..=360.0)?;
        within("iterations", f64::from(self.iterations), 1.0..=10_000.0)?;
        if let Some(smd_um) = self.smd_um {
            within("smd_um", smd_um, 1e-6..=1e4)?;
        }
        for place in self.place_mm.into_iter().flatten() {
            within("place_mm", place, 0.0..=10_000.0)?;
        }
        let Some([a, b]) = self.lattice_px else {
            return Ok(());
        };
        for px in [a, b].into_iter().flatten() {
            within("lattice_px", px, -1e5..=1e5)?;
        }
        let area_px = (a[0] * b[1] - a[1] * b[0]).abs();
        if area_px >= 1.0 {
            return Ok(());
        }
        let what = "the two vectors of lattice_px are parallel";
        Err(checker.wrong("source", "lattice_px", what, "give two that span a repeat"))
    }

    /// The light that it was found under.
    pub fn light(&self) -> Light {
        Light {
            slant_deg: self.slant_deg,
            tilt_deg: self.tilt_deg,
        }
    }

    /// Its map as a file of heights that repeats: what reads and strokes it.
    pub fn map(&self) -> Heightmap {
        let mut map = Heightmap::new(self.file.clone(), &Asked::default());
        map.sha256.clone_from(&self.sha256);
        map.representation = self.representation;
        map.place_mm = self.place_mm;
        map.periodic = true;
        map.noise_um = self.noise_um;
        map.seed = self.seed;
        map
    }

    /// The profile files that a textile built of it has.
    pub(super) fn all_files() -> ProfileFiles {
        let name = |direction: crate::surface::Direction| format!("{}.csv", direction.key());
        ProfileFiles(crate::surface::Direction::ALL.map(|direction| Some(name(direction))))
    }
}
