//! The logarithm of the posterior as a function of numbers.

use super::answers::Block;
use super::curve::scaled;
use super::prior::{Priors, times_ln};
use super::{Model, Psychometric};

/// Everything that the posterior depends on but its arguments.
#[derive(Debug, Clone)]
pub(super) struct Target<'a> {
    pub(super) model: Model,
    pub(super) priors: &'a Priors,
    pub(super) places: Vec<f64>,
    pub(super) blocks: &'a [Block],
}

/// Threshold on the family's scale, logarithm of the width, lapse rate.
pub(super) type Point = [f64; 3];

impl<'a> Target<'a> {
    pub(super) fn new(model: Model, priors: &'a Priors, blocks: &'a [Block]) -> Self {
        Self {
            model,
            priors,
            places: blocks.iter().map(|b| model.family.place(b.x)).collect(),
            blocks,
        }
    }

    /// The logarithm of the posterior density of threshold, width and lapse rate, but for a
    /// constant.
    pub(super) fn ln_posterior(&self, [threshold, ln_width, lapse]: Point) -> f64 {
        let width = ln_width.exp();
        let ln_prior = self.priors.ln_prior(threshold, width);
        if ln_prior.is_finite() {
            ln_prior + self.ln_likelihood([threshold, ln_width, lapse])
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Σ k ln p + (n − k) ln(1 − p).
    pub(super) fn ln_likelihood(&self, [threshold, ln_width, lapse]: Point) -> f64 {
        self.ln_likelihood_of(self.shares([threshold, ln_width]), lapse)
    }

    /// F and 1 − F of every block.
    pub(super) fn shares(&self, [threshold, ln_width]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let per_width = (-ln_width).exp();
        let family = self.model.family;
        let places = self.places.iter();
        places.map(move |place| family.shares((place - threshold) * per_width))
    }

    /// The log-likelihood where F of every block is known.
    pub(super) fn ln_likelihood_of(
        &self,
        shares: impl Iterator<Item = [f64; 2]>,
        lapse: f64,
    ) -> f64 {
        let guess = self.model.guess.rate(lapse);
        let both = shares.zip(self.blocks);
        both.map(|(shares, block)| of_block(block, scaled(shares, guess, lapse)))
            .sum()
    }

    pub(super) fn curve(&self, [threshold, ln_width, lapse]: Point) -> Psychometric {
        Psychometric {
            family: self.model.family,
            threshold: self.model.family.stimulus(threshold),
            width: ln_width.exp(),
            guess: self.model.guess.rate(lapse),
            lapse,
        }
    }
}

/// The point that a curve is.
pub(super) fn point(curve: &Psychometric) -> Point {
    let threshold = curve.family.place(curve.threshold);
    [threshold, curve.width.ln(), curve.lapse]
}

fn of_block(block: &Block, [p, q]: [f64; 2]) -> f64 {
    let n_wrong = block.n - block.n_right;
    times_ln(f64::from(block.n_right), p) + times_ln(f64::from(n_wrong), q)
}

/// 2 Σ n[y ln(y/p) + (1 − y) ln((1 − y)/(1 − p))], y the share right of each block.
pub(super) fn deviance(blocks: &[Block], curve: &Psychometric) -> f64 {
    let of = |block: &Block| {
        let y = f64::from(block.n_right) / f64::from(block.n);
        of_block(block, [y, 1.0 - y]) - of_block(block, curve.probabilities(block.x))
    };
    2.0 * blocks.iter().map(of).sum::<f64>()
}
