//! Where a staircase stays in the long run, exactly: the stationary distribution of its Markov
//! chain over stimulus, answers in a row and direction.

use crate::adaptive::Rule;
use crate::{Computed, undefined};

/// The long run of a staircase of whole steps on an even scale.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stationary {
    /// The share of trials at each place, weakest first.
    pub(super) shares: Vec<f64>,
    /// Mean place of a trial, counted from 0.
    pub(super) mean_place: f64,
    /// Mean place of a reversal, counted from 0.
    pub(super) mean_reversal_place: f64,
    /// The share of right answers.
    pub(super) share_right: f64,
    /// Reversals a trial.
    pub(super) reversals_per_trial: f64,
}

/// States more than this are too many to solve for.
const MOST_STATES: usize = 20_000;

/// The long run with steps of `up` and `down` places between the first and the last of
/// `p_right.len()` places; `p_right` is the probability to be right at each.
///
/// # Errors
/// No rule, steps of nothing, fewer than two places or too many, probabilities outside 0…1, a
/// chain that is not one (some places are never left for others).
pub(super) fn stationary(
    rule: Rule,
    [up, down]: [usize; 2],
    p_right: &[f64],
) -> Computed<Stationary> {
    rule.check()?;
    let chain = Chain {
        rule,
        up,
        down,
        n_places: p_right.len(),
    };
    let n = chain.n_states();
    if up == 0 || down == 0 || p_right.len() < 2 || n > MOST_STATES {
        let places = p_right.len();
        let reason = format!("steps of {up} up and {down} down over {places} places");
        return undefined(reason);
    }
    if let Some(p) = p_right.iter().find(|p| !(0.0..=1.0).contains(*p)) {
        return undefined(format!("a probability of {p}"));
    }
    Ok(chain.read(&chain.long_run(p_right)?, p_right))
}

/// Transitions between states that lie no farther apart than `half`.
struct Band {
    n: usize,
    half: usize,
    cells: Vec<f64>,
}

impl Band {
    fn new(n: usize, half: usize) -> Self {
        let cells = vec![0.0; n * (2 * half + 1)];
        Self { n, half, cells }
    }

    fn at(&mut self, from: usize, to: usize) -> &mut f64 {
        &mut self.cells[from * (2 * self.half + 1) + to + self.half - from]
    }

    /// The stationary distribution by taking out one state after another, without a subtraction
    /// (Grassmann, Taksar & Heyman 1985).
    fn long_run(mut self) -> Computed<Vec<f64>> {
        let mut leaving = vec![0.0; self.n];
        for last in (1..self.n).rev() {
            let first = last.saturating_sub(self.half);
            let away: f64 = (first..last).map(|to| *self.at(last, to)).sum();
            if away <= 0.0 {
                let reason = "the staircase has no single long run: some places never lead back";
                return undefined(reason);
            }
            leaving[last] = away;
            for from in first..last {
                let share = *self.at(from, last) / away;
                if share > 0.0 {
                    for to in first..last {
                        *self.at(from, to) += share * *self.at(last, to);
                    }
                }
            }
        }
        let mut shares = vec![1.0; self.n];
        for last in 1..self.n {
            let into = (last.saturating_sub(self.half)..last).map(|from| {
                let share = *self.at(from, last);
                shares[from] * share
            });
            shares[last] = into.sum::<f64>() / leaving[last];
            // Relative to a first state that is hardly ever seen they would overflow.
            if shares[last] > 1e100 {
                let scale = shares[last].recip();
                shares[..=last].iter_mut().for_each(|share| *share *= scale);
            }
        }
        let sum: f64 = shares.iter().sum();
        for share in &mut shares {
            *share /= sum;
        }
        Ok(shares)
    }
}

/// The chain: a state is a place, a run of answers and the direction of the last move.
struct Chain {
    rule: Rule,
    up: usize,
    down: usize,
    n_places: usize,
}

/// Where an answer leads.
struct Move {
    to: usize,
    is_reversal: bool,
}

impl Chain {
    /// Runs: none, 1…m−1 right, 1…n−1 wrong.
    fn n_runs(&self) -> usize {
        (self.rule.m_down + self.rule.n_up - 1) as usize
    }

    fn n_states(&self) -> usize {
        2 * self.n_places * self.n_runs()
    }

    fn long_run(&self, p_right: &[f64]) -> Computed<Vec<f64>> {
        let half = 2 * self.n_runs() * (self.up.max(self.down) + 1);
        let n = self.n_states();
        let mut band = Band::new(n, half.min(n - 1));
        for state in 0..n {
            for (is_right, p) in self.answers(state, p_right) {
                *band.at(state, self.after(state, is_right).to) += p;
            }
        }
        band.long_run()
    }

    fn place(&self, state: usize) -> usize {
        state / (2 * self.n_runs())
    }

    fn answers(&self, state: usize, p_right: &[f64]) -> [(bool, f64); 2] {
        let p = p_right[self.place(state)];
        [(true, p), (false, 1.0 - p)]
    }

    fn after(&self, state: usize, is_right: bool) -> Move {
        let (n_runs, m) = (self.n_runs(), self.rule.m_down as usize);
        let (place, went_up) = (self.place(state), state % 2);
        let run = state / 2 % n_runs;
        // Runs of wrong answers follow those of right ones.
        let (right, wrong) = if run < m { (run, 0) } else { (0, run - m + 1) };
        let (right, wrong) = if is_right {
            (right + 1, 0)
        } else {
            (0, wrong + 1)
        };
        // The first state, down to the first place, is one that every other leads to.
        let state = |place: usize, run: usize, went_up: usize| (place * n_runs + run) * 2 + went_up;
        if right == m {
            let to = state(place.saturating_sub(self.down), 0, 0);
            Move {
                to,
                is_reversal: went_up == 1,
            }
        } else if wrong == self.rule.n_up as usize {
            let to = state((place + self.up).min(self.n_places - 1), 0, 1);
            Move {
                to,
                is_reversal: went_up == 0,
            }
        } else {
            let run = if is_right { right } else { m + wrong - 1 };
            Move {
                to: state(place, run, went_up),
                is_reversal: false,
            }
        }
    }

    fn read(&self, pi: &[f64], p_right: &[f64]) -> Stationary {
        let mut shares = vec![0.0; self.n_places];
        let (mut share_right, mut reversals, mut reversal_places) = (0.0, 0.0, 0.0);
        for (state, share) in pi.iter().enumerate() {
            let place = self.place(state);
            shares[place] += share;
            share_right += share * p_right[place];
            for (is_right, p) in self.answers(state, p_right) {
                if self.after(state, is_right).is_reversal {
                    reversals += share * p;
                    reversal_places += share * p * place as f64;
                }
            }
        }
        let mean_place = shares.iter().enumerate().map(|(i, s)| i as f64 * s).sum();
        Stationary {
            shares,
            mean_place,
            mean_reversal_place: reversal_places / reversals,
            share_right,
            reversals_per_trial: reversals,
        }
    }
}
