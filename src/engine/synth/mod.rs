//! Samples for a device that plays them (mode B): the drive waveform of every tick, from codes.
//!
//! The waveform is that of [`DriveSynth`], which WAV files have too; the amplitudes are codes, so
//! that every limit and the soft start are in them. A code of 65535 is a sample of 32767.

use selvedge_device::Waveform;
use selvedge_render::RenderError;
use selvedge_render::array::DriveSynth;

/// Ticks a second.
const TICKS_PER_S: u32 = 40;
/// The code of full drive.
const FULL_CODE: f64 = 65535.0;

/// Makes the samples of one tick after another.
#[derive(Debug, Clone)]
pub(crate) struct SampleSynth {
    drive: DriveSynth,
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
    pub(crate) fn prepare(rate_hz: u32, n_channels: usize) -> Result<Self, RenderError> {
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
            amplitudes: vec![[0.0; 2]; n_channels],
            wave: vec![0.0; n_values],
            samples: vec![0; n_values],
        })
    }

    /// The samples of the next tick, interleaved. Allocates nothing.
    pub(crate) fn tick(&mut self, codes: &[[u16; 2]]) -> &[i16] {
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

/// The waveform for a device whose rate is not known yet.
#[derive(Debug, Default)]
pub struct DeviceWaveform(Option<SampleSynth>);

impl Waveform for DeviceWaveform {
    fn prepare(&mut self, rate_hz: u32, n_channels: usize) -> bool {
        self.0 = SampleSynth::prepare(rate_hz, n_channels).ok();
        self.0.is_some()
    }

    fn tick(&mut self, codes: &[[u16; 2]]) -> &[i16] {
        match &mut self.0 {
            Some(synth) => synth.tick(codes),
            None => &[],
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "clamped before the cast")]
fn sample_of(value: f32) -> i16 {
    (value.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16
}

#[cfg(test)]
mod tests;
