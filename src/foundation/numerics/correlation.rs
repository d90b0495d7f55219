//! The correlation of a picture with itself, shifted: over the overlap only, with the mean and the
//! variance of either overlap.
//!
//! `ρ(d) = (Σ t(x)t(x+d) − s₁s₂/n) / √((q₁ − s₁²/n)(q₂ − s₂²/n))`, sums over the n pixels x where
//! both x and x + d are in the picture. The sums of values and of squares come from summed-area
//! tables, the sum of products from one transform there and one back, long enough that no shift up
//! to half the size meets the other side (Padfield 2012 for a mask that is a full rectangle).

use super::{Complex, Grid, RealTransform, in_pieces};

/// Columns that one piece of work takes out of the spectra of rows: as many as cache lines feed.
const N_TOGETHER: usize = 8;
/// A variance below this share of the whole is that of one colour, up to rounding.
const MIN_VARIANCE: f64 = 1e-10;

/// Correlation coefficients of a picture with itself, shifted.
///
/// Columns are shifts −⌊w/2⌋…⌊w/2⌋ across (the middle one is no shift), rows 0…⌊h/2⌋ down;
/// `ρ(−d) = ρ(d)` gives the rest. 0 where either overlap is of one colour. The same bytes for any
/// number of threads.
pub fn overlap_autocorrelation(picture: &Grid<f64>, n_threads: usize) -> Grid<f64> {
    let (width, height) = (picture.width(), picture.height());
    let (reach_x, reach_y) = (width / 2, height / 2);
    let mean = picture.values().iter().sum::<f64>() / (width * height).max(1) as f64;
    let mut centred = picture.clone();
    for x in centred.values_mut() {
        *x -= mean;
    }
    let products = Products::of(&centred, n_threads);
    let sums = SummedArea::of(&centred, |x| x);
    let squares = SummedArea::of(&centred, |x| x * x);
    let least = MIN_VARIANCE * squares.total().max(f64::MIN_POSITIVE) / (width * height) as f64;
    let n_columns = 2 * reach_x + 1;
    let mut rho = Grid::filled(n_columns, reach_y + 1, 0.0);
    let prepare = || products.scratch();
    in_pieces(
        rho.values_mut(),
        n_columns,
        n_threads,
        prepare,
        |s, dy, row| {
            products.row(s, dy);
            for (column, value) in row.iter_mut().enumerate() {
                // The first overlap begins where the second, shifted, has its first pixel.
                let (left, right) = (
                    reach_x.saturating_sub(column),
                    column.saturating_sub(reach_x),
                );
                let size = [width - left - right, height - dy];
                let n = (size[0] * size[1]) as f64;
                let (first, second) = ([left, 0], [right, dy]);
                let (s1, s2) = (sums.over(first, size), sums.over(second, size));
                let (q1, q2) = (squares.over(first, size), squares.over(second, size));
                let (v1, v2) = (q1 - s1 * s1 / n, q2 - s2 * s2 / n);
                if v1.min(v2) > least * n {
                    let product = products.at(s, left, right);
                    *value = ((product - s1 * s2 / n) / (v1 * v2).sqrt()).clamp(-1.0, 1.0);
                }
            }
        },
    );
    rho
}

/// A length that transforms fast (factors 2, 3, 5) and is at least `n`, even.
fn fast_length(n: usize) -> usize {
    let is_fast = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    let mut length = n.max(2).next_multiple_of(2);
    while !is_fast(length) {
        length += 2;
    }
    length
}

/// `Σ t(x) t(x + d)`, transformed back along columns, not yet along rows.
struct Products {
    along: RealTransform,
    n_rows: usize,
    /// For every bin across, the rows 0 … ⌊h/2⌋.
    columns: Vec<Complex>,
}

/// A row of products, and what its transform needs.
struct RowScratch {
    bins: Vec<Complex>,
    products: Vec<f64>,
    room: Vec<Complex>,
}

impl Products {
    fn of(centred: &Grid<f64>, n_threads: usize) -> Self {
        let (width, height) = (centred.width(), centred.height());
        let along = RealTransform::new(fast_length(width + width / 2));
        let across = RealTransform::new(fast_length(height + height / 2));
        let n_bins = along.len() / 2 + 1;
        let mut spectra = vec![Complex::default(); n_bins * height];
        let prepare = || (vec![0.0; along.len()], along.room());
        in_pieces(
            &mut spectra,
            n_bins,
            n_threads,
            prepare,
            |(input, room), row, out| {
                input[..width].copy_from_slice(centred.row(row));
                input[width..].fill(0.0);
                along.forward_into(input, out, room);
            },
        );
        let n_rows = height / 2 + 1;
        let mut columns = vec![Complex::default(); n_bins * n_rows];
        let prepare = || ColumnScratch::new(&across, height);
        let piece = N_TOGETHER * n_rows;
        in_pieces(
            &mut columns,
            piece,
            n_threads,
            prepare,
            |scratch, number, out| {
                let n = out.len() / n_rows;
                let first = number * N_TOGETHER;
                scratch.gather(&spectra, n_bins, first..first + n);
                for (i, column) in out.chunks_exact_mut(n_rows).enumerate() {
                    scratch.correlate(&across, i);
                    column.copy_from_slice(&scratch.a[..n_rows]);
                }
            },
        );
        Self {
            along,
            n_rows,
            columns,
        }
    }

    fn scratch(&self) -> RowScratch {
        RowScratch {
            bins: vec![Complex::default(); self.along.len() / 2 + 1],
            products: vec![0.0; self.along.len()],
            room: self.along.room(),
        }
    }

    /// The products at the shifts down by `dy`.
    fn row(&self, scratch: &mut RowScratch, dy: usize) {
        for (bin, column) in scratch
            .bins
            .iter_mut()
            .zip(self.columns.chunks_exact(self.n_rows))
        {
            *bin = column[dy];
        }
        self.along
            .inverse_into(&mut scratch.bins, &mut scratch.products, &mut scratch.room);
    }

    /// The product at the shift `right − left` across (one of them is 0).
    fn at(&self, scratch: &RowScratch, left: usize, right: usize) -> f64 {
        scratch.products[(self.along.len() - left + right) % self.along.len()]
    }
}

/// Some columns of the spectra of rows, taken out as real and imaginary parts.
struct ColumnScratch {
    height: usize,
    re: Vec<f64>,
    im: Vec<f64>,
    input: Vec<f64>,
    a: Vec<Complex>,
    b: Vec<Complex>,
    room: Vec<Complex>,
}

impl ColumnScratch {
    fn new(across: &RealTransform, height: usize) -> Self {
        let half = vec![Complex::default(); across.len() / 2 + 1];
        Self {
            height,
            re: vec![0.0; N_TOGETHER * height],
            im: vec![0.0; N_TOGETHER * height],
            input: vec![0.0; across.len()],
            a: half.clone(),
            b: half,
            room: across.room(),
        }
    }

    fn gather(&mut self, spectra: &[Complex], n_bins: usize, columns: std::ops::Range<usize>) {
        for row in 0..self.height {
            let bins = &spectra[row * n_bins..][columns.clone()];
            for (i, bin) in bins.iter().enumerate() {
                self.re[i * self.height + row] = bin.re;
                self.im[i * self.height + row] = bin.im;
            }
        }
    }

    /// Leaves in `a` the transform back of the power of column `i`. The power is real, so that a
    /// transform forward and a complex conjugate do it.
    fn correlate(&mut self, across: &RealTransform, i: usize) {
        let n = across.len();
        let part = i * self.height..(i + 1) * self.height;
        for (values, out) in [(&self.re, &mut self.a), (&self.im, &mut self.b)] {
            self.input[..self.height].copy_from_slice(&values[part.clone()]);
            self.input[self.height..].fill(0.0);
            across.forward_into(&self.input, out, &mut self.room);
        }
        let scale = 1.0 / n as f64;
        for (l, (a, b)) in self.a.iter().zip(&self.b).enumerate() {
            // The column's own transform is a + ib, at −l it is the conjugates' a* + ib*.
            let here = Complex::new(a.re - b.im, a.im + b.re).norm_sqr();
            let there = Complex::new(a.re + b.im, b.re - a.im).norm_sqr();
            self.input[l] = here * scale;
            self.input[(n - l) % n] = if l == 0 { here * scale } else { there * scale };
        }
        across.forward_into(&self.input, &mut self.a, &mut self.room);
        for x in &mut self.a {
            *x = x.conj();
        }
    }
}

/// Sums over any rectangle of a grid from four corners.
#[derive(Debug, Clone)]
struct SummedArea {
    sums: Grid<f64>,
}

impl SummedArea {
    fn of(grid: &Grid<f64>, value: impl Fn(f64) -> f64) -> Self {
        let mut sums = Grid::filled(grid.width() + 1, grid.height() + 1, 0.0);
        let mut above = vec![0.0; grid.width() + 1];
        for row in 0..grid.height() {
            let mut sum = 0.0;
            for (i, &x) in grid.row(row).iter().enumerate() {
                sum += value(x);
                above[i + 1] += sum;
            }
            sums.row_mut(row + 1).copy_from_slice(&above);
        }
        Self { sums }
    }

    /// The sum over a rectangle from its upper left corner and size.
    fn over(&self, [x, y]: [usize; 2], [width, height]: [usize; 2]) -> f64 {
        let (top, bottom) = (self.sums.row(y), self.sums.row(y + height));
        bottom[x + width] - bottom[x] - top[x + width] + top[x]
    }

    fn total(&self) -> f64 {
        self.over([0, 0], [self.sums.width() - 1, self.sums.height() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Random;

    /// The definition, pixel by pixel.
    fn by_brute_force(picture: &Grid<f64>, dx: isize, dy: isize) -> f64 {
        let (w, h) = (
            picture.width().cast_signed(),
            picture.height().cast_signed(),
        );
        let value = |x: isize, y: isize| picture.row(y.cast_unsigned())[x.cast_unsigned()];
        let pairs: Vec<[f64; 2]> = (0..h)
            .flat_map(|y| (0..w).map(move |x| (x, y)))
            .filter(|&(x, y)| (0..w).contains(&(x + dx)) && (0..h).contains(&(y + dy)))
            .map(|(x, y)| [value(x, y), value(x + dx, y + dy)])
            .collect();
        let n = pairs.len() as f64;
        let mean = |of: usize| pairs.iter().map(|p| p[of]).sum::<f64>() / n;
        let m = [mean(0), mean(1)];
        let sum = |a: usize, b: usize| -> f64 {
            pairs.iter().map(|p| (p[a] - m[a]) * (p[b] - m[b])).sum()
        };
        let variance = sum(0, 0) * sum(1, 1);
        if variance > 0.0 {
            sum(0, 1) / variance.sqrt()
        } else {
            0.0
        }
    }

    fn noisy(width: usize, height: usize, seed: u64) -> Grid<f64> {
        let mut random = Random::new(seed);
        let value = |i: usize| (i % 7) as f64 + 0.1 * (i / width) as f64;
        let values = (0..width * height)
            .map(|i| value(i) + random.normal())
            .collect();
        Grid::from_rows(width, values).unwrap()
    }

    #[test]
    fn every_coefficient_is_that_of_the_definition() {
        for (width, height) in [
            (9, 7),
            (8, 8),
            (16, 5),
            (5, 16),
            (2, 2),
            (1, 6),
            (6, 1),
            (1, 1),
        ] {
            let picture = noisy(width, height, 3);
            let rho = overlap_autocorrelation(&picture, 2);
            let reach = (width / 2).cast_signed();
            assert_eq!(
                (rho.width(), rho.height()),
                (2 * (width / 2) + 1, height / 2 + 1)
            );
            for dy in 0..rho.height() {
                for (column, &found) in rho.row(dy).iter().enumerate() {
                    let dx = column.cast_signed() - reach;
                    let expected = by_brute_force(&picture, dx, dy.cast_signed());
                    assert!(
                        (found - expected).abs() < 1e-10,
                        "{width} × {height} shifted by {dx}, {dy}: {found} for {expected}"
                    );
                    let other = by_brute_force(&picture, -dx, -dy.cast_signed());
                    assert!((found - other).abs() < 1e-10, "shifted back: {other}");
                }
            }
        }
    }

    #[test]
    fn the_bytes_do_not_depend_on_the_number_of_threads() {
        let picture = noisy(90, 70, 5);
        let one = overlap_autocorrelation(&picture, 1);
        for n in [2, 3, 8] {
            let many = overlap_autocorrelation(&picture, n);
            let is_same = one
                .values()
                .iter()
                .zip(many.values())
                .all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(is_same, "{n} threads");
        }
    }

    #[test]
    fn one_colour_correlates_with_nothing() {
        let rho = overlap_autocorrelation(&Grid::filled(40, 30, 0.3), 2);
        assert!(rho.values().iter().all(|&x| x == 0.0), "one colour");
    }
}
