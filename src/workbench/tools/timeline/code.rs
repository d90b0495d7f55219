//! Levels and speeds as the bytes of tiles: 0 is a gap, 1 is silence or rest, and the larger the
//! byte the stronger or faster.

use std::array;

use crate::bench::on_finger::OnFinger;
use selvedge_foundation::numerics::to_byte;
use selvedge_foundation::quantity;

/// Nothing is known.
pub(crate) const GAP: u8 = 0;
/// Nothing sounds.
pub(crate) const SILENT: u8 = 1;
/// The weakest level that is told from silence, dB re 1 µm.
const LEAST_DB: f64 = -80.0;
/// From a level to the next, dB.
const STEP_DB: f64 = 0.5;
/// The fastest that is told apart: beyond it nothing is felt, mm/s.
const FASTEST_MM_PER_S: f64 = 4348.0;

/// What the finger may get at a tick, from least to most.
const FINGER: [OnFinger; 3] = [OnFinger::Held, OnFinger::ShownOnly, OnFinger::Felt];

/// The byte of a level, dB re 1 µm: the nearest of −80, −79.5 … 46.5.
pub(crate) fn level_code(level_db: f64) -> u8 {
    if level_db.is_nan() {
        return GAP;
    }
    let place = 2.0 + ((level_db - LEAST_DB) / STEP_DB).round();
    to_byte(if place < 2.0 { 1.0 } else { place })
}

/// The byte of an amplitude, µm.
pub(crate) fn amplitude_code(um: f32) -> u8 {
    level_code(quantity::level_db(f64::from(um)))
}

/// The level that a byte stands for, dB re 1 µm; −∞ for silence, `None` for a gap.
pub(crate) fn level_of(code: u8) -> Option<f64> {
    match code {
        GAP => None,
        SILENT => Some(f64::NEG_INFINITY),
        code => Some(LEAST_DB + STEP_DB * f64::from(code - 2)),
    }
}

/// The byte of a speed, mm/s: finer where it is slow.
pub(crate) fn speed_code(speed_mm_per_s: f64) -> u8 {
    let share = (speed_mm_per_s / FASTEST_MM_PER_S).clamp(0.0, 1.0);
    to_byte(1.0 + (254.0 * share.max(0.0).sqrt()).round())
}

/// The speed that a byte stands for, mm/s; `None` for a gap.
pub(crate) fn speed_of(code: u8) -> Option<f64> {
    let share = f64::from(code.checked_sub(1)?) / 254.0;
    Some(FASTEST_MM_PER_S * share * share)
}

/// A byte whose largest tells the least: for the lower ends of lines.
pub(crate) fn mirrored(code: u8) -> u8 {
    if code == GAP { GAP } else { 255 - (code - 1) }
}

/// What each byte is drawn as.
pub(crate) fn table<T>(of: impl Fn(u8) -> T) -> [T; 256] {
    array::from_fn(|code| of(u8::try_from(code).unwrap_or(u8::MAX)))
}

/// What the finger got at a tick; of several ticks the one that it got most of counts.
pub(crate) fn finger_code(on_finger: OnFinger) -> u8 {
    let place = FINGER.iter().position(|one| *one == on_finger);
    place.map_or(GAP, |place| to_byte(1.0 + place as f64))
}

/// What such a code says.
pub(crate) fn finger_of(code: u8) -> Option<OnFinger> {
    FINGER.get(usize::from(code).checked_sub(1)?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_back_to_a_quarter_of_a_db() {
        for tenth in -800..=465 {
            let level_db = f64::from(tenth) / 10.0;
            let back = level_of(level_code(level_db)).unwrap();
            assert!((back - level_db).abs() <= 0.25 + 1e-9, "{level_db}: {back}");
        }
        assert_eq!(level_of(level_code(300.0)), Some(46.5));
    }

    #[test]
    fn silence_and_gaps_are_no_levels() {
        assert_eq!(amplitude_code(0.0), SILENT);
        assert_eq!(level_code(-90.0), SILENT);
        assert_eq!(amplitude_code(f32::NAN), GAP);
        assert_eq!(
            (level_of(SILENT), level_of(GAP)),
            (Some(f64::NEG_INFINITY), None)
        );
    }

    #[test]
    fn speeds_come_back_to_a_few_percent_and_rest_is_rest() {
        for speed in [20.0, 100.0, 350.0, 2_000.0] {
            let back = speed_of(speed_code(speed)).unwrap();
            assert!((back / speed - 1.0).abs() < 0.06, "{speed}: {back}");
        }
        assert_eq!(speed_of(speed_code(0.0)), Some(0.0));
        assert_eq!(speed_of(speed_code(f64::NAN)), Some(0.0));
        assert_eq!(speed_of(GAP), None);
    }

    #[test]
    fn the_largest_mirrored_byte_is_of_the_smallest() {
        for code in 1..=255 {
            assert_eq!(mirrored(mirrored(code)), code);
        }
        assert!(mirrored(3) > mirrored(4) && mirrored(GAP) == GAP);
    }
}
