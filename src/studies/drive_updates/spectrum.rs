//! The long spectrum of a drive waveform, its energy outside the bands, and the level of each tick.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::{Complex, RealTransform};
use selvedge_textile::tactile::Band;

use super::writer::{RATE_HZ, TICK_SAMPLES};

/// Half the width of a band, octaves.
const HALF_OCTAVES: f64 = 0.5;
/// Cells of a plotted spectrum an octave.
const CELLS_PER_OCTAVE: f64 = 12.0;
/// The lowest frequency that is plotted, Hz.
const LOWEST_HZ: f64 = 5.0;

/// One-sided power by frequency.
#[derive(Debug, Clone)]
pub(super) struct Spectrum {
    powers: Vec<f64>,
    spacing_hz: f64,
}

impl Spectrum {
    /// Of all samples at once, behind a Blackman window: side lobes below −58 dB that fall by 18 dB
    /// an octave.
    pub(super) fn of(samples: &[f32]) -> Self {
        let n = samples.len();
        let windowed = |(i, sample): (usize, &f32)| {
            let turn = TAU * i as f64 / n as f64;
            f64::from(*sample) * (0.42 - 0.5 * turn.cos() + 0.08 * (2.0 * turn).cos())
        };
        let windowed: Vec<f64> = samples.iter().enumerate().map(windowed).collect();
        let spectrum = RealTransform::new(n.max(2)).forward(&windowed);
        Self {
            powers: spectrum.iter().map(Complex::norm_sqr).collect(),
            spacing_hz: RATE_HZ as f64 / n.max(2) as f64,
        }
    }

    /// Energy outside ±½ octave around 40 and 320 Hz over the energy inside.
    pub(super) fn out_of_band(&self) -> f64 {
        let [inside, outside] = self.in_and_out_of_band();
        outside / inside
    }

    fn in_and_out_of_band(&self) -> [f64; 2] {
        let is_in_band = |frequency_hz: f64| {
            let off = |band: Band| (frequency_hz / band.carrier_hz()).log2().abs();
            Band::ALL.into_iter().any(|band| off(band) <= HALF_OCTAVES)
        };
        let [mut inside, mut outside] = [0.0; 2];
        for (k, power) in self.powers.iter().enumerate() {
            if is_in_band(k as f64 * self.spacing_hz) {
                inside += power;
            } else {
                outside += power;
            }
        }
        [inside, outside]
    }

    /// Energy above 640 Hz, an octave above the higher carrier, over the energy in the bands.
    pub(super) fn above_640_hz(&self) -> f64 {
        let cells = self.powers.iter().enumerate();
        let above = cells.filter(|(k, _)| *k as f64 * self.spacing_hz > 640.0);
        above.map(|cell| cell.1).sum::<f64>() / self.in_and_out_of_band()[0]
    }

    /// `[frequency in Hz, level in dB re the loudest cell]`: power summed in cells of a twelfth of
    /// an octave.
    pub(super) fn cells_db(&self) -> Vec<[f64; 2]> {
        let ratio = (1.0 / CELLS_PER_OCTAVE).exp2();
        let mut sums: Vec<[f64; 2]> = Vec::new();
        let mut low_hz = LOWEST_HZ;
        let mut powers = (0..)
            .map(|k: u32| f64::from(k) * self.spacing_hz)
            .zip(&self.powers);
        let mut next = powers.find(|(frequency_hz, _)| *frequency_hz >= LOWEST_HZ);
        while let Some((frequency_hz, power)) = next {
            while frequency_hz >= low_hz * ratio {
                low_hz *= ratio;
            }
            let middle_hz = low_hz * ratio.sqrt();
            match sums.last_mut() {
                Some(last) if last[0] >= middle_hz => last[1] += power,
                _ => sums.push([middle_hz, *power]),
            }
            next = powers.next();
        }
        let loudest = sums.iter().map(|cell| cell[1]).fold(0.0, f64::max);
        sums.iter()
            .map(|[hz, power]| [*hz, 10.0 * (power / loudest).log10()])
            .collect()
    }
}

/// `[A40, A320]` that sounded in each tick: the Fourier coefficients of its samples. Both carriers
/// have whole cycles in a tick, so neither leaks into the other.
pub(super) fn sounded(samples: &[f32]) -> Vec<[f64; 2]> {
    let of_tick = |tick: &[f32]| {
        [1.0, 8.0].map(|cycles| {
            let turn = TAU * cycles / TICK_SAMPLES as f64;
            let products = tick
                .iter()
                .enumerate()
                .map(|(m, sample)| f64::from(*sample) * (turn * m as f64).sin());
            2.0 * products.sum::<f64>() / TICK_SAMPLES as f64
        })
    };
    samples.chunks_exact(TICK_SAMPLES).map(of_tick).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(frequency_hz: f64, amplitude: f64) -> Vec<f32> {
        let sample = |m: u32| {
            let value = amplitude * (TAU * frequency_hz * f64::from(m) / RATE_HZ as f64).sin();
            #[expect(clippy::cast_possible_truncation, reason = "a sample")]
            let value = value as f32;
            value
        };
        (0..48_000).map(sample).collect()
    }

    #[test]
    fn a_tone_in_a_band_has_nothing_outside_and_one_between_has_nothing_inside() {
        assert!(
            Spectrum::of(&tone(320.0, 1.0)).out_of_band() < 1e-9,
            "in band"
        );
        assert!(
            Spectrum::of(&tone(120.0, 1.0)).out_of_band() > 1e9,
            "between"
        );
        let both: Vec<f32> = tone(40.0, 1.0)
            .iter()
            .zip(tone(1000.0, 0.1))
            .map(|(a, b)| a + b)
            .collect();
        let out_of_band = Spectrum::of(&both).out_of_band();
        assert!(
            (out_of_band / 0.01 - 1.0).abs() < 1e-3,
            "−20 dB: {out_of_band}"
        );
    }

    #[test]
    fn the_loudest_cell_is_the_tones() {
        let cells = Spectrum::of(&tone(320.0, 0.3)).cells_db();
        let loudest = cells.iter().find(|cell| cell[1] == 0.0).unwrap();
        assert!(
            (loudest[0] / 320.0).log2().abs() < 1.0 / 12.0,
            "{loudest:?}"
        );
    }

    #[test]
    fn a_tick_of_a_tone_has_its_amplitude() {
        for [low, high] in sounded(&tone(320.0, 0.7)) {
            assert!(
                low.abs() < 1e-6 && (high - 0.7).abs() < 1e-6,
                "{low}, {high}"
            );
        }
    }
}
