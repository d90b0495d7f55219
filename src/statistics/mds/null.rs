//! What data without structure would give: ranks drawn at random (Spence & Ogilvie 1973), or the
//! data's own dissimilarities dealt to other pairs.

use super::fit::Problem;
use super::search::search;
use super::{Dissimilarities, Mds};
use crate::numerics::{Random, in_pieces, quantile};
use crate::progress::{Cancelled, Progress, unheard};

/// Which data have no structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NullKind {
    /// Ranks drawn at random, without ties.
    RandomRanks,
    /// The data's own dissimilarities, ties and all, dealt to other pairs.
    Permuted,
}

/// Losses of data without structure in one number of dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Null {
    /// Dimensions.
    pub dims: usize,
    /// Losses, rising.
    pub losses: Vec<f64>,
}

impl Null {
    /// Losses of `n_sets` sets of data with the objects, pairs and weights of `data`, made small
    /// as `mds` says with its starts: as many as the data themselves had, else the two do not
    /// compare.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn of(
        mds: &Mds,
        data: &Dissimilarities,
        kind: NullKind,
        (dims, n_sets): (usize, usize),
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let mut losses = vec![0.0; n_sets];
        let purpose = match kind {
            NullKind::RandomRanks => "random ranks",
            NullKind::Permuted => "permuted",
        };
        let random = Random::new(mds.seed).branch(purpose);
        let n_together = 4 * mds.n_threads.max(1);
        for (n_done, some) in losses.chunks_mut(n_together).enumerate() {
            let first = n_done * n_together;
            let doing = format!("{purpose}, {dims} dimensions");
            progress.step(first as f64 / n_sets as f64, &doing)?;
            in_pieces(
                some,
                1,
                mds.n_threads,
                || (),
                |(), i, loss| {
                    let mut random = random.branch(&format!("set {}", first + i));
                    let set = without_structure(data, kind, &mut random);
                    loss[0] = lowest(mds, &set, dims);
                },
            );
        }
        losses.sort_by(f64::total_cmp);
        Ok(Self { dims, losses })
    }

    /// Their mean.
    pub fn mean(&self) -> f64 {
        self.losses.iter().sum::<f64>() / self.losses.len().max(1) as f64
    }

    /// The loss that one set in twenty goes below.
    pub fn five_percent(&self) -> f64 {
        quantile(&mut self.losses.clone(), 0.05)
    }

    /// How often chance gives a loss as low: (b + 1)/(N + 1).
    pub fn p_value(&self, loss: f64) -> f64 {
        let as_low = self.losses.iter().filter(|&&l| l <= loss + 1e-9).count();
        (as_low + 1) as f64 / (self.losses.len() + 1) as f64
    }
}

fn without_structure(
    data: &Dissimilarities,
    kind: NullKind,
    random: &mut Random,
) -> Dissimilarities {
    let own = || data.pairs().iter().map(|pair| pair.delta);
    let mut deltas: Vec<f64> = match kind {
        NullKind::RandomRanks => own().zip(1..).map(|(_, rank)| f64::from(rank)).collect(),
        NullKind::Permuted => own().collect(),
    };
    random.shuffle(&mut deltas);
    data.with_deltas(&deltas)
}

/// On the thread that asks: the sets are what threads share.
fn lowest(mds: &Mds, set: &Dissimilarities, dims: usize) -> f64 {
    let mut plan = mds.plan(dims);
    plan.n_threads = 1;
    let problem = Problem::new(set, mds.ties);
    let found = unheard(|progress| search(&problem, &plan, None, progress));
    found.map_or(1.0, |found| found.loss)
}
