//! The adversary: a network that tells felt spectra from generated ones, and what is made of that.

use burn::module::{Module, ModuleMapper, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, PaddingConfig2d};
use burn::tensor::activation::{leaky_relu, softplus};
use burn::tensor::{Device, Tensor};

use selvedge_foundation::named;

named! {
    /// What generator and critic are told by each other.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum AdversarialLoss {
        /// Cross entropy of felt against generated, as the authors' code has it, its weights
        /// clipped as there.
        Entropy = "bce",
        /// The difference of means, weights clipped (Arjovsky et al. 2017), as the paper says.
        Wasserstein = "wasserstein",
        /// Cross entropy with kernels scaled to a largest gain of 1 (Miyato et al. 2018).
        Spectral = "spectral",
    }
    /// Its name on the command line.
    pub fn word;
}

/// How far weights may be from 0 where they are clipped.
const CLIP: f32 = 0.01;

/// Convolutions to a map of scores, patch by patch.
#[derive(Module, Debug)]
pub(super) struct Critic {
    layers: Vec<Conv2d>,
    norms: Vec<BatchNorm>,
}

impl Critic {
    /// A critic of so many channels (condition and spectra together), the first layer so wide.
    pub(super) fn new(n_inputs: usize, width: usize, device: &Device) -> Self {
        let conv = |channels: [usize; 2], kernel: [usize; 2], stride: [usize; 2]| {
            let config = Conv2dConfig::new(channels, kernel).with_stride(stride);
            config
                .with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1))
                .init(device)
        };
        // Frames are few and are halved once, bins three times.
        let layers = vec![
            conv([n_inputs, width], [4, 4], [2, 2]),
            conv([width, 2 * width], [3, 4], [1, 2]),
            conv([2 * width, 4 * width], [3, 4], [1, 2]),
            conv([4 * width, 8 * width], [3, 5], [1, 1]),
            conv([8 * width, 1], [3, 4], [1, 1]),
        ];
        let norm = |n: usize| BatchNormConfig::new(n).init(device);
        let norms = vec![norm(2 * width), norm(4 * width), norm(8 * width)];
        Self { layers, norms }
    }

    /// Scores of example × channel × frame × bin: higher for what looks felt.
    pub(super) fn forward(&self, input: Tensor<4>) -> Tensor<4> {
        let last = self.layers.len() - 1;
        let mut x = input;
        for (n, layer) in self.layers.iter().enumerate() {
            x = layer.forward(x);
            // The first and the last have no normalisation.
            if let Some(norm) = n.checked_sub(1).and_then(|n| self.norms.get(n)) {
                x = norm.forward(x);
            }
            if n < last {
                x = leaky_relu(x, 0.2);
            }
        }
        x
    }
}

impl AdversarialLoss {
    /// What the generator loses by these scores of its spectra.
    pub(super) fn of_generator(self, generated: Tensor<4>) -> Tensor<1> {
        match self {
            Self::Wasserstein => generated.mean().neg(),
            // −ln σ(x) = softplus(−x)
            Self::Entropy | Self::Spectral => softplus(generated.neg(), 1.0).mean(),
        }
    }

    /// What the critic loses by its scores of felt and of generated spectra.
    pub(super) fn of_critic(self, felt: Tensor<4>, generated: Tensor<4>) -> Tensor<1> {
        match self {
            Self::Wasserstein => generated.mean() - felt.mean(),
            // The authors weigh what is felt by half.
            Self::Entropy | Self::Spectral => {
                softplus(felt.neg(), 1.0).mean() * 0.5 + softplus(generated, 1.0).mean()
            }
        }
    }

    /// The critic with its weights within what this loss needs.
    pub(super) fn restrained(self, critic: Critic) -> Critic {
        critic.map(&mut Restrained(self))
    }
}

struct Restrained(AdversarialLoss);

impl ModuleMapper for Restrained {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let is_spectral = self.0 == AdversarialLoss::Spectral;
        // What is not learnt, such as running means, is left alone.
        if is_spectral && D < 2 || !param.val().is_require_grad() {
            return param;
        }
        param.map(|weights| {
            // A new leaf: how it was restrained is not learnt from.
            let weights = weights.inner();
            let restrained = if is_spectral {
                let gain = largest_gain(weights.clone());
                weights / gain.max(1.0)
            } else {
                weights.clamp(-CLIP, CLIP)
            };
            restrained.autodiff().require_grad()
        })
    }
}

/// The largest singular value of a kernel as a matrix of outputs × the rest, by power iteration.
fn largest_gain<const D: usize>(weights: Tensor<D>) -> f32 {
    let shape = weights.dims();
    let matrix: Tensor<2> = weights.reshape([shape[0], shape[1..].iter().product()]);
    let mut right = Tensor::<2>::ones([matrix.dims()[1], 1], &matrix.device());
    let mut gain = 0.0;
    for _ in 0..8 {
        let left = matrix.clone().matmul(right);
        right = matrix.clone().transpose().matmul(left.clone());
        let size = |x: &Tensor<2>| x.clone().powi_scalar(2).sum().into_scalar::<f32>().sqrt();
        let (of_left, of_right) = (size(&left), size(&right));
        if of_left <= f32::MIN_POSITIVE || of_right <= f32::MIN_POSITIVE {
            return 0.0;
        }
        gain = of_right / of_left;
        right = right / of_right;
    }
    gain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::weights::{drawn, read, tensor};

    #[test]
    fn restrained_weights_are_within_what_each_loss_needs() {
        let device = Device::flex().autodiff();
        let critic = || drawn(Critic::new(2, 4, &device), 1);
        for loss in [AdversarialLoss::Entropy, AdversarialLoss::Wasserstein] {
            for layer in loss.restrained(critic()).layers {
                let weights = read(&layer);
                assert!(weights.iter().all(|w| w.abs() <= CLIP), "{loss:?}");
            }
        }
        let layers = AdversarialLoss::Spectral.restrained(critic()).layers;
        for layer in layers {
            let gain = largest_gain(layer.weight.val());
            assert!(gain <= 1.01, "{gain}");
        }
    }

    #[test]
    fn a_diagonal_s_largest_gain_is_its_largest_entry() {
        let diagonal = tensor(vec![3.0, 0.0, 0.0, -5.0], [2, 2], &Device::flex());
        assert!((largest_gain(diagonal) - 5.0).abs() < 1e-2);
    }

    #[test]
    fn losses_fall_as_each_side_would_have_it() {
        let device = Device::flex();
        let score = |x: f32| tensor(vec![x], [1, 1, 1, 1], &device);
        let number = |loss: Tensor<1>| loss.into_scalar::<f32>();
        for loss in AdversarialLoss::ALL {
            let generator = |x| number(loss.of_generator(score(x)));
            assert!(generator(1.0) < generator(0.0), "{loss:?}");
            let critic = |felt, generated| number(loss.of_critic(score(felt), score(generated)));
            assert!(critic(1.0, -1.0) < critic(0.0, 0.0), "{loss:?}");
        }
        // At chance: ½ ln 2 + ln 2.
        let chance = number(AdversarialLoss::Entropy.of_critic(score(0.0), score(0.0)));
        assert!((chance - 1.5 * 2.0_f32.ln()).abs() < 1e-6, "{chance}");
    }
}
