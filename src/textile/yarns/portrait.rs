//! The picture of a textile: its own relief, lit from the upper left, in the colours of its yarns.
//!
//! The patch repeats, so the picture tiles. The picture is for the eye; nothing is measured on it.

use super::path::YarnGeometry;
use super::relief::{Axis, Relief, Window};
use super::variation::count;
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{quantile, to_byte};

/// Pixels a millimetre of the finished picture.
pub(crate) const PX_PER_MM: f64 = 10.0;
/// Points across a pixel that the relief is taken at.
const FINE: usize = 3;
/// Towards the light: left, up, out of the textile.
const LIGHT: [f64; 3] = [-0.50, 0.55, 0.67];
/// Heights are lowered by this for the shading: textile is lit softly, not by a lamp at its edge.
const RELIEF_SHARE: f64 = 0.55;
/// Share of light that comes from everywhere.
const AMBIENT: f64 = 0.42;
/// Steps that colours are rounded to: what the eye does not see, the file need not hold.
const COLOUR_STEP: f64 = 7.0;
/// Least range of heights that darkens its low places fully, µm: a thin textile hides no light.
const MIN_DEPTH_UM: f64 = 110.0;
/// Colour seen through the textile.
const BENEATH: [f64; 3] = [0.16, 0.15, 0.14];

/// The picture of the whole patch, warp to the right, weft upwards, [`PX_PER_MM`] pixels a mm (to
/// the nearest whole pixel of the patch).
pub(crate) fn portrait(geometry: &YarnGeometry) -> Rgb8Image {
    let [width, height] = geometry
        .size_mm
        .map(|mm| count((mm * PX_PER_MM).round()).max(1));
    let n = [width * FINE, height * FINE];
    let step_mm = [0, 1].map(|k| geometry.size_mm[k] / n[k] as f64);
    let start_mm = step_mm.map(|step| 0.5 * step);
    let window = Window {
        axis: Axis::Warp,
        start_mm,
        step_mm,
        n,
    };
    let relief = Relief::of(geometry, &window);
    let depth = Depth::of(&relief);
    let mut pixels = Vec::with_capacity(width * height);
    for row in (0..height).rev() {
        for column in 0..width {
            let mut sum = [0.0; 3];
            for y in row * FINE..(row + 1) * FINE {
                for x in column * FINE..(column + 1) * FINE {
                    let light = depth.shade(&relief, [x, y]) * lambert(&relief, &window, [x, y]);
                    let own = colour(geometry, &relief, [x, y]);
                    (0..3).for_each(|c| sum[c] += own[c] * light);
                }
            }
            pixels.push(sum.map(|s| {
                let value = s / (FINE * FINE) as f64;
                to_byte((255.0 * value / COLOUR_STEP).round() * COLOUR_STEP)
            }));
        }
    }
    Rgb8Image {
        width,
        height,
        pixels,
    }
}

fn colour(geometry: &YarnGeometry, relief: &Relief, [x, y]: [usize; 2]) -> [f64; 3] {
    let top = usize::try_from(relief.top.row(y)[x]).unwrap_or(usize::MAX);
    geometry.paths.get(top).map_or(BENEATH, |path| path.colour)
}

/// Light that a point reflects by its slope, about 1 on the level.
fn lambert(relief: &Relief, window: &Window, [x, y]: [usize; 2]) -> f64 {
    let [width, height] = window.n;
    let row = relief.height_um.row(y);
    let rise = |ahead: f64, behind: f64, step_mm: f64| {
        RELIEF_SHARE * (ahead - behind) / (2000.0 * step_mm)
    };
    let dx = rise(
        row[(x + 1) % width],
        row[(x + width - 1) % width],
        window.step_mm[0],
    );
    let above = relief.height_um.row((y + 1) % height)[x];
    let below = relief.height_um.row((y + height - 1) % height)[x];
    let dy = rise(above, below, window.step_mm[1]);
    let length = (1.0 + dx * dx + dy * dy).sqrt();
    let facing = (-dx * LIGHT[0] - dy * LIGHT[1] + LIGHT[2]) / length;
    AMBIENT + (1.0 - AMBIENT) * facing.max(0.0) / LIGHT[2]
}

/// The range of heights, by which low places are darkened: little light reaches them.
struct Depth {
    low_um: f64,
    high_um: f64,
}

impl Depth {
    fn of(relief: &Relief) -> Self {
        let mut heights = relief.height_um.values().to_vec();
        let low_um = quantile(&mut heights, 0.03);
        let high_um = quantile(&mut heights, 0.85);
        Self {
            low_um: low_um.min(high_um - MIN_DEPTH_UM),
            high_um,
        }
    }

    fn shade(&self, relief: &Relief, [x, y]: [usize; 2]) -> f64 {
        let height = relief.height_um.row(y)[x];
        let share = ((height - self.low_um) / (self.high_um - self.low_um)).clamp(0.0, 1.15);
        0.45 + 0.55 * share.sqrt()
    }
}
