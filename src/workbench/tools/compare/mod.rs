//! Compare: two tunings, two textiles or two methods on the same path, rendered offline and set
//! against each other; or two recordings as they were.

pub(crate) mod choice;
pub(crate) mod comparison;
pub(crate) mod export;
pub(crate) mod view;
pub(crate) mod words;

pub(crate) use crate::tools::compare::comparison::Compare;

use eframe::egui::{Theme, Ui};

use crate::bench::Bench;
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::theme::Palette;

impl Tool for Compare {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Compare]
    }

    fn logic(&mut self, bench: &mut Bench) {
        if let Some(two) = bench.exploration.recordings.compared.take() {
            self.set_against(two);
        }
        self.poll();
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| view::show(ui, self, context));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        view::controls::show_corner(ui, self, context.bench);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        // On paper: no difference is nearly white, whatever the window's theme.
        let map = Palette::of(Theme::Light).differences();
        let compared = self.found().zip(self.sides());
        let (difference, sides) = compared
            .ok_or("There is nothing to export yet: press “compare” in the Compare pane")?;
        let grid = bench.plain_scene_view().grid;
        let grid = grid.unwrap_or((1, difference.by_contactor.len()));
        let origin = bench.origin();
        Ok(export::differences(difference, sides, (grid, map), origin))
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.forget();
    }
}
