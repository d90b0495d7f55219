//! What is analysed, and how: the folder, how much chance is drawn on; the report's files.

use std::path::Path;

use eframe::egui::{Align, Layout, ProgressBar, Role, Ui, WidgetInfo, vec2};

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::tool::PaneContext;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{LINE, Need, Tone, note, row_of, text};
use crate::kit::widgets::fold;
use crate::kit::widgets::text::{button, toggle};
use crate::tools::analysis::asked::Effort;
use crate::tools::analysis::state::Analysis;

/// Width of a row's name, points.
const NAME: f32 = 44.0;

/// Shows it all.
pub(crate) fn show(ui: &mut Ui, analysis: &mut Analysis, context: &mut PaneContext<'_>) {
    let mut name = None;
    row_of(ui, NAME, ("folder", ""), |ui, label| {
        name = Some(label.clone());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let tip = "Choose a folder and analyse it";
            if toggle(ui, "choose…", false, tip) {
                let ask = FileCommand::Ask(Purpose::OpenLogs);
                context.commands.push(ask.into());
            }
        });
    });
    if let Some(name) = name {
        // Below its name, since paths are long.
        let line = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(ui.available_width(), LINE), line, |ui| {
            ui.spacing_mut().interact_size.y = LINE - 2.0;
            let about = ("/path/to/study", f32::INFINITY, Need::Optional);
            text(ui, &name, &mut analysis.fields.folder, about);
        });
    }
    row_of(ui, NAME, ("seed", ""), |ui, label| {
        let seed = &mut analysis.fields.seed;
        text(ui, label, seed, ("1", 72.0, Need::Optional));
        show_effort(ui, &mut analysis.choice.effort);
    });
    show_more(ui, analysis, context.bench.has_session());
    ui.add_space(STEP);
    if let Some(share) = analysis.share() {
        show_progress(ui, share, "Analysing the sessions");
        if button(ui, "Cancel", "What was found before stays", None) {
            analysis.stop();
        }
    } else {
        let verb = if analysis.found.is_some() {
            "Analyse again"
        } else {
            "Analyse"
        };
        let tip = "Read the logs and compute everything";
        if button(ui, verb, tip, analysis.refusal()) {
            analysis.begin(context.bench);
        }
    }
    if let Some(line) = &analysis.failure {
        note(ui, line, Tone::Wrong);
    } else if analysis.is_past() && analysis.task.is_none() {
        let words = "What is shown was found with other choices: analyse again.";
        note(ui, words, Tone::Wrong);
    } else if analysis.has_moved_on() && analysis.task.is_none() {
        let words = "The folder has changed since: analyse again.";
        note(ui, words, Tone::Wrong);
    } else if let Some(found) = &analysis.found {
        let words = match found.n_sessions {
            1 => "1 session".to_owned(),
            n => format!("{n} sessions"),
        };
        note(ui, &words, Tone::Quiet);
    }
}

fn show_effort(ui: &mut Ui, chosen: &mut Effort) {
    for (effort, word, tip) in [
        (
            Effort::Quick,
            "quick",
            "For a look: 500 resamples, 499 permutations, 20 maps of resampled subjects",
        ),
        (
            Effort::Full,
            "full",
            "As in a report: 2000 resamples, 4999 permutations, 100 maps of resampled subjects",
        ),
    ] {
        if toggle(ui, word, *chosen == effort, tip) {
            *chosen = effort;
            ui.ctx().request_repaint();
        }
    }
}

/// What is chosen seldom.
fn show_more(ui: &mut Ui, analysis: &mut Analysis, has_session: bool) {
    let Analysis { choice, found, .. } = analysis;
    let left_out = found.as_ref().map_or(&[][..], |found| &found.left_out);
    row_of(ui, NAME, ("with", ""), |ui, _| {
        let tip = "Compare the stress of maps with that of random ranks: takes longer";
        if toggle(ui, "random data", choice.has_random_data, tip) {
            choice.has_random_data = !choice.has_random_data;
            ui.ctx().request_repaint();
        }
        if has_session || !left_out.is_empty() || choice.with_active {
            let tip = "Whoever takes part in a session that is being held counts too";
            if toggle(ui, "session under way", choice.with_active, tip) {
                choice.with_active = !choice.with_active;
                ui.ctx().request_repaint();
            }
        }
    });
    if !left_out.is_empty() {
        let words = format!(
            "{} is left out: a session of theirs is being held.",
            left_out.join(", ")
        );
        note(ui, &words, Tone::Quiet);
    }
}

fn show_progress(ui: &mut Ui, share: f32, name: &str) {
    let bar = ProgressBar::new(share)
        .desired_height(STEP)
        .fill(Palette::in_ui(ui).line);
    let response = ui.add(bar);
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
}

/// The same where there is little room: a name that unfolds.
pub(crate) fn show_folded(ui: &mut Ui, analysis: &mut Analysis, context: &mut PaneContext<'_>) {
    let folder = Path::new(analysis.fields.folder.trim()).file_name();
    let summary = folder.unwrap_or_default().to_string_lossy().into_owned();
    fold(ui, ("Folder and choices", false), &summary, |ui| {
        show(ui, analysis, context);
        show_report(ui, analysis, context);
    });
    if let Some(share) = analysis.share() {
        show_progress(ui, share, "Analysing the sessions");
    }
}

/// The report's files.
pub(crate) fn show_report(ui: &mut Ui, analysis: &Analysis, context: &mut PaneContext<'_>) {
    ui.add_space(2.0 * STEP);
    if let Some(task) = &analysis.writing {
        return show_progress(ui, task.share(), "Writing the report");
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let tip = "A page to read, every table as CSV and JSON, every figure as SVG and PNG";
        let is_past = analysis.is_past() || analysis.has_moved_on();
        let refusal = is_past.then_some("What is shown is of other logs or choices: analyse again");
        if button(ui, "Write report…", tip, refusal) {
            let ask = FileCommand::Ask(Purpose::WriteReport);
            context.commands.push(ask.into());
        }
        let is_written = matches!(analysis.written, Some(Ok(_)));
        if is_written && button(ui, "Show it", "Show the folder of the report", None) {
            analysis.show_report(context.bench);
        }
    });
    match &analysis.written {
        Some(Ok(folder)) => {
            let words = format!("Written: begin with {}", folder.join("index.md").display());
            note(ui, &words, Tone::Quiet);
        }
        Some(Err(line)) => note(ui, line, Tone::Wrong),
        None => {}
    }
    ui.allocate_space(vec2(1.0, STEP));
}
