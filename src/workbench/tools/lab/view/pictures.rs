//! Two pictures of a surface: its relief in shade, and its local spectra over place and wavenumber.
//!
//! A picture is made when what it shows has changed, and then only.

use std::sync::Arc;

use eframe::egui::{
    self, Align2, Color32, ColorImage, Mesh, Painter, Rect, Sense, Shape, Stroke, TextureFilter,
    TextureHandle, TextureOptions, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::signals::spatial::{DENSITIES_DB, density_db};
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_outer_ticks, paint_unit, round_step};
use crate::kit::widgets::bar::colour_bar;
use crate::tools::lab::preview::Preview;
use crate::tools::lab::view::{LabView, title};
use selvedge_foundation::quantity;
use selvedge_textile::lit;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, LocalSpectra};

/// Rows of the picture of spectra.
const N_ROWS: u8 = 96;
/// Wavenumbers at its ends, cycles/mm: beyond, cloth has nothing that is felt.
const WAVENUMBERS: [f64; 2] = [BIN_SPACING_PER_MM, 50.0];
/// Width of the colour bar with its numbers, points.
const BAR: f32 = 40.0;

/// How the relief is read: smooth however far away it is.
const READ: TextureOptions = TextureOptions {
    mipmap_mode: Some(TextureFilter::Linear),
    ..TextureOptions::LINEAR
};

/// The pictures as they were drawn last.
#[derive(Default)]
pub(crate) struct LabPictures {
    relief: Option<(Arc<Preview>, TextureHandle)>,
    spectra: Option<(Key, TextureHandle)>,
    n_made: u64,
}

/// What a picture of spectra is made for.
type Key = (Arc<LocalSpectra>, ColourMap);

impl std::fmt::Debug for LabPictures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LabPictures")
            .field("n_made", &self.n_made)
            .finish_non_exhaustive()
    }
}

impl LabPictures {
    fn relief(&mut self, ctx: &egui::Context, preview: &Arc<Preview>) -> TextureHandle {
        if let Some((of, texture)) = &self.relief
            && Arc::ptr_eq(of, preview)
        {
            return texture.clone();
        }
        let picture = lit(preview.relief.heights_um());
        let pixels = picture
            .pixels
            .iter()
            .map(|&[r, g, b]| Color32::from_rgb(r, g, b));
        let image = ColorImage::new([picture.width, picture.height], pixels.collect());
        let texture = ctx.load_texture("lab relief", image, READ);
        self.n_made += 1;
        self.relief = Some((Arc::clone(preview), texture.clone()));
        texture
    }

    fn spectra(
        &mut self,
        ctx: &egui::Context,
        spectra: &Arc<LocalSpectra>,
        map: ColourMap,
    ) -> TextureHandle {
        if let Some(((of, own), texture)) = &self.spectra
            && Arc::ptr_eq(of, spectra)
            && *own == map
        {
            return texture.clone();
        }
        let rows = rows_db(spectra);
        let n_points = rows.first().map_or(0, Vec::len);
        let colour = |db: &f64| {
            if db.is_finite() {
                map.colour(share(*db))
            } else {
                // Finer than the samples: nothing is known there.
                Color32::TRANSPARENT
            }
        };
        // The top row of a picture holds the highest wavenumbers.
        let pixels = rows.iter().rev().flat_map(|row| row.iter().map(colour));
        let image = ColorImage::new([n_points, rows.len()], pixels.collect());
        let texture = ctx.load_texture("lab spectra", image, TextureOptions::NEAREST);
        self.n_made += 1;
        self.spectra = Some(((Arc::clone(spectra), map), texture.clone()));
        texture
    }
}

fn share(db: f64) -> f64 {
    let [least, most] = DENSITIES_DB;
    ((db - least) / (most - least)).clamp(0.0, 1.0)
}

fn wavenumbers() -> Axis {
    Axis::log(WAVENUMBERS[0], WAVENUMBERS[1])
}

/// Densities in dB re 1 µm² per cycle/mm, a row for every band of wavenumbers from the lowest up,
/// in it a value for every point along the stroke; of areal spectra those across the middle.
pub(crate) fn rows_db(spectra: &LocalSpectra) -> Vec<Vec<f64>> {
    let [n_along, n_across] = spectra.shape();
    let first = n_along * (n_across / 2);
    let axis = wavenumbers();
    let edge = |row: u8| axis.value(f64::from(row) / f64::from(N_ROWS)) / BIN_SPACING_PER_MM;
    let n_bins = spectra.n_bins();
    let row = |row: u8| -> Vec<f64> {
        // Bins whose middle lies in the row; where none does, the nearest one.
        let (from, to) = (edge(row), edge(row + 1));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "wavenumbers are positive and few"
        )]
        let bin = |k: f64| (k as usize).clamp(1, n_bins) - 1;
        let least = bin((0.5 * (from + to)).round()).min(bin(from.ceil()));
        let most = bin(to.floor()).max(least);
        let at = |point: usize| {
            let powers = &spectra.powers_um2(first + point)[least..=most];
            let mean = powers.iter().sum::<f64>() / powers.len() as f64;
            density_db(mean / BIN_SPACING_PER_MM)
        };
        (0..n_along).map(at).collect()
    };
    (0..N_ROWS).map(row).collect()
}

/// Shows the relief, as much of it as there is room for.
pub(crate) fn show_relief(
    ui: &Ui,
    rect: Rect,
    (view, preview): (&LabView<'_>, &Arc<Preview>),
    pictures: &mut LabPictures,
) {
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
    let texture = pictures.relief(ui.ctx(), preview);
    // As wide as the pane, a part of the height: one millimetre is as long both ways.
    let span = view.lab.look.span_mm.min(size_mm[0]);
    let [width, height] = [area.width(), area.height()].map(f64::from);
    let (along, across) = if height / width * span <= size_mm[1] {
        (span, span * height / width)
    } else {
        (size_mm[1] * width / height, size_mm[1])
    };
    let share = |mm: f64, of: f64| -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let share = (mm / of) as f32;
        share
    };
    let along = along.min(size_mm[0]);
    let from = view.lab.look.from_mm.min(size_mm[0] - along).max(0.0);
    let shown = vec2(area.width(), area.height());
    let picture = Rect::from_min_size(area.min, shown);
    let uv = Rect::from_min_max(
        pos2(share(from, size_mm[0]), 1.0 - share(across, size_mm[1])),
        pos2(share(from + along, size_mm[0]), 1.0),
    );
    let mut mesh = Mesh::with_texture(texture.id());
    mesh.add_rect_with_uv(picture, uv, Color32::WHITE);
    ui.painter().add(Shape::mesh(mesh));
    paint_ruler(ui.painter(), picture, along);
    let heights = preview.relief.heights_um().values();
    let (least, most) = heights
        .iter()
        .fold((f64::MAX, f64::MIN), |(least, most), height| {
            (least.min(*height), most.max(*height))
        });
    response.on_hover_text(format!(
        "Heights from {} to {}; warp to the right, weft upwards",
        quantity::with_unit(least, 0, "µm"),
        quantity::with_unit(most, 0, "µm"),
    ));
}

/// A length in millimetres at the lower left.
fn paint_ruler(painter: &Painter, picture: Rect, along_mm: f64) {
    let length_mm = round_step(along_mm / 6.0);
    #[expect(clippy::cast_possible_truncation, reason = "a length, for the screen")]
    let length = (length_mm / along_mm) as f32 * picture.width();
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
    (view, preview): (&LabView<'_>, &Arc<Preview>),
    pictures: &mut LabPictures,
) {
    let direction = view.lab.look.direction;
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
    let texture = pictures.spectra(ui.ctx(), spectra, view.map);
    let mut mesh = Mesh::with_texture(texture.id());
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let floor = Palette::in_ui(ui).floor;
    ui.painter().rect_filled(area, 0, floor);
    mesh.add_rect_with_uv(area, all, Color32::WHITE);
    ui.painter().add(Shape::mesh(mesh));
    paint_axes(ui.painter(), area, spectra);
    paint_bar(ui.painter(), (area, below), view.map);
    tell(response, area, direction, spectra);
}

/// Places are 1 mm apart, one for each window.
fn paint_axes(painter: &Painter, area: Rect, spectra: &LocalSpectra) {
    let axis = wavenumbers();
    let ticks = axis.ticks(area.height(), 20.0);
    paint_outer_ticks(painter, area, (&axis, Side::Left), &ticks);
    let corner = area.left_top() + vec2(-24.0, -3.0);
    paint_unit(painter, corner, Align2::LEFT_BOTTOM, "cycles/mm");
    let places = Axis::linear(0.0, spectra.shape()[0] as f64);
    let ticks = places.ticks(area.width(), 50.0);
    paint_outer_ticks(painter, area, (&places, Side::Bottom), &ticks);
    let corner = area.right_bottom() + vec2(4.0, 14.0);
    paint_unit(painter, corner, Align2::LEFT_BOTTOM, "mm");
}

fn paint_bar(painter: &Painter, (area, whole): (Rect, Rect), map: ColourMap) {
    let left = whole.right() - BAR;
    let bar = Rect::from_x_y_ranges(left..=left + 8.0, area.y_range());
    colour_bar(painter, bar, |share| map.colour(share));
    let axis = Axis::linear(DENSITIES_DB[0], DENSITIES_DB[1]);
    let ticks = axis.ticks(bar.height(), 22.0);
    paint_outer_ticks(painter, bar, (&axis, Side::Right), &ticks);
    let corner = pos2(whole.right(), bar.top() - 3.0);
    paint_unit(painter, corner, Align2::RIGHT_BOTTOM, "dB");
}

fn tell(response: egui::Response, area: Rect, direction: Direction, spectra: &LocalSpectra) {
    let Some(at) = response.hover_pos().filter(|at| area.contains(*at)) else {
        return;
    };
    let wavenumber = wavenumbers().value_at_y(area.y_range(), at.y);
    let [n_along, n_across] = spectra.shape();
    let places = Axis::linear(0.0, n_along as f64);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the picture"
    )]
    let whole = |x: f64| x.max(0.0) as usize;
    let point = whole(places.value_at_x(area.x_range(), at.x)).min(n_along.saturating_sub(1));
    let bin = whole((wavenumber / BIN_SPACING_PER_MM).round()).clamp(1, spectra.n_bins());
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

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::surface::{Profile, ProfileSet, Surface};

    #[test]
    fn a_sine_is_brightest_in_the_row_of_its_wavenumber() {
        let sine = |i: u32| (f64::from(i) / 230.0 * 3.0 * std::f64::consts::TAU).sin();
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, (0..4600).map(sine).collect()).unwrap());
        let surface = Surface::from_profiles(profiles, 0.0).unwrap();
        let rows = rows_db(surface.spectra(Direction::WarpForward));
        assert_eq!(rows.len(), usize::from(N_ROWS));
        let brightest = (0..rows.len()).max_by(|a, b| rows[*a][5].total_cmp(&rows[*b][5]));
        let share = (brightest.unwrap() as f64 + 0.5) / f64::from(N_ROWS);
        let found = wavenumbers().value(share);
        assert!((found / 3.0 - 1.0).abs() < 0.1, "{found}");
    }
}
