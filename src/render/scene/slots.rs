//! Tunings that a scene keeps beside the one in force, to be compared under the finger: slots A to H.
//!
//! A slot holds master, bands and compression; what it gives a single textile stands with that
//! textile, so that textiles may come, go and change their order.

use serde::{Deserialize, Serialize};

use selvedge_textile::tactile::Tuning;

/// The name of a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum SlotLetter {
    A,
    B,
    C,
    D,
    E,
    F,
    G,
    H,
}

impl SlotLetter {
    /// All, in the order of the alphabet.
    pub const ALL: [Self; 8] = [
        Self::A,
        Self::B,
        Self::C,
        Self::D,
        Self::E,
        Self::F,
        Self::G,
        Self::H,
    ];

    /// As files and people write it.
    pub fn name(self) -> &'static str {
        ["A", "B", "C", "D", "E", "F", "G", "H"][self as usize]
    }
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
