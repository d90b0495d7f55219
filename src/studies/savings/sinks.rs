//! What the engine leaves out where nobody listens: tick samples that nobody asked for, and frames
//! that no armed device would play.

use std::time::Instant;

use super::Work;
use crate::{ReportError, Row};
use selvedge_engine::{Command, Engine, EngineConfig, InputSource, PreparedScene};
use selvedge_foundation::geometry::Point;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::{LoadedScene, Stroke};

/// Ticks that are counted.
const N_TICKS: u64 = 100;

/// What the engine makes in some ticks while nobody draws what is felt, and while somebody does.
pub(super) fn rows() -> Result<Vec<Row>, ReportError> {
    let mut rows = Vec::new();
    for is_drawn in [false, true] {
        let (n_samples, n_unheard) = counted(is_drawn)?;
        let case = if is_drawn {
            "a window draws, no device is armed"
        } else {
            "no window draws, no device is armed"
        };
        let work = |unit, needed, done| Work {
            unit,
            asked: N_TICKS,
            needed: Some(needed),
            done,
        };
        let samples = work(
            "tick samples",
            if is_drawn { N_TICKS } else { 0 },
            n_samples,
        );
        let frames = work("frames", 0, N_TICKS - n_unheard);
        rows.push(samples.row(("engine", "unasked tick samples"), case, true));
        rows.push(frames.row(("engine", "unheard frames"), case, true));
    }
    Ok(rows)
}

/// Tick samples made and frames not made along a circle over the shipped scene.
fn counted(is_drawn: bool) -> Result<(u64, u64), ReportError> {
    let scene =
        PreparedScene::prepare(&LoadedScene::shipped()?, Method::Auto, &Accuracy::default())?;
    let config = EngineConfig {
        scene,
        on_news: None,
    };
    let mut engine = Engine::without_thread(config, Instant::now())?;
    engine.send(Command::SampleTicks(is_drawn))?;
    let circle = Stroke::Circle {
        centre: Point::new(130.0, 130.0),
        radius_mm: 70.0,
        speed_mm_per_s: 150.0,
    };
    engine.send(Command::SetSource(InputSource::Stroke(circle)))?;
    engine.send(Command::Play)?;
    let mut n_samples = 0;
    for _ in 0..N_TICKS {
        engine.advance_ticks(1);
        while engine.next_tick_sample().is_some() {
            n_samples += 1;
        }
    }
    Ok((n_samples, engine.snapshot().counters.frames_unheard))
}
