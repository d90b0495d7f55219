//! Choices that the logs leave open.

use super::random_data::RandomData;
use selvedge_statistics::Resampling;
use selvedge_textile::BuildCache;

/// Choices that the logs leave open.
#[derive(Debug, Clone)]
pub struct Options {
    /// What chance begins with.
    pub seed: u64,
    /// Resamples of subjects for intervals, at least 100.
    pub n_resamples: usize,
    /// Permutations for p values.
    pub n_permutations: usize,
    /// Maps of resampled subjects, from which ellipses follow; 0 for none.
    pub n_maps: usize,
    /// Starts of a map in two dimensions and more.
    pub n_starts: usize,
    /// Starts of a map on a line.
    pub n_starts_on_a_line: usize,
    /// Sets of random ranks to compare the stress of maps with; 0 for none.
    pub n_random_data: usize,
    /// What was found of them before.
    pub random_data: RandomData,
    /// Where textiles that are built from recipes are kept.
    pub cache: Option<BuildCache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            n_resamples: 2000,
            n_permutations: 4999,
            n_maps: 100,
            n_starts: 50,
            n_starts_on_a_line: 1000,
            n_random_data: 40,
            random_data: RandomData::default(),
            cache: None,
        }
    }
}

impl Options {
    pub(super) fn resampling(&self) -> Resampling {
        Resampling {
            n_resamples: self.n_resamples.max(100),
            seed: self.seed,
            level: 0.95,
        }
    }
}
