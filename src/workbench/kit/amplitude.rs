//! The one scale on which amplitudes are drawn: two decades, logarithmic, in µm.
//!
//! Heatmaps, dots, the drive's spectrum and every colour bar share it, so that a colour or a size
//! means the same everywhere at once. It may be held, or follow the largest amplitude in steps
//! of 1, 2, 5.

use serde::{Deserialize, Serialize};

use crate::kit::widgets::axis::round_step;
use selvedge_foundation::quantity;

/// From the largest to the smallest amplitude on the scale.
const SPAN: f64 = 100.0;
/// From the top of the levels of curves to their bottom: wider than the scale, whose top they
/// share, since curves fall far, dB.
const LEVELS_SPAN_DB: f64 = 60.0;
/// The full scale of the output, where the scale begins and which it never exceeds by itself, µm.
const FULL_SCALE_UM: f64 = 50.0;
/// The smallest upper end, µm.
const LEAST_TOP_UM: f64 = 0.05;
/// The largest upper end, µm.
const MOST_TOP_UM: f64 = 5e6;

/// The scale of amplitudes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "AmplitudeKeys")]
pub(crate) struct AmplitudeScale {
    /// Its upper end, µm.
    #[serde(rename = "amplitude_top_um")]
    most_um: f64,
    /// Whether it stays whatever comes.
    #[serde(rename = "amplitude_locked")]
    is_locked: bool,
}

impl Default for AmplitudeScale {
    /// Up to the full scale of the output; 40 dB below it is hardly felt.
    fn default() -> Self {
        Self {
            most_um: FULL_SCALE_UM,
            is_locked: true,
        }
    }
}

/// The same as a file states it.
#[derive(Deserialize)]
#[serde(default)]
struct AmplitudeKeys {
    amplitude_top_um: f64,
    amplitude_locked: bool,
}

impl Default for AmplitudeKeys {
    fn default() -> Self {
        let scale = AmplitudeScale::default();
        Self {
            amplitude_top_um: scale.most_um,
            amplitude_locked: scale.is_locked,
        }
    }
}

impl From<AmplitudeKeys> for AmplitudeScale {
    fn from(keys: AmplitudeKeys) -> Self {
        let scale = Self::default().locked_at(keys.amplitude_top_um);
        scale.with_lock(keys.amplitude_locked)
    }
}

impl AmplitudeScale {
    /// A scale that ends near `most_um` and stays there; what is no number changes nothing.
    pub(crate) fn locked_at(self, most_um: f64) -> Self {
        if !most_um.is_finite() {
            return self;
        }
        Self {
            most_um: round_up(most_um),
            is_locked: true,
        }
    }

    /// The same scale, held or free to follow.
    pub(crate) fn with_lock(self, is_locked: bool) -> Self {
        Self { is_locked, ..self }
    }

    /// Whether it is held.
    pub(crate) fn is_locked(self) -> bool {
        self.is_locked
    }

    /// Lower end, µm.
    pub(crate) fn least_um(self) -> f64 {
        self.most_um / SPAN
    }

    /// Upper end, µm.
    pub(crate) fn most_um(self) -> f64 {
        self.most_um
    }

    /// The ends of the levels of curves, dB re 1 µm.
    pub(crate) fn level_ends_db(self) -> [f64; 2] {
        let most_db = quantity::level_db(self.most_um);
        [most_db - LEVELS_SPAN_DB, most_db]
    }

    /// The scale after the largest amplitude seen lately, µm: it rises at once and falls when only
    /// its lower half is used.
    pub(crate) fn following(self, largest_um: f64) -> Self {
        let is_too_low = largest_um > self.most_um;
        let is_too_high = largest_um > 0.0 && largest_um < self.most_um / 5.0;
        if self.is_locked || !(is_too_low || is_too_high) || !largest_um.is_finite() {
            return self;
        }
        Self {
            most_um: round_up(largest_um),
            ..self
        }
    }

    /// Where an amplitude stands, 0…1; beyond the ends the nearest end, NaN at the lower.
    pub(crate) fn share(self, amplitude_um: f64) -> f64 {
        let share = (amplitude_um / self.least_um()).ln() / SPAN.ln();
        share.clamp(0.0, 1.0).max(0.0)
    }

    /// The amplitudes that a colour bar names, µm: 1, 2, 5 of each decade, both ends included.
    pub(crate) fn marks_um(self) -> Vec<f64> {
        let decade = 10.0_f64.powf(self.least_um().log10().floor());
        let marks = (0..4).flat_map(|n| [1.0, 2.0, 5.0].map(|f| f * decade * 10.0_f64.powi(n)));
        let within =
            |um: &f64| *um >= self.least_um() * (1.0 - 1e-9) && *um <= self.most_um * (1.0 + 1e-9);
        marks.filter(within).collect()
    }
}

/// The least of 1, 2, 5 · 10ⁿ that is not below `um`, between the outermost upper ends.
fn round_up(um: f64) -> f64 {
    round_step(um.clamp(LEAST_TOP_UM, MOST_TOP_UM))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_scale_are_its_ends() {
        let scale = AmplitudeScale::default();
        assert_eq!((scale.least_um(), scale.most_um()), (0.5, 50.0));
        assert_eq!((scale.share(0.5), scale.share(50.0)), (0.0, 1.0));
        assert!((scale.share(5.0) - 0.5).abs() < 1e-12, "half way in dB");
        for silent in [0.0, f64::NAN, -1.0] {
            assert_eq!(scale.share(silent), 0.0, "{silent}");
        }
        assert_eq!(scale.share(f64::INFINITY), 1.0);
        assert_eq!(scale.marks_um(), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
    }

    #[test]
    fn a_held_scale_stays_and_a_free_one_follows_in_round_steps() {
        let held = AmplitudeScale::default();
        assert_eq!(held.following(700.0), held);
        let free = held.with_lock(false);
        assert_eq!(free.following(70.0).most_um(), 100.0);
        assert_eq!(free.following(12.0), free, "still well used");
        assert_eq!(free.following(3.0).most_um(), 5.0);
        for nothing in [0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(free.following(nothing), free, "{nothing}");
        }
    }

    #[test]
    fn a_chosen_top_is_rounded_and_stays_in_bounds() {
        let top = |um| AmplitudeScale::default().locked_at(um).most_um();
        assert_eq!((top(18.0), top(0.0), top(1e12)), (20.0, 0.05, 5e6));
        assert_eq!(top(f64::NAN), 50.0, "nothing changes");
    }
}
