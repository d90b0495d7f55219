//! The drive waveform: amplitudes of 40 ticks a second as samples for every contactor.
//!
//! `s(t) = A40 sin(2π·40 t) + A320 sin(2π·320 t)`. New amplitudes take effect at ticks t = n/40 s,
//! where both sines cross zero upwards, so the waveform stays continuous and the carriers keep
//! their phase for ever: the table of a carrier is periodic in whole samples at every rate. Sample
//! m at rate r belongs to tick ⌊40 m/r⌋, also where a tick is no whole number of samples.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::{RenderError, single};
use selvedge_textile::tactile::Band;

/// Ticks a second.
const TICKS_PER_S: u64 = 40;
/// Highest sample rate, Hz.
const MAX_RATE_HZ: u32 = 1_000_000;

/// Writes the drive waveform of any number of channels, interleaved.
#[derive(Debug, Clone)]
pub struct DriveSynth {
    rate_hz: u64,
    /// One common period of both carriers: `[sin 2π40t, sin 2π320t]` a sample.
    carriers: Vec<[f32; 2]>,
    /// Where in the period the next sample lies.
    place: usize,
    /// The next sample to write.
    next_sample: u64,
    /// The first sample of the next tick.
    next_tick_sample: u64,
    /// The amplitudes that sound, 40 Hz and 320 Hz, in units of the scale.
    sounding: [Vec<f32>; 2],
    /// The amplitudes that take effect at the next tick.
    waiting: [Vec<f32>; 2],
    per_um: f64,
}

impl DriveSynth {
    /// A synthesizer at `rate_hz` samples a second for `n_channels` channels; sample 1.0 stands for
    /// `full_scale_um` µm. Starts silent, at sample 0.
    ///
    /// # Errors
    /// A rate of 0 or above 1 MHz; a scale that is not finite and positive; no channel.
    pub fn prepare(
        rate_hz: u32,
        n_channels: usize,
        full_scale_um: f64,
    ) -> Result<Self, RenderError> {
        let refuse = |key, value, mend| Err(RenderError::Drive { key, value, mend });
        if !(1..=MAX_RATE_HZ).contains(&rate_hz) {
            return refuse("rate_hz", f64::from(rate_hz), "give 1 to 1000000 Hz");
        }
        if n_channels == 0 {
            return refuse("channels", 0.0, "give at least one");
        }
        if !(full_scale_um > 0.0 && full_scale_um.is_finite()) {
            return refuse(
                "full_scale_um",
                full_scale_um,
                "give a finite number above 0",
            );
        }
        let silence = || [vec![0.0; n_channels], vec![0.0; n_channels]];
        Ok(Self {
            rate_hz: u64::from(rate_hz),
            carriers: carriers(rate_hz),
            place: 0,
            next_sample: 0,
            next_tick_sample: 0,
            sounding: silence(),
            waiting: silence(),
            per_um: 1.0 / full_scale_um,
        })
    }

    /// Back to sample 0, silent.
    pub fn reset(&mut self) {
        (self.place, self.next_sample, self.next_tick_sample) = (0, 0, 0);
        for amplitudes in self.sounding.iter_mut().chain(&mut self.waiting) {
            amplitudes.fill(0.0);
        }
    }

    /// Number of channels.
    pub fn n_channels(&self) -> usize {
        self.waiting[0].len()
    }

    /// The next sample that [`DriveSynth::fill`] writes.
    pub fn next_sample(&self) -> u64 {
        self.next_sample
    }

    /// The samples of a tick: all m with ⌊40 m/r⌋ = `tick`.
    pub fn samples_of_tick(&self, tick: u64) -> Range<u64> {
        let first = |tick: u64| tick.saturating_mul(self.rate_hz).div_ceil(TICKS_PER_S);
        first(tick)..first(tick.saturating_add(1))
    }

    /// Takes amplitudes `[A40, A320]` in µm, one pair a channel, for the next tick boundary (the
    /// very next sample, if that is one). Channels without a pair fall silent; an amplitude that
    /// is not finite counts as 0. Setting twice before a boundary keeps the later.
    pub fn set_amplitudes(&mut self, amplitudes_um: &[[f32; 2]]) {
        let [low, high] = &mut self.waiting;
        let mut given = amplitudes_um.iter();
        for (low, high) in low.iter_mut().zip(high) {
            let pair = given.next().copied().unwrap_or_default();
            let scaled = pair.map(|um| single(f64::from(um) * self.per_um));
            let [a, b] = scaled.map(|a| if a.is_finite() { a } else { 0.0 });
            (*low, *high) = (a, b);
        }
    }

    /// Writes the next frames: `out` holds channel 0, 1, … of the first frame, then of the next.
    /// A last part of `out` too short for a frame is set to 0. Neither allocates nor fails.
    pub fn fill(&mut self, out: &mut [f32]) {
        let n_channels = self.n_channels();
        let whole = out.len() - out.len() % n_channels;
        let (mut frames, rest) = out.split_at_mut(whole);
        rest.fill(0.0);
        while !frames.is_empty() {
            if self.next_sample == self.next_tick_sample {
                self.begin_tick();
            }
            let n_frames = (frames.len() / n_channels)
                .min(
                    usize::try_from(self.next_tick_sample - self.next_sample).unwrap_or(usize::MAX),
                )
                .min(self.carriers.len() - self.place);
            let (now, later) = frames.split_at_mut(n_frames * n_channels);
            let carriers = &self.carriers[self.place..self.place + n_frames];
            write_frames(now, carriers, &self.sounding);
            self.next_sample += n_frames as u64;
            self.place = (self.place + n_frames) % self.carriers.len();
            frames = later;
        }
    }

    fn begin_tick(&mut self) {
        for (sounding, waiting) in self.sounding.iter_mut().zip(&self.waiting) {
            sounding.copy_from_slice(waiting);
        }
        let tick = self.next_sample.saturating_mul(TICKS_PER_S) / self.rate_hz;
        self.next_tick_sample = self.samples_of_tick(tick).end;
    }
}

/// Both carriers over one common period: `r / gcd(40, r)` samples.
fn carriers(rate_hz: u32) -> Vec<[f32; 2]> {
    let low_hz = TICKS_PER_S;
    let rate = u64::from(rate_hz);
    let period = rate / greatest_common_divisor(low_hz, rate);
    let phase = |m: u64, cycles: u64| (m * cycles * low_hz % rate) as f64 / rate as f64;
    // 320 Hz is the eighth harmonic: phases are exact fractions, however late the sample.
    let harmonics = Band::ALL.map(|band| if band == Band::Low { 1 } else { 8 });
    let sines = |m: u64| harmonics.map(|cycles| single((TAU * phase(m, cycles)).sin()));
    (0..period).map(sines).collect()
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

/// `out[frame][channel] = low[channel]·c40[frame] + high[channel]·c320[frame]`.
fn write_frames(out: &mut [f32], carriers: &[[f32; 2]], [low, high]: &[Vec<f32>; 2]) {
    for (frame, &[c_low, c_high]) in out.chunks_exact_mut(low.len()).zip(carriers) {
        for ((sample, low), high) in frame.iter_mut().zip(low).zip(high) {
            *sample = low * c_low + high * c_high;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(m: u64, rate_hz: u32, [low, high]: [f64; 2]) -> f64 {
        let t = m as f64 / f64::from(rate_hz);
        low * (TAU * 40.0 * t).sin() + high * (TAU * 320.0 * t).sin()
    }

    #[test]
    fn every_sample_has_the_amplitudes_of_its_tick_at_any_rate() {
        let of_tick = |tick: u64| [[1.0 + tick as f32, 20.0 - tick as f32], [0.5, tick as f32]];
        for rate_hz in [8_000, 44_100, 48_000, 22_050, 96_000, 997, 41, 40, 7] {
            let mut synth = DriveSynth::prepare(rate_hz, 2, 50.0).unwrap();
            let n_ticks = 9;
            let mut written = Vec::new();
            for tick in 0..n_ticks {
                synth.set_amplitudes(&of_tick(tick));
                let samples = synth.samples_of_tick(tick);
                let mut block =
                    vec![9.0; 2 * usize::try_from(samples.end - samples.start).unwrap()];
                synth.fill(&mut block);
                written.extend(block);
            }
            assert_eq!(
                written.len() as u64 / 2,
                (n_ticks * u64::from(rate_hz)).div_ceil(40)
            );
            for (index, sample) in written.iter().enumerate() {
                let (m, channel) = (index as u64 / 2, index % 2);
                let amplitudes = of_tick(40 * m / u64::from(rate_hz))[channel].map(f64::from);
                let expected = exact(m, rate_hz, amplitudes) / 50.0;
                // f32 carriers and amplitudes: three roundings of 6e-8 of up to 0.6.
                assert!(
                    (f64::from(*sample) - expected).abs() < 2e-7,
                    "rate {rate_hz}, sample {m}: {sample} for {expected}"
                );
            }
        }
    }

    #[test]
    fn block_sizes_change_no_bit() {
        let run = |block: usize| {
            let mut synth = DriveSynth::prepare(44_100, 3, 1.0).unwrap();
            let mut all = vec![0.0; 3 * 5000];
            for (index, part) in all.chunks_mut(3 * block).enumerate() {
                if index == 0 {
                    synth.set_amplitudes(&[[1.0, 2.0], [3.0, 0.0], [0.0, 0.7]]);
                }
                synth.fill(part);
            }
            all
        };
        let whole = run(5000);
        assert_eq!(run(48), whole);
        assert_eq!(run(1), whole);
    }

    #[test]
    fn the_waveform_stays_continuous_when_amplitudes_jump() {
        let mut synth = DriveSynth::prepare(48_000, 1, 1.0).unwrap();
        let mut before = 0.0_f32;
        for tick in 0..20_u8 {
            synth.set_amplitudes(&[[f32::from(tick % 3), f32::from(tick % 5)]]);
            let mut block = [0.0; 1200];
            synth.fill(&mut block);
            // Steepest slope: 2π(40·2 + 320·4)/48000 a sample.
            assert!(
                (block[0] - before).abs() < 0.19 && block[0].abs() < 1e-5,
                "tick {tick}"
            );
            before = block[1199];
        }
    }

    #[test]
    fn amplitudes_that_are_not_finite_are_silent() {
        let mut synth = DriveSynth::prepare(8_000, 3, 50.0).unwrap();
        synth.set_amplitudes(&[[f32::NAN, f32::INFINITY], [1.0, f32::NEG_INFINITY]]);
        let mut block = [1.0; 3 * 200 + 2];
        synth.fill(&mut block);
        assert!(block.iter().all(|s| s.is_finite()), "no NaN leaves");
        assert_eq!(block[3], 0.0);
        assert_eq!(block[3 * 200..], [0.0; 2]);
    }

    #[test]
    fn senseless_rates_and_scales_are_refused() {
        for (rate_hz, n_channels, scale) in [
            (0, 1, 1.0),
            (2_000_000, 1, 1.0),
            (48_000, 0, 1.0),
            (48_000, 1, f64::NAN),
        ] {
            assert!(
                DriveSynth::prepare(rate_hz, n_channels, scale).is_err(),
                "{rate_hz}"
            );
        }
    }
}
