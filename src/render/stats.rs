//! Figures of a run: cost of a tick, work left out, error against the reference.
//!
//! Plain numbers that serialise with their units in their names; nothing here measures time.

use serde::Serialize;

use super::Counters;
use super::array::{ErrorBound, Method};
use selvedge_foundation::numerics::to_index;

/// Cells a decade: a quantile is at most 0.9 % too large.
const CELLS_PER_DECADE: f64 = 256.0;
/// The smallest value that is told from 0.
const LEAST: f64 = 1e-9;
/// Decades from the smallest value on.
const DECADES: usize = 20;

/// A histogram of non-negative numbers with cells of equal ratio: bounded memory, and quantiles
/// within 0.9 %, however many numbers.
#[derive(Debug, Clone)]
pub struct Histogram {
    counts: Vec<u64>,
    n: u64,
    largest: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self {
            counts: vec![0; 256 * DECADES + 1],
            n: 0,
            largest: 0.0,
        }
    }
}

impl Histogram {
    /// Adds a number. NaN counts as infinite, a negative one as 0.
    pub fn add(&mut self, value: f64) {
        let value = if value.is_nan() {
            f64::INFINITY
        } else {
            value.max(0.0)
        };
        let cell = cell_of(value).min(self.counts.len() - 1);
        self.counts[cell] += 1;
        self.n += 1;
        self.largest = self.largest.max(value);
    }

    /// Adds all numbers of another histogram.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.counts.iter_mut().zip(&other.counts) {
            *count += more;
        }
        self.n += other.n;
        self.largest = self.largest.max(other.largest);
    }

    /// How many numbers lie between one edge and the next, the upper edge included; those below the
    /// first edge count with the first pair, those above the last with the last. Edges that are not
    /// those of cells are off by up to 0.9 %.
    pub fn between(&self, edges: &[f64]) -> Vec<u64> {
        let mut found = vec![0; edges.len().saturating_sub(1)];
        let Some(last) = found.len().checked_sub(1) else {
            return found;
        };
        for (cell, count) in self.counts.iter().enumerate().filter(|(_, n)| **n > 0) {
            let above = edges.partition_point(|edge| *edge < upper_edge(cell) * (1.0 - 1e-9));
            found[above.saturating_sub(1).min(last)] += count;
        }
        found
    }

    /// How many numbers were added.
    pub fn count(&self) -> u64 {
        self.n
    }

    /// The largest number; 0 of none.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// A number that at least the share `q` (0…1) of all do not exceed, at most 0.9 % above the
    /// smallest such number; 0 of none.
    pub fn quantile(&self, q: f64) -> f64 {
        let wanted = (self.n as f64 * q.clamp(0.0, 1.0)).ceil().max(1.0);
        let mut below = 0_u64;
        for (cell, count) in self.counts.iter().enumerate() {
            below += count;
            if below as f64 >= wanted {
                return upper_edge(cell).min(self.largest);
            }
        }
        self.largest
    }
}

fn cell_of(value: f64) -> usize {
    to_index((CELLS_PER_DECADE * (value / LEAST).log10()).ceil())
}

fn upper_edge(cell: usize) -> f64 {
    if cell == 0 {
        0.0
    } else {
        LEAST * 10.0_f64.powf(cell as f64 / CELLS_PER_DECADE)
    }
}

/// Error of a run against `reference` on the very same poses.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct LevelError {
    /// Largest `|20 log₁₀(a/a_ref)|` where `a_ref` is at least a thousandth of its band's largest
    /// in the run, dB.
    pub max_db: f64,
    /// 99th percentile of the same, dB.
    pub p99_db: f64,
    /// How many amplitudes that was taken over.
    pub n_amplitudes: u64,
    /// Largest `|a − a_ref|` of all others, as a share of their band's largest.
    pub max_share_below: f64,
}

/// What a replayed run cost, left out and got wrong.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RunStats {
    /// The method asked for.
    pub method: Method,
    /// The method that rendered: what `auto` chose.
    pub method_used: Method,
    /// The error it promised before the first tick.
    pub bound: ErrorBound,
    /// Contactors of all displays.
    pub n_contactors: usize,
    /// Preparing the renderer, ns.
    pub(crate) prepare_ns: u64,
    /// Time a tick, median, ns.
    pub tick_median_ns: f64,
    /// Time a tick, 99th percentile, ns.
    pub tick_p99_ns: f64,
    /// Time of the slowest tick, ns.
    pub(crate) tick_max_ns: f64,
    /// What was evaluated and left out.
    pub counters: Counters,
    /// T of the bound, the largest of the textiles that were felt, µm before gains: from T/1000 on
    /// the bound is one of level; if errors were measured.
    pub unfiltered_um: Option<f64>,
    /// The largest error as a share of what the bound allows, if it was measured: at most 1.
    pub bound_share: Option<f64>,
    /// The error found, if it was measured.
    pub level_error: Option<LevelError>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_within_a_cell() {
        let mut histogram = Histogram::default();
        (1..=1000).for_each(|i| histogram.add(f64::from(i) * 0.5));
        for (q, exact) in [(0.5, 250.0), (0.99, 495.0), (1.0, 500.0)] {
            let found = histogram.quantile(q);
            assert!((1.0..=1.009).contains(&(found / exact)), "{q}: {found}");
        }
        assert_eq!(Histogram::default().quantile(0.5), 0.0);
        histogram.add(f64::NAN);
        assert_eq!(histogram.largest(), f64::INFINITY);
    }

    #[test]
    fn numbers_are_counted_between_edges_and_histograms_add_up() {
        let mut histogram = Histogram::default();
        let numbers = [0.0, 1e-4, 0.02, 0.03, 5.0, f64::INFINITY];
        for x in numbers {
            histogram.add(x);
        }
        let edges = [1e-3, 1e-2, 0.1, 1.0];
        assert_eq!(histogram.between(&edges), [2, 2, 2]);
        let mut both = histogram.clone();
        both.merge(&histogram);
        assert_eq!(both.between(&edges), [4, 4, 4]);
        assert_eq!((both.count(), both.largest()), (12, f64::INFINITY));
        assert!(histogram.between(&[1.0]).is_empty(), "no pair of edges");
    }
}
