//! Procedural cloth: what a network learns from, as there is no open set of pictures and friction.
//!
//! ```text
//! recipe (family, seed) ─▶ relief (heights of any part) ─┬─▶ photo (light, print, blur, noise)
//!                                                        └─▶ finger (friction along the path)
//! ```
//!
//! Everything is a function of the recipe and the place, so that any part of any size can be made
//! and the same place is the same in all of them. Places are mm, x along the finger's path and
//! y across it; both pictures and traces have [`PER_MM`] samples a millimetre.

mod finger;
mod noise;
mod photo;
mod recipe;
mod relief;

pub(crate) use finger::{FINGER_ROWS, Rubbed};
pub(crate) use photo::Camera;
pub(crate) use recipe::{Family, Recipe};

use selvedge_foundation::numerics::Grid;

/// Pixels and samples a millimetre: 1280 along 100 mm, as Cai et al. (2021) have them.
pub(crate) const PER_MM: f64 = 12.8;

/// A part of a cloth, in samples of [`PER_MM`]: the first column and row, their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Area {
    /// The first column and how many.
    pub columns: [usize; 2],
    /// The first row and how many.
    pub rows: [usize; 2],
}

impl Area {
    /// A value for each place, mm.
    fn filled(self, mut value: impl FnMut(f64, f64) -> f64) -> Grid<f32> {
        let [[x, width], [y, height]] = [self.columns, self.rows];
        Grid::from_fn(width, height, |column, row| {
            let place = [x + column, y + row].map(|n| n as f64 / PER_MM);
            selvedge_foundation::numerics::to_single(value(place[0], place[1]))
        })
    }
}

#[cfg(test)]
mod tests;
