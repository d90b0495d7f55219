//! What a network is compared with: all of it simple, some of it knowing what nobody can know.

use nalgebra::{DMatrix, DVector};

use selvedge_foundation::named;
use selvedge_foundation::numerics::{Grid, StartPhases, to_index, to_single};

use crate::cloth::PER_MM;
use crate::example::Example;
use crate::picture::N_FIGURES;
use crate::score::Prediction;
use crate::signal::{Course, N_BINS};

/// Log-spaced bands that the ridge regression predicts.
const N_RIDGE_BANDS: usize = 40;
/// Shrinkages that it chooses among by leave-one-out error, in units of a figure's variance.
const SHRINKAGES: [f64; 7] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0];

named! {
    /// A way to predict without a network.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Baseline {
        /// The mean level of what was learnt, flat.
        Mean = "training mean",
        /// Mean spectrum and level of the family, which is told.
        Class = "class spectrum",
        /// The true mean, flat: a warning, since the paper's signal score prefers it.
        OracleMean = "oracle mean",
        /// The cloth that looks most alike.
        Nearest = "1-NN",
        /// The five cloths that look most alike.
        FiveNearest = "5-NN",
        /// Linear in the picture's spectrum.
        Ridge = "ridge",
        /// Grey taken as height, felt by its slope.
        HeightMap = "height map",
        /// The true magnitudes with phases by chance: what no method without phases can beat.
        TrueSpectrum = "true spectrum",
        /// What hangs on the surface, and the mean of all strokes.
        Best = "Bayes floor",
    }
    /// Its name in tables.
    pub fn word;
}

/// A baseline that has seen what there is to learn.
pub(crate) struct Fitted<'a> {
    baseline: Baseline,
    learnt: &'a [Example],
    mean: Course,
    /// Mean and standard deviation of each figure of pictures.
    scales: Vec<[f64; 2]>,
    ridge: Option<Ridge>,
    /// Deviation of a trace from what is slow, a share of the level, and of grey's slope.
    slope_share: f64,
}

impl std::fmt::Debug for Fitted<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fitted")
            .field("baseline", &self.baseline)
            .finish_non_exhaustive()
    }
}

impl Baseline {
    /// Whether it knows something of the trace that it is scored against.
    pub fn is_told_answer(self) -> bool {
        matches!(self, Self::OracleMean | Self::TrueSpectrum | Self::Best)
    }

    /// Learns from examples, of which there is at least one.
    pub(crate) fn fitted(self, learnt: &[Example]) -> Fitted<'_> {
        let scales = scales(learnt);
        let all: Vec<&Example> = learnt.iter().collect();
        Fitted {
            baseline: self,
            learnt,
            mean: mean_course(&all),
            ridge: (self == Self::Ridge).then(|| Ridge::fitted(learnt, &scales)),
            slope_share: slope_share(learnt),
            scales,
        }
    }
}

impl Fitted<'_> {
    /// What it predicts of a picture (and of what it is told besides).
    pub(crate) fn predict(&self, example: &Example) -> Prediction {
        let n_samples = example.trace.len();
        match self.baseline {
            Baseline::Mean => Prediction::of_trace(vec![self.mean.level; n_samples]),
            Baseline::OracleMean => Prediction::of_trace(vec![example.course.level; n_samples]),
            Baseline::Class => {
                let of_family = |other: &&Example| other.cloth == example.cloth;
                let known: Vec<&Example> = self.learnt.iter().filter(of_family).collect();
                let course = if known.is_empty() {
                    self.mean.clone()
                } else {
                    mean_course(&known)
                };
                Prediction::of_course(&course)
            }
            Baseline::Nearest => self.nearest(example, 1),
            Baseline::FiveNearest => self.nearest(example, 5),
            Baseline::Ridge => {
                let n_frames = example.course.log_magnitudes.height();
                let figures = standardised(&example.looks.figures, &self.scales);
                let course = self
                    .ridge
                    .as_ref()
                    .map(|ridge| ridge.course(&figures, n_frames));
                Prediction::of_course(&course.unwrap_or_else(|| self.mean.clone()))
            }
            Baseline::HeightMap => Prediction::of_trace(self.felt_slope(example)),
            Baseline::TrueSpectrum => {
                let mut prediction = Prediction::of_course(&example.course);
                let start = StartPhases::Random(example.window.map_or(0, |window| window.take));
                prediction.trace = example.course.trace(n_samples, Some(start));
                prediction
            }
            Baseline::Best => Prediction::of_course(&example.best_possible()),
        }
    }

    fn nearest(&self, example: &Example, n: usize) -> Prediction {
        let figures = standardised(&example.looks.figures, &self.scales);
        let distance = |other: &Example| {
            let other = standardised(&other.looks.figures, &self.scales);
            figures
                .iter()
                .zip(other)
                .map(|(a, b)| (a - b).powi(2))
                .sum::<f64>()
        };
        let mut order: Vec<(f64, &Example)> = self
            .learnt
            .iter()
            .map(|other| (distance(other), other))
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearest: Vec<&Example> = order.into_iter().take(n).map(|(_, other)| other).collect();
        Prediction::of_course(&mean_course(&nearest))
    }

    /// Mean grey across the path as height, its slope through a ridge's width, so large as slopes
    /// of learnt pictures were to their friction.
    fn felt_slope(&self, example: &Example) -> Vec<f64> {
        let slope = grey_slope(example);
        let level = self.mean.level;
        slope
            .iter()
            .map(|slope| level * (1.0 + self.slope_share * slope))
            .collect()
    }
}

/// Mean course of some examples of the same length; they are not none.
fn mean_course(examples: &[&Example]) -> Course {
    let share = 1.0 / examples.len().max(1) as f64;
    let mut mean = Course {
        level: 0.0,
        trend: Vec::new(),
        log_magnitudes: Grid::filled(N_BINS, 0, 0.0),
    };
    for (n, example) in examples.iter().enumerate() {
        let course = &example.course;
        if n == 0 {
            mean.log_magnitudes = course.log_magnitudes.map(|_| 0.0);
            // What is slow differs from stroke to stroke: its mean is nothing.
            mean.trend = vec![0.0; course.trend.len()];
        }
        mean.level += share * course.level;
        let sums = mean.log_magnitudes.values_mut().iter_mut();
        let logs = course.log_magnitudes.values();
        sums.zip(logs)
            .for_each(|(sum, log)| *sum += to_single(share) * log);
    }
    mean
}

/// Mean and standard deviation of every figure.
pub(crate) fn scales(examples: &[Example]) -> Vec<[f64; 2]> {
    let n = examples.len().max(1) as f64;
    (0..N_FIGURES)
        .map(|figure| {
            let values = || examples.iter().map(|example| example.looks.figures[figure]);
            let mean = values().sum::<f64>() / n;
            let variance = values().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
            [mean, variance.sqrt().max(1e-6)]
        })
        .collect()
}

fn standardised(figures: &[f64], scales: &[[f64; 2]]) -> Vec<f64> {
    figures
        .iter()
        .zip(scales)
        .map(|(figure, [mean, sd])| (figure - mean) / sd)
        .collect()
}

/// Slope of the mean grey across the path, smoothed over a ridge's half, relative.
fn grey_slope(example: &Example) -> Vec<f64> {
    let strip = &example.strip;
    let n = strip.width();
    let share = 1.0 / strip.height().max(1) as f64;
    let mut grey = vec![0.0; n];
    for row in 0..strip.height() {
        let values = strip.row(row).iter();
        grey.iter_mut()
            .zip(values)
            .for_each(|(sum, &v)| *sum += share * f64::from(v));
    }
    let mean = grey.iter().sum::<f64>() / n.max(1) as f64;
    let reach = to_index(0.225 * PER_MM);
    let difference = |at: usize| {
        let [before, after] = [at.saturating_sub(reach), (at + reach).min(n - 1)];
        (grey[after] - grey[before]) / mean.max(1e-3)
    };
    (0..n).map(difference).collect()
}

/// How large friction varies for what grey's slope varies by: ratio of root mean squares.
fn slope_share(examples: &[Example]) -> f64 {
    let power = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
    let (friction, slope) = examples
        .iter()
        .fold((0.0, 0.0), |(friction, slope), example| {
            let mean = example.course.level;
            let rest: Vec<f64> = example.trace.iter().map(|f| f / mean - 1.0).collect();
            (friction + power(&rest), slope + power(&grey_slope(example)))
        });
    (friction / slope.max(1e-12)).sqrt()
}

/// The level of friction as the ridge regression has it: a weight a standardised figure, and their
/// constant.
pub(crate) fn linear_level(examples: &[Example], scales: &[[f64; 2]]) -> Vec<f64> {
    let ridge = Ridge::fitted(examples, scales);
    ridge.weights.column(0).iter().map(|w| 0.01 * w).collect()
}

/// Linear in figures of the picture: the level, and the log magnitude of bands.
struct Ridge {
    /// A row a figure and one of constants, a column a target.
    weights: DMatrix<f64>,
}

impl Ridge {
    /// Shrinks by what predicts each left-out example best (the closed form of leaving one out).
    fn fitted(examples: &[Example], scales: &[[f64; 2]]) -> Self {
        let n = examples.len();
        let rows: Vec<Vec<f64>> = examples
            .iter()
            .map(|e| standardised(&e.looks.figures, scales))
            .collect();
        let x = DMatrix::from_fn(n, N_FIGURES, |row, figure| rows[row][figure]);
        let targets: Vec<Vec<f64>> = examples.iter().map(|e| Self::targets(&e.course)).collect();
        let y = DMatrix::from_fn(n, 1 + N_RIDGE_BANDS, |row, target| targets[row][target]);
        let means = DVector::from_fn(y.ncols(), |target, _| y.column(target).mean());
        let centred =
            DMatrix::from_fn(n, y.ncols(), |row, target| y[(row, target)] - means[target]);
        let gram = x.transpose() * &x;
        let right = x.transpose() * &centred;
        let fit = |shrinkage: f64| {
            let mut gram = gram.clone();
            (0..N_FIGURES).for_each(|at| gram[(at, at)] += shrinkage);
            let factor = gram.cholesky()?;
            let weights = factor.solve(&right);
            let hat = factor.solve(&x.transpose());
            let miss = &centred - &x * &weights;
            let error: f64 = (0..n)
                .map(|row| {
                    let leverage = x.row(row).dot(&hat.column(row).transpose()) + 1.0 / n as f64;
                    miss.row(row).norm_squared() / (1.0 - leverage).max(1e-3).powi(2)
                })
                .sum();
            Some((error, weights))
        };
        let fits = SHRINKAGES.iter().filter_map(|&shrinkage| fit(shrinkage));
        let best = fits.min_by(|a, b| a.0.total_cmp(&b.0));
        let weights = best.map_or_else(|| DMatrix::zeros(N_FIGURES, y.ncols()), |(_, w)| w);
        Self {
            weights: weights.insert_row(N_FIGURES, 0.0),
        }
        .with_means(&means)
    }

    fn with_means(mut self, means: &DVector<f64>) -> Self {
        self.weights.set_row(N_FIGURES, &means.transpose());
        self
    }

    /// The level, in hundredths so that it weighs as much as a band, and the mean of each band.
    fn targets(course: &Course) -> Vec<f64> {
        let log = &course.log_magnitudes;
        let band = |band: usize| {
            let [from, to] = [band, band + 1].map(Self::edge);
            let bins = (0..log.height()).flat_map(|frame| &log.row(frame)[from..to]);
            bins.map(|&log| f64::from(log)).sum::<f64>() / (log.height() * (to - from)) as f64
        };
        let mut targets = vec![100.0 * course.level];
        targets.extend((0..N_RIDGE_BANDS).map(band));
        targets
    }

    /// The first bin of a band: single bins first, then ever wider.
    fn edge(band: usize) -> usize {
        let share = band as f64 / N_RIDGE_BANDS as f64;
        band.max(to_index((N_BINS as f64).powf(share)))
    }

    fn course(&self, figures: &[f64], n_frames: usize) -> Course {
        let row = DVector::from_fn(N_FIGURES + 1, |at, _| {
            figures.get(at).copied().unwrap_or(1.0)
        });
        let targets = self.weights.transpose() * row;
        let band_of = |bin: usize| (0..N_RIDGE_BANDS).find(|&band| bin < Self::edge(band + 1));
        let log = |bin: usize| band_of(bin).map_or(0.0, |band| targets[1 + band].max(0.0));
        Course {
            level: 0.01 * targets[0],
            trend: vec![0.0; n_frames],
            log_magnitudes: Grid::from_fn(N_BINS, n_frames, |bin, _| to_single(log(bin))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example::all_taken;
    use crate::score::{Measure, Measures, score};
    use crate::split::Split;

    #[test]
    fn each_baseline_predicts_and_what_knows_more_misses_less() {
        let [learnt, held_back] = Split::Cloths.windows(6);
        let [learnt, held_back] = [learnt, held_back].map(|windows| all_taken(&windows, 2));
        let mut table = Vec::new();
        for baseline in Baseline::ALL {
            let fitted = baseline.fitted(&learnt);
            let mut mean = [0.0; Measure::N];
            for example in &held_back {
                let found = score(&fitted.predict(example), &example.trace);
                assert!(
                    found.iter().all(|x| x.is_finite()),
                    "{baseline:?}: {found:?}"
                );
                mean.iter_mut()
                    .zip(found)
                    .for_each(|(sum, x)| *sum += x / held_back.len() as f64);
            }
            table.push(mean);
        }
        let [lsd, level] = [Measure::LogSpectral, Measure::LevelError].map(|measure| {
            move |baseline: Baseline, table: &[Measures]| measure.of(&table[baseline as usize])
        });
        let of = |baseline| lsd(baseline, &table);
        assert!(of(Baseline::Best) < of(Baseline::Ridge));
        assert!(of(Baseline::Ridge) < of(Baseline::Mean));
        assert!(level(Baseline::OracleMean, &table) < 1e-9);
        assert!(level(Baseline::Best, &table) < level(Baseline::Mean, &table));
    }
}
