//! Whether the period is one of colour: a printed or checked pattern is no relief.

use super::basis::Basis;
use super::light::mean_and_variance;
use super::tile::Tile;
use selvedge_foundation::numerics::Grid;

/// Colour varies with the period if it does at least this much of what brightness does.
const MIN_SHARE: f64 = 0.5;
/// And at least this much of white: less is the camera's.
const MIN_SPREAD: f64 = 0.01;

/// How much colour varies with a lattice, beside brightness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicColour {
    /// Standard deviation over a cell of the share of red or of green in all light, the larger one,
    /// over a third: the share in grey.
    pub(crate) colour_spread: f64,
    /// Standard deviation over a cell of the luminance, over its mean.
    pub(crate) brightness_spread: f64,
}

impl PeriodicColour {
    /// Measures it; 0 of a grey picture.
    pub(crate) fn of(
        luminance: &Tile,
        colour: Option<&Grid<[f32; 2]>>,
        basis: Basis,
        n_threads: usize,
    ) -> Self {
        let spread = |values: &Grid<f64>| {
            let (mean, variance) = mean_and_variance(values);
            if mean > 0.0 {
                variance.sqrt() / mean
            } else {
                0.0
            }
        };
        let channel = |colours: &Grid<[f32; 2]>, i: usize| {
            let grid = colours.map(|colour| f64::from(colour[i]));
            let variance = mean_and_variance(&Tile::fold(&grid, basis, n_threads).values).1;
            3.0 * variance.sqrt()
        };
        let of_channels = colour.map_or(0.0, |colours| {
            let both = (0..2).map(|i| channel(colours, i));
            both.fold(0.0, f64::max)
        });
        Self {
            colour_spread: of_channels,
            brightness_spread: spread(&luminance.values),
        }
    }

    /// Whether the pattern is one of colours.
    pub fn is_printed(&self) -> bool {
        self.colour_spread >= MIN_SPREAD.max(MIN_SHARE * self.brightness_spread)
    }
}
