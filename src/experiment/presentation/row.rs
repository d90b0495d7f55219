//! What is known of a presentation, as its row has it, and by what.

use crate::named::named;

named! { "proof",
    /// By what it is known that something was felt.
    pub enum Proof {
        /// A device acknowledged every tick.
        Array = "array",
        /// An emulator did: felt by nobody.
        Emulator = "emulator",
        /// The screen alone showed it, in a pilot: felt by nobody.
        Screen = "screen",
        /// The experimenter laid cloth and said when it was felt.
        RealCloth = "real-cloth",
        /// The experimenter said that something else presented it.
        Elsewhere = "elsewhere",
        /// An observer that is simulated.
        Simulated = "simulated",
    }
}

/// What is known of a presentation, as its row has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Presentation {
    /// By what it is known; `None` in logs that do not say.
    pub proof: Option<Proof>,
    /// Why it does not count; empty where it does.
    pub void: String,
    /// Ticks at which the device was armed, of all.
    pub armed_share: Option<f64>,
    /// Ticks whose frame the device applied.
    pub frames_applied: Option<u64>,
    /// Frames that came too late or not at all.
    pub frames_late: Option<u64>,
    /// Values that limits changed, of all.
    pub limited_share: Option<f64>,
    /// How long each item was felt in movement, s: by position, the target last.
    pub explored_s: Vec<f64>,
    /// First tick of what is asked about, ns since the session was opened.
    pub onset_ns: Option<u64>,
    /// SHA-256 of the file of how it was explored; empty where there is none.
    pub path_sha256: String,
}

/// Whether a presentation counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Validity {
    /// It was felt as it should be.
    Valid,
    /// It was not.
    Void,
    /// The log does not say.
    Unknown,
}

impl Presentation {
    /// One that is proved by something other than ticks.
    pub fn confirmed(proof: Proof) -> Self {
        Self {
            proof: Some(proof),
            ..Self::default()
        }
    }

    /// Why it does not count, in words.
    pub fn why_void(&self) -> &str {
        match self.validity() {
            Validity::Unknown => "nothing is known of its presentation",
            Validity::Valid | Validity::Void => &self.void,
        }
    }

    /// Whether it counts.
    pub fn validity(&self) -> Validity {
        match self.proof {
            None => Validity::Unknown,
            Some(_) if self.void.is_empty() => Validity::Valid,
            Some(_) => Validity::Void,
        }
    }
}
