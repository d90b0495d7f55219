//! The files that `selvedge render` writes tick by tick: amplitudes as CSV, the drive as WAV.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use clap::ValueEnum;

use super::output::{Staged, TableOut};
use super::{CliError, terminal};
use crate::bridge::{ArrayProfile, SampleFormat, WavSpec, WavWriter};
use crate::render::array::{DisplayFrame, DriveSynth};
use crate::scene::LoadedScene;

const HEADER: [&str; 9] = [
    "tick",
    "t_s",
    "display",
    "contactor",
    "x_mm",
    "y_mm",
    "textile",
    "a40_um",
    "a320_um",
];

/// Amplitudes after gains and before output limits: one row a contactor a tick, displays and
/// contactors in index order.
pub(super) struct AmplitudeTable<'a> {
    out: TableOut,
    loaded: &'a LoadedScene,
}

impl<'a> AmplitudeTable<'a> {
    /// A table in a file, or on standard output.
    pub(super) fn new(path: Option<&Path>, loaded: &'a LoadedScene) -> Result<Self, CliError> {
        Ok(Self {
            out: TableOut::new(path, &HEADER)?,
            loaded,
        })
    }

    /// Writes the rows of a tick.
    pub(super) fn take(
        &mut self,
        tick: u64,
        t_s: f64,
        frames: &[DisplayFrame],
    ) -> Result<(), CliError> {
        for (display, frame) in frames.iter().enumerate() {
            for contactor in 0..frame.n_contactors() {
                let position = frame.contactor_position(contactor);
                let textile = frame.textile(contactor);
                let placed = textile.and_then(|index| self.loaded.scene.textiles.get(index));
                let exact_um = frame.amplitude_um(contactor);
                let single_um = frame.amplitudes_um()[contactor];
                let row = self.out.rows();
                row.number(tick)
                    .number(t_s)
                    .number(display)
                    .number(contactor);
                row.number(position.x_mm).number(position.y_mm);
                row.text(placed.map_or("", |placed| &placed.id));
                for (exact, single) in exact_um.into_iter().zip(single_um) {
                    // What has no more digits than f32 is written with no more.
                    if f64::from(single).to_bits() == exact.to_bits() {
                        row.number(single)
                    } else {
                        row.number(exact)
                    };
                }
                row.end_row()?;
            }
        }
        Ok(())
    }

    /// The table is whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        self.out.finish()
    }
}

/// How samples are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SampleKind {
    /// 32-bit floating point: louder than full scale stays what it is
    F32,
    /// 16-bit integers: louder than full scale is clipped
    I16,
}

/// The drive waveform of all contactors of all displays, one channel each.
pub(super) struct DriveFile {
    synth: DriveSynth,
    wav: WavWriter<BufWriter<File>>,
    staged: Staged,
    amplitudes_um: Vec<[f32; 2]>,
    samples: Vec<f32>,
    peak: f32,
}

impl DriveFile {
    /// A waveform at `rate_hz` samples a second; full scale is that of the array profile.
    pub(super) fn new(
        path: &Path,
        n_contactors: usize,
        (rate_hz, kind): (u32, SampleKind),
    ) -> Result<Self, CliError> {
        let full_scale_um = ArrayProfile::default().full_scale_um[0];
        let too_many = |_| {
            CliError::Input(format!(
                "{n_contactors} channels are too many for a WAV file; use --out"
            ))
        };
        let spec = WavSpec {
            n_channels: u16::try_from(n_contactors).map_err(too_many)?,
            sample_rate_hz: rate_hz,
            format: match kind {
                SampleKind::F32 => SampleFormat::F32,
                SampleKind::I16 => SampleFormat::I16,
            },
            full_scale_um,
        };
        let synth = DriveSynth::prepare(rate_hz, n_contactors, full_scale_um)?;
        let staged = Staged::new(path);
        let wav = WavWriter::new(staged.create()?, spec)?;
        Ok(Self {
            synth,
            wav,
            staged,
            amplitudes_um: Vec::with_capacity(n_contactors),
            samples: Vec::new(),
            peak: 0.0,
        })
    }

    /// Writes the samples of a tick.
    pub(super) fn take(&mut self, tick: u64, frames: &[DisplayFrame]) -> Result<(), CliError> {
        self.amplitudes_um.clear();
        for frame in frames {
            self.amplitudes_um.extend_from_slice(frame.amplitudes_um());
        }
        self.synth.set_amplitudes(&self.amplitudes_um);
        let samples = self.synth.samples_of_tick(tick);
        let n_frames = usize::try_from(samples.end - samples.start).unwrap_or(0);
        self.samples.resize(n_frames * self.synth.n_channels(), 0.0);
        self.synth.fill(&mut self.samples);
        self.peak = self
            .samples
            .iter()
            .fold(self.peak, |peak, sample| peak.max(sample.abs()));
        Ok(self.wav.write(&self.samples)?)
    }

    /// The file is whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        if self.peak > 1.0 {
            let peak = self.peak;
            terminal::notice(&format!(
                "the waveform reaches {peak:.2} of full scale (50 µm)"
            ));
        }
        // Dropping the buffer before the file moves: everything is on its way to the disk.
        drop(self.wav.finish()?);
        self.staged.finish()
    }
}
