//! The arrangement of the window: which pane stands where.

use std::sync::PoisonError;

use eframe::egui::{self, Align, CentralPanel, Frame, Margin, Panel, ScrollArea, Ui};

use super::panes::{self, Wishes};
use super::pointer::Ground;
use super::theme::{Palette, STEP};
use super::view::SceneView;
use super::window::{Layout, Transient, Workbench};
use super::workspace;

/// Height of the header, points.
const HEADER: f32 = 44.0;
/// Width of the controls, points.
const CONTROLS: f32 = 336.0;
/// Height of the live pictures in a high and in a low window, points.
const PICTURES: [f32; 2] = [224.0, 196.0];
/// A window lower than this is low, points.
const LOW: f32 = 800.0;

/// Shows one frame; says what the user wants.
pub(crate) fn show(bench: &mut Workbench, ui: &mut Ui) -> Wishes {
    let mut wishes = Wishes::new();
    let scene = bench.scene_view();
    let (transient, layout) = (&mut bench.transient, bench.layout);
    show_controls(ui, &scene, transient, layout, &mut wishes);
    show_pictures(ui, &scene, transient, layout);
    let central = CentralPanel::default().frame(Frame::new());
    let shown = central
        .show(ui, |ui| {
            workspace::show(ui, &scene, &transient.live, &transient.trail)
        })
        .inner;
    panes::show_notices(ui, shown.ground, &transient.notices, &mut wishes);
    if let Some(ask) = &mut transient.ask {
        panes::show_ask(ui, shown.ground, ask, &mut wishes);
    }
    let ground = Ground {
        view: shown.view,
        rect: shown.ground,
        size_mm: scene.size_mm,
        pixels_per_point: ui.ctx().pixels_per_point(),
    };
    feel(bench, ui.ctx(), ground);
    wishes
}

/// The header, and the controls on the right.
fn show_controls(
    ui: &mut Ui,
    scene: &SceneView,
    transient: &mut Transient,
    layout: Layout,
    wishes: &mut Wishes,
) {
    Panel::top("header")
        .exact_size(HEADER)
        .frame(panel(ui, 16, 0))
        .show(ui, |ui| {
            panes::show_header(ui, scene, &transient.live, layout.colour_map, wishes);
        });
    let controls = Panel::right("controls")
        .exact_size(CONTROLS)
        .resizable(false);
    controls.frame(panel(ui, 0, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            Frame::new()
                .inner_margin(Margin::symmetric(16, 0))
                .show(ui, |ui| {
                    panes::show_tuning(ui, scene, &transient.live, wishes);
                    ui.add_space(2.0 * STEP);
                    let target = transient.target.as_deref();
                    panes::show_bridge(ui, &transient.live, target, &mut transient.port, wishes);
                });
        });
    });
}

/// The live pictures at the bottom.
fn show_pictures(ui: &mut Ui, scene: &SceneView, transient: &Transient, layout: Layout) {
    let is_low = ui.ctx().content_rect().height() < LOW;
    let height = if is_low { PICTURES[1] } else { PICTURES[0] };
    let pictures = Panel::bottom("pictures")
        .exact_size(height)
        .resizable(false);
    pictures.frame(panel(ui, 16, 12)).show(ui, |ui| {
        ui.with_layout(egui::Layout::left_to_right(Align::Min), |ui| {
            panes::show_heatmaps(ui, scene, &transient.live, layout.colour_map);
            ui.add_space(4.0 * STEP);
            panes::show_strip(ui, &transient.levels);
        });
    });
}

fn panel(ui: &Ui, across: i8, down: i8) -> Frame {
    Frame::new()
        .fill(Palette::in_ui(ui).panel)
        .inner_margin(Margin::symmetric(across, down))
}

/// Tells the tap where the workspace is, and feeds it when nobody else does.
fn feel(bench: &Workbench, ctx: &egui::Context, ground: Ground) {
    let is_covered = bench.transient.ask.is_some();
    let mut tap = bench.tap.lock().unwrap_or_else(PoisonError::into_inner);
    tap.set_ground((!is_covered).then_some(ground));
    if bench.is_stepped {
        let moved = ctx.input(|input| {
            let is_move = |event: &egui::Event| matches!(event, egui::Event::PointerMoved(_));
            input
                .events
                .iter()
                .any(is_move)
                .then(|| input.pointer.latest_pos())
                .flatten()
        });
        if let Some(at) = moved {
            tap.moved_to(bench.stamp(), at);
        }
    }
}
