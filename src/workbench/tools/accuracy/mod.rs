//! How accurate the running method is and what it costs: ticks checked against `reference` while
//! somebody looks, the cost of every tick, and every method measured on this very scene.
//!
//! ```text
//! snapshot ─▶ sample ─▶ bounded queue ─▶ thread: reference, error ─▶ latest view ─▶ pane
//! ```
//!
//! Nothing is sampled while the pane is hidden. A tick is checked only when the snapshot shows all
//! commands that were sent, so that a slider on its way is never taken for an error.

pub(crate) mod checker;
pub(crate) mod measuring;
pub(crate) mod sampling;
pub(crate) mod view;
pub(crate) mod worker;

pub(crate) use crate::tools::accuracy::sampling::Accuracy;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::export::{Exported, NOTHING_FELT};
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;

impl Tool for Accuracy {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Accuracy]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.poll_measuring(bench);
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.watch(context.bench);
        self.take_found();
        framed(ui, 10, |ui| view::show(ui, self, context));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, _context: &mut PaneContext<'_>) {
        view::show_corner(ui, self);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        self.take_found();
        if self.found().n_ticks == 0 && self.measured.is_none() {
            return Err(NOTHING_FELT);
        }
        let (rendering, origin) = (
            bench.settings.preferences.rendering,
            bench.rendered_origin(),
        );
        Ok(view::chart::exported(self, rendering, origin))
    }
}
