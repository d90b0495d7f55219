//! Woven textile: two sets of yarns that pass over and under one another.
//!
//! Every end and pick is a tube of its own section that runs over and under by the interlacing
//! matrix, as Peirce (1937) drew it: at a crossing both centres stand apart by half the sum of the
//! two thicknesses there, warp and weft sharing that rise by the crimp balance; in between the
//! path is a cosine, over a float it runs level or bulges. Thick places lift what crosses them,
//! tension shifts the crimp between warp and weft from place to place, picks bow.
//!
//! It knows nothing of probes, spectra or files.

mod crossing;
mod interlacing;

pub(crate) use interlacing::Interlacing;
use interlacing::NAMES;

use crate::error::TextileError;
use crate::recipe::{
    Checker, Example, Group, KeySpec, Model, Recipe, Side, defaults, keys, parameters_of,
};
use crate::surface::Representation;
use crate::yarns::{Yarn, YarnGeometry, add_hairs, model, touch_group, turn_over, usual};
use selvedge_foundation::numerics::Random;

keys! {
    /// The recipe of a woven textile (`kind = "weave"`).
    source Weave {
        /// Whether it is felt along four strokes or at every point of its relief.
        #[serde(default, skip_serializing_if = "Representation::is_default")]
        pub(crate) representation: Representation,
        /// Which side of the textile is touched.
        #[serde(default, skip_serializing_if = "Side::is_face")]
        pub(crate) side: Side,
        /// Chooses the irregularities.
        pub seed: u32,
        pub(crate) interlacing: Interlacing
            => "Interlacing": "Which yarn lies on top at every crossing",
        pub(crate) warp_per_cm: f64
            => "Ends" 2.0 ..= 100.0 "/cm" "Ends per centimetre",
        pub weft_per_cm: f64
            => "Picks" 2.0 ..= 100.0 "/cm" "Picks per centimetre",
        #[serde(default = "half")]
        pub(crate) crimp_share: f64
            => "Crimp of the warp" 0.0 ..= 1.0 "" "Share of the crimp that the warp takes",
        #[serde(default = "default_compaction")]
        pub(crate) compaction: f64
            => "Compaction" 0.1 ..= 1.2 ""
            "How far apart crossing yarns stand, as a share of half the sum of their thicknesses",
        #[serde(default)]
        pub(crate) float_lift_um: f64
            => "Lift of floats" 0.0 ..= 500.0 "µm"
            "How far a float bulges for every crossing that it passes",
        #[serde(default = "usual::tension_drift")]
        pub(crate) tension_drift: f64
            => "Tension drift" 0.0 ..= 0.5 ""
            "Standard deviation of the crimp share from place to place",
        #[serde(default = "usual::drift_mm")]
        pub(crate) drift_mm: f64
            => "Drift length" 1.0 ..= 10.0 "mm" "Over what length tension and bow change",
        #[serde(default = "usual::pitch_cv")]
        pub(crate) pitch_cv: f64
            => "Uneven pitch" 0.0 ..= 0.3 ""
            "Standard deviation of the places of yarns, share of their pitch",
        #[serde(default)]
        pub(crate) bow_um: f64
            => "Bow" 0.0 ..= 2000.0 "µm" "Standard deviation of the bow of a yarn",
        #[serde(default)]
        pub(crate) pucker_um: f64
            => "Pucker" 0.0 ..= 500.0 "µm" "Out-of-plane puckering by lively twist, rms",
        #[serde(default = "usual::pucker_mm")]
        pub(crate) pucker_mm: f64
            => "Size of puckers" 0.5 ..= 10.0 "mm" "Size of the puckers",
        #[serde(default = "usual::noise_um")]
        pub(crate) noise_um: f64
            => "Noise of the probe" 0.0 ..= 10.0 "µm" "Noise of the probe, rms",
        /// The warp yarn.
        pub(crate) warp: Yarn,
        /// The weft yarn.
        pub(crate) weft: Yarn,
    }
}

defaults! {
    half: f64 = 0.5;
    default_compaction: f64 = 0.9;
}

impl Weave {
    /// The interlacings known by name, with their rows.
    pub const INTERLACINGS: [(&str, &[&str]); 15] = NAMES;

    /// The textile. Empty if the interlacing is none: [`Weave::check`] refuses that.
    pub(crate) fn yarn_geometry(&self) -> YarnGeometry {
        let random = Random::new(u64::from(self.seed));
        let thickness = self.warp.thickness_um + self.weft.thickness_um;
        let floor_um = -thickness;
        let Ok(repeat) = self.interlacing.repeat() else {
            return YarnGeometry {
                size_mm: [1.0; 2],
                paths: Vec::new(),
                floor_um,
            };
        };
        let (size_mm, mut ends, mut picks) = crossing::paths(self, &repeat, &random);
        let hairs = match self.side {
            Side::Face => random,
            Side::Back => {
                turn_over(&mut ends, size_mm[1]);
                turn_over(&mut picks, size_mm[1]);
                random.branch("back")
            }
        };
        let mut geometry = YarnGeometry {
            size_mm,
            paths: ends,
            floor_um,
        };
        // Hairs of the warp are rooted before the weft is there, so that each yarn has its own.
        add_hairs(
            &mut geometry,
            0,
            &self.warp,
            &mut hairs.branch("warp hairs"),
        );
        let from = geometry.paths.len();
        geometry.paths.append(&mut picks);
        add_hairs(
            &mut geometry,
            from,
            &self.weft,
            &mut hairs.branch("weft hairs"),
        );
        geometry
    }
}

impl Recipe for Weave {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        if let Err(what) = self.interlacing.repeat() {
            let names: Vec<_> = NAMES.iter().map(|(name, _)| *name).collect();
            let mend = format!("give rows of X and . or one of {}", names.join(", "));
            return Err(checker.wrong("source", "interlacing", what, mend));
        }
        self.warp.check(checker, "source.warp")?;
        self.weft.check(checker, "source.weft")
    }

    fn model(&self) -> Result<Option<Box<dyn Model>>, TextileError> {
        let geometry = self.yarn_geometry();
        Ok(Some(model(geometry, self.seed, self.noise_um, self.side)))
    }

    fn representation(&self) -> Representation {
        self.representation
    }

    fn set_side(&mut self, side: Side) -> bool {
        self.side = side;
        true
    }

    fn textile_kind(&self, fibre: &str) -> Option<&'static str> {
        Some(match &self.interlacing {
            Interlacing::Named(name) => kind_of_weave(name, fibre),
            Interlacing::Rows(_) => "other weave",
        })
    }

    fn groups() -> Vec<Group> {
        let mut cloth = parameters_of("source", Self::KEYS, &[]);
        let noise = cloth.split_off(cloth.len() - 1);
        vec![
            Group::new("Cloth", cloth),
            Yarn::group("source.warp", "Warp yarn"),
            Yarn::group("source.weft", "Weft yarn"),
            touch_group(noise),
        ]
    }

    fn example() -> Result<Option<Example<Self>>, TextileError> {
        Ok(Some(Example::Shipped("wool-twill")))
    }
}

/// Fibres from stems and leaves: stiff, uneven yarns.
const BAST_AND_LEAF: [&str; 4] = ["jute", "linen", "hemp", "sisal"];

/// The kind of a named interlacing; plain weaves, of which there are most, by their fibre.
fn kind_of_weave(interlacing: &str, fibre: &str) -> &'static str {
    match interlacing {
        "plain" if BAST_AND_LEAF.contains(&fibre) => "plain, bast or leaf fibre",
        "plain" if fibre == "silk" => "plain, silk",
        "plain" => "plain, other fibre",
        "twill-2-2" | "herringbone" => "twill alike on both sides",
        "twill-2-1" | "twill-3-1" | "twill-1-3" => "twill with a prevailing yarn",
        "satin-5" | "satin-8" | "sateen-5" => "satin",
        "basket-2-2" | "basket-3-3" | "warp-rib" | "weft-rib" => "basket or rib",
        "crepe" | "honeycomb" => "crêpe or honeycomb",
        _ => "other weave",
    }
}
