//! What is selected, in numbers; everything that is shown where nothing is selected.

use eframe::egui::{self, Align2, Color32, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::kit::pane::scroll_area;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{paint_line, paint_quiet, small};
use crate::tools::collection::listing::{Sort, SortBy, smd_um};
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{CollectionView, Entry};
use crate::tools::collection::view::hand::{Hand, answer, paint_focus};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Height of the headings and of a row, points.
const HEAD: f32 = 34.0;
const LINE: f32 = 22.0;
/// Width of a column of numbers, points.
const NUMBER: f32 = 54.0;
/// The name's share of what is left of the width; the kind has the rest.
const NAME_SHARE: f32 = 0.6;
/// Columns: by what they are sorted, heading, unit, decimals.
const COLUMNS: [(SortBy, &str, &str, usize); 6] = [
    (SortBy::Name, "name", "", 0),
    (SortBy::Amplitude(Band::Low), "A40", "µm", 2),
    (SortBy::Amplitude(Band::High), "A320", "µm", 2),
    (SortBy::Level, "level", "dB", 1),
    (SortBy::Roughness, "SMD", "µm", 2),
    (SortBy::Kind, "kind", "", 0),
];

/// Shows the table.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let (head, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEAD), Sense::hover());
    for (column, cell) in (0..).zip(cells(head)) {
        show_heading(ui, cell, column, &mut hand.choice.sort);
    }
    let palette = Palette::in_ui(ui);
    let line = Stroke::new(1.0, palette.hairline);
    ui.painter().hline(head.x_range(), head.bottom(), line);
    ui.spacing_mut().item_spacing.y = 0.0;
    let listed = view.listed();
    scroll_area("collected").show_rows(ui, LINE, listed.len(), |ui, range| {
        for entry in &listed[range] {
            show_row(ui, entry, view.choice.is_tuned, hand);
        }
    });
}

/// The cells of a row, one for each column.
fn cells(row: Rect) -> [Rect; 6] {
    let rest = (row.width() - 4.0 * NUMBER).max(2.0 * NUMBER);
    let widths = COLUMNS.map(|(by, ..)| match by {
        SortBy::Name => NAME_SHARE * rest,
        SortBy::Kind => (1.0 - NAME_SHARE) * rest,
        _ => NUMBER,
    });
    let mut left = row.left();
    widths.map(|width| {
        let cell = Rect::from_min_size(pos2(left, row.top()), vec2(width, row.height()));
        left += width;
        cell
    })
}

/// A heading: a click sorts by it.
fn show_heading(ui: &Ui, cell: Rect, column: usize, sort: &mut Sort) {
    let (by, name, unit, decimals) = COLUMNS[column];
    let palette = Palette::in_ui(ui);
    let response = ui.interact(cell, ui.scope_id().with(("sort", column)), Sense::click());
    let is_sorted = sort.by == by;
    let label = format!("Sort by {name}");
    response.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_sorted, &label));
    let ink = match by {
        SortBy::Amplitude(band) => palette.band(band),
        _ if is_sorted || response.hovered() => palette.text,
        _ => palette.dim,
    };
    let painter = ui.painter();
    let (anchor, x) = if decimals > 0 {
        (Align2::RIGHT_CENTER, cell.right() - 4.0)
    } else {
        (
            Align2::LEFT_CENTER,
            cell.left() + if column == 0 { 4.0 } else { 10.0 },
        )
    };
    let middle = cell.top() + 10.0;
    let text = painter.text(pos2(x, middle), anchor, name, theme::small(), ink);
    let below = pos2(x, middle + 13.0);
    paint_quiet(painter, below, anchor, unit);
    if is_sorted {
        let at = pos2(
            if decimals > 0 {
                text.left() - 6.0
            } else {
                text.right() + 6.0
            },
            middle,
        );
        paint_arrow(ui, at, *sort, palette.text);
    }
    paint_focus(ui, &response);
    if response.clicked() {
        *sort = sort.after(by);
    }
    response.on_hover_text(label);
}

fn paint_arrow(ui: &Ui, at: egui::Pos2, sort: Sort, ink: Color32) {
    let up = if sort.is_falling { 1.0 } else { -1.0 };
    let corners = [
        vec2(-3.0, -2.0 * up),
        vec2(3.0, -2.0 * up),
        vec2(0.0, 2.5 * up),
    ];
    let corners = corners.map(|by| at + by).to_vec();
    ui.painter()
        .add(Shape::convex_polygon(corners, ink, Stroke::NONE));
}

fn show_row(ui: &mut Ui, entry: &Entry<'_>, is_tuned: bool, hand: &mut Hand<'_>) {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), LINE);
    let (row, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let is_selected = entry.is_selected;
    let texts = COLUMNS.map(|(by, _, _, decimals)| text_of(entry, by, decimals, is_tuned));
    let label = format!("{} in the table: {}", texts[0], texts[1..5].join(", "));
    response.widget_info(|| WidgetInfo::selected(egui::Role::ListItem, true, is_selected, &label));
    if response.hovered() || entry.is_marked {
        ui.painter().rect_filled(row, 4, palette.raised);
    }
    paint_focus(ui, &response);
    let (_, is_stated) = smd_um(entry);
    for ((by, _, _, decimals), (cell, text)) in
        COLUMNS.into_iter().zip(cells(row).iter().zip(texts))
    {
        if decimals > 0 {
            let is_dim = by == SortBy::Roughness && !is_stated;
            let ink = if is_dim { palette.dim } else { palette.text };
            let at = pos2(cell.right() - 4.0, cell.center().y);
            ui.painter()
                .text(at, Align2::RIGHT_CENTER, text, theme::number(), ink);
            continue;
        }
        let is_name = by == SortBy::Name;
        let (ink, indent) = if is_name {
            (palette.text, 4.0)
        } else {
            (palette.dim, 10.0)
        };
        let text = small(text, ink);
        let at = pos2(cell.left() + indent, cell.center().y);
        paint_line(ui, at, cell.width() - indent, text);
    }
    answer(ui, &response, entry, hand);
}

/// What stands in a cell.
fn text_of(entry: &Entry<'_>, by: SortBy, decimals: usize, is_tuned: bool) -> String {
    let value = match by {
        SortBy::Name | SortBy::Library => return entry.item.name.clone(),
        SortBy::Kind => return entry.item.kind.clone(),
        SortBy::Amplitude(band) => entry.value(&Measure::Amplitude(band), is_tuned),
        SortBy::Level => entry.value(&Measure::Level, is_tuned),
        SortBy::Roughness => smd_um(entry).0,
    };
    value.map_or_else(|| "–".to_owned(), |value| quantity::fixed(value, decimals))
}
