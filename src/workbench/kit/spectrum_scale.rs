//! The one scale on which spectrograms are drawn, the line of time's too: the levels that colours
//! stand for, chosen by two handles on the bar of colours, and how frequencies lie.

use serde::{Deserialize, Serialize};

use selvedge_foundation::quantity;

/// The levels that can be chosen lie between these, dB re 1 µm.
pub(crate) const LEVELS_DB: [f64; 2] = [-80.0, 80.0];
/// From the floor to the upper end at least, dB.
const LEAST_SPAN_DB: f64 = 10.0;

/// What linear frequencies are, for tips.
pub(crate) const EVENLY: &str = "Frequencies evenly along the axis, not by their logarithms";

/// The scale of spectrograms.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "SpectrumKeys", into = "SpectrumKeys")]
pub(crate) struct SpectrumScale {
    /// The levels that the colours stand for.
    pub(crate) levels: LevelRange,
    /// Whether frequencies lie evenly, not by their logarithms.
    pub(crate) is_linear: bool,
}

/// The same as a file states it.
#[derive(Serialize, Deserialize)]
#[serde(default)]
struct SpectrumKeys {
    #[serde(rename = "spectrum_floor_db")]
    floor_db: f64,
    #[serde(rename = "spectrum_top_db")]
    top_db: f64,
    #[serde(rename = "spectrum_linear")]
    is_linear: bool,
}

impl Default for SpectrumKeys {
    fn default() -> Self {
        SpectrumScale::default().into()
    }
}

impl From<SpectrumScale> for SpectrumKeys {
    fn from(scale: SpectrumScale) -> Self {
        Self {
            floor_db: scale.levels.floor_db,
            top_db: scale.levels.top_db,
            is_linear: scale.is_linear,
        }
    }
}

impl From<SpectrumKeys> for SpectrumScale {
    fn from(keys: SpectrumKeys) -> Self {
        let levels = LevelRange::within(keys.floor_db, keys.top_db);
        Self {
            levels,
            is_linear: keys.is_linear,
        }
    }
}

/// What of a range of levels is moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Handle {
    /// Its floor.
    Floor,
    /// Its upper end.
    Top,
    /// Both together.
    Both,
}

/// A range of levels, dB re 1 µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LevelRange {
    floor_db: f64,
    top_db: f64,
}

impl Default for LevelRange {
    /// From what nobody feels to twice full drive.
    fn default() -> Self {
        Self {
            floor_db: -40.0,
            top_db: 40.0,
        }
    }
}

impl LevelRange {
    /// From a floor to an upper end, or the nearest range that can be chosen; the first one where
    /// either is no number.
    fn within(floor_db: f64, top_db: f64) -> Self {
        if floor_db.is_nan() || top_db.is_nan() {
            return Self::default();
        }
        let [least, most] = LEVELS_DB;
        let floor_db = floor_db.clamp(least, most - LEAST_SPAN_DB);
        Self {
            floor_db,
            top_db: top_db.clamp(floor_db + LEAST_SPAN_DB, most),
        }
    }

    /// Its floor and its upper end, dB re 1 µm.
    pub(crate) fn ends_db(self) -> [f64; 2] {
        [self.floor_db, self.top_db]
    }

    /// Where a level stands, 0…1; beyond the ends the nearest end.
    pub(crate) fn share(self, level_db: f64) -> f64 {
        ((level_db - self.floor_db) / (self.top_db - self.floor_db)).clamp(0.0, 1.0)
    }

    /// The range after a handle was moved by so much from where `self` has it, dB: in whole dB,
    /// within the levels that can be chosen, its ends never too close.
    pub(crate) fn moved(self, handle: Handle, by_db: f64) -> Self {
        let [least, most] = LEVELS_DB;
        let Self { floor_db, top_db } = self;
        let whole = |level_db: f64, [low, high]: [f64; 2]| level_db.round().clamp(low, high);
        match handle {
            _ if !by_db.is_finite() => self,
            Handle::Floor => Self {
                floor_db: whole(floor_db + by_db, [least, top_db - LEAST_SPAN_DB]),
                top_db,
            },
            Handle::Top => Self {
                floor_db,
                top_db: whole(top_db + by_db, [floor_db + LEAST_SPAN_DB, most]),
            },
            Handle::Both => {
                let by_db = whole(by_db, [least - floor_db, most - top_db]);
                Self {
                    floor_db: floor_db + by_db,
                    top_db: top_db + by_db,
                }
            }
        }
    }

    /// In words: `−40 to 40 dB re 1 µm`.
    pub(crate) fn words(self) -> String {
        let [floor, top] = self.ends_db().map(|db| quantity::fixed(db, 0));
        format!("{floor} to {top} dB re 1 µm")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handles_move_in_whole_decibels_and_never_meet() {
        let range = LevelRange::default();
        assert_eq!(range.moved(Handle::Floor, 12.4).ends_db(), [-28.0, 40.0]);
        assert_eq!(range.moved(Handle::Floor, 500.0).ends_db(), [30.0, 40.0]);
        assert_eq!(range.moved(Handle::Top, -500.0).ends_db(), [-40.0, -30.0]);
        assert_eq!(range.moved(Handle::Top, 500.0).ends_db(), [-40.0, 80.0]);
        assert_eq!(range.moved(Handle::Both, -55.0).ends_db(), [-80.0, 0.0]);
        assert_eq!(range.moved(Handle::Both, f64::NAN), range);
    }

    #[test]
    fn what_a_file_states_is_brought_within_bounds() {
        let ends_db = |floor, top| LevelRange::within(floor, top).ends_db();
        assert_eq!(ends_db(-60.0, 10.0), [-60.0, 10.0]);
        assert_eq!(ends_db(-900.0, -700.0), [-80.0, -70.0]);
        assert_eq!(ends_db(500.0, 0.0), [70.0, 80.0]);
        assert_eq!(ends_db(-50.0, f64::NAN), LevelRange::default().ends_db());
    }

    #[test]
    fn levels_beyond_the_ends_have_the_colour_of_the_end() {
        let range = LevelRange::default();
        assert_eq!(
            [-90.0, -40.0, 0.0, 40.0, 99.0].map(|db| range.share(db)),
            [0.0, 0.0, 0.5, 1.0, 1.0]
        );
        assert_eq!(range.words(), "−40 to 40 dB re 1 µm");
    }
}
