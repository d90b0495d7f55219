//! Units and their printing: decibels, and numbers as people read them.
//!
//! The one place that decides how a number looks in text: fixed decimals, a real minus sign, the
//! unit after a narrow gap. Files do not use it: they hold shortest round-trip digits.
//!
//! # Invariants
//! - pure functions, no I/O
//! - levels are dB re 1 µm peak, gains are dB of an amplitude ratio (20 log₁₀)

mod calendar;

pub use calendar::{date_of, moment_of, rfc3339};

/// Level of an amplitude, dB re 1 µm: `20 log₁₀ a`. Zero gives −∞.
pub fn level_db(amplitude_um: f64) -> f64 {
    20.0 * amplitude_um.log10()
}

/// The amplitude factor of a gain: `10^(dB/20)`. −∞ gives 0.
pub fn factor_of_gain(gain_db: f64) -> f64 {
    10.0_f64.powf(gain_db / 20.0)
}

/// `value` with `decimals` fixed digits, a true minus sign, a gap and `unit`: `−3.0 dB`.
pub fn with_unit(value: f64, decimals: usize, unit: &str) -> String {
    format!("{} {unit}", fixed(value, decimals))
}

/// `value` with `decimals` fixed digits and a true minus sign; never `−0.0`.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_nan() {
        return "none".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 {
            "∞".to_owned()
        } else {
            "−∞".to_owned()
        };
    }
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.bytes().all(|b| b == b'0' || b == b'.');
    if value < 0.0 && !is_zero {
        format!("−{digits}")
    } else {
        digits
    }
}

/// A time span as people read it: `850 ns`, `1.20 µs`, `3.4 ms`, `2.00 s`.
pub fn time_span(seconds: f64) -> String {
    let magnitude = seconds.abs();
    if magnitude < 1e-6 {
        with_unit(seconds * 1e9, 0, "ns")
    } else if magnitude < 1e-3 {
        with_unit(seconds * 1e6, 2, "µs")
    } else if magnitude < 1.0 {
        with_unit(seconds * 1e3, 2, "ms")
    } else {
        with_unit(seconds, 2, "s")
    }
}

/// A time as a clock shows it: `00:12.350`, and from an hour on `1:00:12.350`.
pub fn clock(time_ms: u64) -> String {
    let (ms, s) = (time_ms % 1000, time_ms / 1000);
    let (s, min, h) = (s % 60, s / 60 % 60, s / 3600);
    if h > 0 {
        format!("{h}:{min:02}:{s:02}.{ms:03}")
    } else {
        format!("{min:02}:{s:02}.{ms:03}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minus_is_a_minus_sign_and_never_on_zero() {
        assert_eq!(with_unit(-3.04, 1, "dB"), "−3.0 dB");
        assert_eq!(fixed(-0.01, 1), "0.0");
        assert_eq!(fixed(f64::NEG_INFINITY, 1), "−∞");
    }

    #[test]
    fn gain_and_level_undo_each_other() {
        assert!(
            (level_db(factor_of_gain(-7.5)) + 7.5).abs() < 1e-12,
            "dB round trip"
        );
        assert_eq!(factor_of_gain(f64::NEG_INFINITY), 0.0);
    }

    #[test]
    fn time_spans_choose_their_unit() {
        assert_eq!(time_span(2.5e-7), "250 ns");
        assert_eq!(time_span(0.0125), "12.50 ms");
    }

    #[test]
    fn a_clock_shows_hours_only_when_there_are_any() {
        assert_eq!(clock(0), "00:00.000");
        assert_eq!(clock(12_350), "00:12.350");
        assert_eq!(clock(3_599_975), "59:59.975");
        assert_eq!(clock(3_612_350), "1:00:12.350");
    }
}
