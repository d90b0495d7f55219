//! Paired comparisons by Bradley and Terry's model (Zermelo 1929; Bradley & Terry 1952): the log of
//! the odds that one item is preferred to another is the difference of their abilities.

use super::choices::{Choices, Prior};
use super::deviance::Deviance;
use super::newton::LogLikelihood as _;
use super::preferences::Preferences;
use super::scale::Scale;
use crate::Computed;

/// Abilities of items from paired comparisons.
#[derive(Debug, Clone, PartialEq)]
pub struct BradleyTerry {
    /// Abilities in logits, natural logarithms of odds, summing to zero, with errors from the
    /// observed information.
    pub scale: Scale,
    /// Log-likelihood of the comparisons, without the prior's share and the binomial coefficients.
    pub(crate) log_likelihood: f64,
    /// Against a probability for each pair, and against one half for all.
    pub deviance: Deviance,
    /// Steps of Newton's method.
    pub n_steps: usize,
    /// What was known before.
    pub prior: Prior,
}

impl BradleyTerry {
    /// The most likely abilities, by Newton's method to 1e-10; the peak is where Hunter's MM (2004)
    /// ends.
    ///
    /// # Errors
    /// Fewer than two items, no comparisons; groups of items without finite abilities, unless
    /// there is a prior.
    pub fn fit(preferences: &Preferences, prior: Prior) -> Computed<Self> {
        preferences.check()?;
        let n_items = preferences.n_items();
        let mut choices = Choices::new(n_items);
        for pair in preferences.compared() {
            for (chosen, wins) in pair.items.into_iter().zip(pair.wins) {
                if wins > 0 {
                    choices.add(chosen, pair.items.to_vec(), wins as f64);
                }
            }
        }
        let peak = choices.peak(prior)?;
        Ok(Self {
            scale: Scale::of(&peak.at, &peak.covariance),
            log_likelihood: choices.value(&peak.at),
            deviance: Deviance::of(preferences, prior, |pair| {
                let [i, j] = pair.items;
                odds_of(peak.at[i] - peak.at[j])
            }),
            n_steps: peak.n_steps,
            prior,
        })
    }
}

/// Probabilities of either item from the difference of their abilities.
fn odds_of(difference: f64) -> [f64; 2] {
    [difference, -difference].map(|d| 1.0 / (1.0 + (-d).exp()))
}
