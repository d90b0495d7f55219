//! Weft-knitted textile: courses of loops drawn through the loops of the course before.
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

pub(crate) use structure::Structure;

use crate::error::TextileError;
use crate::recipe::{
    Checker, Example, Group, KeySpec, Model, Recipe, Side, defaults, keys, parameters_of,
};
use crate::surface::Representation;
use crate::yarns::{Yarn, YarnGeometry, add_hairs, model, touch_group, turn_over, usual};
use selvedge_foundation::numerics::Random;

/// What a window shows first; needle lines belong to the loops.
const FIRST: &[&str] = &[
    "structure",
    "wales_per_cm",
    "courses_per_cm",
    "loop_height",
    "bulge",
    "leg_spread",
    "needle_um",
];

keys! {
    /// The recipe of a knitted textile (`kind = "knit"`).
    source Knit {
        /// Whether it is felt along four strokes or at every point of its relief.
        #[serde(default, skip_serializing_if = "Representation::is_default")]
        pub(crate) representation: Representation,
        /// Which side of the textile is touched.
        #[serde(default, skip_serializing_if = "Side::is_face")]
        pub(crate) side: Side,
        /// Chooses the irregularities.
        pub(crate) seed: u32,
        pub(crate) structure: Structure
            => "Structure": "Which stitch stands where",
        pub(crate) wales_per_cm: f64
            => "Wales" 1.0 ..= 40.0 "/cm" "Columns of loops per centimetre",
        pub(crate) courses_per_cm: f64
            => "Courses" 1.0 ..= 50.0 "/cm" "Rows of loops per centimetre",
        #[serde(default = "default_loop_height")]
        pub(crate) loop_height: f64
            => "Height of loops" 1.0 ..= 3.0 ""
            "Height of a loop in courses: above 1, since loops overlap",
        #[serde(default = "default_bulge")]
        pub(crate) bulge: f64
            => "Bulge" 0.0 ..= 0.3 ""
            "How much the loop bulges at head and feet, share of the wale pitch",
        /// How far the legs of a loop stand apart beyond half a wale, share of the wale pitch: the
        /// legs of neighbouring loops touch before those of one loop do.
        #[serde(default = "default_leg_spread")]
        pub(crate) leg_spread: f64
            => "Spread of legs" 0.0 ..= 0.15 ""
            "How far the legs of a loop stand apart beyond half a wale, share of the wale pitch",
        pub(crate) loop_depth_um: f64
            => "Depth of loops" 1.0 ..= 2000.0 "µm"
            "How far legs and arcs stand before and behind the middle of the cloth",
        /// Height of the raised above the sunken stitches of a rib (face above back) or a piqué
        /// (tucks above plain ones), µm; below 0 where the others stand out.
        #[serde(default)]
        pub(crate) relief_um: f64
            => "Relief" -1000.0 ..= 3000.0 "µm"
            "Height of the raised above the sunken stitches of a rib or a piqué",
        #[serde(default)]
        pub(crate) pile_um: f64
            => "Pile" 0.0 ..= 5000.0 "µm" "Height of the pile under the probe's load",
        #[serde(default)]
        pub(crate) pile_clump: f64
            => "Uneven pile" 0.0 ..= 2.0 ""
            "How unevenly the pile stands: standard deviation of the logarithm",
        #[serde(default = "usual::tension_drift")]
        pub(crate) tension_drift: f64
            => "Tension drift" 0.0 ..= 0.5 ""
            "Standard deviation of the loop size from place to place",
        #[serde(default = "usual::drift_mm")]
        pub(crate) drift_mm: f64
            => "Drift length" 1.0 ..= 10.0 "mm" "Over what length tension and bow change",
        #[serde(default = "usual::pitch_cv")]
        pub(crate) pitch_cv: f64
            => "Uneven pitch" 0.0 ..= 0.3 ""
            "Standard deviation of the places of wales and courses, share of their pitch",
        #[serde(default)]
        pub(crate) bow_um: f64
            => "Bow" 0.0 ..= 2000.0 "µm" "Standard deviation of the bow of a course",
        #[serde(default)]
        pub(crate) needle_um: f64
            => "Needle lines" 0.0 ..= 200.0 "µm" "Standard deviation of the height of a wale",
        #[serde(default)]
        pub(crate) pucker_um: f64
            => "Pucker" 0.0 ..= 500.0 "µm" "Out-of-plane puckering by lively twist, rms",
        #[serde(default = "usual::pucker_mm")]
        pub(crate) pucker_mm: f64
            => "Size of puckers" 0.5 ..= 10.0 "mm" "Size of the puckers",
        #[serde(default = "usual::noise_um")]
        pub(crate) noise_um: f64
            => "Noise of the probe" 0.0 ..= 10.0 "µm" "Noise of the probe, rms",
        /// The yarn.
        pub(crate) yarn: Yarn,
    }
}

defaults! {
    default_loop_height: f64 = 1.6;
    default_bulge: f64 = 0.1;
    default_leg_spread: f64 = 0.03;
}

impl Knit {
    /// The textile.
    pub(crate) fn yarn_geometry(&self) -> YarnGeometry {
        let random = Random::new(u64::from(self.seed));
        let bed = course::Bed::new(self, &random);
        let mut paths = bed.courses(0.0, 1.0, &random.branch("front"));
        let behind_um = 2.0 * self.loop_depth_um + self.yarn.thickness_um;
        if self.structure.has_second_bed() {
            // Both beds of such a textile turn their legs outwards; the one behind is not felt, and
            // which way it faces shows only when the textile is turned over.
            let facing = if self.side.is_face() { 1.0 } else { -1.0 };
            let second = random.branch("second bed");
            paths.extend(bed.courses(behind_um, facing, &second));
        }
        paths.extend(bed.pile(&random));
        let floor_um = -(behind_um + self.yarn.thickness_um + self.relief_um.abs());
        let mut geometry = YarnGeometry {
            size_mm: bed.size_mm,
            paths,
            floor_um,
        };
        if self.side.is_face() {
            add_hairs(&mut geometry, 0, &self.yarn, &mut random.branch("hairs"));
            return geometry;
        }
        turn_over(&mut geometry.paths, geometry.size_mm[1]);
        geometry.floor_um = geometry.lowest_um();
        // A nap is raised on one side only.
        if !self.structure.is_brushed() {
            let random = random.branch("back");
            add_hairs(&mut geometry, 0, &self.yarn, &mut random.branch("hairs"));
        }
        geometry
    }
}

impl Recipe for Knit {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        self.yarn.check(checker, "source.yarn")
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

    fn textile_kind(&self, _fibre: &str) -> Option<&'static str> {
        Some(match self.structure {
            Structure::Jersey => "jersey",
            Structure::ReverseJersey => "reverse jersey",
            Structure::Rib11 => "rib 1×1",
            Structure::Rib22 => "rib 2×2",
            Structure::Interlock => "interlock",
            Structure::Pique => "piqué",
            Structure::Terry => "terry",
            Structure::Fleece | Structure::Plush => "brushed or cut pile",
        })
    }

    fn groups() -> Vec<Group> {
        let mut cloth = parameters_of("source", Self::KEYS, FIRST);
        let noise = cloth.split_off(cloth.len() - 1);
        vec![
            Group::new("Cloth", cloth),
            Yarn::group("source.yarn", "Yarn"),
            touch_group(noise),
        ]
    }

    fn example() -> Result<Option<Example<Self>>, TextileError> {
        Ok(Some(Example::Shipped("polyamide-jersey")))
    }
}
