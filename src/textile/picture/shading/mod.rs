//! Shape from shading: heights of one repeat of a surface from its brightness under one light.
//!
//! A matt surface z(x, y) with slopes p, q under a distant light is as bright as
//! `R = a·max(0, 1 − p·l_x − q·l_y) / (√(1 + p² + q²)·√(1 + l²))`, where `l` = tan(slant)·(cos
//! tilt, sin tilt) and a the albedo. Three methods find z from E = R:
//!
//! - [`Method::TsaiShah`]: Tsai & Shah (1994) as published, a local scheme, here for comparison;
//! - [`Method::Linear`]: Pentland (1990), R to first order, one division of Fourier transforms;
//! - [`Method::Variational`]: R as it is, least squares with a smoothness, from the linear one on.
//!
//! # Invariants
//! - x runs along rows, y across them; **row 0 is the lowest y** as in height maps, so pictures,
//!   whose rows come from the top, are turned over first ([`rows_turned_over`])
//! - the tile repeats both ways; heights are in pixels, about their mean
//! - same brightness, same options, same bytes; every height is finite

mod coarse;
mod light;
mod linear;
mod reflectance;
mod reliability;
mod scale;
mod source;
#[cfg(test)]
mod tests;
mod textile;
mod tsai_shah;
mod variational;

pub use light::{Light, LightEstimate, estimate_light};
pub(crate) use linear::Blind;
pub use reflectance::picture_of;
pub use scale::HeightScale;
pub use scale::Scaled;
pub use scale::{mean_smd_um, scaled};
pub use source::PictureSource;
pub(crate) use textile::to_textile;
pub use textile::{PictureTextile, relief_um_of};
pub use tsai_shah::Edges;

use serde::{Deserialize, Serialize};

use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::{Cancelled, Progress};

/// Most points of a tile: 4096 × 4096.
pub const MOST_POINTS: usize = 1 << 24;

/// How heights are found from brightness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Tsai & Shah's iteration as published.
    TsaiShah,
    /// The linear inversion of Pentland, regularised.
    Linear,
    /// Regularised least squares on the full reflectance.
    #[default]
    Variational,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::TsaiShah, Self::Linear, Self::Variational];

    /// The word that files and commands use.
    pub fn word(self) -> &'static str {
        match self {
            Self::TsaiShah => "tsai-shah",
            Self::Linear => "linear",
            Self::Variational => "variational",
        }
    }

    /// What people read.
    pub fn label(self) -> &'static str {
        match self {
            Self::TsaiShah => "Tsai & Shah",
            Self::Linear => "linear",
            Self::Variational => "variational",
        }
    }

    /// Iterations unless stated.
    pub(crate) fn default_iterations(self) -> usize {
        match self {
            Self::TsaiShah => 50,
            Self::Linear => 1,
            Self::Variational => 16,
        }
    }
}

/// How shape is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShadingOptions {
    /// The method.
    pub method: Method,
    /// Iterations, 1 to [`MOST_ITERATIONS`]; the method's own number unless stated. The linear
    /// inversion takes one; the variational method ends sooner where more would not help.
    pub iterations: Option<usize>,
    /// What Tsai & Shah's differences do at the first row and column; the others always repeat.
    pub edges: Edges,
    /// Brightness of a surface that faces the light. Unless stated it is found: so that the mean
    /// brightness is that of a level surface, and by the variational method fitted from there.
    /// Tsai & Shah's published form takes 1.
    pub albedo: Option<f64>,
    /// What keeps the methods from amplifying what the light does not show. Linear: ε of
    /// `H* F / (|H|² + ε)` is the square of this share of |H| at one cycle a tile along the light
    /// (0.1). Variational: the weight of squared curvature (0.001).
    pub regulariser: Option<f64>,
}

/// Most iterations.
pub(crate) const MOST_ITERATIONS: usize = 10_000;

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Heights, px, about their mean; columns and rows as the brightness has them.
    pub height_px: Grid<f64>,
    /// How they were found.
    pub method: Method,
    /// Under which light.
    pub light: Light,
    /// The albedo used or found.
    pub albedo: f64,
    /// Mean of |E/a − R| over the tile, flat first, then after every iteration.
    pub residuals: Vec<f64>,
    /// Rounds of conjugate gradients that the variational method took, those on coarser tiles by
    /// their share of the points; 0 by the others.
    pub n_rounds: usize,
    /// What the light cannot show.
    pub(crate) blind: Blind,
    /// How far the method can be trusted under this light, in a sentence or two.
    pub reliability: String,
}

impl Shape {
    /// Iterations done.
    pub fn n_iterations(&self) -> usize {
        self.residuals.len().saturating_sub(1)
    }

    /// Whether no relief was found at all.
    pub fn is_flat(&self) -> bool {
        let [low, high] = self.range_px();
        high - low <= 1e-12
    }

    /// Lowest and highest height, px.
    pub fn range_px(&self) -> [f64; 2] {
        let values = self.height_px.values().iter();
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &z| {
            [low.min(z), high.max(z)]
        })
    }
}

/// Why no shape was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// No pixel.
    #[error("the tile has no pixel; give one of at least 1 × 1")]
    Empty,
    /// Too many.
    #[error("{width} × {height} pixels are more than {MOST_POINTS}; scale the picture down")]
    TooLarge {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A brightness that none is.
    #[error("row {row}, column {column}: brightness is {value}; give 0 (black) to 1 (white)")]
    Brightness {
        /// The row, from 1.
        row: usize,
        /// The column, from 1.
        column: usize,
        /// What is there.
        value: f64,
    },
    /// All black.
    #[error("the tile is black, so it shows no shading; give a picture with light in it")]
    Black,
    /// A light that is none.
    #[error("the light's {key} is {value}°; give {range}")]
    Light {
        /// `slant` or `tilt`.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        range: &'static str,
    },
    /// Light from the front.
    #[error(
        "light from the front (slant {slant_deg:.1}°) shows no direction of slopes; \
         take a picture with the light at 30° to 60° from the vertical"
    )]
    Frontal {
        /// The slant.
        slant_deg: f64,
    },
    /// The light along which Tsai & Shah's iteration stands still.
    #[error(
        "Tsai & Shah's iteration stands still under this light (cos tilt + sin tilt ≈ 0, at 135° \
         or −45°, or nearly frontal); turn the picture by 90°, or take another method"
    )]
    Singular,
    /// A number out of range.
    #[error("{key} is {value}; give {range}")]
    Option {
        /// Which.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        range: &'static str,
    },
    /// No relief was found.
    #[error("the shape is flat, so there is nothing to feel; give a picture that shows shading")]
    Flat,
    /// Heights without a scale.
    #[error(
        "the heights are in pixels, unscaled; say the scale: the relief from the lowest to the \
         highest point in µm, or the roughness SMD that a surface tester reads, in µm"
    )]
    Unscaled,
    /// Too small a tile for a textile.
    #[error("{width} × {height} px are no relief; give a repeat of at least 2 × 2 px")]
    TooSmall {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A roughness that the relief never has.
    #[error(
        "no height of this relief reads an SMD of {smd_um} µm on the tester (the last try read \
         {found_um:.3} µm); its own noise reads about 0.16 µm: give another SMD, or the relief"
    )]
    Smd {
        /// What was asked for.
        smd_um: f64,
        /// What was read last.
        found_um: f64,
    },
    /// The work was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Heights from brightness 0…1 under a light; row 0 is the lowest y.
///
/// # Errors
/// Brightness that is empty, too large, outside 0…1 or black; a light that the method cannot use;
/// options out of range; cancelled.
pub fn shape_from_shading(
    brightness: &Grid<f64>,
    light: Light,
    options: &ShadingOptions,
    progress: &mut Progress<'_>,
) -> Result<Shape, ShadingError> {
    check(brightness, options)?;
    light.check()?;
    let is_singular = options.method == Method::TsaiShah && tsai_shah::is_singular(light);
    if is_singular {
        return Err(ShadingError::Singular);
    }
    if light.is_frontal() {
        return Err(ShadingError::Frontal {
            slant_deg: light.slant_deg,
        });
    }
    progress.step(0.0, "shape from shading")?;
    let found = match options.method {
        Method::TsaiShah => tsai_shah::solve(brightness, light, options, progress)?,
        Method::Linear => linear::solve(brightness, light, options),
        Method::Variational => variational::solve(brightness, light, options, progress)?,
    };
    let blind = linear::blind(brightness, light, options);
    progress.step(1.0, "shape from shading")?;
    Ok(Shape {
        height_px: about_mean(found.height_px),
        method: options.method,
        light,
        albedo: found.albedo,
        residuals: found.residuals,
        n_rounds: found.n_rounds,
        blind,
        reliability: reliability::words(options.method, light, blind),
    })
}

/// What a method hands back.
struct Found {
    height_px: Grid<f64>,
    albedo: f64,
    residuals: Vec<f64>,
    n_rounds: usize,
}

impl ShadingOptions {
    fn n_iterations(&self) -> usize {
        let own = self.method.default_iterations();
        self.iterations.unwrap_or(own)
    }

    /// The albedo, or the one under which the mean brightness is that of a level surface.
    fn albedo_for(&self, brightness: &Grid<f64>, light: Light) -> f64 {
        let level = light.slant_deg.to_radians().cos();
        self.albedo.unwrap_or_else(|| mean(brightness) / level)
    }
}

fn check(brightness: &Grid<f64>, options: &ShadingOptions) -> Result<(), ShadingError> {
    let (width, height) = (brightness.width(), brightness.height());
    if brightness.values().is_empty() {
        return Err(ShadingError::Empty);
    }
    if width.saturating_mul(height) > MOST_POINTS {
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
    if (1..=MOST_ITERATIONS).contains(&n) {
        return Ok(());
    }
    Err(ShadingError::Option {
        key: "the number of iterations",
        value: n as f64,
        range: "1 to 10000",
    })
}

/// The rows in the other order: from a picture's, which come from the top, to those of heights,
/// which come from the lowest y, and back.
#[must_use]
pub(crate) fn rows_turned_over(grid: &Grid<f64>) -> Grid<f64> {
    let mut turned = grid.clone();
    let height = grid.height();
    for row in 0..height {
        turned
            .row_mut(row)
            .copy_from_slice(grid.row(height - 1 - row));
    }
    turned
}

fn mean(grid: &Grid<f64>) -> f64 {
    grid.values().iter().sum::<f64>() / grid.values().len().max(1) as f64
}

fn about_mean(mut grid: Grid<f64>) -> Grid<f64> {
    let mean = mean(&grid);
    for value in grid.values_mut() {
        *value -= mean;
    }
    grid
}
