//! Simulated observers whose thresholds are known.

use selvedge_statistics::psychometric::{Family, Psychometric};

/// Width from 5 % to 95 % that every way assumes where it assumes one, dB.
pub(super) const ASSUMED_WIDTH_DB: f64 = 10.0;
/// Share right of a guess among three alternatives.
pub(super) const GUESS: f64 = 1.0 / 3.0;

/// An observer but for its threshold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observer {
    pub(super) name: &'static str,
    pub(super) lapse: f64,
    pub(super) width_db: f64,
}

impl Observer {
    /// Without and with lapses, as steep as assumed and half as steep.
    pub(super) fn all() -> [Self; 4] {
        let observer = |name, lapse, width_db| Self {
            name,
            lapse,
            width_db,
        };
        let shallow_db = 2.0 * ASSUMED_WIDTH_DB;
        [
            observer("no lapses, slope as assumed", 0.0, ASSUMED_WIDTH_DB),
            observer("2 % lapses, slope as assumed", 0.02, ASSUMED_WIDTH_DB),
            observer("no lapses, half as steep as assumed", 0.0, shallow_db),
            observer("2 % lapses, half as steep as assumed", 0.02, shallow_db),
        ]
    }

    /// Its function with this threshold.
    pub(super) fn curve(&self, threshold_db: f64) -> Psychometric {
        Psychometric {
            family: Family::Gumbel,
            threshold: threshold_db,
            width: self.width_db,
            guess: GUESS,
            lapse: self.lapse,
        }
    }
}
