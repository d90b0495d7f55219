//! What is read from a picture of a cloth: the strip under the finger, registered with the trace.
//!
//! Pictures are brought to [`PER_MM`] first, and a strip is 10 mm high, so that pixel column and
//! sample of friction are the same place. Nothing is cropped along the path.

use selvedge_foundation::numerics::{Grid, to_index, to_single};

use crate::cloth::{FINGER_ROWS, PER_MM};
use crate::signal::{N_BINS, spectra};

/// Kinds of spectra that are read from a strip.
pub(crate) const N_CHANNELS: usize = 3;
/// Figures of the whole strip.
pub(crate) const N_FIGURES: usize = 2 * N_BANDS + 5 + SHARES.len();
/// Bands of wavenumbers, along and across the path.
pub(crate) const N_BANDS: usize = 16;
/// Shares of pixels that are darker than what is told: how a cloth shines and shades.
const SHARES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];
/// Rows between those whose spectra are averaged.
const ROW_STEP: usize = 2;

/// What is known of a strip.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Looks {
    /// Registered with the spectra of the trace, a row a frame, a column a bin, `ln(1 + m)` of
    /// magnitudes of brightness relative to the mean: of all rows together (what stands across
    /// the path), of each row by itself (root mean square), of the rows' local contrast.
    pub channels: [Grid<f32>; N_CHANNELS],
    /// Spectra in bands along and across, contrast, skewness, steepness along and across, mean
    /// brightness, quantiles of brightness.
    pub figures: Vec<f64>,
}

impl Looks {
    /// What a strip of brightness 0 to 1 looks like. A strip without light or contrast has figures
    /// like any other: those of nothing.
    pub(crate) fn of(strip: &Grid<f32>) -> Self {
        let mean = mean(strip.values().iter().map(|&v| f64::from(v))).max(1e-3);
        let relative = |v: f32| f64::from(v) / mean - 1.0;
        let n = strip.width();
        let (mut together, mut contrast) = (vec![0.0; n], vec![0.0; n]);
        let rows: Vec<Vec<f64>> = (0..strip.height())
            .map(|row| strip.row(row).iter().map(|&v| relative(v)).collect())
            .collect();
        let share = 1.0 / rows.len().max(1) as f64;
        for row in &rows {
            for (at, value) in row.iter().enumerate() {
                together[at] += share * value;
                let step = row[(at + 1).min(n - 1)] - value;
                contrast[at] += share * step.abs();
            }
        }
        let typical = self::mean(contrast.iter().copied());
        for value in &mut contrast {
            *value -= typical;
        }
        let stft = spectra();
        let n_frames = stft.n_frames(n);
        let mut apart = Grid::filled(N_BINS, n_frames, 0.0);
        let read = rows.iter().step_by(ROW_STEP);
        let share = 1.0 / read.len().max(1) as f64;
        for row in read {
            let spectra = stft.forward(row);
            for (sum, x) in apart.values_mut().iter_mut().zip(spectra.values()) {
                *sum += share * x.norm_sqr();
            }
        }
        let log = |m: f64| to_single(m.ln_1p());
        let channels = [
            stft.forward(&together).map(|x| log(x.norm())),
            apart.map(|power: f64| log(power.sqrt())),
            stft.forward(&contrast).map(|x| log(4.0 * x.norm())),
        ];
        let figures = figures(&rows, &apart, mean);
        Self { channels, figures }
    }
}

/// The mean; 0 of none.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), value| (n + 1.0, sum + value));
    sum / f64::max(n, 1.0)
}

/// Edges of bands of bins, each about 1.35 times as far as the one before.
pub(crate) fn band_edges() -> Vec<usize> {
    let edge = |band: usize| {
        let share = band as f64 / N_BANDS as f64;
        to_index((N_BINS as f64 / 2.0).powf(share) * 2.0 + 0.5)
    };
    let mut edges: Vec<usize> = (0..=N_BANDS).map(edge).collect();
    for band in 1..edges.len() {
        edges[band] = edges[band].max(edges[band - 1] + 1).min(N_BINS);
    }
    edges
}

/// Figures of the whole strip.
fn figures(rows: &[Vec<f64>], apart: &Grid<f64>, brightness: f64) -> Vec<f64> {
    let edges = band_edges();
    let in_bands = |spectra: &Grid<f64>| -> Vec<f64> {
        let power = |band: &[usize]| {
            let powers =
                (0..spectra.height()).flat_map(|frame| &spectra.row(frame)[band[0]..band[1]]);
            mean(powers.copied())
        };
        edges
            .windows(2)
            .map(|band| (1e-4 + power(band)).ln())
            .collect()
    };
    let values = || rows.iter().flatten().copied();
    let moment = |power: i32| mean(values().map(|v| v.powi(power)));
    let contrast = moment(2).sqrt();
    let along = rows
        .iter()
        .flat_map(|row| row.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)));
    let across = rows
        .windows(2)
        .flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a).powi(2)));
    let log = |x: f64| (1e-4 + x).ln();
    let mut figures = in_bands(apart);
    figures.extend(in_bands(&across_spectra(rows)));
    figures.extend([
        log(contrast),
        moment(3) / (1e-3 + contrast).powi(3),
        log(mean(along).sqrt()),
        log(mean(across).sqrt()),
        brightness,
    ]);
    figures.extend(quantiles(
        rows.iter().step_by(ROW_STEP).flatten().copied().collect(),
    ));
    figures
}

/// What [`SHARES`] of values, which rise, are not above; 0 of none. Nothing is put in order that
/// nobody asks for.
fn quantiles(mut values: Vec<f64>) -> [f64; SHARES.len()] {
    let last = values.len().saturating_sub(1) as f64;
    let mut begun = 0;
    SHARES.map(|share| {
        let at = to_index(share * last);
        let rest = &mut values[begun..];
        if rest.is_empty() {
            return 0.0;
        }
        let nth = at - begun;
        begun = at;
        *rest.select_nth_unstable_by(nth, f64::total_cmp).1
    })
}

/// Powers of columns, each continued to a frame by mirroring: some of them stand for all.
fn across_spectra(rows: &[Vec<f64>]) -> Grid<f64> {
    let stft = spectra();
    let n = rows.first().map_or(0, Vec::len);
    let columns: Vec<usize> = (0..n).step_by(16).collect();
    let mut powers = Grid::filled(N_BINS, 1, 0.0);
    let share = 1.0 / columns.len().max(1) as f64;
    for column in columns {
        let values: Vec<f64> = rows.iter().map(|row| row[column]).collect();
        let frame = stft.forward(&values);
        for (sum, x) in powers.values_mut().iter_mut().zip(frame.row(0)) {
            *sum += share * x.norm_sqr();
        }
    }
    powers
}

/// The strip of [`FINGER_ROWS`] rows at [`PER_MM`] in the middle of a picture of any scale (means
/// over what a new pixel covers, or between pixels where it is coarser): of those that lie above
/// one another from the top, the middle one. None if the picture is lower.
pub(crate) fn middle_strip(picture: &Grid<f32>, px_per_mm: f64) -> Option<Grid<f32>> {
    let step = px_per_mm / PER_MM;
    let is_same = (step - 1.0).abs() < 1e-9;
    let height = if is_same {
        picture.height()
    } else {
        to_index(picture.height() as f64 / step)
    };
    let n_strips = height / FINGER_ROWS;
    let top = n_strips / 2 * FINGER_ROWS;
    if n_strips == 0 {
        None
    } else if is_same {
        picture.part([0, top, picture.width(), FINGER_ROWS])
    } else {
        Some(rescaled(picture, step, top))
    }
}

/// So many rows from `top` on of a picture whose pixels are `step` times as far apart: only what
/// they cover is read.
fn rescaled(picture: &Grid<f32>, step: f64, top: usize) -> Grid<f32> {
    let [width, height] = [picture.width(), picture.height()];
    let half = 0.5 * (step - 1.0).max(0.0);
    let middle = |at: usize| (at as f64 + 0.5) * step - 0.5;
    let along = |value: &dyn Fn(usize) -> f32, at: usize, n: usize| {
        let n_points = to_index(2.0 * half.ceil()) + 1;
        let sum: f64 = (0..n_points)
            .map(|point| {
                let shift = if n_points == 1 {
                    0.0
                } else {
                    half * (2.0 * point as f64 / (n_points - 1) as f64 - 1.0)
                };
                let place = (middle(at) + shift).clamp(0.0, (n - 1) as f64);
                let before = to_index(place).min(n.saturating_sub(2));
                let share = place - before as f64;
                let [a, b] = [before, (before + 1).min(n - 1)].map(|at| f64::from(value(at)));
                a + (b - a) * share
            })
            .sum();
        to_single(sum / n_points as f64)
    };
    let n_columns = to_index(width as f64 / step);
    // A row to either side for what rounds there.
    let first = to_index((middle(top) - half - 2.0).max(0.0));
    let last = to_index(middle(top + FINGER_ROWS) + half + 2.0).min(height - 1);
    let rows = Grid::from_fn(n_columns, last + 1 - first, |column, row| {
        along(&|at| picture.row(first + row)[at], column, width)
    });
    Grid::from_fn(n_columns, FINGER_ROWS, |column, row| {
        along(&|at| rows.row(at - first)[column], top + row, height)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_strip_lies_where_it_does_at_any_scale() {
        let slope = |x: f64, y: f64| 0.2 + 1e-4 * x + 3e-4 * y;
        for step in [0.5, 1.0, 1.7, 2.0] {
            let side = to_index(700.0 * step);
            let picture = Grid::from_fn(side, side, |x, y| {
                to_single(slope(x as f64 / step, y as f64 / step))
            });
            let strip = middle_strip(&picture, step * PER_MM).unwrap();
            assert_eq!((strip.width(), strip.height()), (700, FINGER_ROWS));
            // Of five strips that lie above one another, the third.
            let top = 2 * FINGER_ROWS;
            let middle = 0.5 - 0.5 / step;
            for (column, row) in [(10, 0), (350, 70), (690, FINGER_ROWS - 1)] {
                let expected = slope(column as f64 + middle, (top + row) as f64 + middle);
                let found = f64::from(strip.row(row)[column]);
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{step}: {found} {expected}"
                );
            }
        }
        let low = Grid::filled(600, 2 * FINGER_ROWS - 1, 0.5);
        assert_eq!(middle_strip(&low, 2.0 * PER_MM), None, "lower than 10 mm");
    }

    #[test]
    fn quantiles_are_those_of_values_in_order() {
        let values = |n: usize| (0..n).map(|at| ((at * 37) % n) as f64).collect::<Vec<_>>();
        let last = 1000.0;
        assert_eq!(
            quantiles(values(1001)),
            SHARES.map(|share| (share * last).floor())
        );
        assert_eq!(quantiles(values(1)), [0.0; SHARES.len()]);
        assert_eq!(quantiles(Vec::new()), [0.0; SHARES.len()]);
    }
}
