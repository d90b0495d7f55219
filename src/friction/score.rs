//! How far a predicted trace is from the one that was felt.

use selvedge_foundation::numerics::{Grid, GriffinLim, StartPhases};

use crate::picture::{band_edges, mean};
use crate::signal::{Course, HOP, magnitudes_of, spectra};

/// The first bin that neither the mean nor what is slow reaches.
const FIRST_BIN: usize = 3;
/// Magnitudes are compared in dB above this: half of what a sensor's noise leaves.
const FLOOR: f64 = 0.01;

/// What was predicted.
#[derive(Debug, Clone)]
pub(crate) struct Prediction {
    /// Magnitudes of the whole trace, a row a frame.
    pub magnitudes: Grid<f64>,
    /// The trace.
    pub trace: Vec<f64>,
}

impl Prediction {
    /// A trace that is predicted whole.
    pub(crate) fn of_trace(trace: Vec<f64>) -> Self {
        Self {
            magnitudes: magnitudes_of(&trace),
            trace,
        }
    }

    /// A trace that is predicted by its parts.
    pub(crate) fn of_course(course: &Course) -> Self {
        let n_samples = (course.log_magnitudes.height() - 1) * HOP;
        Self {
            magnitudes: course.whole_magnitudes(n_samples),
            trace: course.trace(n_samples, None),
        }
    }

    /// A trace that is predicted by the magnitudes of all of it.
    pub(crate) fn of_magnitudes(magnitudes: Grid<f64>) -> Self {
        let n_samples = (magnitudes.height() - 1) * HOP;
        let start = StartPhases::OfConstant(0);
        let trace = spectra().griffin_lim(&magnitudes, n_samples, start, GriffinLim::default());
        Self { magnitudes, trace }
    }
}

/// What is measured, as columns of files; all but the ratio of deviations and the correlation are
/// best at 0.
pub(crate) const MEASURES: [&str; 12] = [
    "spectrogram_rmse",
    "spectrogram_mae",
    "signal_rmse",
    "signal_mae",
    "signal_rmse_percent",
    "level_error_percent",
    "deviation_ratio",
    "log_spectral_distance_db",
    "band_energy_error_db",
    "dominant_period_error_mm",
    "correlation",
    "signal_mae_percent",
];

/// The place of a measure in [`MEASURES`].
pub(crate) const LEVEL: usize = 5;
/// The place of another.
pub(crate) const LOG_SPECTRAL: usize = 7;

/// A prediction against the trace that was felt, by each of [`MEASURES`].
pub(crate) fn score(predicted: &Prediction, felt: &[f64]) -> [f64; MEASURES.len()] {
    let truth = Prediction::of_trace(felt.to_vec());
    let bins = || {
        predicted
            .magnitudes
            .values()
            .iter()
            .zip(truth.magnitudes.values())
    };
    let samples = || predicted.trace.iter().zip(felt);
    let [p, t] = [&predicted.trace, &truth.trace].map(|trace| Course::of(trace));
    let signal_rms = rms(samples());
    let signal_mae = mean(samples().map(|(a, b)| (a - b).abs()));
    [
        rms(bins()),
        mean(bins().map(|(a, b)| (a - b).abs())),
        signal_rms,
        signal_mae,
        100.0 * signal_rms / t.level,
        100.0 * (p.level - t.level).abs() / t.level,
        deviation(&predicted.trace) / deviation(felt),
        log_spectral_distance(&predicted.magnitudes, &truth.magnitudes),
        band_error(&predicted.magnitudes, &truth.magnitudes),
        (period_mm(&predicted.magnitudes) - period_mm(&truth.magnitudes)).abs(),
        correlation(&predicted.trace, felt),
        100.0 * signal_mae / t.level,
    ]
}

fn rms<'a>(pairs: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    mean(pairs.map(|(a, b)| (a - b).powi(2))).sqrt()
}

fn deviation(trace: &[f64]) -> f64 {
    let middle = mean(trace.iter().copied());
    mean(trace.iter().map(|f| (f - middle).powi(2))).sqrt()
}

fn db(magnitude: f64) -> f64 {
    20.0 * (magnitude.max(0.0) + FLOOR).log10()
}

/// Root mean square difference of magnitudes in dB, a frame; the mean of all frames.
fn log_spectral_distance(predicted: &Grid<f64>, truth: &Grid<f64>) -> f64 {
    mean((0..truth.height()).map(|frame| {
        let pairs = predicted
            .row(frame)
            .iter()
            .zip(truth.row(frame))
            .skip(FIRST_BIN);
        mean(pairs.map(|(a, b)| (db(*a) - db(*b)).powi(2))).sqrt()
    }))
}

/// Mean square of each bin over all frames.
fn powers(magnitudes: &Grid<f64>) -> Vec<f64> {
    let mut powers = vec![0.0; magnitudes.width()];
    for frame in 0..magnitudes.height() {
        let row = magnitudes.row(frame).iter();
        powers
            .iter_mut()
            .zip(row)
            .for_each(|(sum, m)| *sum += m * m);
    }
    powers
        .iter()
        .map(|sum| sum / magnitudes.height().max(1) as f64)
        .collect()
}

/// Mean absolute difference of the energies of seven bands, dB.
fn band_error(predicted: &Grid<f64>, truth: &Grid<f64>) -> f64 {
    let edges: Vec<usize> = band_edges()
        .into_iter()
        .step_by(2)
        .map(|edge| edge.max(FIRST_BIN))
        .collect();
    let [p, t] = [predicted, truth].map(powers);
    let bands = edges[1..].windows(2);
    mean(bands.map(|band| {
        let [p, t] = [&p, &t].map(|powers| mean(powers[band[0]..band[1]].iter().copied()));
        (db(p.sqrt()) - db(t.sqrt())).abs()
    }))
}

/// The period of the strongest bin, mm.
fn period_mm(magnitudes: &Grid<f64>) -> f64 {
    let powers = powers(magnitudes);
    let bins = powers.iter().enumerate().skip(FIRST_BIN);
    let strongest = bins
        .max_by(|a, b| a.1.total_cmp(b.1))
        .map_or(FIRST_BIN, |(bin, _)| bin);
    crate::signal::FRAME as f64 / crate::cloth::PER_MM / strongest as f64
}

/// Pearson's correlation; 0 where one of both does not vary.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let [ma, mb] = [a, b].map(|trace| mean(trace.iter().copied()));
    let product = mean(a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)));
    let scale = deviation(a) * deviation(b);
    if scale > 1e-15 { product / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split::Split;

    #[test]
    fn a_perfect_prediction_has_no_error_and_a_constant_has_the_stated_ones() {
        let example = Split::Cloths.windows(1)[1][0].taken();
        let felt = &example.trace;
        let perfect = score(&Prediction::of_trace(felt.clone()), felt);
        let expected = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        for ((found, expected), measure) in perfect.iter().zip(expected).zip(MEASURES) {
            assert!((found - expected).abs() < 1e-9, "{measure}: {found}");
        }
        let level = example.course.level;
        let flat = score(&Prediction::of_trace(vec![1.02 * level; felt.len()]), felt);
        assert!((flat[LEVEL] - 2.0).abs() < 1e-9, "{}", flat[LEVEL]);
        assert!(
            (flat[11] - 100.0 * flat[3] / level).abs() < 1e-9,
            "{flat:?}"
        );
        assert!(
            flat[LOG_SPECTRAL] > 5.0 && flat[10] == 0.0 && flat[6] < 1e-9,
            "{flat:?}"
        );
    }

    #[test]
    fn the_best_possible_beats_the_right_constant_in_what_means_something() {
        let windows = &Split::Cloths.windows(1)[1];
        for window in windows {
            let example = window.taken();
            let best = Prediction::of_course(&example.best_possible());
            let best = score(&best, &example.trace);
            let flat = vec![example.course.level; example.trace.len()];
            let flat = score(&Prediction::of_trace(flat), &example.trace);
            assert!(
                best[LOG_SPECTRAL] < flat[LOG_SPECTRAL],
                "{window:?}: {best:?}, {flat:?}"
            );
            assert!(best[LEVEL] < 5.0, "{best:?}");
        }
    }
}
