//! What the user turns: gains and compression, all in dB, all applied after the spectra.

use serde::{Deserialize, Serialize};

use super::Band;

/// The user's tuning of a scene. Gains in dB; −∞ is silence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tuning {
    /// Gain of everything, dB.
    pub gain_db: f64,
    /// Gain of the 40 Hz band, dB.
    pub gain_40_db: f64,
    /// Gain of the 320 Hz band, dB.
    pub gain_320_db: f64,
    /// Compression κ: 0 leaves textiles as different as they are, 1 makes all equally strong.
    pub compression: f64,
    /// The level that compression leaves alone, dB re 1 µm; absent = the library's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compression_reference_db: Option<f64>,
}

/// A tuning that makes no sense.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TuningError {
    /// A gain is NaN or +∞.
    #[error("{key} is {value}; give a number of dB, or -inf for silence")]
    Gain {
        /// The key as files spell it.
        key: &'static str,
        /// What it was.
        value: f64,
    },
    /// Compression lies outside 0…1.
    #[error("compression is {value}; give a number from 0 (none) to 1 (all equally strong)")]
    Compression {
        /// What it was.
        value: f64,
    },
    /// The reference level is not finite.
    #[error("compression_reference_db is {value}; give a finite number of dB")]
    Reference {
        /// What it was.
        value: f64,
    },
}

impl TuningError {
    /// The key that is wrong, as files spell it.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Gain { key, .. } => key,
            Self::Compression { .. } => "compression",
            Self::Reference { .. } => "compression_reference_db",
        }
    }
}

impl Default for Tuning {
    /// Everything as it is: no gain, no compression.
    fn default() -> Self {
        Self {
            gain_db: 0.0,
            gain_40_db: 0.0,
            gain_320_db: 0.0,
            compression: 0.0,
            compression_reference_db: None,
        }
    }
}

impl Tuning {
    /// Refuses gains that are NaN or +∞, compression outside 0…1, a reference that is not finite.
    pub fn check(&self) -> Result<(), TuningError> {
        Self::check_gain("gain_db", self.gain_db)?;
        Self::check_gain("gain_40_db", self.gain_40_db)?;
        Self::check_gain("gain_320_db", self.gain_320_db)?;
        if !(0.0..=1.0).contains(&self.compression) {
            return Err(TuningError::Compression {
                value: self.compression,
            });
        }
        match self.compression_reference_db {
            Some(value) if !value.is_finite() => Err(TuningError::Reference { value }),
            _ => Ok(()),
        }
    }

    /// Master gain and gain of the band, dB.
    pub fn band_gain_db(&self, band: Band) -> f64 {
        self.gain_db + self.own_band_gain_db(band)
    }

    /// Gain of the band alone, dB.
    pub fn own_band_gain_db(&self, band: Band) -> f64 {
        match band {
            Band::Low => self.gain_40_db,
            Band::High => self.gain_320_db,
        }
    }

    /// Gain that compression gives a textile of this level: `−κ (L − L_ref)` dB; 0 for a textile
    /// that has no level.
    pub fn compression_gain_db(&self, level_db: Option<f64>, reference_db: f64) -> f64 {
        level_db.map_or(0.0, |level_db| {
            -self.compression * (level_db - reference_db)
        })
    }

    /// Refuses a gain that is NaN or +∞; −∞ is silence and fine.
    pub fn check_gain(key: &'static str, value: f64) -> Result<(), TuningError> {
        if value.is_nan() || value == f64::INFINITY {
            return Err(TuningError::Gain { key, value });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_compression_makes_all_levels_equal() {
        let tuning = Tuning {
            compression: 1.0,
            ..Tuning::default()
        };
        for level_db in [-20.0, 3.0, 17.5] {
            let felt_db = level_db + tuning.compression_gain_db(Some(level_db), -3.0);
            assert!((felt_db + 3.0).abs() < 1e-12, "{felt_db}");
        }
        assert_eq!(tuning.compression_gain_db(None, -3.0), 0.0);
    }

    #[test]
    fn senseless_tunings_are_refused_by_key() {
        let with = |change: fn(&mut Tuning)| {
            let mut tuning = Tuning::default();
            change(&mut tuning);
            tuning.check().map_err(|error| error.key())
        };
        assert_eq!(with(|t| t.gain_db = f64::NEG_INFINITY), Ok(()));
        assert_eq!(with(|t| t.gain_db = f64::INFINITY), Err("gain_db"));
        assert_eq!(with(|t| t.gain_320_db = f64::NAN), Err("gain_320_db"));
        assert_eq!(with(|t| t.compression = 1.01), Err("compression"));
        assert_eq!(with(|t| t.compression = f64::NAN), Err("compression"));
        assert_eq!(
            with(|t| t.compression_reference_db = Some(f64::NEG_INFINITY)),
            Err("compression_reference_db")
        );
    }
}
