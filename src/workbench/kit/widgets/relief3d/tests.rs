//! The block under the hands of a simulated user, and its picture.

use eframe::egui::accesskit::Role as AccessRole;
use eframe::egui::{
    Context, Event, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, RawInput,
    TouchPhase,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::kit::theme;
use crate::shell::raster::{Picture, Rasteriser};

const NAME: &str = "Relief of the test";
/// Between frames, s: smooth scrolling is over in a few.
const SLOW_S: f32 = 0.25;

struct Bench {
    relief: Relief3d,
    view: View3d,
}

fn waves(n: usize) -> Relief3d {
    let mut grid = Grid::filled(n, n, 0.0);
    for row in 0..n {
        for column in 0..n {
            let phase = |i: usize| std::f64::consts::TAU * 3.0 * i as f64 / n as f64;
            grid.row_mut(row)[column] = 60.0 * (phase(row).sin() * phase(column).cos());
        }
    }
    Relief3d::of(&HeightMap::new(grid, [4.0 / n as f64; 2]).unwrap())
}

fn window(relief: Relief3d, step_s: f32) -> Harness<'static, Bench> {
    let view = View3d::for_relief(&relief);
    let mut is_styled = false;
    let show = move |ui: &mut Ui, bench: &mut Bench| {
        if !is_styled {
            theme::install(ui.ctx());
            is_styled = true;
        }
        if let Some(view) = relief3d(ui, NAME, &bench.relief, bench.view) {
            bench.view = view;
        }
    };
    Harness::builder()
        .with_size(vec2(520.0, 420.0))
        .with_step_dt(step_s)
        .build_ui_state(show, Bench { relief, view })
}

fn n_meshes(harness: &Harness<'_, Bench>) -> u64 {
    let kept: Option<Kept> = harness.ctx.data(|data| data.get_temp(mesh_id(NAME)));
    kept.map_or(0, |kept| kept.n_made)
}

#[test]
fn dragging_turns_it_the_wheel_brings_it_nearer_and_a_double_click_goes_back() {
    let mut harness = window(waves(64), SLOW_S);
    harness.run();
    let first = harness.state().view;
    let block = harness.get_by_role_and_label(AccessRole::Image, NAME);
    let middle = block.rect().center();
    harness.drag_at(middle);
    harness.event(Event::PointerMoved(middle + vec2(40.0, -20.0)));
    harness.run();
    harness.drop_at(middle + vec2(40.0, -20.0));
    harness.run();
    let turned = harness.state().view;
    assert!(
        (turned.yaw_deg - first.yaw_deg - 20.0).abs() < 1.0,
        "{turned:?}"
    );
    assert!(
        (turned.pitch_deg - first.pitch_deg + 10.0).abs() < 1.0,
        "{turned:?}"
    );
    harness.event(Event::PointerMoved(middle));
    harness.run();
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, 3.0),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run();
    let zoom = harness.state().view.zoom;
    assert!(zoom > 1.05, "{zoom}");
}

#[test]
fn a_double_click_goes_back_to_the_first_view() {
    let mut harness = window(waves(64), 0.02);
    harness.run();
    let first = harness.state().view;
    let middle = harness
        .get_by_role_and_label(AccessRole::Image, NAME)
        .rect()
        .center();
    harness.state_mut().view = first.turned(50.0, 10.0).nearer(2.0);
    harness.step();
    harness.event(Event::PointerMoved(middle));
    for is_down in [true, false, true, false] {
        harness.event(Event::PointerButton {
            pos: middle,
            button: PointerButton::Primary,
            pressed: is_down,
            modifiers: Modifiers::NONE,
        });
        harness.step();
    }
    harness.step();
    assert_eq!(harness.state().view, first);
}

#[test]
fn keys_turn_it_and_tools_are_told_what_it_shows() {
    let mut harness = window(waves(64), SLOW_S);
    harness.run();
    let before = harness.state().view;
    harness
        .get_by_role_and_label(AccessRole::Image, NAME)
        .focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.key_press(Key::ArrowDown);
    harness.key_press(Key::Plus);
    harness.run();
    let after = harness.state().view;
    assert!(
        (after.yaw_deg - before.yaw_deg - 5.0).abs() < 1e-3,
        "{after:?}"
    );
    assert!(
        (after.pitch_deg - before.pitch_deg - 5.0).abs() < 1e-3,
        "{after:?}"
    );
    assert!(after.zoom > before.zoom);
    let words = spoken(&harness.state().relief, after);
    assert!(
        words.contains("4.00 by 4.00 mm") && words.contains("120 µm"),
        "{words}"
    );
    harness.get_by_role_and_label(AccessRole::Slider, "Exaggeration");
}

#[test]
fn nothing_is_made_again_while_nothing_changes() {
    let mut harness = window(waves(300), SLOW_S);
    harness.run();
    let first = n_meshes(&harness);
    assert!(first >= 1);
    for _ in 0..5 {
        harness.step();
    }
    assert_eq!(n_meshes(&harness), first, "the mesh is kept");
    harness.state_mut().view.yaw_deg += 10.0;
    harness.step();
    assert_eq!(n_meshes(&harness), first + 1);
}

#[test]
fn large_maps_are_averaged_and_odd_ones_are_drawn() {
    let large = waves(300);
    let n = [large.heights_um.width(), large.heights_um.height()];
    assert_eq!(n, [MOST_POINTS; 2]);
    assert!((large.size_mm()[0] - 4.0).abs() < 1e-9);
    assert!(
        (large.relief_um() - 120.0).abs() < 3.0,
        "{}",
        large.relief_um()
    );
    for (width, height) in [(1, 1), (1, 40), (40, 1), (2, 2), (3, 700)] {
        for value in [0.0, 1e12, -5.0] {
            let map = HeightMap::new(Grid::filled(width, height, value), [0.02; 2]).unwrap();
            let relief = Relief3d::of(&map);
            let view = View3d::for_relief(&relief);
            assert!(view.exaggeration.is_finite());
            let rect = Rect::from_min_size(Pos2::ZERO, vec2(300.0, 200.0));
            for (yaw, pitch) in [(0.0, 0.0), (90.0, 50.0), (211.0, -80.0)] {
                let projection = Projection::of(&relief, view.turned(yaw, pitch), rect);
                let mesh = mesh::of(&relief, &projection, Palette::of(eframe::egui::Theme::Dark));
                assert!(mesh.is_valid());
                assert!(
                    mesh.vertices
                        .iter()
                        .all(|v| v.pos.x.is_finite() && v.pos.y.is_finite())
                );
            }
        }
    }
}

#[test]
fn what_is_in_front_is_painted_last() {
    let relief = waves(32);
    let rect = Rect::from_min_size(Pos2::ZERO, vec2(300.0, 200.0));
    for yaw in [0.0, 30.0, 100.0, 200.0, 300.0] {
        let view = View3d {
            yaw_deg: yaw,
            ..View3d::for_relief(&relief)
        };
        let projection = Projection::of(&relief, view, rect);
        let [x, y] = projection.nearest();
        let [u, w, _] = projection.half;
        let away = |sx: f32, sy: f32| projection.turned([sx * u, sy * w])[1];
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
        let nearest = corners.into_iter().map(|[sx, sy]| away(sx, sy));
        let nearest = nearest.fold(f32::INFINITY, f32::min);
        assert!((away(x, y) - nearest).abs() < 1e-4, "{yaw}°");
    }
}

/// Writes pictures of it where `SELVEDGE_PICTURES` says, and looks that there is something on them.
#[test]
fn it_can_be_seen_in_both_themes() {
    for (name, theme) in [
        ("dark", eframe::egui::Theme::Dark),
        ("light", eframe::egui::Theme::Light),
    ] {
        for (view_name, yaw, pitch) in [
            ("corner", 30.0, 40.0),
            ("above", 0.0, 90.0),
            ("low", 205.0, 15.0),
        ] {
            let picture = picture(&waves(96), theme, [yaw, pitch]);
            let colours: std::collections::BTreeSet<&[u8]> = picture.rgba.chunks_exact(4).collect();
            assert!(
                colours.len() > 60,
                "{name} {view_name}: {} colours",
                colours.len()
            );
            let Some(folder) = std::env::var_os("SELVEDGE_PICTURES") else {
                continue;
            };
            let path = std::path::Path::new(&folder).join(format!("relief-{name}-{view_name}.png"));
            let (width, height) = (picture.width, picture.height);
            let png =
                selvedge_foundation::files::encode_png_rgba(&picture.rgba, width, height, &path)
                    .unwrap();
            std::fs::write(&path, png).unwrap();
        }
    }
}

fn picture(
    relief: &Relief3d,
    theme: eframe::egui::Theme,
    [yaw_deg, pitch_deg]: [f32; 2],
) -> Picture {
    let ctx = Context::default();
    theme::install(&ctx);
    ctx.set_theme(theme);
    let view = View3d {
        yaw_deg,
        pitch_deg,
        ..View3d::for_relief(relief)
    };
    let mut rasteriser = Rasteriser::default();
    let mut shapes = Vec::new();
    for _ in 0..3 {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(520.0, 420.0))),
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |ui| {
            relief3d(ui, NAME, relief, view);
        });
        rasteriser.apply(&mut output.textures_delta);
        shapes = output.shapes;
    }
    let primitives = ctx.tessellate(shapes, 1.0);
    rasteriser.draw(&primitives, [520, 420], 1.0, Palette::of(theme).panel)
}
