//! The gains of every placed textile and band: all that is applied after the spectra.
//!
//! `total dB = master + band + manifest + scene + compression`; what the scene gives a textile is
//! its gain and that of the band alone. Changing them costs a few powers of ten and never touches a
//! spectrum; it allocates nothing, so sliders may move while a tick is due.

use super::{PlacedLevel, RenderError, RenderScene};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_textile::tactile::{Band, Tuning};

/// Total gains above this count as this, so that every product stays finite, dB.
pub(crate) const MAX_TOTAL_GAIN_DB: f64 = 300.0;

/// The terms of one textile's gain in one band, dB.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct GainTerms {
    /// The master gain.
    pub master_db: f64,
    /// The gain of the band.
    pub band_db: f64,
    /// The gain of the textile's manifest.
    pub manifest_db: f64,
    /// The gain that the scene gives the textile, in this band.
    pub scene_db: f64,
    /// The gain that compression gives it; 0 while its level is pending.
    pub compression_db: f64,
}

impl GainTerms {
    /// Those of a tuning over what a textile has of its own in a band, without compression, dB.
    pub(crate) fn of(tuning: &Tuning, band: Band, [manifest_db, scene_db]: [f64; 2]) -> Self {
        Self {
            master_db: tuning.gain_db,
            band_db: tuning.own_band_gain_db(band),
            manifest_db,
            scene_db,
            compression_db: 0.0,
        }
    }

    /// Their sum, at most [`MAX_TOTAL_GAIN_DB`].
    pub fn total_db(&self) -> f64 {
        let sum = self.master_db + self.band_db + self.manifest_db + self.scene_db;
        (sum + self.compression_db).min(MAX_TOTAL_GAIN_DB)
    }

    /// The amplitude factor of their sum; 0 at −∞ dB.
    pub fn factor(&self) -> f64 {
        factor_of_gain(self.total_db())
    }
}

#[derive(Debug, Clone)]
struct TextileGain {
    manifest_db: f64,
    scene_db: f64,
    /// On top of that, by band.
    scene_band_db: [f64; 2],
    level: PlacedLevel,
    factors: [f64; 2],
}

/// Live gains of a scene.
#[derive(Debug, Clone)]
pub(super) struct Gains {
    tuning: Tuning,
    library_reference_db: Option<f64>,
    textiles: Vec<TextileGain>,
}

impl Gains {
    pub(super) fn of(scene: &RenderScene) -> Self {
        let textile = |placed: &super::PlacedSurface| TextileGain {
            manifest_db: placed.manifest_gain_db,
            scene_db: placed.scene_gain_db,
            scene_band_db: placed.scene_band_gains_db,
            level: placed.level,
            factors: [0.0; 2],
        };
        let mut gains = Self {
            tuning: scene.tuning,
            library_reference_db: scene.library_reference_db,
            textiles: scene.textiles.iter().map(textile).collect(),
        };
        gains.apply();
        gains
    }

    /// Takes a new tuning with the gains that the scene gives some textiles (place in the list,
    /// dB), or keeps all as it was when any of it makes no sense.
    pub(super) fn set(
        &mut self,
        tuning: &Tuning,
        textiles_db: &[(usize, f64)],
    ) -> Result<(), RenderError> {
        tuning.check()?;
        let n_textiles = self.textiles.len();
        for &(index, gain_db) in textiles_db {
            Tuning::check_gain("gain_db", gain_db)?;
            if index >= n_textiles {
                return Err(RenderError::NoTextile { index, n_textiles });
            }
        }
        self.tuning = *tuning;
        for &(index, gain_db) in textiles_db {
            self.textiles[index].scene_db = gain_db;
        }
        self.apply();
        Ok(())
    }

    /// Takes the levels of all textiles once they are known; a wrong number of them is refused.
    pub(super) fn set_levels(&mut self, levels: &[PlacedLevel]) -> Result<(), RenderError> {
        if levels.len() != self.textiles.len() {
            return Err(RenderError::WrongNumberOfLevels {
                given: levels.len(),
                wanted: self.textiles.len(),
            });
        }
        for (textile, &level) in self.textiles.iter_mut().zip(levels) {
            textile.level = level;
        }
        self.apply();
        Ok(())
    }

    pub(super) fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// Amplitude factors by band of what is no textile of the scene: the master's and the band's.
    pub(super) fn plain_factors(&self) -> [f64; 2] {
        Band::ALL.map(|band| GainTerms::of(&self.tuning, band, [0.0; 2]).factor())
    }

    /// Amplitude factors of a textile by band.
    pub(super) fn factors(&self, textile: usize) -> [f64; 2] {
        self.textiles[textile].factors
    }

    pub(super) fn terms(&self, textile: usize, band: Band) -> GainTerms {
        terms_of(
            &self.textiles[textile],
            &self.tuning,
            self.reference_db(),
            band,
        )
    }

    /// Whether compression waits for levels that are still being computed.
    pub(super) fn compression_is_pending(&self) -> bool {
        self.tuning.compression > 0.0
            && self
                .textiles
                .iter()
                .any(|t| t.level == PlacedLevel::Pending)
    }

    /// The level that compression leaves alone: the tuning's, else the library's, else the mean of
    /// the textiles placed. `None` when no level is known, or one that the mean needs is pending.
    pub(super) fn reference_db(&self) -> Option<f64> {
        let stated = self.tuning.compression_reference_db;
        stated.or(self.library_reference_db).or_else(|| {
            let is_pending = |t: &TextileGain| t.level == PlacedLevel::Pending;
            if self.textiles.iter().any(is_pending) {
                return None;
            }
            let levels = || self.textiles.iter().filter_map(|t| t.level.db());
            let n_levels = levels().count();
            (n_levels > 0).then(|| levels().sum::<f64>() / n_levels as f64)
        })
    }

    fn apply(&mut self) {
        let reference_db = self.reference_db();
        for textile in &mut self.textiles {
            textile.factors =
                Band::ALL.map(|band| terms_of(textile, &self.tuning, reference_db, band).factor());
        }
    }
}

fn terms_of(
    textile: &TextileGain,
    tuning: &Tuning,
    reference_db: Option<f64>,
    band: Band,
) -> GainTerms {
    let compress = |reference_db| tuning.compression_gain_db(textile.level.db(), reference_db);
    let scene_db = textile.scene_db + textile.scene_band_db[band.index()];
    GainTerms {
        compression_db: reference_db.map_or(0.0, compress),
        ..GainTerms::of(tuning, band, [textile.manifest_db, scene_db])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gains(levels: &[PlacedLevel]) -> Gains {
        let textile = |&level: &PlacedLevel| TextileGain {
            manifest_db: -2.0,
            scene_db: 1.0,
            scene_band_db: [0.5, 0.0],
            level,
            factors: [0.0; 2],
        };
        let mut gains = Gains {
            tuning: Tuning {
                compression: 1.0,
                gain_db: 3.0,
                gain_320_db: -6.0,
                ..Tuning::default()
            },
            library_reference_db: None,
            textiles: levels.iter().map(textile).collect(),
        };
        gains.apply();
        gains
    }

    #[test]
    fn the_terms_add_up_and_compression_uses_the_mean_level() {
        let gains = gains(&[
            PlacedLevel::Known(10.0),
            PlacedLevel::Known(-4.0),
            PlacedLevel::Silent,
        ]);
        let terms = gains.terms(0, Band::High);
        assert_eq!(terms.compression_db, -7.0);
        assert_eq!(terms.total_db(), 3.0 - 6.0 - 2.0 + 1.0 - 7.0);
        assert_eq!(gains.terms(2, Band::Low).compression_db, 0.0);
        assert_eq!(gains.factors(1)[0], factor_of_gain(2.0 + 0.5 + 7.0));
        assert!(!gains.compression_is_pending(), "all levels are known");
    }

    #[test]
    fn pending_levels_leave_compression_alone_until_they_come() {
        let mut gains = gains(&[PlacedLevel::Pending, PlacedLevel::Known(6.0)]);
        assert!(gains.compression_is_pending(), "one level is missing");
        assert_eq!(gains.terms(1, Band::Low).compression_db, 0.0);
        let levels = [PlacedLevel::Known(0.0), PlacedLevel::Known(6.0)];
        gains.set_levels(&levels).unwrap();
        assert_eq!(gains.terms(1, Band::Low).compression_db, -3.0);
        assert!(
            gains.set_levels(&levels[..1]).is_err(),
            "one level for two textiles"
        );
    }

    #[test]
    fn senseless_tunings_keep_the_last_and_silence_is_silent() {
        let mut gains = gains(&[PlacedLevel::Known(1.0)]);
        let before = gains.factors(0);
        for gain_db in [f64::NAN, f64::INFINITY] {
            let tuning = Tuning {
                gain_db,
                ..Tuning::default()
            };
            assert!(gains.set(&tuning, &[(0, 3.0)]).is_err(), "{gain_db}");
        }
        assert_eq!(gains.factors(0), before);
        let silence = Tuning {
            gain_db: f64::NEG_INFINITY,
            ..Tuning::default()
        };
        gains.set(&silence, &[]).unwrap();
        assert_eq!(gains.factors(0), [0.0; 2]);
        let loud = Tuning {
            gain_db: 1e9,
            ..Tuning::default()
        };
        gains.set(&loud, &[]).unwrap();
        assert_eq!(gains.factors(0), [1e15; 2]);
    }
}
