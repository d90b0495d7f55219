//! Larger pieces of cloth to look through; only those in sight are read and drawn.

use eframe::egui::{self, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use crate::bench::view::ClothPicture;
use crate::kit::pane::scroll_area;
use crate::kit::swatch;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{paint_line, quiet, small};
use crate::tools::collection::state::{CollectionView, Entry};
use crate::tools::collection::view::hand::{Hand, answer, paint_focus};
use selvedge_foundation::numerics::to_index;

/// Side of a piece of cloth, points.
const SIDE: f32 = 112.0;
/// How much cloth it shows, mm.
const SHOWN_MM: f32 = 36.0;
/// Between neighbours, points.
const GAP: f32 = 12.0;
/// Height of the words below it, points.
const WORDS: f32 = 44.0;

/// Shows the pieces in rows.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let room = ui.available_width() - 12.0;
    let n_columns = to_index(f64::from((room + GAP) / (SIDE + GAP))).max(1);
    let rows: Vec<&[Entry<'_>]> = view.entries.chunks(n_columns).collect();
    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
    scroll_area("cloths").show_rows(ui, SIDE + WORDS, rows.len(), |ui, range| {
        for row in &rows[range] {
            ui.horizontal(|ui| {
                for entry in *row {
                    let library_view = &mut hand.bench.library.view;
                    library_view.want(&entry.item.id);
                    let picture = library_view.picture(&entry.item.id);
                    show_piece(ui, entry, picture, hand);
                }
            });
        }
    });
}

fn show_piece(ui: &mut Ui, entry: &Entry<'_>, picture: Option<ClothPicture>, hand: &mut Hand<'_>) {
    let palette = Palette::in_ui(ui);
    let (rect, response) =
        ui.allocate_exact_size(vec2(SIDE, SIDE + WORDS), Sense::click_and_drag());
    let name = format!("Piece of {}", entry.item.name);
    let (is_selected, is_usable) = (entry.is_selected, entry.item.flaw.is_none());
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::ListItem, is_usable, is_selected, &name));
    let square = Rect::from_min_size(rect.min, vec2(SIDE, SIDE));
    swatch::paint(ui.painter(), square, SHOWN_MM, picture);
    if entry.is_selected || entry.is_marked || response.hovered() {
        let (width, ink) = if entry.is_selected {
            (3.0, palette.selection)
        } else {
            (1.0, palette.line)
        };
        let stroke = Stroke::new(width, ink);
        ui.painter()
            .rect_stroke(square, 0, stroke, StrokeKind::Inside);
    }
    if entry.placed.is_some() {
        let stroke = Stroke::new(1.5, palette.panel);
        let corner = square.right_top() + vec2(-8.0, 8.0);
        ui.painter().circle(corner, 4.0, palette.text, stroke);
    }
    paint_focus(ui, &response);
    let ink = if is_usable { palette.text } else { palette.dim };
    let structure = entry.item.structure.unwrap_or_default();
    let kind = if is_usable {
        entry.item.kind.as_str()
    } else {
        "cannot be read"
    };
    let lines = [small(&entry.item.name, ink), quiet(kind), quiet(structure)];
    for (below, line) in [9.0, 23.0, 37.0].into_iter().zip(lines) {
        let at = pos2(square.left(), square.bottom() + below);
        paint_line(ui, at, SIDE, line);
    }
    answer(ui, &response, entry, hand);
    response.on_hover_ui(|ui| {
        let flaw = entry.item.flaw.as_deref();
        let tip = "Click to select it, double click to add it, drag it into the workspace";
        let words = flaw.unwrap_or(tip);
        ui.label(format!("{}\n{words}", entry.item.name));
    });
}
