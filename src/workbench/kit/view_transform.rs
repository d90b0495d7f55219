//! Where a millimetre of the workspace is on the screen.
//!
//! Workspace: x right, y up. Screen: points, y down.

use eframe::egui::{Pos2, Rect, pos2};

use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;

/// How a part of the workspace is laid on a rectangle of the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ViewTransform {
    /// The rectangle, points.
    pub(crate) rect: Rect,
    /// The place in the workspace shown at the middle of the rectangle.
    pub(crate) centre: Point,
    /// Points per millimetre.
    pub(crate) points_per_mm: f64,
}

impl ViewTransform {
    /// Shows `points_per_mm` around `centre` in `rect`.
    pub(crate) fn new(rect: Rect, centre: Point, points_per_mm: f64) -> Self {
        Self {
            rect,
            centre,
            points_per_mm,
        }
    }

    /// Shows the whole of a workspace of `size_mm`, as large as fits in `rect`.
    pub(crate) fn fitted(rect: Rect, size_mm: [f64; 2]) -> Self {
        let [width_mm, height_mm] = size_mm.map(|mm| if mm > 0.0 { mm } else { 1.0 });
        let points_per_mm = (f64::from(rect.width().max(1.0)) / width_mm)
            .min(f64::from(rect.height().max(1.0)) / height_mm);
        Self::new(
            rect,
            Point::new(width_mm / 2.0, height_mm / 2.0),
            points_per_mm,
        )
    }

    /// How long a length in the workspace is on the screen, points.
    pub(crate) fn length(&self, length_mm: f64) -> f32 {
        to_single(length_mm * self.points_per_mm)
    }

    /// The screen's place of a place in the workspace.
    pub(crate) fn screen(&self, place: Point) -> Pos2 {
        let off = place - self.centre;
        let middle = self.rect.center();
        pos2(
            to_single(f64::from(middle.x) + off.x_mm * self.points_per_mm),
            to_single(f64::from(middle.y) - off.y_mm * self.points_per_mm),
        )
    }

    /// The place in the workspace at a place on the screen.
    pub(crate) fn workspace(&self, screen: Pos2) -> Point {
        let off = screen - self.rect.center();
        Point::new(
            self.centre.x_mm + f64::from(off.x) / self.points_per_mm,
            self.centre.y_mm - f64::from(off.y) / self.points_per_mm,
        )
    }
}

/// The window that the pointer is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Pointed {
    /// The workbench.
    #[default]
    Workbench,
    /// The participant's window.
    Participant,
}

/// Where a pane lets the pointer feel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointerGround {
    /// In which window.
    pub window: Pointed,
    /// How mm are laid on the screen.
    pub view: ViewTransform,
    /// The part of the screen where the pointer feels, points.
    pub rect: Rect,
    /// Width and height of what lies there, mm.
    pub size_mm: [f64; 2],
    /// Pixels per point.
    pub pixels_per_point: f32,
    /// Whether the pointer feels there now: not while it arranges, pans, or handles a control.
    pub feels: bool,
}

/// Whether a place is in the workspace or so close that the display still reaches into it.
pub(crate) fn is_near(place: Point, size_mm: [f64; 2]) -> bool {
    let reach_mm = 20.0;
    let within = |at: f64, size: f64| (-reach_mm..=size + reach_mm).contains(&at);
    within(place.x_mm, size_mm[0]) && within(place.y_mm, size_mm[1])
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;

    use super::*;

    #[test]
    fn up_in_the_workspace_is_up_on_the_screen_and_back() {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(600.0, 300.0));
        let view = ViewTransform::fitted(rect, [260.0, 260.0]);
        assert_eq!(view.screen(Point::new(130.0, 130.0)), rect.center());
        assert_eq!(view.screen(Point::new(130.0, 260.0)).y, rect.top());
        let there = Point::new(17.0, 203.0);
        assert!((view.workspace(view.screen(there)) - there).length_mm() < 1e-4);
    }

    #[test]
    fn a_workspace_without_extent_is_still_somewhere() {
        let view = ViewTransform::fitted(Rect::ZERO, [0.0, f64::NAN]);
        assert!(view.workspace(pos2(3.0, 4.0)).is_finite());
    }
}
