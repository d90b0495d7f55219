//! The section at hand: what to know, figures, tables.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{Label, RichText, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, ShowCommand};
use crate::bench::pane::Pane;
use crate::bench::tool::PaneContext;
use crate::bench::view::SceneView;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::analysis::findings::{Findings, SHIPPED};
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::state::Analysis;
use crate::tools::analysis::view::figure::Asked;
use crate::tools::analysis::view::{figure, table, words};
use selvedge_experiment::analysis::Section;
use selvedge_textile::{Library, elsewhere};

/// Lines longer than this are hard to read, points.
const MEASURE: f32 = 640.0;
/// The bar at the right of what scrolls, points.
const BAR: f32 = 12.0;

/// What brings a textile under the finger: it is laid into the scene unless it lies there, and the
/// workspace comes into sight.
pub(crate) fn felt(key: &str, scene: &SceneView, own: &Library) -> [Command; 2] {
    let is_own = |name: &Path| name == own.root() || name == Path::new(SHIPPED) && own.is_shipped();
    let key = elsewhere(key).map_or(key, |(name, id)| if is_own(name) { id } else { key });
    let command = match scene.placed(key) {
        Some(index) => ShowCommand::SelectCloth(Some(index)).into(),
        None => Edit::AddCloths(vec![key.to_owned()]).into(),
    };
    [command, ShowCommand::Reveal(Pane::Workspace).into()]
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
        match figure::show(ui, (nth, drawn, room), found, analysis) {
            Some(Asked::Save) => analysis.save_figure(nth, context),
            Some(Asked::Feel(key)) => {
                let own = context.bench.engine_scene.loaded.library();
                for command in felt(&key, context.scene, own) {
                    context.commands.push(command);
                }
            }
            None => {}
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
