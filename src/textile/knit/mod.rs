//! Weft-knitted cloth: courses of loops drawn through the loops of the course before.
//!
//! Every course is one yarn along the three-dimensional centre line of its stitches, an omega in
//! the plane that dives from the face (legs) to the back (head and feet), after the loop models of
//! Peirce (1947) and Leaf (1960) with the curve written as a trochoid. Structures place face and
//! back stitches, tucks, a second bed and pile. The stroke along the wales is called warp, the
//! stroke along the courses weft.
//!
//! It knows nothing of probes, spectra or files.

mod course;
mod structure;

pub use structure::Structure;

use serde::{Deserialize, Serialize};

use super::TextileError;
use super::cloth::{Cloth, Side, Yarn, add_hairs, turn_over, usual};
use super::manifest::{Checker, profile_file_keys};
use super::parameter::{Number, numbers};
use crate::surface::Representation;
use selvedge_foundation::numerics::Random;

/// The recipe of a knitted cloth (`kind = "knit"`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knit {
    /// Always `knit`.
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
    /// Which stitch stands where.
    pub structure: Structure,
    /// Wales (columns of loops) per centimetre.
    pub(crate) wales_per_cm: f64,
    /// Courses (rows of loops) per centimetre.
    pub(crate) courses_per_cm: f64,
    /// Height of a loop in courses: above 1, since loops overlap.
    #[serde(default = "default_loop_height")]
    pub(crate) loop_height: f64,
    /// How much the omega bulges at head and feet, share of the wale pitch.
    #[serde(default = "default_bulge")]
    pub(crate) bulge: f64,
    /// How far the legs of a loop stand apart beyond half a wale, share of the wale pitch: the legs
    /// of neighbouring loops touch before those of one loop do.
    #[serde(default = "default_leg_spread")]
    pub(crate) leg_spread: f64,
    /// How far legs and arcs stand before and behind the middle of the cloth, µm.
    pub(crate) loop_depth_um: f64,
    /// Height of the raised above the sunken stitches of a rib (face above back) or a piqué
    /// (tucks above plain ones), µm; below 0 where the others stand out.
    #[serde(default)]
    pub relief_um: f64,
    /// Height of the pile under the probe's load, µm.
    #[serde(default)]
    pub(crate) pile_um: f64,
    /// How unevenly the pile stands: standard deviation of the logarithm.
    #[serde(default)]
    pub(crate) pile_clump: f64,
    /// Standard deviation of the loop size from place to place.
    #[serde(default = "usual::tension_drift")]
    pub(crate) tension_drift: f64,
    /// Over what length tension and bow change, mm.
    #[serde(default = "usual::drift_mm")]
    pub(crate) drift_mm: f64,
    /// Standard deviation of the places of wales and courses, share of their pitch.
    #[serde(default = "usual::pitch_cv")]
    pub(crate) pitch_cv: f64,
    /// Standard deviation of the bow of a course, µm.
    #[serde(default)]
    pub(crate) bow_um: f64,
    /// Standard deviation of the height of a wale: needle lines, µm.
    #[serde(default)]
    pub(crate) needle_um: f64,
    /// Out-of-plane puckering by lively twist, µm rms.
    #[serde(default)]
    pub(crate) pucker_um: f64,
    /// Size of the puckers, mm.
    #[serde(default = "usual::pucker_mm")]
    pub(crate) pucker_mm: f64,
    /// Noise of the probe, µm rms.
    #[serde(default = "usual::noise_um")]
    pub noise_um: f64,
    /// The yarn.
    pub(crate) yarn: Yarn,
}

fn default_loop_height() -> f64 {
    1.6
}
fn default_bulge() -> f64 {
    0.1
}
fn default_leg_spread() -> f64 {
    0.03
}

profile_file_keys!(Knit);

/// The numbers of a knit.
pub(crate) const NUMBERS: &[Number<Knit>] = numbers! { Knit;
    wales_per_cm "Wales" 1.0..=40.0 "/cm" "Columns of loops per centimetre";
    courses_per_cm "Courses" 1.0..=50.0 "/cm" "Rows of loops per centimetre";
    loop_height "Height of loops" 1.0..=3.0 ""
        "Height of a loop in courses: above 1, since loops overlap";
    bulge "Bulge" 0.0..=0.3 ""
        "How much the loop bulges at head and feet, share of the wale pitch";
    leg_spread "Spread of legs" 0.0..=0.15 ""
        "How far the legs of a loop stand apart beyond half a wale, share of the wale pitch";
    needle_um "Needle lines" 0.0..=200.0 "µm" "Standard deviation of the height of a wale";
    loop_depth_um "Depth of loops" 1.0..=2000.0 "µm"
        "How far legs and arcs stand before and behind the middle of the cloth";
    relief_um "Relief" -1000.0..=3000.0 "µm"
        "Height of the raised above the sunken stitches of a rib or a piqué";
    pile_um "Pile" 0.0..=5000.0 "µm" "Height of the pile under the probe's load";
    pile_clump "Uneven pile" 0.0..=2.0 ""
        "How unevenly the pile stands: standard deviation of the logarithm";
    tension_drift "Tension drift" 0.0..=0.5 ""
        "Standard deviation of the loop size from place to place";
    drift_mm "Drift length" 1.0..=10.0 "mm" "Over what length tension and bow change";
    pitch_cv "Uneven pitch" 0.0..=0.3 ""
        "Standard deviation of the places of wales and courses, share of their pitch";
    bow_um "Bow" 0.0..=2000.0 "µm" "Standard deviation of the bow of a course";
    pucker_um "Pucker" 0.0..=500.0 "µm" "Out-of-plane puckering by lively twist, rms";
    pucker_mm "Size of puckers" 0.5..=10.0 "mm" "Size of the puckers";
    noise_um "Noise of the probe" 0.0..=10.0 "µm" "Noise of the probe, rms";
};

impl Knit {
    /// Refuses what cannot be knitted.
    pub fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        Number::check(NUMBERS, self, (checker, "source"))?;
        self.yarn.check(checker, "source.yarn")
    }

    /// The cloth.
    pub fn cloth(&self) -> Cloth {
        let random = Random::new(u64::from(self.seed));
        let bed = course::Bed::new(self, &random);
        let mut strands = bed.courses(0.0, 1.0, &random.branch("front"));
        let behind_um = 2.0 * self.loop_depth_um + self.yarn.thickness_um;
        if self.structure.has_second_bed() {
            // Both beds of such a cloth turn their legs outwards; the one behind is not felt, and
            // which way it faces shows only when the cloth is turned over.
            let facing = if self.side.is_face() { 1.0 } else { -1.0 };
            let second = random.branch("second bed");
            strands.extend(bed.courses(behind_um, facing, &second));
        }
        strands.extend(bed.pile(&random));
        let floor_um = -(behind_um + self.yarn.thickness_um + self.relief_um.abs());
        let mut cloth = Cloth {
            size_mm: bed.size_mm,
            strands,
            floor_um,
        };
        if self.side.is_face() {
            add_hairs(&mut cloth, 0, &self.yarn, &mut random.branch("hairs"));
            return cloth;
        }
        turn_over(&mut cloth.strands, cloth.size_mm[1]);
        cloth.floor_um = cloth.lowest_um();
        // A nap is raised on one side only.
        if !self.structure.is_brushed() {
            let random = random.branch("back");
            add_hairs(&mut cloth, 0, &self.yarn, &mut random.branch("hairs"));
        }
        cloth
    }
}
