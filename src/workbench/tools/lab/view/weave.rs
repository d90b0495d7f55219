//! An interlacing as weavers draw it: a name, and a point paper whose crossings can be pressed.
//!
//! A filled cell is a warp end on top; the first pick is the lowest row, as on paper.

use eframe::egui::{Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::kit::theme::{Palette, STEP};
use crate::tools::lab::view::rows::combo;
use selvedge_foundation::files::KeyValue;
use selvedge_foundation::numerics::to_index;
use selvedge_textile::{Draft, Parameter, Weave};

/// What the list says of rows that are no named interlacing.
const OWN: &str = "its own";
/// Side of the largest cell, points.
const CELL: f32 = 13.0;
/// Height of the point paper, points.
const HEIGHT: f32 = 106.0;

/// Shows it; says the new interlacing when it was changed.
pub(crate) fn show(ui: &mut Ui, draft: &Draft, parameter: &Parameter) -> Option<KeyValue> {
    let value = draft.value(parameter.place)?;
    let now = value.as_str().unwrap_or(OWN);
    let names: Vec<&str> = Weave::INTERLACINGS.iter().map(|(name, _)| *name).collect();
    let chosen = combo(ui, parameter, now, &names).map(KeyValue::from);
    let rows = rows_of(value);
    let pressed = paper(ui, &rows);
    ui.add_space(STEP);
    chosen.or_else(|| Some(value_of(&turned(&rows, pressed?))))
}

/// The rows of an interlacing, from the first pick on.
fn rows_of(value: &KeyValue) -> Vec<Vec<bool>> {
    let cells = |row: &str| row.chars().map(|c| c == 'X').collect();
    if let Some(rows) = value.as_array() {
        let texts = rows.iter().filter_map(KeyValue::as_str);
        return texts.map(cells).collect();
    }
    let name = value.as_str().unwrap_or_default();
    let named = Weave::INTERLACINGS.iter().find(|(known, _)| *known == name);
    let rows = named.map_or(&[][..], |(_, rows)| rows);
    rows.iter().map(|row| cells(row)).collect()
}

/// The same with one crossing the other way round.
fn turned(rows: &[Vec<bool>], [pick, end]: [usize; 2]) -> Vec<Vec<bool>> {
    let mut rows = rows.to_vec();
    if let Some(cell) = rows.get_mut(pick).and_then(|row| row.get_mut(end)) {
        *cell = !*cell;
    }
    rows
}

/// Rows as a recipe states them: by name where they have one.
fn value_of(rows: &[Vec<bool>]) -> KeyValue {
    let text = |row: &Vec<bool>| -> String {
        let signs = row.iter().map(|is_warp| if *is_warp { 'X' } else { '.' });
        signs.collect()
    };
    let texts: Vec<String> = rows.iter().map(text).collect();
    let mut known = Weave::INTERLACINGS.iter();
    let named = known.find(|(_, rows)| rows.iter().eq(texts.iter()));
    named.map_or_else(|| texts.into(), |(name, _)| (*name).into())
}

/// The point paper; says which crossing was pressed: pick and end.
fn paper(ui: &mut Ui, rows: &[Vec<bool>]) -> Option<[usize; 2]> {
    let palette = Palette::in_ui(ui);
    let n_ends = rows.iter().map(Vec::len).max().unwrap_or(0);
    if n_ends == 0 {
        return None;
    }
    let width = ui.available_width();
    let cell = (HEIGHT / rows.len() as f32)
        .min(width / n_ends as f32)
        .min(CELL);
    let size = vec2(cell * n_ends as f32, cell * rows.len() as f32);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        let words = "Point paper: press a crossing to turn it over";
        WidgetInfo::labeled(eframe::egui::Role::Button, true, words)
    });
    for (pick, row) in rows.iter().enumerate() {
        for (end, is_warp) in row.iter().enumerate() {
            let corner = pos2(
                rect.left() + cell * end as f32,
                rect.bottom() - cell * (pick + 1) as f32,
            );
            let square = Rect::from_min_size(corner, vec2(cell, cell)).shrink(0.5);
            let ink = if *is_warp {
                palette.text
            } else {
                palette.raised
            };
            ui.painter().rect_filled(square, 1, ink);
        }
    }
    let cell_at = |at: eframe::egui::Pos2| {
        let whole = |x: f32| to_index(f64::from(x / cell));
        let (pick, end) = (whole(rect.bottom() - at.y), whole(at.x - rect.left()));
        [pick.min(rows.len() - 1), end.min(n_ends - 1)]
    };
    if let Some([pick, end]) = response.hover_pos().map(cell_at) {
        let corner = pos2(
            rect.left() + cell * end as f32,
            rect.bottom() - cell * (pick + 1) as f32,
        );
        let square = Rect::from_min_size(corner, vec2(cell, cell));
        let edge = Stroke::new(1.0, palette.selection);
        let inside = eframe::egui::StrokeKind::Inside;
        ui.painter().rect_stroke(square, 1, edge, inside);
    }
    let at = response
        .interact_pointer_pos()
        .filter(|_| response.clicked());
    response.on_hover_text("Bright: the warp lies on top. Press a crossing to turn it over");
    at.map(cell_at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_that_is_turned_twice_has_its_name_back() {
        let plain: KeyValue = "plain".into();
        let rows = rows_of(&plain);
        assert_eq!(rows, [[true, false], [false, true]]);
        let once = turned(&rows, [0, 1]);
        assert_eq!(
            value_of(&once),
            vec!["XX".to_owned(), ".X".to_owned()].into()
        );
        assert_eq!(rows_of(&value_of(&once)), once);
        assert_eq!(value_of(&turned(&once, [0, 1])), plain);
        assert_eq!(turned(&rows, [9, 9]), rows, "off the paper");
    }
}
