//! Tunings that a scene keeps beside the one in force, to be compared under the finger: slots A to
//! H.
//!
//! A slot holds master, bands and compression; what it gives a single textile stands with that
//! textile, so that textiles may come, go and change their order.

use serde::{Deserialize, Serialize};

use selvedge_textile::tactile::Tuning;

selvedge_foundation::named! {
    /// The name of a slot.
    #[derive(
        Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
    )]
    pub enum SlotLetter {
        /// The first.
        A = "A",
        /// The second.
        B = "B",
        /// The third.
        C = "C",
        /// The fourth.
        D = "D",
        /// The fifth.
        E = "E",
        /// The sixth.
        F = "F",
        /// The seventh.
        G = "G",
        /// The last.
        H = "H",
    }
    /// As files and people write it.
    pub fn name;
}

/// A tuning that is kept under a letter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TuningSlot {
    /// Its letter; no two slots of a scene have the same.
    pub letter: SlotLetter,
    /// What people call it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What is to be remembered of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Gains and compression; the gains of single textiles stand with these.
    pub tuning: Tuning,
}
