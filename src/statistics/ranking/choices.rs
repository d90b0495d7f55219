//! Choices of one item among several by Luce's rule: the counts that both Plackett and Luce's model
//! of rankings and Bradley and Terry's of pairs come down to.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::connection::{Connection, number};
use super::newton::{LogLikelihood, Peak, maximise};
use crate::{Computed, undefined};

/// What is known of worths before anything was compared.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Prior {
    /// Nothing: the most likely worths of the data alone.
    #[default]
    None,
    /// Independent Gamma distributions of the worths with this strength, shape less 1, whatever
    /// their rate (Caron & Doucet 2012): as if every item had besides been chosen first among all
    /// so many times. Draws worths together and makes every estimate finite.
    Gamma(f64),
}

impl Prior {
    /// Whether there is none.
    pub fn is_none(self) -> bool {
        matches!(self, Self::None)
    }

    /// The choices that it stands for.
    pub(super) fn choices(self, n_items: usize) -> Computed<Choices> {
        let mut choices = Choices::new(n_items);
        match self {
            Self::None => {}
            Self::Gamma(strength) if strength > 0.0 && strength.is_finite() => {
                for item in 0..n_items {
                    choices.add(item, (0..n_items).collect(), strength);
                }
            }
            Self::Gamma(strength) => {
                return undefined(format!("a prior of strength {strength}: above 0 needed"));
            }
        }
        Ok(choices)
    }
}

/// How often each item was chosen, and among which sets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Choices {
    wins: Vec<f64>,
    sets: BTreeMap<Vec<usize>, f64>,
    is_above: Vec<bool>,
}

impl Choices {
    pub(super) fn new(n_items: usize) -> Self {
        Self {
            wins: vec![0.0; n_items],
            sets: BTreeMap::new(),
            is_above: vec![false; n_items * n_items],
        }
    }

    /// Adds an item chosen from a set with itself, rising, so many times.
    pub(super) fn add(&mut self, chosen: usize, among: Vec<usize>, times: f64) {
        self.wins[chosen] += times;
        for &other in among.iter().filter(|&&other| other != chosen) {
            self.is_above[chosen * self.wins.len() + other] = true;
        }
        *self.sets.entry(among).or_insert(0.0) += times;
    }

    /// Adds a ranking, best first: its first chosen among all, the next among the rest.
    pub(super) fn add_ranking(&mut self, ranking: &[usize]) {
        let mut rest = ranking.to_vec();
        rest.sort_unstable();
        for &chosen in &ranking[..ranking.len().saturating_sub(1)] {
            self.add(chosen, rest.clone(), 1.0);
            rest.retain(|&item| item != chosen);
        }
    }

    /// Adds all of another's choices.
    pub(super) fn merge(&mut self, other: &Self) {
        for (wins, others) in self.wins.iter_mut().zip(&other.wins) {
            *wins += others;
        }
        for (set, times) in &other.sets {
            *self.sets.entry(set.clone()).or_insert(0.0) += times;
        }
        for (is, others) in self.is_above.iter_mut().zip(&other.is_above) {
            *is |= others;
        }
    }

    /// Where the worths are most likely, with what a prior adds.
    ///
    /// # Errors
    /// Groups of items without finite worths; a search that does not settle.
    pub(super) fn peak(&self, prior: Prior) -> Computed<Peak> {
        let n_items = self.wins.len();
        let mut all = prior.choices(n_items)?;
        all.merge(self);
        all.connection().check(number)?;
        maximise(&all, vec![0.0; n_items])
    }

    /// How they hang together.
    fn connection(&self) -> Connection {
        let n = self.wins.len();
        Connection::of(n, |i, j| self.is_above[i * n + j])
    }

    /// The log-likelihood of all worths equal.
    pub(super) fn null_value(&self) -> f64 {
        let terms = self.sets.iter();
        terms.map(|(set, n)| -n * (set.len() as f64).ln()).sum()
    }
}

impl LogLikelihood for Choices {
    fn value(&self, x: &[f64]) -> f64 {
        let chosen: f64 = self.wins.iter().zip(x).map(|(w, x)| w * x).sum();
        let among = |(set, n): (&Vec<usize>, &f64)| {
            let top = set.iter().fold(f64::NEG_INFINITY, |top, &i| top.max(x[i]));
            let sum: f64 = set.iter().map(|&i| (x[i] - top).exp()).sum();
            n * (top + sum.ln())
        };
        chosen - self.sets.iter().map(among).sum::<f64>()
    }

    fn slopes(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let n_items = x.len();
        let mut slopes = self.wins.clone();
        // Row by row; the most of the work when there are many sets.
        let mut information = vec![0.0; n_items * n_items];
        for (set, n) in &self.sets {
            let shares = shares(x, set);
            for (&i, p) in set.iter().zip(&shares) {
                let row = &mut information[i * n_items..(i + 1) * n_items];
                let expected = n * p;
                slopes[i] -= expected;
                row[i] += expected;
                for (&j, q) in set.iter().zip(&shares) {
                    row[j] -= expected * q;
                }
            }
        }
        let information = DMatrix::from_vec(n_items, n_items, information);
        (DVector::from_vec(slopes), information)
    }

    fn span(&self, step: &[f64]) -> f64 {
        let of_set = |set: &Vec<usize>| {
            let steps = || set.iter().map(|&i| step[i]);
            steps().fold(f64::NEG_INFINITY, f64::max) - steps().fold(f64::INFINITY, f64::min)
        };
        self.sets.keys().map(of_set).fold(0.0, f64::max)
    }
}

/// The probability of each item of a set to be chosen, from the log-worths of all items.
pub(super) fn shares(log_worths: &[f64], set: &[usize]) -> Vec<f64> {
    let top = set
        .iter()
        .fold(f64::NEG_INFINITY, |top, &i| top.max(log_worths[i]));
    let worths: Vec<f64> = set.iter().map(|&i| (log_worths[i] - top).exp()).collect();
    let sum: f64 = worths.iter().sum();
    worths.iter().map(|worth| worth / sum).collect()
}
