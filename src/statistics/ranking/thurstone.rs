//! Paired comparisons by Thurstone's Case V (1927): each item gives a sensation that varies
//! normally, all alike and independently, and the stronger one is preferred.

use nalgebra::{DMatrix, DVector};

use super::choices::Prior;
use super::connection::number;
use super::deviance::Deviance;
use super::newton::{LogLikelihood, maximise};
use super::preferences::{Compared, Preferences, span_of_pairs};
use super::scale::Scale;
use crate::detection::Correction;
use crate::{
    Computed, Named, Outcome, by_chi_squared, normal_density, normal_lower, normal_quantile,
    undefined,
};

/// Values of items by maximum likelihood (probit).
///
/// The unit is the standard deviation of the difference of two sensations, so that P(i over j) =
/// Φ(sᵢ − sⱼ); times √2 it is that of one sensation, the unit of d′.
#[derive(Debug, Clone, PartialEq)]
pub struct Thurstone {
    /// Values summing to zero, with errors from the observed information.
    pub scale: Scale,
    /// Log-likelihood of the comparisons, without the binomial coefficients.
    pub(crate) log_likelihood: f64,
    /// Against a probability for each pair, and against one half for all.
    pub deviance: Deviance,
    /// Steps of Newton's method.
    pub n_steps: usize,
}

impl Thurstone {
    /// The most likely values, by Newton's method to 1e-10.
    ///
    /// # Errors
    /// Fewer than two items, no comparisons, groups of items without finite values.
    pub fn fit(preferences: &Preferences) -> Computed<Self> {
        preferences.check()?;
        preferences.connection().check(number)?;
        let n_items = preferences.n_items();
        let model = Probit {
            pairs: preferences.compared(),
        };
        let peak = maximise(&model, vec![0.0; n_items])?;
        Ok(Self {
            scale: Scale::of(&peak.at, &peak.covariance),
            log_likelihood: model.value(&peak.at),
            deviance: Deviance::of(preferences, Prior::None, |pair| shares(pair, &peak.at)),
            n_steps: peak.n_steps,
        })
    }
}

struct Probit {
    pairs: Vec<Compared>,
}

impl LogLikelihood for Probit {
    fn value(&self, x: &[f64]) -> f64 {
        let value = |pair: &Compared| {
            let terms = pair.wins.into_iter().zip(shares(pair, x));
            let term = |(wins, share): (u64, f64)| match wins {
                0 => 0.0,
                wins => wins as f64 * share.ln(),
            };
            terms.map(term).sum::<f64>()
        };
        self.pairs.iter().map(value).sum()
    }

    fn slopes(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let mut slopes = DVector::zeros(x.len());
        let mut information = DMatrix::zeros(x.len(), x.len());
        for pair in &self.pairs {
            let [i, j] = pair.items;
            let (mut slope, mut bend) = (0.0, 0.0);
            for (wins, sign) in pair.wins.into_iter().zip([1.0, -1.0]) {
                if wins > 0 {
                    // d ln Φ = φ/Φ and d² ln Φ = −φ/Φ (z + φ/Φ).
                    let lead = sign * (x[i] - x[j]);
                    let ratio = normal_density(lead) / normal_lower(lead);
                    slope += sign * wins as f64 * ratio;
                    bend += wins as f64 * ratio * (lead + ratio);
                }
            }
            for (a, sign) in [(i, 1.0), (j, -1.0)] {
                slopes[a] += sign * slope;
                information[(a, i)] += sign * bend;
                information[(a, j)] -= sign * bend;
            }
        }
        (slopes, information)
    }

    fn span(&self, step: &[f64]) -> f64 {
        span_of_pairs(&self.pairs, step)
    }
}

/// Probabilities that the first is preferred and the second.
fn shares(pair: &Compared, x: &[f64]) -> [f64; 2] {
    let lead = x[pair.items[0]] - x[pair.items[1]];
    [normal_lower(lead), normal_lower(-lead)]
}

/// Values of items as means of z over rows (Thurstone 1927; Mosteller 1951), in the unit of
/// [`Thurstone`], without errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Mosteller {
    /// Values summing to zero.
    pub values: Vec<f64>,
    /// Pairs in which one item was always preferred, whose share was moved to 1/(2n) or 1 − 1/(2n)
    /// since its z is infinite. The values hang on that choice.
    pub(crate) n_clipped: usize,
    /// Whether the shares deviate from the scale, by Mosteller's test (1951) on arcsines of the
    /// square roots of the shares as they are: χ² with (k − 1)(k − 2)/2 degrees of freedom.
    pub fit: Computed<Outcome>,
}

impl Mosteller {
    /// The values by row means of z.
    ///
    /// # Errors
    /// Fewer than two items, no comparisons, pairs that were never compared (with their list).
    pub fn of(preferences: &Preferences) -> Computed<Self> {
        preferences.check()?;
        let missing = preferences.pairs_where(|n| n == 0);
        if !missing.is_empty() {
            let reason = format!(
                "never compared: {}; row means need every pair",
                missing.join(", ")
            );
            return undefined(reason);
        }
        let k = preferences.n_items();
        let mut values = vec![0.0; k];
        let mut n_clipped = 0;
        let pairs = preferences.compared();
        for pair in &pairs {
            n_clipped += usize::from(pair.wins.contains(&0));
            let z = normal_quantile(Correction::Clip.share(pair.wins[0], pair.n()))?;
            values[pair.items[0]] += z / k as f64;
            values[pair.items[1]] -= z / k as f64;
        }
        let fit = arcsine_fit(&pairs, &values);
        Ok(Self {
            values,
            n_clipped,
            fit,
        })
    }
}

fn arcsine_fit(pairs: &[Compared], values: &[f64]) -> Computed<Outcome> {
    let k = values.len();
    if k < 3 {
        let reason = "two items have one share and one difference: nothing left to test by";
        return undefined(reason);
    }
    // The variance of the arcsine of the root of a share is 1/(4n).
    let term = |pair: &Compared| {
        let n = pair.n() as f64;
        let seen = (pair.wins[0] as f64 / n).sqrt().asin();
        let expected = shares(pair, values)[0].sqrt().asin();
        4.0 * n * (seen - expected).powi(2)
    };
    let chi: f64 = pairs.iter().map(term).sum();
    let n: u64 = pairs.iter().map(Compared::n).sum();
    let df = ((k - 1) * (k - 2) / 2) as f64;
    let why = "a test of fit";
    let n = vec![usize::try_from(n).unwrap_or(usize::MAX)];
    let statistic = (Named::of("χ²", chi), df);
    by_chi_squared(
        "Mosteller, fit of Case V",
        n,
        statistic,
        undefined(why),
        why,
    )
}
