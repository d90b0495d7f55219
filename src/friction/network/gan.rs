//! How `FrictGAN` learns and what it is asked.

use burn::module::Module as _;
use burn::optim::{GradientsParams, ModuleOptimizer, RmsPropConfig};
use burn::tensor::{Device, Tensor};

use selvedge_foundation::numerics::{Grid, Random, to_single};

use super::checkpoint::{Parts, save};
use super::critic::{AdversarialLoss, Critic};
use super::frictgan::{Generator, N_NOISE, SIDE, critic_crop};
use super::learn::{L1_WEIGHT, Learner, Losses, Network, number};
use super::lesson::Lesson;
use super::weights::{Weights, drawn, tensor, values};
use crate::FrictionError;
use crate::example::Example;
use crate::score::Prediction;
use crate::signal::{N_BINS, magnitudes_of};

/// Steps of the critic for one of the generator.
const N_CRITIC_STEPS: usize = 5;

/// `FrictGAN` while it learns.
pub(super) struct FrictGan {
    generator: Generator,
    critic: Critic,
    optimizers: [ModuleOptimizer; 2],
    /// Mean magnitude of every bin over what is learnt.
    mean: Vec<f32>,
    n_frames: usize,
}

impl FrictGan {
    /// Before its first step.
    pub(super) fn begin(lesson: &Lesson, examples: &[Example]) -> Self {
        let device = Device::flex().autodiff();
        let n_frames = examples.first().map_or(1, |e| e.course.trend.len());
        let rms_prop = || {
            let config = RmsPropConfig::new().with_alpha(0.9).with_momentum(0.0);
            config.with_epsilon(1e-7).init()
        };
        Self {
            generator: drawn(Generator::new(n_frames, &device), lesson.seed),
            critic: drawn(Critic::new(2, 16, &device), !lesson.seed),
            optimizers: [rms_prop(), rms_prop()],
            mean: mean_magnitudes(examples),
            n_frames,
        }
    }
}

impl Learner for FrictGan {
    fn step(
        &mut self,
        batch: &[&Example],
        loss: AdversarialLoss,
        rate: f64,
        random: &mut Random,
    ) -> Losses {
        let rate = 5e-4 * rate + 5e-6;
        let device = Device::flex().autodiff();
        let n = batch.len();
        let shape = [n, 1, N_BINS, self.n_frames];
        // Once for all steps of this batch: only noise and what is dropped change between them.
        let seen = self.generator.encode(pictures(batch, &device));
        let crop = |e: &&Example| critic_crop(&e.square(), self.n_frames);
        let crops = tensor(batch.iter().flat_map(crop).collect(), shape, &device);
        let felt = batch
            .iter()
            .flat_map(|e| above_mean(&whole_magnitudes(e), &self.mean));
        let felt = tensor(felt.collect(), shape, &device);
        let beside = |x: Tensor<4>| Tensor::cat(vec![crops.clone(), x], 1).swap_dims(2, 3);
        let mut losses = Losses::default();
        let mut drawn = |gan: &Self| {
            let noise = (0..n * N_NOISE)
                .map(|_| to_single(random.normal()))
                .collect();
            let masks = Generator::masks_of(n, gan.n_frames).map(|shape| {
                let kept = (0..shape.iter().product())
                    .map(|_| if random.uniform() < 0.5 { 0.0 } else { 2.0 });
                tensor(kept.collect(), shape, &device)
            });
            let noise = tensor(noise, [n, N_NOISE], &device);
            gan.generator.decode(&seen, noise, Some(&masks))
        };
        for _ in 0..N_CRITIC_STEPS {
            let generated = drawn(self).detach();
            let scores = [felt.clone(), generated].map(|x| self.critic.forward(beside(x)));
            let [of_felt, of_generated] = scores;
            let lost = loss.of_critic(of_felt, of_generated);
            losses.critic = number(&lost);
            let gradients = GradientsParams::from_grads(lost.backward(), &self.critic);
            let critic = self.optimizers[1].step(rate, self.critic.clone(), gradients);
            self.critic = loss.restrained(critic);
        }
        let generated = drawn(self);
        let miss = (generated.clone() - felt).abs().mean();
        losses.spectra = number(&miss);
        let fooled = loss.of_generator(self.critic.forward(beside(generated)));
        let all = fooled + miss * L1_WEIGHT;
        let gradients = GradientsParams::from_grads(all.backward(), &self.generator);
        self.generator = self.optimizers[0].step(rate, self.generator.clone(), gradients);
        losses
    }

    fn save(&self, bytes: &mut Vec<u8>) {
        self.generator.settle();
        let [of_generator, of_critic] = &self.optimizers;
        save(bytes, &self.generator, of_generator);
        save(bytes, &self.critic, of_critic);
    }

    fn restore(&mut self, parts: &mut Parts<'_>) -> Result<(), FrictionError> {
        let [of_generator, of_critic] = &mut self.optimizers;
        parts.restore(&mut self.generator, of_generator)?;
        parts.restore(&mut self.critic, of_critic)
    }

    fn network(&self) -> Box<dyn Network> {
        self.generator.settle();
        Box::new(Generated {
            generator: self.generator.valid(),
            mean: self.mean.clone(),
            n_frames: self.n_frames,
        })
    }
}

/// `FrictGAN` that has learnt.
struct Generated {
    generator: Generator,
    mean: Vec<f32>,
    n_frames: usize,
}

impl Network for Generated {
    fn predict(&self, example: &Example) -> Prediction {
        let device = Device::flex();
        let noise = tensor(vec![0.0; N_NOISE], [1, N_NOISE], &device);
        let seen = self.generator.encode(pictures(&[example], &device));
        let found = values(self.generator.decode(&seen, noise, None));
        let magnitude = |bin: usize, frame: usize| {
            f64::from((found[bin * self.n_frames + frame] + self.mean[bin]).max(0.0))
        };
        Prediction::of_magnitudes(Grid::from_fn(N_BINS, self.n_frames, magnitude))
    }

    fn weights(&self) -> Option<Weights> {
        None
    }
}

/// Pictures, −1 to 1.
fn pictures(examples: &[&Example], device: &Device) -> Tensor<4> {
    let picture = |e: &&Example| {
        let square = e.square();
        square
            .values()
            .iter()
            .map(|v| 2.0 * v - 1.0)
            .collect::<Vec<_>>()
    };
    let all = examples.iter().flat_map(picture).collect();
    tensor(all, [examples.len(), 1, SIDE, SIDE], device)
}

/// Magnitudes of the whole trace, bin by bin, each with all its frames.
fn whole_magnitudes(example: &Example) -> Vec<Vec<f32>> {
    let magnitudes = magnitudes_of(&example.trace);
    let frames = |bin: usize| {
        let at = |frame: usize| to_single(magnitudes.row(frame)[bin]);
        (0..magnitudes.height()).map(at).collect()
    };
    (0..N_BINS).map(frames).collect()
}

fn above_mean(magnitudes: &[Vec<f32>], mean: &[f32]) -> Vec<f32> {
    let bins = magnitudes.iter().zip(mean);
    bins.flat_map(|(frames, mean)| frames.iter().map(move |m| m - mean))
        .collect()
}

fn mean_magnitudes(examples: &[Example]) -> Vec<f32> {
    let mut mean = vec![0.0; N_BINS];
    for example in examples {
        for (sum, frames) in mean.iter_mut().zip(whole_magnitudes(example)) {
            *sum += frames.iter().sum::<f32>() / (frames.len() * examples.len()) as f32;
        }
    }
    mean
}
