//! Yarns under the virtual tester: a model that is felt.

use std::path::Path;

use super::path::YarnGeometry;
use super::portrait::{PX_PER_MM, portrait};
use super::relief::relief_map;
use super::stroke::{STEP_MM, profiles};
use crate::error::TextileError;
use crate::profile_file;
use crate::recipe::{Model, Side};
use crate::surface::{Direction, HeightMap, Probe, SurfaceError};
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::Random;

/// Distance of the points of a model's relief, about, mm: finer than the wire can follow.
const RELIEF_STEP_MM: f64 = 0.02;

/// Yarns, and the probe that is drawn over them.
struct StrokedYarns {
    geometry: YarnGeometry,
    probe: Probe,
    random: Random,
}

/// The model of yarns that are touched on one side by a probe with this noise.
pub(crate) fn model(
    geometry: YarnGeometry,
    seed: u32,
    noise_um: f64,
    side: Side,
) -> Box<dyn Model> {
    Box::new(StrokedYarns {
        geometry,
        probe: Probe {
            noise_um,
            ..Probe::default()
        },
        random: Random::new(u64::from(seed)).branch(match side {
            Side::Face => "probe",
            Side::Back => "probe on the back",
        }),
    })
}

impl Model for StrokedYarns {
    fn profile_files(&self) -> Result<[String; 4], TextileError> {
        let mut texts: [String; 4] = Default::default();
        let strokes = profiles(&self.geometry, &self.probe, &self.random);
        for (direction, heights) in Direction::ALL.into_iter().zip(&strokes) {
            texts[direction.index()] =
                profile_file::write(heights, STEP_MM, Path::new(direction.key()))?;
        }
        Ok(texts)
    }

    fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        Some(relief_map(&self.geometry, RELIEF_STEP_MM))
    }

    fn relief(&self, step_mm: f64) -> Result<HeightMap, SurfaceError> {
        relief_map(&self.geometry, step_mm)
    }

    fn picture(&self) -> (Rgb8Image, f64) {
        (portrait(&self.geometry), PX_PER_MM)
    }
}
