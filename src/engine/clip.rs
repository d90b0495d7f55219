//! A rendered exploration on its way to files for other programs: waveform, MPEG haptics, frames.
//!
//! Whoever renders hands over the amplitudes of a tick after the other; each file is written as
//! they come, in the same memory however long it lasts, and appears only when it is whole. Not for
//! the engine's own thread: this is what is done with explorations afterwards.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::EngineError;
use selvedge_device::{
    ArrayProfile, FrameTable, HjifSpec, HjifWriter, SampleFormat, SinkError, WavParts, WavSpec,
};
use selvedge_foundation::progress::Progress;
use selvedge_render::array::{DisplayFrame, DriveSynth};
use selvedge_render::scene::ExplorationPath;
use selvedge_render::{Replay, replay};

/// Ticks between two looks at whether to stop.
const TICKS_A_STEP: u64 = 64;

/// Which file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ClipKind {
    /// The drive waveform, one channel a contactor.
    Wav {
        /// Samples a second.
        rate_hz: u32,
        /// How samples are stored.
        format: SampleFormat,
    },
    /// MPEG haptics.
    Hjif,
    /// Drive codes of every tick as a table.
    Frames,
}

impl ClipKind {
    /// The waveform to keep: small, with everything that a device of 8 kHz plays.
    pub const ARCHIVE: Self = Self::Wav {
        rate_hz: 8_000,
        format: SampleFormat::I16,
    };
    /// The waveform to play through an audio interface.
    pub const FLOAT: Self = Self::Wav {
        rate_hz: 48_000,
        format: SampleFormat::F32,
    };
}

/// One file being written.
#[derive(Debug)]
pub struct ClipWriter {
    to: To,
}

#[derive(Debug)]
enum To {
    Wav(Box<Waveform>),
    Hjif(Box<HjifWriter>),
    Frames(Box<FrameTable>, PathBuf, ApplyTicks),
}

/// The device's tick at which each tick of a recording was felt, as far as it was sent; none at all
/// of an exploration that no device played.
pub type ApplyTicks = Arc<[Option<u32>]>;

/// What became of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// The file, or its parts in order.
    pub paths: Vec<PathBuf>,
    /// The largest sample of a waveform, as a share of full scale; `None` of other files.
    pub peak: Option<f32>,
}

impl ClipWriter {
    /// A file at `path` for `n_contactors` contactors of arrays like `profile`, explored on a
    /// scene called `title`.
    ///
    /// # Errors
    /// The place is wrong, or there are too many contactors for that kind of file.
    pub fn create(
        path: &Path,
        kind: ClipKind,
        (profile, n_contactors): (&ArrayProfile, usize),
        title: &str,
    ) -> Result<Self, EngineError> {
        Self::of_played(
            path,
            kind,
            (profile, n_contactors),
            title,
            ApplyTicks::default(),
        )
    }

    /// The same of what a device played at these ticks, which frames then say.
    ///
    /// # Errors
    /// As there.
    pub fn of_played(
        path: &Path,
        kind: ClipKind,
        (profile, n_contactors): (&ArrayProfile, usize),
        title: &str,
        apply_ticks: ApplyTicks,
    ) -> Result<Self, EngineError> {
        let to = match kind {
            ClipKind::Wav { rate_hz, format } => {
                let full_scale_um = profile.full_scale_um[0];
                let spec = WavSpec {
                    // Too many are refused with their number by the format.
                    n_channels: u16::try_from(n_contactors).unwrap_or(u16::MAX),
                    sample_rate_hz: rate_hz,
                    format,
                    full_scale_um,
                    part: None,
                };
                let synth = DriveSynth::prepare(rate_hz, n_contactors, full_scale_um)?;
                To::Wav(Box::new(Waveform {
                    parts: WavParts::create(path, spec)?,
                    synth,
                    samples: Vec::new(),
                    peak: 0.0,
                }))
            }
            ClipKind::Hjif => {
                let spec = HjifSpec {
                    n_channels: n_contactors,
                    full_scale_um: profile.full_scale_um,
                    title: title.to_owned(),
                };
                To::Hjif(Box::new(HjifWriter::create(path, spec)?))
            }
            ClipKind::Frames => {
                let was_played = apply_ticks.iter().any(Option::is_some);
                let frames = FrameTable::create(path, (profile, n_contactors), was_played)?;
                To::Frames(Box::new(frames), path.to_owned(), apply_ticks)
            }
        };
        Ok(Self { to })
    }

    /// Writes a tick: amplitudes [A40, A320] of every contactor, µm, after gains, before limits.
    ///
    /// # Errors
    /// The disk is full, or something else keeps it from being written.
    pub fn take(&mut self, tick: u64, amplitudes_um: &[[f32; 2]]) -> Result<(), SinkError> {
        match &mut self.to {
            To::Wav(waveform) => waveform.take(tick, amplitudes_um),
            To::Hjif(writer) => writer.take(amplitudes_um),
            To::Frames(frames, _, apply_ticks) => {
                let nth = usize::try_from(tick).unwrap_or(usize::MAX);
                let apply_tick = apply_ticks.get(nth).copied().flatten();
                frames.take(tick, apply_tick, amplitudes_um)
            }
        }
    }

    /// Writes what is left and puts the file in its place.
    ///
    /// # Errors
    /// It was stopped, or cannot be written: then there is no file.
    pub fn finish(self, progress: &mut Progress<'_>) -> Result<Written, SinkError> {
        match self.to {
            To::Wav(waveform) => Ok(Written {
                paths: waveform.parts.finish()?,
                peak: Some(waveform.peak),
            }),
            To::Hjif(writer) => writer.finish(progress).map(Written::at),
            To::Frames(frames, path, _) => {
                frames.finish()?;
                Ok(Written::at(path))
            }
        }
    }
}

impl Written {
    fn at(path: PathBuf) -> Self {
        Self {
            paths: vec![path],
            peak: None,
        }
    }
}

#[derive(Debug)]
struct Waveform {
    parts: WavParts,
    synth: DriveSynth,
    samples: Vec<f32>,
    peak: f32,
}

impl Waveform {
    fn take(&mut self, tick: u64, amplitudes_um: &[[f32; 2]]) -> Result<(), SinkError> {
        self.synth.set_amplitudes(amplitudes_um);
        let samples = self.synth.samples_of_tick(tick);
        let n_frames = usize::try_from(samples.end - samples.start).unwrap_or(0);
        self.samples.resize(n_frames * self.synth.n_channels(), 0.0);
        self.synth.fill(&mut self.samples);
        let louder = |peak: f32, sample: &f32| peak.max(sample.abs());
        self.peak = self.samples.iter().fold(self.peak, louder);
        self.parts.write(&self.samples)
    }
}

/// The amplitudes of all displays after each other, as a file has its contactors.
pub fn side_by_side(frames: &[DisplayFrame], amplitudes_um: &mut Vec<[f32; 2]>) {
    amplitudes_um.clear();
    for frame in frames {
        amplitudes_um.extend_from_slice(frame.amplitudes_um());
    }
}

/// Renders `path` as `what` says into a file.
///
/// # Errors
/// What the renderer refuses, what the file does, or that it was stopped.
pub fn write_clip(
    mut clip: ClipWriter,
    what: &Replay<'_>,
    path: &ExplorationPath,
    progress: &mut Progress<'_>,
) -> Result<Written, EngineError> {
    let n_ticks = path.n_ticks() as f64;
    let mut amplitudes_um = Vec::new();
    let mut failed: Option<SinkError> = None;
    replay(what, path, &mut || 0, &mut |tick, _, frames| {
        side_by_side(frames, &mut amplitudes_um);
        let mut done = clip.take(tick, &amplitudes_um);
        if tick.is_multiple_of(TICKS_A_STEP) {
            let share = tick as f64 / n_ticks;
            done = done.and_then(|()| Ok(progress.step(share, "rendering")?));
        }
        done.map_or_else(
            |error| {
                failed = Some(error);
                ControlFlow::Break(())
            },
            ControlFlow::Continue,
        )
    })?;
    match failed {
        Some(error) => Err(error.into()),
        None => Ok(clip.finish(progress)?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::{CancelFlag, Progress};
    use selvedge_scratch::ScratchFolder;

    fn clip(path: &Path, kind: ClipKind) -> ClipWriter {
        let profile = ArrayProfile::default();
        ClipWriter::create(path, kind, (&profile, 24), "test").unwrap()
    }

    #[test]
    fn frames_of_what_a_device_played_say_at_which_of_its_ticks() {
        let profile = ArrayProfile::default();
        let folder = ScratchFolder::made("clip");
        let header_of = |apply_ticks: &[Option<u32>]| {
            let path = folder.join("a.csv");
            let array = (&profile, 2);
            let mut writer =
                ClipWriter::of_played(&path, ClipKind::Frames, array, "", apply_ticks.into())
                    .unwrap();
            for tick in 0..3 {
                writer.take(tick, &[[1.0, 2.0]; 2]).unwrap();
            }
            Progress::unheard(|progress| writer.finish(progress)).unwrap();
            let text = folder.read("a.csv");
            let rows = text.lines().filter(|line| !line.starts_with('#'));
            let start = |row: &str| row.split(',').take(3).map(str::to_owned).collect();
            rows.map(start).collect::<Vec<Vec<String>>>()
        };
        let played = header_of(&[Some(77), None]);
        assert_eq!(played[0], ["tick", "t_s", "apply_tick"]);
        let described: Vec<&str> = played[1..].iter().map(|row| row[2].as_str()).collect();
        assert_eq!(described, ["77", "", ""]);
        let unplayed = header_of(&[None, None, None]);
        assert_eq!(unplayed[0], ["tick", "t_s", "code40_0"]);
    }

    #[test]
    fn a_second_has_the_frames_of_its_rate_in_either_waveform() {
        for (kind, rate_hz, bits) in [(ClipKind::ARCHIVE, 8000, 16), (ClipKind::FLOAT, 48_000, 32)]
        {
            let folder = ScratchFolder::made("clip");
            let path = folder.join("a.wav");
            let mut writer = clip(&path, kind);
            for tick in 0..40 {
                writer.take(tick, &[[25.0, 10.0]; 24]).unwrap();
            }
            let written = Progress::unheard(|progress| writer.finish(progress)).unwrap();
            assert_eq!(written.paths, std::slice::from_ref(&path));
            assert!(
                written.peak.is_some_and(|peak| (0.6..0.71).contains(&peak)),
                "{written:?}"
            );
            let reader = hound::WavReader::open(&path).unwrap();
            let spec = reader.spec();
            assert_eq!(
                (spec.channels, spec.sample_rate, spec.bits_per_sample),
                (24, rate_hz, bits)
            );
            assert_eq!(reader.duration(), rate_hz);
        }
    }

    #[test]
    fn a_stopped_rendering_leaves_no_file() {
        use selvedge_foundation::geometry::{Displacement, Point};
        use selvedge_render::array::{Accuracy, Method};
        use selvedge_render::scene::PathRow;
        use selvedge_render::{ContactorArray, RenderScene};
        let scene = RenderScene {
            displays: vec![ContactorArray {
                offsets: vec![Displacement::default()],
                rotation_deg: 0.0,
            }],
            ..RenderScene::default()
        };
        let what = Replay {
            scene: &scene,
            method: Method::Table,
            accuracy: Accuracy::default(),
            measures_error: false,
        };
        let row = |t_s| PathRow {
            t_s,
            position: Point::new(t_s, 0.0),
            ..PathRow::default()
        };
        let path = ExplorationPath::new(vec![row(0.0), row(10.0)]).unwrap();
        for kind in [ClipKind::ARCHIVE, ClipKind::Hjif, ClipKind::Frames] {
            let folder = ScratchFolder::made("clip");
            let place = folder.join("stopped");
            let profile = ArrayProfile::default();
            let create = || ClipWriter::create(&place, kind, (&profile, 1), "test").unwrap();
            let flag = CancelFlag::new();
            let mut heard = 0;
            let mut report = |_: f64, _: &str| {
                heard += 1;
            };
            let mut progress = Progress::new(&mut report, flag.clone());
            write_clip(create(), &what, &path, &mut progress).unwrap();
            assert!(place.exists(), "{kind:?}");
            std::fs::remove_file(&place).unwrap();
            flag.cancel();
            let stopped = write_clip(create(), &what, &path, &mut progress);
            let is_cancelled = matches!(stopped, Err(EngineError::Sink(SinkError::Cancelled(_))));
            assert!(is_cancelled && !place.exists(), "{stopped:?}");
            assert!(heard > 5, "{heard}");
        }
    }
}
