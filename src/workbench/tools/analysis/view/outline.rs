//! The sections to choose from, under the name of their experiment.

use eframe::egui::{Align2, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use crate::bench::query::capitalised;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::list;
use crate::kit::widgets::text::{paint_line, section};
use selvedge_experiment::analysis::Section;

/// Height of a row, points.
const LINE: f32 = 22.0;

/// The name of the experiment and what the section is about: `Ranking: map` is of both.
pub(crate) fn named(title: &str) -> (&str, String) {
    match title.rsplit_once(": ") {
        Some((experiment, about)) => (experiment, capitalised(about)),
        None => ("", capitalised(title)),
    }
}

/// Shows the sections.
pub(crate) fn show(ui: &mut Ui, sections: &[Section], chosen: &mut usize) {
    let mut above = None;
    ui.add_space(STEP);
    for (nth, one) in sections.iter().enumerate() {
        let (experiment, about) = named(&one.title);
        if above != Some(experiment) {
            section(ui, experiment);
            above = Some(experiment);
        }
        if entry(ui, one, &about, nth == *chosen) {
            *chosen = nth;
            ui.ctx().request_repaint();
        }
    }
}

/// A section; says whether it was chosen.
fn entry(ui: &mut Ui, section: &Section, about: &str, is_chosen: bool) -> bool {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), LINE);
    let gap = std::mem::replace(&mut ui.spacing_mut().item_spacing.y, 0.0);
    let (row, response) = ui.allocate_exact_size(size, Sense::click());
    ui.spacing_mut().item_spacing.y = gap;
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, &section.title));
    if is_chosen || response.hovered() || response.has_focus() {
        let fill = if is_chosen {
            palette.hovered
        } else {
            palette.raised
        };
        ui.painter().rect_filled(row, 4, fill);
    }
    let ink = if is_chosen { palette.text } else { palette.dim };
    let counts = counts(section);
    let right = pos2(row.right() - 6.0, row.center().y);
    let described = ui.painter().text(
        right,
        Align2::RIGHT_CENTER,
        counts,
        theme::small_number(),
        palette.dim,
    );
    let left = pos2(row.left() + 6.0, row.center().y);
    let room = described.left() - left.x - 2.0 * STEP;
    paint_line(ui, left, room, RichText::new(about).color(ink));
    response.on_hover_text(tip(section)).clicked()
}

/// How many figures a section has.
fn counts(section: &Section) -> String {
    match section.figures.len() {
        0 => String::new(),
        1 => "1 figure".to_owned(),
        n => format!("{n} figures"),
    }
}

fn tip(section: &Section) -> String {
    let (n_tables, n_figures) = (section.tables.len(), section.figures.len());
    format!("{}\nfigures {n_figures}, tables {n_tables}", section.title)
}

/// The same as a closed list, where there is little room.
pub(crate) fn show_closed(ui: &mut Ui, sections: &[Section], chosen: &mut usize) {
    let now = sections.get(*chosen).map_or("", |section| &section.title);
    let width = ui.available_width();
    list(ui, ("analysis sections", "Section"), width, now, |ui| {
        for (nth, section) in sections.iter().enumerate() {
            if ui
                .selectable_label(nth == *chosen, &section.title)
                .clicked()
            {
                *chosen = nth;
                ui.ctx().request_repaint();
            }
        }
    });
}
