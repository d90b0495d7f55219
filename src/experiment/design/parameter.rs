//! Numbers that are turned or adapted, and scales that are answered on.

use std::ops::RangeInclusive;

use serde::Deserialize;

use crate::named::named;
use selvedge_textile::tactile::Tuning;

/// Levels and gains that make sense, dB.
pub(super) const LEVELS_DB: RangeInclusive<f64> = -120.0..=60.0;

/// A parameter that participants turn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TunedParameter {
    /// Which.
    #[serde(rename = "key")]
    pub(crate) what: Tunable,
    /// The lowest value.
    pub from: f64,
    /// The highest value.
    pub to: f64,
    /// What one press of a key turns it by.
    pub step: f64,
}

named! { "parameter",
    /// A number of a stimulus that can be turned or adapted.
    pub(crate) enum Tunable {
        /// The level of a vibration, dB re 1 µm.
        Level = "level_db",
        /// The gain of everything, dB.
        Gain = "gain_db",
        /// The gain of the 40 Hz band, dB.
        Gain40 = "gain_40_db",
        /// The gain of the 320 Hz band, dB.
        Gain320 = "gain_320_db",
        /// Compression, 0 to 1.
        Compression = "compression",
        /// How a textile is turned, degrees counter-clockwise.
        Rotation = "rotation_deg",
        /// The length of a vibration, ms.
        Duration = "duration_ms",
    }
}

impl Tunable {
    /// Sets it in a tuning, which holds no number of a vibration and turns no textile.
    pub(crate) fn set(self, tuning: &mut Tuning, value: f64) {
        match self {
            Self::Level | Self::Rotation | Self::Duration => {}
            Self::Gain => tuning.gain_db = value,
            Self::Gain40 => tuning.gain_40_db = value,
            Self::Gain320 => tuning.gain_320_db = value,
            Self::Compression => tuning.compression = value,
        }
    }

    /// Whether it is a number of the tuning, which can be turned while a stimulus is felt.
    pub(crate) fn is_of_tuning(self) -> bool {
        !matches!(self, Self::Level | Self::Rotation | Self::Duration)
    }

    /// The values that make sense.
    pub(crate) fn bounds(self) -> RangeInclusive<f64> {
        match self {
            Self::Compression => 0.0..=1.0,
            Self::Rotation => -180.0..=180.0,
            Self::Duration => 25.0..=5000.0,
            _ => LEVELS_DB,
        }
    }

    /// A log's column of it: gains and compression of the whole array have columns of their own.
    pub(crate) fn column(self) -> String {
        match self {
            Self::Level => self.name().to_owned(),
            _ => format!("adapted_{}", self.name()),
        }
    }

    /// What that column holds.
    pub(crate) fn meaning(self) -> &'static str {
        match self {
            Self::Level => "level of the signal",
            Self::Gain => "gain of the stimulus",
            Self::Gain40 => "gain of the 40 Hz band",
            Self::Gain320 => "gain of the 320 Hz band",
            Self::Compression => "compression of the stimulus, 0 to 1",
            Self::Rotation => "turn of the stimulus, counter-clockwise",
            Self::Duration => "length of the signal",
        }
    }

    /// Its unit; empty where it has none.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Level => "dB re 1 µm",
            _ => self.unit_of_differences(),
        }
    }

    /// The unit of a difference of two values.
    pub(crate) fn unit_of_differences(self) -> &'static str {
        match self {
            Self::Compression => "",
            Self::Rotation => "°",
            Self::Duration => "ms",
            _ => "dB",
        }
    }

    /// What names of columns that hold values or differences end with.
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Compression => "",
            Self::Rotation => "_deg",
            Self::Duration => "_ms",
            _ => "_db",
        }
    }
}

/// One scale.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// Its name in logs: letters, digits and `_`.
    pub key: String,
    /// What stands at its low end.
    pub low: String,
    /// What stands at its high end.
    pub high: String,
    /// Its points from 1; 0 is a line from 0 to 100 without points.
    #[serde(default)]
    pub points: u8,
}

impl Scale {
    /// The lowest and the highest answer.
    pub fn bounds(&self) -> [f64; 2] {
        match self.points {
            0 => [0.0, 100.0],
            points => [1.0, f64::from(points)],
        }
    }
}
