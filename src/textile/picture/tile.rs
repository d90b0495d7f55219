//! The primitive tile: the mean of all cells of a picture, and textile made of it again.
//!
//! Averaging modulo the lattice leaves what repeats; the noise of single threads falls with the
//! square root of the number of cells.

use super::basis::{Basis, Place, dot, greatest_divisor, length, whole};
use super::light::mean_and_variance;
use selvedge_foundation::numerics::{Grid, in_pieces, to_index};

/// Samples of a tile at most.
const MAX_SAMPLES: f64 = 1_048_576.0;
/// With this many cells there are enough pixels for two samples a pixel along either vector.
const CELLS_FOR_TWO: f64 = 16.0;
/// Bands of rows that are folded each for itself, whatever the number of threads.
const N_BANDS: usize = 8;

/// One cell of a lattice, sampled as a parallelogram: sample (i, j) stands at
/// `i/width·p1 + j/height·p2` from the centre of the picture's first pixel. Periodic in both.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Samples along p1 (a row) by samples along p2, luminance 0…1.
    pub values: Grid<f64>,
    /// The first lattice vector, px.
    pub p1_px: Place,
    /// The second lattice vector, px.
    pub p2_px: Place,
}

/// A rectangle of textile, periodic in both directions, its first axis turned in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Rectangle {
    /// Samples, rows along the first axis.
    pub values: Grid<f64>,
    /// Size, px of the picture.
    pub size_px: [f64; 2],
    /// Direction of the first axis in the picture, radians clockwise from x to the right.
    pub angle_rad: f64,
    /// How far the lattice's own axes are from a right angle, radians: what the rectangle is
    /// sheared by.
    pub(crate) shear_rad: f64,
}

/// Combinations of the vectors that are tried as sides of a rectangle, each way.
const MAX_STEPS: isize = 8;
/// Sides this far from a right angle still make a rectangle, radians.
const MAX_SHEAR: f64 = 0.035;

impl Tile {
    /// The mean of all cells of a picture.
    pub fn fold(luminance: &Grid<f64>, basis: Basis, n_threads: usize) -> Self {
        let whole = [0, 0, luminance.width(), luminance.height()];
        Self::fold_part(luminance, whole, basis, n_threads)
    }

    /// The mean of all cells of a part of a picture (left, top, width, height, px), which begins
    /// at the part's first pixel.
    pub(super) fn fold_part(
        luminance: &Grid<f64>,
        part: [usize; 4],
        basis: Basis,
        n_threads: usize,
    ) -> Self {
        let size = samples(&basis, part[2] * part[3]);
        let mut folded = folded((luminance, part), &basis, size, n_threads);
        fill(&mut folded);
        let values = folded.iter().map(|[sum, weight]| sum / weight);
        let values = Grid::from_rows(size[0], values.collect());
        Self {
            values: values.unwrap_or_else(|| Grid::filled(1, 1, 0.0)),
            p1_px: basis.p1,
            p2_px: basis.p2,
        }
    }

    /// Its lattice.
    pub fn basis(&self) -> Basis {
        Basis::new(self.p1_px, self.p2_px)
    }

    /// The value at lattice coordinates (u, v), bilinear and periodic.
    pub fn at(&self, place: Place) -> f64 {
        between(&self.values, place, |a, b, share| a + share * (b - a))
    }

    /// A picture of so many columns and rows made of it, sample by sample as they are asked for.
    pub(super) fn samples(&self, [width, height]: [usize; 2]) -> impl Iterator<Item = f64> {
        let basis = self.basis();
        let places = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        places.map(move |place| self.at(basis.coordinates(place.map(|n| n as f64))))
    }

    /// Textile of any size made of it: sample (x, y) of the patch lies at
    /// `step_px·(x along, y across)` from the picture's first pixel, along turned by `angle_rad`
    /// clockwise from x to the right.
    pub fn patch(
        &self,
        width: usize,
        height: usize,
        step_px: f64,
        angle_rad: f64,
        n_threads: usize,
    ) -> Grid<f64> {
        let basis = self.basis();
        let (s, c) = angle_rad.sin_cos();
        let along = basis.coordinates([step_px * c, step_px * s]);
        let across = basis.coordinates([-step_px * s, step_px * c]);
        self.sampled([width, height], [along, across], n_threads)
    }

    /// The values at lattice coordinates `x·along + y·across`.
    fn sampled(
        &self,
        [width, height]: [usize; 2],
        [along, across]: [Place; 2],
        n_threads: usize,
    ) -> Grid<f64> {
        let mut samples = Grid::filled(width, height, 0.0);
        let work = |(): &mut (), row: usize, values: &mut [f64]| {
            let y = row as f64;
            for (x, value) in values.iter_mut().enumerate() {
                let x = x as f64;
                *value = self.at([x * along[0] + y * across[0], x * along[1] + y * across[1]]);
            }
        };
        in_pieces(samples.values_mut(), width, n_threads, || (), work);
        samples
    }

    /// The smallest rectangle that repeats, if the lattice has one: two of its vectors at a right
    /// angle, up to a small shear. Samples are about `step_px` apart, a whole number a side.
    pub fn rectangle(&self, step_px: f64, n_threads: usize) -> Option<Rectangle> {
        let basis = self.basis();
        let (first, second) = right_angle(&basis)?;
        let at = |index: [isize; 2]| index.map(|x| x as f64);
        let (a, b) = (basis.place(at(first)), basis.place(at(second)));
        let size_px = [length(a), length(b)];
        let n = size_px.map(|side| {
            whole((side / step_px).clamp(1.0, 8192.0))
                .max(1)
                .cast_unsigned()
        });
        let along = at(first).map(|x| x / n[0] as f64);
        let across = at(second).map(|x| x / n[1] as f64);
        Some(Rectangle {
            values: self.sampled(n, [along, across], n_threads),
            size_px,
            angle_rad: a[1].atan2(a[0]),
            shear_rad: cosine(a, b).asin(),
        })
    }

    /// Share of the variance of a picture that the tile explains, adjusted for the number of
    /// samples it was made with: `1 − (SSE/(N − K))/(SST/(N − 1))`. About 0 for what does not
    /// repeat; 0 where nothing varies.
    pub fn explained_variance(&self, luminance: &Grid<f64>, n_threads: usize) -> f64 {
        let basis = self.basis();
        let step = basis.coordinates([1.0, 0.0]);
        let mut rows = vec![0.0; luminance.height()];
        let work = |(): &mut (), row: usize, sum: &mut [f64]| {
            let start = basis.coordinates([0.0, row as f64]);
            let mut left = 0.0;
            for (x, value) in luminance.row(row).iter().enumerate() {
                let x = x as f64;
                left += (self.at([start[0] + x * step[0], start[1] + x * step[1]]) - value).powi(2);
            }
            sum.fill(left);
        };
        in_pieces(&mut rows, 1, n_threads, || (), work);
        let left: f64 = rows.iter().sum();
        let n = luminance.values().len() as f64;
        let total = mean_and_variance(luminance).1 * n;
        // Two samples a pixel are no more freedom than the pixels of a cell.
        let freedom = (n - self.basis().area().max(1.0)).max(1.0);
        if total > 0.0 {
            1.0 - (left / freedom) / (total / (n - 1.0).max(1.0))
        } else {
            0.0
        }
    }
}

/// What repeats over a grid at lattice coordinates (u, v), bilinear.
#[inline]
pub(super) fn between<T: Copy>(cell: &Grid<T>, [u, v]: Place, blend: impl Fn(T, T, f64) -> T) -> T {
    let ([i, next_i], s) = around(u, cell.width());
    let ([j, next_j], t) = around(v, cell.height());
    let along = |row: &[T]| blend(row[i], row[next_i], s);
    blend(along(cell.row(j)), along(cell.row(next_j)), t)
}

/// The two samples of `n` a period that a coordinate lies between, and how far behind the first.
#[inline]
fn around(at: f64, n: usize) -> ([usize; 2], f64) {
    let place = (at - at.floor()) * n as f64;
    let first = to_index(place).min(n - 1);
    let next = if first + 1 == n { 0 } else { first + 1 };
    ([first, next], place - first as f64)
}

fn cosine(a: Place, b: Place) -> f64 {
    dot(a, b) / (length(a) * length(b))
}

/// The index vectors of the smallest rectangle, the one that is more level first.
fn right_angle(basis: &Basis) -> Option<([isize; 2], [isize; 2])> {
    let steps = || -MAX_STEPS..=MAX_STEPS;
    let all = steps().flat_map(|j| steps().map(move |i| [i, j]));
    let place = |[i, j]: [isize; 2]| basis.place([i as f64, j as f64]);
    // Half of them, the first pointing right; only those that are no multiple of another.
    let is_first = |&[i, j]: &[isize; 2]| {
        let [x, y] = place([i, j]);
        let is_right = x > 0.0 && y.abs() <= x * 1.001;
        is_right && is_primitive([i, j])
    };
    let firsts: Vec<[isize; 2]> = all.filter(is_first).collect();
    let mut best: Option<(f64, [isize; 2], [isize; 2])> = None;
    for first in firsts {
        for j in steps() {
            for i in steps().filter(|&i| is_primitive([i, j])) {
                let (a, b) = (place(first), place([i, j]));
                let is_down = b[1] > 0.0 && cosine(a, b).abs() <= MAX_SHEAR;
                let area = length(a) * length(b);
                if is_down && best.is_none_or(|(min, ..)| area < min * (1.0 - 1e-9)) {
                    best = Some((area, first, [i, j]));
                }
            }
        }
    }
    best.map(|(_, first, second)| (first, second))
}

fn is_primitive([i, j]: [isize; 2]) -> bool {
    greatest_divisor(i, j) == 1
}

/// Samples along either vector.
fn samples(basis: &Basis, n_pixels: usize) -> [usize; 2] {
    let fine = if n_pixels as f64 >= CELLS_FOR_TWO * basis.area() {
        2.0
    } else {
        1.0
    };
    let wanted = [basis.p1, basis.p2].map(|p| fine * length(p));
    let scale = (MAX_SAMPLES / (wanted[0] * wanted[1]).max(1.0))
        .sqrt()
        .min(1.0);
    wanted.map(|n| whole((n * scale).ceil().clamp(4.0, 16384.0)).cast_unsigned())
}

/// Sums of values and of weights in every sample of a cell.
fn folded(
    (luminance, [left, top, width, height]): (&Grid<f64>, [usize; 4]),
    basis: &Basis,
    [nu, nv]: [usize; 2],
    n_threads: usize,
) -> Vec<[f64; 2]> {
    let n_rows = height.div_ceil(N_BANDS).max(1);
    let mut bands = vec![vec![[0.0; 2]; nu * nv]; height.div_ceil(n_rows)];
    let step = basis.coordinates([1.0, 0.0]);
    let work = |(): &mut (), band: usize, sums: &mut [Vec<[f64; 2]>]| {
        let rows = band * n_rows..((band + 1) * n_rows).min(height);
        let Some(sums) = sums.first_mut() else { return };
        for row in rows {
            let start = basis.coordinates([0.0, row as f64]);
            let values = &luminance.row(top + row)[left..left + width];
            for (x, &value) in values.iter().enumerate() {
                let x = x as f64;
                let ([i, ni], s) = around(start[0] + x * step[0], nu);
                let ([j, nj], t) = around(start[1] + x * step[1], nv);
                for (index, weight) in [
                    (j * nu + i, (1.0 - s) * (1.0 - t)),
                    (j * nu + ni, s * (1.0 - t)),
                    (nj * nu + i, (1.0 - s) * t),
                    (nj * nu + ni, s * t),
                ] {
                    sums[index][0] += weight * value;
                    sums[index][1] += weight;
                }
            }
        }
    };
    in_pieces(&mut bands, 1, n_threads, || (), work);
    let mut all = vec![[0.0; 2]; nu * nv];
    for band in &bands {
        for (sum, part) in all.iter_mut().zip(band) {
            sum[0] += part[0];
            sum[1] += part[1];
        }
    }
    // A sample at the edge of a pixel's reach would be one pixel's noise blown up.
    for sum in &mut all {
        if sum[1] < 1e-3 {
            *sum = [0.0; 2];
        }
    }
    all
}

/// Samples that no pixel fell on get the mean of their row's neighbours, or of everything.
fn fill(sums: &mut [[f64; 2]]) {
    let total = sums
        .iter()
        .fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    let mean = if total[1] > 0.0 {
        total[0] / total[1]
    } else {
        0.0
    };
    let n = sums.len();
    let known: Vec<bool> = sums.iter().map(|s| s[1] > 0.0).collect();
    for i in (0..n).filter(|&i| !known[i]) {
        let before = (1..n).map(|k| (i + n - k) % n).take(64).find(|&k| known[k]);
        let after = (1..n).map(|k| (i + k) % n).take(64).find(|&k| known[k]);
        let near: Vec<f64> = [before, after]
            .into_iter()
            .flatten()
            .map(|k| sums[k][0] / sums[k][1])
            .collect();
        let value = if near.is_empty() {
            mean
        } else {
            near.iter().sum::<f64>() / near.len() as f64
        };
        sums[i] = [value, 1.0];
    }
}
