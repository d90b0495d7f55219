//! The parametric bootstrap: answers drawn from the fitted function and fitted again, for
//! intervals and for the goodness of fit (Wichmann & Hill 2001).

use super::answers::Block;
use super::target::deviance;
use super::{Fit, Psychometric};
use crate::summary::deviation;
use crate::{Computed, Interval, Resampling, undefined};
use selvedge_foundation::numerics::{Random, quantile};

/// Functions fitted to simulated answers at the same stimuli.
///
/// Stimuli are held as they were: of an adaptive procedure that is an approximation.
#[derive(Debug, Clone, PartialEq)]
pub struct Resamples {
    /// The functions.
    pub curves: Vec<Psychometric>,
    /// How well each fits the answers that it was fitted to.
    pub(crate) deviances: Vec<f64>,
    /// Simulations that said nothing of a threshold.
    pub n_undefined: usize,
    /// Confidence of the intervals.
    pub level: f64,
    deviance: f64,
}

impl Fit {
    /// Simulates the experiment.
    ///
    /// # Errors
    /// Fewer than 100 resamples, a level outside (0, 1), more than half of the resamples without
    /// a threshold.
    pub fn resample(&self, how: Resampling) -> Computed<Resamples> {
        let Resampling {
            n_resamples,
            seed,
            level,
        } = how;
        if n_resamples < 100 || !(level > 0.0 && level < 1.0) {
            let reason = format!("{n_resamples} resamples at level {level} give no interval");
            return undefined(reason);
        }
        let mut random = Random::new(seed).branch("psychometric bootstrap");
        let (mut curves, mut deviances) = (Vec::new(), Vec::new());
        for _ in 0..n_resamples {
            let blocks = self.simulated(&mut random);
            if let Ok(curve) = self.again(&blocks) {
                deviances.push(deviance(&blocks, &curve));
                curves.push(curve);
            }
        }
        let n_undefined = n_resamples - curves.len();
        if 2 * n_undefined > n_resamples {
            let reason = format!("no threshold in {n_undefined} of {n_resamples} resamples");
            return undefined(reason);
        }
        Ok(Resamples {
            curves,
            deviances,
            n_undefined,
            level,
            deviance: self.deviance,
        })
    }

    fn simulated(&self, random: &mut Random) -> Vec<Block> {
        let answered = |block: &Block| {
            let p = self.curve.at(block.x);
            let n_right = (0..block.n).map(|_| u32::from(random.uniform() < p)).sum();
            Block { n_right, ..*block }
        };
        self.blocks.iter().map(answered).collect()
    }
}

impl Resamples {
    /// The probability of a deviance at least that of the fit, if the model holds.
    pub fn p_deviance(&self) -> f64 {
        let n_worse = self
            .deviances
            .iter()
            .filter(|&&d| d >= self.deviance)
            .count();
        (n_worse as f64 + 1.0) / (self.deviances.len() as f64 + 1.0)
    }

    /// Standard deviation and percentile interval of a quantity over the resamples.
    ///
    /// # Errors
    /// A quantity that one of the functions does not have.
    pub fn interval(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
    ) -> Computed<(f64, Interval)> {
        let mut values = self
            .curves
            .iter()
            .map(quantity)
            .collect::<Computed<Vec<_>>>()?;
        let se = deviation(&values);
        let tail = 0.5 * (1.0 - self.level);
        let interval = Interval {
            low: quantile(&mut values, tail),
            high: quantile(&mut values, 1.0 - tail),
            level: self.level,
        };
        Ok((se, interval))
    }
}
