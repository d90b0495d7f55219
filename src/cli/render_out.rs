//! The files that `selvedge render` writes tick by tick: amplitudes as CSV, and what is for other
//! programs.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::ValueEnum;

use super::output::TableOut;
use super::terminal::with_meter_until;
use super::{CliError, terminal};
use selvedge_device::ArrayProfile;
use selvedge_engine::{ClipKind, ClipWriter, side_by_side};
use selvedge_render::array::DisplayFrame;
use selvedge_render::scene::LoadedScene;

/// Columns of amplitudes: what a contactor is given at a tick, and where it is.
pub(super) const AMPLITUDE_COLUMNS: [&str; 9] = [
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
            out: TableOut::new(path, &AMPLITUDE_COLUMNS)?,
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
                let placed = textile.and_then(|index| self.loaded.scene().textiles.get(index));
                let row = self.out.rows();
                row.number(tick)
                    .number(t_s)
                    .number(display)
                    .number(contactor);
                row.number(position.x_mm).number(position.y_mm);
                row.text(placed.map_or("", |placed| &placed.id));
                write_amplitudes(&mut self.out, frame, contactor);
                self.out.rows().end_row()?;
            }
        }
        Ok(())
    }

    /// The table is whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        self.out.finish()
    }
}

/// The amplitudes of a contactor; what has no more digits than f32 is written with no more.
pub(super) fn write_amplitudes(out: &mut TableOut, frame: &DisplayFrame, contactor: usize) {
    let single_um = frame.amplitudes_um()[contactor];
    for (exact, single) in frame.amplitude_um(contactor).into_iter().zip(single_um) {
        if f64::from(single).to_bits() == exact.to_bits() {
            out.rows().number(single)
        } else {
            out.rows().number(exact)
        };
    }
}

/// What the waveform is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum WavKind {
    /// 48 kHz, 32-bit floating point: louder than full scale stays what it is
    #[value(alias = "f32")]
    Float,
    /// 8 kHz, 16-bit integers: a twelfth of the size; louder than full scale is clipped
    #[value(alias = "i16")]
    Archive,
}

impl WavKind {
    /// The file, at another rate if one is named.
    pub(super) fn clip(self, rate_hz: Option<u32>) -> ClipKind {
        let usual = match self {
            Self::Float => ClipKind::FLOAT,
            Self::Archive => ClipKind::ARCHIVE,
        };
        match (usual, rate_hz) {
            (ClipKind::Wav { format, .. }, Some(rate_hz)) => ClipKind::Wav { rate_hz, format },
            (usual, _) => usual,
        }
    }
}

/// The files for other programs that a run writes.
pub(super) struct Clips {
    clips: Vec<ClipWriter>,
    amplitudes_um: Vec<[f32; 2]>,
}

impl Clips {
    /// Files for the contactors of all displays.
    pub(super) fn create(
        files: &[(&Path, ClipKind)],
        n_contactors: usize,
        title: &str,
    ) -> Result<Self, CliError> {
        let profile = ArrayProfile::default();
        let create = |(path, kind): &(&Path, ClipKind)| {
            ClipWriter::create(path, *kind, (&profile, n_contactors), title)
        };
        Ok(Self {
            clips: files.iter().map(create).collect::<Result<_, _>>()?,
            amplitudes_um: Vec::with_capacity(n_contactors),
        })
    }

    /// Writes a tick to all of them.
    pub(super) fn take(&mut self, tick: u64, frames: &[DisplayFrame]) -> Result<(), CliError> {
        side_by_side(frames, &mut self.amplitudes_um);
        for clip in &mut self.clips {
            clip.take(tick, &self.amplitudes_um)?;
        }
        Ok(())
    }

    /// The files are whole; says what a listener should know.
    pub(super) fn finish(self, stop: &Arc<AtomicBool>) -> Result<(), CliError> {
        for clip in self.clips {
            let written = with_meter_until("writing", stop, |progress| clip.finish(progress))?;
            if let [first, .., last] = &written.paths[..] {
                let (first, last) = (first.display(), last.display());
                let n = written.paths.len();
                terminal::notice(&format!("the waveform is in {n} files, {first} to {last}"));
            }
            if let Some(peak) = written.peak.filter(|peak| *peak > 1.0) {
                terminal::notice(&format!(
                    "the waveform reaches {peak:.2} of full scale (50 µm)"
                ));
            }
        }
        Ok(())
    }
}
