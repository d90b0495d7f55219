//! The four strokes of the virtual probe over a model textile.

use super::path::YarnGeometry;
use super::relief::{Axis, Relief, Window};
use crate::surface::{Direction, Probe};
use selvedge_foundation::numerics::Random;

/// Samples of a stroke: 20 mm at 230 a millimetre.
const N_SAMPLES: usize = 4600;
/// Distance of samples, mm.
pub(super) const STEP_MM: f64 = 1.0 / 230.0;
/// Tracks that stand for the width of the probe's wire.
const N_TRACKS: usize = 80;

/// Heights of four strokes over the textile, µm, by [`Direction::index`], each in travel order.
///
/// Forward and reverse run over the same strip, as the instrument's do; the instrument is zeroed at
/// the mean height of the strip.
pub(crate) fn profiles(geometry: &YarnGeometry, probe: &Probe, random: &Random) -> [Vec<f64>; 4] {
    let mut heights: [Vec<f64>; 4] = Default::default();
    for (axis, pair) in [
        (Axis::Warp, [Direction::WarpForward, Direction::WarpReverse]),
        (Axis::Weft, [Direction::WeftForward, Direction::WeftReverse]),
    ] {
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
