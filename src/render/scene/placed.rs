//! A textile that lies in a scene: where, how it is turned, where it is felt, and its own gains.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::slots::SlotLetter;
use selvedge_foundation::geometry::{Frame, Point, Rotation};
use selvedge_textile::tactile::Band;

/// How far outside its left and lower edge a textile is still felt, and how far inside its right
/// and upper edge no longer, mm.
pub(crate) const EDGE_MM: f64 = 1e-6;

/// A textile of the library and where it lies.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlacedTextile {
    /// The textile's id in the library, or `LIBRARY:ID` of another one
    /// ([`selvedge_textile::elsewhere`]), whose folder is absolute here.
    pub id: String,
    /// Its lower-left corner before turning, in the workspace.
    pub origin_mm: Point,
    /// Its extent along warp and weft, mm.
    pub size_mm: [f64; 2],
    /// Counter-clockwise turn about its origin, degrees.
    #[serde(default)]
    pub rotation_deg: f64,
    /// Gain on top of the textile's own, dB; −∞ silences it.
    #[serde(default)]
    pub gain_db: f64,
    /// What it adds to that at 40 Hz, dB.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gain_40_db: f64,
    /// The same at 320 Hz.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gain_320_db: f64,
    /// Lower left and upper right corner in the workspace of what it is felt within, whichever way
    /// it is turned; `None` is all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_mm: Option<[Point; 2]>,
    /// What the screen calls it.
    #[serde(default)]
    pub label: String,
    /// The level above the threshold of detection that 40 Hz is to have, dB.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target_40_db_sl: Option<f64>,
    /// The same of 320 Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target_320_db_sl: Option<f64>,
    /// Its gain in the scene's slots, dB; in others it is [`Self::gain_db`].
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub slot_gains_db: BTreeMap<SlotLetter, f64>,
}

impl PlacedTextile {
    /// The textile's own axes, seen from the workspace: x along its warp, y along its weft.
    pub fn workspace_from_textile(&self) -> Frame {
        Frame {
            origin: self.origin_mm,
            rotation: Rotation::from_degrees(self.rotation_deg),
        }
    }

    /// Whether a point of the textile's own axes (u along the warp, w along the weft) is on it.
    pub fn contains(&self, textile_point: Point) -> bool {
        let in_workspace = || self.workspace_from_textile().point(textile_point);
        is_on(textile_point, in_workspace, self.size_mm, self.within_mm)
    }

    /// What it adds to its gain in a band, dB.
    pub fn band_gain_db(&self, band: Band) -> f64 {
        match band {
            Band::Low => self.gain_40_db,
            Band::High => self.gain_320_db,
        }
    }

    /// The level above the threshold of detection that a band is to have, dB.
    pub fn target_db_sl(&self, band: Band) -> Option<f64> {
        match band {
            Band::Low => self.target_40_db_sl,
            Band::High => self.target_320_db_sl,
        }
    }

    /// What it is and where it lies, without gains, targets and label.
    #[must_use]
    pub fn untuned(&self) -> Self {
        Self {
            id: self.id.clone(),
            origin_mm: self.origin_mm,
            size_mm: self.size_mm,
            rotation_deg: self.rotation_deg,
            within_mm: self.within_mm,
            ..Self::default()
        }
    }
}

/// Whether a gain changes nothing; a key that does not is left out.
#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands a reference over"
)]
fn is_zero(gain_db: &f64) -> bool {
    gain_db.abs() <= 0.0
}

/// Whether a point lies on a textile of this size: by its place in the textile's own axes, and by
/// that in the workspace where it is felt in a part of that only.
#[inline]
pub(crate) fn is_on(
    place: Point,
    in_workspace: impl FnOnce() -> Point,
    [width_mm, height_mm]: [f64; 2],
    within_mm: Option<[Point; 2]>,
) -> bool {
    let within = |place_mm, extent_mm| -EDGE_MM <= place_mm && place_mm < extent_mm - EDGE_MM;
    let is_felt_at = |[from, to]: [Point; 2]| {
        let at = in_workspace();
        within(at.x_mm - from.x_mm, to.x_mm - from.x_mm)
            && within(at.y_mm - from.y_mm, to.y_mm - from.y_mm)
    };
    within(place.x_mm, width_mm)
        && within(place.y_mm, height_mm)
        && within_mm.is_none_or(is_felt_at)
}
