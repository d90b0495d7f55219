//! Which part of the workspace is in sight: all of it, or a place with a magnification.
//!
//! Plain data and arithmetic; who holds a camera applies what the user wants to see to it. The
//! workspace cannot be lost: a bit of it stays in sight however far one goes.

use eframe::egui::Rect;

use crate::bench::command::Look;
use crate::kit::view_transform::ViewTransform;
use selvedge_foundation::geometry::Point;

/// Space around the workspace when all of it is shown, points.
const MARGIN: f32 = 16.0;
/// The least and the most points per millimetre.
const MAGNIFICATIONS: [f64; 2] = [0.2, 200.0];
/// How much of the workspace stays in sight, points.
const IN_SIGHT: f64 = 48.0;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Camera {
    /// All of the workspace, as large as fits.
    #[default]
    Fit,
    /// A part of it.
    At {
        /// The place in the middle of the pane.
        centre: Point,
        /// Points per millimetre.
        points_per_mm: f64,
    },
}

impl Camera {
    /// How a workspace of `size_mm` is laid on the pane.
    pub(crate) fn view(self, pane: Rect, size_mm: [f64; 2]) -> ViewTransform {
        let rect = pane.shrink(MARGIN);
        match self {
            Self::Fit => ViewTransform::fitted(rect, size_mm),
            Self::At {
                centre,
                points_per_mm,
            } => {
                let centre = kept_in_sight(centre, points_per_mm, rect, size_mm);
                ViewTransform::new(rect, centre, points_per_mm)
            }
        }
    }

    /// The camera after the user wanted to see something else. True size needs a calibrated screen
    /// (`true_points_per_mm`); what makes no sense changes nothing.
    #[must_use]
    pub(crate) fn apply(
        self,
        look: Look,
        pane: Rect,
        size_mm: [f64; 2],
        true_points_per_mm: Option<f64>,
    ) -> Self {
        let view = self.view(pane, size_mm);
        let middle = view.centre;
        let points_per_mm = view.points_per_mm;
        let (centre, wanted) = match look {
            Look::Fit => return Self::Fit,
            Look::TrueSize => match true_points_per_mm {
                Some(true_points_per_mm) => (middle, true_points_per_mm),
                None => return self,
            },
            Look::Zoom(factor, place) => {
                let wanted = magnified(points_per_mm, factor);
                (
                    place.toward(middle, points_per_mm / limited(wanted)),
                    wanted,
                )
            }
            Look::ZoomBy(factor) => (middle, magnified(points_per_mm, factor)),
            Look::Centre(place) => (place, points_per_mm),
        };
        if !(centre.is_finite() && wanted.is_finite() && wanted > 0.0) {
            return self;
        }
        let points_per_mm = limited(wanted);
        let centre = kept_in_sight(centre, points_per_mm, view.rect, size_mm);
        Self::At {
            centre,
            points_per_mm,
        }
    }
}

/// The magnification after a step; `NaN` for a factor that is none.
fn magnified(points_per_mm: f64, factor: f64) -> f64 {
    if factor > 0.0 {
        points_per_mm * factor
    } else {
        f64::NAN
    }
}

fn limited(points_per_mm: f64) -> f64 {
    let [least, most] = MAGNIFICATIONS;
    points_per_mm.clamp(least, most)
}

/// The nearest middle from which a bit of the workspace is still seen.
fn kept_in_sight(centre: Point, points_per_mm: f64, rect: Rect, size_mm: [f64; 2]) -> Point {
    let along = |at_mm: f64, size_mm: f64, extent: f32| {
        let size_mm = if size_mm > 0.0 { size_mm } else { 1.0 };
        let half_mm = 0.5 * f64::from(extent.max(1.0)) / points_per_mm;
        let kept_mm = (IN_SIGHT / points_per_mm).min(size_mm).min(half_mm);
        at_mm.clamp(kept_mm - half_mm, size_mm - kept_mm + half_mm)
    };
    Point::new(
        along(centre.x_mm, size_mm[0], rect.width()),
        along(centre.y_mm, size_mm[1], rect.height()),
    )
}

#[cfg(test)]
mod tests {
    use eframe::egui::{pos2, vec2};

    use super::*;

    const SIZE_MM: [f64; 2] = [260.0, 240.0];

    fn pane() -> Rect {
        Rect::from_min_size(pos2(34.0, 64.0), vec2(798.0, 600.0))
    }

    fn close_up() -> Camera {
        Camera::At {
            centre: Point::new(100.0, 80.0),
            points_per_mm: 7.0,
        }
    }

    #[test]
    fn a_camera_that_nobody_moved_shows_all_of_the_workspace() {
        let view = Camera::default().view(pane(), SIZE_MM);
        assert_eq!(view, ViewTransform::fitted(pane().shrink(16.0), SIZE_MM));
        assert_eq!(
            close_up().apply(Look::Fit, pane(), SIZE_MM, None),
            Camera::Fit
        );
    }

    #[test]
    fn zooming_about_a_place_holds_that_place() {
        let place = Point::new(61.0, 203.0);
        for camera in [Camera::Fit, close_up()] {
            for factor in [1.2, 0.8, 5.0] {
                let before = camera.view(pane(), SIZE_MM);
                let zoomed = camera.apply(Look::Zoom(factor, place), pane(), SIZE_MM, None);
                let after = zoomed.view(pane(), SIZE_MM);
                let moved = (after.screen(place) - before.screen(place)).length();
                assert!(moved < 1e-2, "{camera:?} × {factor}: moved by {moved}");
                let ratio = after.points_per_mm / before.points_per_mm;
                assert!((ratio - factor).abs() < 1e-9, "{ratio}");
            }
        }
    }

    #[test]
    fn magnification_has_ends() {
        let by = |camera: Camera, factor| {
            let zoomed = camera.apply(Look::ZoomBy(factor), pane(), SIZE_MM, None);
            zoomed.view(pane(), SIZE_MM).points_per_mm
        };
        assert_eq!(by(close_up(), 1e9), 200.0);
        assert_eq!(by(close_up(), 1e-9), 0.2);
    }

    #[test]
    fn the_workspace_cannot_be_lost() {
        for x_mm in [-1e6, 1e6] {
            let away = Look::Centre(Point::new(x_mm, -x_mm));
            for camera in [Camera::Fit, close_up()] {
                let camera = camera.apply(away, pane(), SIZE_MM, None);
                let view = camera.view(pane(), SIZE_MM);
                let corners = [Point::default(), Point::new(SIZE_MM[0], SIZE_MM[1])];
                let [low, high] = corners.map(|corner| view.screen(corner));
                let seen = Rect::from_two_pos(low, high).intersect(pane());
                assert!(
                    seen.width() >= 47.0 && seen.height() >= 47.0,
                    "{camera:?}: {seen:?}"
                );
            }
        }
    }

    #[test]
    fn true_size_needs_a_calibrated_screen_and_keeps_the_middle() {
        let camera = close_up();
        assert_eq!(
            camera.apply(Look::TrueSize, pane(), SIZE_MM, None),
            camera,
            "nobody knows the screen"
        );
        let expected = Camera::At {
            centre: Point::new(100.0, 80.0),
            points_per_mm: 3.78,
        };
        assert_eq!(
            camera.apply(Look::TrueSize, pane(), SIZE_MM, Some(3.78)),
            expected
        );
    }

    #[test]
    fn what_makes_no_sense_changes_nothing() {
        let nowhere = Point::new(f64::NAN, 0.0);
        let looks = [
            Look::ZoomBy(0.0),
            Look::ZoomBy(f64::NAN),
            Look::ZoomBy(-2.0),
            Look::Zoom(2.0, nowhere),
            Look::Centre(nowhere),
        ];
        for look in looks {
            assert_eq!(
                close_up().apply(look, pane(), SIZE_MM, None),
                close_up(),
                "{look:?}"
            );
        }
        for true_size in [f64::NAN, 0.0, -1.0] {
            let camera = close_up().apply(Look::TrueSize, pane(), SIZE_MM, Some(true_size));
            assert_eq!(camera, close_up(), "{true_size}");
        }
        let nothing = close_up().view(Rect::ZERO, [0.0, f64::NAN]);
        assert!(nothing.workspace(pos2(3.0, 4.0)).is_finite());
    }
}
