//! Learning: steps on batches in an order that hangs on the seed alone, kept after every round so
//! that it goes on where it was broken off, to the same bytes.

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer, RmsPropConfig};
use burn::tensor::{Bytes, Device, Tensor};
use serde::{Deserialize, Serialize};

use selvedge_foundation::named;
use selvedge_foundation::numerics::{Grid, Random, to_index, to_single};
use selvedge_foundation::progress::Progress;

use super::critic::{AdversarialLoss, Critic};
use super::frictgan::{Generator, N_NOISE, SIDE, critic_crop};
use super::registered::{Answer, Registered, Scales, Size};
use super::weights::{Weights, drawn, filled, read, tensor, values};
use crate::FrictionError;
use crate::example::Example;
use crate::picture::Looks;
use crate::score::Prediction;
use crate::signal::{Course, N_BINS};

/// Examples of a step.
const BATCH: usize = 8;
/// How much the error of the level and of the trend weighs against that of the spectra.
const WEIGHTS: [f64; 2] = [0.3, 0.05];
/// How much an error of magnitudes weighs against the critic, as in the paper.
const L1_WEIGHT: f64 = 100.0;
/// Steps of the critic for one of `FrictGAN`'s generator.
const N_CRITIC_STEPS: usize = 5;

named! {
    /// Which network learns.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Method {
        /// Registered strips, level, trend and spectra apart.
        Ours = "ours", "registered strips; level, trend and spectra apart",
        /// The same with a critic.
        OursAdversarial = "ours-adversarial", "the same with a critic",
        /// `FrictGAN` built anew.
        FrictGan = "frictgan", "FrictGAN (Cai et al. 2021) built anew, at reduced size",
    }
    /// Its name on the command line and in tables.
    pub fn word;
    /// What it is.
    pub fn describe;
}

/// What is learnt how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lesson {
    /// Which network.
    pub method: Method,
    /// What generator and critic are told by each other, where there are both.
    pub loss: AdversarialLoss,
    /// How large ours is.
    pub size: Size,
    /// Times that every example is seen.
    pub n_rounds: usize,
    /// What everything that is drawn hangs on.
    pub seed: u64,
}

impl Lesson {
    /// As shipped and compared.
    pub fn usual(method: Method, seed: u64) -> Self {
        Self {
            method,
            loss: AdversarialLoss::Entropy,
            size: Size::default(),
            n_rounds: match method {
                Method::Ours | Method::FrictGan => 8,
                Method::OursAdversarial => 6,
            },
            seed,
        }
    }
}

/// What was lost in a round, means over its steps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Losses {
    /// Mean absolute error of log magnitudes (ours) or of magnitudes (`FrictGAN`).
    pub spectra: f64,
    /// Mean absolute error of the level, in units of 0.05; 0 where it is not learnt apart.
    pub level: f64,
    /// What the critic lost; 0 without one.
    pub critic: f64,
}

/// A network in the middle of learning.
#[derive(Debug)]
pub(crate) struct Learning {
    lesson: Lesson,
    learner: Learner,
    n_rounds_done: usize,
}

enum Learner {
    Ours(Box<Ours>),
    FrictGan(Box<FrictGan>),
}

impl std::fmt::Debug for Learner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Ours(_) => "Ours",
            Self::FrictGan(_) => "FrictGan",
        })
    }
}

struct Ours {
    network: Registered,
    scales: Scales,
    optimizer: ModuleOptimizer,
    critic: Option<(Critic, ModuleOptimizer)>,
}

struct FrictGan {
    generator: Generator,
    critic: Critic,
    optimizers: [ModuleOptimizer; 2],
    /// Mean magnitude of every bin over what is learnt.
    mean: Vec<f32>,
    n_frames: usize,
}

impl Learning {
    /// Begins to learn from examples, of which there is at least one.
    pub(crate) fn begin(lesson: Lesson, examples: &[Example]) -> Self {
        let device = Device::flex().autodiff();
        let n_frames = examples.first().map_or(1, |e| e.course.trend.len());
        let learner = match lesson.method {
            Method::Ours | Method::OursAdversarial => {
                let has_critic = lesson.method == Method::OursAdversarial;
                let critic = || {
                    let critic = Critic::new(crate::picture::N_CHANNELS + 1, 8, &device);
                    (drawn(critic, !lesson.seed), AdamConfig::new().init())
                };
                Learner::Ours(Box::new(Ours {
                    network: drawn(Registered::new(lesson.size, &device), lesson.seed),
                    scales: Scales::of(examples),
                    optimizer: AdamConfig::new().init(),
                    critic: has_critic.then(critic),
                }))
            }
            Method::FrictGan => {
                let rms_prop = || {
                    let config = RmsPropConfig::new().with_alpha(0.9).with_momentum(0.0);
                    config.with_epsilon(1e-7).init()
                };
                Learner::FrictGan(Box::new(FrictGan {
                    generator: drawn(Generator::new(n_frames, &device), lesson.seed),
                    critic: drawn(Critic::new(2, 16, &device), !lesson.seed),
                    optimizers: [rms_prop(), rms_prop()],
                    mean: mean_magnitudes(examples),
                    n_frames,
                }))
            }
        };
        Self {
            lesson,
            learner,
            n_rounds_done: 0,
        }
    }

    /// Goes on from a [`Self::checkpoint`] of the same lesson on the same examples.
    ///
    /// # Errors
    /// Bytes that are none.
    pub(crate) fn resume(
        lesson: Lesson,
        examples: &[Example],
        checkpoint: &[u8],
    ) -> Result<Self, FrictionError> {
        let mut learning = Self::begin(lesson, examples);
        let mut parts = Parts(checkpoint);
        let n_rounds_done = parts.next()?;
        let head = <[u8; 8]>::try_from(n_rounds_done).map_err(Parts::wrong)?;
        learning.n_rounds_done = to_index(u64::from_le_bytes(head) as f64);
        match &mut learning.learner {
            Learner::Ours(ours) => {
                parts.restore(&mut ours.network, &mut ours.optimizer)?;
                if let Some((critic, optimizer)) = &mut ours.critic {
                    parts.restore(critic, optimizer)?;
                }
            }
            Learner::FrictGan(gan) => {
                let [of_generator, of_critic] = &mut gan.optimizers;
                parts.restore(&mut gan.generator, of_generator)?;
                parts.restore(&mut gan.critic, of_critic)?;
            }
        }
        Ok(learning)
    }

    /// Everything that going on needs.
    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        put(&mut bytes, &(self.n_rounds_done as u64).to_le_bytes());
        match &self.learner {
            Learner::Ours(ours) => {
                save(&mut bytes, &ours.network, &ours.optimizer);
                if let Some((critic, optimizer)) = &ours.critic {
                    save(&mut bytes, critic, optimizer);
                }
            }
            Learner::FrictGan(gan) => {
                save(&mut bytes, &gan.generator, &gan.optimizers[0]);
                save(&mut bytes, &gan.critic, &gan.optimizers[1]);
            }
        }
        bytes
    }

    /// Rounds that are done, of [`Lesson::n_rounds`].
    pub(crate) fn n_rounds_done(&self) -> usize {
        self.n_rounds_done
    }

    /// Sees every example once more (but for those that fill no whole batch).
    ///
    /// # Errors
    /// Cancelled: what was learnt in this round is not to be used.
    pub(crate) fn round(
        &mut self,
        examples: &[Example],
        progress: &mut Progress<'_>,
    ) -> Result<Losses, FrictionError> {
        let round = self.n_rounds_done;
        let mut random = Random::new(self.lesson.seed).branch(&format!("round {round}"));
        let mut order: Vec<&Example> = examples.iter().collect();
        random.shuffle(&mut order);
        let batch = BATCH.min(order.len().max(1));
        let n_steps = order.len() / batch;
        let mut sum = Losses::default();
        for (step, batch) in order.chunks_exact(batch).enumerate() {
            let share = step as f64 / n_steps as f64;
            let all = (round as f64 + share) / self.lesson.n_rounds.max(1) as f64;
            progress
                .step(all, "learning")
                .map_err(|_stopped| FrictionError::Cancelled)?;
            // Slower towards the end: half a cosine.
            let rate = 0.5 + 0.5 * (std::f64::consts::PI * all.min(1.0)).cos();
            let lost = match &mut self.learner {
                Learner::Ours(ours) => ours.step(batch, self.lesson.loss, 2e-3 * rate + 1e-5),
                Learner::FrictGan(gan) => {
                    gan.step(batch, self.lesson.loss, 5e-4 * rate + 5e-6, &mut random)
                }
            };
            sum.spectra += lost.spectra / n_steps as f64;
            sum.level += lost.level / n_steps as f64;
            sum.critic += lost.critic / n_steps as f64;
        }
        if let Learner::FrictGan(gan) = &self.learner {
            gan.generator.settle();
        }
        self.n_rounds_done += 1;
        Ok(sum)
    }

    /// The network as it is now.
    pub(crate) fn network(&self) -> Network {
        match &self.learner {
            Learner::Ours(ours) => Network(Kind::Ours(Box::new(OurNetwork {
                network: ours.network.valid(),
                scales: ours.scales.clone(),
            }))),
            Learner::FrictGan(gan) => Network(Kind::FrictGan {
                generator: Box::new(gan.generator.valid()),
                mean: gan.mean.clone(),
                n_frames: gan.n_frames,
            }),
        }
    }
}

impl Ours {
    fn step(&mut self, batch: &[&Example], loss: AdversarialLoss, rate: f64) -> Losses {
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
}

impl FrictGan {
    fn step(
        &mut self,
        batch: &[&Example],
        loss: AdversarialLoss,
        rate: f64,
        random: &mut Random,
    ) -> Losses {
        let device = Device::flex().autodiff();
        let n = batch.len();
        let shape = [n, 1, N_BINS, self.n_frames];
        let pictures = pictures(batch, &device);
        let crop = |e: &&Example| critic_crop(&e.square(), self.n_frames);
        let crops = tensor(batch.iter().flat_map(crop).collect(), shape, &device);
        let felt = batch
            .iter()
            .flat_map(|e| above_mean(&whole_magnitudes(e), &self.mean));
        let felt = tensor(felt.collect(), shape, &device);
        let seen = |x: Tensor<4>| Tensor::cat(vec![crops.clone(), x], 1).swap_dims(2, 3);
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
            gan.generator.forward(pictures.clone(), noise, Some(&masks))
        };
        for _ in 0..N_CRITIC_STEPS {
            let generated = drawn(self).detach();
            let scores = [felt.clone(), generated].map(|x| self.critic.forward(seen(x)));
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
        let fooled = loss.of_generator(self.critic.forward(seen(generated)));
        let all = fooled + miss * L1_WEIGHT;
        let gradients = GradientsParams::from_grads(all.backward(), &self.generator);
        self.generator = self.optimizers[0].step(rate, self.generator.clone(), gradients);
        losses
    }
}

/// A network that has learnt.
pub(crate) struct Network(Kind);

enum Kind {
    Ours(Box<OurNetwork>),
    FrictGan {
        generator: Box<Generator>,
        mean: Vec<f32>,
        n_frames: usize,
    },
}

impl std::fmt::Debug for Network {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Network")
    }
}

impl Network {
    /// What it makes of an example's picture.
    pub(crate) fn predict(&self, example: &Example) -> Prediction {
        match &self.0 {
            Kind::Ours(network) => {
                let courses = network.courses(&[&example.looks]);
                courses
                    .first()
                    .map_or_else(|| Prediction::of_trace(Vec::new()), Prediction::of_course)
            }
            Kind::FrictGan {
                generator,
                mean,
                n_frames,
            } => {
                let device = Device::flex();
                let noise = tensor(vec![0.0; N_NOISE], [1, N_NOISE], &device);
                let found = generator.forward(pictures(&[example], &device), noise, None);
                let found = values(found);
                let magnitude = |bin: usize, frame: usize| {
                    f64::from((found[bin * n_frames + frame] + mean[bin]).max(0.0))
                };
                Prediction::of_magnitudes(Grid::from_fn(N_BINS, *n_frames, magnitude))
            }
        }
    }

    /// Ours, if it is that.
    pub(crate) fn into_ours(self) -> Option<OurNetwork> {
        match self.0 {
            Kind::Ours(network) => Some(*network),
            Kind::FrictGan { .. } => None,
        }
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

    /// Its weights.
    pub(crate) fn weights(&self) -> Weights {
        Weights {
            scales: self.scales.numbers(),
            values: read(&self.network),
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
        self.scales.courses(self.network.decode(code))
    }

    /// A cloth that lies so far (0 to 1) from the first strip's to the second's, which is as long;
    /// `None` if it is not.
    pub(crate) fn between(&self, from: &Looks, to: &Looks, share: f64) -> Option<Course> {
        if from.channels[0].height() != to.channels[0].height() {
            return None;
        }
        let device = Device::flex();
        let [from, to] =
            [from, to].map(|looks| self.network.encode(self.scales.inputs(&[looks], &device)));
        self.scales
            .courses(self.network.decode(from.towards(&to, share)))
            .pop()
    }
}

fn number(loss: &Tensor<1>) -> f64 {
    f64::from(loss.clone().into_scalar::<f32>())
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
    let magnitudes = crate::baseline::magnitudes_of(&example.trace);
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

/// A part of a checkpoint: its length, its bytes.
fn put(bytes: &mut Vec<u8>, part: &[u8]) {
    bytes.extend((part.len() as u64).to_le_bytes());
    bytes.extend(part);
}

fn save<M: Module>(bytes: &mut Vec<u8>, module: &M, optimizer: &ModuleOptimizer) {
    // Records are made in memory: nothing can fail but what resuming would find.
    let part = |record: Result<Bytes, _>| {
        record.map_or_else(
            |_: burn::store::RecordError| Vec::new(),
            |bytes| bytes.to_vec(),
        )
    };
    put(bytes, &part(module.clone().into_record().into_bytes()));
    put(bytes, &part(optimizer.into_bytes()));
}

/// Parts of a checkpoint that are still to come.
struct Parts<'a>(&'a [u8]);

impl<'a> Parts<'a> {
    fn wrong(what: impl std::fmt::Display) -> FrictionError {
        FrictionError::Checkpoint {
            what: what.to_string(),
        }
    }

    fn next(&mut self) -> Result<&'a [u8], FrictionError> {
        let cut = || Self::wrong("it is cut short");
        let (head, rest) = self.0.split_first_chunk::<8>().ok_or_else(cut)?;
        let length = usize::try_from(u64::from_le_bytes(*head)).map_err(Self::wrong)?;
        let (part, rest) = rest.split_at_checked(length).ok_or_else(cut)?;
        self.0 = rest;
        Ok(part)
    }

    fn restore<M: Module>(
        &mut self,
        module: &mut M,
        optimizer: &mut ModuleOptimizer,
    ) -> Result<(), FrictionError> {
        let bytes = |part: &[u8]| Bytes::from_bytes_vec(part.to_vec());
        let record =
            burn::store::ModuleRecord::from_bytes(bytes(self.next()?)).map_err(Self::wrong)?;
        *module = module.clone().load_record(record);
        let state = self.next()?;
        *optimizer = optimizer
            .clone()
            .from_bytes(bytes(state))
            .map_err(Self::wrong)?;
        Ok(())
    }
}
