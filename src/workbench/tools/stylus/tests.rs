//! The stylus in a window without a screen: it follows the display, live and looked back at, asks
//! before what cannot be held, and costs nothing out of sight.

use eframe::egui::{Event, Modifiers, PointerButton, Pos2};

use super::follow::FeltRow;
use super::settings::{DIALS, StylusSettings};
use super::*;
use crate::bench::command::{PlayCommand, ShowCommand};
use crate::shell::headless::Headless;
use selvedge_render::contact::{Standing, Stepper};

/// Radius of the tip, mm.
pub(super) const FINE_MM: f64 = 0.05;

/// A window whose display has explored by itself, with the pane in sight.
pub(super) fn explored(n_ticks: u32) -> Headless {
    let mut desk = Headless::shipped();
    // A fine tip is soon rolled over all textiles.
    stylus(&mut desk).chosen.applied.radius_mm = FINE_MM;
    desk.dispatch(ShowCommand::Pane(Pane::Stylus));
    desk.dispatch(PlayCommand::Toggle);
    desk.pass_ticks(n_ticks);
    // What is due is done over several frames.
    desk.run_after(0).drop_without_applying_deltas();
    desk
}

pub(super) fn fine() -> StylusSettings {
    StylusSettings {
        radius_mm: FINE_MM,
        ..StylusSettings::default()
    }
}

pub(super) fn stylus(desk: &mut Headless) -> &mut Stylus {
    desk.workbench.tools.get_mut().unwrap()
}

/// The rows of a stretch of felt time.
fn rows_between(desk: &mut Headless, from: u64, to: u64) -> Vec<FeltRow> {
    let inside = |row: &&FeltRow| row.column >= from as f64 && row.column <= to as f64;
    let rows = stylus(desk).follower.rows().iter();
    rows.filter(inside).copied().collect()
}

fn newest(desk: &Headless) -> u64 {
    desk.workbench.bench.past.history.newest().unwrap().column
}

#[test]
fn the_stylus_is_where_the_displays_centre_is() {
    let mut desk = explored(200);
    let bench = &desk.workbench.bench;
    let entry = *bench.past.history.newest().unwrap();
    let scene = bench.engine_scene.loaded.scene();
    let spot = spot_at(scene, entry.tick_sample.pose.position);
    let spot = spot.expect("the stroke goes round over textiles");
    let rows = stylus(&mut desk).follower.rows();
    let last = rows.back().unwrap();
    let [x_mm, y_mm, z_mm] = last.felt.place_mm;
    let away = (x_mm - spot.place_mm[0]).hypot(y_mm - spot.place_mm[1]);
    assert!(away < 1e-6, "{away} mm");
    assert_eq!(last.column, entry.column as f64);
    assert!(z_mm.abs() < 2.0, "on the cloth: {z_mm} mm");
    let mean_n = rows.iter().map(|row| row.felt.force_n).sum::<f64>() / rows.len() as f64;
    let press_n = fine().press_n;
    assert!(
        (mean_n / press_n - 1.0).abs() < 0.3,
        "as much as the hand presses: {mean_n} N"
    );
    let is_number = |row: &FeltRow| {
        let felt = row.felt;
        let all = [felt.force_n, felt.vibration_n, felt.energy_j, felt.depth_um];
        all.iter().chain(&felt.place_mm).all(|x| x.is_finite())
    };
    assert!(rows.iter().all(is_number), "no number is missing");
}

#[test]
fn what_is_looked_back_at_is_what_was_felt_live() {
    let mut desk = explored(520);
    let column = newest(&desk);
    let live = rows_between(&mut desk, column - 30, column);
    assert!(live.len() > 500, "{} rows at 1 kHz", live.len());
    // Forward and back again, and from far away.
    for to in [column - 200, column - 7, column - 430, column] {
        desk.dispatch(PlayCommand::LookBack(Some(to)));
        desk.pass(3);
        assert_eq!(stylus(&mut desk).end, Some(to));
    }
    assert_eq!(rows_between(&mut desk, column - 30, column), live);
}

#[test]
fn what_cannot_be_held_is_asked_before_it_is_applied() {
    let mut desk = explored(60);
    let sampled = StylusSettings {
        is_sampled: true,
        damping_n_s_per_m: 0.0,
        stiffness_n_per_m: 100.0,
        press_n: 1.0,
        ..fine()
    };
    let chosen = &mut stylus(&mut desk).chosen;
    chosen.ask(sampled);
    assert_eq!(chosen.applied, sampled, "it can be held");
    let stiff = StylusSettings {
        stiffness_n_per_m: 50_000.0,
        ..sampled
    };
    chosen.ask(stiff);
    assert_eq!((chosen.applied, chosen.shown()), (sampled, stiff));
    let (_, why) = chosen.asked.clone().unwrap();
    assert!(why.contains("no method can hold 50000 N/m"), "{why}");
    desk.pass_ticks(8);
    let desk_stylus = stylus(&mut desk);
    assert!(
        desk_stylus.follower.trouble.is_none(),
        "the old one goes on"
    );
    desk_stylus.chosen.confirm();
    desk.pass_ticks(80);
    let (stylus, is_number) = (stylus(&mut desk), |row: &FeltRow| {
        row.felt.force_n.is_finite()
    });
    let trouble = stylus.follower.trouble.clone().unwrap();
    assert!(trouble.contains("grows without end"), "{trouble}");
    assert!(stylus.follower.rows().iter().all(is_number), "nothing odd");
}

#[test]
fn the_mark_on_the_slider_is_where_the_loop_begins_to_grow() {
    let settings = StylusSettings {
        is_sampled: true,
        damping_n_s_per_m: 0.0,
        ..StylusSettings::default()
    };
    let limit = settings.case().stiffness_limits(0.0, 0.0).exact;
    // Without damping of the wall a heavy mass has the limit K = 2 b/T, and 75 g nearly.
    assert!((limit / 1000.0 - 1.0).abs() < 2e-3, "{limit} N/m");
    let standing = |factor: f64| {
        let settings = StylusSettings {
            stiffness_n_per_m: factor * limit,
            ..settings
        };
        settings.case().standing()
    };
    assert_ne!(standing(0.99), Standing::Unstable);
    assert_eq!(standing(1.01), Standing::Unstable);
    let map = map::map(&settings);
    let least = map.bands[1].points[0];
    assert!(
        (least[2] / limit - 1.0).abs() < 0.5,
        "the map agrees: {least:?}"
    );
}

#[test]
fn every_end_of_every_slider_is_finite_or_refused_in_a_line() {
    let mut desk = explored(120);
    for method in Stepper::ALL {
        for (nth, is_sampled) in (0..DIALS.len()).flat_map(|nth| [(nth, false), (nth, true)]) {
            let dial = &DIALS[nth];
            for end in [dial.scale.least, dial.scale.most] {
                let mut settings = StylusSettings {
                    method,
                    is_sampled,
                    ..fine()
                };
                *(dial.field)(&mut settings) = end;
                settings.radius_mm = settings.radius_mm.min(FINE_MM);
                let chosen = &mut stylus(&mut desk).chosen;
                chosen.ask(settings);
                chosen.confirm();
                desk.pass(2);
                let (stylus, name) = (stylus(&mut desk), dial.name);
                let rows = stylus.follower.rows();
                assert!(
                    rows.iter().all(|row| row.felt.force_n.is_finite()),
                    "{name} {end}"
                );
                let waits = stylus.note.is_some() || !rows.is_empty();
                assert!(waits || stylus.follower.trouble.is_some(), "{name} {end}");
            }
        }
    }
}

#[test]
fn out_of_sight_it_costs_nothing() {
    let mut desk = explored(80);
    let before = (
        stylus(&mut desk).n_steps(),
        stylus(&mut desk).grounds.n_begun(),
    );
    assert!(before.0 > 0 && before.1 > 0, "{before:?}");
    desk.dispatch(ShowCommand::Pane(Pane::Why));
    desk.pass_ticks(80);
    let hidden = (
        stylus(&mut desk).n_steps(),
        stylus(&mut desk).grounds.n_begun(),
    );
    assert_eq!(hidden, before);
    desk.dispatch(ShowCommand::Pane(Pane::Stylus));
    desk.pass_ticks(8);
    assert!(
        stylus(&mut desk).n_steps() > before.0,
        "in sight it goes on"
    );
}

#[test]
fn a_display_that_stands_still_is_computed_once() {
    let mut desk = explored(80);
    desk.dispatch(PlayCommand::Toggle);
    desk.pass_ticks(20);
    let before = stylus(&mut desk).n_steps();
    desk.pass_ticks(20);
    assert_eq!(stylus(&mut desk).n_steps(), before);
}

#[test]
fn the_export_has_the_columns_of_probe_and_the_numbers_that_are_shown() {
    let mut desk = explored(100);
    let window = &mut desk.workbench;
    let tool = window.tools.get_mut::<Stylus>().unwrap();
    let exported = tool.export(Pane::Stylus, &mut window.bench).unwrap();
    let csv = exported
        .sheet
        .to_csv(&[], std::path::Path::new("stylus.csv"));
    let csv = String::from_utf8(csv.unwrap()).unwrap();
    let header = csv.lines().next().unwrap();
    let expected = "t_s,x_mm,y_mm,z_mm,depth_um,force_n,tangential_n,vibration_n,energy_j";
    assert_eq!(header, expected);
    assert_eq!(csv.lines().count(), 1 + tool.follower.rows().len());
    assert!(
        !csv.contains("NaN") && !csv.contains("inf"),
        "numbers alone"
    );
}

#[test]
fn the_dot_on_the_map_is_dragged() {
    let mut desk = explored(40);
    desk.dispatch(ShowCommand::Maximise(Some(Pane::Stylus)));
    desk.pass(3);
    let before = stylus(&mut desk).chosen.applied;
    // The map stands in the lower right corner, the line of time below it.
    let at = Pos2::new(1200.0, 720.0);
    desk.events.push(Event::PointerMoved(at));
    desk.pass(1);
    desk.events.push(Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed: true,
        modifiers: Modifiers::NONE,
    });
    desk.pass(1);
    desk.events
        .push(Event::PointerMoved(at + eframe::egui::vec2(-20.0, 10.0)));
    desk.pass(2);
    let after = stylus(&mut desk).chosen.shown();
    assert_ne!(
        after.stiffness_n_per_m.to_bits(),
        before.stiffness_n_per_m.to_bits()
    );
    assert_ne!(
        after.damping_n_s_per_m.to_bits(),
        before.damping_n_s_per_m.to_bits()
    );
}
