//! A friction trace taken apart and put together again.
//!
//! `f = level + trend + rest`: the level is the mean, the trend is what is slower than half a cycle
//! a centimetre (one value a frame of the spectra carries it), the rest is told by its short-time
//! magnitudes. Kept apart, the mean no longer rules what a network learns (it makes rows 0 and 1 of
//! a plain spectrogram some hundred times as large as all others).

use std::f64::consts::PI;

use selvedge_foundation::numerics::{Complex, Grid, GriffinLim, StartPhases, Stft, to_single};

/// Samples of a frame and from frame to frame, as Cai et al. (2021) have them.
pub(crate) const FRAME: usize = 512;
/// See [`FRAME`].
pub(crate) const HOP: usize = 128;
/// Bins of a frame.
pub(crate) const N_BINS: usize = FRAME / 2 + 1;
/// A magnitude m is learnt as `ln(1 + m / MAGNITUDE_SCALE)`: about what a sensor's noise leaves.
pub(crate) const MAGNITUDE_SCALE: f64 = 0.02;
/// Seed of the phases that a signal is found from.
const PHASE_SEED: u64 = 1984;

/// What is learnt and predicted of a trace.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Course {
    /// Mean coefficient of friction.
    pub level: f64,
    /// What is added to it slowly, at the middle of each frame.
    pub trend: Vec<f64>,
    /// `ln(1 + m / MAGNITUDE_SCALE)` of the rest: a row a frame, a column a bin.
    pub log_magnitudes: Grid<f32>,
}

/// The spectra of a trace.
pub(crate) fn spectra() -> Stft {
    Stft::hamming(FRAME, HOP)
}

/// The magnitudes of a whole trace, for those that predict them whole.
pub(crate) fn magnitudes_of(trace: &[f64]) -> Grid<f64> {
    spectra().forward(trace).map(Complex::norm)
}

impl Course {
    /// A trace taken apart.
    pub(crate) fn of(trace: &[f64]) -> Self {
        let slow = Slow::of(trace);
        let stft = spectra();
        let rest = Self::rest_of(trace);
        let log = |norm: f64| to_single((norm / MAGNITUDE_SCALE).ln_1p());
        Self {
            level: slow.cosines.first().copied().unwrap_or_default(),
            trend: slow.trend(stft.n_frames(trace.len())),
            log_magnitudes: stft.forward(&rest).map(|x| log(x.norm())),
        }
    }

    /// What is left of a trace without what is slow.
    pub(crate) fn rest_of(trace: &[f64]) -> Vec<f64> {
        let slow = Slow::of(trace);
        (0..trace.len())
            .map(|at| trace[at] - slow.at(at as f64))
            .collect()
    }

    /// Magnitudes of the rest.
    pub(crate) fn magnitudes(&self) -> Grid<f64> {
        self.log_magnitudes
            .map(|log| MAGNITUDE_SCALE * f64::from(log).exp_m1().max(0.0))
    }

    /// A trace of `n_samples` with this level, trend and rest, never below 0: what the spectra
    /// leave open, the phases, is found by rounds of projection from `phases`, or else from fixed
    /// ones.
    pub(crate) fn trace(&self, n_samples: usize, phases: Option<StartPhases<'_>>) -> Vec<f64> {
        let start = phases.unwrap_or(StartPhases::Random(PHASE_SEED));
        let stft = spectra();
        let rest = stft.griffin_lim(&self.magnitudes(), n_samples, start, GriffinLim::default());
        let slow = Slow::through(self.level, &self.trend, n_samples);
        let sum = rest
            .iter()
            .enumerate()
            .map(|(at, rest)| rest + slow.at(at as f64));
        sum.map(|f| f.max(0.0)).collect()
    }

    /// The magnitudes of the whole trace, mean and trend included, as the paper's spectrograms are.
    pub(crate) fn whole_magnitudes(&self, n_samples: usize) -> Grid<f64> {
        let slow = Slow::through(self.level, &self.trend, n_samples);
        let slow: Vec<f64> = (0..n_samples).map(|at| slow.at(at as f64)).collect();
        let slow = spectra().forward(&slow);
        let rest = self.magnitudes();
        // Their phases are unrelated.
        Grid::from_fn(rest.width(), rest.height(), |bin, frame| {
            slow.row(frame)[bin].norm().hypot(rest.row(frame)[bin])
        })
    }
}

/// What is slow of a trace, as cosines of 0, ½, 1, 1½ … cycles over its length.
struct Slow {
    cosines: Vec<f64>,
    n_samples: f64,
}

impl Slow {
    fn of(trace: &[f64]) -> Self {
        let n = trace.len() as f64;
        // Up to half a cycle a frame's step: 0.5 cycles/cm.
        let n_cosines = trace.len() / HOP + 1;
        let share = |k: usize| {
            let sum: f64 = (trace.iter().enumerate())
                .map(|(at, f)| f * (PI * k as f64 * (at as f64 + 0.5) / n).cos())
                .sum();
            sum * if k == 0 { 1.0 } else { 2.0 } / n.max(1.0)
        };
        Self {
            cosines: (0..n_cosines).map(share).collect(),
            n_samples: n,
        }
    }

    /// What has these values at the middles of frames (type-I cosine transform).
    fn through(level: f64, trend: &[f64], n_samples: usize) -> Self {
        let last = trend.len().saturating_sub(1).max(1);
        let share = |k: usize| {
            let is_end = |at: usize| at == 0 || at == last;
            let sum: f64 = (trend.iter().enumerate())
                .map(|(at, value)| {
                    let weight = if is_end(at) { 0.5 } else { 1.0 };
                    weight * value * (PI * (k * at) as f64 / last as f64).cos()
                })
                .sum();
            sum * if is_end(k) { 1.0 } else { 2.0 } / last as f64
        };
        let mut cosines: Vec<f64> = (0..trend.len()).map(share).collect();
        match cosines.first_mut() {
            Some(mean) => *mean += level,
            None => cosines.push(level),
        }
        Self {
            cosines,
            n_samples: n_samples as f64,
        }
    }

    fn at(&self, place: f64) -> f64 {
        let angle = PI * (place + 0.5) / self.n_samples;
        let cosines = self.cosines.iter().enumerate();
        cosines.map(|(k, a)| a * (angle * k as f64).cos()).sum()
    }

    /// Values at the middles of frames, without the level.
    fn trend(&self, n_frames: usize) -> Vec<f64> {
        let level = self.cosines.first().copied().unwrap_or_default();
        (0..n_frames)
            .map(|frame| self.at((frame * HOP) as f64 - 0.5) - level)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{Area, FINGER_ROWS, Family, Recipe};

    fn trace(n_samples: usize) -> Vec<f64> {
        let area = Area {
            columns: [0, n_samples],
            rows: [0, FINGER_ROWS],
        };
        let recipe = Recipe::of(Family::Twill, 8);
        recipe.rubbed(&recipe.relief_um(area), area, 0).friction
    }

    #[test]
    fn a_trace_comes_back_from_its_parts_when_the_phases_are_known() {
        for n_samples in [1280, 512] {
            let trace = trace(n_samples);
            let course = Course::of(&trace);
            assert_eq!(course.trend.len(), n_samples / HOP + 1);
            let mean = trace.iter().sum::<f64>() / n_samples as f64;
            assert!((course.level - mean).abs() < 1e-12);
            let slow = Slow::through(course.level, &course.trend, n_samples);
            let rest: Vec<f64> = (0..n_samples)
                .map(|at| trace[at] - slow.at(at as f64))
                .collect();
            let phases = spectra().forward(&rest);
            let back = course.trace(n_samples, Some(StartPhases::Of(&phases)));
            for (a, b) in trace.iter().zip(&back) {
                assert!((a - b).abs() < 1e-5, "{a} came back as {b}");
            }
        }
    }

    #[test]
    fn what_is_slow_is_all_of_a_slow_trace() {
        let wave = |at: i32| 0.4 + 0.02 * (PI * 7.0 * (f64::from(at) + 0.5) / 1280.0).cos();
        let trace: Vec<f64> = (0..1280).map(wave).collect();
        let course = Course::of(&trace);
        assert!((course.level - 0.4).abs() < 1e-12, "{}", course.level);
        assert!(course.log_magnitudes.values().iter().all(|&log| log < 1e-6));
        assert!((course.trend[0] - 0.02).abs() < 1e-12, "{:?}", course.trend);
        let whole = course.whole_magnitudes(1280);
        assert!((whole.row(5)[0] / (0.4 * spectra().gain()) - 1.0).abs() < 0.06);
    }

    #[test]
    fn an_empty_and_a_short_trace_are_taken_apart_without_a_panic() {
        for n_samples in [0, 1, 100] {
            let course = Course::of(&trace(1280)[..n_samples]);
            let back = course.trace(n_samples, None);
            assert!(
                back.iter().all(|f| f.is_finite() && *f >= 0.0),
                "{n_samples}"
            );
        }
    }
}
