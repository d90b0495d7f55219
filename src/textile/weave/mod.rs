//! Woven cloth: two sets of yarns that pass over and under one another.
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

pub use interlacing::Repeat;
pub use interlacing::{Interlacing, NAMES};

use serde::{Deserialize, Serialize};

use super::TextileError;
use super::cloth::{Cloth, Side, Yarn, add_hairs, turn_over, usual};
use super::manifest::{Checker, profile_file_keys};
use super::parameter::{Number, numbers};
use crate::surface::Representation;
use selvedge_foundation::numerics::Random;

/// The recipe of a woven cloth (`kind = "weave"`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weave {
    /// Always `weave`.
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
    /// Which side of the cloth is touched.
    #[serde(default, skip_serializing_if = "Side::is_face")]
    pub side: Side,
    /// Chooses the irregularities.
    pub seed: u32,
    /// Which yarn lies on top where.
    pub interlacing: Interlacing,
    /// Ends per centimetre.
    pub warp_per_cm: f64,
    /// Picks per centimetre.
    pub weft_per_cm: f64,
    /// Share of the crimp that the warp takes, 0…1.
    #[serde(default = "half")]
    pub crimp_share: f64,
    /// How far apart crossing yarns stand, as a share of half the sum of their thicknesses.
    #[serde(default = "default_compaction")]
    pub compaction: f64,
    /// How far a float bulges for every crossing that it passes, µm.
    #[serde(default)]
    pub float_lift_um: f64,
    /// Standard deviation of the crimp share from place to place.
    #[serde(default = "usual::tension_drift")]
    pub tension_drift: f64,
    /// Over what length tension and bow change, mm.
    #[serde(default = "usual::drift_mm")]
    pub drift_mm: f64,
    /// Standard deviation of the places of yarns, share of their pitch.
    #[serde(default = "usual::pitch_cv")]
    pub pitch_cv: f64,
    /// Standard deviation of the bow of a yarn, µm.
    #[serde(default)]
    pub bow_um: f64,
    /// Out-of-plane puckering by lively twist, µm rms.
    #[serde(default)]
    pub pucker_um: f64,
    /// Size of the puckers, mm.
    #[serde(default = "usual::pucker_mm")]
    pub pucker_mm: f64,
    /// Noise of the probe, µm rms.
    #[serde(default = "usual::noise_um")]
    pub noise_um: f64,
    /// The warp yarn.
    pub warp: Yarn,
    /// The weft yarn.
    pub weft: Yarn,
}

fn half() -> f64 {
    0.5
}
fn default_compaction() -> f64 {
    0.9
}

profile_file_keys!(Weave);

/// The numbers of a weave.
pub(crate) const NUMBERS: &[Number<Weave>] = numbers! { Weave;
    warp_per_cm "Ends" 2.0..=100.0 "/cm" "Ends per centimetre";
    weft_per_cm "Picks" 2.0..=100.0 "/cm" "Picks per centimetre";
    crimp_share "Crimp of the warp" 0.0..=1.0 "" "Share of the crimp that the warp takes";
    compaction "Compaction" 0.1..=1.2 ""
        "How far apart crossing yarns stand, as a share of half the sum of their thicknesses";
    float_lift_um "Lift of floats" 0.0..=500.0 "µm"
        "How far a float bulges for every crossing that it passes";
    tension_drift "Tension drift" 0.0..=0.5 ""
        "Standard deviation of the crimp share from place to place";
    drift_mm "Drift length" 1.0..=10.0 "mm" "Over what length tension and bow change";
    pitch_cv "Uneven pitch" 0.0..=0.3 ""
        "Standard deviation of the places of yarns, share of their pitch";
    bow_um "Bow" 0.0..=2000.0 "µm" "Standard deviation of the bow of a yarn";
    pucker_um "Pucker" 0.0..=500.0 "µm" "Out-of-plane puckering by lively twist, rms";
    pucker_mm "Size of puckers" 0.5..=10.0 "mm" "Size of the puckers";
    noise_um "Noise of the probe" 0.0..=10.0 "µm" "Noise of the probe, rms";
};

impl Weave {
    /// Refuses what cannot be woven.
    pub fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        Number::check(NUMBERS, self, (checker, "source"))?;
        if let Err(what) = self.interlacing.repeat() {
            let names: Vec<_> = NAMES.iter().map(|(name, _)| *name).collect();
            let mend = format!("give rows of X and . or one of {}", names.join(", "));
            return Err(checker.wrong("source", "interlacing", what, mend));
        }
        self.warp.check(checker, "source.warp")?;
        self.weft.check(checker, "source.weft")
    }

    /// The cloth. Empty if the interlacing is none: [`Weave::check`] refuses that.
    pub fn cloth(&self) -> Cloth {
        let random = Random::new(u64::from(self.seed));
        let thickness = self.warp.thickness_um + self.weft.thickness_um;
        let floor_um = -thickness;
        let Ok(repeat) = self.interlacing.repeat() else {
            return Cloth {
                size_mm: [1.0; 2],
                strands: Vec::new(),
                floor_um,
            };
        };
        let (size_mm, mut ends, mut picks) = crossing::strands(self, &repeat, &random);
        let hairs = match self.side {
            Side::Face => random,
            Side::Back => {
                turn_over(&mut ends, size_mm[1]);
                turn_over(&mut picks, size_mm[1]);
                random.branch("back")
            }
        };
        let mut cloth = Cloth {
            size_mm,
            strands: ends,
            floor_um,
        };
        // Hairs of the warp are rooted before the weft is there, so that each yarn has its own.
        add_hairs(&mut cloth, 0, &self.warp, &mut hairs.branch("warp hairs"));
        let from = cloth.strands.len();
        cloth.strands.append(&mut picks);
        add_hairs(
            &mut cloth,
            from,
            &self.weft,
            &mut hairs.branch("weft hairs"),
        );
        cloth
    }
}
