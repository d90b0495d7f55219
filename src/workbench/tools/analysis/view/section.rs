//! The section at hand: what to know, figures, tables.

use std::sync::Arc;

use eframe::egui::{Label, RichText, Ui};

use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::analysis::findings::Findings;
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::state::Analysis;
use crate::tools::analysis::view::{figure, table, words};
use selvedge_experiment::analysis::Section;

/// Lines longer than this are hard to read, points.
const MEASURE: f32 = 640.0;
/// The bar at the right of what scrolls, points.
const BAR: f32 = 12.0;

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
            Some(Err(error)) => context.bench.notices.give(error.to_string()),
            None => {}
        }
        ui.add_space(5.0 * STEP);
    }
    wanted
}
