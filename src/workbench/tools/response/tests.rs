//! The pane under the hands of a simulated user, empty and loaded.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::bench::background::Executor;
use crate::bench::command::Command;
use crate::bench::probe::Probe;
use crate::kit::amplitude::AmplitudeScale;
use selvedge_foundation::geometry::Velocity;
use selvedge_render::RenderScene;
use selvedge_render::array::{ContactInspector, TextileResponse};
use selvedge_render::scene::LoadedScene;
use selvedge_textile::Uncertainty;

struct Pane {
    response: TextileResponse,
    curves: Curves,
    probe: Probe,
    commands: Commands,
    rotation_deg: f64,
}

fn pane() -> Pane {
    let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
    let response = ContactInspector::new(&scene).response(0).unwrap();
    Pane {
        response,
        curves: Curves::default(),
        probe: Probe::default().with_direction(30.0),
        commands: Commands::new(),
        rotation_deg: 0.0,
    }
}

fn window(pane: Pane) -> Harness<'static, Pane> {
    let mut is_styled = false;
    let show_pane = move |ui: &mut Ui, pane: &mut Pane| {
        if !is_styled {
            theme::install(ui.ctx());
            is_styled = true;
        }
        let points = pane.response.points_at([20.0, 30.0]);
        let wanted = Wanted {
            response: pane.response.clone(),
            points: Some(points),
            probe: pane.probe,
        };
        (pane.curves).follow(ui.ctx(), &Executor::InLine, wanted);
        let view = ResponseView {
            textile: "1 Silk".to_owned(),
            rotation_deg: pane.rotation_deg,
            factors: pane.response.factors(),
            uncertainty: None,
            place: Some((9, points)),
            curves: &pane.curves,
            probe: pane.probe,
            moving: Some(Velocity::new(30.0, -40.0)),
            scale: AmplitudeScale::default(),
        };
        let mut commands = Commands::new();
        show(ui, Some(&view), &mut commands);
        for wish in &commands {
            if let Command::Show(ShowCommand::Probe(probe)) = wish {
                pane.probe = *probe;
            }
        }
        pane.commands.extend(commands);
    };
    Harness::builder()
        .with_size(vec2(480.0, 216.0))
        .build_ui_state(show_pane, pane)
}

#[test]
fn dragging_in_the_polar_plot_chooses_the_direction_and_in_the_other_the_speed() {
    let mut harness = window(pane());
    harness.run();
    let n_first = harness.state().curves.n_computed();
    let dial = harness.get_by_role_and_label(Role::Slider, "Direction of movement");
    let rect = dial.rect();
    let above = rect.center() - vec2(0.0, 0.3 * rect.height());
    harness.drag_at(above);
    harness.run();
    assert_eq!(harness.state().probe.direction_deg, 90.0, "straight up");
    harness.hover_at(rect.center() - vec2(40.0, 0.0));
    harness.run();
    harness.drop_at(rect.center() - vec2(40.0, 0.0));
    harness.run();
    assert_eq!(
        harness.state().probe.direction_deg,
        180.0,
        "dragged to the left"
    );
    let speeds = harness.get_by_role_and_label(Role::Slider, "Speed of movement");
    let rect = speeds.rect();
    let at = rect.center() - vec2(30.0, 0.0);
    harness.drag_at(at);
    harness.run();
    harness.drop_at(at);
    harness.run();
    let probe = harness.state().probe;
    assert!(
        probe.speed_mm_per_s > 2.0 && probe.speed_mm_per_s < 60.0,
        "{probe:?}"
    );
    assert_eq!(probe.direction_deg, 180.0, "the other plot keeps its own");
    assert!(harness.state().curves.n_computed() > n_first, "asked anew");
    let n_before = harness.state().curves.n_computed();
    harness.run_steps(5);
    assert_eq!(harness.state().curves.n_computed(), n_before, "still");
}

#[test]
fn keys_and_assistive_tools_choose_too() {
    let mut harness = window(pane());
    harness.run();
    harness
        .get_by_role_and_label(Role::Slider, "Direction of movement")
        .focus();
    harness.run();
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert_eq!(harness.state().probe.direction_deg, 35.0);
    harness
        .get_by_role_and_label(Role::Slider, "Speed of movement")
        .set_value_accesskit(250.0);
    harness.run();
    assert_eq!(harness.state().probe.speed_mm_per_s, 250.0);
}

#[test]
fn a_place_in_the_polar_plot_and_its_direction_undo_each_other() {
    let pane = pane();
    let curves = Curves::default();
    let view = ResponseView {
        textile: String::new(),
        rotation_deg: 23.0,
        factors: [1.0; 2],
        uncertainty: None,
        place: None,
        curves: &curves,
        probe: pane.probe,
        moving: None,
        scale: AmplitudeScale::default(),
    };
    let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 180.0));
    let plot = polar::Plot::new(rect, &view);
    for direction_deg in [-170.0, -90.0, 0.0, 45.0, 133.0] {
        let found = plot.direction_deg(plot.at(direction_deg, 10.0)).unwrap();
        assert!((found - direction_deg).abs() < 1e-3, "{found}");
    }
    assert_eq!(plot.direction_deg(rect.center()), None);
    for silent in [f64::NEG_INFINITY, f64::NAN, -400.0] {
        assert_eq!(plot.at(45.0, silent), rect.center(), "{silent}");
    }
}

#[test]
fn nothing_odd_harms_the_pane() {
    let mut harness = Harness::builder()
        .with_size(vec2(400.0, 200.0))
        .build_ui(|ui| {
            let curves = Curves::default();
            let odd = ResponseView {
                textile: String::new(),
                rotation_deg: f64::NAN,
                factors: [f64::INFINITY, 0.0],
                uncertainty: None,
                place: None,
                curves: &curves,
                probe: Probe::default(),
                moving: Some(Velocity::new(f64::NAN, f64::INFINITY)),
                scale: AmplitudeScale::default(),
            };
            show(ui, None, &mut Commands::new());
            show(ui, Some(&odd), &mut Commands::new());
        });
    harness.run();
    for size in [vec2(30.0, 20.0), vec2(1000.0, 40.0), vec2(60.0, 900.0)] {
        let mut harness = window(Pane {
            rotation_deg: 300.0,
            ..pane()
        });
        harness.set_size(size);
        harness.run();
        assert!(harness.state().commands.is_empty(), "{size:?}");
    }
}

#[test]
fn a_textile_that_was_not_measured_is_shaded_from_where_to_where_it_may_lie() {
    let mut harness = window(pane());
    harness.run();
    let state = harness.state();
    let view = |known: Option<Uncertainty>| ResponseView {
        textile: String::new(),
        rotation_deg: 0.0,
        factors: [1.0; 2],
        uncertainty: known,
        place: None,
        curves: &state.curves,
        probe: state.probe,
        moving: None,
        scale: AmplitudeScale::default(),
    };
    let known = Uncertainty {
        levels: vec![[40.0, 0.0, -6.0, 2.0], [320.0, 0.0, -1.0, 4.0]],
        ..Uncertainty::default()
    };
    let plain = chart::over_speed(&view(None));
    let shaded = chart::over_speed(&view(Some(known)));
    assert_eq!(shaded.bands.len(), plain.bands.len() + 2);
    let of = |name: &str| shaded.bands.iter().find(|band| band.name == name).unwrap();
    for (name, width_db) in [("40 Hz is known to", 8.0), ("320 Hz is known to", 5.0)] {
        let points = &of(name).points;
        let is_wide = |[_, low, high]: &[f64; 3]| (high - low - width_db).abs() < 1e-9;
        assert!(
            points.len() > 10 && points.iter().all(is_wide),
            "{name}: {points:?}"
        );
    }
    let ends = shaded.columns.points("a40_low_db", "a320_high_db");
    assert_eq!(ends[0], [-6.0, 4.0]);
}
