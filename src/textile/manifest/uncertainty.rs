//! How far values of a textile may be off, where they were not measured on it.

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::Checker;

/// The table `[uncertainty]`: what 95 of 100 textiles like this one keep within.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// The mean coefficient of friction may be so far off, either way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_level: Option<f64>,
    /// By band of wavenumbers: from, to, cycles/mm, and how far friction's magnitudes may be off,
    /// dB.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub friction_bands_db: Vec<[f64; 3]>,
}

impl Uncertainty {
    /// Refuses what is no interval.
    pub(super) fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        if let Some(level) = self.friction_level {
            checker.within("uncertainty", "friction_level", level, 0.0..=10.0)?;
        }
        let is_band =
            |[from, to, db]: &[f64; 3]| *from >= 0.0 && from < to && (0.0..=200.0).contains(db);
        match self.friction_bands_db.iter().find(|band| !is_band(band)) {
            None => Ok(()),
            Some(band) => Err(checker.wrong(
                "uncertainty",
                "friction_bands_db",
                format!("{band:?} is no band"),
                "write [from, to, dB] with 0 <= from < to in cycles/mm and 0 to 200 dB",
            )),
        }
    }
}
