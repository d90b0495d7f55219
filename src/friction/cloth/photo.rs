//! The picture of a cloth: light from one side, shade in the depths, a print that has nothing to do
//! with the heights, the camera's blur and noise.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::{Grid, Random, to_single};

use super::noise::{bell, smooth};
use super::{Area, PER_MM, Recipe};

/// Light, print and camera of one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    /// Where the light comes from, radians from +x, and how high it stands.
    pub azimuth: f64,
    /// Height of the light above the cloth, radians.
    pub elevation: f64,
    /// Standard deviation of the blur, pixels.
    pub blur_px: f64,
    /// Standard deviation of the noise, share of full white.
    pub noise: f64,
    /// How strong the print is, 0 to 1.
    pub print: f64,
    /// How large the print is, mm.
    pub print_mm: f64,
    /// Whether the print is stripes, or else blots.
    pub is_striped: bool,
    /// Mean brightness, 0 to 1.
    pub exposure: f64,
    /// What print and noise are drawn from.
    pub seed: u64,
}

impl Camera {
    /// The camera of a seed. Two of three cloths have no print.
    pub(crate) fn of(seed: u64) -> Self {
        let mut random = Random::new(seed).branch("camera");
        let mut between = |low: f64, high: f64| random.uniform_in(low, high);
        Self {
            azimuth: between(0.0, TAU),
            elevation: between(0.35, 1.0),
            blur_px: between(0.2, 1.2),
            noise: between(0.004, 0.03),
            print: (between(-2.0, 1.0)).max(0.0),
            print_mm: between(1.0, 15.0),
            is_striped: between(0.0, 1.0) < 0.5,
            exposure: between(0.3, 0.65),
            seed,
        }
    }

    /// How much light the print takes at a place, mm.
    fn ink(&self, x: f64, y: f64) -> f64 {
        if self.print == 0.0 {
            return 0.0;
        }
        let [x, y] = [x, y].map(|place| place / self.print_mm);
        let wave = if self.is_striped {
            let (sin, cos) = (self.azimuth + 1.0).sin_cos();
            (TAU * (cos * x + sin * y)).sin()
        } else {
            2.0 * smooth(self.seed ^ 0x1ac, x, y)
        };
        0.5 * self.print * (0.5 + 0.5 * wave.clamp(-1.0, 1.0))
    }
}

impl Recipe {
    /// The picture of a part with these heights, brightness 0 to 1. Near its edges light and blur
    /// know nothing of what lies beyond.
    pub(crate) fn photo(&self, relief_um: &Grid<f32>, area: Area, camera: &Camera) -> Grid<f32> {
        // What light sees of depth: heights against what is around them.
        let reach = 0.5 * self.pitch_mm[0].max(self.pitch_mm[1]) * PER_MM;
        let around = blurred(relief_um, reach.max(1.0));
        let (sin, cos) = camera.azimuth.sin_cos();
        let (up, flat) = camera.elevation.sin_cos();
        let um_per_slope = 2e3 / PER_MM;
        let [[left, _], [below, _]] = [area.columns, area.rows];
        let (n_columns, n_rows) = (relief_um.width(), relief_um.height());
        let lit = Grid::from_fn(n_columns, n_rows, |column, row| {
            let height = |column: usize, row: usize| f64::from(relief_um.row(row)[column]);
            let right = (column + 1).min(n_columns - 1);
            let above = (row + 1).min(n_rows - 1);
            let slope_x =
                (height(right, row) - height(column.saturating_sub(1), row)) / um_per_slope;
            let slope_y =
                (height(column, above) - height(column, row.saturating_sub(1))) / um_per_slope;
            let long = (1.0 + slope_x * slope_x + slope_y * slope_y).sqrt();
            let facing = ((up - flat * (cos * slope_x + sin * slope_y)) / long).max(0.0);
            let depth = f64::from(around.row(row)[column]) - height(column, row);
            let shade = (-depth.max(0.0) / (2.0 * self.crimp_um)).exp();
            let shine = self.lustre * facing.powi(12);
            let place = [left + column, below + row].map(|n| n as f64 / PER_MM);
            let albedo = 1.0 - camera.ink(place[0], place[1]);
            let light = albedo * shade * (0.35 + 0.65 * facing / up) + 0.4 * shine;
            to_single(camera.exposure * light)
        });
        let mut photo = blurred(&lit, camera.blur_px);
        for row in 0..n_rows {
            for (column, value) in photo.row_mut(row).iter_mut().enumerate() {
                let grain = bell(
                    camera.seed ^ 0x9a1,
                    (left + column).cast_signed() as i64,
                    (below + row).cast_signed() as i64,
                );
                let seen = f64::from(*value) + camera.noise * grain;
                // A picture has 256 shades.
                *value = to_single((255.0 * seen.clamp(0.0, 1.0)).round() / 255.0);
            }
        }
        photo
    }
}

/// A grid blurred by a Gauss curve of a standard deviation in pixels, its edges continued.
pub(super) fn blurred(grid: &Grid<f32>, sd_px: f64) -> Grid<f32> {
    let reach = selvedge_foundation::numerics::to_index((3.0 * sd_px).ceil()).min(64);
    let weight = |n: usize| (-0.5 * (n as f64 / sd_px.max(1e-6)).powi(2)).exp();
    let half: Vec<f64> = (0..=reach).map(weight).collect();
    let sum: f64 = half[0] + 2.0 * half[1..].iter().sum::<f64>();
    let kernel: Vec<f32> = half.iter().map(|w| to_single(w / sum)).collect();
    let along = |value: &dyn Fn(usize) -> f32, at: usize, n: usize| {
        let mut total = kernel[0] * value(at);
        for (k, weight) in kernel.iter().enumerate().skip(1) {
            total += weight * (value(at.saturating_sub(k)) + value((at + k).min(n - 1)));
        }
        total
    };
    let (width, height) = (grid.width(), grid.height());
    let rows = Grid::from_fn(width, height, |column, row| {
        along(&|at| grid.row(row)[at], column, width)
    });
    Grid::from_fn(width, height, |column, row| {
        along(&|at| rows.row(at)[column], row, height)
    })
}
