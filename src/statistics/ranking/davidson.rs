//! Paired comparisons with ties by Davidson's model (1970): preferred, tied and not preferred have
//! probabilities as πᵢ : ν√(πᵢπⱼ) : πⱼ.

use nalgebra::{DMatrix, DVector};

use super::choices::{Choices, Prior};
use super::connection::number;
use super::deviance::{Deviance, deviance_of};
use super::newton::{LogLikelihood, maximise};
use super::preferences::{Compared, Preferences, span_of_pairs};
use super::scale::{Estimate, Scale};
use crate::{Computed, Undefined};

/// Abilities of items from paired comparisons with ties.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Davidson {
    /// Abilities in logits of preferred against not preferred, ln π, summing to zero, with errors
    /// from the observed information.
    pub scale: Scale,
    /// ln ν. Two equal items tie with probability ν/(2 + ν).
    pub(crate) log_nu: Estimate,
    /// Log-likelihood of the comparisons, without the prior's share and the multinomial
    /// coefficients.
    pub(crate) log_likelihood: f64,
    /// Against two free probabilities for each pair, and against equal items that tie as often as
    /// all did.
    pub deviance: Deviance,
    /// Steps of Newton's method.
    pub n_steps: usize,
    /// What was known before of the abilities; of ν nothing.
    pub prior: Prior,
}

/// The most likely abilities and ν, by Newton's method to 1e-10.
///
/// # Errors
/// Fewer than two items, no comparisons; no ties (ν would be 0: that is
/// [`bradley_terry`](super::bradley_terry())); ties so many that ν would be infinite; groups of
/// items without finite abilities, unless there is a prior.
pub(crate) fn davidson(preferences: &Preferences, prior: Prior) -> Computed<Davidson> {
    check(preferences, prior)?;
    let n_items = preferences.n_items();
    let model = Model {
        n_items,
        pairs: preferences.compared(),
        prior: prior.choices(n_items)?,
    };
    let peak = maximise(&model, vec![0.0; n_items + 1])?;
    let residual = |pair: &Compared| deviance_of(counts(pair), shares(pair, &peak.at));
    let tied = preferences.n_ties() as f64 / preferences.n_comparisons() as f64;
    let preferred = 0.5 * (1.0 - tied);
    let null = |pair: &Compared| deviance_of(counts(pair), [preferred, preferred, tied]);
    let n_free = 2 * model.pairs.len();
    Ok(Davidson {
        scale: Scale::of(&peak.at[..n_items], &peak.covariance),
        log_nu: Estimate {
            value: peak.at[n_items],
            se: peak.covariance[(n_items, n_items)].sqrt(),
        },
        log_likelihood: model.value_of_pairs(&peak.at),
        deviance: Deviance {
            n_comparisons: preferences.n_comparisons(),
            residual: model.pairs.iter().map(residual).sum(),
            df: n_free.saturating_sub(n_items),
            null: model.pairs.iter().map(null).sum(),
            null_df: n_free - 1,
            prior,
        },
        n_steps: peak.n_steps,
        prior,
    })
}

/// Refuses counts whose peak is nowhere finite: a direction in which every outcome seen becomes no
/// less likely leads from each point to infinity (Albert & Anderson 1984).
fn check(preferences: &Preferences, prior: Prior) -> Computed<()> {
    preferences.check()?;
    let (n, n_ties) = (preferences.n_comparisons(), preferences.n_ties());
    if n_ties == 0 {
        let reason = "no comparison is a tie: ν is 0, and the model is Bradley and Terry's";
        return Err(Undefined::because(reason));
    }
    if n_ties == n {
        let reason = format!("all {n} comparisons are ties: nothing was preferred");
        return Err(Undefined::because(reason));
    }
    if !prior.is_none() {
        return Ok(());
    }
    preferences.connection_with_ties().check(number)?;
    if is_steppable(preferences) {
        let reason = "items lie on steps, tied on one or between two and preferred above: ν and \
                      the distance of the steps are infinite without a prior";
        return Err(Undefined::because(reason));
    }
    Ok(())
}

/// Whether items have heights such that each lies at least 1 above those it was preferred to and
/// at most 1 from those it tied with: whether no circle of these conditions is shorter than
/// nothing (Bellman 1958). Then heights and ν grow together without end.
fn is_steppable(preferences: &Preferences) -> bool {
    let n_items = preferences.n_items();
    let mut heights = vec![0_i64; n_items];
    for _ in 0..=n_items {
        let mut has_moved = false;
        for (i, j) in (0..n_items).flat_map(|i| (0..n_items).map(move |j| (i, j))) {
            let above = if preferences.wins(i, j) > 0 {
                -1
            } else if preferences.ties(i, j) > 0 {
                1
            } else {
                continue;
            };
            if heights[j] > heights[i] + above {
                heights[j] = heights[i] + above;
                has_moved = true;
            }
        }
        if !has_moved {
            return true;
        }
    }
    false
}

struct Model {
    n_items: usize,
    pairs: Vec<Compared>,
    prior: Choices,
}

impl Model {
    fn value_of_pairs(&self, x: &[f64]) -> f64 {
        let value = |pair: &Compared| {
            let terms = counts(pair).into_iter().zip(shares(pair, x));
            let term = |(count, share): (u64, f64)| match count {
                0 => 0.0,
                count => count as f64 * share.ln(),
            };
            terms.map(term).sum::<f64>()
        };
        self.pairs.iter().map(value).sum()
    }
}

impl LogLikelihood for Model {
    fn n_items(&self) -> usize {
        self.n_items
    }

    fn value(&self, x: &[f64]) -> f64 {
        self.value_of_pairs(x) + self.prior.value(&x[..self.n_items])
    }

    fn slopes(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let nu = self.n_items;
        let (of_prior, bends_of_prior) = self.prior.slopes(&x[..nu]);
        let mut slopes = of_prior.resize_vertically(nu + 1, 0.0);
        let mut information = bends_of_prior.resize(nu + 1, nu + 1, 0.0);
        for pair in &self.pairs {
            let n = pair.n() as f64;
            let [upper, lower, tied] = shares(pair, x);
            let lead = upper - lower;
            let wins = pair.wins.map(|w| w as f64);
            let slope = 0.5 * (wins[0] - wins[1] - n * lead);
            let bend = 0.25 * n * (upper + lower - lead * lead);
            let cross = -0.5 * n * tied * lead;
            let signed = [(pair.items[0], 1.0), (pair.items[1], -1.0)];
            for (i, sign) in signed {
                slopes[i] += sign * slope;
                information[(i, nu)] += sign * cross;
                information[(nu, i)] += sign * cross;
                for (j, other) in signed {
                    information[(i, j)] += sign * other * bend;
                }
            }
            slopes[nu] += pair.ties as f64 - n * tied;
            information[(nu, nu)] += n * tied * (1.0 - tied);
        }
        (slopes, information)
    }

    fn span(&self, step: &[f64]) -> f64 {
        let of_nu = step[self.n_items].abs();
        span_of_pairs(&self.pairs, step)
            .max(self.prior.span(step))
            .max(of_nu)
    }
}

fn counts(pair: &Compared) -> [u64; 3] {
    [pair.wins[0], pair.wins[1], pair.ties]
}

/// Probabilities that the first is preferred, the second, neither.
fn shares(pair: &Compared, x: &[f64]) -> [f64; 3] {
    let half = 0.5 * (x[pair.items[0]] - x[pair.items[1]]);
    let logs = [half, -half, x.last().copied().unwrap_or_default()];
    let top = logs.iter().fold(f64::NEG_INFINITY, |top, l| top.max(*l));
    let weights = logs.map(|l| (l - top).exp());
    let sum: f64 = weights.iter().sum();
    weights.map(|w| w / sum)
}
