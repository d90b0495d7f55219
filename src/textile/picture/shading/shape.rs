//! What is asked of shape from shading, and what it finds.

use serde::{Deserialize, Serialize};

use super::light::{Light, View};
use selvedge_foundation::named;
use selvedge_foundation::numerics::Grid;

named! {
    /// How heights are found from brightness.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Method {
        /// Tsai & Shah's iteration as published.
        TsaiShah = "tsai-shah", "Tsai & Shah",
        /// The linear inversion of Pentland, regularised.
        Linear = "linear", "linear",
        /// Regularised least squares on the full reflectance.
        #[default]
        Variational = "variational", "variational",
        /// No shading at all: height follows brightness.
        DarkIsDeep = "dark-is-deep", "dark is deep",
    }
    /// The word that files and commands use.
    pub fn word;
    /// What people read.
    pub fn label;
}

impl Method {
    /// Iterations unless stated.
    pub(crate) fn default_iterations(self) -> usize {
        match self {
            Self::TsaiShah => 50,
            Self::Linear | Self::DarkIsDeep => 1,
            Self::Variational => 16,
        }
    }

    /// Those that take brightness for the slope towards a light, so that the light matters.
    pub const OF_SHADING: [Self; 3] = [Self::TsaiShah, Self::Linear, Self::Variational];
}

/// How shape is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShadingOptions {
    /// The method.
    pub method: Method,
    /// Iterations, 1 to [`MAX_ITERATIONS`]; the method's own number unless stated. The linear
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
    /// (0.1). Variational: the weight of squared curvature (0.001). Dark is deep: the power of
    /// brightness that height follows (1).
    pub regulariser: Option<f64>,
}

/// Most iterations.
pub(crate) const MAX_ITERATIONS: usize = 10_000;

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

/// What the differences do at the first row and column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Edges {
    /// Go on at the other side: the tile repeats.
    #[default]
    Repeat,
    /// As published: no slope in the first row and the first column.
    Published,
}

/// What a light cannot show: wave vectors so nearly across it that less than half of their height
/// comes back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Blind {
    /// Their share of all wave vectors.
    pub(crate) share_of_vectors: f64,
    /// Their share of the picture's energy (its variance): what the linear inversion leaves out.
    /// A matt surface without noise has next to none there.
    pub(crate) share_of_energy: f64,
}

/// What a method hands back.
pub(super) struct Found {
    pub(super) height_px: Grid<f64>,
    pub(super) albedo: f64,
    pub(super) residuals: Vec<f64>,
    pub(super) n_rounds: usize,
}

impl ShadingOptions {
    pub(super) fn n_iterations(&self) -> usize {
        let own = self.method.default_iterations();
        self.iterations.unwrap_or(own)
    }

    /// The albedo, or the one under which the mean brightness is that of a level surface.
    pub(super) fn albedo_for(&self, brightness: &Grid<f64>, light: Light) -> f64 {
        let level = light.slant_deg.to_radians().cos();
        self.albedo.unwrap_or_else(|| mean(brightness) / level)
    }
}

/// The mean of all values.
pub(super) fn mean(grid: &Grid<f64>) -> f64 {
    grid.values().iter().sum::<f64>() / grid.values().len().max(1) as f64
}

/// How many readings of its own the even albedo counts for at a point of several pictures.
pub(super) const EVEN: f64 = 0.3;

/// What pictures show on the mean: what does not turn with the light.
pub(super) fn mean_of(views: &[View<'_>], first: &Grid<f64>) -> Grid<f64> {
    let mut sum = first.map(|_| 0.0);
    for (view, _) in views {
        for (sum, e) in sum.values_mut().iter_mut().zip(view.values()) {
            *sum += e / views.len() as f64;
        }
    }
    sum
}

/// Values about their mean.
pub(super) fn about_mean(grid: &Grid<f64>) -> Grid<f64> {
    let mean = mean(grid);
    grid.map(|value| value - mean)
}
