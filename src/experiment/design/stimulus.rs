//! What is felt in a trial.

use selvedge_textile::tactile::Band;

/// What the finger lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Medium {
    /// A tactile array, real or emulated.
    Array,
    /// Cloth on the table.
    RealCloth,
}

impl Medium {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Array, Self::RealCloth];

    /// As files spell it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Array => "array",
            Self::RealCloth => "real-cloth",
        }
    }
}

/// Something that is felt.
#[derive(Debug, Clone, PartialEq)]
pub struct Stimulus {
    /// Its name in logs and analyses; no two share one.
    pub id: String,
    /// Which material it is or stands for; several stimuli may stand for one.
    pub material: String,
    /// Where it comes from, as the study calls it: `measured`, `picture`, …
    pub condition: String,
    /// What presents it.
    pub source: Source,
}

/// What presents a stimulus.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// A textile of the library on the array.
    Textile {
        /// Its id in the library.
        id: String,
        /// Gain on top of the textile's own, dB.
        gain_db: f64,
    },
    /// A cloth on the table that goes by this name.
    RealCloth(String),
    /// A steady vibration of every contactor.
    Vibration {
        /// Its band.
        band: Band,
        /// Its level, dB re 1 µm.
        level_db: f64,
    },
}
