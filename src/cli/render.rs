//! `selvedge render`: an exploration replayed into files.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::Args;
use serde::Serialize;

use super::method::MethodArgs;
use super::output::{InFile, OutFile};
use super::render_out::{AmplitudeTable, BandTables, Clips, WavKind};
use super::terminal::{self, Meter};
use super::{CliError, output, signals};

use selvedge_engine::ClipKind;
use selvedge_foundation::files::{read_text, to_json_string};
use selvedge_foundation::progress::Cancelled;
use selvedge_render::array::Method;
use selvedge_render::scene::{ExplorationPath, LoadedScene, Pose};
use selvedge_render::{RenderScene, Replay, RunStats, replay};

const PATH_HELP: &str = "Exploration: a CSV of t_s,x_mm,y_mm, optionally angle_deg and \
                         vx_mm_per_s,vy_mm_per_s; `-` is standard input";

/// What to replay, and what to write.
#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    /// Scene file; `-` is standard input
    scene: InFile,
    #[arg(long, value_name = "PATH.csv", help = PATH_HELP)]
    path: InFile,
    /// Amplitudes after gains, one row a contactor a tick (standard output if no file is asked for)
    #[arg(long, value_name = "A.csv")]
    out: Option<OutFile>,
    /// Amplitudes at both ends of what textiles are known to (their `[uncertainty]`): textiles of
    /// pictures; others are written as they are
    #[arg(
        long,
        value_name = "LOW.csv,HIGH.csv",
        value_delimiter = ',',
        num_args = 1
    )]
    band: Vec<OutFile>,
    #[command(flatten)]
    how: MethodArgs,
    /// The drive waveform, one channel a contactor; full scale is 50 µm
    #[arg(long, value_name = "W.wav")]
    wav: Option<OutFile>,
    /// What the waveform is for: float is 48 kHz and f32, archive 8 kHz and i16
    #[arg(long, value_enum, default_value_t = WavKind::Float, requires = "wav")]
    wav_format: WavKind,
    /// Another sample rate of the waveform, Hz
    #[arg(long, value_name = "HZ", requires = "wav", value_parser = wav_rate)]
    wav_rate: Option<u32>,
    /// MPEG haptics: a channel a contactor, a keyframe a tick in each band
    #[arg(long, value_name = "H.hjif")]
    hjif: Option<OutFile>,
    /// Drive codes of every contactor, one row a tick
    #[arg(long, value_name = "F.csv")]
    frames: Option<OutFile>,
    /// Cost, work left out and level error of every method on this path, as JSON
    #[arg(long, value_name = "S.json")]
    stats: Option<OutFile>,
}

/// A sample rate as it is typed, Hz: two samples a period of the higher carrier at least.
fn wav_rate(text: &str) -> Result<u32, String> {
    let rate_hz = text
        .parse()
        .map_err(|_whatever| "give a whole number of Hz".to_owned())?;
    if rate_hz < 2 * 320 {
        return Err("320 Hz takes two samples a period: give 640 Hz or above".to_owned());
    }
    Ok(rate_hz)
}

impl RenderArgs {
    /// The files for other programs that were asked for.
    fn clips(&self) -> Vec<(&Path, ClipKind)> {
        let wav = self.wav_format.clip(self.wav_rate);
        let kinds = [
            (&self.wav, wav),
            (&self.hjif, ClipKind::Hjif),
            (&self.frames, ClipKind::Frames),
        ];
        let asked = kinds.into_iter();
        asked
            .filter_map(|(path, kind)| Some((path.as_deref()?, kind)))
            .collect()
    }
}

/// What `--stats` writes.
#[derive(Debug, Serialize)]
struct StatsFile<'a> {
    program: &'static str,
    version: &'static str,
    scene: &'a Path,
    path: &'a Path,
    n_ticks: u64,
    /// Textiles placed of which nothing is felt on this path: their surfaces were not read.
    unread: &'a [String],
    /// The method that made the amplitudes written.
    method: Method,
    /// Every method on this very path, the one above first.
    methods: Vec<RunStats>,
}

/// Replays, and writes what was asked for.
pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let path = ExplorationPath::read(&args.path)?;
    let cache = selvedge_workbench::build_cache();
    let text = (&*read_text(&args.scene)?, args.scene.place());
    let loaded = LoadedScene::from_text_along(text, cache.as_ref(), &path)?;
    if let Some(changed) = loaded.changed() {
        terminal::notice(&changed);
    }
    let scene = RenderScene::of(&loaded);
    let stop = signals::stop_flag()?;
    let mut sinks = Sinks::open(args, &loaded, &scene)?;
    let first = run_method(
        &scene,
        (args.how.method, args),
        &path,
        &mut |tick, pose, frames| sinks.take(tick, pose, frames, &stop),
    )?;
    sinks.finish(&stop)?;
    if let Some(place) = &args.stats {
        write_stats(args, (place, &loaded), &scene, &path, &first, &stop)?;
    }
    Ok(())
}

/// One replay of the whole path.
fn run_method(
    scene: &RenderScene,
    (method, args): (Method, &RenderArgs),
    path: &ExplorationPath,
    sink: &mut dyn FnMut(u64, &Pose, &[selvedge_render::array::DisplayFrame]) -> Step,
) -> Result<RunStats, CliError> {
    let what = Replay {
        scene,
        method,
        accuracy: args.how.accuracy(),
        measures_error: args.stats.is_some(),
    };
    let started = Instant::now();
    let mut clock_ns = || u64::try_from(started.elapsed().as_nanos()).unwrap_or(u64::MAX);
    let mut meter = Meter::new("rendering");
    let n_ticks = path.n_ticks() as f64;
    let mut failed = None;
    let stats = replay(&what, path, &mut clock_ns, &mut |tick, pose, frames| {
        meter.show(tick as f64 / n_ticks, method.name());
        match sink(tick, pose, frames) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                failed = Some(error);
                ControlFlow::Break(())
            }
        }
    })?;
    failed.map_or(Ok(stats), Err)
}

type Step = Result<(), CliError>;

/// Runs the other methods too and writes the figures of all.
fn write_stats(
    args: &RenderArgs,
    (place, loaded): (&Path, &LoadedScene),
    scene: &RenderScene,
    path: &ExplorationPath,
    first: &RunStats,
    stop: &AtomicBool,
) -> Result<(), CliError> {
    let mut methods = vec![*first];
    for method in [Method::Reference, Method::Banded, Method::Table] {
        if method != first.method {
            let goes_on = &mut |_, _: &_, _: &[_]| check(stop);
            methods.push(run_method(scene, (method, args), path, goes_on)?);
        }
    }
    let file = StatsFile {
        program: "selvedge",
        version: env!("CARGO_PKG_VERSION"),
        scene: args.scene.place(),
        path: args.path.place(),
        n_ticks: path.n_ticks(),
        unread: loaded.unread(),
        method: first.method_used,
        methods,
    };
    output::write_text(Some(place), &to_json_string(&file, place)?)
}

/// The files of a run.
struct Sinks<'a> {
    table: Option<AmplitudeTable<'a>>,
    band: Option<BandTables<'a>>,
    clips: Clips,
}

impl<'a> Sinks<'a> {
    fn open(
        args: &RenderArgs,
        loaded: &'a LoadedScene,
        scene: &RenderScene,
    ) -> Result<Self, CliError> {
        let clips = args.clips();
        let is_other = !clips.is_empty() || args.stats.is_some() || !args.band.is_empty();
        let is_asked = args.out.is_some() || !is_other;
        let table = is_asked
            .then(|| AmplitudeTable::new(args.out.as_deref(), loaded))
            .transpose()?;
        let band = match &args.band[..] {
            [] => None,
            [low, high] => Some(BandTables::new([low, high], loaded, scene)?),
            _ => {
                let line =
                    "--band takes two files; give the lower end and the upper: LOW.csv,HIGH.csv";
                return Err(CliError::Input(line.to_owned()));
            }
        };
        let displays = scene.displays.iter();
        let n_contactors = displays.map(|display| display.offsets.len()).sum();
        let clips = Clips::create(&clips, n_contactors, &loaded.scene().name)?;
        Ok(Self { table, band, clips })
    }

    fn take(
        &mut self,
        tick: u64,
        pose: &Pose,
        frames: &[selvedge_render::array::DisplayFrame],
        stop: &AtomicBool,
    ) -> Result<(), CliError> {
        check(stop)?;
        if let Some(table) = &mut self.table {
            table.take(tick, pose.t_s, frames)?;
        }
        if let Some(band) = &mut self.band {
            band.take(tick, pose, frames)?;
        }
        self.clips.take(tick, frames)
    }

    fn finish(self, stop: &Arc<AtomicBool>) -> Result<(), CliError> {
        self.table.map_or(Ok(()), AmplitudeTable::finish)?;
        self.band.map_or(Ok(()), BandTables::finish)?;
        self.clips.finish(stop)
    }
}

fn check(stop: &AtomicBool) -> Result<(), CliError> {
    if stop.load(Ordering::Relaxed) {
        Err(Cancelled.into())
    } else {
        Ok(())
    }
}
