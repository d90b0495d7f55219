//! What data without structure would give: ranks drawn at random (Spence & Ogilvie 1973), or the
//! data's own dissimilarities dealt to other pairs.

use super::fit::Problem;
use super::search::{Plan, search};
use super::{Dissimilarities, Loss, Mds};
use selvedge_foundation::numerics::{Random, in_pieces, quantile};
use selvedge_foundation::progress::{Cancelled, Progress};

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

/// Starts that find the lowest loss of data without structure in a plane or more.
const N_STARTS: usize = 5;
/// Starts on a line for S-stress, which has few low places there.
const N_ON_A_LINE_SSTRESS: usize = 60;
/// Starts on a line for stress-1, followed by exchange of objects in the best order.
const N_ON_A_LINE_STRESS1: usize = 20;

impl Mds {
    /// The same with as many starts as data without structure need: they have many places nearly as
    /// low as the lowest. Against ten to fifty times as many starts, 40 sets of random ranks of 7
    /// and 16 objects have the same 5 % point to four digits and means 0.000–0.003 higher.
    #[must_use]
    pub fn for_chance(&self) -> Self {
        let (n_on_a_line, n_exchanged) = match self.loss {
            Loss::SStress => (N_ON_A_LINE_SSTRESS, 0),
            Loss::Stress1 => (N_ON_A_LINE_STRESS1, 1),
        };
        Self {
            n_starts: self.n_starts.min(N_STARTS),
            n_starts_on_a_line: self.n_starts_on_a_line.min(n_on_a_line),
            n_exchanged: self.n_exchanged.min(n_exchanged),
            ..*self
        }
    }
}

impl Null {
    /// Losses of `n_sets` sets of data with the objects, pairs and weights of `data`, made small
    /// as `mds` says with its starts. Too few starts leave losses too high, and the data look
    /// better than they are; [`Mds::for_chance`] has enough.
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
    let mds = Mds {
        n_threads: 1,
        ..*mds
    };
    let plan = Plan { k: dims, mds };
    let problem = Problem::new(set, mds.ties);
    let found = Progress::unheard(|progress| search(&problem, &plan, None, progress));
    found.map_or(1.0, |found| found.loss)
}
