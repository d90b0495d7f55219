//! Pentland, "Linear shape from shading", International Journal of Computer Vision 4, 1990: to
//! first order in the slopes the brightness over its mean is `1 − p·l_x − q·l_y`, so that its
//! transform is `F = H·Z` with `H = −i(l_x k_x + l_y k_y)`, and `Z = H* F / (|H|² + ε)`.
//!
//! Wave vectors across the light have H = 0: a linear picture does not show them.

use std::f64::consts::TAU;

use super::View;
use super::reflectance::residual_of;
use super::shape::{Blind, Found, Method, ShadingOptions, mean};
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform};

/// The regulariser unless stated.
const REGULARISER: f64 = 0.1;

/// H of every wave vector of a half transform, by pictures, and ε.
struct Weights {
    h: Vec<Grid<f64>>,
    epsilon: f64,
}

impl Weights {
    fn of(views: &[View<'_>], options: &ShadingOptions) -> Self {
        let (width, height) = size_of(views);
        let h_of = |&(_, light): &View<'_>| {
            let lean = light.lean();
            Grid::from_fn(width / 2 + 1, height, |column, row| {
                -(lean[0] * wavenumber(column, width) + lean[1] * wavenumber(row, height))
            })
        };
        let h = views.iter().map(h_of).collect();
        let lean = views.first().map_or([0.0; 2], |view| view.1.lean());
        // The variational method's regulariser is of another kind.
        let stated = options.regulariser;
        let is_linear = options.method == Method::Linear;
        let share = stated.filter(|_| is_linear).unwrap_or(REGULARISER);
        let once = lean[0].hypot(lean[1]) * TAU / width.max(height) as f64;
        let epsilon = (share * once) * (share * once);
        Self { h, epsilon }
    }

    /// The sum of |H|² over the pictures.
    fn squares(&self, row: usize, column: usize) -> f64 {
        self.h.iter().map(|h| h.row(row)[column].powi(2)).sum()
    }
}

fn size_of(views: &[View<'_>]) -> (usize, usize) {
    let first = views.first();
    first.map_or((0, 0), |(e, _)| (e.width(), e.height()))
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

/// Heights by the linear inversion of all pictures together, px: `Σ H* F / (Σ |H|² + ε)`.
pub(super) fn heights(views: &[View<'_>], options: &ShadingOptions) -> Grid<f64> {
    let (width, height) = size_of(views);
    let transform = PlaneTransform::new(width, height);
    let weights = Weights::of(views, options);
    let mut sum = Grid::filled(width / 2 + 1, height, Complex::default());
    for ((brightness, _), h) in views.iter().zip(&weights.h) {
        let spectrum = contrast(brightness, &transform);
        let pairs = spectrum.values().iter().zip(h.values());
        for (sum, (f, h)) in sum.values_mut().iter_mut().zip(pairs) {
            *sum += Complex::new(0.0, -h) * f;
        }
    }
    for row in 0..height {
        for (column, f) in sum.row_mut(row).iter_mut().enumerate() {
            *f /= weights.squares(row, column) + weights.epsilon;
        }
    }
    transform.inverse(sum)
}

pub(super) fn solve(views: &[View<'_>], albedo: f64, options: &ShadingOptions) -> Found {
    let height_px = heights(views, options);
    let flat = height_px.map(|_| 0.0);
    let residuals = [&flat, &height_px].map(|z| residual_of(views, albedo, z));
    Found {
        height_px,
        albedo,
        residuals: residuals.to_vec(),
        n_rounds: 0,
    }
}

/// What the lights cannot show of a tile, by the first picture.
pub(super) fn blind(views: &[View<'_>], options: &ShadingOptions) -> Blind {
    let (width, height) = size_of(views);
    let Some((brightness, _)) = views.first() else {
        return Blind::default();
    };
    let spectrum = contrast(brightness, &PlaneTransform::new(width, height));
    let weights = Weights::of(views, options);
    let [mut n, mut n_blind, mut energy, mut blind] = [0.0_f64; 4];
    for row in 0..height {
        for (column, f) in spectrum.row(row).iter().enumerate() {
            if row == 0 && column == 0 {
                continue;
            }
            // Columns within stand for those of the other half too.
            let is_own = column == 0 || 2 * column == width;
            let count = if is_own { 1.0 } else { 2.0 };
            let power = count * f.norm_sqr();
            n += count;
            energy += power;
            if weights.squares(row, column) < weights.epsilon {
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
