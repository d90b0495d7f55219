//! How the line of time is drawn, as it is kept per user.

use serde::{Deserialize, Serialize};

/// Ends of the levels that can be told apart, dB re 1 µm.
pub(crate) const LEVELS_DB: [f64; 2] = [-80.0, 46.0];
/// The least difference between floor and top, dB.
const LEAST_RANGE_DB: f64 = 6.0;
/// Bounds of its height, points.
pub(crate) const HEIGHTS: [f32; 2] = [68.0, 420.0];

/// How the line of time is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct TimelineStyle {
    /// Its height, points.
    #[serde(rename = "timeline_height")]
    pub(crate) height: f32,
    /// The level that the lower end of the spectrum's colours stands for, dB re 1 µm.
    #[serde(rename = "timeline_floor_db")]
    pub(crate) floor_db: f64,
    /// The same of the upper end.
    #[serde(rename = "timeline_top_db")]
    pub(crate) top_db: f64,
    /// Whether its frequencies are even rather than logarithmic.
    #[serde(rename = "timeline_even_frequencies")]
    pub(crate) is_linear: bool,
}

impl Default for TimelineStyle {
    fn default() -> Self {
        Self {
            height: 132.0,
            floor_db: -40.0,
            top_db: 20.0,
            is_linear: false,
        }
    }
}

impl TimelineStyle {
    /// Ends of the spectrum's colours, dB re 1 µm.
    pub(crate) fn levels_db(&self) -> [f64; 2] {
        [self.floor_db, self.top_db]
    }

    /// With these ends, or the nearest that make a range; the end that is held stays.
    pub(crate) fn with_levels(self, [floor_db, top_db]: [f64; 2], holds_top: bool) -> Self {
        let [least, most] = LEVELS_DB;
        let (floor_db, top_db) = if holds_top {
            let top_db = top_db.clamp(least + LEAST_RANGE_DB, most);
            (floor_db.clamp(least, top_db - LEAST_RANGE_DB), top_db)
        } else {
            let floor_db = floor_db.clamp(least, most - LEAST_RANGE_DB);
            (floor_db, top_db.clamp(floor_db + LEAST_RANGE_DB, most))
        };
        Self {
            floor_db,
            top_db,
            ..self
        }
    }

    /// The same with every value at the nearest bound; what is no number is as at first.
    pub(crate) fn in_bounds(self) -> Self {
        let first = Self::default();
        let is_sound = !(self.floor_db.is_nan() || self.top_db.is_nan());
        let levels_db = if is_sound {
            self.levels_db()
        } else {
            first.levels_db()
        };
        let height = if self.height.is_nan() {
            first.height
        } else {
            self.height
        };
        let bounded = Self {
            height: height.clamp(HEIGHTS[0], HEIGHTS[1]),
            ..self
        };
        bounded.with_levels(levels_db, true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_and_top_never_meet_and_the_held_end_stays() {
        let style = TimelineStyle::default();
        assert_eq!(
            style.with_levels([30.0, 20.0], true).levels_db(),
            [14.0, 20.0]
        );
        assert_eq!(
            style.with_levels([-10.0, -20.0], false).levels_db(),
            [-10.0, -4.0]
        );
        assert_eq!(
            style.with_levels([-900.0, 900.0], true).levels_db(),
            LEVELS_DB
        );
    }

    #[test]
    fn what_is_no_number_is_as_at_first() {
        let broken = TimelineStyle {
            height: f32::NAN,
            floor_db: f64::NAN,
            ..TimelineStyle::default()
        };
        assert_eq!(broken.in_bounds(), TimelineStyle::default());
    }
}
