//! What lies on the ground: textiles with what is drawn over them, their tags, the display.

use eframe::egui::{Painter, Rect, Stroke, StrokeKind, Ui, accesskit};

use crate::bench::command::Tool;
use crate::bench::paint_display;
use crate::kit::swatch::paint_outline;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::{arrange, cloth, overlay};
use selvedge_foundation::geometry::Point;

/// Draws what lies on the ground. Says whose tag is under the pointer.
pub(crate) fn paint(ui: &Ui, stage: &Stage<'_>) -> Option<usize> {
    let painter = ui.painter_at(stage.ground);
    paint_extent(&painter, &stage.view, stage.sight.scene.size_mm);
    paint_cloths(&painter, &stage.view, stage);
    let tag = paint_tags(&painter, stage);
    if stage.sight.scene.cloths.is_empty() {
        cloth::paint_empty(&painter, stage.ground);
    }
    paint_marked(&painter, stage);
    paint_display(&painter, &stage.view, stage);
    declare(ui, stage);
    tag
}

/// Draws the textiles through a view; the lens uses it too.
pub(crate) fn paint_cloths(painter: &Painter, view: &ViewTransform, stage: &Stage<'_>) {
    let lifted = lifted(stage);
    for (index, cloth) in stage.sight.scene.cloths.iter().enumerate() {
        cloth::paint(painter, view, cloth, lifted == Some(index));
        overlay::paint_on_cloth(painter, view, stage, (index, cloth));
        if lifted == Some(index) {
            cloth::paint_lifted(painter, view, cloth);
        }
    }
}

/// The textile that is felt; where textiles are arranged, none is.
fn lifted(stage: &Stage<'_>) -> Option<usize> {
    match stage.state.tool {
        Tool::Feel => stage.sight.live.cloth_under_display(),
        Tool::Arrange => None,
    }
}

/// Draws trail and contactors through a view; the lens uses it too.
pub(crate) fn paint_display(painter: &Painter, view: &ViewTransform, stage: &Stage<'_>) {
    paint_display::paint_trail(painter, view, stage.sight.trail.aged());
    if stage.sight.live.centre.is_some() {
        let pointed = stage.sight.scene.marks.hovered.contactor;
        overlay::paint_velocities(painter, view, stage);
        paint_display::paint(
            painter,
            view,
            stage.sight.live,
            (stage.sight.selection, pointed),
        );
        overlay::paint_readings(painter, view, stage);
    }
}

/// Marks the textile that the pointer rests on in another view.
fn paint_marked(painter: &Painter, stage: &Stage<'_>) {
    let hovered = stage.sight.scene.marks.hovered.cloth;
    let elsewhere = hovered.filter(|_| stage.response.hover_pos().is_none());
    if let Some(cloth) = elsewhere.and_then(|index| stage.sight.scene.cloths.get(index)) {
        let palette = Palette::of(painter.ctx().theme());
        let corners = arrange::screen_corners(&stage.view, cloth);
        let edge = Stroke::new(1.5, palette.selection.gamma_multiply(0.7));
        paint_outline(painter, corners, edge);
    }
}

fn paint_tags(painter: &Painter, stage: &Stage<'_>) -> Option<usize> {
    let lifted = lifted(stage);
    let pointer = stage.response.hover_pos();
    let mut hovered = None;
    for (index, cloth) in stage.sight.scene.cloths.iter().enumerate() {
        let is_lit = lifted == Some(index) || stage.sight.scene.is_marked(index);
        let tag = cloth::paint_tag(painter, &stage.view, cloth, is_lit);
        if let (Some(tag), Some(at)) = (tag, pointer)
            && tag.contains(at)
        {
            hovered = Some(index);
        }
    }
    hovered
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

/// Declares every textile in sight to the accessibility tree: painted, they would not be there,
/// with its place on the screen.
fn declare(ui: &Ui, stage: &Stage<'_>) {
    for (index, cloth) in stage.sight.scene.cloths.iter().enumerate() {
        let bounds = arrange::screen_bounds(&stage.view, cloth).intersect(stage.ground);
        if !bounds.is_positive() {
            continue;
        }
        let id = ui.scope_id().with(("textile in the workspace", index));
        let name = format!("Textile {} {}", cloth.label, cloth.name);
        ui.ctx().accesskit_node_builder(id, |node| {
            node.set_role(accesskit::Role::Figure);
            node.set_label(name);
            node.set_bounds(accesskit_rect(bounds));
        });
    }
}

fn accesskit_rect(rect: Rect) -> accesskit::Rect {
    accesskit::Rect {
        x0: rect.min.x.into(),
        y0: rect.min.y.into(),
        x1: rect.max.x.into(),
        y1: rect.max.y.into(),
    }
}
