//! The discrete Fourier transform of a grid of real numbers, both ways.
//!
//! Rows first, then columns.

use super::fft::ComplexTransform;
use super::{Complex, Grid, RealTransform};

/// The DFT of a grid of fixed size: `X_{k,l} = Σ_{i,j} x_{i,j} e^{−2πi(ki/n_u + lj/n_w)}`.
#[derive(Debug, Clone)]
pub struct PlaneTransform {
    along: RealTransform,
    across: ComplexTransform,
}

impl PlaneTransform {
    /// The transform of grids `width` × `height`.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            along: RealTransform::new(width),
            across: ComplexTransform::new(height),
        }
    }

    /// `X_{k,l}`: columns k = 0 … ⌊width/2⌋, rows l = 0 … height − 1. `grid` has the transform's
    /// size.
    pub fn forward(&self, grid: &Grid<f64>) -> Grid<Complex> {
        let (width, height) = (self.along.len() / 2 + 1, self.across.len());
        let mut spectrum = Grid::filled(width, height, Complex::default());
        self.forward_into(grid, &mut spectrum);
        spectrum
    }

    /// [`Self::forward`] into a spectrum of the transform's size.
    pub fn forward_into(&self, grid: &Grid<f64>, spectrum: &mut Grid<Complex>) {
        let mut room = self.along.room();
        for row in 0..self.across.len() {
            let into = spectrum.row_mut(row);
            self.along.forward_into(grid.row(row), into, &mut room);
        }
        in_columns(spectrum, self.across.room(), |columns, room| {
            self.across.forward(columns, room);
        });
    }

    /// The grid whose forward transform is `spectrum` (with the factor 1/(width·height)).
    pub fn inverse(&self, mut spectrum: Grid<Complex>) -> Grid<f64> {
        let mut grid = Grid::filled(self.along.len(), self.across.len(), 0.0);
        self.inverse_into(&mut spectrum, &mut grid);
        grid
    }

    /// [`Self::inverse`] into a grid of the transform's size. `spectrum` is destroyed.
    pub fn inverse_into(&self, spectrum: &mut Grid<Complex>, grid: &mut Grid<f64>) {
        let n = self.across.len();
        let scale = 1.0 / n as f64;
        in_columns(spectrum, self.across.room(), |columns, room| {
            self.across.inverse(columns, room);
            for x in columns {
                *x *= scale;
            }
        });
        let mut room = self.along.room();
        for row in 0..n {
            let (from, into) = (spectrum.row_mut(row), grid.row_mut(row));
            self.along.inverse_into(from, into, &mut room);
        }
    }
}

/// Columns that are taken out of a grid and put back together: as many as a cache line feeds.
const N_TOGETHER: usize = 16;

/// Does `work` on all columns of a grid, several at a time, one after the other.
fn in_columns(
    grid: &mut Grid<Complex>,
    mut room: Vec<Complex>,
    work: impl Fn(&mut [Complex], &mut [Complex]),
) {
    let (width, height) = (grid.width(), grid.height());
    let mut columns = vec![Complex::default(); N_TOGETHER * height];
    for first in (0..width).step_by(N_TOGETHER) {
        let n = N_TOGETHER.min(width - first);
        for row in 0..height {
            for (i, value) in grid.row(row)[first..first + n].iter().enumerate() {
                columns[i * height + row] = *value;
            }
        }
        work(&mut columns[..n * height], &mut room);
        for row in 0..height {
            for (i, value) in grid.row_mut(row)[first..first + n].iter_mut().enumerate() {
                *value = columns[i * height + row];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::numerics::Random;

    #[test]
    fn forward_is_the_double_sum_and_inverse_undoes_it() {
        for (width, height) in [(6, 5), (5, 8), (1, 4), (4, 1)] {
            let mut random = Random::new(2);
            let values: Vec<f64> = (0..width * height).map(|_| random.normal()).collect();
            let grid = Grid::from_rows(width, values).unwrap();
            let transform = PlaneTransform::new(width, height);
            let spectrum = transform.forward(&grid);
            for l in 0..height {
                for k in 0..=width / 2 {
                    let mut sum = Complex::default();
                    for j in 0..height {
                        for (i, &x) in grid.row(j).iter().enumerate() {
                            let turns =
                                (k * i) as f64 / width as f64 + (l * j) as f64 / height as f64;
                            sum += Complex::from_polar(1.0, -TAU * turns) * x;
                        }
                    }
                    assert!(
                        (spectrum.row(l)[k] - sum).norm() < 1e-12,
                        "{width} × {height}"
                    );
                }
            }
            let back = transform.inverse(spectrum);
            for (a, b) in back.values().iter().zip(grid.values()) {
                assert!((a - b).abs() < 1e-13, "{width} × {height}: {a} and {b}");
            }
        }
    }
}
