//! What the engine leaves out where nobody listens: tick samples that nobody asked for, and frames
//! that no armed device would play.

use std::thread;
use std::time::{Duration, Instant};

use super::{ALL, NONE, UNASKED_TICK_SAMPLES, UNHEARD_FRAMES, largest_difference};
use crate::{Bench, ReportError, Row};
use selvedge_device::{BridgeEvent, Target};
use selvedge_engine::{Command, Engine, EngineConfig, InputSource, Notice, PreparedScene};
use selvedge_foundation::geometry::Point;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::{LoadedScene, Stroke};

/// What these rows are called.
const CASE: &str = "the engine on four alternatives";
/// Ticks after which amplitudes are compared.
const N_COMPARED: u64 = 100;
/// How long the emulated device may take to be ready and armed.
const PATIENCE: Duration = Duration::from_secs(10);

/// Who listens to the engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Listeners {
    /// Somebody draws what is felt over time.
    window: bool,
    /// A device is armed.
    device: bool,
}

/// What a tick of the engine costs when nobody listens, when everybody does, and in between.
pub(super) fn rows(bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let to = |window, device| Listeners { window, device };
    let (mut quiet, expected) = engine(to(false, false))?;
    let snapshot = quiet.snapshot();
    let settings = [
        (Row::of("engine", ALL, CASE), to(false, false)),
        (Row::of("engine", NONE, CASE), to(true, true)),
        (
            UNHEARD_FRAMES.row(snapshot.counters.frames_unheard, CASE),
            to(true, false),
        ),
        (
            UNASKED_TICK_SAMPLES.row(snapshot.tick, CASE),
            to(false, true),
        ),
    ];
    let mut rows = Vec::new();
    for (row, listeners) in settings {
        let (mut engine, felt) = engine(listeners)?;
        let n_ticks = bench.effort.pick(50, 400);
        let cost = bench.time(n_ticks, || advance(&mut engine, n_ticks as u64));
        let error = largest_difference(&felt, &expected);
        rows.push(row.error(error).promised(0.0).cost(cost));
    }
    Ok(rows)
}

/// An engine that follows a circle over the shipped scene, and its amplitudes after
/// [`N_COMPARED`] ticks, µm.
fn engine(listeners: Listeners) -> Result<(Engine, Vec<[f64; 2]>), ReportError> {
    let scene =
        PreparedScene::prepare(&LoadedScene::shipped()?, Method::Auto, &Accuracy::default())?;
    let config = EngineConfig {
        scene,
        on_news: None,
    };
    let mut engine = Engine::without_thread(config, Instant::now())?;
    engine.send(Command::SampleTicks(listeners.window))?;
    if listeners.device {
        arm(&mut engine)?;
    }
    let circle = Stroke::Circle {
        centre: Point::new(130.0, 130.0),
        radius_mm: 70.0,
        speed_mm_per_s: 150.0,
    };
    engine.send(Command::SetSource(InputSource::Stroke(circle)))?;
    engine.send(Command::Play)?;
    advance(&mut engine, N_COMPARED);
    let felt = engine.snapshot().displays.iter().flat_map(|display| {
        let contactors = display.contactors.iter();
        contactors.map(|contactor| contactor.amplitude_um.map(f64::from))
    });
    let felt = felt.collect();
    Ok((engine, felt))
}

/// Arms an emulated device in this process, which lives in real time.
fn arm(engine: &mut Engine) -> Result<(), ReportError> {
    engine.send(Command::Connect(Target::Emulator))?;
    wait_for(engine, |event| matches!(event, BridgeEvent::Ready(_)))?;
    engine.send(Command::Arm)?;
    wait_for(engine, |event| matches!(event, BridgeEvent::Armed))
}

fn wait_for(engine: &mut Engine, is_it: impl Fn(&BridgeEvent) -> bool) -> Result<(), ReportError> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        engine.advance(Instant::now());
        while let Some(notice) = engine.next_notice() {
            if matches!(&notice, Notice::Bridge(event) if is_it(event)) {
                return Ok(());
            }
        }
        thread::sleep(Duration::from_millis(1));
    }
    Err(ReportError::Device)
}

/// Lets so many ticks pass, however many of the device's came in between.
fn advance(engine: &mut Engine, n_ticks: u64) {
    let end = engine.snapshot().tick + n_ticks;
    while engine.snapshot().tick < end {
        engine.advance_ticks(1);
        while engine.next_tick_sample().is_some() {}
        while engine.next_notice().is_some() {}
    }
}
