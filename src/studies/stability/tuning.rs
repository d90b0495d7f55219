//! Gains and compression that make no sense: in files, and live.

use std::path::Path;
use std::time::Instant;

use super::case::{Case, Verdict, cases, failed, refused, verdict};
use super::scene::{METHODS, extent_um, moving, range_um, renderer, wavy_scene};
use selvedge_device::{ArrayProfile, Coder};
use selvedge_engine::{Command, Engine, EngineConfig, Notice, PreparedScene};
use selvedge_foundation::geometry::Point;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::Scene;
use selvedge_textile::tactile::Tuning;

/// Gains and compression.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = cases! { "gain";
        "−∞ dB, live" => "silent", || silent_with_gain(f64::NEG_INFINITY);
        "−∞ dB, in a file" => "taken", || {
            let read = in_file("gain_db = -inf").map_err(|error| error.to_string())?;
            let gain_db = read.tuning.map(|tuning| tuning.gain_db);
            let is_taken = gain_db == Some(f64::NEG_INFINITY);
            verdict(is_taken, "taken as silence".to_owned())
        };
        "1e308 dB, live" => "finite", || finite_with_gain(1e308);
    };
    let mut add = |area, [tried, line]: [String; 2], tuning: Tuning, should| {
        let file = move || refused(in_file(&line), &["a.toml:4", "; "]);
        let tried_in_file = format!("{tried}, in a file");
        cases.push(Case::new(
            area,
            tried_in_file,
            "refused with file and line",
            file,
        ));
        let live = move || ignored_live(tuning);
        cases.push(Case::new(area, format!("{tried}, live"), should, live));
    };
    for (gain_db, spelt) in [(f64::INFINITY, "inf"), (f64::NAN, "nan")] {
        let both = [format!("{gain_db} dB"), format!("gain_db = {spelt}")];
        add("gain", both, with_gain(gain_db), "ignored with a notice");
    }
    for (compression, spelt) in [(-0.1, "-0.1"), (1.1, "1.1"), (f64::NAN, "nan")] {
        let both = [compression.to_string(), format!("compression = {spelt}")];
        let tuning = Tuning {
            compression,
            ..Tuning::default()
        };
        add("compression", both, tuning, "refused with a notice");
    }
    cases
}

fn with_gain(gain_db: f64) -> Tuning {
    Tuning {
        gain_db,
        ..Tuning::default()
    }
}

/// A scene file with this line in its tuning, the fourth.
fn in_file(line: &str) -> Result<Scene, impl std::fmt::Display + use<>> {
    let text = format!("name = \"a\"\nsize_mm = [100.0, 100.0]\n[tuning]\n{line}\n");
    Scene::from_toml(&text, Path::new("a.toml"))
}

fn silent_with_gain(gain_db: f64) -> Verdict {
    let heard = heard_with_gain(gain_db)?;
    let is_silent = heard.iter().all(|extent| *extent == [0.0; 2]);
    verdict(is_silent, range_um(heard[0]))
}

fn finite_with_gain(gain_db: f64) -> Verdict {
    let heard = heard_with_gain(gain_db)?;
    let profile = ArrayProfile::default();
    let mut coder = Coder::new(&profile, 1);
    let mut codes = Vec::new();
    for [low, high] in &heard {
        codes.extend(coder.encode(&[[*low, *high]], 1.0));
    }
    let is_bounded = codes
        .iter()
        .all(|[low, high]| u32::from(*low) + u32::from(*high) <= 65_535);
    let is_number = heard.iter().flatten().all(|um| !um.is_nan());
    let came_back = format!("{}, codes within full drive", range_um(heard[0]));
    verdict(is_bounded && is_number, came_back)
}

/// What every method gives at 100 mm/s with a gain.
fn heard_with_gain(gain_db: f64) -> Result<Vec<[f32; 2]>, String> {
    let scene = wavy_scene()?;
    let mut heard = Vec::new();
    for method in METHODS {
        let mut renderer = renderer(&scene, method)?;
        renderer.set_tuning(&with_gain(gain_db)).map_err(failed)?;
        heard.push(extent_um(&renderer.tick(&[moving(100.0)])[0]));
    }
    Ok(heard)
}

/// An engine that is given a senseless tuning says so and keeps the last one.
fn ignored_live(tuning: Tuning) -> Verdict {
    let mut renderer = renderer(&wavy_scene()?, Method::Reference)?;
    let before = extent_um(&renderer.tick(&[moving(100.0)])[0]);
    let is_refused = renderer.set_tuning(&tuning).is_err();
    let after = extent_um(&renderer.tick(&[moving(100.0)])[0]);
    let (mut engine, _) = engine()?;
    engine.send(Command::SetTuning(tuning)).map_err(failed)?;
    engine.advance_ticks(1);
    match engine.next_notice() {
        Some(Notice::GainIgnored(error)) => {
            let is_kept = is_refused && before == after;
            verdict(is_kept, format!("ignored: {error}"))
        }
        other => Err(format!("no such notice: {other:?}")),
    }
}

/// An engine in told time on a scene of one textile, and that time.
pub(super) fn engine() -> Result<(Engine, Instant), String> {
    let start = Instant::now();
    let (profile, accuracy) = (ArrayProfile::default(), Accuracy::default());
    let method = (Method::Reference, &accuracy);
    let scene = PreparedScene::from_parts(&wavy_scene()?, profile, Point::new(50.0, 50.0), method);
    let config = EngineConfig {
        scene: scene.map_err(failed)?,
        on_news: None,
    };
    let engine = Engine::without_thread(config, start).map_err(failed)?;
    Ok((engine, start))
}
