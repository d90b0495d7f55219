//! Friction in a window without a screen: a picture becomes a trace, the display's place a voltage;
//! nothing is done before it is asked for.

use super::*;
use crate::bench::command::friction::PictureAtHand;
use crate::bench::command::{PlayCommand, PlaySource};
use crate::bench::export::Exportable;
use crate::shell::headless::Headless;
use selvedge_foundation::numerics::{Grid, extent, to_single};
use selvedge_render::electrovibration::{Carrier, SimulatedScreen};

/// Pixels to a millimetre of the picture below.
const SCALE: f64 = 10.0;

/// A cloth of threads 0.6 mm apart, so long and high, mm.
fn cloth([length, height]: [usize; 2]) -> PictureAtHand {
    let turn = std::f64::consts::TAU;
    let brightness = Grid::from_fn(10 * length, 10 * height, |x, y| {
        let [x, y] = [x, y].map(|at| turn * at as f64 / 6.0);
        to_single(0.5 + 0.2 * x.cos() + 0.15 * y.cos())
    });
    PictureAtHand {
        name: "weave".to_owned(),
        brightness: Arc::new(brightness),
        px_per_mm: SCALE,
    }
}

/// A window with the pane in sight.
fn window() -> Headless {
    let mut desk = Headless::shipped();
    desk.dispatch(ShowCommand::Reveal(Pane::Friction));
    desk.pass(3);
    desk
}

fn tool(desk: &mut Headless) -> &mut Friction {
    desk.workbench.tools.get_mut().unwrap()
}

/// The same with the cloth's friction, after a stroke of so many ticks.
fn felt(n_ticks: u32) -> Headless {
    let mut desk = window();
    desk.dispatch(cloth([60, 12]));
    desk.dispatch(PlayCommand::Source(PlaySource::Stroke));
    desk.dispatch(PlayCommand::Toggle);
    desk.pass_ticks(n_ticks);
    desk.pass(2);
    desk
}

#[test]
fn nothing_is_predicted_before_a_picture_and_its_scale_are_there_and_in_sight() {
    let mut desk = window();
    let empty = desk.workbench.exported(Exportable::Pane(Pane::Friction));
    assert!(empty.unwrap_err().contains("open a picture"));
    assert_eq!(tool(&mut desk).work.n_begun(), 0);
    desk.dispatch(ShowCommand::Reveal(Pane::Workspace));
    let moment = Moment::default();
    tool(&mut desk).change(moment, |friction| {
        friction.chosen.source = Some(Source::AtHand(cloth([60, 12])));
        friction.chosen.scale = "10".to_owned();
    });
    desk.pass(3);
    assert_eq!(tool(&mut desk).work.n_begun(), 0, "nobody looks");
    desk.dispatch(ShowCommand::Reveal(Pane::Friction));
    desk.pass(3);
    let friction = tool(&mut desk);
    assert_eq!(friction.work.n_begun(), 1);
    assert_eq!(friction.trace().unwrap().unwrap().length_mm(), 60.0);
}

#[test]
fn the_displays_place_on_the_strip_gives_the_voltage_live_and_looked_back_at() {
    let mut desk = felt(80);
    let newest = *desk.workbench.bench.past.history.newest().unwrap();
    let now = |desk: &mut Headless, column: u64| {
        let entry = *desk.workbench.bench.past.history.at_column(column).unwrap();
        let x_mm = entry.tick_sample.pose.position.x_mm;
        let friction = tool(desk);
        let trace = Arc::clone(friction.trace().unwrap().unwrap());
        let shown = friction.shown.as_ref().unwrap();
        let (place_mm, mu, driven) = shown.now.unwrap();
        assert_eq!(place_mm, trace.place_mm(x_mm));
        assert_eq!(mu, trace.mu(place_mm));
        assert_eq!(driven.peak_to_peak_v, 120.0 * mu);
        assert_eq!(shown.stroke.len(), 40 * 500, "a whole second");
        assert_eq!(shown.charts.len(), 5);
        for instant in &shown.stroke {
            assert!(instant.driven.v >= 0.0 && instant.driven.v < Electrovibration::MAX_V);
            let bare_n = stroke::BARE_MU * stroke::PRESS_N;
            let is_pulled = instant.driven.v > 0.0;
            assert_eq!(instant.friction_n > bare_n, is_pulled, "{instant:?}");
        }
        place_mm
    };
    let live = now(&mut desk, newest.column);
    let before = newest.column - 20;
    desk.dispatch(PlayCommand::LookBack(Some(before)));
    desk.pass(1);
    assert_ne!(now(&mut desk, before), live);
}

#[test]
fn the_simulated_screen_bears_no_voltage_the_largest_and_the_slowest_and_fastest_carriers() {
    let mut desk = felt(2);
    let trace = Arc::clone(tool(&mut desk).trace().unwrap().unwrap());
    let felt_n = |v: f64| stroke::BARE_MU * (stroke::PRESS_N + SimulatedScreen::pull_n(v));
    let most_v = Electrovibration::MAX_V;
    for (carrier, peak_v, n_a_period) in [
        (Carrier::Square, most_v, 1.0),
        (Carrier::Sine, 0.5 * most_v, 2.0),
    ] {
        for carrier_hz in Electrovibration::CARRIER_HZ {
            let friction_n = |amplification_v: f64| {
                let drive = Electrovibration {
                    amplification_v,
                    carrier_hz,
                    carrier,
                };
                let stroke = stroke::along(&trace, &drive);
                let is_within = |instant: &Instant| instant.driven.v.abs() <= most_v;
                assert!(stroke.iter().all(is_within));
                let forces = stroke.iter().map(|instant| instant.friction_n);
                forces.collect::<Vec<f64>>()
            };
            let silent = friction_n(0.0);
            assert!(silent.iter().all(|&n| n == felt_n(0.0)), "0 V");
            // Friction of the cloth is above 0.255: all of it is cut off.
            let loud = friction_n(Electrovibration::MAX_AMPLIFICATION_V);
            let [least, most] = extent(loud.iter().copied());
            assert!((least - felt_n(0.0)).abs() < 1e-6, "{least} N");
            assert!((most / felt_n(peak_v) - 1.0).abs() < 1e-3, "{most} N");
            // A stroke of 60 mm at 100 mm/s.
            let middle = 0.5 * (least + most);
            let rises = loud.windows(2).filter(|n| n[0] < middle && n[1] >= middle);
            let expected = 0.6 * n_a_period * carrier_hz;
            let n_rises = rises.count() as f64;
            assert!((n_rises - expected).abs() <= 1.5, "{carrier:?}: {n_rises}");
        }
    }
}

#[test]
fn a_strip_goes_to_and_fro_without_a_jump() {
    let mut desk = felt(2);
    let trace = Arc::clone(tool(&mut desk).trace().unwrap().unwrap());
    for (x_mm, place_mm) in [
        (0.0, 0.0),
        (59.0, 59.0),
        (61.0, 59.0),
        (121.0, 1.0),
        (-2.0, 2.0),
    ] {
        let found = trace.place_mm(x_mm);
        assert!((found - place_mm).abs() < 1e-9, "{x_mm}: {found}");
    }
}

#[test]
fn every_choice_is_a_step_and_the_drive_is_kept_within_its_limits() {
    let mut desk = felt(4);
    let moment = |press| Moment {
        press,
        is_down: true,
        t_s: 0.0,
    };
    let friction = tool(&mut desk);
    for b in [200.0, 300.0] {
        friction.change(moment(1), |friction| {
            friction.chosen.drive.amplification_v = b;
        });
    }
    friction.change(moment(2), |friction| {
        friction.chosen.drive.carrier = Carrier::Sine;
    });
    friction.change(moment(3), |friction| {
        friction.chosen.drive = Electrovibration::PRESETS[0].1;
    });
    let steps = desk.workbench.steps();
    assert_eq!(
        steps.names,
        ["picture", "amplification", "carrier", "preset"]
    );
    desk.dispatch(Command::StepTo(2));
    assert_eq!(tool(&mut desk).chosen.drive.amplification_v, 300.0);
    let mut preferences = Preferences::default();
    tool(&mut desk).keep_preferences(&mut preferences);
    assert_eq!(preferences.hand.electrovibration.amplification_v, 300.0);
    preferences.hand.electrovibration.carrier_hz = 1e6;
    desk.workbench.bench.settings.preferences = preferences;
    let mut next = Friction::default();
    next.begin(&mut desk.workbench.bench);
    assert_eq!(next.chosen.drive.carrier_hz, 1000.0);
}

#[test]
fn what_cannot_be_read_is_one_line() {
    let mut desk = window();
    let why = |desk: &mut Headless| {
        desk.pass(3);
        tool(desk).trace().unwrap().unwrap_err().to_owned()
    };
    desk.dispatch(cloth([30, 12]));
    assert!(why(&mut desk).contains("at least 40 mm x 10 mm"));
    let folder = selvedge_scratch::ScratchFolder::made("friction");
    let path = folder.write("odd.png", "no picture");
    let purpose = Purpose::OpenPicture(Pane::Friction);
    desk.dispatch(FileCommand::Use(purpose, path));
    let line = why(&mut desk);
    assert!(line.contains("odd.png") && !line.contains('\n'), "{line}");
    tool(&mut desk).chosen.scale = "0".to_owned();
    assert_eq!(tool(&mut desk).standing(), Standing::Empty);
    tool(&mut desk).chosen.scale = "11,8".to_owned();
    assert_ne!(tool(&mut desk).standing(), Standing::Empty);
}

#[test]
fn a_textile_gives_its_own_picture_and_one_without_says_so() {
    let mut desk = window();
    let loaded = &desk.workbench.bench.engine_scene.loaded;
    let with = Arc::clone(&loaded.textiles()[0]);
    assert!(with.manifest().appearance.is_some());
    tool(&mut desk).chosen.source = Some(Source::Textile(with));
    tool(&mut desk).chosen.scale = "10".to_owned();
    desk.pass(3);
    let trace = tool(&mut desk).trace().unwrap().unwrap();
    assert!((trace.length_mm() - 100.0).abs() < 1e-9);
}

#[test]
fn tables_are_those_of_the_strip_and_of_a_stroke_along_it() {
    let mut desk = felt(60);
    let mut csv = |table| {
        tool(&mut desk).table = table;
        let exported = desk.workbench.exported(Exportable::Pane(Pane::Friction));
        exported.unwrap().to_csv().unwrap()
    };
    let strip = csv(TableOf::Strip);
    let rows: Vec<&str> = strip
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert_eq!((rows[0], rows.len()), ("x_mm,mu", 1 + 768));
    let stroke = csv(TableOf::Stroke);
    let rows: Vec<&str> = stroke
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert_eq!(rows[0], "t_s,x_mm,mu,voltage_v,friction_n");
    // 60 mm at 100 mm/s, 20,000 a second.
    assert_eq!(rows.len(), 1 + 12_000);
    assert!(stroke.contains("# electrovibration = b 120 V, square carrier of 100 Hz"));
}
