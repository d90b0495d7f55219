//! Where a textile of the library is let go: it is placed with its middle there.

use eframe::egui::{DragAndDrop, Rect, Stroke, StrokeKind, Ui, vec2};

use crate::bench::command::Commands;
use crate::bench::command::edit::Edit;
use crate::bench::editing::new_size_mm;
use crate::bench::library_view::LibraryItem;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::tools::workspace::stage::Stage;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity;

/// Shows where a carried textile would lie, and places it when it is let go.
pub(crate) fn take(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) {
    if !DragAndDrop::has_payload_of_type::<LibraryItem>(ui.ctx()) {
        return;
    }
    let Some(at) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    let under = stage.view.workspace(at);
    let middle = Point::new(under.x_mm.round(), under.y_mm.round());
    if let Some(item) = stage.response.dnd_release_payload::<LibraryItem>() {
        commands.push(Edit::AddCloth(item.id.clone(), middle).into());
    } else if stage.response.dnd_hover_payload::<LibraryItem>().is_some() {
        paint_ghost(ui, stage, middle);
    }
}

fn paint_ghost(ui: &Ui, stage: &Stage<'_>, middle: Point) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(stage.ground);
    let size_mm = new_size_mm(stage.sight.scene.size_mm);
    let size = size_mm.map(|mm| stage.view.length(mm));
    let ghost = Rect::from_center_size(stage.view.screen(middle), vec2(size[0], size[1]));
    painter.rect_filled(ghost, 0, palette.selection.gamma_multiply(0.12));
    let edge = Stroke::new(1.5, palette.selection);
    painter.rect_stroke(ghost, 0, edge, StrokeKind::Inside);
    let [width, height] = size_mm.map(|mm| quantity::fixed(mm, 0));
    let words = format!("{width} × {height} mm");
    let galley = painter.layout_no_wrap(words, theme::number(), palette.text);
    let plate = Rect::from_center_size(ghost.center(), galley.size() + vec2(12.0, 6.0));
    painter.rect_filled(plate, 4, palette.tag);
    painter.galley(plate.min + vec2(6.0, 3.0), galley, palette.text);
}
