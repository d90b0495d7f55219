//! Shape from shading: heights of one repeat of a surface from its brightness under one light.
//!
//! A matt surface z(x, y) with slopes p, q under a distant light is as bright as
//! `R = a·max(0, 1 − p·l_x − q·l_y) / (√(1 + p² + q²)·√(1 + l²))`, where `l` = tan(slant)·(cos
//! tilt, sin tilt) and a the albedo. Three methods find z from E = R, a fourth takes E for z:
//!
//! - [`Method::TsaiShah`]: Tsai & Shah (1994) as published, a local scheme, here for comparison;
//! - [`Method::Linear`]: Pentland (1990), R to first order, one division of Fourier transforms;
//! - [`Method::Variational`]: R as it is, least squares with a smoothness, from the linear one on;
//! - [`Method::DarkIsDeep`]: light from all sides, which gaps between yarns keep out.
//!
//! Which of both models a picture speaks for, and under which light: [`Evidence`]; what pictures of
//! the cloth turned under one lamp say of both: [`Turns`].
//!
//! # Invariants
//! - x runs along rows, y across them; **row 0 is the lowest y** as in height maps, so pictures,
//!   whose rows come from the top, are turned over first ([`Grid::turned_over`])
//! - the tile repeats both ways; heights are in pixels, about their mean
//! - same brightness, same options, same bytes; every height is finite

mod coarse;
mod depth;
mod error;
mod evidence;
mod light;
mod linear;
mod reflectance;
mod reliability;
mod shape;
mod tangent;
#[cfg(test)]
pub(crate) mod tests;
mod tsai_shah;
mod turns;
mod variational;

pub use error::ShadingError;
pub(crate) use evidence::Evidence;
pub(crate) use light::View;
pub use light::{Light, LightEstimate};
pub use reflectance::picture_of;
pub use shape::{Edges, Method, ShadingOptions, Shape};
pub(crate) use turns::Turns;

use std::f64::consts::TAU;

use crate::tactile::{Band, LEVEL_SPEED_MM_PER_S};
use error::MAX_POINTS;
use selvedge_foundation::numerics::{Grid, PlaneTransform};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::factor_of_gain;
use shape::{MAX_ITERATIONS, about_mean, mean, mean_of};

impl Shape {
    /// Heights from brightness 0…1 under a light; row 0 is the lowest y.
    ///
    /// # Errors
    /// Brightness that is empty, too large, outside 0…1 or black; a light that the method cannot
    /// use; options out of range; cancelled.
    pub fn from_shading(
        brightness: &Grid<f64>,
        light: Light,
        options: &ShadingOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ShadingError> {
        Self::from_views(&[(brightness, light)], options, progress)
    }

    /// Heights of a surface that was taken under several lights; the same place at the same point,
    /// as bright on the mean.
    ///
    /// What all pictures agree in is albedo, point by point. Dark is deep takes their mean; Tsai &
    /// Shah's iteration takes the first alone.
    ///
    /// # Errors
    /// As [`Self::from_shading`]; no picture.
    pub(crate) fn from_views(
        views: &[View<'_>],
        options: &ShadingOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ShadingError> {
        let &(brightness, light) = views.first().ok_or(ShadingError::Empty)?;
        for (brightness, light) in views {
            check(brightness, options)?;
            light.check()?;
        }
        let is_singular = options.method == Method::TsaiShah && tsai_shah::is_singular(light);
        if is_singular {
            return Err(ShadingError::Singular);
        }
        if light.is_frontal() && Method::OF_SHADING.contains(&options.method) {
            return Err(ShadingError::Frontal {
                slant_deg: light.slant_deg,
            });
        }
        progress.step(0.0, "shape from shading")?;
        let found = match options.method {
            Method::TsaiShah => tsai_shah::solve(brightness, light, options, progress)?,
            Method::Linear => {
                let albedo = options.albedo_for(brightness, light);
                linear::solve(views, albedo, options)
            }
            Method::Variational => variational::solve(views, options, progress)?,
            Method::DarkIsDeep => depth::solve(&mean_of(views, brightness), options),
        };
        let blind = linear::blind(views, options);
        progress.step(1.0, "shape from shading")?;
        Ok(Self {
            height_px: about_mean(&found.height_px),
            method: options.method,
            light,
            albedo: found.albedo,
            residuals: found.residuals,
            n_rounds: found.n_rounds,
            blind,
            reliability: reliability::words(options.method, light, blind),
        })
    }

    /// The share of the pictures' variance that it leaves when they are drawn again, self-shadow
    /// and all, by shading; by dark is deep, nothing.
    pub(crate) fn unexplained(&self, views: &[View<'_>]) -> f64 {
        if !Method::OF_SHADING.contains(&self.method) {
            return 0.0;
        }
        let mut sums = [0.0, 1e-12];
        for &(brightness, light) in views {
            let level = mean(brightness);
            let drawn = picture_of(&self.height_px, light);
            let pairs = brightness.values().iter().zip(drawn.values());
            sums = pairs.fold(sums, |[left, all], (e, r)| {
                [
                    left + (e - self.albedo * r).powi(2),
                    all + (e - level).powi(2),
                ]
            });
        }
        sums[0] / sums[1]
    }

    /// The same relief with its waves by gains of warp (x) and weft (y) at 40 and 320 Hz, dB, as
    /// waves of 2.5 and 0.31 mm sound at the standard speed: between them in proportion to the
    /// octaves, and from axis to axis by `cos²` of the angle.
    #[must_use]
    pub(crate) fn weighed(&self, step_mm: [f64; 2], gains_db: [[f64; 2]; 2]) -> Self {
        let (width, height) = (self.height_px.width(), self.height_px.height());
        let transform = PlaneTransform::new(width, height);
        let mut spectrum = transform.forward(&self.height_px);
        let ends = Band::ALL.map(|band| (band.carrier_hz() / LEVEL_SPEED_MM_PER_S).log2());
        for row in 0..height {
            let y = linear::wavenumber(row, height) / step_mm[1];
            for (column, f) in spectrum.row_mut(row).iter_mut().enumerate() {
                let x = linear::wavenumber(column, width) / step_mm[0];
                let square = (x * x + y * y).max(f64::MIN_POSITIVE);
                let octave = (square.sqrt() / TAU).log2();
                let share = ((octave - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0);
                let [warp, weft] = gains_db.map(|[low, high]| low + (high - low) * share);
                let gain_db = (warp * x * x + weft * y * y) / square;
                *f *= factor_of_gain(gain_db);
            }
        }
        Self {
            height_px: transform.inverse(spectrum),
            ..self.clone()
        }
    }
}

fn check(brightness: &Grid<f64>, options: &ShadingOptions) -> Result<(), ShadingError> {
    let (width, height) = (brightness.width(), brightness.height());
    if brightness.values().is_empty() {
        return Err(ShadingError::Empty);
    }
    if width.saturating_mul(height) > MAX_POINTS {
        return Err(ShadingError::TooLarge { width, height });
    }
    let values = brightness.values();
    if let Some(place) = values.iter().position(|e| !(0.0..=1.0).contains(e)) {
        return Err(ShadingError::Brightness {
            row: place / width + 1,
            column: place % width + 1,
            value: values[place],
        });
    }
    if mean(brightness) < 1e-9 {
        return Err(ShadingError::Black);
    }
    let numbers = [
        ("the albedo", options.albedo, 1e-3..=1e3, "0.001 to 1000"),
        (
            "the regulariser",
            options.regulariser,
            1e-9..=1e3,
            "1e-9 to 1000",
        ),
    ];
    for (key, value, allowed, range) in numbers {
        if let Some(value) = value.filter(|value| !allowed.contains(value)) {
            return Err(ShadingError::Option { key, value, range });
        }
    }
    let n = options.n_iterations();
    if (1..=MAX_ITERATIONS).contains(&n) {
        return Ok(());
    }
    Err(ShadingError::Option {
        key: "the number of iterations",
        value: n as f64,
        range: "1 to 10000",
    })
}
