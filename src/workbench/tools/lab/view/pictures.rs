//! Two pictures of a surface: its relief in shade, and its local spectra over place and wavenumber.

use std::sync::Arc;

use eframe::egui::{self, Align2, Painter, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::bench::signals::spatial::{DENSITIES_DB, density_db};
use crate::kit::texture::{WHOLE, paint};
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_outer_ticks, round_step};
use crate::kit::widgets::bar::colour_bar;
use crate::kit::widgets::text::paint_quiet;
use crate::tools::lab::pictures::wavenumbers;
use crate::tools::lab::preview::Preview;
use crate::tools::lab::state::Lab;
use crate::tools::lab::view::parts::title;
use selvedge_foundation::numerics::{extent, to_index, to_single};
use selvedge_foundation::quantity;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, LocalSpectra};

/// Width of the colour bar with its numbers, points.
const BAR: f32 = 40.0;

/// Shows the relief, as much of it as there is room for.
pub(crate) fn show_relief(ui: &Ui, rect: Rect, lab: &mut Lab, preview: &Arc<Preview>) {
    let size_mm = preview.relief.size_mm();
    let words = format!(
        "relief  {} × {} mm, lit from the upper left",
        quantity::fixed(size_mm[0], 1),
        quantity::fixed(size_mm[1], 1)
    );
    let area = title(ui, rect, &words);
    let id = ui.scope_id().with("lab relief");
    let response = ui.interact(area, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, "Relief in shade"));
    if area.width() < 24.0 || area.height() < 24.0 {
        return;
    }
    let texture = lab.pictures.relief(ui.ctx(), preview);
    // As wide as the pane, a part of the height: one millimetre is as long both ways.
    let span = lab.look.span_mm.min(size_mm[0]);
    let [width, height] = [area.width(), area.height()].map(f64::from);
    let (along, across) = if height / width * span <= size_mm[1] {
        (span, span * height / width)
    } else {
        (size_mm[1] * width / height, size_mm[1])
    };
    let share = |mm: f64, of: f64| to_single(mm / of);
    let along = along.min(size_mm[0]);
    let from = lab.look.from_mm.min(size_mm[0] - along).max(0.0);
    let shown = vec2(area.width(), area.height());
    let picture = Rect::from_min_size(area.min, shown);
    let uv = Rect::from_min_max(
        pos2(share(from, size_mm[0]), 1.0 - share(across, size_mm[1])),
        pos2(share(from + along, size_mm[0]), 1.0),
    );
    paint(ui.painter(), picture, uv, texture);
    paint_ruler(ui.painter(), picture, along);
    let heights = preview.relief.heights_um().values();
    let [least, most] = extent(heights.iter().copied());
    response.on_hover_text(format!(
        "Heights from {} to {}; warp to the right, weft upwards",
        quantity::with_unit(least, 0, "µm"),
        quantity::with_unit(most, 0, "µm"),
    ));
}

/// A length in millimetres at the lower left.
fn paint_ruler(painter: &Painter, picture: Rect, along_mm: f64) {
    let length_mm = round_step(along_mm / 6.0);
    let length = to_single(length_mm / along_mm) * picture.width();
    let left = picture.left_bottom() + vec2(10.0, -10.0);
    let palette = Palette::of(painter.ctx().theme());
    let tick = Tick::number(length_mm);
    let words = format!("{} mm", tick.label);
    let font = crate::kit::theme::small();
    let galley = painter.layout_no_wrap(words, font, palette.text);
    let ground = Rect::from_min_max(
        pos2(left.x - 5.0, left.y - galley.size().y - 5.0),
        pos2(left.x + length.max(galley.size().x) + 5.0, left.y + 5.0),
    );
    painter.rect_filled(ground, 3, palette.tag.gamma_multiply(0.85));
    painter.galley(
        left - vec2(0.0, galley.size().y + 2.0),
        galley,
        palette.text,
    );
    let line = Stroke::new(2.0, palette.text);
    painter.hline(left.x..=left.x + length, left.y, line);
}

/// Shows the local spectra of the stroke that is looked at.
pub(crate) fn show_spectra(
    ui: &Ui,
    rect: Rect,
    (lab, preview): (&mut Lab, &Preview),
    map: ColourMap,
) {
    let direction = lab.look.direction;
    let words = format!("local spectra, {}", direction.label());
    let below = title(ui, rect, &words);
    let area = Rect::from_min_max(
        pos2(below.left() + 26.0, below.top() + 10.0),
        pos2(below.right() - BAR - 8.0, below.bottom() - 16.0),
    );
    let id = ui.scope_id().with("lab spectra");
    let response = ui.interact(below, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &words));
    if area.width() < 24.0 || area.height() < 24.0 {
        return;
    }
    let spectra = preview.felt.surface.spectra(direction);
    let texture = lab.pictures.spectra(ui.ctx(), spectra, map);
    let floor = Palette::in_ui(ui).floor;
    ui.painter().rect_filled(area, 0, floor);
    paint(ui.painter(), area, WHOLE, texture);
    paint_axes(ui.painter(), area, spectra);
    paint_bar(ui.painter(), (area, below), map);
    describe(response, area, direction, spectra);
}

/// Places are 1 mm apart, one for each window.
fn paint_axes(painter: &Painter, area: Rect, spectra: &LocalSpectra) {
    let axis = wavenumbers();
    let ticks = axis.ticks(area.height(), 20.0);
    paint_outer_ticks(painter, area, (&axis, Side::Left), &ticks);
    let corner = area.left_top() + vec2(-24.0, -3.0);
    paint_quiet(painter, corner, Align2::LEFT_BOTTOM, "cycles/mm");
    let places = Axis::linear(0.0, spectra.shape()[0] as f64);
    let ticks = places.ticks(area.width(), 50.0);
    paint_outer_ticks(painter, area, (&places, Side::Bottom), &ticks);
    let corner = area.right_bottom() + vec2(4.0, 14.0);
    paint_quiet(painter, corner, Align2::LEFT_BOTTOM, "mm");
}

fn paint_bar(painter: &Painter, (area, whole): (Rect, Rect), map: ColourMap) {
    let left = whole.right() - BAR;
    let bar = Rect::from_x_y_ranges(left..=left + 8.0, area.y_range());
    colour_bar(painter, bar, |share| map.colour(share));
    let axis = Axis::linear(DENSITIES_DB[0], DENSITIES_DB[1]);
    let ticks = axis.ticks(bar.height(), 22.0);
    paint_outer_ticks(painter, bar, (&axis, Side::Right), &ticks);
    let corner = pos2(whole.right(), bar.top() - 3.0);
    paint_quiet(painter, corner, Align2::RIGHT_BOTTOM, "dB");
}

fn describe(response: egui::Response, area: Rect, direction: Direction, spectra: &LocalSpectra) {
    let Some(at) = response.hover_pos().filter(|at| area.contains(*at)) else {
        return;
    };
    let wavenumber = wavenumbers().value_at_y(area.y_range(), at.y);
    let [n_along, n_across] = spectra.shape();
    let places = Axis::linear(0.0, n_along as f64);
    let point = to_index(places.value_at_x(area.x_range(), at.x)).min(n_along.saturating_sub(1));
    let bin = to_index((wavenumber / BIN_SPACING_PER_MM).round()).clamp(1, spectra.n_bins());
    let powers = spectra.powers_um2(n_along * (n_across / 2) + point);
    let level = density_db(powers[bin - 1] / BIN_SPACING_PER_MM);
    let words = format!(
        "{}  point {point}\n{}  {}\nOne-sided power density re 1 µm² per cycle/mm",
        direction.label(),
        quantity::with_unit(wavenumber, 2, "cycles/mm"),
        quantity::with_unit(level, 1, "dB"),
    );
    response.on_hover_text_at_pointer(words);
}
