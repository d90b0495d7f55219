//! Dark is deep (after Langer & Zucker 1994, who look at light from all of the sky): the bottom of
//! a gap sees little of the light, so that brightness follows height, not slope.
//!
//! Occlusion alone gives an order of heights, no law: `z = (E/mean)^power`, whose power says how
//! soon gaps turn dark. Heights have no scale of their own.

use super::shape::{Found, ShadingOptions, mean};
use selvedge_foundation::numerics::Grid;

pub(super) fn solve(brightness: &Grid<f64>, options: &ShadingOptions) -> Found {
    let level = mean(brightness);
    let power = options.regulariser.unwrap_or(1.0);
    let contrast: f64 = brightness
        .values()
        .iter()
        .map(|e| (e / level - 1.0).abs())
        .sum();
    Found {
        height_px: brightness.map(|e| (e / level).powf(power)),
        albedo: level,
        // Any picture is explained wholly, which is why this says nothing for the model.
        residuals: vec![contrast / brightness.values().len() as f64, 0.0],
        n_rounds: 0,
    }
}
