//! Whether a function fits answers no worse than it would fit answers of its own (Wichmann & Hill
//! 2001).

use super::Fit;
use super::answers::Block;
use super::evidence::{Evidence, of_block};
use selvedge_foundation::numerics::Random;

/// How much answers lie off the function that is fitted to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Goodness {
    /// 2 Σ n[y ln(y/p) + (1 − y) ln((1 − y)/(1 − p))], y the share right of each stimulus.
    pub deviance: f64,
    /// Likewise of answers that the function itself gave, each set fitted again.
    pub simulated: Vec<f64>,
}

impl Goodness {
    /// Of a fit, by so many sets of answers at its stimuli. Stimuli are held as they were: of an
    /// adaptive procedure that is an approximation.
    pub fn of(evidence: &Evidence, fit: &Fit, (n_sets, seed): (usize, u64)) -> Self {
        let search = Search::of(evidence);
        let observed: Vec<u32> = evidence.blocks.iter().map(|b| b.n_right).collect();
        let mut random = Random::new(seed).branch("deviance");
        let simulated = (0..n_sets).map(|_| {
            let answered = |block: &Block| {
                let p = fit.curve.at(block.x);
                (0..block.n).map(|_| u32::from(random.uniform() < p)).sum()
            };
            let answers: Vec<u32> = evidence.blocks.iter().map(answered).collect();
            search.deviance(&evidence.blocks, &answers)
        });
        Self {
            simulated: simulated.collect(),
            deviance: search.deviance(&evidence.blocks, &observed),
        }
    }

    /// The probability of a deviance at least as large if the function holds.
    pub fn p(&self) -> f64 {
        let as_large = self
            .simulated
            .iter()
            .filter(|&&d| d >= self.deviance - 1e-9);
        (as_large.count() as f64 + 1.0) / (self.simulated.len() as f64 + 1.0)
    }

    /// Of several subjects together.
    pub fn together(all: &[Self]) -> Self {
        let n_sets = all.iter().map(|one| one.simulated.len()).min().unwrap_or(0);
        let of_set = |set: usize| all.iter().map(|one| one.simulated[set]).sum();
        Self {
            deviance: all.iter().map(|one| one.deviance).sum(),
            simulated: (0..n_sets).map(of_set).collect(),
        }
    }
}

/// The log-likelihood of any answers under every function of a grid.
struct Search {
    n_blocks: usize,
    /// Function by function: Σ n ln(1 − p).
    all_wrong: Vec<f64>,
    /// Likewise ln p − ln(1 − p) of every block.
    per_right: Vec<f64>,
}

impl Search {
    fn of(evidence: &Evidence) -> Self {
        let (mut all_wrong, mut per_right) = (Vec::new(), Vec::new());
        evidence.each_function(|evidence, threshold, width, lapse| {
            let mut sum = 0.0;
            for (block, [p, q]) in evidence.shares(threshold, width, lapse) {
                sum += f64::from(block.n) * q.ln();
                per_right.push(p.ln() - q.ln());
            }
            all_wrong.push(sum);
        });
        Self {
            n_blocks: evidence.blocks.len(),
            all_wrong,
            per_right,
        }
    }

    /// The deviance of the function of the grid that fits answers best.
    fn deviance(&self, blocks: &[Block], answers: &[u32]) -> f64 {
        let rights: Vec<f64> = answers.iter().map(|n| f64::from(*n)).collect();
        let rows = self
            .per_right
            .chunks_exact(self.n_blocks)
            .zip(&self.all_wrong);
        let best = rows.fold(f64::NEG_INFINITY, |best, (row, wrong)| {
            let gained: f64 = row.iter().zip(&rights).map(|(ln, n)| ln * n).sum();
            best.max(wrong + gained)
        });
        let of_itself = |(block, n_right): (&Block, &u32)| {
            let y = f64::from(*n_right) / f64::from(block.n);
            of_block(block, *n_right, [y, 1.0 - y])
        };
        let saturated: f64 = blocks.iter().zip(answers).map(of_itself).sum();
        2.0 * (saturated - best)
    }
}
