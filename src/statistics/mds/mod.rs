//! Maps from dissimilarities: non-metric multidimensional scaling (Kruskal 1964; de Leeuw 1977).
//!
//! Points whose distances rise as the dissimilarities do. [`Mds::maps`] follows many starts
//! downhill, keeps the best and lays it down one way; [`Null`] says what data without structure
//! would give, [`Elbow`] how many dimensions are worth it.

mod bootstrap;
mod descend;
mod dissimilarities;
mod elbow;
mod fit;
mod map;
mod monotone;
mod null;
mod search;
mod start;
#[cfg(test)]
mod tests;

pub use bootstrap::Resampled;
pub use dissimilarities::{Dissimilarities, Pair};
pub use elbow::Elbow;
pub use fit::Loss;
pub use map::{Map, ShepardPoint};
pub use monotone::Ties;
pub use null::{Null, NullKind};
pub use search::Descent;

use std::ops::RangeInclusive;

use fit::Problem;
use search::{Plan, search, work};
use selvedge_foundation::progress::{Cancelled, Progress};

/// How maps are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mds {
    /// What ties ask for.
    pub ties: Ties,
    /// What is made small.
    pub loss: Loss,
    /// How starts are followed.
    pub descent: Descent,
    /// Starts in two dimensions and more.
    pub n_starts: usize,
    /// Starts on a line.
    pub n_starts_on_a_line: usize,
    /// The best orders on a line that are improved by exchange besides; most of the work there.
    pub n_exchanged: usize,
    /// What chance begins with.
    pub seed: u64,
    /// Threads that share the work; the maps do not depend on it.
    pub n_threads: usize,
}

impl Default for Mds {
    fn default() -> Self {
        Self {
            ties: Ties::default(),
            loss: Loss::default(),
            descent: Descent::default(),
            n_starts: Self::DEFAULT_STARTS,
            n_starts_on_a_line: Self::LEAST_STARTS_ON_A_LINE,
            n_exchanged: 6,
            seed: 1,
            n_threads: selvedge_foundation::numerics::n_threads(),
        }
    }
}

impl Mds {
    /// The most dimensions of a map.
    pub const MOST_DIMENSIONS: usize = 5;
    /// Starts in two dimensions and more, when nobody says how many.
    pub const DEFAULT_STARTS: usize = 50;
    /// Fewest starts on a line, where hardly one in a hundred reaches the best order.
    pub const LEAST_STARTS_ON_A_LINE: usize = 1000;

    /// The best map in each number of dimensions, 1 … [`Self::MOST_DIMENSIONS`]; others are left
    /// out.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn maps(
        &self,
        data: &Dissimilarities,
        dims: RangeInclusive<usize>,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Map>, Cancelled> {
        let problem = Problem::new(data, self.ties);
        let mut maps: Vec<Map> = Vec::new();
        let dims: Vec<usize> = dims
            .filter(|k| (1..=Self::MOST_DIMENSIONS).contains(k))
            .collect();
        let total: f64 = dims.iter().map(|k| self.work(data, *k)).sum();
        let mut done = 0.0;
        for k in dims {
            let lower = maps.last().map(|map| map.points.concat());
            let plan = Plan { k, mds: *self };
            let share = self.work(data, k) / total;
            let found = progress.within([done, done + share], |progress| {
                search(&problem, &plan, lower.as_deref(), progress)
            })?;
            done += share;
            maps.push(Map::of(&problem, self.loss, k, &found));
        }
        Ok(maps)
    }

    /// How much a map in so many dimensions takes, in starts of as many objects on a line: what
    /// progress is told by.
    pub fn work(&self, data: &Dissimilarities, k: usize) -> f64 {
        let [starts, exchanged] = work(self, data.n_objects(), k);
        starts + exchanged
    }

    /// Starts that are followed in so many dimensions.
    fn starts_in(&self, k: usize) -> usize {
        match (self.descent, k) {
            (Descent::None, _) => 1,
            (_, 1) => self.n_starts_on_a_line,
            _ => self.n_starts,
        }
    }
}
