//! Shape from shading: golden numbers, truths that are known, and extremes.

mod extremes;
mod published;
mod textile;
mod truths;

use std::f64::consts::{PI, TAU};

use super::*;
use selvedge_foundation::progress::Progress;

/// Points of a fine relief to a pixel's side.
const FINE: usize = 4;

/// Heights in px over `n` × `n` px, by a function of the place in repeats (0…1 each way).
struct Truth {
    fine: Grid<f64>,
}

impl Truth {
    fn of(n: usize, height_px: impl Fn(f64, f64) -> f64) -> Self {
        let m = n * FINE;
        let at = |i: usize| (i as f64 + 0.5) / m as f64;
        let rows = (0..m).flat_map(|row| (0..m).map(move |column| (row, column)));
        let values = rows.map(|(row, column)| height_px(at(column), at(row)));
        let fine = Grid::from_rows(m, values.collect()).unwrap();
        Self { fine }
    }

    /// A plain weave of two by two yarns that touch: cosine paths, parabolic sections.
    fn plain_weave(n: usize, rise: f64, section: f64) -> Self {
        let pitch = n as f64 / 2.0;
        let sign = |t: f64| {
            if (t * 2.0).floor() % 2.0 == 0.0 {
                1.0
            } else {
                -1.0
            }
        };
        let arch = |t: f64| section * (1.0 - (2.0 * ((t * 2.0).fract() - 0.5)).powi(2));
        Self::of(n, |x, y| {
            let warp = rise * (TAU * y).sin() * sign(x) + arch(x);
            let weft = -rise * (TAU * x).sin() * sign(y) + arch(y);
            pitch * warp.max(weft)
        })
    }

    fn egg_crate(n: usize, amplitude_px: f64) -> Self {
        Self::of(n, |x, y| {
            amplitude_px * (2.0 * TAU * x).sin() * (2.0 * TAU * y).sin()
        })
    }

    fn height_px(&self) -> Grid<f64> {
        about_mean(&averaged(&self.fine))
    }

    /// Its picture: slopes by differences of the fine relief, pixels as means of what is in them.
    fn picture(&self, slant_deg: f64, tilt_deg: f64) -> Grid<f64> {
        let (slant, tilt) = (slant_deg * PI / 180.0, tilt_deg * PI / 180.0);
        let to_light = [
            slant.sin() * tilt.cos(),
            slant.sin() * tilt.sin(),
            slant.cos(),
        ];
        let m = self.fine.width();
        let z = |row: usize, column: usize| self.fine.row(row % m)[column % m];
        let mut bright = self.fine.clone();
        for row in 0..m {
            for column in 0..m {
                let step = 2.0 / FINE as f64;
                let p = (z(row, column + 1) - z(row, column + m - 1)) / step;
                let q = (z(row + 1, column) - z(row + m - 1, column)) / step;
                let normal = [-p, -q, 1.0];
                let length = (1.0 + p * p + q * q).sqrt();
                let facing: f64 = normal.iter().zip(&to_light).map(|(a, b)| a * b).sum();
                bright.row_mut(row)[column] = (facing / length).max(0.0);
            }
        }
        averaged(&bright)
    }
}

fn averaged(fine: &Grid<f64>) -> Grid<f64> {
    let n = fine.width() / FINE;
    let mut coarse = Grid::filled(n, n, 0.0);
    for row in 0..n * FINE {
        for (column, value) in fine.row(row).iter().enumerate() {
            coarse.row_mut(row / FINE)[column / FINE] += value / (FINE * FINE) as f64;
        }
    }
    coarse
}

/// Correlation of two grids.
pub(crate) fn correlation(a: &Grid<f64>, b: &Grid<f64>) -> f64 {
    let [a, b] = [a, b].map(about_mean);
    let dot = |a: &Grid<f64>, b: &Grid<f64>| -> f64 {
        a.values().iter().zip(b.values()).map(|(a, b)| a * b).sum()
    };
    dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt()
}

fn light(slant_deg: f64, tilt_deg: f64) -> Light {
    Light {
        slant_deg,
        tilt_deg,
    }
}

fn with(method: Method) -> ShadingOptions {
    ShadingOptions {
        method,
        ..ShadingOptions::default()
    }
}

fn shape(brightness: &Grid<f64>, from: Light, method: Method) -> Result<Shape, ShadingError> {
    Progress::unheard(|progress| Shape::from_shading(brightness, from, &with(method), progress))
}
