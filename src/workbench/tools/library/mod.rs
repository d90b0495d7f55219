//! The libraries, to take textiles from, and the textiles of the scene, to mute, choose and remove.

pub(crate) mod cards;
pub(crate) mod list;
pub(crate) mod menus;
pub(crate) mod placed;
pub(crate) mod state;

pub(crate) use crate::tools::library::state::Library;

use eframe::egui::{Context, Stroke, Ui, UiBuilder};

use crate::bench::Bench;
use crate::bench::command::Command;
use crate::bench::history::StepList;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::library::list::ROW;

/// Most rows of the scene that are in sight at once.
const SCENE_ROWS: usize = 6;

impl Tool for Library {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Library]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| show(ui, self, context));
    }

    fn windows(&mut self, ctx: &Context, context: &mut PaneContext<'_>) {
        cards::show(ctx, self, context);
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        if matches!(command, Command::AllOff | Command::Dismiss) {
            self.renaming = None;
            bench.dispatch_library(LibraryCommand::ForgetKeep);
        }
    }

    fn is_open(&self, bench: &Bench) -> bool {
        let acts = &bench.library.acts;
        self.renaming.is_some() || acts.taken.is_some() || acts.listening.is_some()
    }

    /// While the last thing that was done was done with a library: the scene's list is here too.
    fn steps(&self, bench: &Bench) -> Option<StepList> {
        let acts = &bench.library.acts;
        acts.is_last.then(|| acts.steps())
    }

    fn step_to(&mut self, n_done: usize, bench: &mut Bench) {
        bench.step_library_to(n_done);
    }
}

/// Shows the pane.
fn show(ui: &mut Ui, state: &mut Library, context: &mut PaneContext<'_>) {
    let n_rows = context.scene.cloths.len().clamp(2, SCENE_ROWS);
    let lower = n_rows as f32 * (theme::ROW + STEP) + 28.0;
    let whole = ui.max_rect();
    let edge = (whole.bottom() - lower)
        .max(whole.top() + 3.0 * ROW)
        .round();
    let (above, below) = whole.split_top_bottom_at_y(edge);
    ui.scope_builder(UiBuilder::new().max_rect(above), |ui| {
        list::show(ui, state, context);
    });
    let line = Stroke::new(1.0, Palette::in_ui(ui).hairline);
    ui.painter().hline(whole.x_range(), edge + 1.0, line);
    let below = below.with_min_y(edge + STEP);
    ui.scope_builder(UiBuilder::new().max_rect(below), |ui| {
        placed::show(ui, context);
    });
}
