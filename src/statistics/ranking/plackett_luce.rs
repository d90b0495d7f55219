//! Rankings by Plackett and Luce's model (Luce 1959; Plackett 1975): the best is chosen among all,
//! the next among the rest, each with a probability that is its share of the worth there.

use super::choices::{Choices, Prior, shares};
use super::deviance::likelihood_ratio;
use super::newton::LogLikelihood as _;
use super::preferences::check_rankings;
use super::scale::Scale;
use crate::{Computed, Named, Outcome, undefined};

/// Worths of items from rankings.
#[derive(Debug, Clone, PartialEq)]
pub struct PlackettLuce {
    /// Natural logarithms of the worths, summing to zero, with errors from the observed
    /// information: those of rankings that know nothing of each other. Where subjects gave several
    /// each, the error over subjects is the honest one.
    pub scale: Scale,
    /// Rankings that entered.
    pub n_rankings: usize,
    /// Log-likelihood of the rankings, without the prior's share.
    pub(crate) log_likelihood: f64,
    /// That of worths all equal: of rankings by chance.
    pub(crate) null_log_likelihood: f64,
    /// Steps of Newton's method.
    pub n_steps: usize,
    /// What was known before; with a prior the worths are the mode of what is known after, and the
    /// errors its curvature.
    pub prior: Prior,
}

impl PlackettLuce {
    /// Worths that sum to 1: the probability of each item to be ranked first among all.
    pub fn worths(&self) -> Vec<f64> {
        let all: Vec<usize> = (0..self.scale.values.len()).collect();
        shares(&self.scale.values, &all)
    }

    /// Whether rankings are other than by chance, by the ratio of likelihoods. The effect is the
    /// share of the log-likelihood explained (likelihood-ratio index).
    ///
    /// # Errors
    /// A prior: the ratio follows no χ².
    pub fn against_chance(&self) -> Computed<Outcome> {
        if !self.prior.is_none() {
            return undefined("with a prior the ratio of likelihoods follows no χ²");
        }
        let ratio = 2.0 * (self.log_likelihood - self.null_log_likelihood);
        let df = self.scale.values.len() - 1;
        let effect = Named::of("R²", 1.0 - self.log_likelihood / self.null_log_likelihood);
        likelihood_ratio(
            "worths against chance",
            self.n_rankings,
            (ratio, df),
            effect,
        )
    }

    /// The most likely worths of `n_items` items from rankings, each the indices of two items or
    /// more, best first; items that a ranking leaves out say nothing in it.
    ///
    /// By Newton's method on log-worths, to 1e-10; the peak is where Hunter's MM (2004) ends.
    ///
    /// # Errors
    /// Fewer than two items, no rankings, a ranking with fewer than two items or an item twice or
    /// unknown (with its number); groups of items without finite worths, unless there is a prior.
    pub fn fit<R: AsRef<[usize]>>(n_items: usize, rankings: &[R], prior: Prior) -> Computed<Self> {
        check_rankings(n_items, rankings)?;
        let mut choices = Choices::new(n_items);
        for ranking in rankings {
            choices.add_ranking(ranking.as_ref());
        }
        let peak = choices.peak(prior)?;
        Ok(Self {
            scale: Scale::of(&peak.at, &peak.covariance),
            n_rankings: rankings.len(),
            log_likelihood: choices.value(&peak.at),
            null_log_likelihood: choices.null_value(),
            n_steps: peak.n_steps,
            prior,
        })
    }
}
