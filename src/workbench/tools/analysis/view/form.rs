//! What is analysed, and how: the folder, how much chance is drawn on; the report's files.

use std::path::Path;

use eframe::egui::{Align, Layout, ProgressBar, Role, Ui, WidgetInfo, vec2};

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{LINE, Need, Tone, note, row_of, text};
use crate::kit::widgets::fold;
use crate::kit::widgets::text::{button, toggle};
use crate::tools::analysis::AnalysisView;
use crate::tools::analysis::asked::{Choice, Effort, Fields};
use crate::tools::analysis::command::AnalysisCommand;

/// Width of a row's name, points.
const NAME: f32 = 44.0;

/// Shows it all.
pub(crate) fn show(
    ui: &mut Ui,
    view: &AnalysisView<'_>,
    fields: &mut Fields,
    commands: &mut Commands,
) {
    let mut name = None;
    row_of(ui, NAME, ("folder", ""), |ui, label| {
        name = Some(label.clone());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let tip = "Choose a folder and analyse it";
            if toggle(ui, "choose…", false, tip) {
                commands.push(FileCommand::Ask(Purpose::OpenLogs).into());
            }
        });
    });
    if let Some(name) = name {
        // Below its name, since paths are long.
        let line = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(ui.available_width(), LINE), line, |ui| {
            ui.spacing_mut().interact_size.y = LINE - 2.0;
            let about = ("/path/to/study", f32::INFINITY, Need::Optional);
            text(ui, &name, &mut fields.folder, about);
        });
    }
    row_of(ui, NAME, ("seed", ""), |ui, label| {
        text(ui, label, &mut fields.seed, ("1", 72.0, Need::Optional));
        show_effort(ui, view.choice, commands);
    });
    show_more(ui, view, commands);
    ui.add_space(STEP);
    if let Some(share) = view.share {
        show_progress(ui, share, "Analysing the sessions");
        if button(ui, "Cancel", "What was found before stays", None) {
            commands.push(AnalysisCommand::Stop.into());
        }
    } else {
        show_button(ui, view, commands);
    }
    if let Some(line) = view.failure {
        note(ui, line, Tone::Wrong);
    } else if view.is_past && view.share.is_none() {
        let words = "What is shown was found with other choices: analyse again.";
        note(ui, words, Tone::Quiet);
    } else if let Some(found) = view.found {
        let words = match found.n_sessions {
            1 => "1 session".to_owned(),
            n => format!("{n} sessions"),
        };
        note(ui, &words, Tone::Quiet);
    }
}

fn show_button(ui: &mut Ui, view: &AnalysisView<'_>, commands: &mut Commands) {
    let verb = if view.found.is_some() {
        "Analyse again"
    } else {
        "Analyse"
    };
    let tip = "Read the logs and compute everything";
    if button(ui, verb, tip, view.refusal) {
        commands.push(AnalysisCommand::Begin.into());
    }
}

fn show_effort(ui: &mut Ui, choice: &Choice, commands: &mut Commands) {
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
        if toggle(ui, word, choice.effort == effort, tip) {
            let choice = Choice {
                effort,
                ..choice.clone()
            };
            commands.push(AnalysisCommand::Choose(choice).into());
        }
    }
}

/// What is chosen seldom.
fn show_more(ui: &mut Ui, view: &AnalysisView<'_>, commands: &mut Commands) {
    let choice = view.choice;
    row_of(ui, NAME, ("with", ""), |ui, _| {
        let tip = "Compare the stress of maps with that of random ranks: takes longer";
        if toggle(ui, "random data", choice.has_random_data, tip) {
            let choice = Choice {
                has_random_data: !choice.has_random_data,
                ..choice.clone()
            };
            commands.push(AnalysisCommand::Choose(choice).into());
        }
        let is_left_out = view.found.is_some_and(|found| !found.left_out.is_empty());
        if view.held.is_some() || is_left_out || choice.with_held {
            let tip = "Whoever takes part in a session that is being held counts too";
            if toggle(ui, "session under way", choice.with_held, tip) {
                let choice = Choice {
                    with_held: !choice.with_held,
                    ..choice.clone()
                };
                commands.push(AnalysisCommand::Choose(choice).into());
            }
        }
    });
    if let Some(found) = view.found.filter(|found| !found.left_out.is_empty()) {
        let words = format!(
            "{} is left out: a session of theirs is being held.",
            found.left_out.join(", ")
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
pub(crate) fn show_folded(
    ui: &mut Ui,
    view: &AnalysisView<'_>,
    fields: &mut Fields,
    commands: &mut Commands,
) {
    let folder = Path::new(fields.folder.trim()).file_name();
    let summary = folder.unwrap_or_default().to_string_lossy().into_owned();
    fold(ui, ("Folder and choices", false), &summary, |ui| {
        show(ui, view, fields, commands);
        show_report(ui, view, commands);
    });
    if let Some(share) = view.share {
        show_progress(ui, share, "Analysing the sessions");
    }
}

/// The report's files.
pub(crate) fn show_report(ui: &mut Ui, view: &AnalysisView<'_>, commands: &mut Commands) {
    ui.add_space(2.0 * STEP);
    if let Some(share) = view.writing {
        return show_progress(ui, share, "Writing the report");
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let tip = "A page to read, every table as CSV and JSON, every figure as SVG and PNG";
        if button(ui, "Write report…", tip, None) {
            commands.push(FileCommand::Ask(Purpose::WriteReport).into());
        }
        let is_written = matches!(view.written, Some(Ok(_)));
        if is_written && button(ui, "Show it", "Show the folder of the report", None) {
            commands.push(AnalysisCommand::ShowReport.into());
        }
    });
    match view.written {
        Some(Ok(folder)) => {
            let words = format!("Written: begin with {}", folder.join("index.md").display());
            note(ui, &words, Tone::Quiet);
        }
        Some(Err(line)) => note(ui, line, Tone::Wrong),
        None => {}
    }
    ui.allocate_space(vec2(1.0, STEP));
}
