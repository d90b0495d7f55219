//! How bright a matt slope is, and the slopes of a tile that repeats.

use crate::numerics::Grid;

use super::Light;

/// A matt (Lambertian) surface of albedo 1 under a distant light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lambert {
    lean: [f64; 2],
    norm: f64,
}

impl Lambert {
    pub(super) fn under(light: Light) -> Self {
        let lean = light.lean();
        let norm = (1.0 + lean[0] * lean[0] + lean[1] * lean[1]).sqrt();
        Self { lean, norm }
    }

    /// Brightness of slopes p, q; below 0 where the surface turns away from the light.
    pub(super) fn of(&self, p: f64, q: f64) -> f64 {
        let facing = 1.0 - p * self.lean[0] - q * self.lean[1];
        facing / ((1.0 + p * p + q * q).sqrt() * self.norm)
    }

    /// Brightness and its derivatives by p and q; both 0 where it is dark.
    pub(super) fn with_slopes(&self, p: f64, q: f64) -> [f64; 3] {
        let g = 1.0 + p * p + q * q;
        let bright = self.of(p, q);
        if bright <= 0.0 {
            return [0.0; 3];
        }
        let scale = 1.0 / (g.sqrt() * self.norm);
        [
            bright,
            -self.lean[0] * scale - bright * p / g,
            -self.lean[1] * scale - bright * q / g,
        ]
    }
}

/// Central differences along rows, a px.
pub(super) fn along(z: &Grid<f64>) -> Grid<f64> {
    let n = z.width();
    let mut slopes = Grid::filled(n, z.height(), 0.0);
    for row in 0..z.height() {
        let from = z.row(row);
        for (column, slope) in slopes.row_mut(row).iter_mut().enumerate() {
            *slope = 0.5 * (from[after(column, n)] - from[before(column, n)]);
        }
    }
    slopes
}

/// Central differences across rows, a px.
pub(super) fn across(z: &Grid<f64>) -> Grid<f64> {
    let n = z.height();
    let mut slopes = Grid::filled(z.width(), n, 0.0);
    for row in 0..n {
        let pairs = z.row(after(row, n)).iter().zip(z.row(before(row, n)));
        for (slope, (above, below)) in slopes.row_mut(row).iter_mut().zip(pairs) {
            *slope = 0.5 * (above - below);
        }
    }
    slopes
}

/// The sum of the four neighbours less four times the point.
pub(super) fn laplacian(z: &Grid<f64>) -> Grid<f64> {
    let (width, height) = (z.width(), z.height());
    let mut bent = Grid::filled(width, height, 0.0);
    for row in 0..height {
        let (here, above) = (z.row(row), z.row(after(row, height)));
        let below = z.row(before(row, height));
        for (column, value) in bent.row_mut(row).iter_mut().enumerate() {
            let beside = here[after(column, width)] + here[before(column, width)];
            *value = beside + above[column] + below[column] - 4.0 * here[column];
        }
    }
    bent
}

pub(super) fn before(i: usize, n: usize) -> usize {
    (i + n - 1) % n
}

pub(super) fn after(i: usize, n: usize) -> usize {
    (i + 1) % n
}

/// The mean of |E/a − R| of heights in px.
pub(super) fn residual(target: &Grid<f64>, albedo: f64, z: &Grid<f64>, matt: Lambert) -> f64 {
    let (p, q) = (along(z), across(z));
    let slopes = p.values().iter().zip(q.values());
    let pairs = target.values().iter().zip(slopes);
    let sum: f64 = pairs
        .map(|(e, (p, q))| (e / albedo - matt.of(*p, *q).max(0.0)).abs())
        .sum();
    sum / target.values().len() as f64
}
