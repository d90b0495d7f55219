//! The whole posterior on a grid, and the intervals that it gives.

use super::target::{Point, Target, point};
use super::{Fit, Psychometric};
use crate::{Computed, Interval, undefined};

/// Cells along threshold, width and lapse rate.
const CELLS: [usize; 3] = [40, 32, 9];
/// Likewise while the grid closes in.
const COARSE: [usize; 3] = [24, 24, 5];
/// A row of cells with less than this share of the largest row is left out.
const LEAST: f64 = 1e-5;

/// The posterior on a grid that holds all but a ten-thousandth of it.
#[derive(Debug, Clone)]
pub struct Posterior {
    /// Functions and their probabilities, 1 together.
    pub(super) cells: Vec<(Psychometric, f64)>,
}

/// An even grid: the first ends, and how many cells between.
#[derive(Debug, Clone, Copy)]
struct Grid {
    ends: [[f64; 2]; 3],
    counts: [usize; 3],
}

impl Grid {
    fn along(&self, axis: usize, i: usize) -> f64 {
        let [low, high] = self.ends[axis];
        low + (high - low) * (i as f64 + 0.5) / self.counts[axis] as f64
    }

    /// Masses of all cells, 1 together, the lapse rate innermost.
    fn masses(&self, target: &Target<'_>) -> Vec<f64> {
        let mut masses = Vec::with_capacity(self.counts.iter().product());
        let mut shares = Vec::with_capacity(target.blocks.len());
        for i in 0..self.counts[0] {
            for j in 0..self.counts[1] {
                let place = [self.along(0, i), self.along(1, j)];
                shares.clear();
                shares.extend(target.shares(place));
                // Cells are even in the logarithm of the width, the prior in the width.
                let ln_prior = target.priors.ln_prior(place[0], place[1].exp()) + place[1];
                for k in 0..self.counts[2] {
                    let lapse = self.along(2, k);
                    let ln_likelihood = target.ln_likelihood_of(shares.iter().copied(), lapse);
                    masses.push(ln_prior + ln_likelihood);
                }
            }
        }
        let most = masses.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for mass in &mut masses {
            *mass = (*mass - most).exp();
        }
        let sum: f64 = masses.iter().sum();
        for mass in &mut masses {
            *mass /= sum;
        }
        masses
    }

    fn marginal(&self, masses: &[f64], axis: usize) -> Vec<f64> {
        let inner: usize = self.counts[axis + 1..].iter().product();
        let mut sums = vec![0.0; self.counts[axis]];
        for (cell, mass) in masses.iter().enumerate() {
            sums[cell / inner % self.counts[axis]] += mass;
        }
        sums
    }

    /// The ends of what matters, with a cell to spare and the mode inside.
    fn closer(&self, masses: &[f64], mode: Point) -> [[f64; 2]; 3] {
        let mut ends = self.ends;
        for axis in 0..2 {
            let sums = self.marginal(masses, axis);
            let least = LEAST * sums.iter().copied().fold(0.0, f64::max);
            let first = sums.iter().position(|&s| s > least).unwrap_or(0);
            let last = sums.iter().rposition(|&s| s > least).unwrap_or(0);
            let [low, high] = self.ends[axis];
            let cell = (high - low) / self.counts[axis] as f64;
            let from = low + cell * (first as f64 - 1.0);
            let to = low + cell * (last as f64 + 2.0);
            ends[axis] = [
                from.min(mode[axis] - cell).max(low),
                to.max(mode[axis] + cell).min(high),
            ];
        }
        ends
    }
}

impl Fit {
    /// The posterior on a grid.
    pub fn posterior(&self) -> Posterior {
        let (target, mode) = (self.target(), point(&self.curve));
        let (most, is_fixed) = self.model.lapses();
        let lapses = if is_fixed { [most, most] } else { [0.0, most] };
        let n_lapses = |n: usize| if is_fixed { 1 } else { n };
        let mut grid = Grid {
            ends: [
                self.priors.threshold_support(),
                self.priors.width_support().map(f64::ln),
                lapses,
            ],
            counts: [COARSE[0], COARSE[1], n_lapses(COARSE[2])],
        };
        for _ in 0..2 {
            grid.ends = grid.closer(&grid.masses(&target), mode);
        }
        grid.counts = [CELLS[0], CELLS[1], n_lapses(CELLS[2])];
        let masses = grid.masses(&target);
        let [_, n_widths, n_lapses] = grid.counts;
        let curve = |cell: usize| {
            let (i, j, k) = (
                cell / n_lapses / n_widths,
                cell / n_lapses % n_widths,
                cell % n_lapses,
            );
            target.curve([grid.along(0, i), grid.along(1, j), grid.along(2, k)])
        };
        Posterior {
            cells: masses
                .iter()
                .enumerate()
                .map(|(cell, &m)| (curve(cell), m))
                .collect(),
        }
    }
}

impl Posterior {
    /// The central interval of a quantity of the function: as much probability below as above.
    ///
    /// # Errors
    /// A level outside (0, 1), a quantity that some likely function does not have.
    pub fn interval(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
        level: f64,
    ) -> Computed<Interval> {
        if !(level > 0.0 && level < 1.0) {
            return undefined(format!("a confidence of {level}"));
        }
        let mut values = Vec::with_capacity(self.cells.len());
        for (curve, mass) in self.cells.iter().filter(|(_, mass)| *mass > 1e-12) {
            values.push((quantity(curve)?, *mass));
        }
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let tail = 0.5 * (1.0 - level);
        let [low, high] = [tail, 1.0 - tail].map(|share| quantile(&values, share));
        Ok(Interval { low, high, level })
    }
}

/// The value below which so much of the sorted, weighted values lies, each spread evenly between
/// the middles of its neighbours.
fn quantile(values: &[(f64, f64)], share: f64) -> f64 {
    let mut below = 0.0;
    let (mut last, mut last_at) = (values[0].0, 0.0);
    for &(value, mass) in values {
        let at = below + 0.5 * mass;
        if at >= share {
            let part = if at > last_at {
                (share - last_at) / (at - last_at)
            } else {
                1.0
            };
            return last + part.clamp(0.0, 1.0) * (value - last);
        }
        below += mass;
        (last, last_at) = (value, at);
    }
    last
}
