//! A noise that covers what contactors can be heard by, as a sound file for any player.
//!
//! Contactors are heard at their carriers (40 and 320 Hz), at multiples of them up to some kHz, and
//! as a rustle where amplitudes change from tick to tick. The noise fills that band, 30 Hz to
//! 6 kHz: pink, as strong in every third of an octave, so that it covers all of it with the least
//! loudness; or white, for a device that rings high up. It is made in the frequency domain, from
//! lines with random phases and a period of one minute: where the file ends it goes on as it
//! began, and a player that repeats it makes no click.

use std::io::{self, Write as _};
use std::path::Path;

use super::ExperimentError;
use super::named::named;
use selvedge_engine::{SOUND_RATE_HZ, SoundSource};
use selvedge_foundation::files::{FileError, Staged};
use selvedge_foundation::numerics::{Complex, Random, RealTransform, to_whole};
use selvedge_foundation::progress::Progress;
use selvedge_render::single;

/// Samples per second.
pub(crate) const NOISE_RATE_HZ: u32 = SOUND_RATE_HZ;
/// The noise repeats itself after so long, s: nobody notices.
const PERIOD_S: u32 = 60;
/// What is filled, Hz.
const BAND_HZ: [f64; 2] = [30.0, 6_000.0];
/// Beyond the band the noise falls to nothing within this ratio of frequencies: a third of an
/// octave.
const EDGE: f64 = 1.259_921_049_894_873_2;
/// Root mean square, of full scale: −20 dB, which leaves room for peaks.
const RMS: f64 = 0.1;
/// The longest fade, s.
pub(crate) const LONGEST_FADE_S: f64 = 30.0;

named! { "colour",
    /// How the power of a noise lies over frequency.
    #[derive(Default)]
    pub enum Colour {
        /// As much in every third of an octave.
        #[default]
        Pink = "pink",
        /// As much in every Hz.
        White = "white",
    }
}

/// A masking noise that is to be written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaskingNoise {
    /// Its colour.
    pub colour: Colour,
    /// What its phases come from.
    pub seed: u64,
    /// How long the file lasts, minutes.
    pub minutes: u16,
    /// How long it fades in at its beginning and out at its end, s; 0 for a file that is repeated.
    pub fade_s: f64,
}

impl Default for MaskingNoise {
    fn default() -> Self {
        Self {
            colour: Colour::Pink,
            seed: 1,
            minutes: 10,
            fade_s: 0.0,
        }
    }
}

/// A masking noise as it is played: the same on both sides, again and again without a seam.
#[derive(Debug)]
pub struct NoiseSound {
    period: Vec<f32>,
    next: usize,
}

impl SoundSource for NoiseSound {
    fn fill(&mut self, frames: &mut [[f32; 2]]) {
        for frame in frames {
            *frame = [self.period.get(self.next).copied().unwrap_or_default(); 2];
            self.next = (self.next + 1) % self.period.len().max(1);
        }
    }
}

impl MaskingNoise {
    /// The longest file, minutes.
    pub const MOST_MINUTES: u16 = 120;

    /// Its level, rms, dB re full scale.
    pub const LEVEL_DB: f64 = -20.0;

    /// The samples of its file, to be played. Takes a moment.
    pub fn sound(&self) -> NoiseSound {
        let period = self.period().into_iter().map(single).collect();
        NoiseSound { period, next: 0 }
    }

    /// Writes it: one channel of 16 bits. A file that was there is replaced once this one is whole.
    ///
    /// # Errors
    /// It is too long or not at all, it cannot be written, or the work was cancelled.
    pub fn write(&self, path: &Path, progress: &mut Progress<'_>) -> Result<(), ExperimentError> {
        self.check()?;
        let stop = |_| ExperimentError::value("the noise was cancelled", "write it again");
        progress.step(0.0, "noise").map_err(stop)?;
        let period = self.period();
        let wrong = |source: io::Error| FileError::Write {
            path: path.to_owned(),
            source,
        };
        let staged = Staged::new(path);
        let mut out = staged.create().map_err(wrong)?;
        let n_samples = u64::from(self.minutes) * u64::from(60 * NOISE_RATE_HZ);
        out.write_all(&header(n_samples)).map_err(wrong)?;
        for minute in 0..self.minutes {
            let share = f64::from(minute + 1) / f64::from(self.minutes);
            progress.step(share, "noise").map_err(stop)?;
            let bytes = self.minute(minute, &period);
            out.write_all(&bytes).map_err(wrong)?;
        }
        staged.finish(out)?;
        Ok(())
    }

    fn check(&self) -> Result<(), ExperimentError> {
        if !(1..=Self::MOST_MINUTES).contains(&self.minutes) {
            let what = format!("the noise lasts {} minutes", self.minutes);
            let mend = format!("give 1 to {}: it is to be repeated", Self::MOST_MINUTES);
            return Err(ExperimentError::value(what, mend));
        }
        if !(0.0..=LONGEST_FADE_S).contains(&self.fade_s) {
            let what = format!("the noise fades for {} s", self.fade_s);
            let mend = format!("give 0 to {LONGEST_FADE_S} s");
            return Err(ExperimentError::value(what, mend));
        }
        Ok(())
    }

    /// One period, of full scale 1.
    fn period(&self) -> Vec<f64> {
        let n = (PERIOD_S * NOISE_RATE_HZ) as usize;
        let mut random = Random::new(self.seed).branch("masking noise");
        let line_hz = 1.0 / f64::from(PERIOD_S);
        let spectrum: Vec<Complex> = (0..=n / 2)
            .map(|k| {
                let phase = random.uniform_in(0.0, std::f64::consts::TAU);
                Complex::from_polar(self.magnitude(k as f64 * line_hz), phase)
            })
            .collect();
        let mut samples = RealTransform::new(n).inverse(&spectrum);
        let power = samples.iter().map(|x| x * x).sum::<f64>() / n as f64;
        let scale = RMS / power.sqrt();
        for x in &mut samples {
            *x *= scale;
        }
        samples
    }

    /// Magnitude of the line at a frequency, without unit.
    fn magnitude(&self, hz: f64) -> f64 {
        let [low, high] = BAND_HZ;
        let octaves_out = (low / hz).log2().max((hz / high).log2());
        let share_out = octaves_out / EDGE.log2();
        let edge = match share_out {
            out if out <= 0.0 => 1.0,
            out if out < 1.0 => 0.5 + 0.5 * (std::f64::consts::PI * out).cos(),
            _ => return 0.0,
        };
        match self.colour {
            Colour::Pink => edge / hz.sqrt(),
            Colour::White => edge,
        }
    }

    /// One minute of the file, as its bytes.
    fn minute(&self, nth: u16, period: &[f64]) -> Vec<u8> {
        let before = f64::from(nth) * f64::from(PERIOD_S);
        let end_s = f64::from(self.minutes) * f64::from(PERIOD_S);
        let samples = period.iter().enumerate();
        let faded = samples.map(|(at, x)| {
            let t_s = before + at as f64 / f64::from(NOISE_RATE_HZ);
            x * self.gain(t_s.min(end_s - t_s))
        });
        faded.flat_map(|x| quantised(x).to_le_bytes()).collect()
    }

    /// Gain at this time from the nearer end.
    fn gain(&self, from_end_s: f64) -> f64 {
        if from_end_s >= self.fade_s {
            return 1.0;
        }
        0.5 - 0.5 * (std::f64::consts::PI * from_end_s / self.fade_s).cos()
    }
}

fn quantised(x: f64) -> i16 {
    to_whole((x.clamp(-1.0, 1.0) * f64::from(i16::MAX)).round())
}

/// The plain header of one channel of 16 bits, which every player reads.
fn header(n_samples: u64) -> Vec<u8> {
    let n_bytes = u32::try_from(2 * n_samples).unwrap_or(u32::MAX);
    let mut header = Vec::with_capacity(44);
    header.extend(b"RIFF");
    header.extend(n_bytes.saturating_add(36).to_le_bytes());
    header.extend(b"WAVEfmt ");
    header.extend(16_u32.to_le_bytes());
    // PCM, one channel.
    header.extend(1_u16.to_le_bytes());
    header.extend(1_u16.to_le_bytes());
    header.extend(NOISE_RATE_HZ.to_le_bytes());
    header.extend((2 * NOISE_RATE_HZ).to_le_bytes());
    // Bytes of a frame, bits of a sample.
    header.extend(2_u16.to_le_bytes());
    header.extend(16_u16.to_le_bytes());
    header.extend(b"data");
    header.extend(n_bytes.to_le_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::tests::Folder;
    use selvedge_foundation::progress::Progress;

    fn written(folder: &Folder, noise: MaskingNoise) -> Vec<f64> {
        std::fs::create_dir_all(&folder.0).unwrap();
        let path = folder.0.join("noise.wav");
        Progress::unheard(|progress| noise.write(&path, progress)).unwrap();
        let mut reader = hound::WavReader::open(&path).unwrap();
        let spec = reader.spec();
        assert_eq!(
            (spec.channels, spec.sample_rate, spec.bits_per_sample),
            (1, 48_000, 16)
        );
        let samples = reader.samples::<i16>();
        samples.map(|x| f64::from(x.unwrap()) / 32_767.0).collect()
    }

    /// Power within some frequencies, of the whole file.
    fn power(spectrum: &[Complex], seconds: f64, [low, high]: [f64; 2]) -> f64 {
        let lines = spectrum.iter().enumerate();
        let within = lines.filter(|(k, _)| (low..high).contains(&(*k as f64 / seconds)));
        within.map(|(_, x)| x.norm_sqr()).sum()
    }

    #[test]
    fn every_third_of_an_octave_of_the_band_is_filled_alike_and_nothing_beyond() {
        let noise = MaskingNoise {
            minutes: 1,
            ..MaskingNoise::default()
        };
        let samples = written(&Folder::new("noise-pink"), noise);
        assert_eq!(samples.len(), 60 * 48_000);
        let rms = (samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64).sqrt();
        assert!((rms - 0.1).abs() < 1e-3, "{rms}");
        let peak = samples.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
        assert!((0.3..0.9).contains(&peak), "{peak}");
        let spectrum = RealTransform::new(samples.len()).forward(&samples);
        let third = |hz: f64| power(&spectrum, 60.0, [hz / 1.1225, hz * 1.1225]);
        for hz in [40.0, 80.0, 320.0, 640.0, 1280.0, 5000.0] {
            let off_db = 10.0 * (third(hz) / third(1000.0)).log10();
            assert!(off_db.abs() < 0.5, "{hz} Hz: {off_db} dB");
        }
        let beyond =
            power(&spectrum, 60.0, [8_000.0, 24_000.0]) + power(&spectrum, 60.0, [0.0, 20.0]);
        let all = power(&spectrum, 60.0, [0.0, 24_000.0]);
        assert!(10.0 * (beyond / all).log10() < -60.0);
    }

    #[test]
    fn a_noise_that_is_repeated_has_no_seam_and_comes_again_by_its_seed() {
        let noise = |seed, fade_s| MaskingNoise {
            seed,
            minutes: 1,
            fade_s,
            ..MaskingNoise::default()
        };
        let samples = written(&Folder::new("noise-seam"), noise(7, 0.0));
        let steps: Vec<f64> = samples
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .collect();
        let largest = steps.iter().fold(0.0_f64, |most, step| most.max(*step));
        let seam = (samples[0] - samples[samples.len() - 1]).abs();
        assert!(seam < largest, "{seam} {largest}");
        let again = written(&Folder::new("noise-again"), noise(7, 0.0));
        let other = written(&Folder::new("noise-other"), noise(8, 0.0));
        assert!(samples == again && samples != other);
        let faded = written(&Folder::new("noise-fade"), noise(7, 2.0));
        assert!(faded[0].abs() < 1e-4 && faded[faded.len() - 1].abs() < 1e-4);
        assert!(faded[3 * 48_000..57 * 48_000] == samples[3 * 48_000..57 * 48_000]);
    }

    #[test]
    fn what_is_played_is_what_is_written_on_both_sides_again_and_again() {
        let noise = MaskingNoise {
            minutes: 2,
            ..MaskingNoise::default()
        };
        let file = written(&Folder::new("noise-played"), noise);
        let mut sound = noise.sound();
        let mut frames = vec![[9.0; 2]; 7919];
        let mut n_played = 0;
        while n_played < file.len() {
            sound.fill(&mut frames);
            for ([left, right], sample) in frames.iter().zip(&file[n_played..]) {
                assert!(left == right && (f64::from(*left) - sample).abs() < 2e-5);
            }
            n_played += frames.len();
        }
        let rms = (file.iter().map(|x| x * x).sum::<f64>() / file.len() as f64).sqrt();
        assert!((20.0 * rms.log10() - MaskingNoise::LEVEL_DB).abs() < 0.01);
    }

    #[test]
    fn a_noise_of_no_length_is_refused_and_nothing_is_written() {
        let folder = Folder::new("noise-none");
        std::fs::create_dir_all(&folder.0).unwrap();
        let path = folder.0.join("noise.wav");
        for (minutes, fade_s) in [(0, 0.0), (500, 0.0), (1, f64::NAN), (1, -1.0)] {
            let noise = MaskingNoise {
                minutes,
                fade_s,
                ..MaskingNoise::default()
            };
            let error = Progress::unheard(|progress| noise.write(&path, progress)).unwrap_err();
            assert!(error.to_string().contains("give"), "{error}");
        }
        assert!(!path.exists());
    }
}
