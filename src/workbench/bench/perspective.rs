//! Perspectives: what the window is arranged for.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// What the window is arranged for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Perspective {
    /// To feel a scene.
    #[default]
    Explore,
    /// To make cloth.
    Cloth,
    /// To run an experiment.
    Experiment,
}

impl Perspective {
    /// All, in the order in which they are offered.
    pub(crate) const ALL: [Self; 3] = [Self::Explore, Self::Cloth, Self::Experiment];

    /// Its place in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        let mut all = Self::ALL.into_iter();
        all.position(|one| one == self).unwrap_or_default()
    }

    /// What people call it.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Explore => "Explore",
            Self::Cloth => "Cloth",
            Self::Experiment => "Experiment",
        }
    }

    /// What it is for.
    pub(crate) fn what(self) -> &'static str {
        match self {
            Self::Explore => "Feel a scene",
            Self::Cloth => "Make cloth: the library and the textile lab",
            Self::Experiment => "Run an experiment with a participant",
        }
    }
}
