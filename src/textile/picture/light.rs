//! Uneven light: what varies over the whole picture is divided out.

use super::source::between;
use selvedge_foundation::numerics::{Grid, to_index};

/// The smooth part is taken over this share of the shorter side unless a radius is said.
const SHARE_OF_SIDE: f64 = 0.125;
/// A smooth part that holds less than this share of the variance is left alone by `Auto`.
const MIN_SHARE: f64 = 0.01;
/// The smooth part is never taken as darker than this share of the mean.
const DARKEST: f64 = 0.05;
/// A standard deviation of the smooth part is at least so many blocks, and a side so many: a block
/// widens it by 1/24 of their square, by a six-thousandth.
const BLOCKS_A_SIGMA: f64 = 16.0;
const MIN_BLOCKS: f64 = 64.0;
/// Three box filters in a row are about a Gaussian.
const N_PASSES: usize = 3;

/// Whether uneven light is divided out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum EvenLight {
    /// Where it holds a hundredth of the variance or more.
    #[default]
    Auto,
    /// Never.
    Off,
    /// Always, with a smooth part of this standard deviation, px.
    Radius(f64),
}

/// The picture with its light evened out, and whether anything was done. The mean stays.
pub fn even_light(mut luminance: Grid<f64>, how: EvenLight) -> (Grid<f64>, bool) {
    let side = luminance.width().min(luminance.height()) as f64;
    let sigma = match how {
        EvenLight::Off => return (luminance, false),
        EvenLight::Auto => SHARE_OF_SIDE * side,
        EvenLight::Radius(sigma) => sigma,
    };
    // What is smooth is known by the means of blocks that are small beside it.
    let most = to_index(side / MIN_BLOCKS).max(1);
    let block = to_index(sigma / BLOCKS_A_SIGMA).clamp(1, most);
    let smooth = smoothed(blocks(&luminance, block), sigma / block as f64);
    let (mean, variance) = mean_and_variance(&luminance);
    let is_even = mean_and_variance(&smooth).1 < MIN_SHARE * variance;
    if mean <= 0.0 || (how == EvenLight::Auto && is_even) {
        return (luminance, false);
    }
    let place = |px: usize| (px as f64 + 0.5) / block as f64 - 0.5;
    for row in 0..luminance.height() {
        for (column, value) in luminance.row_mut(row).iter_mut().enumerate() {
            let at = [place(column), place(row)];
            let light = between(&smooth, at, |a, b, share| a + (b - a) * share);
            *value *= mean / light.max(DARKEST * mean);
        }
    }
    (luminance, true)
}

/// Means of squares of so many pixels a side, the last ones of what is there.
fn blocks(grid: &Grid<f64>, side: usize) -> Grid<f64> {
    let (width, height) = (grid.width(), grid.height());
    Grid::from_fn(width.div_ceil(side), height.div_ceil(side), |i, j| {
        let columns = i * side..((i + 1) * side).min(width);
        let rows = j * side..((j + 1) * side).min(height);
        let n = (columns.len() * rows.len()) as f64;
        let sums = rows.map(|row| grid.row(row)[columns.clone()].iter().sum::<f64>());
        sums.sum::<f64>() / n
    })
}

/// Mean and variance of a grid; 0 of none.
pub(super) fn mean_and_variance(grid: &Grid<f64>) -> (f64, f64) {
    let n = (grid.values().len()).max(1) as f64;
    let mean = grid.values().iter().sum::<f64>() / n;
    let square = |x: &f64| (x - mean).powi(2);
    (mean, grid.values().iter().map(square).sum::<f64>() / n)
}

/// A grid smoothed by about a Gaussian of standard deviation `sigma`, which fades to the mean of
/// what is there at the edges.
fn smoothed(mut smooth: Grid<f64>, sigma: f64) -> Grid<f64> {
    // A box of 2r + 1 has the variance r(r + 1)/3; three of them add up.
    let widest = smooth.width().max(smooth.height()) as f64;
    let radius = ((0.25 + sigma * sigma).sqrt() - 0.5).min(widest);
    let radius = to_index(radius.round());
    for _ in 0..N_PASSES {
        for row in 0..smooth.height() {
            box_filter(smooth.row_mut(row), radius);
        }
        box_down(&mut smooth, radius);
    }
    smooth
}

/// Means over up to `radius` neighbours on either side, as many as there are.
fn box_filter(row: &mut [f64], radius: usize) {
    let mut sums = Vec::with_capacity(row.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for x in row.iter() {
        sum += x;
        sums.push(sum);
    }
    let n = row.len();
    for (i, x) in row.iter_mut().enumerate() {
        let (from, to) = (
            i.saturating_sub(radius),
            i.saturating_add(radius + 1).min(n),
        );
        *x = (sums[to] - sums[from]) / (to - from) as f64;
    }
}

/// Columns that are filtered together: as many as a cache line feeds.
const N_TOGETHER: usize = 8;

/// The same along columns.
fn box_down(grid: &mut Grid<f64>, radius: usize) {
    let (width, height) = (grid.width(), grid.height());
    let mut columns = vec![0.0; N_TOGETHER * height];
    for first in (0..width).step_by(N_TOGETHER) {
        let n = N_TOGETHER.min(width - first);
        for row in 0..height {
            for (i, x) in grid.row(row)[first..first + n].iter().enumerate() {
                columns[i * height + row] = *x;
            }
        }
        for column in columns.chunks_exact_mut(height).take(n) {
            box_filter(column, radius);
        }
        for row in 0..height {
            for (i, x) in grid.row_mut(row)[first..first + n].iter_mut().enumerate() {
                *x = columns[i * height + row];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threads(light: impl Fn(f64, f64) -> f64) -> Grid<f64> {
        let value = |i: usize| {
            let (x, y) = ((i % 160) as f64, (i / 160) as f64);
            light(x, y) * (0.5 + 0.2 * (x * 0.9).sin() * (y * 0.7).sin())
        };
        Grid::from_rows(160, (0..160 * 120).map(value).collect()).unwrap()
    }

    #[test]
    fn a_shadow_is_divided_out_and_even_light_left_alone() {
        let even = threads(|_, _| 1.0);
        assert_eq!(
            even_light(even.clone(), EvenLight::Auto),
            (even.clone(), false)
        );
        let shaded = threads(|x, y| 0.5 + 0.003 * x + 0.002 * y);
        let (mended, is_done) = even_light(shaded.clone(), EvenLight::Auto);
        assert!(is_done, "the shadow is seen");
        let ratio = |of: &Grid<f64>, i: usize| of.values()[i] / even.values()[i];
        let spread = |of: &Grid<f64>| {
            let all: Vec<f64> = (0..160 * 120)
                .filter(|i| (20..140).contains(&(i % 160)))
                .map(|i| ratio(of, i))
                .collect();
            let max = all.iter().copied().fold(0.0, f64::max);
            max / all.iter().copied().fold(f64::INFINITY, f64::min)
        };
        assert!(
            spread(&shaded) > 1.9 && spread(&mended) < 1.35,
            "{} to {}",
            spread(&shaded),
            spread(&mended)
        );
        let (mean, _) = mean_and_variance(&mended);
        assert!((mean - mean_and_variance(&shaded).0).abs() < 0.02, "{mean}");
    }

    #[test]
    fn smoothing_keeps_a_constant_and_any_radius_is_finite() {
        let flat = Grid::filled(9, 5, 0.4);
        for sigma in [0.0, 1.0, 50.0, 1e300] {
            let smooth = smoothed(flat.clone(), sigma);
            assert!(
                smooth.values().iter().all(|x| (x - 0.4).abs() < 1e-12),
                "{sigma}"
            );
        }
        let black = Grid::filled(6, 6, 0.0);
        assert_eq!(
            even_light(black.clone(), EvenLight::Radius(2.0)),
            (black.clone(), false)
        );
    }
}
