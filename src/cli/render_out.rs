//! The files that `selvedge render` writes tick by tick: amplitudes as CSV, and what is for other
//! programs.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::ValueEnum;

use super::output::{Spool, TableOut};
use super::terminal::with_meter_until;
use super::{CliError, terminal};
use selvedge_device::ArrayProfile;
use selvedge_engine::{ClipKind, ClipWriter, side_by_side};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_render::RenderScene;
use selvedge_render::array::{ContactInspector, ContactorReading, DisplayFrame, Reading};
use selvedge_render::scene::{LoadedScene, Pose};
use selvedge_textile::tactile::Band;

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
        self.take_by(tick, t_s, frames, |_, _| [1.0; 2])
    }

    /// The same with amplitudes by factors of a contactor of a display.
    fn take_by(
        &mut self,
        tick: u64,
        t_s: f64,
        frames: &[DisplayFrame],
        mut factors: impl FnMut(usize, usize) -> [f64; 2],
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
                match factors(display, contactor) {
                    [1.0, 1.0] => write_amplitudes(&mut self.out, frame, contactor),
                    factors => {
                        for (um, factor) in frame.amplitude_um(contactor).into_iter().zip(factors) {
                            self.out.rows().number(um * factor);
                        }
                    }
                }
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

/// Amplitudes at both ends of what textiles are known to: a contactor's are shifted by the band of
/// the textile that it is on, interpolated at its own direction of movement in the textile's frame.
/// What has no band is shifted by nothing.
pub(super) struct BandTables<'a> {
    ends: [AmplitudeTable<'a>; 2],
    inspector: ContactInspector,
    readings: Vec<ContactorReading>,
}

impl<'a> BandTables<'a> {
    /// A table for either end.
    pub(super) fn new(
        [low, high]: [&Path; 2],
        loaded: &'a LoadedScene,
        scene: &RenderScene,
    ) -> Result<Self, CliError> {
        Ok(Self {
            ends: [
                AmplitudeTable::new(Some(low), loaded)?,
                AmplitudeTable::new(Some(high), loaded)?,
            ],
            inspector: ContactInspector::new(scene),
            readings: Vec::new(),
        })
    }

    /// Writes the rows of a tick.
    pub(super) fn take(
        &mut self,
        tick: u64,
        pose: &Pose,
        frames: &[DisplayFrame],
    ) -> Result<(), CliError> {
        let mut shifts_db = Vec::with_capacity(frames.len());
        for display in 0..frames.len() {
            self.inspector
                .readings_into(display, pose, &mut self.readings);
            let loaded = self.ends[0].loaded;
            let shift = |moving: &ContactorReading| {
                moving
                    .reading
                    .map_or([[0.0; 2]; 2], |reading| shift_db(loaded, &reading))
            };
            shifts_db.push(self.readings.iter().map(shift).collect::<Vec<_>>());
        }
        for (end, table) in self.ends.iter_mut().enumerate() {
            table.take_by(tick, pose.t_s, frames, |display, contactor| {
                let shift = shifts_db[display]
                    .get(contactor)
                    .copied()
                    .unwrap_or_default();
                [0, 1].map(|band| factor_of_gain(shift[band][end]))
            })?;
        }
        Ok(())
    }

    /// The tables are whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        self.ends.into_iter().try_for_each(AmplitudeTable::finish)
    }
}

/// By band from where to where a contactor's amplitude may lie, dB from what it is given.
fn shift_db(loaded: &LoadedScene, reading: &Reading) -> [[f64; 2]; 2] {
    let textile = loaded.textiles().get(reading.textile);
    let band = textile.and_then(|textile| textile.manifest().uncertainty.as_ref());
    let [u, w] = reading.velocity_mm_per_s;
    let direction_deg = w.atan2(u).to_degrees();
    Band::ALL.map(|of| band.map_or([0.0; 2], |band| band.level_db(of, direction_deg)))
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
    clips: Vec<(ClipWriter, Spool)>,
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
        let create = |(path, kind): &(&Path, ClipKind)| -> Result<_, CliError> {
            let spool = Spool::of(path)?;
            let what = (&profile, n_contactors);
            let clip = ClipWriter::create(spool.path(), *kind, what, title)?;
            Ok((clip, spool))
        };
        Ok(Self {
            clips: files.iter().map(create).collect::<Result<_, _>>()?,
            amplitudes_um: Vec::with_capacity(n_contactors),
        })
    }

    /// Writes a tick to all of them.
    pub(super) fn take(&mut self, tick: u64, frames: &[DisplayFrame]) -> Result<(), CliError> {
        side_by_side(frames, &mut self.amplitudes_um);
        for (clip, _) in &mut self.clips {
            clip.take(tick, &self.amplitudes_um)?;
        }
        Ok(())
    }

    /// The files are whole; says what a listener should know.
    pub(super) fn finish(self, stop: &Arc<AtomicBool>) -> Result<(), CliError> {
        for (clip, spool) in self.clips {
            let written = with_meter_until("writing", stop, |progress| clip.finish(progress))?;
            spool.finish(&written.paths)?;
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
