//! How likely a subject's answers are under every function of a grid of thresholds, widths and
//! lapse rates: what all estimates are sums over.

use super::answers::Block;
use super::curve::scaled;
use super::model::{Expected, Model};

/// Cells along threshold, width and lapse rate.
pub(super) const CELLS: [usize; 3] = [48, 16, 5];
/// Widths reach so far to either side of the usual one: their logarithm.
const LN_WIDTHS: f64 = 1.6;
/// No lapse rate above this is believed.
const MAX_LAPSE: f64 = 0.12;
/// Thresholds that are less probable than the best by this share are left out.
const LEAST: f64 = 1e-5;
/// A normal density on cells is no narrower than so many of them: below that its sum depends on
/// where its middle lies between two.
const NARROWEST: f64 = 0.6;

/// The likelihood of a subject's answers over a grid of functions.
#[derive(Debug, Clone)]
pub struct Evidence {
    pub(super) model: Model,
    pub(super) blocks: Vec<Block>,
    /// Where the middle of the first cell of thresholds lies, on the family's scale.
    first: f64,
    /// From one cell of thresholds to the next.
    pub(super) step: f64,
    /// Over its largest; lapse rates innermost, thresholds outermost.
    likelihood: Vec<f64>,
}

/// Sums over the widths and lapse rates of one threshold.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct AtThreshold {
    /// Probability of the answers.
    pub likelihood: f64,
    /// The same times the logarithm of the width.
    pub ln_width: f64,
    /// The same times the lapse rate.
    pub lapse: f64,
}

impl Evidence {
    pub(super) fn of(model: Model, blocks: Vec<Block>) -> Self {
        let places = blocks.iter().map(|b| model.family.place(b.x));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
            (low.min(place), high.max(place))
        });
        let beyond = (0.5 * (high - low)).max(model.usual_width);
        let mut evidence = Self {
            model,
            blocks,
            first: 0.0,
            step: 0.0,
            likelihood: Vec::new(),
        };
        evidence.spread([low - beyond, high + beyond]);
        // Twice: of many trials all may lie within a cell or two of the whole range.
        for _ in 0..2 {
            let ends = evidence.ends();
            evidence.spread(ends);
        }
        evidence
    }

    /// Lays the grid between two thresholds.
    fn spread(&mut self, [low, high]: [f64; 2]) {
        self.step = (high - low) / CELLS[0] as f64;
        self.first = low + 0.5 * self.step;
        let mut ln_likelihood = Vec::with_capacity(CELLS.iter().product());
        self.each_function(|evidence, threshold, width, lapse| {
            ln_likelihood.push(evidence.ln_likelihood(threshold, width, lapse));
        });
        let most = ln_likelihood
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        for value in &mut ln_likelihood {
            *value = (*value - most).exp();
        }
        self.likelihood = ln_likelihood;
    }

    /// Every function of the grid in order: threshold on the family's scale, width, lapse rate.
    pub(super) fn each_function(&self, mut take: impl FnMut(&Self, f64, f64, f64)) {
        for i in 0..CELLS[0] {
            for j in 0..CELLS[1] {
                for k in 0..CELLS[2] {
                    take(self, self.threshold(i), self.ln_width(j).exp(), lapse(k));
                }
            }
        }
    }

    /// p and 1 − p of every block.
    pub(super) fn shares(
        &self,
        threshold: f64,
        width: f64,
        lapse: f64,
    ) -> impl Iterator<Item = (&Block, [f64; 2])> {
        let Model { family, guess, .. } = self.model;
        self.blocks.iter().map(move |block| {
            let z = (family.place(block.x) - threshold) / width;
            (block, scaled(family.shares(z), guess.rate(lapse), lapse))
        })
    }

    fn ln_likelihood(&self, threshold: f64, width: f64, lapse: f64) -> f64 {
        let shares = self.shares(threshold, width, lapse);
        shares
            .map(|(block, [p, q])| of_block(block, block.n_right, [p, q]))
            .sum()
    }

    /// The middle of a cell, on the family's scale.
    pub(super) fn threshold(&self, i: usize) -> f64 {
        self.first + self.step * i as f64
    }

    /// The middle of a cell: the logarithm of the width.
    pub(super) fn ln_width(&self, j: usize) -> f64 {
        let share = (j as f64 + 0.5) / CELLS[1] as f64;
        self.model.usual_width.ln() + LN_WIDTHS * (2.0 * share - 1.0)
    }

    /// The sums of every threshold where width and lapse rate are known so far.
    pub(super) fn over_thresholds(&self, expected: &Expected) -> Vec<AtThreshold> {
        let [widths, lapses] = self.weights(expected);
        let row = |row: &[f64]| {
            let mut sums = AtThreshold::default();
            for (j, (cells, weight)) in row.chunks_exact(CELLS[2]).zip(&widths).enumerate() {
                let both = || cells.iter().zip(&lapses);
                let mass: f64 = both().map(|(l, w)| l * w).sum();
                let of_lapse = both().enumerate().map(|(k, (l, w))| l * w * lapse(k));
                sums.likelihood += weight * mass;
                sums.ln_width += weight * mass * self.ln_width(j);
                sums.lapse += weight * of_lapse.sum::<f64>();
            }
            sums
        };
        self.likelihood
            .chunks_exact(CELLS[1] * CELLS[2])
            .map(row)
            .collect()
    }

    /// The probability of the answers at every threshold, where that is all that is wanted.
    pub(super) fn likelihoods(&self, [widths, lapses]: &[Vec<f64>; 2], out: &mut Vec<f64>) {
        let row = |row: &[f64]| -> f64 {
            let cells = row.chunks_exact(CELLS[2]).zip(widths);
            cells
                .map(|(cells, width)| {
                    let mass: f64 = cells.iter().zip(lapses).map(|(l, w)| l * w).sum();
                    width * mass
                })
                .sum()
        };
        out.clear();
        out.extend(self.likelihood.chunks_exact(CELLS[1] * CELLS[2]).map(row));
    }

    /// Weights of widths and of lapse rates, 1 together.
    pub(super) fn weights(&self, expected: &Expected) -> [Vec<f64>; 2] {
        let [mean, sd] = expected.ln_width;
        let sd = sd.max(NARROWEST * 2.0 * LN_WIDTHS / CELLS[1] as f64);
        let width = |j: usize| (-0.5 * ((self.ln_width(j) - mean) / sd).powi(2)).exp();
        // Cells lie closer towards 0: each counts as much as it is long.
        let rate = |k: usize| (2.0 * k as f64 + 1.0) * (-lapse(k) / expected.lapse).exp();
        [
            shared((0..CELLS[1]).map(width).collect()),
            shared((0..CELLS[2]).map(rate).collect()),
        ]
    }

    /// The density of a normal of thresholds at every cell, times its length.
    pub(super) fn normal(&self, [mean, sd]: [f64; 2]) -> impl Iterator<Item = f64> {
        let sd = sd.max(NARROWEST * self.step);
        let scale = self.step / (sd * (2.0 * std::f64::consts::PI).sqrt());
        (0..CELLS[0]).map(move |i| scale * (-0.5 * ((self.threshold(i) - mean) / sd).powi(2)).exp())
    }

    /// Between which thresholds all lie that are not much less probable than the best, with a
    /// cell to spare.
    fn ends(&self) -> [f64; 2] {
        let mut masses = Vec::new();
        self.likelihoods(&self.weights(&self.model.expected()), &mut masses);
        let least = LEAST * masses.iter().copied().fold(0.0, f64::max);
        let first = masses.iter().position(|m| *m > least).unwrap_or(0);
        let last = masses.iter().rposition(|m| *m > least).unwrap_or(0);
        let [low, high] = [first, last].map(|at| self.threshold(at));
        [low - 1.5 * self.step, high + 1.5 * self.step]
    }
}

/// The middle of a cell of lapse rates.
pub(super) fn lapse(k: usize) -> f64 {
    MAX_LAPSE * ((k as f64 + 0.5) / CELLS[2] as f64).powi(2)
}

/// What adds up to 1.
pub(super) fn shared(mut masses: Vec<f64>) -> Vec<f64> {
    let sum: f64 = masses.iter().sum();
    for mass in &mut masses {
        *mass /= sum;
    }
    masses
}

/// k ln p + (n − k) ln(1 − p).
pub(super) fn of_block(block: &Block, n_right: u32, [p, q]: [f64; 2]) -> f64 {
    let times_ln = |n: u32, share: f64| {
        if n > 0 {
            f64::from(n) * share.ln()
        } else {
            0.0
        }
    };
    times_ln(n_right, p) + times_ln(block.n - n_right, q)
}
