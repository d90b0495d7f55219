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
    let n = z.width();
    let mut slopes = Grid::filled(n, z.height(), 0.0);
    for row in 0..z.height() {
        let (from, to) = (z.row(row), slopes.row_mut(row));
        for (slope, three) in to.iter_mut().skip(1).zip(from.windows(3)) {
            *slope = 0.5 * (three[2] - three[0]);
        }
        for end in [0, n - 1] {
            to[end] = 0.5 * (from[after(end, n)] - from[before(end, n)]);
        }
    }
    slopes
}

/// Central differences across rows, a px.
pub(super) fn across(z: &Grid<f64>) -> Grid<f64> {
    let n = z.height();
    Grid::from_fn(z.width(), n, |column, row| {
        0.5 * (z.row(after(row, n))[column] - z.row(before(row, n))[column])
    })
}

/// The sum of the four neighbours less four times the point.
pub(super) fn laplacian(z: &Grid<f64>) -> Grid<f64> {
    let (width, height) = (z.width(), z.height());
    let mut bent = Grid::filled(width, height, 0.0);
    for row in 0..height {
        let (here, to) = (z.row(row), bent.row_mut(row));
        for (value, three) in to.iter_mut().skip(1).zip(here.windows(3)) {
            *value = three[0] + three[2] - 4.0 * three[1];
        }
        for end in [0, width - 1] {
            to[end] = here[before(end, width)] + here[after(end, width)] - 4.0 * here[end];
        }
        let pairs = z
            .row(after(row, height))
            .iter()
            .zip(z.row(before(row, height)));
        for (value, (above, below)) in to.iter_mut().zip(pairs) {
            *value += above + below;
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
