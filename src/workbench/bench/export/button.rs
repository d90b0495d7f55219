//! The small button that every pane with numbers has: save them as a picture or a table, or copy
//! them.

use eframe::egui::{self, Popup, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::bench::export::Exportable;
use crate::kit::theme::Palette;

/// Width and height of the button, points.
pub(crate) const SIZE: f32 = 18.0;
/// Width of its menu, points.
const MENU: f32 = 196.0;

/// Shows the button; its menu opens on a click.
pub(crate) fn show(ui: &mut Ui, what: Exportable, commands: &mut Commands) {
    let name = format!("Export {}", what.title());
    let (rect, response) = ui.allocate_exact_size(vec2(SIZE, SIZE), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), &name));
    let menu = Popup::menu(&response);
    let palette = Palette::in_ui(ui);
    let is_lit = menu.is_open() || response.hovered() || response.has_focus();
    let (ground, ink) = if is_lit {
        (palette.hovered, palette.text)
    } else {
        (palette.raised, palette.dim)
    };
    ui.painter().rect_filled(rect, 3, ground);
    paint(ui, rect, Stroke::new(1.25, ink));
    menu.show(|ui| {
        ui.set_min_width(MENU);
        let ask = FileCommand::Ask(Purpose::Export(what));
        entry(ui, "Save as PNG, SVG or CSV…", ask, commands);
        entry(ui, "Copy as CSV", FileCommand::CopyTable(what), commands);
    });
    response.on_hover_text(name);
}

fn entry(ui: &mut Ui, label: &str, command: FileCommand, commands: &mut Commands) {
    if ui.button(label).clicked() {
        commands.push(command.into());
        ui.close();
    }
}

/// An arrow out of a tray.
fn paint(ui: &Ui, rect: Rect, stroke: Stroke) {
    let painter = ui.painter();
    let at = |x: f32, y: f32| rect.center() + vec2(x, y);
    painter.line_segment([at(0.0, 1.5), at(0.0, -5.0)], stroke);
    let head = vec![at(-2.75, -2.25), at(0.0, -5.0), at(2.75, -2.25)];
    painter.add(egui::Shape::line(head, stroke));
    let tray = vec![at(-5.0, 0.5), at(-5.0, 5.0), at(5.0, 5.0), at(5.0, 0.5)];
    painter.add(egui::Shape::line(tray, stroke));
}

/// Where the button stands at the upper right corner of a picture without a row of tabs.
pub(crate) fn place_in(rect: Rect) -> Rect {
    let corner = pos2(rect.right() - SIZE, rect.top() - 6.0);
    Rect::from_min_size(corner, vec2(SIZE, SIZE))
}
