//! Yarns under the virtual tester: a model that is felt.

use super::path::YarnGeometry;
use super::portrait::{PX_PER_MM, portrait};
use super::relief::{Axis, Relief, Window, relief_map};
use crate::recipe::{Model, Side};
use crate::surface::{Direction, HeightMap, Probe, SurfaceError};
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::Random;

/// Distance of the points of a model's relief, about, mm: finer than the wire can follow.
const RELIEF_STEP_MM: f64 = 0.02;

/// Samples of a stroke: 20 mm at 230 a millimetre.
const N_SAMPLES: usize = 4600;
/// Distance of samples, mm.
const STEP_MM: f64 = 1.0 / 230.0;
/// Tracks that stand for the width of the probe's wire.
const N_TRACKS: usize = 80;

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
    fn strokes_um(&self) -> ([Vec<f64>; 4], [f64; 2]) {
        let strokes = profiles(&self.geometry, &self.probe, &self.random);
        (strokes, [STEP_MM; 2])
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

/// Heights of four strokes over the textile, µm, by [`Direction::index`], each in travel order.
///
/// Forward and reverse run over the same strip, as the instrument's do; the instrument is zeroed at
/// the mean height of the strip.
fn profiles(geometry: &YarnGeometry, probe: &Probe, random: &Random) -> [Vec<f64>; 4] {
    let mut heights: [Vec<f64>; 4] = Default::default();
    for (axis, pair) in [Axis::Warp, Axis::Weft].into_iter().zip(Direction::BY_AXIS) {
        let margin = probe.margin_samples(STEP_MM);
        let track_mm = probe.width_mm / N_TRACKS as f64;
        let window = Window {
            axis,
            start_mm: [-(margin as f64) * STEP_MM, 0.5 * track_mm],
            step_mm: [STEP_MM, track_mm],
            n: [N_SAMPLES + 2 * margin, N_TRACKS],
        };
        let relief = Relief::of(geometry, &window);
        let mut lift = probe.lift_um(&relief.height_um, STEP_MM);
        let mean = lift.iter().sum::<f64>() / lift.len().max(1) as f64;
        for height in &mut lift {
            *height -= mean;
        }
        for direction in pair {
            let mut noise = random.branch(direction.key());
            heights[direction.index()] =
                probe.stroke(&lift, STEP_MM, direction.is_reverse(), &mut noise);
        }
    }
    heights
}
