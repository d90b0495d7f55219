//! The filters that reduce a vibration spectrum to two amplitudes.
//!
//! The shape of the original's filters is not published in what we could read; both kinds here
//! are reconstructions. Their gain is 1 at the carrier.

use super::Band;

/// Displacement thresholds over frequency, dB re 1 µm peak, large contactor: non-Pacinian.
/// Background values read off well-known curves, ±3 dB.
const NON_PACINIAN_DB: [(f64, f64); 12] = [
    (1.0, 27.0),
    (3.0, 24.0),
    (10.0, 14.0),
    (20.0, 10.0),
    (30.0, 8.0),
    (40.0, 8.0),
    (60.0, 8.0),
    (80.0, 8.0),
    (100.0, 9.0),
    (160.0, 10.0),
    (200.0, 11.0),
    (250.0, 12.0),
];
/// The same for the Pacinian channel.
const PACINIAN_DB: [(f64, f64); 14] = [
    (10.0, 35.0),
    (20.0, 22.0),
    (30.0, 14.0),
    (40.0, 9.0),
    (60.0, 1.0),
    (80.0, -5.0),
    (100.0, -9.0),
    (160.0, -16.0),
    (200.0, -18.0),
    (250.0, -20.0),
    (300.0, -20.0),
    (320.0, -19.0),
    (400.0, -16.0),
    (500.0, -12.0),
];
/// Slope of the non-Pacinian threshold above its table, dB an octave.
const NON_PACINIAN_ABOVE_DB: f64 = 5.0;
/// Slope of the Pacinian threshold below its table, dB an octave.
const PACINIAN_BELOW_DB: f64 = -12.0;

/// A pair of filters, one for each band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filters {
    /// `H_b(f) = 2^(−½ (log₂(f/b) / (octaves/2))²)`.
    LogGaussian {
        /// Width between the half-power points, octaves.
        octaves: f64,
    },
    /// `H_b(f) = 10^((T_b(b) − T_b(f))/20)` with the detection threshold `T_b` of the channel that
    /// the band speaks to: non-Pacinian for 40 Hz, Pacinian for 320 Hz.
    Receptor,
}

impl Default for Filters {
    /// Log-Gaussian, two octaves wide.
    fn default() -> Self {
        Self::LogGaussian { octaves: 2.0 }
    }
}

impl Filters {
    /// Amplitude gain of a band's filter at a frequency in Hz; 1 at the carrier, 0 at 0 Hz.
    pub fn gain(&self, band: Band, frequency_hz: f64) -> f64 {
        self.power_gain(band, frequency_hz).sqrt()
    }

    /// Power gain `H_b(f)²`.
    pub fn power_gain(&self, band: Band, frequency_hz: f64) -> f64 {
        match self {
            Self::LogGaussian { octaves } => {
                let off = (frequency_hz / band.carrier_hz()).log2() / (0.5 * octaves);
                (-off * off).exp2()
            }
            Self::Receptor => {
                let fall_db =
                    threshold_db(band, band.carrier_hz()) - threshold_db(band, frequency_hz);
                10.0_f64.powf(fall_db / 10.0)
            }
        }
    }
}

/// Detection threshold of the channel of a band, dB re 1 µm: linear over log₂ f between table
/// entries, continued beyond them.
pub(super) fn threshold_db(band: Band, frequency_hz: f64) -> f64 {
    let (table, below_db, above_db): (&[_], _, _) = match band {
        Band::Low => (&NON_PACINIAN_DB, None, Some(NON_PACINIAN_ABOVE_DB)),
        Band::High => (&PACINIAN_DB, Some(PACINIAN_BELOW_DB), None),
    };
    let (first, last) = (table[0], table[table.len() - 1]);
    let above = table
        .partition_point(|&(f, _)| f <= frequency_hz)
        .clamp(1, table.len() - 1);
    let (low, high) = (table[above - 1], table[above]);
    let own_slope = (high.1 - low.1) / (high.0 / low.0).log2();
    if frequency_hz < first.0 {
        return first.1 + below_db.unwrap_or(own_slope) * (frequency_hz / first.0).log2();
    }
    if frequency_hz > last.0 {
        return last.1 + above_db.unwrap_or(own_slope) * (frequency_hz / last.0).log2();
    }
    low.1 + own_slope * (frequency_hz / low.0).log2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_gaussian_is_one_at_its_carrier_and_half_power_an_octave_off() {
        let filters = Filters::default();
        for band in Band::ALL {
            let b = band.carrier_hz();
            assert_eq!(filters.power_gain(band, b), 1.0);
            for f in [b * 2.0, b / 2.0] {
                assert!((filters.power_gain(band, f) - 0.5).abs() < 1e-12, "{f} Hz");
            }
            assert_eq!(filters.power_gain(band, 0.0), 0.0);
        }
        // One and a half octaves off, the crossover: gain 2^(−½·2.25) = 0.4585.
        let crossover_hz = (40.0_f64 * 320.0).sqrt();
        assert!(
            (filters.gain(Band::Low, crossover_hz) - 0.458_5).abs() < 1e-3,
            "crossover"
        );
    }

    #[test]
    fn receptor_filters_follow_the_thresholds() {
        let db = |band, f| 20.0 * Filters::Receptor.gain(band, f).log10();
        for (band, f, expected_db) in [
            (Band::Low, 40.0, 0.0),
            (Band::Low, 10.0, -6.0),
            (Band::Low, 500.0, -9.0),
            (Band::Low, 3.0_f64.sqrt(), -17.5),
            (Band::High, 320.0, 0.0),
            (Band::High, 250.0, 1.0),
            (Band::High, 5.0, -66.0),
            (Band::High, 1000.0, -7.0 - 4.0 / 1.25_f64.log2()),
        ] {
            let got = db(band, f);
            assert!(
                (got - expected_db).abs() < 1e-9,
                "{band:?} {f} Hz: {got} dB"
            );
        }
        assert_eq!(Filters::Receptor.gain(Band::Low, 0.0), 0.0);
    }
}
