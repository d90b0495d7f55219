//! Turning, scaling and shifting from one picture to another.

use super::super::basis::{Place, mix};
use selvedge_foundation::numerics::{Complex, Grid, catmull_rom, in_pieces, to_whole};

/// A similarity of the plane: pixels, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    from: Place,
    to: Place,
    /// What a shift, as the number x + iy, is multiplied by.
    factor: Complex,
}

impl Similarity {
    /// Turns what lies at the first place by so many degrees, counter-clockwise as seen, scales it
    /// and puts it to the second.
    pub(super) fn new([from, to]: [Place; 2], turn_deg: f64, scale: f64) -> Self {
        let factor = Complex::from_polar(scale, -turn_deg.to_radians());
        Self { from, to, factor }
    }

    /// The one that takes the first of each pair nearest to the second, by least squares.
    pub(super) fn fitted(pairs: &[[Place; 2]]) -> Self {
        let n = pairs.len().max(1) as f64;
        let mean = |which: usize| {
            [0, 1].map(|axis| pairs.iter().map(|pair| pair[which][axis]).sum::<f64>() / n)
        };
        let (from, to) = (mean(0), mean(1));
        let shift = |place: Place, mean: Place| complex(mix(place, 1.0, mean, -1.0));
        let (mut product, mut square) = (Complex::default(), 1e-12);
        for [a, b] in pairs {
            let (a, b) = (shift(*a, from), shift(*b, to));
            product += a.conj() * b;
            square += a.norm_sqr();
        }
        Self {
            from,
            to,
            factor: product / square,
        }
    }

    /// Where a place of the first picture lies in the other.
    pub fn at(&self, place: Place) -> Place {
        let shift = complex(mix(place, 1.0, self.from, -1.0)) * self.factor;
        mix(self.to, 1.0, [shift.re, shift.im], 1.0)
    }

    /// Where a place of the other picture lies in the first.
    #[cfg(test)]
    pub(super) fn back(&self, place: Place) -> Place {
        let shift = complex(mix(place, 1.0, self.to, -1.0)) / self.factor;
        mix(self.from, 1.0, [shift.re, shift.im], 1.0)
    }

    /// By how much the cloth is turned, degrees counter-clockwise, −180 to 180.
    pub fn turn_deg(&self) -> f64 {
        -self.factor.arg().to_degrees()
    }

    /// How much larger the cloth is in the other picture.
    pub fn scale(&self) -> f64 {
        self.factor.norm()
    }

    /// Turned further and scaled.
    pub(super) fn changed(&self, by_deg: f64, scale: f64) -> Self {
        let factor = self.factor * Complex::from_polar(scale, -by_deg.to_radians());
        Self { factor, ..*self }
    }

    /// With what lay at a shift of the first picture, px, where it is now said to be.
    pub(super) fn shifted(&self, shift_px: Place) -> Self {
        let to = self.at(mix(self.from, 1.0, shift_px, 1.0));
        Self { to, ..*self }
    }

    /// How far the turns of both are apart, degrees.
    pub(super) fn turn_from(&self, other: &Self) -> f64 {
        (self.factor * other.factor.conj()).arg().to_degrees().abs()
    }

    /// The other picture as the first has it, so many columns and rows.
    pub(super) fn laid(&self, other: &Grid<f64>, n: [usize; 2], n_threads: usize) -> Grid<f64> {
        let mut laid = Grid::filled(n[0], n[1], 0.0);
        in_pieces(
            laid.values_mut(),
            n[0],
            n_threads,
            || (),
            |(), row, values| {
                for (column, value) in values.iter_mut().enumerate() {
                    *value = cubic(other, self.at([column as f64, row as f64]));
                }
            },
        );
        laid
    }
}

fn complex([x, y]: Place) -> Complex {
    Complex::new(x, y)
}

/// A value between samples by cubics through four each way, which keeps more of
/// fine threads than straight lines do; beyond the edges the edges' values.
fn cubic(grid: &Grid<f64>, place: Place) -> f64 {
    let last = [grid.width(), grid.height()].map(|n| n as f64 - 1.0);
    let at = [0, 1].map(|axis| place[axis].clamp(0.0, last[axis]));
    let [x, y] = at.map(|at| catmull_rom(at - at.floor()));
    let index = |axis: usize, i: usize| {
        to_whole::<usize>((at[axis].floor() + i as f64 - 1.0).clamp(0.0, last[axis]))
    };
    let along = |j: usize| -> f64 {
        let row = grid.row(index(1, j));
        (0..4).map(|i| x[i] * row[index(0, i)]).sum()
    };
    (0..4).map(|j| y[j] * along(j)).sum()
}
