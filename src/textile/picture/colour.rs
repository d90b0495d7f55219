//! Whether the period is one of colour: a printed or checked pattern is no relief. The colours of
//! what was cut from a picture.

use super::analysis::Found;
use super::basis::Basis;
use super::brightness::Brightness;
use super::light::mean_and_variance;
use super::relief::ReliefOf;
use super::source::LUMINANCE;
use super::tile::Tile;
use super::turned::Turned;
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

impl Brightness {
    /// Red, green and blue of what was cut, 0…1, by the shares of red and green in the picture, grey
    /// without: point by point, or by their mean where cells were averaged or laid straight.
    pub fn colours(
        &self,
        (shares, turned): (Option<&Grid<[f32; 2]>>, &[Turned]),
        (relief_of, found): (ReliefOf, Option<&Found>),
    ) -> [Grid<f64>; 3] {
        let region = Turned::common(turned).ok().filter(|_| !turned.is_empty());
        let part = region.and_then(|region| shares?.part(region));
        let shares = part.as_ref().or(shares);
        let is_laid = turned.is_empty() && found.is_some_and(|found| found.unwarped.is_some());
        let is_straight = relief_of != ReliefOf::Cell && !is_laid;
        let channel = |i: usize| shares.map(|all| all.map(|share| f64::from(share[i])));
        let laid = |grid: Option<Grid<f64>>| {
            let grid = grid.unwrap_or_else(|| Grid::filled(1, 1, 1.0 / 3.0));
            let (mean, _) = mean_and_variance(&grid);
            let cut = Self::of_picture(&grid, self.angle_rad).values;
            let size = |grid: &Grid<f64>| (grid.width(), grid.height());
            let is_like = is_straight && size(&cut) == size(&self.values);
            if is_like {
                cut
            } else {
                self.values.map(|_| mean)
            }
        };
        let [red, green] = [0, 1].map(|i| laid(channel(i)));
        let mut all = [
            self.values.clone(),
            self.values.clone(),
            self.values.clone(),
        ];
        for (i, (r, g)) in red.values().iter().zip(green.values()).enumerate() {
            let shares = [*r, *g, 1.0 - r - g];
            let weight: f64 = shares.iter().zip(LUMINANCE).map(|(a, b)| a * b).sum();
            for (to, share) in all.iter_mut().zip(shares) {
                let value = &mut to.values_mut()[i];
                *value = (*value * share / weight.max(0.05)).clamp(0.0, 1.0);
            }
        }
        all
    }
}
