//! The response of both bands to a surface that moves at one speed.
//!
//! A bin of wavenumber 0.23 k cycles/mm sounds at f = v·0.23·k Hz; the band power is
//! `A_b² = 2 Σ_k P_k H_b(f_k)²` over the bins below 1 kHz.

use super::{Band, Filters};
use crate::surface::{BIN_SPACING_PER_MM, N_BINS};
use selvedge_foundation::numerics::to_whole;

/// Bins at or above this frequency are not rendered, Hz.
pub const MAX_FREQUENCY_HZ: f64 = 1000.0;
/// A velocity component below this is rest, mm/s.
pub const MIN_SPEED_MM_PER_S: f64 = 0.01;
/// At this speed the first bin reaches 1 kHz: from here on nothing sounds, mm/s.
pub const MAX_SPEED_MM_PER_S: f64 = MAX_FREQUENCY_HZ / BIN_SPACING_PER_MM;

/// How many bins sound at a speed: those with `v·0.23·k < 1000` Hz; none at a speed that cannot be
/// felt.
pub fn n_audible_bins(speed_mm_per_s: f64) -> usize {
    if !(MIN_SPEED_MM_PER_S..MAX_SPEED_MM_PER_S).contains(&speed_mm_per_s) {
        return 0;
    }
    let is_audible =
        |&k: &u16| speed_mm_per_s * BIN_SPACING_PER_MM * f64::from(k) < MAX_FREQUENCY_HZ;
    // From the quotient, corrected by the very comparison that defines it.
    let bound = (MAX_FREQUENCY_HZ / (BIN_SPACING_PER_MM * speed_mm_per_s)).min(N_BINS as f64 + 1.0);
    let upper = (to_whole::<u16>(bound) + 1).min(500);
    (1..=upper).rev().find(is_audible).map_or(0, usize::from)
}

/// Both bands' power gains for every bin that sounds at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedResponse {
    power_gains: Vec<[f64; 2]>,
}

impl SpeedResponse {
    /// The response at a speed in mm/s.
    pub fn at(speed_mm_per_s: f64, filters: &Filters) -> Self {
        let gains_of = |k: usize| {
            let frequency_hz = speed_mm_per_s * BIN_SPACING_PER_MM * k as f64;
            Band::ALL.map(|band| filters.power_gain(band, frequency_hz))
        };
        Self {
            power_gains: (1..=n_audible_bins(speed_mm_per_s)).map(gains_of).collect(),
        }
    }

    /// `[H_40², H_320²]` for bins 1, 2, … as far as they sound.
    pub fn power_gains(&self) -> &[[f64; 2]] {
        &self.power_gains
    }

    /// The squared amplitudes `A_b² = 2 Σ P_k H_b²` in µm² that powers in µm² (bin k in slot
    /// k − 1) give.
    pub fn squared_amplitudes_um2(&self, powers_um2: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (power, gains) in powers_um2.iter().zip(&self.power_gains) {
            sums[0] += power * gains[0];
            sums[1] += power * gains[1];
        }
        sums.map(|sum| 2.0 * sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn audible_bins_end_strictly_below_a_kilohertz() {
        assert_eq!(n_audible_bins(100.0), 43);
        assert_eq!(n_audible_bins(8.0), 500);
        assert_eq!(n_audible_bins(4347.0), 1);
        for silent in [
            0.0,
            1e-300,
            0.0099,
            -5.0,
            MAX_SPEED_MM_PER_S,
            f64::INFINITY,
            f64::NAN,
        ] {
            assert_eq!(n_audible_bins(silent), 0, "{silent} mm/s");
        }
        for k in 1..=500_u16 {
            let crossing = MAX_FREQUENCY_HZ / (BIN_SPACING_PER_MM * f64::from(k));
            for speed in [
                crossing,
                crossing.next_down(),
                crossing.next_up(),
                crossing * 0.999,
            ] {
                let by_count = (1..=500_u16)
                    .filter(|&j| speed * BIN_SPACING_PER_MM * f64::from(j) < MAX_FREQUENCY_HZ)
                    .count();
                let expected = if speed < MAX_SPEED_MM_PER_S {
                    by_count
                } else {
                    0
                };
                assert_eq!(n_audible_bins(speed), expected, "{speed} mm/s");
            }
        }
    }

    #[test]
    fn a_line_at_a_carrier_gives_its_amplitude() {
        // Bin 10 at 2.3 cycles/mm sounds at 40 Hz at 17.391 mm/s; power ½ is amplitude 1.
        let mut powers = vec![0.0; 500];
        powers[9] = 0.5;
        let response = SpeedResponse::at(40.0 / 2.3, &Filters::default());
        let [low, high] = response.squared_amplitudes_um2(&powers);
        assert!(
            (low - 1.0).abs() < 1e-12 && (high - 2.0_f64.powi(-9)).abs() < 1e-12,
            "{low} {high}"
        );
    }
}
