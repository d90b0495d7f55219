//! What can be typed and chosen of an analysis.

use std::path::PathBuf;

use crate::bench::settings::build_cache;
use selvedge_experiment::analysis::Options;

/// Sets of random ranks where they are asked for.
const N_RANDOM_DATA: usize = 100;

/// How much chance is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Effort {
    /// Little: for a look.
    Quick,
    /// As much as reports have.
    #[default]
    Full,
}

/// What is chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Choice {
    /// How much chance is drawn on.
    pub effort: Effort,
    /// Whether the stress of maps is compared with that of random ranks.
    pub(crate) has_random_data: bool,
    /// Whether who takes part in an active session counts too.
    pub(crate) with_active: bool,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            effort: Effort::default(),
            has_random_data: Options::default().n_random_data > 0,
            with_active: false,
        }
    }
}

/// What is typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fields {
    /// The folder of the logs.
    pub folder: String,
    /// What chance begins with.
    pub seed: String,
}

impl Default for Fields {
    fn default() -> Self {
        Self {
            folder: String::new(),
            seed: Options::default().seed.to_string(),
        }
    }
}

impl Fields {
    /// The folder of the logs, if one is typed.
    pub(crate) fn folder(&self) -> Option<PathBuf> {
        let folder = self.folder.trim();
        (!folder.is_empty()).then(|| PathBuf::from(folder))
    }

    /// The seed, if it is one.
    pub(crate) fn seed(&self) -> Option<u64> {
        self.seed.trim().parse().ok()
    }
}

/// What an analysis is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Asked {
    /// The folder of the logs.
    pub folder: PathBuf,
    /// What chance begins with.
    pub seed: u64,
    /// What is chosen.
    pub choice: Choice,
}

impl Asked {
    /// The same for the analysis.
    pub(crate) fn options(&self) -> Options {
        let usual = Options::default();
        let n_random_data = match self.choice.has_random_data {
            true if usual.n_random_data > 0 => usual.n_random_data,
            true => N_RANDOM_DATA,
            false => 0,
        };
        let full = Options {
            seed: self.seed,
            n_random_data,
            cache: build_cache(),
            ..usual
        };
        match self.choice.effort {
            Effort::Full => full,
            Effort::Quick => Options {
                n_resamples: 500,
                n_permutations: 499,
                n_maps: 20,
                n_starts: 10,
                n_starts_on_a_line: 200,
                ..full
            },
        }
    }
}
