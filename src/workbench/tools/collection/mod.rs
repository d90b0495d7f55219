//! The whole library at once: what of it is shown, on which axes, and which of it is selected.
//!
//! ```text
//! library ─▶ measuring (a thread: levels at the chosen speed) ─┐
//! choice (speed, axes, tuned or raw, search, order) ───────────┼▶ CollectionView ─▶ pane, export
//! tuning, manifests' gains, reference level ───────────────────┘
//! ```
//!
//! Neither saved nor undone. Gains are applied when it is drawn, so that no slider computes
//! anything.

pub(crate) mod chart;
pub(crate) mod listing;
pub(crate) mod measure;
pub(crate) mod measuring;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod view;

pub(crate) use crate::tools::collection::state::Collection;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::tools::collection::measuring::Asked;
use crate::tools::collection::view::hand::Hand;

impl Collection {
    /// Has the library measured as the pane shows it.
    fn measure(&mut self, bench: &mut Bench) {
        let asked = Asked {
            speed_mm_per_s: self.choice.speed_mm_per_s,
            filters: bench.document.scene().filters,
        };
        let items = bench.library.view.items().iter();
        let usable = items.filter(|item| item.flaw.is_none());
        let ids = usable.map(|item| item.id.clone());
        let library = bench.library.view.library();
        self.measurements.catch_up(&bench.ctx, library, asked, ids);
        for flaw in self.measurements.take_flaws() {
            bench.notices.give(flaw);
        }
    }

    /// Shows the pane and takes what is chosen in it.
    fn show(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let items = context.bench.library.view.shared_items();
        let mut hand = Hand {
            choice: self.choice.clone(),
            search: self.search.clone(),
            pointed: None,
            halts: None,
            bench: &mut *context.bench,
            commands: &mut *context.commands,
        };
        let view = self.view(&items, context.scene, &hand.bench.library.selection);
        view::show(ui, &view, &mut hand);
        let Hand {
            choice,
            search,
            pointed,
            halts,
            ..
        } = hand;
        if (&self.choice, &self.pointed) != (&choice, &pointed) {
            ui.ctx().request_repaint();
        }
        self.choice.take(choice);
        (self.search, self.pointed) = (search, pointed);
        match halts {
            Some(true) => self.measurements.halt(),
            Some(false) => self.measurements.go_on(),
            None => {}
        }
    }
}

impl Tool for Collection {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Collection]
    }

    fn logic(&mut self, bench: &mut Bench) {
        if !bench.shows(Pane::Collection) {
            self.measurements.rest();
        }
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| {
            self.measure(context.bench);
            self.show(ui, context);
        });
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let (scene, origin) = (bench.plain_scene_view(), bench.origin());
        let items = bench.library.view.shared_items();
        let view = self.view(&items, &scene, &bench.library.selection);
        if view.entries.iter().all(|one| one.figures.is_none()) {
            return Err(
                "There is nothing to export yet: the library is measured while the Collection \
                 pane is in sight",
            );
        }
        Ok(chart::exported(&view, origin))
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.leave_library();
    }
}
