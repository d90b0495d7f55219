//! The section at hand: what to know, figures, tables.

use std::sync::Arc;

use eframe::egui::{ColorImage, Label, RichText, TextureHandle, Ui};

use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::analysis::Analysis;
use crate::tools::analysis::findings::Findings;
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::view::columns::TableLook;
use crate::tools::analysis::view::{figure, table, words};
use selvedge_experiment::analysis::Section;

/// Lines longer than this are hard to read, points.
const MEASURE: f32 = 640.0;
/// The bar at the right of what scrolls, points.
const BAR: f32 = 12.0;

/// Tables and figures of the section at hand as they are laid out.
#[derive(Default)]
pub(crate) struct Looks {
    of: Option<(Arc<Findings>, usize)>,
    /// By their place in the section.
    pub(crate) tables: Vec<Option<TableLook>>,
    /// The same; the picture that each was made of.
    pub(crate) textures: Vec<Option<(Arc<ColorImage>, TextureHandle)>>,
}

impl Looks {
    /// Forgets what belongs to another section.
    fn turn_to(&mut self, found: &Arc<Findings>, nth: usize, section: &Section) {
        let is_same = |(of, at): &(Arc<Findings>, usize)| Arc::ptr_eq(of, found) && *at == nth;
        if self.of.as_ref().is_some_and(is_same) {
            return;
        }
        self.of = Some((Arc::clone(found), nth));
        self.tables = section.tables.iter().map(|_| None).collect();
        self.textures = section.figures.iter().map(|_| None).collect();
    }
}

impl std::fmt::Debug for Looks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Looks")
            .field("section", &self.of.as_ref().map(|(_, nth)| nth))
            .finish_non_exhaustive()
    }
}

/// Shows a section in a room of this width; says which figures are wanted, if it has any.
pub(crate) fn show(
    ui: &mut Ui,
    found: &Arc<Findings>,
    (section, room): (&Section, f32),
    analysis: &mut Analysis,
    context: &mut PaneContext<'_>,
) -> Option<Wanted> {
    analysis.looks.turn_to(found, analysis.section, section);
    let palette = Palette::in_ui(ui);
    ui.add(Label::new(RichText::new(&section.title).font(theme::title())).wrap());
    ui.add_space(STEP);
    for note in &section.notes {
        ui.scope(|ui| {
            ui.set_max_width(MEASURE.min(ui.available_width()));
            ui.add(Label::new(words::job(note, palette)).wrap());
        });
    }
    ui.add_space(3.0 * STEP);
    let room = room - BAR;
    let wanted = (!section.figures.is_empty())
        .then(|| figure::wanted(ui, room, (Arc::clone(found), analysis.section)));
    for (nth, drawn) in section.figures.iter().enumerate() {
        if figure::show(ui, (nth, drawn, room), found, analysis) {
            analysis.save_figure(nth, context);
        }
        ui.add_space(4.0 * STEP);
    }
    for (nth, one) in section.tables.iter().enumerate() {
        let is_copied = table::show(ui, (nth, one), &mut analysis.looks.tables);
        match is_copied.then(|| one.to_csv()) {
            Some(Ok(text)) => ui.ctx().copy_text(text),
            Some(Err(error)) => context.bench.transient.notices.give(error.to_string()),
            None => {}
        }
        ui.add_space(5.0 * STEP);
    }
    wanted
}
