//! The spatial spectra as they are painted, with the bins lit that sound.
//!
//! Warp is bright, weft dim; forward is solid, reverse dashed: amber and cyan are left to the
//! wavenumbers that sound at 40 and 320 Hz.

use eframe::egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ};
use crate::bench::signals::spatial::{
    DENSITIES_DB, Felt, SpatialCurve, SpatialView, density_db, wavenumber_per_mm,
};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_label, paint_ticks, paint_unit};
use crate::kit::widgets::polyline::corners;
use selvedge_foundation::quantity;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, N_BINS};
use selvedge_textile::tactile::Band;

/// Bins nearer to one another on the screen than this are drawn as their mean, points.
const LEAST_STEP: f32 = 1.5;
/// How bright a curve is where it does not sound.
const UNLIT: f32 = 0.5;
/// How bright the marks of the slower direction are.
const SLOWER: f32 = 0.45;

/// The curve of a density as `[wavenumber, density]`: bins that are drawn nearer to one another
/// than `least_step` as their mean. `x` is where a wavenumber is drawn.
pub(crate) fn means_of(
    density_um2_mm: &[f64],
    least_step: f32,
    x: impl Fn(f64) -> f32,
) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    let (mut n_bins, mut wavenumbers, mut densities) = (0.0, 0.0, 0.0);
    let mut next_x = f32::NEG_INFINITY;
    for (k, density) in (1..).zip(density_um2_mm) {
        n_bins += 1.0;
        wavenumbers += wavenumber_per_mm(k);
        densities += density;
        let at = x(wavenumbers / n_bins);
        if at >= next_x {
            points.push([wavenumbers / n_bins, densities / n_bins]);
            (n_bins, wavenumbers, densities) = (0.0, 0.0, 0.0);
            next_x = at + least_step;
        }
    }
    points
}

fn is_weft(direction: Direction) -> bool {
    direction.index() >= 2
}

fn ink_of(palette: &Palette, direction: Direction) -> Color32 {
    if is_weft(direction) {
        palette.dim
    } else {
        palette.text
    }
}

pub(crate) fn words_of(view: &SpatialView, k: usize) -> String {
    let wavenumber = quantity::with_unit(wavenumber_per_mm(k), 2, "cycles/mm");
    let curves = view.curves.iter().map(|curve| curve_words(view, curve, k));
    let curves: Vec<String> = curves.collect();
    format!(
        "{wavenumber}, bin {k}\n{}\nOne-sided power density re 1 µm² per cycle/mm: the power of a \
         bin over 0.23 cycles/mm",
        curves.join("\n")
    )
}

fn curve_words(view: &SpatialView, curve: &SpatialCurve, k: usize) -> String {
    let density = curve.density_um2_mm.get(k - 1).copied().unwrap_or(0.0);
    let level = quantity::with_unit(density_db(density), 1, "dB");
    let (name, point) = (curve.direction.label(), curve.point);
    let source = if curve.taken_from == curve.direction {
        String::new()
    } else {
        format!(", taken from {}", curve.taken_from.label())
    };
    let sounds = view.felt_in(curve.direction).map(|felt| {
        let frequency_hz = wavenumber_per_mm(k) * felt.speed_mm_per_s;
        format!(", sounds at {}", quantity::with_unit(frequency_hz, 0, "Hz"))
    });
    format!(
        "{name}  {level}, point {point}{source}{}",
        sounds.unwrap_or_default()
    )
}

pub(crate) struct Plot {
    area: Rect,
    wavenumbers: Axis,
    levels_db: Axis,
}

impl Plot {
    pub(crate) fn new(area: Rect) -> Self {
        Self {
            area,
            wavenumbers: Axis::log(wavenumber_per_mm(1), wavenumber_per_mm(N_BINS)),
            levels_db: Axis::linear(DENSITIES_DB[0], DENSITIES_DB[1]),
        }
    }

    pub(crate) fn x(&self, wavenumber_per_mm: f64) -> f32 {
        self.wavenumbers.x(self.area.x_range(), wavenumber_per_mm)
    }

    /// The place of a density; below the axis, and for none, just under its lower end.
    fn y(&self, density_um2_mm: f64) -> f32 {
        let y = self
            .levels_db
            .y(self.area.y_range(), density_db(density_um2_mm));
        y.clamp(self.area.top() - 2.0, self.area.bottom() + 2.0)
    }

    pub(crate) fn bin_at(&self, x: f32) -> usize {
        let wavenumber = self.wavenumbers.value_at_x(self.area.x_range(), x);
        let k = (wavenumber / BIN_SPACING_PER_MM).round();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the bins"
        )]
        let k = k.clamp(1.0, N_BINS as f64) as usize;
        k
    }

    pub(crate) fn paint(&self, painter: &Painter, view: &SpatialView) {
        self.paint_axes(painter);
        for felt in view.felt.iter().flatten() {
            let is_fastest = Some(*felt) == view.fastest();
            self.paint_carriers(painter, *felt, if is_fastest { 1.0 } else { SLOWER });
        }
        if let Some(felt) = view.fastest() {
            self.paint_frequencies(painter, felt);
        }
        for curve in view.curves.iter().rev() {
            self.paint_curve(painter, view, curve);
        }
        self.paint_legend(painter, view);
        self.paint_level_unit(painter);
    }

    /// The unit of levels, in the corner that falling spectra leave free.
    fn paint_level_unit(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let unit = "dB re 1 µm² per cycle/mm".to_owned();
        let text = painter.layout_no_wrap(unit, theme::small(), palette.dim);
        let corner = self.area.left_bottom() + vec2(6.0, -3.0 - text.size().y);
        let ground = Rect::from_min_size(corner, text.size()).expand2(vec2(3.0, 0.0));
        painter.rect_filled(ground, 0, palette.panel);
        painter.galley(corner, text, palette.dim);
    }

    fn paint_axes(&self, painter: &Painter) {
        let levels = self.levels_db.ticks(self.area.height(), 18.0);
        paint_ticks(painter, self.area, (&self.levels_db, Side::Left), &levels);
        // Room for six: the whole decades, and their unit before the first.
        let wavenumbers = self.wavenumbers.ticks(6.0, 1.0);
        let axis = (&self.wavenumbers, Side::Bottom);
        paint_ticks(painter, self.area, axis, &wavenumbers);
        let below = self.area.left_bottom() + vec2(0.0, 2.0);
        paint_unit(painter, below, Align2::LEFT_TOP, "cycles/mm");
    }

    /// Marks the wavenumbers that sound at the carriers.
    fn paint_carriers(&self, painter: &Painter, felt: Felt, strength: f32) {
        let palette = Palette::of(painter.ctx().theme());
        for band in Band::ALL {
            let x = self.x(felt.wavenumber_per_mm(band.carrier_hz()));
            if self.area.x_range().contains(x) {
                let x = painter.round_to_pixel_center(x);
                let ends = [pos2(x, self.area.top()), pos2(x, self.area.bottom())];
                let ink = palette.band(band).gamma_multiply(strength);
                let stroke = Stroke::new(1.0, ink);
                add_line(painter, &ends, stroke, felt.direction.is_reverse());
            }
        }
    }

    /// The frequencies that wavenumbers sound at, above the plot.
    fn paint_frequencies(&self, painter: &Painter, felt: Felt) {
        let palette = Palette::of(painter.ctx().theme());
        let mut marks = [LEAST_HZ, 100.0, MOST_HZ]
            .map(|hz| (hz, palette.dim))
            .to_vec();
        marks.extend(Band::ALL.map(|band| (band.carrier_hz(), palette.band(band))));
        for (frequency_hz, ink) in marks {
            let x = self.x(felt.wavenumber_per_mm(frequency_hz));
            if self.area.x_range().contains(x) {
                let at = pos2(x, self.area.top());
                let tick = Tick::number(frequency_hz);
                painter.vline(x, at.y - 3.0..=at.y, Stroke::new(1.0, ink));
                paint_label(painter, self.area, (at, Side::Top), &tick.label, ink);
            }
        }
        let unit_at = pos2(self.area.left() - 5.0, self.area.top() - 4.0);
        paint_unit(painter, unit_at, Align2::RIGHT_BOTTOM, "Hz");
    }

    fn paint_curve(&self, painter: &Painter, view: &SpatialView, curve: &SpatialCurve) {
        let palette = Palette::of(painter.ctx().theme());
        let painter = painter.with_clip_rect(self.area);
        let ink = ink_of(palette, curve.direction);
        let is_dashed = curve.direction.is_reverse();
        let means = means_of(&curve.density_um2_mm, LEAST_STEP, |wavenumber| {
            self.x(wavenumber)
        });
        let at = |[wavenumber, density]: &[f64; 2]| pos2(self.x(*wavenumber), self.y(*density));
        let points: Vec<Pos2> = means.iter().map(at).collect();
        let unlit = Stroke::new(1.0, ink.gamma_multiply(UNLIT));
        add_line(&painter, &points, unlit, is_dashed);
        if let Some(felt) = view.felt_in(curve.direction) {
            let lit = means
                .iter()
                .filter(|[wavenumber, _]| felt.sounds(*wavenumber));
            let points: Vec<Pos2> = lit.map(at).collect();
            add_line(&painter, &points, Stroke::new(2.0, ink), is_dashed);
        }
    }

    /// Names the curves, and lights those that are felt.
    fn paint_legend(&self, painter: &Painter, view: &SpatialView) {
        let palette = Palette::of(painter.ctx().theme());
        let mut y = self.area.top() + 10.0;
        for direction in Direction::ALL {
            let is_felt = view.felt_in(direction).is_some();
            let ink = ink_of(palette, direction);
            let right = self.area.right() - 6.0;
            let name = if is_weft(direction) { "weft" } else { "warp" };
            let name_at = pos2(right - 12.0, y);
            painter.text(name_at, Align2::RIGHT_CENTER, name, theme::small(), ink);
            painter.add(arrow(pos2(right - 4.0, y), direction.is_reverse(), ink));
            let sample = [pos2(right - 66.0, y), pos2(right - 44.0, y)];
            let stroke = if is_felt {
                Stroke::new(2.0, ink)
            } else {
                Stroke::new(1.0, ink.gamma_multiply(UNLIT))
            };
            add_line(painter, &sample, stroke, direction.is_reverse());
            y += 13.0;
        }
    }
}

/// A small triangle that points along a stroke: to the right, or in reverse to the left.
fn arrow(at: Pos2, is_reverse: bool, ink: Color32) -> Shape {
    let along = if is_reverse { -3.5 } else { 3.5 };
    let corners = vec![
        at + vec2(-along, -3.5),
        at + vec2(along, 0.0),
        at + vec2(-along, 3.5),
    ];
    Shape::convex_polygon(corners, ink, Stroke::NONE)
}

fn add_line(painter: &Painter, points: &[Pos2], stroke: Stroke, is_dashed: bool) {
    if points.len() < 2 {
        return;
    }
    if is_dashed {
        painter.extend(Shape::dashed_line(points, stroke, 4.0, 3.0));
    } else {
        painter.add(Shape::line(corners(points), stroke));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(width: f32) -> Plot {
        Plot::new(Rect::from_min_size(pos2(40.0, 20.0), vec2(width, 150.0)))
    }

    #[test]
    fn a_flat_density_stays_flat_however_many_bins_fall_together() {
        for width in [60.0, 350.0, 3_000.0] {
            let plot = plot(width);
            let points = means_of(&[0.1; N_BINS], LEAST_STEP, |wavenumber| plot.x(wavenumber));
            assert!(
                points
                    .iter()
                    .all(|[_, density]| (density - 0.1).abs() < 1e-12),
                "{width}"
            );
            assert!(
                points.len() as f32 <= width / LEAST_STEP + 2.0,
                "{}",
                points.len()
            );
            assert!(
                points.windows(2).all(|pair| pair[0][0] < pair[1][0]),
                "rising"
            );
        }
        let wide = plot(3e5);
        let points = means_of(&[0.1; N_BINS], LEAST_STEP, |wavenumber| wide.x(wavenumber));
        assert_eq!(points.len(), N_BINS);
    }

    #[test]
    fn the_pointer_finds_the_bin_under_it() {
        let plot = plot(350.0);
        for k in [1, 2, 7, 40] {
            assert_eq!(plot.bin_at(plot.x(wavenumber_per_mm(k))), k);
        }
        assert_eq!((plot.bin_at(-1e6), plot.bin_at(1e6)), (1, N_BINS));
    }

    #[test]
    fn silence_and_what_is_no_number_lie_under_the_axis() {
        let plot = plot(350.0);
        for density in [0.0, 1e-300, f64::NAN] {
            assert_eq!(plot.y(density), plot.area.bottom() + 2.0, "{density}");
        }
        assert_eq!(plot.y(1.0), plot.area.bottom() - 0.6 * plot.area.height());
    }
}
