//! QUEST+: the stimulus whose answer is expected to tell most (Watson 2017).
//!
//! The posterior stands on a grid of threshold, width and lapse rate. Its expected entropy after an
//! answer is its entropy now less what the answer tells, H(p̄) − mean H(p): two sums of products
//! over the grid a stimulus, from tables made once, and no logarithm in the loop.

use super::{Procedure, Reached, Stop, Trial, over};
use crate::psychometric::{Family, Guess, Psychometric, scaled};
use crate::{Computed, undefined};

/// Stimuli that tell this much more, in nats, than an earlier one are better than it; less is
/// rounding.
const TIE: f64 = 1e-12;
/// Sums that run side by side.
const LANES: usize = 8;
/// More cells than this are no table.
const MOST_CELLS: usize = 1 << 26;

/// What is possible: stimuli to choose from and functions to tell apart.
#[derive(Debug, Clone, PartialEq)]
pub struct QuestGrid {
    /// The shape.
    pub family: Family,
    /// Its lower end.
    pub guess: Guess,
    /// Stimuli, in the order in which ties are broken.
    pub stimuli: Vec<f64>,
    /// Thresholds, in the unit of the stimulus.
    pub thresholds: Vec<f64>,
    /// Widths from 5 % to 95 %, of Weibull in natural logarithms.
    pub widths: Vec<f64>,
    /// Lapse rates.
    pub lapses: Vec<f64>,
}

impl QuestGrid {
    fn n_functions(&self) -> usize {
        self.thresholds.len() * self.widths.len() * self.lapses.len()
    }

    /// The function of a number, lapse rates innermost.
    pub(super) fn curve(&self, function: usize) -> Psychometric {
        let (n_widths, n_lapses) = (self.widths.len(), self.lapses.len());
        let lapse = self.lapses[function % n_lapses];
        Psychometric {
            family: self.family,
            threshold: self.thresholds[function / n_lapses / n_widths],
            width: self.widths[function / n_lapses % n_widths],
            guess: self.guess.rate(lapse),
            lapse,
        }
    }

    fn check(&self) -> Computed<()> {
        let cells = self.stimuli.len().saturating_mul(self.n_functions());
        if cells == 0 || cells > MOST_CELLS {
            let lists = [&self.stimuli, &self.thresholds, &self.widths, &self.lapses];
            let counts = lists.map(|list| list.len().to_string()).join(" × ");
            return undefined(format!("a grid of {counts}"));
        }
        (0..self.n_functions()).try_for_each(|i| self.curve(i).checked().map(|_| ()))?;
        let is_placed = |x: &&f64| !self.family.place(**x).is_finite();
        match self.stimuli.iter().find(is_placed) {
            Some(x) => undefined(format!("a stimulus of {x} has no place")),
            None => Ok(()),
        }
    }

    /// p and 1 − p of every function at a stimulus, in order.
    fn each_probability(&self, stimulus: f64, mut take: impl FnMut([f64; 2])) {
        let place = self.family.place(stimulus);
        for threshold in &self.thresholds {
            let above = place - self.family.place(*threshold);
            for width in &self.widths {
                let shares = self.family.shares(above / width);
                for lapse in &self.lapses {
                    take(scaled(shares, self.guess.rate(*lapse), *lapse));
                }
            }
        }
    }
}

/// What the posterior says of one number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reckoned {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Its value in the most probable function.
    pub mode: f64,
}

/// The posterior after a trial.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuestSummary {
    /// Of the threshold.
    pub threshold: Reckoned,
    /// Of the width.
    pub width: Reckoned,
    /// Of the lapse rate.
    pub lapse: Reckoned,
}

/// A QUEST+ procedure as far as it came.
#[derive(Debug, Clone)]
pub struct QuestPlus {
    grid: QuestGrid,
    stop: Stop,
    /// Stimulus by stimulus, p of every function.
    probabilities: Vec<f64>,
    /// Likewise the entropy of its answer.
    entropies: Vec<f64>,
    ln_posterior: Vec<f64>,
    masses: Vec<f64>,
    best: usize,
    trials: Vec<Trial>,
    summary: QuestSummary,
}

impl QuestPlus {
    /// With every function of the grid as likely as another.
    ///
    /// # Errors
    /// An empty or enormous grid, functions that are none, stimuli without a place, a rule to stop
    /// that cannot come true.
    pub fn new(grid: QuestGrid, stop: Stop) -> Computed<Self> {
        grid.check()?;
        stop.check(&Reached {
            posterior_sd: Some(f64::MAX),
            ..Reached::default()
        })?;
        let n = grid.n_functions();
        let mut probabilities = Vec::with_capacity(n * grid.stimuli.len());
        for stimulus in &grid.stimuli {
            grid.each_probability(*stimulus, |[p, _]| probabilities.push(p));
        }
        let entropies = probabilities
            .iter()
            .map(|p| entropy_of([*p, 1.0 - p]))
            .collect();
        let mut quest = Self {
            stop,
            probabilities,
            entropies,
            ln_posterior: Vec::new(),
            masses: Vec::new(),
            best: 0,
            trials: Vec::new(),
            summary: QuestSummary::default(),
            grid,
        };
        quest.believe(vec![0.0; n])?;
        Ok(quest)
    }

    /// What is possible.
    pub fn grid(&self) -> &QuestGrid {
        &self.grid
    }

    /// The posterior now.
    pub fn summary(&self) -> QuestSummary {
        self.summary
    }

    /// How far it is.
    pub(crate) fn reached(&self) -> Reached {
        Reached {
            n_trials: u32::try_from(self.trials.len()).unwrap_or(u32::MAX),
            n_reversals: None,
            posterior_sd: Some(self.summary().threshold.sd),
        }
    }

    /// The information in nats that the answer to a stimulus is expected to give.
    fn information_of(&self, stimulus: usize) -> f64 {
        let n = self.masses.len();
        let row = stimulus * n..(stimulus + 1) * n;
        let p = product(&self.masses, &self.probabilities[row.clone()]);
        entropy_of([p, 1.0 - p]) - product(&self.masses, &self.entropies[row])
    }

    /// Takes an unnormalised logarithm of the posterior.
    fn believe(&mut self, mut ln_posterior: Vec<f64>) -> Computed<()> {
        let most = ln_posterior
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        if !most.is_finite() || ln_posterior.iter().any(|ln| ln.is_nan()) {
            let reason = "no function of the grid allows these answers: give it lapses and guesses";
            return undefined(reason);
        }
        let sum: f64 = ln_posterior.iter().map(|ln| (ln - most).exp()).sum();
        let total = most + sum.ln();
        for ln in &mut ln_posterior {
            *ln -= total;
        }
        self.masses.clear();
        self.masses.extend(ln_posterior.iter().map(|ln| ln.exp()));
        self.ln_posterior = ln_posterior;
        self.summary = self.summarised();
        let mut best = (0, f64::NEG_INFINITY);
        for i in 0..self.grid.stimuli.len() {
            let gain = self.information_of(i);
            if gain > best.1 + TIE {
                best = (i, gain);
            }
        }
        self.best = best.0;
        Ok(())
    }

    fn summarised(&self) -> QuestSummary {
        let start = (0, f64::NEG_INFINITY);
        let larger = |best: (usize, f64), (i, ln): (usize, &f64)| {
            if *ln > best.1 { (i, *ln) } else { best }
        };
        let (mode, _) = self.ln_posterior.iter().enumerate().fold(start, larger);
        let (n_widths, n_lapses) = (self.grid.widths.len(), self.grid.lapses.len());
        let reckoned = |values: &[f64], place: &dyn Fn(usize) -> usize| {
            let mut shares = vec![0.0; values.len()];
            for (i, mass) in self.masses.iter().enumerate() {
                shares[place(i)] += mass;
            }
            let of = |value: &dyn Fn(f64) -> f64| -> f64 {
                values.iter().zip(&shares).map(|(v, s)| s * value(*v)).sum()
            };
            let mean = of(&|v| v);
            Reckoned {
                mean,
                sd: of(&|v| (v - mean).powi(2)).sqrt(),
                mode: values[place(mode)],
            }
        };
        QuestSummary {
            threshold: reckoned(&self.grid.thresholds, &|i| i / n_lapses / n_widths),
            width: reckoned(&self.grid.widths, &|i| i / n_lapses % n_widths),
            lapse: reckoned(&self.grid.lapses, &|i| i % n_lapses),
        }
    }
}

impl Procedure for QuestPlus {
    fn stimulus(&self) -> Option<f64> {
        (!self.stop.is_met(&self.reached())).then(|| self.grid.stimuli[self.best])
    }

    /// Takes a stimulus that is none of the grid as well: its likelihood is computed as it is.
    fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()> {
        let asked = self.stimulus().ok_or_else(over)?;
        if !self.grid.family.place(presented).is_finite() {
            let reason = format!("a stimulus of {presented} has no place on the scale");
            return undefined(reason);
        }
        let mut ln_posterior = self.ln_posterior.clone();
        let mut each = ln_posterior.iter_mut();
        self.grid.each_probability(presented, |[p, q]| {
            if let Some(ln) = each.next() {
                *ln += if is_right { p } else { q }.ln();
            }
        });
        self.believe(ln_posterior)?;
        self.trials.push(Trial {
            asked,
            presented,
            is_right,
        });
        Ok(())
    }

    fn trials(&self) -> &[Trial] {
        &self.trials
    }
}

fn entropy_of(shares: [f64; 2]) -> f64 {
    let of = |p: f64| if p > 0.0 { -p * p.ln() } else { 0.0 };
    of(shares[0]) + of(shares[1])
}

/// Σ ab, several sums side by side.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    impl QuestPlus {
        /// The probability of every function, thresholds outermost and lapse rates innermost.
        pub(in crate::adaptive) fn masses(&self) -> &[f64] {
            &self.masses
        }

        /// The entropy of the posterior now, nats.
        pub(in crate::adaptive) fn entropy(&self) -> f64 {
            let both = self.masses.iter().zip(&self.ln_posterior);
            both.map(|(m, ln)| if *m > 0.0 { -m * ln } else { 0.0 })
                .sum()
        }

        /// The entropy that is to be expected after a trial with each stimulus, nats.
        pub(in crate::adaptive) fn expected_entropies(&self) -> Vec<f64> {
            (0..self.grid.stimuli.len())
                .map(|i| self.entropy() - self.information_of(i))
                .collect()
        }
    }
}
