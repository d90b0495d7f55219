//! The kind `picture`: heights that were found on a picture, kept as a map of one repeat beside
//! the manifest, with what they were found by.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::heightmap::Heightmap;
use crate::error::TextileError;
use crate::metrology::{HeightOptions, Measured};
use crate::picture::shading::{Light, Method};
use crate::picture::{Basis, PictureScale, TurnedPicture, synthesized};
use crate::recipe::{Checker, HeightsFile, KeySpec, Recipe, defaults, keys};
use crate::surface::{HeightMap, Probe, ProfileSet, Representation};
use selvedge_foundation::files::FileError;
use selvedge_foundation::numerics::{Random, to_index};

keys! {
    /// Heights found on a picture (`kind = "picture"`).
    source PictureSource {
        /// Whether it is felt along four strokes or at every point of its relief.
        #[serde(default, skip_serializing_if = "Representation::is_default")]
        pub(crate) representation: Representation,
        /// The map of one repeat: a file of heights that states its scale, a 16-bit PNG as this
        /// program writes it. It lies beside the manifest unless the profile files are named and
        /// felt.
        pub(crate) file: String,
        /// SHA-256 of the map; another file is refused.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) sha256: Option<String>,
        /// The picture that the heights were found on; it need not be there.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) picture: Option<String>,
        /// SHA-256 of that picture.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) picture_sha256: Option<String>,
        pub(crate) px_per_mm: f64
            => "Scale" 2.0 ..= 2000.0 "px/mm" "The picture's scale",
        /// How that is known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub(crate) scale: Option<PictureScale>,
        /// The two vectors by which the pattern repeats, px, x to the right and y up.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) lattice_px: Option<[[f64; 2]; 2]>,
        /// How the heights were found.
        pub(crate) method: Method,
        pub(crate) iterations: u32
            => "Iterations" 1.0 ..= 10_000.0 "" "Iterations of that method",
        pub(crate) slant_deg: f64
            => "Slant" 0.0 ..= 85.0 "°" "Where the light came from: its angle to the vertical",
        pub(crate) tilt_deg: f64
            => "Tilt" -360.0 ..= 360.0 "°" "Where the light came from: its angle in the plane",
        /// Whether the light was estimated from the picture.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub(crate) light_is_estimated: bool,
        pub relief_um: f64
            => "Relief" 1e-6 ..= 1e5 "µm" "From the lowest to the highest height",
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) smd_um: Option<f64>
            => "Roughness SMD" 1e-6 ..= 1e4 "µm"
            "What the heights were scaled to; the relief was given if not stated",
        /// Where the strokes cross, mm from the lower left corner; the middle if not stated.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) place_mm: Option<[f64; 2]>,
        #[serde(default = "default_noise")]
        pub(crate) noise_um: f64
            => "Noise of the probe" 0.0 ..= 10.0 "µm" "Noise of the virtual tester, rms",
        /// Chooses that noise.
        #[serde(default = "default_seed")]
        pub(crate) seed: u32,
        /// The cloth that is made of the map and felt in its place; the map over and over if none
        /// is stated.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub(crate) synthesis: Option<Synthesis>,
        /// Further pictures of the cloth that the heights were found on, turned.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub(crate) turned: Vec<TurnedPicture>,
    }
}

/// Cloth that is synthesized of a map: its mean cell over and over, and what varies from cell to
/// cell drawn anew.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Synthesis {
    /// Its extent along u and w, mm; somewhat more, so that cells fit.
    pub(crate) size_mm: [f64; 2],
    /// The two vectors by which the pattern of the map repeats, mm along u and w; none of a
    /// pattern without a repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) cell_mm: Option<[[f64; 2]; 2]>,
    /// Chooses what is drawn.
    pub(crate) seed: u32,
}

impl Synthesis {
    /// Puts the cloth in the place of a map.
    pub(crate) fn extend(self, measured: &mut Measured, path: &Path) -> Result<(), TextileError> {
        let step_mm = measured.step_mm;
        let n = [0, 1].map(|axis| to_index((self.size_mm[axis] / step_mm[axis]).round()).max(1));
        if n[0].saturating_mul(n[1]) > MAX_SYNTHESIZED {
            let what = format!(
                "{} × {} mm of synthesized cloth are {} × {} points, more than 16 million",
                self.size_mm[0], self.size_mm[1], n[0], n[1]
            );
            let mend = "give less as size_mm (--extent-mm)";
            return Err(FileError::whole(path, what, mend).into());
        }
        let map = HeightMap::new(measured.heights_um.clone(), step_mm);
        let map = map.map_err(TextileError::surface(path))?.filled();
        let points = |[u, w]: [f64; 2]| [u / step_mm[0], w / step_mm[1]];
        let cell = self.cell_mm.map(|[a, b]| Basis::new(points(a), points(b)));
        let mut random = Random::new(u64::from(self.seed)).branch("synthesis");
        measured.heights_um = synthesized(map.heights_um(), cell, n, &mut random);
        Ok(())
    }
}

/// Points of synthesized cloth at most.
const MAX_SYNTHESIZED: usize = 1 << 24;

defaults! {
    default_noise: f64 = Probe::default().noise_um;
    default_seed: u32 = 1;
}

impl PictureSource {
    /// The light that it was found under.
    pub fn light(&self) -> Light {
        Light {
            slant_deg: self.slant_deg,
            tilt_deg: self.tilt_deg,
        }
    }

    fn check_places(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let within = |key, value, range| checker.within("source", key, value, range);
        let stated = self.scale.and_then(PictureScale::stated_px_per_mm);
        if let Some(stated) = stated.filter(|px| (px / self.px_per_mm - 1.0).abs() >= 1e-6) {
            let what = format!("scale comes to {stated} px/mm, px_per_mm says otherwise");
            return Err(checker.wrong("source", "px_per_mm", what, "make both agree"));
        }
        for place in self.place_mm.into_iter().flatten() {
            within("place_mm", place, 0.0..=10_000.0)?;
        }
        for mm in self.synthesis.iter().flat_map(|all| all.size_mm) {
            within("size_mm", mm, 1.0..=1000.0)?;
        }
        for one in &self.turned {
            within("turn_deg", one.turn_deg, -360.0..=360.0)?;
            within("score", one.score, 0.0..=1.0)?;
        }
        let cell_mm = self.synthesis.and_then(|all| all.cell_mm);
        for (key, vectors, least) in [
            ("lattice_px", self.lattice_px, 1.0),
            ("cell_mm", cell_mm, 1e-6),
        ] {
            let Some([a, b]) = vectors else { continue };
            for length in [a, b].into_iter().flatten() {
                within(key, length, -1e5..=1e5)?;
            }
            if (a[0] * b[1] - a[1] * b[0]).abs() < least {
                let what = format!("the two vectors of {key} are parallel");
                return Err(checker.wrong("source", key, what, "give two that span a repeat"));
            }
        }
        Ok(())
    }

    /// What is felt: the map as its file has it, or cloth that is synthesized of it.
    pub(crate) fn open(&self, bytes: &[u8], path: &Path) -> Result<Measured, TextileError> {
        let mut measured = self.map().open(bytes, path)?;
        if let Some(synthesis) = self.synthesis {
            synthesis.extend(&mut measured, path)?;
        }
        Ok(measured)
    }

    /// Its map as a file of heights that repeats: what reads and strokes it.
    pub(crate) fn map(&self) -> Heightmap {
        let mut map = Heightmap::new(self.file.clone(), &HeightOptions::default());
        map.sha256.clone_from(&self.sha256);
        map.representation = self.representation;
        map.place_mm = self.place_mm;
        map.periodic = true;
        map.noise_um = self.noise_um;
        map.seed = self.seed;
        map
    }
}

impl Recipe for PictureSource {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        self.check_places(checker)?;
        checker.file_name("source", "file", Some(&self.file))
    }

    fn representation(&self) -> Representation {
        self.representation
    }

    fn heights_file(&self) -> Option<Box<dyn HeightsFile>> {
        Some(Box::new(self.clone()))
    }
}

impl HeightsFile for PictureSource {
    fn name(&self) -> &str {
        &self.file
    }

    fn height_map(&self, bytes: &[u8], path: &Path) -> Result<HeightMap, TextileError> {
        self.map().level(&self.open(bytes, path)?, path)
    }

    fn profiles(&self, bytes: &[u8], path: &Path) -> Result<ProfileSet, TextileError> {
        self.map().strokes(&self.open(bytes, path)?, path)
    }
}
