//! Why a contactor does what it does: every number from its place to its drive code, in order.
//!
//! What is shown can be copied as text and saved as a table.

pub(crate) mod explanation;
pub(crate) mod export;
#[cfg(test)]
mod tests;
pub(crate) mod text;
pub(crate) mod view;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::export::{Exported, NO_CONTACTOR};
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::widgets::text::toggle;
use crate::tools::why::explanation::Explanation;
use crate::tools::why::text::to_text;

/// The explanation of the chosen contactor.
#[derive(Debug, Default)]
pub(crate) struct Why {
    /// What is shown.
    pub(crate) shown: Option<Explanation>,
    /// Whether it stays while everything else goes on.
    is_frozen: bool,
}

impl Why {
    /// Explains the chosen contactor as it is now, unless the explanation is frozen.
    fn explain(&mut self, bench: &mut Bench) {
        if !self.is_frozen || self.shown.is_none() {
            self.shown = Explanation::of_chosen(bench);
        }
    }
}

impl Tool for Why {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Why]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.explain(context.bench);
        let filters = &context.scene.filters;
        framed(ui, 10, |ui| view::show(ui, self.shown.as_ref(), filters));
    }

    /// Copy, freeze, hear, and the contactors beside.
    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let Some(shown) = &self.shown else {
            return;
        };
        if toggle(ui, "copy", false, "Copy the chain as text") {
            ui.ctx().copy_text(to_text(shown));
        }
        let tip = "Hold the explanation while everything else goes on";
        if toggle(ui, "freeze", self.is_frozen, tip) {
            self.is_frozen = !self.is_frozen;
            ui.ctx().request_repaint();
        }
        let is_alone = context.bench.heard_alone().is_some();
        let tip = "Hear this contactor alone, or all of them again";
        if toggle(ui, "hear", is_alone, tip) {
            context.bench.hear_alone(!is_alone);
            ui.ctx().request_repaint();
        }
        let n_contactors = context.bench.live.dots.len();
        let chosen = context.bench.selection.contactor;
        let Some(contactor) = chosen.filter(|contactor| *contactor < n_contactors) else {
            return;
        };
        // Around all of them.
        let steps = [
            ("›", 1, "Choose the next contactor, in every view"),
            (
                "‹",
                n_contactors - 1,
                "Choose the contactor before, in every view",
            ),
        ];
        for (sign, step, tip) in steps {
            if toggle(ui, sign, false, tip) {
                let next = (contactor + step) % n_contactors;
                (context.commands).push(ShowCommand::SelectContactor(next).into());
            }
        }
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        self.explain(bench);
        let shown = self.shown.as_ref().ok_or(NO_CONTACTOR)?;
        let filters = bench.document.scene().filters;
        Ok(export::explanation(shown, &filters, bench.origin()))
    }
}
