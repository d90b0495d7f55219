//! How our network learns and what it is asked.

use burn::module::Module as _;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::tensor::{Device, Tensor};

use selvedge_foundation::numerics::Random;

use super::checkpoint::{Parts, save};
use super::critic::{AdversarialLoss, Critic};
use super::learn::{L1_WEIGHT, Learner, Losses, Network, number};
use super::lesson::Lesson;
use super::registered::{Answer, Registered, Scales, Size};
use super::weights::{Weights, drawn, filled, read, tensor, values};
use crate::FrictionError;
use crate::example::Example;
use crate::picture::{Looks, N_CHANNELS};
use crate::score::Prediction;
use crate::signal::Course;

/// How much the error of the level and of the trend weighs against that of the spectra.
const WEIGHTS: [f64; 2] = [0.3, 0.05];

/// Our network while it learns.
pub(super) struct Ours {
    network: Registered,
    scales: Scales,
    optimizer: ModuleOptimizer,
    critic: Option<(Critic, ModuleOptimizer)>,
}

impl Ours {
    /// Before its first step.
    pub(super) fn begin(lesson: &Lesson, examples: &[Example], has_critic: bool) -> Self {
        let device = Device::flex().autodiff();
        let critic = || {
            let critic = Critic::new(N_CHANNELS + 1, 8, &device);
            (drawn(critic, !lesson.seed), AdamConfig::new().init())
        };
        Self {
            network: drawn(Registered::new(lesson.size, &device), lesson.seed),
            scales: Scales::of(examples),
            optimizer: AdamConfig::new().init(),
            critic: has_critic.then(critic),
        }
    }
}

impl Learner for Ours {
    fn step(
        &mut self,
        batch: &[&Example],
        loss: AdversarialLoss,
        rate: f64,
        _random: &mut Random,
    ) -> Losses {
        let rate = 2e-3 * rate + 1e-5;
        let device = Device::flex().autodiff();
        let looks: Vec<_> = batch.iter().map(|example| &example.looks).collect();
        let code = self.network.encode(self.scales.inputs(&looks, &device));
        let answer = self.network.decode(code);
        let Answer {
            log_magnitudes,
            trend,
            level,
        } = self.scales.targets(batch, &device);
        let spectra = (answer.log_magnitudes.clone() - log_magnitudes.clone())
            .abs()
            .mean();
        let level = (answer.level - level).abs().mean();
        let trend = (answer.trend - trend).abs().mean();
        let mut losses = Losses {
            spectra: number(&spectra),
            level: number(&level),
            critic: 0.0,
        };
        let mut all = spectra + level * WEIGHTS[0] + trend * WEIGHTS[1];
        if let Some((critic, optimizer)) = &mut self.critic {
            // The critic sees the same strip, frame by frame and bin by bin.
            let strip = self.scales.inputs(&looks, &device).spectra();
            let seen = |log: Tensor<3>| Tensor::cat(vec![strip.clone(), log.unsqueeze_dim(1)], 1);
            let felt = critic.forward(seen(log_magnitudes));
            let generated = critic.forward(seen(answer.log_magnitudes.clone().detach()));
            let lost = loss.of_critic(felt, generated);
            losses.critic = number(&lost);
            let gradients = GradientsParams::from_grads(lost.backward(), critic);
            *critic = loss.restrained(optimizer.step(0.2 * rate, critic.clone(), gradients));
            let fooled = loss.of_generator(critic.forward(seen(answer.log_magnitudes)));
            all = all + fooled / L1_WEIGHT;
        }
        let gradients = GradientsParams::from_grads(all.backward(), &self.network);
        self.network = self.optimizer.step(rate, self.network.clone(), gradients);
        losses
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        save(bytes, &self.network, &self.optimizer);
        if let Some((critic, optimizer)) = &self.critic {
            save(bytes, critic, optimizer);
        }
    }

    fn restore(&mut self, parts: &mut Parts<'_>) -> Result<(), FrictionError> {
        parts.restore(&mut self.network, &mut self.optimizer)?;
        match &mut self.critic {
            Some((critic, optimizer)) => parts.restore(critic, optimizer),
            None => Ok(()),
        }
    }

    fn network(&self) -> Box<dyn Network> {
        Box::new(OurNetwork {
            network: self.network.valid(),
            scales: self.scales.clone(),
        })
    }
}

/// Our network, ready to be asked.
pub(crate) struct OurNetwork {
    network: Registered,
    scales: Scales,
}

impl std::fmt::Debug for OurNetwork {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("OurNetwork")
    }
}

impl OurNetwork {
    /// Before it learns, of nothing.
    pub(crate) fn untaught(size: Size) -> Self {
        Self {
            network: drawn(Registered::new(size, &Device::flex()), 0),
            scales: Scales::of(&[]),
        }
    }

    /// From weights of a network of a size.
    ///
    /// # Errors
    /// Weights of another.
    pub(crate) fn from_weights(weights: &Weights, size: Size) -> Result<Self, FrictionError> {
        let network = Registered::new(size, &Device::flex());
        let scales = Scales::from_numbers(&weights.scales);
        match scales {
            Some(scales) if network.num_params() == weights.values.len() => Ok(Self {
                network: filled(network, &weights.values),
                scales,
            }),
            _ => Err(FrictionError::Weights {
                what: "it is of a network of another size".to_owned(),
            }),
        }
    }

    /// What it makes of strips of the same length.
    pub(crate) fn courses(&self, looks: &[&Looks]) -> Vec<Course> {
        if looks.is_empty() {
            return Vec::new();
        }
        let code = self
            .network
            .encode(self.scales.inputs(looks, &Device::flex()));
        let levels: Vec<f64> = looks.iter().map(|l| self.scales.linear_level(l)).collect();
        self.scales.courses(self.network.decode(code), &levels)
    }

    /// What stands for the cloth of a strip.
    pub(crate) fn latent(&self, looks: &Looks) -> Vec<f32> {
        let inputs = self.scales.inputs(&[looks], &Device::flex());
        values(self.network.latent(&inputs))
    }

    /// What it makes of a strip whose latent is shaken: noise in units of the latent's deviation.
    pub(crate) fn shaken(&self, looks: &Looks, noise: impl Iterator<Item = f32>) -> Course {
        let device = Device::flex();
        let mut code = self.network.encode(self.scales.inputs(&[looks], &device));
        let latent = values(code.latent);
        let size = latent.iter().map(|x| x * x).sum::<f32>() / latent.len() as f32;
        let moved = latent
            .iter()
            .zip(noise)
            .map(|(x, noise)| x + size.sqrt() * noise);
        code.latent = tensor(moved.collect(), [1, latent.len()], &device);
        let level = self.scales.linear_level(looks);
        self.scales
            .courses(self.network.decode(code), &[level])
            .swap_remove(0)
    }

    /// A cloth that lies so far (0 to 1) from the first strip's to the second's, which is as long;
    /// `None` if it is not.
    pub(crate) fn between(&self, from: &Looks, to: &Looks, share: f64) -> Option<Course> {
        if from.channels[0].height() != to.channels[0].height() {
            return None;
        }
        let device = Device::flex();
        let [of_from, of_to] = [from, to].map(|looks| self.scales.linear_level(looks));
        let [from, to] =
            [from, to].map(|looks| self.network.encode(self.scales.inputs(&[looks], &device)));
        let level = (1.0 - share) * of_from + share * of_to;
        self.scales
            .courses(self.network.decode(from.towards(&to, share)), &[level])
            .pop()
    }
}

impl Network for OurNetwork {
    fn predict(&self, example: &Example) -> Prediction {
        let courses = self.courses(&[&example.looks]);
        courses
            .first()
            .map_or_else(|| Prediction::of_trace(Vec::new()), Prediction::of_course)
    }

    fn weights(&self) -> Option<Weights> {
        Some(Weights {
            scales: self.scales.numbers(),
            values: read(&self.network),
        })
    }
}
