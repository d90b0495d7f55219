//! Learning: steps on batches in an order that hangs on the seed alone, kept after every round so
//! that it goes on where it was broken off, to the same bytes.

use std::f64::consts::PI;

use burn::tensor::Tensor;

use selvedge_foundation::numerics::{Random, to_index};
use selvedge_foundation::progress::Progress;

use super::checkpoint::{Parts, put};
use super::critic::AdversarialLoss;
use super::gan::FrictGan;
use super::lesson::{Lesson, Method};
use super::ours::Ours;
use super::weights::Weights;
use crate::FrictionError;
use crate::example::Example;
use crate::score::Prediction;

/// Examples of a step.
const BATCH: usize = 8;
/// How much an error of magnitudes weighs against the critic, as in the paper.
pub(super) const L1_WEIGHT: f64 = 100.0;

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

/// A network that learns.
pub(super) trait Learner {
    /// Learns from a batch; `rate`, 1 to 0, is what is left of the step's length.
    fn step(
        &mut self,
        batch: &[&Example],
        loss: AdversarialLoss,
        rate: f64,
        random: &mut Random,
    ) -> Losses;

    /// Puts what going on needs behind `bytes`.
    fn save(&self, bytes: &mut Vec<u8>);

    /// Takes back what [`Self::save`] put.
    fn restore(&mut self, parts: &mut Parts<'_>) -> Result<(), FrictionError>;

    /// The network as it is now.
    fn network(&self) -> Box<dyn Network>;
}

/// A network that has learnt.
pub(crate) trait Network {
    /// What it makes of an example's picture.
    fn predict(&self, example: &Example) -> Prediction;

    /// Its weights, if they are kept.
    fn weights(&self) -> Option<Weights>;
}

/// A network in the middle of learning.
pub(crate) struct Learning {
    lesson: Lesson,
    learner: Box<dyn Learner>,
    n_rounds_done: usize,
}

impl Learning {
    /// Begins to learn from examples, of which there is at least one.
    pub(crate) fn begin(lesson: Lesson, examples: &[Example]) -> Self {
        let learner: Box<dyn Learner> = match lesson.method {
            Method::Ours => Box::new(Ours::begin(&lesson, examples, false)),
            Method::OursAdversarial => Box::new(Ours::begin(&lesson, examples, true)),
            Method::FrictGan => Box::new(FrictGan::begin(&lesson, examples)),
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
        learning.learner.restore(&mut parts)?;
        Ok(learning)
    }

    /// Everything that going on needs.
    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        put(&mut bytes, &(self.n_rounds_done as u64).to_le_bytes());
        self.learner.save(&mut bytes);
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
            let rate = 0.5 + 0.5 * (PI * all.min(1.0)).cos();
            let lost = self
                .learner
                .step(batch, self.lesson.loss, rate, &mut random);
            sum.spectra += lost.spectra / n_steps as f64;
            sum.level += lost.level / n_steps as f64;
            sum.critic += lost.critic / n_steps as f64;
        }
        self.n_rounds_done += 1;
        Ok(sum)
    }

    /// The network as it is now.
    pub(crate) fn network(&self) -> Box<dyn Network> {
        self.learner.network()
    }
}

pub(super) fn number(loss: &Tensor<1>) -> f64 {
    f64::from(loss.clone().into_scalar::<f32>())
}
