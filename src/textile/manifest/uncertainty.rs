//! How far values of a textile may be off, where they were not measured on it.

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::Checker;
use crate::tactile::Band;
use selvedge_foundation::quantity::fixed;

/// The table `[uncertainty]`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// The mean coefficient of friction may be so far off, either way, in 95 of 100 textiles like
    /// this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_level: Option<f64>,
    /// By band of wavenumbers: from, to, cycles/mm, and how far friction's magnitudes may be off,
    /// dB; likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub friction_bands_db: Vec<[f64; 3]>,
    /// By band and direction: Hz, degrees from the warp towards the weft, and from where to where
    /// the amplitude may lie, dB from what is felt: 16 and 84 of 100 surfaces that explain what is
    /// known lie below.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<[f64; 4]>,
}

/// A band that is wider asks for a measurement, dB.
const WIDE_DB: f64 = 12.0;

impl Uncertainty {
    /// From where to where the amplitude of a band may lie in a direction of movement, dB from what
    /// is felt: between the directions of [`Self::levels`] in proportion, both ways along a line
    /// alike. 0 to 0 where nothing is said.
    pub fn level_db(&self, band: Band, direction_deg: f64) -> [f64; 2] {
        let of_band = |&&[hz, ..]: &&[f64; 4]| (hz - band.carrier_hz()).abs() < 0.5;
        let mut known: Vec<[f64; 3]> = self
            .levels
            .iter()
            .filter(of_band)
            .map(|&[_, at, low, high]| [at, low, high])
            .collect();
        known.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (Some(first), Some(last)) = (known.first().copied(), known.last().copied()) else {
            return [0.0; 2];
        };
        let at = direction_deg.rem_euclid(180.0);
        let turned = |[deg, low, high]: [f64; 3], by: f64| [deg + by, low, high];
        let mut around = vec![turned(last, -180.0)];
        around.extend(known);
        around.push(turned(first, 180.0));
        let found = around.windows(2).find(|pair| at <= pair[1][0]);
        let Some([[from, a_low, a_high], [to, b_low, b_high]]) =
            found.and_then(|pair| pair.first_chunk())
        else {
            return [first[1], first[2]];
        };
        let share = if to > from {
            (at - from) / (to - from)
        } else {
            0.0
        };
        [
            a_low + (b_low - a_low) * share,
            a_high + (b_high - a_high) * share,
        ]
    }

    /// From where to where, dB, as people read it.
    pub fn range_words([low_db, high_db]: [f64; 2]) -> String {
        let signed = |db: f64| {
            let words = fixed(db, 1);
            let plus = if words.starts_with('−') { "" } else { "+" };
            format!("{plus}{words}")
        };
        format!("{} to {}", signed(low_db), signed(high_db))
    }

    /// The mean of warp and weft of that.
    pub fn mean_level_db(&self, band: Band) -> [f64; 2] {
        let [warp, weft] = [0.0, 90.0].map(|deg| self.level_db(band, deg));
        [0, 1].map(|end| 0.5 * (warp[end] + weft[end]))
    }

    /// From where to where the amplitudes may lie along warp and weft, in a line; `None` where
    /// nothing is said.
    pub fn words(&self) -> Option<String> {
        let of = |band: Band| {
            let [warp, weft] = [0.0, 90.0].map(|deg| Self::range_words(self.level_db(band, deg)));
            format!(
                "A{} {warp} dB along the warp, {weft} along the weft",
                band.carrier_hz()
            )
        };
        (!self.levels.is_empty()).then(|| Band::ALL.map(of).join("; "))
    }

    /// The band and direction of the widest band and its width in dB, where it is so wide that a
    /// measurement is worth more than what is known.
    pub fn too_wide(&self) -> Option<[f64; 4]> {
        let width = |&[.., low, high]: &[f64; 4]| high - low;
        let widest = self
            .levels
            .iter()
            .copied()
            .max_by(|a, b| width(a).total_cmp(&width(b)));
        widest.filter(|band| width(band) > WIDE_DB)
    }

    /// Refuses what is no interval.
    pub(super) fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        if let Some(level) = self.friction_level {
            checker.within("uncertainty", "friction_level", level, 0.0..=10.0)?;
        }
        let is_band =
            |[from, to, db]: &[f64; 3]| *from >= 0.0 && from < to && (0.0..=200.0).contains(db);
        if let Some(band) = self.friction_bands_db.iter().find(|band| !is_band(band)) {
            return Err(checker.wrong(
                "uncertainty",
                "friction_bands_db",
                format!("{band:?} is no band"),
                "write [from, to, dB] with 0 <= from < to in cycles/mm and 0 to 200 dB",
            ));
        }
        let is_band = |[hz, deg, low, high]: &[f64; 4]| {
            let is_carrier = Band::ALL
                .iter()
                .any(|band| (band.carrier_hz() - hz).abs() < 0.5);
            let range = -200.0..=200.0;
            is_carrier
                && (0.0..180.0).contains(deg)
                && low <= high
                && range.contains(low)
                && range.contains(high)
        };
        match self.levels.iter().find(|band| !is_band(band)) {
            None => Ok(()),
            Some(band) => Err(checker.wrong(
                "uncertainty",
                "levels",
                format!("{band:?} is no band"),
                "write [Hz, degrees, dB, dB] with 40 or 320 Hz, 0 to below 180° from the warp, and \
                 the lower end first",
            )),
        }
    }
}
