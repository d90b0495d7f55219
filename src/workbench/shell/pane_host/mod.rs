//! The panes in their tiles: which view is drawn where.
//!
//! A pane that is hidden, or behind another, is not drawn, and nothing is computed for it.

pub(crate) mod tiles;

use eframe::egui::{RichText, Ui};

use crate::bench::export::Exportable;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tools};
use crate::kit::pane::framed;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::paragraph;
use crate::shell::state::PaneFocus;
use crate::shell::tab_row::TabRow;

/// Everything that panes are drawn from, and what came of drawing them.
pub(crate) struct PaneHost<'a> {
    /// What panes are drawn with.
    pub(crate) context: PaneContext<'a>,
    /// The tools.
    pub(crate) tools: &'a mut Tools,
    /// How often each pane was drawn.
    pub(crate) n_drawn: &'a mut [u64; Pane::ALL.len()],
    /// Whether panes were moved.
    pub(crate) is_rearranged: bool,
    /// The pane that has the focus as a whole.
    pub(crate) focus: &'a mut PaneFocus,
    /// The pane that the tour speaks of.
    pub(crate) toured: Option<Pane>,
    /// Where titles and the pane's corner have no room side by side, the corner stands in the pane.
    pub row: TabRow,
}

impl PaneHost<'_> {
    fn show(&mut self, ui: &mut Ui, pane: Pane) {
        self.n_drawn[pane.index()] += 1;
        if ui.input(|input| input.pointer.any_pressed()) && ui.rect_contains_pointer(ui.max_rect())
        {
            self.context.bench.pointer.pane_in_use = Some(pane);
        }
        self.focus.take(ui, pane);
        if self.context.bench.is_veiled(pane) {
            return framed(ui, 10, show_veil);
        }
        if let Some(tool) = self.tools.showing(pane) {
            tool.ui(pane, ui, &mut self.context);
        }
    }
}

/// What stands in the place of a pane that would tell too much.
fn show_veil(ui: &mut Ui) {
    let words = "Hidden while a session is held: what lies under the finger is not to be seen.";
    let ink = Palette::in_ui(ui).dim;
    ui.add_space(2.0 * STEP);
    paragraph(ui, RichText::new(words).color(ink));
}

/// The right end of a row of tabs: what belongs to the pane in front.
impl PaneHost<'_> {
    fn show_corner(&mut self, ui: &mut Ui, pane: Pane) {
        if pane.has_export() {
            crate::bench::export::button::show(ui, Exportable::Pane(pane), self.context.commands);
        }
        if let Some(tool) = self.tools.showing(pane) {
            if !self.context.bench.is_veiled(pane) {
                return tool.corner(pane, ui, &mut self.context);
            }
            // It looks as ever, and a session goes on as it is.
            let corner = ui.scope(|ui| {
                ui.visuals_mut().disabled_alpha = 1.0;
                ui.disable();
                tool.corner(pane, ui, &mut self.context);
            });
            let rect = corner.response.rect;
            if ui.input(|input| input.pointer.any_click()) && ui.rect_contains_pointer(rect) {
                self.context.bench.refuse_in_session();
            }
        }
    }
}
