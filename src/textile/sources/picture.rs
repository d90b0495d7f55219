//! The kind `picture`: heights that were found on a picture, kept as a map of one repeat beside
//! the manifest, with what they were found by.

use super::heightmap::Heightmap;
use crate::error::TextileError;
use crate::metrology::HeightOptions;
use crate::picture::PictureScale;
use crate::picture::shading::{Light, Method};
use crate::recipe::{Checker, HeightsFile, KeySpec, Recipe, defaults, keys};
use crate::surface::{Probe, Representation};

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
    }
}

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

    /// Its map as a file of heights that repeats: what reads and strokes it.
    pub fn map(&self) -> Heightmap {
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
        Some(Box::new(self.map()))
    }
}
