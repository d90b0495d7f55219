//! Curves of the pane: directions over angle, and the four strokes.

use eframe::egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, pos2};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::polyline::corners;
use crate::tools::picture::found::Made;
use selvedge_foundation::quantity;
use selvedge_textile::picture::{Directions, Measured};

/// Length of a stroke that is shown, mm.
const SHOWN_MM: f64 = 10.0;

#[expect(clippy::cast_possible_truncation, reason = "shares, for the screen")]
fn place(rect: Rect, x: f64, y: f64) -> Pos2 {
    let (x, y) = (x as f32, y as f32);
    pos2(
        rect.left() + x * rect.width(),
        rect.bottom() - y * rect.height(),
    )
}

fn line(painter: &Painter, points: &[Pos2], (width, ink): (f32, Color32)) {
    painter.line(corners(points), Stroke::new(width, ink));
}

/// Both measures over half a turn, each by its own highest value; the chosen directions as marks.
pub(crate) fn directions(painter: &Painter, rect: Rect, directions: &Directions) {
    let palette = Palette::of(painter.ctx().theme());
    let plot = Rect::from_min_max(rect.min, pos2(rect.right(), rect.bottom() - 14.0));
    for deg in [0.0, 45.0, 90.0, 135.0, 180.0] {
        let at = place(plot, deg / 180.0, 0.0);
        let x = painter.round_to_pixel_center(at.x);
        painter.vline(x, plot.y_range(), Stroke::new(1.0, palette.hairline));
        let anchor = match deg {
            d if d < 1.0 => Align2::LEFT_TOP,
            d if d > 179.0 => Align2::RIGHT_TOP,
            _ => Align2::CENTER_TOP,
        };
        let label = format!("{}°", quantity::fixed(deg, 0));
        painter.text(at, anchor, label, theme::small_number(), palette.dim);
    }
    let both = [
        (&directions.by_hough, 1.0, palette.dim, "Hough"),
        (
            &directions.by_concentration,
            1.5,
            palette.text,
            "concentration",
        ),
    ];
    for (nth, (measured, width, ink, name)) in (0_u8..).zip(both) {
        curve(painter, plot, measured, (width, ink));
        let at = pos2(plot.right() - 2.0, plot.top() + 12.0 * f32::from(1 - nth));
        painter.text(at, Align2::RIGHT_TOP, name, theme::small(), ink);
    }
}

fn curve(painter: &Painter, plot: Rect, measured: &Measured, (width, ink): (f32, Color32)) {
    let most = measured.curve.iter().copied().fold(0.0, f64::max);
    let n = measured.curve.len().max(1) as f64;
    if most <= 0.0 {
        return;
    }
    let points = measured.curve.iter().enumerate();
    let points = points.map(|(i, value)| place(plot, i as f64 / n, 0.92 * value / most));
    line(painter, &points.collect::<Vec<Pos2>>(), (width, ink));
    for angle in measured.best.into_iter().flatten() {
        let share = (angle / std::f64::consts::PI).rem_euclid(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "an index of the curve"
        )]
        let index = (share * n).round() as usize % measured.curve.len().max(1);
        let at = place(plot, share, 0.92 * measured.curve[index] / most);
        painter.circle_stroke(at, 4.0, Stroke::new(width, ink));
    }
}

/// The four strokes, on one scale, each on its own line.
pub(crate) fn strokes(painter: &Painter, rect: Rect, made: &Made) {
    let palette = Palette::of(painter.ctx().theme());
    let all = made.profiles.iter().flat_map(|(_, heights, _)| heights);
    let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
        [low.min(*z), high.max(*z)]
    });
    let range = (high - low).max(1e-9);
    let n = made.profiles.len().max(1) as f32;
    for (nth, (direction, heights, step_mm)) in made.profiles.iter().enumerate() {
        let height = (rect.height() - 12.0) / n;
        let top = rect.top() + nth as f32 * height;
        let lane = Rect::from_min_max(
            pos2(rect.left(), top + 12.0),
            pos2(rect.right(), top + height),
        );
        let at = pos2(rect.left(), top);
        painter.text(
            at,
            Align2::LEFT_TOP,
            direction.label(),
            theme::small(),
            palette.dim,
        );
        let points = heights.iter().enumerate();
        let points = points.map(|(i, z)| (i as f64 * step_mm / SHOWN_MM, (z - low) / range));
        let points = points
            .take_while(|(x, _)| *x <= 1.0)
            .map(|(x, y)| place(lane, x, y));
        line(painter, &points.collect::<Vec<Pos2>>(), (1.0, palette.text));
    }
    let range = quantity::with_unit(range, 0, "µm");
    let words = format!("{} mm, each {range} high", quantity::fixed(SHOWN_MM, 0));
    let font = theme::small();
    painter.text(
        rect.right_bottom(),
        Align2::RIGHT_BOTTOM,
        words,
        font,
        palette.dim,
    );
}
