//! Rulers along the top and the left of the workspace, in mm.

use eframe::egui::{Align2, Painter, Rect, Stroke, pos2};

use super::ViewTransform;
use crate::app::theme::{self, Palette};
use crate::geometry::Point;
use crate::quantity;

/// How high the upper ruler is, points.
pub(crate) const TOP: f32 = 20.0;
/// How wide the left ruler is, points.
pub(crate) const LEFT: f32 = 34.0;

/// Least distance between labelled marks, points.
const MIN_LABEL_POINTS: f64 = 48.0;

/// A mark on a ruler.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mark {
    at_mm: f64,
    is_labelled: bool,
}

/// Draws both rulers around the view, with a marker where the display is.
pub(crate) fn paint(
    painter: &Painter,
    frame: Rect,
    view: &ViewTransform,
    size_mm: [f64; 2],
    display: Option<Point>,
) {
    let palette = Palette::of(painter.ctx().theme());
    let line = Stroke::new(1.0, palette.hairline);
    let (left, top) = (frame.left() + LEFT, frame.top() + TOP);
    painter.hline(frame.x_range(), top, line);
    painter.vline(left, frame.y_range(), line);
    painter.text(
        pos2(frame.left() + 0.5 * LEFT, frame.top() + 0.5 * TOP),
        Align2::CENTER_CENTER,
        "mm",
        theme::small_number(),
        palette.dim,
    );
    let tick = Stroke::new(1.0, palette.line);
    let label = |mm: f64| quantity::fixed(mm, 0);
    for Mark { at_mm, is_labelled } in marks(size_mm[0], view.points_per_mm()) {
        let x = painter.round_to_pixel_center(view.screen(Point::new(at_mm, 0.0)).x);
        if x > left {
            let length = if is_labelled { 6.0 } else { 3.0 };
            painter.vline(x, (top - length)..=top, tick);
            if is_labelled {
                let at = pos2(x, top - 7.0);
                painter.text(
                    at,
                    Align2::CENTER_BOTTOM,
                    label(at_mm),
                    theme::small_number(),
                    palette.dim,
                );
            }
        }
    }
    for Mark { at_mm, is_labelled } in marks(size_mm[1], view.points_per_mm()) {
        let y = painter.round_to_pixel_center(view.screen(Point::new(0.0, at_mm)).y);
        if y > top {
            let length = if is_labelled { 6.0 } else { 3.0 };
            painter.hline((left - length)..=left, y, tick);
            if is_labelled {
                let at = pos2(left - 9.0, y);
                painter.text(
                    at,
                    Align2::RIGHT_CENTER,
                    label(at_mm),
                    theme::small_number(),
                    palette.dim,
                );
            }
        }
    }
    if let Some(place) = display {
        let at = view.screen(place);
        let mark = Stroke::new(1.5, palette.contactor);
        painter.vline(at.x, (top - 8.0)..=top, mark);
        painter.hline((left - 8.0)..=left, at.y, mark);
    }
}

/// Marks from 0 to `length_mm`: labelled ones a round distance apart, five or ten parts between.
fn marks(length_mm: f64, points_per_mm: f64) -> impl Iterator<Item = Mark> {
    let step_mm = round_step(MIN_LABEL_POINTS / points_per_mm.max(1e-6));
    let fine_mm = step_mm / 5.0;
    let n_marks = (length_mm / fine_mm + 1e-6).floor().clamp(0.0, 2000.0);
    (0..=2000_u32)
        .take_while(move |&i| f64::from(i) <= n_marks)
        .map(move |i| Mark {
            at_mm: f64::from(i) * fine_mm,
            is_labelled: i % 5 == 0,
        })
}

/// The smallest of 1, 2, 5 · 10ⁿ that is at least `least`.
fn round_step(least: f64) -> f64 {
    let decade = 10.0_f64.powf(least.log10().floor());
    let factors = [1.0, 2.0, 5.0, 10.0];
    factors
        .into_iter()
        .map(|f| f * decade)
        .find(|&s| s >= least * (1.0 - 1e-9))
        .unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (least, expected) in [
            (17.0, 20.0),
            (20.0, 20.0),
            (21.0, 50.0),
            (0.3, 0.5),
            (61.0, 100.0),
        ] {
            assert!(
                (round_step(least) - expected).abs() < 1e-9,
                "{least} → {}",
                round_step(least)
            );
        }
    }

    #[test]
    fn a_ruler_of_260_mm_is_marked_every_ten_and_labelled_every_fifty() {
        let marks: Vec<Mark> = marks(260.0, 2.2).collect();
        assert_eq!(marks.len(), 27);
        let labelled: Vec<f64> = marks
            .iter()
            .filter(|m| m.is_labelled)
            .map(|m| m.at_mm)
            .collect();
        assert_eq!(labelled, [0.0, 50.0, 100.0, 150.0, 200.0, 250.0]);
    }
}
