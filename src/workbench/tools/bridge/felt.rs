//! What the emulator's contactors are told and what a model says they do, number by number.

use eframe::egui::{
    self, Align2, Painter, Rect, Response, RichText, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fold::described_fold;
use crate::kit::widgets::text::{paint_quiet, paragraph, quiet, row, small};
use crate::tools::bridge::actuators::{ActuatorPeek, PlantCell, PlantView};
use selvedge_device::Skin;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Space between grids, points.
const BETWEEN: f32 = 12.0;
/// Height of a grid's title, points.
const TITLE: f32 = 20.0;
/// Width of a number, points.
const CELL: f32 = 42.0;
/// Height of a line of numbers, points.
const LINE: f32 = 13.0;

/// Shows the section; it opens and closes by its title.
pub(crate) fn show(ui: &mut Ui, peek: &mut ActuatorPeek) {
    let ActuatorPeek {
        view,
        skin,
        is_open,
        ..
    } = peek;
    let tip = "What the emulator’s contactors would do under a finger, beside what they are told";
    let part = ("Displacement by a model", view.is_open);
    let head = described_fold(ui, part, "", |ui| show_open(ui, view, skin));
    if head.on_hover_text(tip).clicked() {
        *is_open = !view.is_open;
        ui.ctx().request_repaint();
    }
}

fn show_open(ui: &mut Ui, view: &PlantView, skin: &mut Skin) {
    show_skin(ui, skin);
    let palette = Palette::in_ui(ui);
    if view.contactors.is_empty() {
        let words = "Waiting for the emulator’s next tick…";
        ui.label(RichText::new(words).color(palette.dim));
    } else {
        show_grids(ui, view);
        paragraph(ui, small(troubles(&view.contactors), palette.text));
    }
    let words = format!(
        "A model estimate, no measurement: design-sheet values of beams of {}; skin {}.",
        view.beams, view.skin
    );
    paragraph(ui, quiet(&words));
}

/// The finger: one of those that have a name.
fn show_skin(ui: &mut Ui, chosen: &mut Skin) {
    row(ui, "Finger", |ui| {
        for (name, skin) in Skin::NAMED.into_iter().rev() {
            let label = capitalised(name);
            let tip = format!("Every contactor under skin: {skin}");
            let choice = ui.selectable_label(skin == *chosen, label);
            if choice.on_hover_text(tip).clicked() && skin != *chosen {
                *chosen = skin;
                ui.ctx().request_repaint();
            }
        }
    });
}

fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

/// Both bands side by side and the current below, or beside them where there is room.
fn show_grids(ui: &mut Ui, view: &PlantView) {
    let n_columns = view.n_columns.max(1);
    let n_rows = view.contactors.len().div_ceil(n_columns);
    let room = ui.available_width();
    let cell = ((room - BETWEEN) / (2 * n_columns) as f32)
        .floor()
        .clamp(8.0, CELL);
    let grid_width = cell * n_columns as f32;
    let is_wide = room >= 3.0 * grid_width + 2.0 * BETWEEN;
    let pair_height = TITLE + 2.0 * LINE * n_rows as f32 + STEP * n_rows as f32;
    let current_height = TITLE + LINE * n_rows as f32;
    let height = if is_wide {
        pair_height
    } else {
        pair_height + STEP + current_height
    };
    let (rect, response) = ui.allocate_exact_size(vec2(room, height), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, in_words(view)));
    let place = |nth: usize| {
        let (across, down) = match (nth, is_wide) {
            (2, false) => (0.0, pair_height + STEP),
            _ => (nth as f32 * (grid_width + BETWEEN), 0.0),
        };
        Rect::from_min_size(rect.min + vec2(across, down), vec2(grid_width, height))
    };
    let painter = ui.painter();
    let palette = Palette::in_ui(ui);
    for (nth, band) in Band::ALL.into_iter().enumerate() {
        let at = place(nth);
        let hz = band.carrier_hz();
        paint_title(painter, at, &format!("{hz} Hz"), "µm", palette.band(band));
        for (index, one) in view.contactors.iter().enumerate() {
            let corner = cell_at(at, index, n_columns, vec2(cell, 2.0 * LINE + STEP));
            paint_number(painter, corner, 0.0, one.moved_um[nth], palette.text);
            paint_number(painter, corner, LINE, one.told_um[nth], palette.dim);
        }
    }
    let at = place(2);
    paint_title(painter, at, "Current", "mA rms", palette.dim);
    let line = if is_wide { 2.0 * LINE + STEP } else { LINE };
    for (index, one) in view.contactors.iter().enumerate() {
        let corner = cell_at(at, index, n_columns, vec2(cell, line));
        let text = quantity::fixed(one.current_ma[0], 2);
        paint_text(painter, corner, 0.0, &text, palette.text);
    }
    describe(&response, view, |index| {
        let sizes = [2.0 * LINE + STEP, 2.0 * LINE + STEP, line];
        sizes.into_iter().enumerate().any(|(nth, line)| {
            let at = cell_at(place(nth), index, n_columns, vec2(cell, line));
            response
                .hover_pos()
                .is_some_and(|pointer| at.contains(pointer))
        })
    });
}

fn cell_at(grid: Rect, index: usize, n_columns: usize, size: egui::Vec2) -> Rect {
    let (row, column) = (index / n_columns, index % n_columns);
    let corner = grid.min + vec2(column as f32, row as f32) * size + vec2(0.0, TITLE);
    Rect::from_min_size(corner, size)
}

/// A title on a hairline, its unit dimmer at the right end.
fn paint_title(painter: &Painter, at: Rect, title: &str, unit: &str, ink: egui::Color32) {
    let palette = Palette::of_visuals(&painter.ctx().global_style().visuals);
    let middle = at.top() + 0.5 * TITLE - 1.0;
    let (left, right) = (pos2(at.left(), middle), pos2(at.right(), middle));
    painter.text(left, Align2::LEFT_CENTER, title, theme::small(), ink);
    paint_quiet(painter, right, Align2::RIGHT_CENTER, unit);
    let line = at.top() + TITLE - 2.0;
    painter.hline(at.x_range(), line, Stroke::new(1.0, palette.line));
}

fn paint_number(painter: &Painter, cell: Rect, down: f32, um: f64, ink: egui::Color32) {
    let decimals = usize::from(um < 99.95);
    paint_text(painter, cell, down, &quantity::fixed(um, decimals), ink);
}

fn paint_text(painter: &Painter, cell: Rect, down: f32, text: &str, ink: egui::Color32) {
    let right = pos2(cell.right(), cell.top() + down);
    painter.text(right, Align2::RIGHT_TOP, text, theme::small_number(), ink);
}

/// The contactor under the pointer in words.
fn describe(response: &Response, view: &PlantView, is_under: impl Fn(usize) -> bool) {
    let found = (0..view.contactors.len()).find(|index| is_under(*index));
    if let Some(index) = found {
        let words = contactor_words(index, &view.contactors[index]);
        response.clone().on_hover_text_at_pointer(words);
    }
}

fn contactor_words(index: usize, one: &PlantCell) -> String {
    let um = |um: f64| quantity::with_unit(um, 1, "µm");
    let percent = |share: f64| quantity::with_unit(100.0 * share, 0, "%");
    let lines = Band::ALL.into_iter().enumerate().map(|(nth, band)| {
        let (moved, described) = (um(one.moved_um[nth]), um(one.told_um[nth]));
        format!(
            "{} Hz: moves {moved}, told {described}\n",
            band.carrier_hz()
        )
    });
    let lines: String = lines.collect();
    let [rms, peak] = one.current_ma.map(|ma| quantity::with_unit(ma, 2, "mA"));
    format!(
        "Contactor {index}\n{lines}Current: {rms} rms, {peak} peak\nSkin off {} of the time; \
         amplifier held back {}",
        percent(one.lost_share),
        percent(one.held_share)
    )
}

/// What differs from a finger that stays on and an amplifier that follows.
fn troubles(contactors: &[PlantCell]) -> String {
    let count = |of: fn(&PlantCell) -> f64| contactors.iter().filter(|one| of(one) > 0.0).count();
    let current: f64 = contactors.iter().map(|one| one.current_ma[0]).sum();
    let current = quantity::with_unit(current, 2, "mA");
    let held = match count(|one| one.held_share) {
        0 => "every amplifier follows".to_owned(),
        n => format!("amplifiers held back: {n}"),
    };
    let off = match count(|one| one.lost_share) {
        0 => String::new(),
        n => format!("; contactors that skin lifts off: {n}"),
    };
    format!("Above: moved. Below: told. All together {current}; {held}{off}.")
}

/// The grids for those who do not see them.
fn in_words(view: &PlantView) -> String {
    let most = |of: &dyn Fn(&PlantCell) -> f64| view.contactors.iter().map(of).fold(0.0, f64::max);
    let bands = [0, 1].map(|nth| {
        let moved = quantity::with_unit(most(&|one| one.moved_um[nth]), 1, "µm");
        let described = quantity::with_unit(most(&|one| one.told_um[nth]), 1, "µm");
        format!(
            "at {} Hz up to {moved} moved and {described} told",
            Band::ALL[nth].carrier_hz()
        )
    });
    let current = quantity::with_unit(most(&|one| one.current_ma[0]), 2, "mA");
    let n = view.contactors.len();
    format!(
        "Displacement of {n} contactors: {}; current up to {current}",
        bands.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_what_differs_from_following() {
        let mut contactors = vec![PlantCell::default(); 3];
        let words = troubles(&contactors);
        assert!(
            words.contains("every amplifier follows") && !words.contains("lifts"),
            "{words}"
        );
        contactors[1].lost_share = 0.5;
        contactors[2].held_share = 0.1;
        contactors[2].current_ma = [0.25, 1.0];
        let words = troubles(&contactors);
        for part in ["0.25 mA", "amplifiers held back: 1", "skin lifts off: 1"] {
            assert!(words.contains(part), "{part} in {words}");
        }
    }
}
