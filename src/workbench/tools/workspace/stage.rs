//! What the parts of the pane share during one frame.

use std::cell::Cell;

use eframe::egui::{Rect, Response};

use crate::bench::command::{Look, Tool};
use crate::bench::selection::Selection;
use crate::bench::trail::Trail;
use crate::bench::view::{Cloth, EngineView, SceneView};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::maps::Maps;
use crate::tools::workspace::overlay::lattice::Lattice;
use crate::tools::workspace::state::{Place, WorkspaceView};
use selvedge_render::array::ContactorReading;

/// Dots per inch of a screen that nobody measured, where a point is a dot.
const USUAL_DOTS_PER_INCH: f64 = 96.0;

/// What overlays are drawn from.
#[derive(Clone, Copy)]
pub(crate) struct Layers<'a> {
    /// What the contactors read and how they move; empty while that is not drawn.
    pub readings: &'a [ContactorReading],
    /// Maps of the textiles.
    pub maps: &'a Maps,
    /// Pictures of the points.
    pub lattice: &'a Lattice,
    /// The colours that stand for numbers.
    pub colours: ColourMap,
}

/// What the pane is drawn from.
#[derive(Clone, Copy)]
pub(crate) struct Sight<'a> {
    pub(crate) scene: &'a SceneView,
    pub(crate) live: &'a EngineView,
    pub(crate) trail: &'a Trail,
    pub(crate) selection: &'a Selection,
    pub(crate) layers: Layers<'a>,
    /// How the workspace is looked at in the next frame.
    pub(crate) next: &'a Cell<WorkspaceView>,
}

/// What the parts of the pane share during one frame.
pub(crate) struct Stage<'a> {
    pub(crate) sight: Sight<'a>,
    /// How it is looked at in this frame.
    pub(crate) state: WorkspaceView,
    /// The part of the screen where mm are.
    pub(crate) ground: Rect,
    pub(crate) view: ViewTransform,
    /// What the pointer does on the ground.
    pub(crate) response: Response,
}

impl Stage<'_> {
    /// Whether a drag moves textiles now.
    pub(crate) fn arranges(&self) -> bool {
        self.state.tool == Tool::Arrange && !self.state.is_calibrating
    }

    /// Points per millimetre at true size: as measured, else on a screen of 96 dots an inch.
    pub(crate) fn true_points_per_mm(&self) -> f64 {
        let ctx = &self.response.ctx;
        let native = ctx.native_pixels_per_point().unwrap_or(1.0);
        let pixels_per_mm = (self.state.true_pixels_per_mm).unwrap_or_else(|| {
            let dots_per_mm = USUAL_DOTS_PER_INCH / 25.4;
            dots_per_mm * f64::from(native)
        });
        pixels_per_mm / f64::from(ctx.pixels_per_point())
    }

    /// Changes how the workspace is looked at from the next frame on.
    pub(crate) fn change(&self, change: impl FnOnce(&mut WorkspaceView, Place)) {
        let mut next = self.sight.next.get();
        let place = Place {
            pane: self.ground,
            size_mm: self.sight.scene.size_mm,
            pixels_per_point: self.response.ctx.pixels_per_point(),
        };
        change(&mut next, place);
        self.sight.next.set(next);
    }

    /// Looks at another part of the workspace from the next frame on.
    pub(crate) fn look(&self, look: Look) {
        self.change(|view, place| view.look(look, place));
    }

    /// The chosen textile, if there still is one at its place.
    pub(crate) fn selected(&self) -> Option<(usize, &Cloth)> {
        let index = self.sight.selection.cloth?;
        Some((index, self.sight.scene.cloths.get(index)?))
    }
}
