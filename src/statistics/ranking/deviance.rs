//! How far a model of paired comparisons lies from the counts: minus twice the logarithm of the
//! ratio of its likelihood to that of a model with free probabilities for every pair.

use super::choices::Prior;
use super::preferences::{Compared, Preferences};
use crate::{Computed, Named, Outcome, by_chi_squared, undefined};

/// Deviances of a model and of items all alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviance {
    /// Comparisons that entered.
    pub n_comparisons: u64,
    /// Of the model.
    pub residual: f64,
    /// Its degrees of freedom: free probabilities less parameters.
    pub df: usize,
    /// Of all items equal.
    pub null: f64,
    /// Its degrees of freedom.
    pub(crate) null_df: usize,
    /// What was known before the data; no test with a prior.
    pub prior: Prior,
}

impl Deviance {
    /// Of a model that gives every pair its two shares.
    pub(super) fn of(
        preferences: &Preferences,
        prior: Prior,
        shares: impl Fn(&Compared) -> [f64; 2],
    ) -> Self {
        let pairs = preferences.compared();
        let off = |pair: &Compared| deviance_of(pair.wins, shares(pair));
        let null = |pair: &Compared| deviance_of(pair.wins, [0.5; 2]);
        Self {
            n_comparisons: preferences.n_comparisons(),
            residual: pairs.iter().map(off).sum(),
            df: (pairs.len() + 1).saturating_sub(preferences.n_items()),
            null: pairs.iter().map(null).sum(),
            null_df: pairs.len(),
            prior,
        }
    }

    /// Whether the counts deviate from the model, by χ². A small p says that one scale does not
    /// describe them.
    ///
    /// # Errors
    /// A prior, or no degrees of freedom left.
    pub fn goodness_of_fit(&self) -> Computed<Outcome> {
        self.check()?;
        if self.df == 0 {
            let reason = "as many parameters as probabilities: nothing left to test the fit by";
            return undefined(reason);
        }
        let effect = self.explained();
        let test = (self.residual.max(0.0), self.df);
        likelihood_ratio("goodness of fit", self.n(), test, effect)
    }

    /// Whether items differ at all, by the fall of the deviance from all items equal.
    ///
    /// # Errors
    /// A prior.
    pub fn against_equal(&self) -> Computed<Outcome> {
        self.check()?;
        let fall = (self.null - self.residual).max(0.0);
        let test = (fall, self.null_df - self.df);
        likelihood_ratio("items differ", self.n(), test, self.explained())
    }

    fn explained(&self) -> Named {
        Named::of("R²", 1.0 - self.residual / self.null)
    }

    fn n(&self) -> usize {
        usize::try_from(self.n_comparisons).unwrap_or(usize::MAX)
    }

    fn check(&self) -> Computed<()> {
        if self.prior.is_none() {
            return Ok(());
        }
        undefined("with a prior the deviance follows no χ²")
    }
}

/// The share of minus twice the log-likelihood ratio of one pair: 2 Σ count ln(count/expected).
fn deviance_of<const N: usize>(counts: [u64; N], probabilities: [f64; N]) -> f64 {
    let n: u64 = counts.iter().sum();
    let term = |(&count, p): (&u64, f64)| match count {
        0 => 0.0,
        count => count as f64 * (count as f64 / (n as f64 * p)).ln(),
    };
    2.0 * counts.iter().zip(probabilities).map(term).sum::<f64>()
}

/// A test by χ² of minus twice the log of a ratio of likelihoods.
pub(super) fn likelihood_ratio(
    test: &'static str,
    n: usize,
    (statistic, df): (f64, usize),
    effect: Named,
) -> Computed<Outcome> {
    let statistic = (Named::of("χ²", statistic), df as f64);
    let effect = if effect.value.is_finite() {
        Ok(effect)
    } else {
        undefined("chance already explains everything")
    };
    by_chi_squared(test, vec![n], statistic, effect, "several items, not one")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pair_has_the_deviance_by_hand_and_counts_of_nothing_add_nothing() {
        let found = deviance_of([3, 1], [0.5, 0.5]);
        let by_hand = 2.0 * (3.0 * 1.5_f64.ln() + 0.5_f64.ln());
        assert!((found - by_hand).abs() < 1e-14, "{found}");
        let empty = deviance_of([4, 0], [0.5, 0.5]);
        assert!((empty - 8.0 * 2.0_f64.ln()).abs() < 1e-14, "{empty}");
        assert_eq!(deviance_of([2, 6], [0.25, 0.75]), 0.0);
    }

    #[test]
    fn without_freedom_or_with_a_prior_there_is_no_test() {
        let deviance = Deviance {
            n_comparisons: 10,
            residual: 0.0,
            df: 0,
            null: 0.0,
            null_df: 1,
            prior: Prior::None,
        };
        assert!(deviance.goodness_of_fit().is_err(), "no freedom");
        let equal = deviance.against_equal().unwrap();
        assert_eq!((equal.p, equal.effect.is_err()), (1.0, true));
        let prior = Prior::Gamma(1.0);
        assert!(Deviance { prior, ..deviance }.against_equal().is_err());
    }
}
