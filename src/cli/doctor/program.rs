//! What the program does here: its library, its numbers, its emulator, sound and the window.

use std::env;
use std::ops::ControlFlow;
use std::thread;
use std::time::{Duration, Instant};

use super::{Finding, State};
use crate::CliError;
use selvedge_device::{ArrayProfile, Bridge, BridgeState, Coder, Target};
use selvedge_engine::{SoundOutput, SoundSource, SoundState};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::geometry::Point;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::{ExplorationPath, LoadedScene, PathRow, Stroke, TICKS_PER_S};
use selvedge_render::{RenderScene, Replay, replay};
use selvedge_textile::Library;
use selvedge_textile::tactile::{Filters, Levels};
use selvedge_workbench::{AppError, check_display};

/// Figures of an index have six digits.
const ROUNDING: f64 = 1e-5;
/// How long an emulator or a server of sound may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// Ticks of a stroke round the shipped scene.
const N_TICKS: u32 = 160;
/// The drive codes of that stroke by `reference`, then by `table`.
pub(super) const CODES_HASH: &str =
    "17b913c4a02040953e5dea877a17e262bbe7ac5f279a2c703ac1876b8285c33c";

pub(super) fn library() -> Vec<Finding> {
    vec![Finding::of("library", levels_as_listed())]
}

/// Every textile of the shipped library is as strong as its index says.
fn levels_as_listed() -> Result<String, CliError> {
    let library = Library::shipped()?;
    for id in library.ids() {
        let found = Levels::of(library.load(id)?.surface(), &Filters::default()).mean_um;
        let listed = library.index().and_then(|index| index.entry(id));
        let listed = listed.map(|entry| [entry.a40_um, entry.a320_um]);
        let is_same = |listed: [f64; 2]| {
            let mut pairs = found.iter().zip(listed);
            pairs.all(|(found, listed)| (found - listed).abs() <= ROUNDING * listed.abs())
        };
        if !listed.is_some_and(is_same) {
            let what = format!("{id} is not as strong as listed: the program is damaged");
            return Err(CliError::Failed(format!("{what}; install it again")));
        }
    }
    Ok(format!(
        "{} textiles, as strong as listed",
        library.ids().len()
    ))
}

pub(super) fn rendering() -> Vec<Finding> {
    let finding = match codes_hash() {
        Ok(hash) if hash == CODES_HASH => {
            let what = "the same drive codes as elsewhere, by reference and by table";
            Finding::new("rendering", State::Ok, what)
        }
        Ok(_) => {
            let what = "drive codes differ in the last digit from those of other machines; \
                        compare files made here with each other only";
            Finding::new("rendering", State::Note, what)
        }
        Err(error) => Finding::new("rendering", State::Wrong, error.to_string()),
    };
    vec![finding]
}

/// The hash of the drive codes of a stroke round the shipped scene.
pub(super) fn codes_hash() -> Result<String, CliError> {
    let loaded = LoadedScene::shipped()?;
    let scene = RenderScene::of(&loaded);
    let [width_mm, height_mm] = loaded.scene().size_mm;
    let stroke = Stroke::Circle {
        centre: Point::new(width_mm / 2.0, height_mm / 2.0),
        radius_mm: 0.25 * height_mm,
        speed_mm_per_s: 120.0,
    };
    let row = |n| {
        let pose = stroke.pose_at(f64::from(n) / TICKS_PER_S);
        PathRow {
            t_s: pose.t_s,
            position: pose.position,
            angle_deg: pose.angle_deg,
            velocity: Some(pose.velocity),
        }
    };
    let path = ExplorationPath::new((0..N_TICKS).map(row).collect())?;
    let profile = ArrayProfile::default();
    let mut coder = Coder::new(&profile, profile.n_contactors());
    let mut bytes = Vec::new();
    for method in [Method::Reference, Method::Table] {
        let what = Replay {
            scene: &scene,
            method,
            accuracy: Accuracy::default(),
            measures_error: false,
        };
        replay(&what, &path, &mut || 0, &mut |_, _, frames| {
            for frame in frames {
                let codes = coder.encode(frame.amplitudes_um(), 1.0);
                bytes.extend(codes.iter().flatten().flat_map(|code| code.to_le_bytes()));
            }
            ControlFlow::Continue(())
        })?;
    }
    Ok(sha256_hex([bytes.as_slice()]))
}

/// Greets the emulator in this process as the window does.
pub(super) fn emulator() -> Vec<Finding> {
    let began = Instant::now();
    let profile = ArrayProfile::default();
    let n_contactors = profile.n_contactors();
    let mut bridge = Bridge::open(Target::Emulator, profile, n_contactors, || {});
    while bridge.state() != BridgeState::Ready && began.elapsed() < PATIENCE {
        while bridge.poll().is_some() {}
        thread::sleep(Duration::from_millis(1));
    }
    let finding = if bridge.state() == BridgeState::Ready {
        let ms = began.elapsed().as_millis();
        Finding::new("emulator", State::Ok, format!("ready after {ms} ms"))
    } else {
        let what = "it does not answer: end other programs that take all of the processor";
        Finding::new("emulator", State::Wrong, what)
    };
    vec![finding]
}

struct Silence;

impl SoundSource for Silence {
    fn fill(&mut self, frames: &mut [[f32; 2]]) {
        frames.fill([0.0; 2]);
    }
}

/// Plays a moment of silence by whatever the window would play by.
pub(super) fn sound() -> Vec<Finding> {
    let state = SoundOutput::open(Box::new(Silence)).map(|output| {
        let began = Instant::now();
        while output.state() == SoundState::Opening && began.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(5));
        }
        output.state()
    });
    let finding = match state {
        Ok(state) => sound_as(state),
        Err(error) => Finding::new("sound", State::Wrong, error.to_string()),
    };
    vec![finding]
}

pub(super) fn sound_as(state: SoundState) -> Finding {
    let silent = |why: &str| {
        let what = format!("none ({why}): start PulseAudio or PipeWire, or install alsa-utils");
        Finding::new("sound", State::Note, what)
    };
    match state {
        SoundState::Playing { by, latency } => {
            let late = latency.map(|late| format!(", {} ms late", late.as_millis()));
            let what = format!("by {by}{}", late.unwrap_or_default());
            Finding::new("sound", State::Ok, what)
        }
        SoundState::Absent(why) => silent(&why),
        SoundState::Opening => silent("nothing answers"),
    }
}

pub(super) fn display() -> Vec<Finding> {
    let is_named = |name: &&str| env::var_os(name).is_some_and(|value| !value.is_empty());
    let named = ["WAYLAND_DISPLAY", "DISPLAY"].into_iter().find(is_named);
    vec![display_as(named, check_display())]
}

/// A machine that names no display is meant to have none: what works without a window works.
pub(super) fn display_as(named: Option<&str>, outcome: Result<String, AppError>) -> Finding {
    match (named, outcome) {
        (_, Ok(what)) => {
            let by = named.map(|name| format!(", by {name}")).unwrap_or_default();
            Finding::new("display", State::Ok, format!("{what}{by}"))
        }
        (None, Err(error @ AppError::NoDisplay)) if cfg!(target_os = "linux") => {
            Finding::new("display", State::Note, error.to_string())
        }
        (Some(name), Err(AppError::NoDisplay)) => {
            let what = format!("nothing answers at the display that {name} names; correct it");
            Finding::new("display", State::Wrong, what)
        }
        (_, Err(error)) => Finding::new("display", State::Wrong, error.to_string()),
    }
}
