//! How bright a matt slope is, and the slopes of a tile that repeats.

use selvedge_foundation::numerics::Grid;

use super::{Light, View};

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

/// How bright a tile of heights (px) is under a light, 0…1, albedo 1: the forward problem, which a
/// residual or a study is set beside. Slopes are central differences; nothing casts a shadow.
pub fn picture_of(height_px: &Grid<f64>, light: Light) -> Grid<f64> {
    let matt = Lambert::under(light);
    let (mut bright, q) = (along(height_px), across(height_px));
    for (value, q) in bright.values_mut().iter_mut().zip(q.values()) {
        *value = matt.of(*value, *q).max(0.0);
    }
    bright
}

/// Central differences along rows, a px.
pub(super) fn along(z: &Grid<f64>) -> Grid<f64> {
    of_rows(z, along_row)
}

/// Central differences across rows, a px.
pub(super) fn across(z: &Grid<f64>) -> Grid<f64> {
    of_rows(z, across_row)
}

/// The sum of the four neighbours less four times the point.
pub(super) fn laplacian(z: &Grid<f64>) -> Grid<f64> {
    of_rows(z, laplacian_row)
}

fn of_rows(z: &Grid<f64>, of: impl Fn(&Grid<f64>, usize, &mut [f64])) -> Grid<f64> {
    let mut all = Grid::filled(z.width(), z.height(), 0.0);
    for row in 0..z.height() {
        of(z, row, all.row_mut(row));
    }
    all
}

/// One row of [`along`].
pub(super) fn along_row(z: &Grid<f64>, row: usize, slopes: &mut [f64]) {
    let (from, n) = (z.row(row), z.width());
    for (slope, three) in slopes.iter_mut().skip(1).zip(from.windows(3)) {
        *slope = 0.5 * (three[2] - three[0]);
    }
    for end in [0, n - 1] {
        slopes[end] = 0.5 * (from[after(end, n)] - from[before(end, n)]);
    }
}

/// One row of [`across`].
pub(super) fn across_row(z: &Grid<f64>, row: usize, slopes: &mut [f64]) {
    let n = z.height();
    let pairs = z.row(after(row, n)).iter().zip(z.row(before(row, n)));
    for (slope, (above, below)) in slopes.iter_mut().zip(pairs) {
        *slope = 0.5 * (above - below);
    }
}

/// One row of [`laplacian`].
pub(super) fn laplacian_row(z: &Grid<f64>, row: usize, bent: &mut [f64]) {
    let (here, width, height) = (z.row(row), z.width(), z.height());
    for (value, three) in bent.iter_mut().skip(1).zip(here.windows(3)) {
        *value = three[0] + three[2] - 4.0 * three[1];
    }
    for end in [0, width - 1] {
        bent[end] = here[before(end, width)] + here[after(end, width)] - 4.0 * here[end];
    }
    let [above, below] = [after(row, height), before(row, height)].map(|row| z.row(row));
    for (value, (above, below)) in bent.iter_mut().zip(above.iter().zip(below)) {
        *value += above + below;
    }
}

pub(super) fn before(i: usize, n: usize) -> usize {
    (i + n - 1) % n
}

pub(super) fn after(i: usize, n: usize) -> usize {
    (i + 1) % n
}

/// The mean of |E/a − R| of heights in px, over all pictures.
pub(super) fn residual_of(views: &[View<'_>], albedo: f64, z: &Grid<f64>) -> f64 {
    let (p, q) = (along(z), across(z));
    let of = |&(e, light): &View<'_>| residual(e, albedo, [&p, &q], Lambert::under(light));
    views.iter().map(of).sum::<f64>() / views.len().max(1) as f64
}

/// The same of one picture and slopes.
pub(super) fn residual(
    target: &Grid<f64>,
    albedo: f64,
    [p, q]: [&Grid<f64>; 2],
    matt: Lambert,
) -> f64 {
    let slopes = p.values().iter().zip(q.values());
    let pairs = target.values().iter().zip(slopes);
    let sum: f64 = pairs
        .map(|(e, (p, q))| (e / albedo - matt.of(*p, *q).max(0.0)).abs())
        .sum();
    sum / target.values().len() as f64
}
