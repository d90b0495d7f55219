//! Samples for a device that plays them (mode B): the drive waveform of every tick, from codes.
//!
//! The waveform is that of [`DriveSynth`], which WAV files have too; the amplitudes are codes, so
//! that every limit and the soft start are in them. A code of 65535 is a sample of 32767.

use crate::render::RenderError;
use crate::render::array::DriveSynth;

/// Ticks a second.
const TICKS_PER_S: u32 = 40;
/// The code of full drive.
const FULL_CODE: f64 = 65535.0;

/// Makes the samples of one tick after another.
#[derive(Debug, Clone)]
pub struct SampleSynth {
    drive: DriveSynth,
    per_tick: u32,
    amplitudes: Vec<[f32; 2]>,
    wave: Vec<f32>,
    samples: Vec<i16>,
}

impl SampleSynth {
    /// A synthesizer of `rate_hz` samples a second for `n_channels` channels, silent.
    ///
    /// # Errors
    /// A rate at which a tick is no whole number of samples, or that [`DriveSynth`] refuses; no
    /// channel.
    pub fn prepare(rate_hz: u32, n_channels: usize) -> Result<Self, RenderError> {
        if !rate_hz.is_multiple_of(TICKS_PER_S) {
            return Err(RenderError::Drive {
                key: "rate_hz",
                value: f64::from(rate_hz),
                mend: "give a multiple of 40 Hz",
            });
        }
        let drive = DriveSynth::prepare(rate_hz, n_channels, FULL_CODE)?;
        let per_tick = rate_hz / TICKS_PER_S;
        let n_values = usize::try_from(per_tick).unwrap_or(0) * n_channels;
        Ok(Self {
            drive,
            per_tick,
            amplitudes: vec![[0.0; 2]; n_channels],
            wave: vec![0.0; n_values],
            samples: vec![0; n_values],
        })
    }

    /// The number of a tick's first sample; wraps as it does on the wire.
    pub fn first_of(&self, tick: u32) -> u32 {
        tick.wrapping_mul(self.per_tick)
    }

    /// The samples of the next tick, interleaved. Allocates nothing.
    pub fn tick(&mut self, codes: &[[u16; 2]]) -> &[i16] {
        for (amplitude, code) in self.amplitudes.iter_mut().zip(codes) {
            *amplitude = code.map(f32::from);
        }
        self.drive.set_amplitudes(&self.amplitudes);
        self.drive.fill(&mut self.wave);
        for (sample, value) in self.samples.iter_mut().zip(&self.wave) {
            *sample = sample_of(*value);
        }
        &self.samples
    }
}

#[expect(clippy::cast_possible_truncation, reason = "clamped before the cast")]
fn sample_of(value: f32) -> i16 {
    (value.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16
}

#[cfg(test)]
mod tests;
