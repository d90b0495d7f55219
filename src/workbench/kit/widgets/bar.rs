//! The bar that shows which colour stands for how much.

use eframe::egui::{Align2, Color32, Painter, Rect, Stroke, pos2, vec2};

use crate::kit::amplitude::AmplitudeScale;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::text::paint_quiet;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Height of a number beside the bar, points.
const LINE: f32 = 10.0;

/// Slices of a bar: more than the eye tells apart.
const N_SLICES: u8 = 64;

/// Paints the colours of a scale, by share 0…1, from the bottom up.
pub(crate) fn colour_bar(painter: &Painter, bar: Rect, colour: impl Fn(f64) -> Color32) {
    let step = bar.height() / f32::from(N_SLICES);
    for i in 0..N_SLICES {
        let y = bar.bottom() - f32::from(i + 1) * step;
        // Half a point of overlap hides the seams.
        let slice = Rect::from_min_size(pos2(bar.left(), y), vec2(bar.width(), step + 0.5));
        let share = f64::from(i) / f64::from(N_SLICES - 1);
        painter.rect_filled(slice.intersect(bar), 0, colour(share));
    }
}

/// Paints the colours of a map on a scale of amplitudes, with its numbers in µm on the right and
/// the unit above.
pub(crate) fn amplitude_bar(painter: &Painter, bar: Rect, map: ColourMap, scale: AmplitudeScale) {
    let palette = Palette::of(painter.ctx().theme());
    colour_bar(painter, bar, |share| map.colour(share));
    let mut taken: Vec<f32> = Vec::new();
    let mut marks: Vec<f64> = scale.marks_um();
    // The ends of the scale are written before what lies between.
    marks.sort_by(|a, b| b.total_cmp(a));
    if let Some(least) = marks.pop() {
        marks.insert(1.min(marks.len()), least);
    }
    for amplitude_um in marks {
        let share = to_single(scale.share(amplitude_um));
        let y = bar.bottom() - bar.height() * share;
        let decimals = if amplitude_um < 0.1 {
            2
        } else {
            usize::from(amplitude_um < 1.0)
        };
        let digits = quantity::fixed(amplitude_um, decimals);
        let tick = Stroke::new(1.0, palette.line);
        painter.hline(bar.right()..=bar.right() + 3.0, y, tick);
        let y = y.clamp(bar.top() + 4.0, bar.bottom() - 4.0);
        if taken.iter().any(|other| (other - y).abs() < LINE) {
            continue;
        }
        taken.push(y);
        let at = pos2(bar.right() + 7.0, y);
        let font = theme::small_number();
        painter.text(at, Align2::LEFT_CENTER, digits, font, palette.dim);
    }
    let unit_at = pos2(bar.left(), bar.top() - 11.0);
    paint_quiet(painter, unit_at, Align2::LEFT_CENTER, "µm");
}
