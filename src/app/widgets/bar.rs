//! The bar that shows which colour stands for how much.

use eframe::egui::{Color32, Painter, Rect, pos2, vec2};

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
