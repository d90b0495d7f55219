//! Axes of the lanes: round steps of time and of speed, and where levels end.

use selvedge_foundation::quantity;

/// Ends of the level axis, dB re 1 µm.
pub(crate) const LEVELS_DB: [f64; 2] = [-10.0, 40.0];
/// A time axis has a mark at most this often, points.
const MARKS: f64 = 84.0;
/// Steps of a time axis, ms.
const STEPS_MS: [u64; 20] = [
    25,
    50,
    100,
    200,
    500,
    1_000,
    2_000,
    5_000,
    10_000,
    15_000,
    30_000,
    60_000,
    120_000,
    300_000,
    600_000,
    1_800_000,
    3_600_000,
    18_000_000,
    86_400_000,
    432_000_000,
];

/// The distance between two marks of a time axis that is this long, ms.
pub(crate) fn step_ms(duration_ms: u64, width: f32) -> u64 {
    let most = (f64::from(width) / MARKS).max(1.0);
    let is_wide = |step: &u64| duration_ms as f64 / *step as f64 <= most;
    STEPS_MS.into_iter().find(is_wide).unwrap_or(u64::MAX)
}

/// A time on an axis whose marks are this far apart.
pub(crate) fn time_words(time_ms: u64, step_ms: u64) -> String {
    if step_ms < 1000 {
        let decimals = if step_ms < 100 { 3 } else { 1 };
        return quantity::with_unit(time_ms as f64 / 1000.0, decimals, "s");
    }
    let clock = quantity::clock(time_ms);
    clock.split('.').next().unwrap_or_default().to_owned()
}

/// The smallest of 100, 200, 500, 1000 … that is no less; a slow exploration has the same axis as
/// most others.
pub(crate) fn round_above(speed_mm_per_s: f64) -> f64 {
    let rounds = (2..6).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(power)));
    let last = 1e6;
    rounds
        .into_iter()
        .find(|round| speed_mm_per_s <= *round)
        .unwrap_or(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_axes_end_at_round_numbers() {
        for (fastest, top) in [
            (0.0, 100.0),
            (100.0, 100.0),
            (130.0, 200.0),
            (2_100.0, 5_000.0),
        ] {
            assert_eq!(round_above(fastest), top, "{fastest}");
        }
        assert!(round_above(f64::NAN).is_finite() && round_above(f64::INFINITY).is_finite());
    }

    #[test]
    fn marks_of_time_are_never_crowded() {
        assert_eq!(step_ms(12_000, 900.0), 2_000);
        assert_eq!(step_ms(4 * 3_600_000, 900.0), 1_800_000);
        for duration_ms in [0, 25, 900, 61_000, 1_000_000_000] {
            let n = duration_ms / step_ms(duration_ms, 500.0);
            assert!(n as f64 * MARKS <= 500.0, "{duration_ms} ms: {n}");
        }
        assert_eq!(time_words(65_000, 5_000), "01:05");
        assert_eq!(time_words(500, 100), "0.5 s");
    }
}
