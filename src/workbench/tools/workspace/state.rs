//! How the workspace is looked at: plain data.

use eframe::egui::Rect;

use crate::bench::command::{Look, Tool};
use crate::bench::overlays::Overlays;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::camera::Camera;

/// How the workspace is looked at. Never undoable.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct WorkspaceView {
    /// Which part of it is in sight.
    pub camera: Camera,
    /// What a drag does.
    pub tool: Tool,
    /// What is drawn over the cloth.
    pub overlays: Overlays,
    /// Whether the screen is being calibrated to true size.
    pub(crate) is_calibrating: bool,
    /// Physical pixels per millimetre of the screen, once it is calibrated.
    pub(crate) true_pixels_per_mm: Option<f64>,
}

/// Where the workspace is shown, which some commands need to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// The ground of the workspace when it was drawn last, points.
    pub pane: Rect,
    /// Width and height of the workspace, mm.
    pub size_mm: [f64; 2],
    /// Pixels per point.
    pub pixels_per_point: f32,
}

impl WorkspaceView {
    /// Shows true size on a screen with this many pixels per millimetre.
    pub(crate) fn calibrate(&mut self, pixels_per_mm: f64, place: Place) {
        self.true_pixels_per_mm = Some(pixels_per_mm);
        self.is_calibrating = false;
        self.look(Look::TrueSize, place);
    }

    /// Points per millimetre at true size, once the screen is calibrated.
    pub(crate) fn true_points_per_mm(&self, pixels_per_point: f32) -> Option<f64> {
        self.true_pixels_per_mm
            .map(|pixels_per_mm| pixels_per_mm / f64::from(pixels_per_point))
    }

    /// Whether a view shows true size, to half a percent.
    pub(crate) fn is_true_size(&self, view: &ViewTransform, pixels_per_point: f32) -> bool {
        self.true_points_per_mm(pixels_per_point)
            .is_some_and(|wanted| (view.points_per_mm / wanted - 1.0).abs() < 0.005)
    }

    /// Looks; true size asks for a calibration first where there is none.
    pub(crate) fn look(&mut self, look: Look, place: Place) {
        let true_size = self.true_points_per_mm(place.pixels_per_point);
        if look == Look::TrueSize && true_size.is_none() {
            self.is_calibrating = true;
        }
        self.camera = self
            .camera
            .apply(look, place.pane, place.size_mm, true_size);
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{pos2, vec2};

    use super::*;

    fn place() -> Place {
        Place {
            pane: Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 600.0)),
            size_mm: [260.0, 260.0],
            pixels_per_point: 2.0,
        }
    }

    #[test]
    fn true_size_asks_for_a_calibration_and_holds_at_every_scale_of_the_window() {
        let mut state = WorkspaceView::default();
        state.look(Look::TrueSize, place());
        assert!(state.is_calibrating, "nobody knows the screen yet");
        assert_eq!(state.camera, Camera::Fit);
        state.calibrate(9.0, place());
        assert!(!state.is_calibrating, "done");
        let Place { pane, size_mm, .. } = place();
        let view = state.camera.view(pane, size_mm);
        assert!((view.points_per_mm - 4.5).abs() < 1e-12, "{view:?}");
        assert!(state.is_true_size(&view, 2.0));
        assert!(!state.is_true_size(&view, 1.0), "the window was rescaled");
    }
}
