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

/// What is measured, in the order of columns of files; all but two are best at 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Root mean square difference of magnitudes.
    SpectrogramRmse,
    /// Mean absolute difference of magnitudes.
    SpectrogramMae,
    /// Root mean square difference of traces.
    SignalRmse,
    /// Mean absolute difference of traces.
    SignalMae,
    /// The same root, % of the level that was felt.
    SignalRmsePercent,
    /// Difference of levels, % of the one that was felt.
    LevelError,
    /// Standard deviation over that of what was felt: best at 1.
    DeviationRatio,
    /// Distance of spectra, dB.
    LogSpectral,
    /// Difference of seven bands' energies, dB.
    BandEnergy,
    /// Difference of the strongest bins' periods, mm.
    DominantPeriod,
    /// Pearson's, of traces: best at 1.
    Correlation,
    /// The mean absolute difference of traces, % of the level.
    SignalMaePercent,
}

/// A prediction by each [`Measure`].
pub type Measures = [f64; Measure::N];

impl Measure {
    /// How many there are.
    pub const N: usize = Self::COLUMNS.len();
    /// Their names, with units, as columns of files.
    pub const COLUMNS: [&str; 12] = [
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

    /// Its column.
    pub const fn column(self) -> &'static str {
        Self::COLUMNS[self as usize]
    }

    /// Its own of what there is by each.
    pub const fn of<T: Copy>(self, all: &[T; Self::N]) -> T {
        all[self as usize]
    }
}

/// A prediction against the trace that was felt, by each [`Measure`].
pub(crate) fn score(predicted: &Prediction, felt: &[f64]) -> Measures {
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
        for ((found, expected), measure) in perfect.iter().zip(expected).zip(Measure::COLUMNS) {
            assert!((found - expected).abs() < 1e-9, "{measure}: {found}");
        }
        let level = example.course.level;
        let flat = score(&Prediction::of_trace(vec![1.02 * level; felt.len()]), felt);
        assert!(
            (Measure::LevelError.of(&flat) - 2.0).abs() < 1e-9,
            "{}",
            Measure::LevelError.of(&flat)
        );
        assert!(
            (flat[11] - 100.0 * flat[3] / level).abs() < 1e-9,
            "{flat:?}"
        );
        assert!(
            Measure::LogSpectral.of(&flat) > 5.0
                && Measure::Correlation.of(&flat) == 0.0
                && Measure::DeviationRatio.of(&flat) < 1e-9,
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
                Measure::LogSpectral.of(&best) < Measure::LogSpectral.of(&flat),
                "{window:?}: {best:?}, {flat:?}"
            );
            assert!(Measure::LevelError.of(&best) < 5.0, "{best:?}");
        }
    }
}
