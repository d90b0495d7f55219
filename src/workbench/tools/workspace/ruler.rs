//! Rulers along the top and the left of the workspace, in mm.

use eframe::egui::{Align2, Painter, Pos2, Rect, Stroke, pos2, vec2};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::kit::widgets::axis::round_step;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity;

/// How high the upper ruler is, points.
pub(crate) const TOP: f32 = 20.0;
/// How wide the left ruler is, points.
pub(crate) const LEFT: f32 = 34.0;

/// Least distance between labelled marks, points.
const MIN_LABEL_POINTS: f64 = 48.0;
/// Labels wider than this have no room beside their mark on the left ruler, points.
const LEFT_ROOM: f32 = LEFT - 10.0;

/// A mark on a ruler.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mark {
    at_mm: f64,
    is_labelled: bool,
}

/// What the rulers point out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pointed {
    /// The middle of the display.
    pub(crate) display: Option<Point>,
    /// The pointer, where it arranges; with its numbers.
    pub(crate) pointer: Option<Point>,
}

/// Draws both rulers along the edges of `frame`.
pub(crate) fn paint(
    painter: &Painter,
    frame: Rect,
    view: &ViewTransform,
    size_mm: [f64; 2],
    pointed: Pointed,
) {
    let rulers = Rulers {
        painter,
        palette: Palette::of(painter.ctx().theme()),
        edge: frame.min + vec2(LEFT, TOP),
        view,
        step_mm: round_step(MIN_LABEL_POINTS / view.points_per_mm.max(1e-6)),
    };
    let line = Stroke::new(1.0, rulers.palette.hairline);
    painter.hline(frame.x_range(), rulers.edge.y, line);
    painter.vline(rulers.edge.x, frame.y_range(), line);
    painter.text(
        pos2(frame.left() + 0.5 * LEFT, frame.top() + 0.5 * TOP),
        Align2::CENTER_CENTER,
        "mm",
        theme::small_number(),
        rulers.palette.dim,
    );
    let low = view.workspace(pos2(rulers.edge.x, frame.bottom()));
    let high = view.workspace(pos2(frame.right(), rulers.edge.y));
    for mark in marks([low.x_mm, high.x_mm], rulers.step_mm) {
        rulers.mark_top(mark, size_mm[0]);
    }
    for mark in marks([low.y_mm, high.y_mm], rulers.step_mm) {
        rulers.mark_left(mark, size_mm[1]);
    }
    if let Some(place) = pointed.display {
        rulers.point_out(
            view.screen(place),
            Stroke::new(1.5, rulers.palette.contactor),
        );
    }
    if let Some(place) = pointed.pointer {
        rulers.read_out(place);
    }
}

struct Rulers<'a> {
    painter: &'a Painter,
    palette: &'static Palette,
    /// Where the rulers end and the ground begins.
    edge: Pos2,
    view: &'a ViewTransform,
    step_mm: f64,
}

impl Rulers<'_> {
    /// Marks outside the workspace are fainter.
    fn tick(&self, at_mm: f64, size_mm: f64) -> Stroke {
        let is_inside = (-1e-9..=size_mm + 1e-9).contains(&at_mm);
        let ink = if is_inside {
            self.palette.line
        } else {
            self.palette.hairline
        };
        Stroke::new(1.0, ink)
    }

    fn mark_top(&self, Mark { at_mm, is_labelled }: Mark, size_mm: f64) {
        let top = self.edge.y;
        let x = self.view.screen(Point::new(at_mm, 0.0)).x;
        let x = self.painter.round_to_pixel_center(x);
        if x <= self.edge.x {
            return;
        }
        let length = if is_labelled { 6.0 } else { 3.0 };
        self.painter
            .vline(x, (top - length)..=top, self.tick(at_mm, size_mm));
        if is_labelled {
            self.painter.text(
                pos2(x, top - 7.0),
                Align2::CENTER_BOTTOM,
                quantity::fixed(at_mm, decimals(self.step_mm)),
                theme::small_number(),
                self.palette.dim,
            );
        }
    }

    fn mark_left(&self, Mark { at_mm, is_labelled }: Mark, size_mm: f64) {
        let left = self.edge.x;
        let y = self.view.screen(Point::new(0.0, at_mm)).y;
        let y = self.painter.round_to_pixel_center(y);
        if y <= self.edge.y {
            return;
        }
        let mut length = if is_labelled { 6.0 } else { 3.0 };
        if is_labelled {
            let digits = quantity::fixed(at_mm, decimals(self.step_mm));
            let font = theme::small_number();
            let galley = self.painter.layout_no_wrap(digits, font, self.palette.dim);
            let size = galley.size();
            let mut gap = 3.0;
            if size.x > LEFT_ROOM {
                (length, gap) = (1.0, 2.0);
            }
            let corner = pos2(left - length - gap - size.x, y - 0.5 * size.y);
            self.painter.galley(corner, galley, self.palette.dim);
        }
        self.painter
            .hline((left - length)..=left, y, self.tick(at_mm, size_mm));
    }

    fn point_out(&self, at: Pos2, stroke: Stroke) {
        if at.x > self.edge.x {
            self.painter
                .vline(at.x, (self.edge.y - 8.0)..=self.edge.y, stroke);
        }
        if at.y > self.edge.y {
            self.painter
                .hline((self.edge.x - 8.0)..=self.edge.x, at.y, stroke);
        }
    }

    /// The pointer's own numbers, on top of what the rulers say there.
    fn read_out(&self, place: Point) {
        let at = self.view.screen(place);
        let ink = self.palette.selection;
        self.point_out(at, Stroke::new(1.0, ink));
        let decimals = if self.view.points_per_mm > 20.0 { 2 } else { 1 };
        let number = |mm: f64, decimals| {
            let digits = quantity::fixed(mm, decimals);
            self.painter
                .layout_no_wrap(digits, theme::small_number(), ink)
        };
        let across = number(place.x_mm, decimals);
        let size = across.size() + vec2(6.0, 0.0);
        let plate = Rect::from_center_size(pos2(at.x, self.edge.y - 14.0), size);
        self.painter.rect_filled(plate, 2, self.palette.raised);
        self.painter.galley(plate.min + vec2(3.0, 0.0), across, ink);
        // The left ruler has room for five letters, and for no more.
        let is_long = place.y_mm >= 100.0 || place.y_mm <= -10.0;
        let up = number(place.y_mm, if is_long { 1 } else { decimals });
        let corner = pos2(self.edge.x - 2.0 - up.size().x, at.y - 0.5 * up.size().y);
        let plate = Rect::from_min_max(
            corner - vec2(2.0, 0.0),
            pos2(self.edge.x, corner.y + up.size().y),
        );
        self.painter.rect_filled(plate, 2, self.palette.raised);
        self.painter.galley(corner, up, ink);
    }
}

/// Marks between two places: labelled ones `step_mm` apart, five parts between.
fn marks([low_mm, high_mm]: [f64; 2], step_mm: f64) -> impl Iterator<Item = Mark> {
    let fine_mm = step_mm / 5.0;
    let first = (low_mm / fine_mm - 1e-6).ceil();
    let n_marks = ((high_mm / fine_mm + 1e-6).floor() - first).clamp(-1.0, 2000.0);
    (0..=2000_u32)
        .take_while(move |&i| f64::from(i) <= n_marks)
        .map(move |i| {
            let number = first + f64::from(i);
            Mark {
                at_mm: number * fine_mm,
                is_labelled: number.rem_euclid(5.0) < 0.5,
            }
        })
}

/// Decimals that tell labels apart which are this far from each other.
fn decimals(step_mm: f64) -> usize {
    match step_mm {
        step_mm if step_mm >= 1.0 => 0,
        step_mm if step_mm >= 0.1 => 1,
        _ => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labelled(range_mm: [f64; 2], step_mm: f64) -> Vec<f64> {
        marks(range_mm, step_mm)
            .filter(|mark| mark.is_labelled)
            .map(|mark| mark.at_mm)
            .collect()
    }

    #[test]
    fn a_ruler_of_260_mm_is_marked_every_ten_and_labelled_every_fifty() {
        assert_eq!(marks([0.0, 260.0], 50.0).count(), 27);
        let expected = [0.0, 50.0, 100.0, 150.0, 200.0, 250.0];
        assert_eq!(labelled([0.0, 260.0], 50.0), expected);
    }

    #[test]
    fn marks_go_on_below_zero_and_between_millimetres() {
        assert_eq!(labelled([-120.0, 30.0], 50.0), [-100.0, -50.0, 0.0]);
        assert_eq!(labelled([17.2, 18.1], 0.5), [17.5, 18.0]);
        assert_eq!([1.0, 0.5, 0.05].map(decimals), [0, 1, 2]);
        assert_eq!(marks([5.0, -5.0], 1.0).count(), 0);
        assert_eq!(marks([f64::NAN, 5.0], 1.0).count(), 0);
    }
}
