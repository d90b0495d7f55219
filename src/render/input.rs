//! What rendering needs to know of a scene: plain data, without files, ids or labels.
//!
//! Made from a loaded scene once, off the real-time path; a renderer is prepared from it.

use std::sync::Arc;

use super::RenderError;
use crate::scene::{Display, LoadedScene};
use selvedge_foundation::geometry::{Displacement, Frame, Point};
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::{Band, Filters, Tuning};

/// Most textiles that a scene to render may hold.
const MAX_TEXTILES: usize = 65_000;

/// A scene as rendering sees it.
#[derive(Debug, Clone, Default)]
pub struct RenderScene {
    /// The textiles in order of placement; where they overlap the last one is on top.
    pub textiles: Vec<PlacedSurface>,
    /// The displays, one per finger.
    pub displays: Vec<ContactorArray>,
    /// The filters of the two bands.
    pub filters: Filters,
    /// Gains and compression at the start; they may change live.
    pub tuning: Tuning,
    /// The library's reference level, dB re 1 µm, used when the tuning states none.
    pub library_reference_db: Option<f64>,
}

/// A surface and where it lies.
#[derive(Debug, Clone)]
pub struct PlacedSurface {
    /// The textile's own axes seen from the workspace: x along its warp, y along its weft.
    pub workspace_from_textile: Frame,
    /// Its extent along warp and weft, mm.
    pub size_mm: [f64; 2],
    /// Lower left and upper right corner in the workspace of what it is felt within; `None` is all
    /// of it.
    pub within_mm: Option<[Point; 2]>,
    /// The gain of its manifest, dB.
    pub manifest_gain_db: f64,
    /// The gain that the scene gives it, dB.
    pub scene_gain_db: f64,
    /// What it adds to that at 40 and 320 Hz, dB.
    pub scene_band_gains_db: [f64; 2],
    /// How strong it is as a whole.
    pub level: PlacedLevel,
    /// Its spectra.
    pub surface: Arc<Surface>,
}

/// The level of a textile as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum PlacedLevel {
    /// Still being computed: compression leaves the textile alone until then.
    #[default]
    Pending,
    /// The textile is silent in a band and has no level: compression gain 0 dB.
    Silent,
    /// Its level, dB re 1 µm.
    Known(f64),
}

impl PlacedLevel {
    /// The level of [`selvedge_textile::tactile::Levels::level_db`].
    pub fn of(level_db: Option<f64>) -> Self {
        level_db.map_or(Self::Silent, Self::Known)
    }

    /// The level in dB re 1 µm, if there is one.
    pub fn db(self) -> Option<f64> {
        match self {
            Self::Known(level_db) => Some(level_db),
            Self::Pending | Self::Silent => None,
        }
    }
}

/// The contactors of a display.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactorArray {
    /// Offsets of the contactors from the display's centre, mm, before turning.
    pub offsets: Vec<Displacement>,
    /// How the display is turned on the finger, degrees counter-clockwise.
    pub rotation_deg: f64,
}

impl RenderScene {
    /// What rendering needs of a loaded scene, with its tuning or the library's.
    pub fn of(loaded: &LoadedScene) -> Self {
        let scene = loaded.scene();
        let placed = scene
            .textiles
            .iter()
            .zip(loaded.textiles())
            .zip(loaded.levels_db());
        let textiles = placed.map(|((placed, textile), level_db)| PlacedSurface {
            workspace_from_textile: placed.workspace_from_textile(),
            size_mm: placed.size_mm,
            within_mm: placed.within_mm,
            manifest_gain_db: textile.manifest().gain_db,
            scene_gain_db: placed.gain_db,
            scene_band_gains_db: Band::ALL.map(|band| placed.band_gain_db(band)),
            level: PlacedLevel::of(*level_db),
            surface: Arc::clone(textile.surface()),
        });
        Self {
            textiles: textiles.collect(),
            displays: scene.displays.iter().map(ContactorArray::of).collect(),
            filters: scene.filters,
            tuning: loaded.tuning(),
            library_reference_db: loaded.library_reference_db(),
        }
    }

    /// Refuses what cannot be rendered: gains that are NaN or +∞, a senseless tuning, places that
    /// are not finite, too many textiles.
    pub fn check(&self) -> Result<(), RenderError> {
        self.tuning.check()?;
        if self.textiles.len() > MAX_TEXTILES {
            return Err(RenderError::TooManyTextiles {
                n_textiles: self.textiles.len(),
                at_most: MAX_TEXTILES,
            });
        }
        for (index, textile) in self.textiles.iter().enumerate() {
            Tuning::check_gain("gain_db", textile.manifest_gain_db)?;
            Tuning::check_gain("gain_db", textile.scene_gain_db)?;
            let [low_db, high_db] = textile.scene_band_gains_db;
            Tuning::check_gain("gain_40_db", low_db)?;
            Tuning::check_gain("gain_320_db", high_db)?;
            if !textile.is_finite() {
                return Err(RenderError::NotFinite {
                    what: "textile",
                    index,
                });
            }
        }
        let odd = self
            .displays
            .iter()
            .position(|display| !display.is_finite());
        odd.map_or(Ok(()), |index| {
            let what = "display";
            Err(RenderError::NotFinite { what, index })
        })
    }
}

impl PlacedSurface {
    fn is_finite(&self) -> bool {
        let (cos, sin) = self.workspace_from_textile.rotation.cos_sin();
        let numbers = [cos, sin, self.size_mm[0], self.size_mm[1]];
        let corners = self.within_mm.as_ref().map_or(&[][..], |corners| corners);
        self.workspace_from_textile.origin.is_finite()
            && numbers.iter().all(|x| x.is_finite())
            && corners.iter().all(|corner| corner.is_finite())
    }
}

impl ContactorArray {
    pub(crate) fn of(display: &Display) -> Self {
        Self {
            offsets: display.geometry.contactors(),
            rotation_deg: display.rotation_deg,
        }
    }

    fn is_finite(&self) -> bool {
        let is_place = |by: &Displacement| by.x_mm.is_finite() && by.y_mm.is_finite();
        self.rotation_deg.is_finite() && self.offsets.iter().all(is_place)
    }
}
