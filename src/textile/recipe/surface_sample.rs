//! A sample of a model surface: what four strokes over it read, and a patch for its picture.

use super::Model;
use crate::surface::{Direction, HeightMap, ProfileSet, SurfaceError};
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{Grid, quantile, to_byte};

/// Four strokes and a patch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SurfaceSample {
    /// Heights of the strokes, µm, by [`Direction::index`], in travel order.
    pub(crate) strokes_um: [Vec<f64>; 4],
    /// Steps along warp and weft, mm.
    pub(crate) step_mm: [f64; 2],
    /// What is pictured.
    pub(crate) patch: HeightMap,
    /// All of the surface, where it was drawn in two dimensions.
    pub(crate) area: Option<HeightMap>,
    /// Figures found on it, for the manifest.
    pub(crate) measured: Vec<(&'static str, f64)>,
}

impl SurfaceSample {
    /// Strokes along two lines, forward and back: a point has no friction.
    pub(crate) fn of_lines(lines_um: [Vec<f64>; 2], step_mm: f64, patch: HeightMap) -> Self {
        let back = |line: &[f64]| line.iter().rev().copied().collect();
        let [warp, weft] = lines_um.map(about_mean);
        let strokes_um = [warp.clone(), back(&warp), weft.clone(), back(&weft)];
        Self {
            strokes_um,
            step_mm: [step_mm; 2],
            patch,
            area: None,
            measured: Vec::new(),
        }
    }

    /// Strokes that a probe made over a map.
    pub(crate) fn of_strokes(strokes: &ProfileSet, patch: HeightMap) -> Self {
        let heights = |index: usize| {
            let profile = strokes[index].as_ref();
            profile.map_or_else(Vec::new, |profile| profile.heights_um().to_vec())
        };
        Self {
            strokes_um: Direction::ALL.map(|direction| heights(direction.index())),
            step_mm: patch.step_mm(),
            patch,
            area: None,
            measured: Vec::new(),
        }
    }
}

impl Model for SurfaceSample {
    fn strokes_um(&self) -> ([Vec<f64>; 4], [f64; 2]) {
        (self.strokes_um.clone(), self.step_mm)
    }

    fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        self.area.clone().map(Ok)
    }

    fn relief(&self, _step_mm: f64) -> Result<HeightMap, SurfaceError> {
        Ok(self.patch.clone())
    }

    /// The relief of the patch lit from the upper left, one pixel a point.
    fn picture(&self) -> (Rgb8Image, f64) {
        (lit(self.patch.heights_um()), 1.0 / self.patch.step_mm()[0])
    }

    fn measured(&self) -> &[(&'static str, f64)] {
        &self.measured
    }
}

/// Heights about their mean.
fn about_mean(mut heights_um: Vec<f64>) -> Vec<f64> {
    let mean = heights_um.iter().sum::<f64>() / heights_um.len().max(1) as f64;
    for height in &mut heights_um {
        *height -= mean;
    }
    heights_um
}

/// Every `stride`-th point of a map, so that a picture of it stays small.
pub(crate) fn thinned(map: &HeightMap, stride: usize) -> Option<HeightMap> {
    let heights = map.heights_um();
    let (width, stride) = (heights.width().div_ceil(stride.max(1)), stride.max(1));
    let rows = (0..heights.height()).step_by(stride);
    let values = rows.flat_map(|row| heights.row(row).iter().step_by(stride).copied());
    let grid = Grid::from_rows(width, values.collect())?;
    let step_mm = map.step_mm().map(|step| step * stride as f64);
    HeightMap::new(grid, step_mm).ok()
}

/// How bright the slope that nine of ten do not exceed is over the level.
const CONTRAST: f64 = 70.0;
/// Brightness of the level.
const GREY: f64 = 150.0;
/// Steps that grey is rounded to: what the eye does not see, the file need not hold.
const GREY_STEP: f64 = 6.0;

/// A relief in grey: its slope towards the upper left, scaled to its own usual slope.
pub fn lit(heights_um: &Grid<f64>) -> Rgb8Image {
    let (width, height) = (heights_um.width(), heights_um.height());
    let mut slopes = Vec::with_capacity(width * height);
    for row in (0..height).rev() {
        // A surface need not fit its other side: the last slope is the one before it.
        let low = row.min(height.saturating_sub(2));
        let (here, below) = (heights_um.row(row), heights_um.row(low));
        let above = heights_um.row((low + 1).min(height - 1));
        for column in 0..width {
            let left = column.min(width.saturating_sub(2));
            let across = here[(left + 1).min(width - 1)] - here[left];
            slopes.push(across - (above[column] - below[column]));
        }
    }
    let mut sizes: Vec<f64> = slopes.iter().map(|slope| slope.abs()).collect();
    let usual = quantile(&mut sizes, 0.9).max(f64::MIN_POSITIVE);
    let grey = |slope: &f64| {
        let grey = GREY + CONTRAST * (slope / usual).clamp(-2.0, 1.5);
        [to_byte((grey / GREY_STEP).round() * GREY_STEP); 3]
    };
    Rgb8Image {
        width,
        height,
        pixels: slopes.iter().map(grey).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_goes_back_over_what_it_went_over() {
        let grid = Grid::from_rows(4, (0..16).map(f64::from).collect()).unwrap();
        let patch = HeightMap::new(grid, [0.1, 0.1]).unwrap();
        let sample = SurfaceSample::of_lines([vec![1.0, 2.0, 6.0], vec![0.0; 3]], 0.1, patch);
        assert_eq!(sample.strokes_um[0], [-2.0, -1.0, 3.0]);
        assert_eq!(sample.strokes_um[1], [3.0, -1.0, -2.0]);
        let (picture, px_per_mm) = sample.picture();
        assert_eq!((picture.width, picture.height, px_per_mm), (4, 4, 10.0));
        let thin = thinned(&sample.patch, 2).unwrap();
        assert_eq!(thin.heights_um().values(), [0.0, 2.0, 8.0, 10.0]);
        assert_eq!(thin.step_mm(), [0.2, 0.2]);
    }
}
