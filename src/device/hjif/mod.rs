//! MPEG haptics, the interchange format `.hjif` (ISO/IEC 23090-31, JSON): one channel per
//! contactor, one vectorial band per carrier, one basis effect each, one keyframe per 25 ms.
//!
//! The format holds a channel after the other, while ticks come one after the other. So ticks are
//! kept in blocks beside the file ([`Spool`]) and turned round at the end: memory stays the same
//! whatever the length, and the work is in proportion to it.
//!
//! An amplitude modulation of 1 is `full scale · gain` µm peak; the gain of all channels is 1, or
//! what the loudest amplitude needs, so that nothing is cut. Players interpolate linearly between
//! keyframes where a device of our own holds an amplitude for its tick. The date is that of no day:
//! the same exploration makes the same bytes.

mod spool;
#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::SinkError;
use selvedge_foundation::files::{Staged, push_number};
use selvedge_foundation::progress::Progress;
use spool::Spool;

/// The carriers with the ends of their bands, Hz: an octave to each side.
const BANDS: [Band; 2] = [
    Band {
        carrier_hz: 40,
        limits_hz: [20, 80],
    },
    Band {
        carrier_hz: 320,
        limits_hz: [160, 640],
    },
];
/// From keyframe to keyframe, in ticks of the format's scale of 1 ms.
const KEYFRAME_MS: u64 = 25;
/// Channels that level 1 of the profile allows.
const MAX_AT_LEVEL_1: usize = 128;
/// Text that is gathered before it is written, bytes.
const CHUNK: usize = 1 << 16;

struct Band {
    carrier_hz: u32,
    /// Where the band begins and ends, Hz.
    limits_hz: [u32; 2],
}

/// What a file says of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct HjifSpec {
    /// Contactors, a channel each.
    pub n_channels: usize,
    /// `[F40, F320]`: peak displacement in µm that a modulation of 1 stands for at gain 1.
    pub full_scale_um: [f64; 2],
    /// What was explored, for people.
    pub title: String,
}

/// A file being written.
#[derive(Debug)]
pub struct HjifWriter {
    staged: Staged,
    out: BufWriter<File>,
    spec: HjifSpec,
    spool: Spool,
    /// The largest share of full scale so far.
    peak: f64,
}

impl HjifWriter {
    /// A file at `path`.
    pub fn create(path: &Path, spec: HjifSpec) -> Result<Self, SinkError> {
        let staged = Staged::new(path);
        let out = staged.create().map_err(SinkError::place(path))?;
        Ok(Self {
            staged,
            out,
            spool: Spool::beside(path, 2 * spec.n_channels),
            spec,
            peak: 0.0,
        })
    }

    /// Takes a tick: amplitudes [A40, A320] of every channel, µm. What is no number is 0, and so
    /// are channels without a pair.
    pub fn take(&mut self, amplitudes_um: &[[f32; 2]]) -> Result<(), SinkError> {
        let mut given = amplitudes_um.iter();
        for _ in 0..self.spec.n_channels {
            let pair = given.next().copied().unwrap_or_default();
            for (amplitude_um, full_um) in pair.into_iter().zip(self.spec.full_scale_um) {
                let is_sound = amplitude_um.is_finite() && amplitude_um > 0.0;
                let amplitude_um = if is_sound { amplitude_um } else { 0.0 };
                self.peak = self.peak.max(f64::from(amplitude_um) / full_um);
                self.spool.push(amplitude_um);
            }
        }
        self.spool.end_tick()
    }

    /// Writes the channels, puts the file in its place and says where that is.
    pub fn finish(mut self, progress: &mut Progress<'_>) -> Result<PathBuf, SinkError> {
        let path = self.staged.path().to_owned();
        let gain = self.peak.max(1.0);
        let mut text = Text {
            out: &mut self.out,
            path: &path,
            gathered: String::with_capacity(CHUNK + 4096),
        };
        text.open(&self.spec);
        let n_channels = self.spec.n_channels;
        for channel in 0..n_channels {
            progress.step(channel as f64 / n_channels as f64, "writing MPEG haptics")?;
            text.begin_channel(channel, gain);
            for (number, band) in BANDS.iter().enumerate() {
                text.begin_band(number, band);
                let per_um = 1.0 / (self.spec.full_scale_um[number] * gain);
                let mut place = 0;
                let mut keyframe = |text: &mut Text<'_>, amplitude_um: f32| {
                    text.keyframe(place, f64::from(amplitude_um) * per_um, band.carrier_hz)?;
                    place += KEYFRAME_MS;
                    Ok(())
                };
                let row = 2 * channel + number;
                let last = self.spool.visit(row, &mut |um| keyframe(&mut text, um))?;
                // The last amplitude lasts for its tick.
                keyframe(&mut text, last)?;
                text.push("]}]}");
            }
            text.push("]}");
        }
        text.push("]}],\"syncs\":[]}\n");
        text.write()?;
        self.staged.finish(self.out)?;
        Ok(path)
    }
}

/// JSON on its way to a file.
struct Text<'a> {
    out: &'a mut BufWriter<File>,
    path: &'a Path,
    gathered: String,
}

impl Text<'_> {
    fn push(&mut self, text: impl std::fmt::Display) {
        push_number(&mut self.gathered, text);
    }

    fn open(&mut self, spec: &HjifSpec) {
        let level = 1 + u8::from(spec.n_channels > MAX_AT_LEVEL_1);
        let [full_40, full_320] = spec.full_scale_um;
        let title = quoted(&format!("{}: drive of a fingertip array", spec.title));
        self.push(format_args!(
            "{{\"version\":\"2023\",\"profile\":\"Main\",\"level\":{level},\
             \"date\":\"1970-01-01\",\"description\":{title},\"timescale\":1000,\
             \"avatars\":[{{\"id\":1,\"lod\":0,\"type\":\"Vibration\"}}],\
             \"perceptions\":[{{\"id\":1,\"avatar_id\":1,\"description\":\"amplitude 1 at gain 1 \
             is {full_40} um peak displacement at 40 Hz and {full_320} um at 320 Hz; one channel \
             per contactor, row by row\",\"perception_modality\":\"Vibrotactile\",\
             \"reference_devices\":[],\"effect_library\":[],\"channels\":["
        ));
    }

    fn begin_channel(&mut self, channel: usize, gain: f64) {
        let comma = if channel == 0 { "" } else { "," };
        self.push(format_args!(
            "{comma}\n{{\"id\":{channel},\"description\":\"contactor {channel}\",\"gain\":{gain},\
             \"mixing_coefficient\":1,\"body_part_mask\":0,\"bands\":["
        ));
    }

    fn begin_band(&mut self, number: usize, band: &Band) {
        let comma = if number == 0 { "" } else { "," };
        let [lower_hz, upper_hz] = band.limits_hz;
        self.push(format_args!(
            "{comma}{{\"band_type\":\"VectorialWave\",\"lower_frequency_limit\":{lower_hz},\
             \"upper_frequency_limit\":{upper_hz},\"effects\":[{{\"effect_type\":\"Basis\",\
             \"position\":0,\"phase\":0,\"base_signal\":\"Sine\",\"keyframes\":["
        ));
    }

    fn keyframe(&mut self, at_ms: u64, amplitude: f64, hz: u32) -> Result<(), SinkError> {
        let (comma, amplitude) = (if at_ms == 0 { "" } else { "," }, single(amplitude));
        self.push(format_args!(
            "{comma}{{\"relative_position\":{at_ms},\"amplitude_modulation\":{amplitude},\
             \"frequency_modulation\":{hz}}}"
        ));
        if self.gathered.len() >= CHUNK {
            self.write()?;
        }
        Ok(())
    }

    fn write(&mut self) -> Result<(), SinkError> {
        let written = self.out.write_all(self.gathered.as_bytes());
        self.gathered.clear();
        written.map_err(SinkError::write(self.path))
    }
}

/// Text in quotes. Control characters do not stand in names of ours.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            character if character.is_control() => quoted.push(' '),
            character => quoted.push(character),
        }
    }
    quoted.push('"');
    quoted
}

/// No more digits than an amplitude has.
#[expect(clippy::cast_possible_truncation, reason = "a share of 0…1")]
fn single(amplitude: f64) -> f32 {
    amplitude.min(1.0) as f32
}
