//! Our network: from the spectra of a strip to those of the friction along it, place by place.
//!
//! ```text
//! spectra of the strip ─▶ convolutions over frames and bins ─┬─▶ log magnitudes (+ a bin curve)
//!                              ▲ shifts                      ├─▶ trend, a value a frame
//! figures of the strip ─▶ latent ────────────────────────────┴─▶ level
//! ```
//!
//! Picture and trace have the same scale and the same frames, so a bin of the strip's spectra
//! stands for the same wavenumber at the same place as that of the answer: nothing has to be learnt
//! of where it is. Frames may be any number. The level that is told is the mean of the network's
//! and of a ridge regression's, which knows less and errs less on families never seen.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

use selvedge_foundation::numerics::{Grid, to_single};

use super::weights::{tensor, values};
use crate::baseline::{linear_level, scales};
use crate::example::Example;
use crate::picture::{Looks, N_CHANNELS, N_FIGURES};
use crate::signal::{Course, N_BINS};

/// Numbers that stand for a whole cloth.
pub(super) const N_LATENT: usize = 64;
/// Channels of the input: spectra, and two that say which bin it is.
const N_INPUTS: usize = N_CHANNELS + 2;
/// Mean and standard deviation of levels, roughly: the network's unit of level.
const LEVEL: [f64; 2] = [0.38, 0.05];
/// The network's unit of trend.
const TREND: f64 = 0.01;

/// How large the network is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    /// Channels of the convolutions.
    pub width: usize,
    /// Convolutions that add to what is there.
    pub n_layers: usize,
}

impl Default for Size {
    fn default() -> Self {
        Self {
            width: 16,
            n_layers: 3,
        }
    }
}

/// The layers.
#[derive(Module, Debug)]
pub(super) struct Registered {
    first: Conv2d,
    middle: Vec<Conv2d>,
    last: Conv2d,
    figures: Linear,
    latent: Linear,
    shifts: Vec<Linear>,
    bins: Linear,
    slow: Linear,
    level: Linear,
    level_last: Linear,
}

/// What a strip becomes before it is friction: between two of them lies another cloth.
#[derive(Debug, Clone)]
pub(super) struct Code {
    /// A row of [`N_LATENT`] an example.
    pub(super) latent: Tensor<2>,
    /// Example, channel, frame, bin.
    map: Tensor<4>,
}

/// The answers, in the network's units.
#[derive(Debug, Clone)]
pub(super) struct Answer {
    /// Example, frame, bin: above the mean of what was learnt.
    pub(super) log_magnitudes: Tensor<3>,
    /// Example, frame.
    pub(super) trend: Tensor<2>,
    /// Example, one.
    pub(super) level: Tensor<2>,
}

impl Registered {
    pub(super) fn new(size: Size, device: &Device) -> Self {
        let Size { width, n_layers } = size;
        let conv = |channels: [usize; 2], [frames, bins]: [usize; 2]| {
            let [f, b] = [frames / 2, bins / 2];
            let padding = PaddingConfig2d::Explicit(f, b, f, b);
            let config = Conv2dConfig::new(channels, [frames, bins]);
            config.with_padding(padding).init(device)
        };
        let linear = |from, to| LinearConfig::new(from, to).init(device);
        Self {
            first: conv([N_INPUTS, width], [3, 7]),
            middle: (0..n_layers)
                .map(|_| conv([width, width], [3, 5]))
                .collect(),
            last: conv([width, 1], [1, 1]),
            figures: linear(N_FIGURES, N_LATENT),
            latent: linear(N_LATENT, N_LATENT),
            shifts: (0..=n_layers).map(|_| linear(N_LATENT, width)).collect(),
            bins: linear(N_LATENT, N_BINS),
            slow: linear(width, 1),
            level: linear(N_LATENT + width, 32),
            level_last: linear(32, 1),
        }
    }

    /// What stands for each cloth, a row of [`N_LATENT`] an example.
    pub(super) fn latent(&self, inputs: &Inputs) -> Tensor<2> {
        let figures = relu(self.figures.forward(inputs.figures.clone()));
        relu(self.latent.forward(figures))
    }

    pub(super) fn encode(&self, inputs: Inputs) -> Code {
        let latent = self.latent(&inputs);
        let shift = |n: usize| {
            let shift: Tensor<2> = self.shifts[n].forward(latent.clone());
            shift.unsqueeze_dim::<3>(2).unsqueeze_dim::<4>(3)
        };
        let mut map = relu(self.first.forward(inputs.channels) + shift(0));
        for (n, conv) in self.middle.iter().enumerate() {
            map = map.clone() + relu(conv.forward(map) + shift(n + 1));
        }
        Code { latent, map }
    }

    pub(super) fn decode(&self, code: Code) -> Answer {
        let Code { latent, map } = code;
        let [n, _, n_frames, n_bins] = map.dims();
        let bins: Tensor<2> = self.bins.forward(latent.clone());
        let by_place = self
            .last
            .forward(map.clone())
            .reshape([n, n_frames, n_bins]);
        let per_frame = map.mean_dim(3).squeeze_dim::<3>(3).swap_dims(1, 2);
        let pooled = per_frame.clone().mean_dim(1).squeeze_dim::<2>(1);
        let trend = self.slow.forward(per_frame).squeeze_dim::<2>(2);
        let level = relu(self.level.forward(Tensor::cat(vec![latent, pooled], 1)));
        Answer {
            log_magnitudes: by_place + bins.unsqueeze_dim::<3>(1),
            trend: trend.clone() - trend.mean_dim(1),
            level: self.level_last.forward(level),
        }
    }
}

impl Code {
    /// A code so far from this one to another; 0 is this one. Both have as many frames.
    pub(super) fn towards(&self, other: &Self, share: f64) -> Self {
        let between = |from: f64| to_single(from);
        let [a, b] = [between(1.0 - share), between(share)];
        Self {
            latent: self.latent.clone() * a + other.latent.clone() * b,
            map: self.map.clone() * a + other.map.clone() * b,
        }
    }
}

/// Strips as tensors.
pub(super) struct Inputs {
    channels: Tensor<4>,
    figures: Tensor<2>,
}

/// Mean and standard deviation of what the network reads and says, over what is learnt.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scales {
    figures: Vec<[f32; 2]>,
    /// For each channel, by bin.
    channels: Vec<Vec<[f32; 2]>>,
    /// Means alone count.
    logs: Vec<[f32; 2]>,
    /// The level as a ridge regression has it: a weight a figure, and their constant.
    level: Vec<f32>,
}

impl Inputs {
    /// The spectra of the strips, a channel each.
    pub(super) fn spectra(self) -> Tensor<4> {
        self.channels.narrow(1, 0, N_CHANNELS)
    }
}

impl Scales {
    pub(super) fn of(examples: &[Example]) -> Self {
        let figures = scales(examples);
        let level = linear_level(examples, &figures).into_iter();
        let channel = |n: usize| of_bins(examples.iter().map(move |e| &e.looks.channels[n]));
        Self {
            figures: figures.iter().map(|scale| scale.map(to_single)).collect(),
            channels: (0..N_CHANNELS).map(channel).collect(),
            logs: of_bins(examples.iter().map(|e| &e.course.log_magnitudes)),
            level: level.map(to_single).collect(),
        }
    }

    pub(super) fn numbers(&self) -> Vec<f32> {
        let of_bins = self.channels.iter().flatten().chain(&self.logs);
        let pairs = self.figures.iter().chain(of_bins).flatten();
        pairs.chain(&self.level).copied().collect()
    }

    /// From as many numbers as [`Self::numbers`] gives; `None` of another count.
    pub(super) fn from_numbers(numbers: &[f32]) -> Option<Self> {
        let n_pairs = N_FIGURES + (N_CHANNELS + 1) * N_BINS;
        let (pairs, level) = numbers.split_at_checked(2 * n_pairs)?;
        if level.len() != N_FIGURES + 1 {
            return None;
        }
        let (pairs, _) = pairs.as_chunks::<2>();
        let (figures, of_bins) = pairs.split_at(N_FIGURES);
        let mut of_bins = of_bins.chunks(N_BINS).map(<[[f32; 2]]>::to_vec);
        Some(Self {
            figures: figures.to_vec(),
            channels: of_bins.by_ref().take(N_CHANNELS).collect(),
            logs: of_bins.next()?,
            level: level.to_vec(),
        })
    }

    /// Strips of as many frames each; at least one.
    pub(super) fn inputs(&self, looks: &[&Looks], device: &Device) -> Inputs {
        let n_frames = looks.first().map_or(0, |looks| looks.channels[0].height());
        let shape = [looks.len(), N_INPUTS, n_frames, N_BINS];
        let mut of_bins = Vec::with_capacity(shape.iter().product());
        for looks in looks {
            for (channel, scales) in looks.channels.iter().zip(&self.channels) {
                for frame in 0..n_frames {
                    let bins = channel.row(frame).iter().zip(scales);
                    of_bins.extend(bins.map(|(value, [mean, sd])| (value - mean) / sd));
                }
            }
            let share = |bin: usize| bin as f32 / (N_BINS - 1) as f32;
            let linear = |bin| 2.0 * share(bin) - 1.0;
            let logarithmic = |bin| 2.0 * (255.0 * share(bin)).ln_1p() / 256.0_f32.ln() - 1.0;
            for place in [&linear as &dyn Fn(usize) -> f32, &logarithmic] {
                for _ in 0..n_frames {
                    of_bins.extend((0..N_BINS).map(place));
                }
            }
        }
        let figures = looks.iter().flat_map(|looks| self.standardised(looks));
        let figures = figures.collect();
        Inputs {
            channels: tensor(of_bins, shape, device),
            figures: tensor(figures, [looks.len(), N_FIGURES], device),
        }
    }

    fn standardised<'a>(&'a self, looks: &'a Looks) -> impl Iterator<Item = f32> + 'a {
        let figures = looks.figures.iter().zip(&self.figures);
        figures.map(|(&figure, [mean, sd])| (to_single(figure) - mean) / sd)
    }

    /// The level of a strip as the ridge regression has it.
    pub(super) fn linear_level(&self, looks: &Looks) -> f64 {
        let figures = self.standardised(looks).chain([1.0]);
        let sum = figures
            .zip(&self.level)
            .map(|(figure, weight)| figure * weight);
        f64::from(sum.sum::<f32>())
    }

    /// What should be answered of examples.
    pub(super) fn targets(&self, examples: &[&Example], device: &Device) -> Answer {
        let n = examples.len();
        let n_frames = examples.first().map_or(0, |e| e.course.trend.len());
        let above_mean = |e: &&Example| {
            let log = &e.course.log_magnitudes;
            let means = self.logs.iter().cycle();
            log.values()
                .iter()
                .zip(means)
                .map(|(log, [mean, _])| log - mean)
                .collect::<Vec<_>>()
        };
        let trend = examples
            .iter()
            .flat_map(|e| &e.course.trend)
            .map(|t| to_single(t / TREND));
        let level = |e: &&Example| to_single((e.course.level - LEVEL[0]) / LEVEL[1]);
        let log_magnitudes = examples.iter().flat_map(above_mean).collect();
        Answer {
            log_magnitudes: tensor(log_magnitudes, [n, n_frames, N_BINS], device),
            trend: tensor(trend.collect(), [n, n_frames], device),
            level: tensor(examples.iter().map(level).collect(), [n, 1], device),
        }
    }

    /// Answers as courses, one an example. The level is the mean of the network's and of the ridge
    /// regression's (`linear_levels`), which misses less where the family is unknown.
    pub(super) fn courses(&self, answer: Answer, linear_levels: &[f64]) -> Vec<Course> {
        let [_, n_frames, _] = answer.log_magnitudes.dims();
        let logs = values(answer.log_magnitudes);
        let trends = values(answer.trend);
        let levels = values(answer.level);
        let course = |(n, (level, linear)): (usize, (&f32, &f64))| {
            let logs = &logs[n * n_frames * N_BINS..][..n_frames * N_BINS];
            let trend = &trends[n * n_frames..][..n_frames];
            let log = |bin: usize, frame: usize| {
                (logs[frame * N_BINS + bin] + self.logs[bin][0]).max(0.0)
            };
            Course {
                level: (0.5 * (LEVEL[0] + LEVEL[1] * f64::from(*level) + linear)).max(0.0),
                trend: trend.iter().map(|&t| TREND * f64::from(t)).collect(),
                log_magnitudes: Grid::from_fn(N_BINS, n_frames, log),
            }
        };
        levels
            .iter()
            .zip(linear_levels)
            .enumerate()
            .map(course)
            .collect()
    }
}

/// Mean and standard deviation of each bin over all frames.
fn of_bins<'a>(grids: impl Iterator<Item = &'a Grid<f32>>) -> Vec<[f32; 2]> {
    let mut sums = vec![[0.0_f64; 3]; N_BINS];
    for grid in grids {
        for frame in 0..grid.height() {
            for (sum, &value) in sums.iter_mut().zip(grid.row(frame)) {
                let value = f64::from(value);
                *sum = [sum[0] + 1.0, sum[1] + value, sum[2] + value * value];
            }
        }
    }
    let scale = |[n, sum, squares]: [f64; 3]| {
        let mean = sum / n.max(1.0);
        let variance = (squares / n.max(1.0) - mean * mean).max(0.0);
        [mean, variance.sqrt().max(1e-3)].map(to_single)
    };
    sums.into_iter().map(scale).collect()
}
