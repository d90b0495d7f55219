//! The workspace: the scene in mm from above, with the display moving over it, and a lens that
//! shows what lies under the finger.
//!
//! Draws and says where the pointer is; what the pointer does is the engine's business.

mod cloth;
mod display;
mod lens;
mod ruler;
mod trail;
mod transform;

pub(crate) use trail::Trail;
pub(crate) use transform::ViewTransform;

use eframe::egui::{
    self, CursorIcon, Painter, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use super::theme::{self, Palette};
use super::view::{Live, SceneView};
use crate::geometry::Point;

/// Space around the workspace, points.
const MARGIN: f32 = 16.0;

/// What came of showing the workspace.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// How mm are laid on the screen.
    pub(crate) view: ViewTransform,
    /// The part of the screen where the pointer feels.
    pub(crate) ground: Rect,
}

/// Shows the workspace in all the space that is left.
pub(crate) fn show(ui: &mut Ui, scene: &SceneView, live: &Live, trail: &Trail) -> Shown {
    let palette = Palette::in_ui(ui);
    let (frame, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    ui.painter().rect_filled(frame, 0, palette.floor);
    let inner = Rect::from_min_max(frame.min + vec2(ruler::LEFT, ruler::TOP), frame.max);
    let (ground, lens) = lens::split(inner, scene.size_mm);
    let view = ViewTransform::fitted(ground.shrink(MARGIN), scene.size_mm);
    let painter = ui.painter_at(inner);
    paint_extent(&painter, &view, scene.size_mm);
    paint_cloths(&painter, &view, scene, live);
    paint_tags(&painter, &view, scene, live);
    paint_display(&painter, &view, live, trail);
    ruler::paint(
        &ui.painter_at(frame),
        frame,
        &view,
        scene.size_mm,
        live.centre,
    );
    if let Some(lens) = lens {
        lens::show(ui, lens, scene, live, trail);
    }
    if live.is_stopped {
        paint_all_off(&painter, ground);
    }
    let response = response.on_hover_cursor(CursorIcon::Crosshair);
    response.widget_info(|| {
        let words = format!("Workspace with {} textiles", scene.cloths.len());
        WidgetInfo::labeled(egui::Role::Canvas, true, words)
    });
    Shown { view, ground }
}

/// Draws the textiles through a view; the lens uses it too.
fn paint_cloths(painter: &Painter, view: &ViewTransform, scene: &SceneView, live: &Live) {
    let under = live.cloth_under_display();
    for (index, cloth) in scene.cloths.iter().enumerate() {
        cloth::paint(painter, view, cloth, under == Some(index));
    }
    if scene.cloths.is_empty() {
        cloth::paint_empty(painter, view.rect());
    }
}

/// Draws trail and contactors through a view; the lens uses it too.
fn paint_display(painter: &Painter, view: &ViewTransform, live: &Live, trail: &Trail) {
    display::paint_trail(painter, view, &trail.aged());
    if live.centre.is_some() {
        display::paint(painter, view, &live.dots);
    }
}

fn paint_tags(painter: &Painter, view: &ViewTransform, scene: &SceneView, live: &Live) {
    let under = live.cloth_under_display();
    for (index, cloth) in scene.cloths.iter().enumerate() {
        cloth::paint_tag(painter, view, cloth, under == Some(index));
    }
}

/// Says that everything is off, and what ends that.
fn paint_all_off(painter: &Painter, ground: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    let words = "Everything is off. Arm to feel again.".to_owned();
    let galley = painter.layout_no_wrap(words, theme::body(), palette.text);
    let middle = ground.center_top() + vec2(0.0, 30.0);
    let pill = Rect::from_center_size(middle, galley.size() + vec2(32.0, 14.0));
    painter.rect_filled(pill, 15, palette.raised);
    painter.rect_stroke(
        pill,
        15,
        Stroke::new(1.0, palette.danger),
        StrokeKind::Inside,
    );
    painter.galley(middle - 0.5 * galley.size(), galley, palette.text);
}

fn paint_extent(painter: &Painter, view: &ViewTransform, size_mm: [f64; 2]) {
    let palette = Palette::of(painter.ctx().theme());
    let corners = [Point::default(), Point::new(size_mm[0], size_mm[1])];
    let [low, high] = corners.map(|corner| view.screen(corner));
    let extent = Rect::from_two_pos(low, high);
    painter.rect_stroke(
        extent,
        0,
        Stroke::new(1.0, palette.hairline),
        StrokeKind::Outside,
    );
}

/// Whether a place is in the workspace or so close that the display still reaches into it.
pub(crate) fn is_near(place: Point, size_mm: [f64; 2]) -> bool {
    let reach_mm = 20.0;
    let within = |at: f64, size: f64| (-reach_mm..=size + reach_mm).contains(&at);
    within(place.x_mm, size_mm[0]) && within(place.y_mm, size_mm[1])
}
