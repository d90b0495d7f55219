//! Pentland, "Linear shape from shading", International Journal of Computer Vision 4, 1990: to
//! first order in the slopes the brightness over its mean is `1 − p·l_x − q·l_y`, so that its
//! transform is `F = H·Z` with `H = −i(l_x k_x + l_y k_y)`, and `Z = H* F / (|H|² + ε)`.
//!
//! Wave vectors across the light have H = 0: a linear picture does not show them.

use std::f64::consts::TAU;

use super::Light;
use super::reflectance::{Lambert, residual};
use super::shape::{Blind, Found, Method, ShadingOptions, mean};
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform};

/// The regulariser unless stated.
const REGULARISER: f64 = 0.1;

/// H of every wave vector of a half transform, and ε.
struct Weights {
    h: Grid<f64>,
    epsilon: f64,
}

impl Weights {
    fn of(brightness: &Grid<f64>, light: Light, options: &ShadingOptions) -> Self {
        let (width, height) = (brightness.width(), brightness.height());
        let lean = light.lean();
        let h = Grid::from_fn(width / 2 + 1, height, |column, row| {
            -(lean[0] * wavenumber(column, width) + lean[1] * wavenumber(row, height))
        });
        // The variational method's regulariser is of another kind.
        let stated = options.regulariser;
        let is_linear = options.method == Method::Linear;
        let share = stated.filter(|_| is_linear).unwrap_or(REGULARISER);
        let once = lean[0].hypot(lean[1]) * TAU / width.max(height) as f64;
        let epsilon = (share * once) * (share * once);
        Self { h, epsilon }
    }
}

/// Wavenumber of bin k of n, rad/px; 0 at the Nyquist bin, where a slope has no sign.
pub(super) fn wavenumber(k: usize, n: usize) -> f64 {
    let cycles = match (2 * k).cmp(&n) {
        std::cmp::Ordering::Less => k as f64,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => k as f64 - n as f64,
    };
    TAU * cycles / n as f64
}

/// The brightness over its mean, less 1, transformed.
fn contrast(brightness: &Grid<f64>, transform: &PlaneTransform) -> Grid<Complex> {
    let level = mean(brightness);
    transform.forward(&brightness.map(|e| e / level - 1.0))
}

/// Heights by the linear inversion, px.
pub(super) fn heights(brightness: &Grid<f64>, light: Light, options: &ShadingOptions) -> Grid<f64> {
    let transform = PlaneTransform::new(brightness.width(), brightness.height());
    let mut spectrum = contrast(brightness, &transform);
    let weights = Weights::of(brightness, light, options);
    let pairs = spectrum.values_mut().iter_mut().zip(weights.h.values());
    for (f, h) in pairs {
        *f = Complex::new(0.0, -h) * *f / (h * h + weights.epsilon);
    }
    transform.inverse(spectrum)
}

pub(super) fn solve(brightness: &Grid<f64>, light: Light, options: &ShadingOptions) -> Found {
    let height_px = heights(brightness, light, options);
    let albedo = options.albedo_for(brightness, light);
    let flat = Grid::filled(brightness.width(), brightness.height(), 0.0);
    let matt = Lambert::under(light);
    let residuals = [&flat, &height_px].map(|z| residual(brightness, albedo, z, matt));
    Found {
        height_px,
        albedo,
        residuals: residuals.to_vec(),
        n_rounds: 0,
    }
}

/// What the light cannot show of a tile.
pub(super) fn blind(brightness: &Grid<f64>, light: Light, options: &ShadingOptions) -> Blind {
    let (width, height) = (brightness.width(), brightness.height());
    let spectrum = contrast(brightness, &PlaneTransform::new(width, height));
    let weights = Weights::of(brightness, light, options);
    let [mut n, mut n_blind, mut energy, mut blind] = [0.0_f64; 4];
    for row in 0..height {
        let pairs = spectrum.row(row).iter().zip(weights.h.row(row));
        for (column, (f, h)) in pairs.enumerate() {
            if row == 0 && column == 0 {
                continue;
            }
            // Columns within stand for those of the other half too.
            let is_own = column == 0 || 2 * column == width;
            let count = if is_own { 1.0 } else { 2.0 };
            let power = count * f.norm_sqr();
            n += count;
            energy += power;
            if h * h < weights.epsilon {
                n_blind += count;
                blind += power;
            }
        }
    }
    let share = |part: f64, whole: f64| if whole > 1e-18 { part / whole } else { 0.0 };
    Blind {
        share_of_vectors: share(n_blind, n),
        share_of_energy: share(blind, energy),
    }
}
