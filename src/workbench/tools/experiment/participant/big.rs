//! Buttons to be seen and hit from a metre away: large, with an edge, lit under the pointer, ringed
//! where the keys are.

use eframe::egui::{
    self, Align2, Color32, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};

/// Height of a row of large controls, points.
pub(crate) const ROW: f32 = 56.0;
/// Height of a button in it, points.
const HEIGHT: f32 = ROW - 2.0 * STEP;
/// How round corners are, points.
const ROUND: u8 = 8;

/// A large button, at least so wide, that is chosen or not; read out as `label`.
pub(crate) fn button(
    ui: &mut Ui,
    (words, label): (&str, &str),
    least: f32,
    is_on: bool,
) -> Response {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(words.to_owned(), theme::large(), palette.text);
    let size = vec2((galley.size().x + 8.0 * STEP).max(least), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let is_enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::selected(egui::Role::Button, is_enabled, is_on, label));
    let face = match (is_enabled, is_on) {
        (false, _) => Face::dead(palette),
        (true, true) => Face::chosen(palette),
        (true, false) => Face::loose(palette, response.hovered()),
    };
    paint(ui, rect, face);
    ring(ui, rect, &response);
    let ink = match (is_on, is_enabled) {
        (true, _) => palette.panel,
        (false, true) => palette.text,
        (false, false) => palette.dim,
    };
    let at = rect.center();
    ui.painter()
        .text(at, Align2::CENTER_CENTER, words, theme::large(), ink);
    response
}

/// How a surface that can be pressed is filled and edged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    fill: Color32,
    edge: Color32,
}

impl Face {
    /// Something that cannot be pressed now.
    fn dead(palette: &Palette) -> Self {
        Self {
            fill: palette.panel,
            edge: palette.hairline,
        }
    }

    /// Something that was chosen.
    fn chosen(palette: &Palette) -> Self {
        Self {
            fill: palette.selection,
            edge: palette.selection,
        }
    }

    /// Something that can be pressed or taken.
    pub(crate) fn loose(palette: &Palette, is_lit: bool) -> Self {
        let (fill, edge) = if is_lit {
            (palette.hovered, palette.text)
        } else {
            (palette.raised, palette.line)
        };
        Self { fill, edge }
    }

    /// A place for it.
    pub(crate) fn place(palette: &Palette, is_lit: bool) -> Self {
        Self {
            fill: palette.floor,
            edge: if is_lit {
                palette.selection
            } else {
                palette.line
            },
        }
    }
}

/// Paints such a surface.
pub(crate) fn paint(ui: &Ui, rect: Rect, face: Face) {
    let edge = Stroke::new(1.0, face.edge);
    ui.painter()
        .rect(rect, ROUND, face.fill, edge, StrokeKind::Inside);
}

/// A ring around what the keys go to.
pub(crate) fn ring(ui: &Ui, rect: Rect, response: &Response) {
    if response.has_focus() {
        let stroke = Stroke::new(2.0, Palette::in_ui(ui).selection);
        let around = rect.expand(3.0);
        ui.painter()
            .rect_stroke(around, ROUND + 3, stroke, StrokeKind::Inside);
    }
}
