//! The discrete Fourier transform of a grid of real numbers, both ways.
//!
//! Rows first, then columns; a complex column is transformed as its real and its imaginary part.

use super::{Complex, Grid, RealTransform};

/// The DFT of a grid of fixed size: `X_{k,l} = Σ_{i,j} x_{i,j} e^{−2πi(ki/n_u + lj/n_w)}`.
#[derive(Debug, Clone)]
pub struct PlaneTransform {
    along: RealTransform,
    across: RealTransform,
}

impl PlaneTransform {
    /// The transform of grids `width` × `height`.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            along: RealTransform::new(width),
            across: RealTransform::new(height),
        }
    }

    /// `X_{k,l}`: columns k = 0 … ⌊width/2⌋, rows l = 0 … height − 1. `grid` has the transform's
    /// size.
    pub fn forward(&self, grid: &Grid<f64>) -> Grid<Complex> {
        let n = self.across.len();
        let width = self.along.len() / 2 + 1;
        let mut spectrum = Grid::filled(width, n, Complex::default());
        for row in 0..n {
            let transformed = self.along.forward(grid.row(row));
            spectrum.row_mut(row).copy_from_slice(&transformed);
        }
        in_columns(&mut spectrum, |column| {
            let re: Vec<f64> = column.iter().map(|x| x.re).collect();
            let im: Vec<f64> = column.iter().map(|x| x.im).collect();
            let (a, b) = (self.across.forward(&re), self.across.forward(&im));
            for (row, value) in column.iter_mut().enumerate() {
                let (a, b) = (whole(&a, row, n), whole(&b, row, n));
                *value = Complex::new(a.re - b.im, a.im + b.re);
            }
        });
        spectrum
    }

    /// The grid whose forward transform is `spectrum` (with the factor 1/(width·height)).
    pub fn inverse(&self, mut spectrum: Grid<Complex>) -> Grid<f64> {
        let n = self.across.len();
        let half = n / 2 + 1;
        let (mut a, mut b) = (
            vec![Complex::default(); half],
            vec![Complex::default(); half],
        );
        in_columns(&mut spectrum, |column| {
            for row in 0..half {
                let here = column[row];
                let there = column[(n - row) % n].conj();
                a[row] = 0.5 * (here + there);
                let odd = 0.5 * (here - there);
                b[row] = Complex::new(odd.im, -odd.re);
            }
            let (re, im) = (self.across.inverse(&a), self.across.inverse(&b));
            for (value, (re, im)) in column.iter_mut().zip(re.iter().zip(&im)) {
                *value = Complex::new(*re, *im);
            }
        });
        let mut grid = Grid::filled(self.along.len(), n, 0.0);
        for row in 0..n {
            let values = self.along.inverse(spectrum.row(row));
            grid.row_mut(row).copy_from_slice(&values);
        }
        grid
    }
}

/// Columns that are taken out of a grid and put back together: as many as a cache line feeds.
const N_TOGETHER: usize = 16;

/// Does `work` on every column of a grid.
fn in_columns(grid: &mut Grid<Complex>, mut work: impl FnMut(&mut [Complex])) {
    let (width, height) = (grid.width(), grid.height());
    let mut columns = vec![Complex::default(); N_TOGETHER * height];
    for first in (0..width).step_by(N_TOGETHER) {
        let n = N_TOGETHER.min(width - first);
        for row in 0..height {
            for (i, value) in grid.row(row)[first..first + n].iter().enumerate() {
                columns[i * height + row] = *value;
            }
        }
        columns.chunks_exact_mut(height).take(n).for_each(&mut work);
        for row in 0..height {
            for (i, value) in grid.row_mut(row)[first..first + n].iter_mut().enumerate() {
                *value = columns[i * height + row];
            }
        }
    }
}

/// `X_k` of a real sequence of `n` from the first half of its transform.
fn whole(half: &[Complex], k: usize, n: usize) -> Complex {
    if k < half.len() {
        half[k]
    } else {
        half[n - k].conj()
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
