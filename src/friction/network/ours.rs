//! From a strip to level, trend and spectra, registered.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

use crate::example::Example;
use crate::picture::{N_CHANNELS, N_FIGURES};
use crate::signal::N_BINS;

use super::batch::tensor;

#[derive(Module, Debug)]
pub struct Ours {
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

pub const LATENT: usize = 64;

/// Inputs.
pub struct Inputs {
    pub channels: Tensor<4>,
    pub figures: Tensor<2>,
}

pub struct Outputs {
    pub log: Tensor<3>,
    pub trend: Tensor<2>,
    pub level: Tensor<2>,
}

impl Ours {
    pub fn new(width: usize, n_layers: usize, device: &Device) -> Self {
        let conv = |channels: [usize; 2], kernel: [usize; 2]| {
            let same = PaddingConfig2d::Explicit(kernel[0] / 2, kernel[1] / 2, kernel[0] / 2, kernel[1] / 2);
            Conv2dConfig::new(channels, kernel).with_padding(same).init(device)
        };
        let linear = |from, to| LinearConfig::new(from, to).init(device);
        Self {
            first: conv([N_CHANNELS + 2, width], [3, 7]),
            middle: (0..n_layers).map(|_| conv([width, width], [3, 5])).collect(),
            last: conv([width, 1], [1, 1]),
            figures: linear(N_FIGURES, LATENT),
            latent: linear(LATENT, LATENT),
            shifts: (0..=n_layers).map(|_| linear(LATENT, width)).collect(),
            bins: linear(LATENT, N_BINS),
            slow: linear(width, 1),
            level: linear(LATENT + width, 32),
            level_last: linear(32, 1),
        }
    }

    pub fn forward(&self, inputs: Inputs) -> Outputs {
        let latent = relu(self.latent.forward(relu(self.figures.forward(inputs.figures))));
        let [b, _, f, k] = inputs.channels.dims();
        let shift = |n: usize| {
            let shift: Tensor<2> = self.shifts[n].forward(latent.clone());
            shift.unsqueeze_dim::<3>(2).unsqueeze_dim::<4>(3)
        };
        let mut x = relu(self.first.forward(inputs.channels) + shift(0));
        for (n, conv) in self.middle.iter().enumerate() {
            x = x.clone() + relu(conv.forward(x) + shift(n + 1));
        }
        let bins: Tensor<2> = self.bins.forward(latent.clone());
        let log = self.last.forward(x.clone()).reshape([b, f, k]) + bins.unsqueeze_dim::<3>(1);
        let per_frame: Tensor<3> = x.mean_dim(3).squeeze_dim::<3>(3).swap_dims(1, 2);
        let pooled: Tensor<2> = per_frame.clone().mean_dim(1).squeeze_dim::<2>(1);
        let trend: Tensor<2> = self.slow.forward(per_frame).squeeze_dim::<2>(2);
        let trend = trend.clone() - trend.mean_dim(1);
        let level = relu(self.level.forward(Tensor::cat(vec![latent, pooled], 1)));
        Outputs { log, trend, level: self.level_last.forward(level) }
    }
}

/// Level as the network has it.
pub fn of_level(level: f64) -> f64 {
    (level - 0.38) / 0.05
}

pub struct Scales {
    pub figures: Vec<[f64; 2]>,
    /// channel, bin
    pub channels: Vec<Vec<[f32; 2]>>,
    pub logs: Vec<[f32; 2]>,
}

fn of_bins<'a>(grids: impl Iterator<Item = &'a selvedge_foundation::numerics::Grid<f32>> + Clone) -> Vec<[f32; 2]> {
    (0..N_BINS).map(|bin| {
        let values = || grids.clone().flat_map(move |g| (0..g.height()).map(move |f| g.row(f)[bin]));
        let n = values().count() as f32;
        let mean = values().sum::<f32>() / n;
        let var = values().map(|v| (v - mean).powi(2)).sum::<f32>() / n;
        [mean, var.sqrt().max(1e-3)]
    }).collect()
}

impl Scales {
    pub fn of(examples: &[Example]) -> Self {
        Self {
            figures: crate::baseline::scales(examples),
            channels: (0..N_CHANNELS).map(|c| of_bins(examples.iter().map(move |e| &e.looks.channels[c]))).collect(),
            logs: of_bins(examples.iter().map(|e| &e.course.log_magnitudes)),
        }
    }
}

pub fn inputs(examples: &[&Example], scales: &Scales, device: &Device) -> Inputs {
    let n_frames = examples[0].looks.channels[0].height();
    let b = examples.len();
    let mut values = Vec::with_capacity(b * (N_CHANNELS + 2) * n_frames * N_BINS);
    for example in examples {
        for (channel, scales) in example.looks.channels.iter().zip(&scales.channels) {
            for f in 0..n_frames {
                values.extend(channel.row(f).iter().zip(scales).map(|(v, [m, s])| (v - m) / s));
            }
        }
        for place in [|s: f32| 2.0 * s - 1.0, |s: f32| (1.0 + 256.0 * s).ln() / 2.75 - 1.0] {
            for _ in 0..n_frames {
                values.extend((0..N_BINS).map(|bin| place(bin as f32 / 256.0)));
            }
        }
    }
    let figures: Vec<f32> = examples
        .iter()
        .flat_map(|e| e.looks.figures.iter().zip(&scales.figures).map(|(f, [m, s])| ((f - m) / s) as f32))
        .collect();
    Inputs {
        channels: tensor(values, [b, N_CHANNELS + 2, n_frames, N_BINS], device),
        figures: tensor(figures, [b, N_FIGURES], device),
    }
}
