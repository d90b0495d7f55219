//! The study board: who took part, how far each session is, what of it counts, what is missing.

use std::path::PathBuf;

use eframe::egui::{Grid, ProgressBar, RichText, Ui};

use crate::bench::session::title_of;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Need, Tone, note, row_of, text};
use crate::kit::widgets::text::{button, mark, section};
use crate::tools::experiment::form::Form;
use crate::tools::experiment::held::{Held, Standing, missing};
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::design::Subject;

/// Width of a bar of progress, points.
const BAR: f32 = 96.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    let form = &mut experiment.form;
    row_of(ui, 60.0, ("folder", ""), |ui, label| {
        let hint = ("/path/to/study", f32::INFINITY, Need::Optional);
        text(ui, label, &mut form.folder, hint);
    });
    let refusal = form
        .kept_folder()
        .is_none()
        .then_some("Say in which folder first");
    if button(
        ui,
        "List again",
        "Look which sessions the folder holds",
        refusal,
    ) {
        experiment.list_sessions(context.bench, true);
        ui.ctx().request_repaint();
    }
    section(ui, "The study");
    show_missing(ui, &experiment.form);
    for line in &experiment.form.unread {
        note(ui, line, Tone::Wrong);
    }
    section(ui, "Sessions");
    if experiment.form.found.is_empty() {
        let words = "There is none yet. One that was interrupted is resumed from here.";
        return note(ui, words, Tone::Quiet);
    }
    if let Some(log) = show_sessions(ui, &experiment.form) {
        experiment.resume_session(log, context.bench);
        ui.ctx().request_repaint();
    }
}

fn show_missing(ui: &mut Ui, form: &Form) {
    let Ok(design) = form.study.design() else {
        return;
    };
    note(
        ui,
        &format!("{} ({})", title_of(design), design.study),
        Tone::Quiet,
    );
    for line in missing(&form.found, design.rules.subjects, &design.hash) {
        note(ui, &line, Tone::Quiet);
    }
}

/// Shows the sessions of the folder; the log of the one to be resumed.
fn show_sessions(ui: &mut Ui, form: &Form) -> Option<PathBuf> {
    let mut resumed = None;
    let mut broken: Vec<&str> = Vec::new();
    Grid::new("sessions")
        .num_columns(6)
        .spacing([16.0, STEP])
        .show(ui, |ui| {
            for head in ["participant", "progress", "count", "void", "state", ""] {
                ui.label(dim(ui, head));
            }
            ui.end_row();
            for one in &form.found {
                show_progress(ui, one);
                show_standing(ui, one);
                if one.standing == Standing::Open {
                    let tip = format!("Go on with {}", one.log.display());
                    if button(ui, "Resume", &tip, None) {
                        resumed = Some(one.log.clone());
                    }
                } else {
                    ui.label("");
                }
                ui.end_row();
                if let Standing::Broken(lines) = &one.standing {
                    broken.extend(lines.iter().map(String::as_str));
                }
            }
        });
    if !broken.is_empty() {
        section(ui, "Not as it was written: left out of the analysis");
        for line in broken {
            note(ui, line, Tone::Wrong);
        }
    }
    if let Some(line) = &form.failure {
        note(ui, line, Tone::Wrong);
    }
    resumed
}

/// Whose session it is, how far, and what of it counts.
fn show_progress(ui: &mut Ui, one: &Held) {
    let Subject {
        pseudonym, session, ..
    } = &one.subject;
    let tip = format!("{}\n{}", one.title, one.log.display());
    ui.label(format!("{pseudonym}, session {session}"))
        .on_hover_text(tip);
    let (done, all) = one.progress;
    #[expect(clippy::cast_precision_loss, reason = "some hundred trials")]
    let share = done as f32 / all.max(1) as f32;
    let bar = ProgressBar::new(share)
        .desired_width(BAR)
        .desired_height(4.0);
    ui.horizontal(|ui| {
        ui.add(bar);
        ui.label(dim(ui, &format!("{done} of {all}")));
    });
    let [valid, void, unknown] = one.counts;
    ui.label(match unknown {
        0 => valid.to_string(),
        n => format!("{valid} + {n} unknown"),
    });
    ui.label(void.to_string());
}

fn dim(ui: &Ui, words: &str) -> RichText {
    let palette = Palette::in_ui(ui);
    RichText::new(words).font(theme::small()).color(palette.dim)
}

fn show_standing(ui: &mut Ui, one: &Held) {
    let palette = Palette::in_ui(ui);
    let (lamp, words) = match &one.standing {
        Standing::Complete => (palette.dim, "complete"),
        Standing::Open => (palette.selection, "open"),
        Standing::Held => (palette.selection, "being held"),
        Standing::Broken(_) => (palette.danger, "not as it was written"),
    };
    let words = match one.unfelt {
        Some(who) => format!("{words}; {who}: felt by nobody"),
        None => words.to_owned(),
    };
    ui.horizontal(|ui| {
        mark(ui, lamp, &words);
        ui.label(words);
    });
}
