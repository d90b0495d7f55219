//! The textiles of the workspace in the accessibility tree: painted, they would not be there.

use eframe::egui::{Rect, Ui, accesskit};

use crate::tools::workspace::{Stage, arrange};

/// Declares every textile in sight, with its place on the screen.
pub(crate) fn declare(ui: &Ui, stage: &Stage<'_>) {
    for (index, cloth) in stage.scene.cloths.iter().enumerate() {
        let bounds = arrange::screen_bounds(&stage.view, cloth).intersect(stage.ground);
        if !bounds.is_positive() {
            continue;
        }
        let id = ui.scope_id().with(("textile in the workspace", index));
        let name = format!("Textile {} {}", cloth.label, cloth.name);
        ui.ctx().accesskit_node_builder(id, |node| {
            node.set_role(accesskit::Role::Figure);
            node.set_label(name);
            node.set_bounds(accesskit_rect(bounds));
        });
    }
}

fn accesskit_rect(rect: Rect) -> accesskit::Rect {
    accesskit::Rect {
        x0: rect.min.x.into(),
        y0: rect.min.y.into(),
        x1: rect.max.x.into(),
        y1: rect.max.y.into(),
    }
}
